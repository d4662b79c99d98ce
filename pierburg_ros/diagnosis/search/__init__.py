"""Which explanations there are, and how well each fits."""
