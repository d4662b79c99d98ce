"""What changes over the life of each unit: courses, trends, steps, forecasts, and who is unlike the rest."""
