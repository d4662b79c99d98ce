"""What a job found, for viewers of time series: signals and remarks to be laid over a recording."""
