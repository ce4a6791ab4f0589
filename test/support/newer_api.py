"""Finds what is newer than Ubuntu 20.04 in sources: C++, CMake, Python and shell. The names are in newer_names.py."""

import ast
import functools
import re
import sys
from collections import namedtuple
from pathlib import Path

import newer_names as names

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "scripts"))
from mutants.source_text import without_comments_and_texts  # noqa: E402 (only there after the line before)

Finding = namedtuple("Finding", "file line api version")
OLDEST_PYTHON = (3, 8)
OLDEST_CMAKE = (3, 16)
CMAKE_ASIDE = re.compile(r"#[^\n]*")
SHELL_ASIDE = re.compile(r"(?<![^\s;])#[^\n]*")


def _without(text, aside):
    """The text without comments, on the same lines."""
    return aside.sub(lambda match: " " + "\n" * match.group().count("\n"), text)


def _whole(word):
    """A pattern of whole words."""
    before = r"(?<!\w)" if re.match(r"[\w(]", word) else ""
    after = r"(?!\w)" if re.search(r"[\w)*]$", word) and not word.endswith(r"\(") else ""
    return f"{before}(?:{word}){after}"


@functools.lru_cache(maxsize=None)
def _pattern(words):
    return re.compile("|".join(map(_whole, words)))


def _search(file, text, table):
    for version, words in table.items():
        for match in _pattern(words).finditer(text):
            yield Finding(file, text.count("\n", 0, match.start()) + 1, " ".join(match.group().split()), version)


def in_cpp(file, text):
    return list(_search(file, without_comments_and_texts(text), names.CPP))


def in_cmake(file, text):
    code = _without(text, CMAKE_ASIDE)
    found = list(_search(file, code, names.CMAKE))
    for match in re.finditer(r"cmake_minimum_required\s*\(\s*VERSION\s+(\d+)\.(\d+)", code, re.I):
        if (int(match.group(1)), int(match.group(2))) > OLDEST_CMAKE:
            version = f"CMake {match.group(1)}.{match.group(2)}"
            found.append(Finding(file, code.count("\n", 0, match.start()) + 1, "cmake_minimum_required", version))
    return found


def in_shell(file, text):
    return list(_search(file, _without(text, SHELL_ASIDE), names.SHELL))


def in_python(file, text):
    try:
        tree = ast.parse(text, feature_version=OLDEST_PYTHON)
    except SyntaxError as error:
        version = re.search(r"Python 3\.\d+", error.msg)
        return [Finding(file, error.lineno, f"syntax ({error.msg})", version.group() if version else "no Python")]
    found = [Finding(file, line, api, version) for line, api, version in _python_names(tree)]
    if not any(isinstance(node, ast.ImportFrom) and node.module == "__future__" and
               any(alias.name == "annotations" for alias in node.names) for node in ast.walk(tree)):
        found += [Finding(file, line, api, version) for line, api, version in _python_annotations(tree)]
    return found + [Finding(file, line, api, version) for line, api, version in _python_expressions(tree)]


def _version_of(name):
    return next((version for version, words in names.PYTHON_NAMES.items() if name in words), None)


def _python_names(tree):
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute):
            module = node.value.id if isinstance(node.value, ast.Name) else ""
            version = names.PYTHON_MEMBERS.get((module, node.attr)) or _version_of(node.attr)
            if version:
                yield node.lineno, node.attr, version
        elif isinstance(node, ast.ImportFrom):
            for alias in node.names:
                version = names.PYTHON_MEMBERS.get((node.module, alias.name)) or _version_of(alias.name)
                if version:
                    yield node.lineno, alias.name, version
        modules = [alias.name for alias in node.names] if isinstance(node, ast.Import) else \
            [node.module or ""] if isinstance(node, ast.ImportFrom) else []
        for module in modules:
            if module.split(".")[0] in names.PYTHON_MODULES:
                yield node.lineno, module, names.PYTHON_MODULES[module.split(".")[0]]


def _python_annotations(tree):
    """X | Y where a type is told: it is computed when the function is defined."""
    for node in ast.walk(tree):
        for told in (getattr(node, "annotation", None), getattr(node, "returns", None)):
            for part in ast.walk(told) if told else ():
                if isinstance(part, ast.BinOp) and isinstance(part.op, ast.BitOr):
                    yield part.lineno, "X | Y for types", "Python 3.10"
                elif _is_generic(part):
                    yield part.lineno, f"{part.value.id}[...]", "Python 3.9"


def _is_generic(node):
    return isinstance(node, ast.Subscript) and isinstance(node.value, ast.Name) and \
        node.value.id in {"list", "dict", "tuple", "set", "frozenset", "type"}


def _python_expressions(tree):
    for node in ast.walk(tree):
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.BitOr):
            if any(_is_dictionary(side) for side in (node.left, node.right)):
                yield node.lineno, "dict | dict", "Python 3.9"
        elif isinstance(node, ast.Call):
            function = getattr(node.func, "attr", getattr(node.func, "id", ""))
            for keyword in node.keywords:
                version = names.PYTHON_ARGUMENTS.get((function, keyword.arg))
                if version:
                    yield node.lineno, f"{function}({keyword.arg}=)", version


def _is_dictionary(node):
    return isinstance(node, (ast.Dict, ast.DictComp)) or \
        isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "dict"


def language(path):
    """The scanner of a file, or None."""
    if path.suffix in (".cpp", ".h"):
        return in_cpp
    if path.suffix == ".cmake" or path.name == "CMakeLists.txt":
        return in_cmake
    if path.suffix == ".py":
        return in_python
    if path.suffix in (".bash", ".sh"):
        return in_shell
    if path.suffix:
        return None
    with path.open("rb") as file:
        first = file.readline(80)
    if not first.startswith(b"#!"):
        return None
    return in_python if b"python" in first else in_shell if re.search(rb"\b(ba)?sh\b", first) else None


def sources(folder):
    """Files of a checkout that have a language of ours, without what builds leave in it."""
    for path in sorted(Path(folder).iterdir()):
        hidden = path.name.startswith(".") and path.name != ".ci"
        if path.is_symlink() or hidden or path.name.startswith("build") and path.is_dir() or path.name == "__pycache__":
            continue
        if path.is_dir():
            yield from sources(path)
        elif language(path):
            yield path


def newer_api(root):
    """All findings in a checkout."""
    return [finding for path in sources(root)
            for finding in language(path)(str(path.relative_to(root)), path.read_text(errors="replace"))]
