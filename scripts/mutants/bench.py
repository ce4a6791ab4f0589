"""Builds mutants and lets the tests judge them."""

import json
import shutil
import threading
from concurrent.futures import ThreadPoolExecutor

from .results import code_fingerprint, folder_fingerprint
from .workshop import LONGEST

SHORTEST = 20  # s, that a test may take at least
SLOWER = 10  # times as long as without a mutant: it hangs
MANY = 8  # sources that see a header: it takes long to compile them all


class TestTimes:
    """Keeps the seconds that tests took when they passed."""

    def __init__(self, path):
        self._path = path
        self._seconds = json.loads(path.read_text(encoding="utf-8")) if path.is_file() else {}

    def of(self, test):
        """Returns the seconds of a test, or 0 when they are not known."""
        return self._seconds.get(test.name, 0)

    def note(self, test, seconds):
        self._seconds[test.name] = round(seconds, 1)
        self._path.write_text(json.dumps(self._seconds, indent=0, sort_keys=True), encoding="utf-8")


def is_of_shared_library(path):
    """Says whether a mutant of this file changes only a shared library. The gtest programs then need not be built anew."""
    return path.startswith(("src/core/", "src/ros/")) and path.endswith(".cpp")


class Bench:
    def __init__(self, workshop, concern, results, times, patience, jobs, report):
        """patience: s of tests that a mutant has to survive. jobs: mutants side by side. report: called with each result."""
        self._workshop, self._concern, self._results, self._times = workshop, concern, results, times
        self._patience, self._jobs, self._report = patience, jobs, report
        self._tests = folder_fingerprint(workshop.tree / "test")
        self._sources = {}
        self._changing = threading.Lock()  # of the build and of what is known
        self._built = set()  # test programs that are there without a mutant
        self._passing = {}  # whether a test passes without a mutant: only those are asked that have failed with one

    def known(self, mutant, by_any_tests=False):
        """Returns the result of an earlier run that still holds, or None. by_any_tests: also one that survived older tests."""
        return self._results.of(mutant, self._source(mutant.path), None if by_any_tests else self._tests)

    def _source(self, path):
        """Returns the fingerprint of a source file without a mutant. known() asks for it before the file is changed."""
        if path not in self._sources:
            self._sources[path] = code_fingerprint(self._workshop.tree / path)
        return self._sources[path]

    def judge(self, mutants):
        """Judges all mutants: those of libraries side by side as far as gtest programs tell, the others one by one."""
        if not self._workshop.build("uav_landing_core", "uav_landing_ros"):
            raise RuntimeError(f"the tree does not build without a mutant, see {self._workshop.tree.parent / 'build.log'}")
        side_by_side = [mutant for mutant in mutants if is_of_shared_library(mutant.path)]
        # All at once, on all cores. One that cannot be built fails without a mutant, too.
        programs = {test.target for mutant in side_by_side for test in self._concern.tests_of(mutant.path) if test.program}
        if programs and self._workshop.build(*programs):
            self._built = programs
        with ThreadPoolExecutor(self._jobs) as pool:
            finished = set(pool.map(self._judge_beside, side_by_side))
        self._built = set()
        others = [mutant for mutant in mutants if mutant not in finished]
        for mutant in sorted(others, key=lambda mutant: (mutant.path.endswith(".h"), mutant.path)):
            self._judge_in_place(mutant)

    def _tests_of(self, mutant):
        return self._concern.tests_of(mutant.path, self._times.of)

    def _judge_beside(self, mutant):
        """Returns the mutant when gtest programs have judged it, None when other tests have to."""
        tests = self._tests_of(mutant)
        programs = [test for test in tests if test.program]
        library = self._workshop.build_library_with(mutant)
        if not library:
            self._note(mutant, "broken", None, 0)
            return mutant
        while True:
            killer, seconds = self._face_tests(programs, library)
            if not killer or self._passes_without(killer):
                break
        shutil.rmtree(library)
        if not killer and len(programs) < len(tests):
            return None
        self._note(mutant, "killed" if killer else "survived", killer, seconds)
        return mutant

    def _judge_in_place(self, mutant):
        """Judges a mutant with which tests or programs have to be built, or which tests with a ROS master judge."""
        tests = self._tests_of(mutant)
        if is_of_shared_library(mutant.path):
            tests = [test for test in tests if not test.program]
        if mutant.path.endswith(".h") and len(self._concern.sources_that_see(mutant.path)) > MANY:
            # To compile all of them takes minutes. Most mutants are killed with the nearest ones alone.
            nearest = self._concern.nearest_sources(mutant.path)
            near_tests = [test for test in tests if self._concern.sources_of(test) & nearest] or tests[:1]
            outcome = self._judge_built(mutant, near_tests, nearest)
            if outcome[0] == "killed":
                return self._note(mutant, *outcome)
        self._note(mutant, *self._judge_built(mutant, tests))

    def _judge_built(self, mutant, tests, sources=None):
        """Returns the outcome, the test that killed, and its seconds. sources: see Workshop.changed()."""
        libraries = ["uav_landing_core"]
        if not mutant.path.startswith(("src/core/", "include/")):
            libraries += ["uav_landing_ros", "uav_landing_nodelets", "uav_landing_tools"]
        while True:
            with self._workshop.changed(mutant, sources):
                if not self._workshop.build(*libraries):
                    return "broken", None, 0
                killer, seconds = self._face_tests(tests)
            if not killer:
                return "survived", None, seconds
            if self._passes_without(killer):
                return "killed", killer, seconds

    def _passes_without(self, test):
        """Says whether a test passes without a mutant. One that does not is left out from then on."""
        with self._changing:
            if test not in self._passing:
                built = test.target in self._built or self._workshop.build(*self._targets(test))
                self._passing[test], seconds = self._workshop.run(test) if built else (False, 0)
                if self._passing[test]:
                    self._times.note(test, seconds)
                else:
                    print(f"{test.name}: {'fails' if built else 'cannot be built'} without a mutant, left out", flush=True)
        return self._passing[test]

    @staticmethod
    def _targets(test):
        if test.program:
            return [test.target]
        return [test.target, "uav_landing_nodelets"] if test.target else ["all"]

    def _face_tests(self, tests, library=None):
        """The test that killed, or None, and the seconds that tests took. library: as of Workshop.run(); None: tests are built."""
        spent = 0
        for test in tests:
            if spent > self._patience:
                break
            if self._passing.get(test) is False:
                continue
            # A test that cannot be built refuses the mutant.
            if not library and not self._workshop.build(*self._targets(test)):
                return test, spent
            passed, seconds = self._run(test, library)
            spent += seconds
            # What waits for others may fail once by itself.
            if not passed and not test.program:
                passed, seconds = self._run(test, library)
                spent += seconds
            if not passed:
                return test, spent
        return None, spent

    def _run(self, test, library):
        usual = self._times.of(test)
        passed, seconds = self._workshop.run(test, library, min(LONGEST, max(SHORTEST, SLOWER * usual)) if usual else LONGEST)
        if passed:
            with self._changing:
                self._times.note(test, seconds)
        return passed, seconds

    def _note(self, mutant, outcome, by, seconds):
        with self._changing:
            self._report(self._results.add(mutant, outcome, by.name if by else "", seconds, self._source(mutant.path), self._tests))
