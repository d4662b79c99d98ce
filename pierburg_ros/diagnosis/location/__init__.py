"""Where a mismatch is: windows of time, and ranges of what the shaft does."""
