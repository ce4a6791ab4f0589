"""Finds all mutants that a tree allows, in the random order of a seed."""

import hashlib
import re
from collections import namedtuple

from .operators import KINDS
from .source_text import without_comments_and_texts

# path: below the tree; line: from 1; column: from 0.
Mutant = namedtuple("Mutant", "name path line column kind before after")

_NOT_CODE = re.compile(r"^\s*(?:#|using |namespace |template\b|static_assert|assert\(|ROS_|NODELET_|friend |class |struct .*;$|extern )")


def _digest(*parts):
    return hashlib.sha256("\n".join(map(str, parts)).encode()).hexdigest()


def source_files(tree, folders):
    """Returns sources and headers below the folders or files, as paths below the tree."""
    found = set()
    for folder in folders:
        path = tree / folder
        found |= {path} if path.is_file() else {p for p in path.rglob("*") if p.suffix in (".cpp", ".h")}
    return sorted(path.relative_to(tree).as_posix() for path in found)


def of_file(tree, path):
    """Returns a list of mutants for each line that has any. Their names stay the same while other lines change."""
    source = (tree / path).read_text(encoding="utf-8")
    seen = {}
    for number, (text, code) in enumerate(zip(source.split("\n"), without_comments_and_texts(source).split("\n")), 1):
        if _NOT_CODE.match(code):
            continue
        occurrence = seen[text.strip()] = seen.get(text.strip(), 0) + 1
        mutants = []
        for kind, operator in KINDS.items():
            for start, end, replacement in operator(code):
                after = text[:start] + replacement + text[end:]
                name = _digest(path, text.strip(), occurrence, after.strip())[:10]
                mutants.append(Mutant(name, path, number, start, kind, text, after))
        if mutants:
            yield mutants


def in_random_order(tree, folders, seed):
    """Returns one mutant of each line. The lines are in random order, and the mutant of a line is drawn at random."""
    drawn = []
    for path in source_files(tree, folders):
        for mutants in of_file(tree, path):
            drawn.append(min(mutants, key=lambda mutant: _digest(seed, "mutant", mutant.name)))
    return sorted(drawn, key=lambda mutant: _digest(seed, "line", mutant.name))
