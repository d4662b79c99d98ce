"""What the recorder is made of: topics of any type, read by a thread of its own, written to files that outlive it."""
