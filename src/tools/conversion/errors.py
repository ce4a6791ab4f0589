"""Errors that are the input's fault."""


class InputError(Exception):
    """The input cannot be used. The message says which file, topic or field, and what was expected."""


class BrokenPicture(InputError):
    """One image cannot be used, but others may be."""


def unreadable(path, error):
    """Returns the InputError for an OSError of a file."""
    return InputError(f"{path}: " + ("no such file" if isinstance(error, FileNotFoundError) else error.strerror))


class LeftOut:
    """Images that cannot be used, among many that can. All are counted, and the first ones are described."""

    SHOWN = 5

    def __init__(self):
        self.count, self.messages, self.notes = 0, [], []

    def add(self, broken):
        """Counts an image that cannot be used."""
        self.count += 1
        if self.count <= self.SHOWN:
            self.messages.append(str(broken))

    def note(self, text):
        """Adds what else a person should know of the images."""
        self.notes.append(text)

    @property
    def first(self):
        return self.messages[0]

    def lines(self):
        """Returns lines for the user."""
        lines = [f"left out: {message}" for message in self.messages]
        if self.count:
            lines.append("1 broken image was left out" if self.count == 1 else f"{self.count} broken images were left out")
        return lines + self.notes
