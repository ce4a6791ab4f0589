"""What can be wrong with the input."""


class InputError(Exception):
    """The input cannot be used; the message says which file, topic or field, and what was expected."""


def unreadable(path, error):
    """InputError for an OSError of a file."""
    return InputError(f"{path}: " + ("no such file" if isinstance(error, FileNotFoundError) else error.strerror))
