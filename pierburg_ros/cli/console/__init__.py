"""What a command shows on the terminal: text as it stands, how far it is, and how it ends."""
