"""Errors that are the input's fault."""


class InputError(Exception):
    """The input cannot be used. The message says which file and why."""
