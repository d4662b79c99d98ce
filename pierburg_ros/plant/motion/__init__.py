"""Motion between events: linear pieces in closed form, and what ends them."""
