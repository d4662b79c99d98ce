"""Many recordings of many actuators: diagnosed, put into tables, followed over the life of each."""
