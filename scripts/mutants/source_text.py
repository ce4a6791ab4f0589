"""Reads C++ source line by line, with comments and texts blanked out: for the mutation test and for newer_api.py."""

import re

_QUIET = re.compile(r"""
    //[^\n]*                      # comment to the end of the line
  | /\*.*?\*/                     # comment
  | R"(?P<mark>\w*)\(.*?\)(?P=mark)"  # raw text
  | "(?:\\.|[^"\\\n])*"           # text
  | (?<!\w)'(?:\\.|[^'\\\n])+'    # character; between digits it separates
""", re.VERBOSE | re.DOTALL)

_OPERATOR = re.compile(r" (?:[-+*/%<>?:|&^=]|[<>=!]=|&&|\|\|) ")


def without_comments_and_texts(source):
    """Returns the source with the same lines and columns, and blanks in place of comments and texts."""
    def blank(match):
        return "".join("\n" if c == "\n" else " " for c in match.group())
    return _QUIET.sub(blank, source)


def _end(line, start, is_end):
    """Returns the first place from start on where is_end(place) holds at the level of start, or where that level is left."""
    depth = 0
    for i in range(start, len(line)):
        if line[i] in "([{":
            depth += 1
        elif line[i] in ")]}":
            depth -= 1
            if depth < 0:
                return i
        elif depth == 0 and (line[i] in ",;" or is_end(i)):
            return i
    return None


def argument_end(line, start):
    """Returns where the argument that begins at start ends, or None where the line ends before."""
    return _end(line, start, lambda i: False)


def term_end(line, start):
    """Where the operand that begins at `start` ends: before the next operator, comma or bracket of its own level.

    Operators have blanks on both sides, as clang-format writes them. None where the line ends before the operand does.
    """
    return _end(line, start, lambda i: _OPERATOR.match(line, i))
