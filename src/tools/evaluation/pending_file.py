"""Writes files that get their name only when they are complete."""
import contextlib
import os


@contextlib.contextmanager
def pending(path):
    """The name to write to: the path with .part in its name. It becomes the path when the block is left, and is removed
    when that is by an exception. The ending stays, because matplotlib goes by it."""
    folder, name = os.path.split(str(path))
    stem, ending = os.path.splitext(name)
    temporary = os.path.join(folder, f"{stem}.part{ending}")
    try:
        yield temporary
        os.replace(temporary, str(path))
    finally:
        with contextlib.suppress(FileNotFoundError):
            os.remove(temporary)
