"""What can be wrong with the input."""


class InputError(Exception):
    """The input cannot be used; the message says which file, topic or field, and what was expected."""
