"""The exceptions a caller handles differently."""


class InputError(ValueError):
    """Something a person gave is not usable; the message is one line: what was found, what was expected, what to do."""
