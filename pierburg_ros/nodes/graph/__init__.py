"""What every node shares with the graph: topics, parameters, diagnostics, lifecycle, and a clean end."""
