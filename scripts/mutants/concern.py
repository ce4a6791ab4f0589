"""Finds the tests that concern a source file: those that reach it by includes, the nearest first."""

import re
from collections import namedtuple
from pathlib import Path

# target: what is built for it (None: nothing of its own). program: a gtest program that needs no ROS master.
Test = namedtuple("Test", "name target program")

_INCLUDE = re.compile(r'^\s*#include "([^"]+)"', re.MULTILINE)
_ROOTS = ("include", "src", "src/core", "src/ros", "src/nodelets", "src/tools", "test")
_DEFINED = re.compile(r"^[\w:<>,&*\s]*?\b([A-Z]\w+)::[~\w]+\(", re.MULTILINE)
_DECLARED = re.compile(r"^(?:class|struct) (\w+)\b[^;]*$", re.MULTILINE)
_FUNCTION = re.compile(r"^[A-Za-z][\w:<>,&* ]*[ &*>](\w+)\(", re.MULTILINE)
# Nodelets that run in the tests of others as well.
_WHOLE_CHAIN = ("chain_nodelet", "abuse_nodelet")


def _read(path):
    return path.read_text(encoding="utf-8")


class Concern:
    """The include graph of a tree, and its tests."""

    def __init__(self, tree, tests, sources_of):
        """tests: all of ctest. sources_of: source files of a target, as paths below the tree."""
        self._tree = tree
        self._files = [path.relative_to(tree).as_posix() for folder in ("include", "src", "test")
                       for path in sorted((tree / folder).rglob("*")) if path.suffix in (".cpp", ".h")]
        self._texts = {name: _read(tree / name) for name in self._files}
        self._includes = {name: self._resolved(name) for name in self._files}
        self._includers = {name: [] for name in self._files}
        for name, included in self._includes.items():
            for header in included:
                self._includers[header].append(name)
        self._homes = {kind: name for name in self._files if name.endswith(".h")
                       for kind in _DECLARED.findall(self._texts[name])}
        self._tests = tests
        self._sources = {test: set(sources_of(test.target)) if test.target else set() for test in tests}
        self._by_source = {}
        for test in tests:
            for source in self._sources[test]:
                self._by_source.setdefault(source, []).append(test)

    def _resolved(self, name):
        found = []
        for included in _INCLUDE.findall(self._texts[name]):
            places = [Path(name).parent / included] + [Path(root) / included for root in _ROOTS]
            found += [place.as_posix() for place in places if place.as_posix() in self._texts][:1]
        return found

    def sources_of(self, test):
        return self._sources[test]

    def sources_that_see(self, header):
        """Returns the sources of libraries and programs that include a file, directly or by other headers."""
        return {name for name in self._seeing(header) if name.startswith("src/")}

    def nearest_sources(self, header):
        """Returns those of the sources and of the tests that see a file by the fewest includes."""
        nearest = set()
        for folder in ("src/", "test/"):
            seeing = {name: steps for name, steps in self._seeing(header).items() if name.startswith(folder)}
            nearest |= {name for name, steps in seeing.items() if steps == min(seeing.values())}
        return nearest

    def _seeing(self, header):
        """Returns the sources that include a file, with the number of includes that it takes."""
        steps, border = {header: 0}, [header]
        while border:
            reached = {user: steps[at] + 1 for at in border for user in self._includers[at] if user not in steps}
            steps.update(reached)
            border = list(reached)
        return {name: count for name, count in steps.items() if name.endswith(".cpp")}

    def _headers_of(self, name):
        """Returns the headers that a source implements: of its own name, of classes, or else of functions that it defines."""
        stem = Path(name).stem
        same = {header for header in self._includes[name] if Path(header).stem == stem}
        same |= {self._homes[kind] for kind in _DEFINED.findall(self._texts[name]) if kind in self._homes}
        if same:
            return same
        functions = set(_FUNCTION.findall(self._texts[name]))
        return {header for header in self._includes[name] if functions & set(_FUNCTION.findall(self._texts[header]))}

    def _distances(self, name):
        """Returns the files that depend on this one, with the number of includes between."""
        distances, border = {name: 0}, [name]
        while border:
            reached = []
            for at in border:
                used_by = self._headers_of(at) if at.endswith(".cpp") else self._includers[at]
                # To its own header is no step.
                step = 0 if at.endswith(".cpp") else 1
                for other in used_by:
                    if distances[at] + step < distances.get(other, 1000):
                        distances[other] = distances[at] + step
                        reached.append(other)
            border = reached
        return distances

    def _by_words(self, word, folders):
        """Returns the tests in Python or with a launch file that name a program."""
        return [test for test in self._tests if not test.target and any(folder in test.name for folder in folders) and
                re.search(rf"\b{word}\b", self._text_of(test))]

    def _text_of(self, test):
        for folder in ("test/tools", "test/scripts", "test/launch", "test/nodelets"):
            marker = folder.replace("/", "_") + "_"
            if marker in test.name:
                return self._text_with_launched(self._tree / folder / test.name.split(marker, 1)[1])
        return ""

    def _text_with_launched(self, path):
        """Returns the text of a test with those of the program that its .test file starts and of the launch files it names."""
        if not path.is_file():
            return ""
        text = _read(path)
        started = [path.parent / name for name in re.findall(r'type="(\w+\.py)"', text)]
        text += "".join(_read(file) for file in started if file.is_file())
        launched = [self._tree / "launch" / name for name in sorted(set(re.findall(r"\w+\.launch\b", text)))]
        return text + "".join(_read(file) for file in launched if file.is_file())

    def _outside_core(self, name):
        """Returns the tests of a nodelet or of a program by its source: 0 for those with its name, 1 for others."""
        stem, tests = Path(name).stem, []
        if name.startswith("src/nodelets/"):
            targets = [f"{nodelet}_test" for nodelet in (stem, *_WHOLE_CHAIN)]
            tests = [test for test in self._tests if test.target in targets]
        elif name.startswith("src/tools/") and re.search(r"^int main\(", self._texts[name], re.MULTILINE):
            tests = self._by_words(stem, ("test_tools", "test_scripts", "test_launch"))
        return {test: 0 if stem in test.name else 1 for test in tests}

    def tests_of(self, name, seconds=lambda test: 0):
        """The nearest first; those that bear its name before all others; of those that are as near the quickest first."""
        near = {}
        for other, distance in self._distances(name).items():
            named = Path(other).stem.startswith(Path(name).stem)
            for test in self._by_source.get(other, []):
                near[test] = min(near.get(test, 1000), -1 if named else distance)
            for test, further in self._outside_core(other).items():
                near[test] = min(near.get(test, 1000), distance + 1 + further)
        # Of the core the tests without a ROS master say all, where there are any.
        alone = {test: distance for test, distance in near.items() if test.program}
        if alone and name.startswith(("src/core/", "include/")):
            near = alone
        return sorted(near, key=lambda test: (near[test], not test.program, seconds(test), test.name))
