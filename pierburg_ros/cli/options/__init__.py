"""The options that commands share: each is written once."""
