"""Builds mutants and lets the tests judge them."""

import shutil
import threading
from concurrent.futures import ThreadPoolExecutor

from .results import file_fingerprint, folder_fingerprint
from .workshop import LONGEST

SHORTEST = 20  # s, that a test may take at least
SLOWER = 10  # times as long as without a mutant: it hangs


def is_of_shared_library(path):
    """Whether a mutant of this file changes nothing but a shared library: gtest programs then need not be built anew."""
    return path.startswith(("src/core/", "src/ros/")) and path.endswith(".cpp")


class Bench:
    def __init__(self, workshop, concern, results, patience, jobs, report):
        """patience: s of tests that a mutant has to survive. jobs: mutants side by side. report: called with each result."""
        self._workshop, self._concern, self._results = workshop, concern, results
        self._patience, self._jobs, self._report = patience, jobs, report
        self._tests = folder_fingerprint(workshop.tree / "test")
        self._sources = {}
        self._changing = threading.Lock()  # of the build and of what is known
        self._built = set()  # targets of tests, without a mutant
        self._times = {}  # s of each test without a mutant; None: it fails without one

    def known(self, mutant, by_any_tests=False):
        """The result of an earlier run that still holds, or None. by_any_tests: also of one that survived older tests."""
        return self._results.of(mutant, self._source(mutant.path), None if by_any_tests else self._tests)

    def _source(self, path):
        """Fingerprint of a source file without a mutant: it is asked for first by known()."""
        if path not in self._sources:
            self._sources[path] = file_fingerprint(self._workshop.tree / path)
        return self._sources[path]

    def judge(self, mutants):
        """All of them: those of libraries side by side as far as gtest programs tell, the others one by one in the copy."""
        if not self._workshop.build("uav_landing_core", "uav_landing_ros"):
            raise RuntimeError(f"the tree does not build without a mutant, see {self._workshop.tree.parent / 'build.log'}")
        side_by_side = [mutant for mutant in mutants if is_of_shared_library(mutant.path)]
        # All at once, on all cores. One that cannot be built is left out when its turn comes.
        programs = {test.target for mutant in side_by_side for test in self._concern.tests_of(mutant.path) if test.program}
        if programs and self._workshop.build(*programs):
            self._built = programs
        with ThreadPoolExecutor(self._jobs) as pool:
            finished = set(pool.map(self._judge_beside, side_by_side))
        others = [mutant for mutant in mutants if mutant not in finished]
        for mutant in sorted(others, key=lambda mutant: (mutant.path.endswith(".h"), mutant.path)):
            self._judge_in_place(mutant)

    def _judge_beside(self, mutant):
        """Returns the mutant when gtest programs have judged it, None when other tests have to."""
        tests = self._concern.tests_of(mutant.path)
        programs = [test for test in tests if test.program]
        library = self._workshop.build_library_with(mutant)
        if not library:
            self._note(mutant, "broken", "", 0)
            return mutant
        killer, seconds = self._face_tests(programs, library, self._is_ready)
        shutil.rmtree(library)
        if not killer and len(programs) < len(tests):
            return None
        self._note(mutant, "killed" if killer else "survived", killer, seconds)
        return mutant

    def _judge_in_place(self, mutant):
        """A mutant that tests or programs are built with, or that tests with a ROS master judge."""
        tests = self._concern.tests_of(mutant.path)
        if is_of_shared_library(mutant.path):
            tests = [test for test in tests if not test.program]
        for test in tests:  # before the change: how long they take without it
            if sum(self._times.get(done) or 0 for done in tests) > self._patience:
                break
            self._is_ready(test, with_programs=True)
        libraries = ["uav_landing_core"]
        if not mutant.path.startswith(("src/core/", "include/")):
            libraries += ["uav_landing_ros", "uav_landing_nodelets", "uav_landing_tools"]
        with self._workshop.changed(mutant):
            if not self._workshop.build(*libraries):
                return self._note(mutant, "broken", "", 0)
            killer, seconds = self._face_tests(tests, None, self._is_built)
        self._note(mutant, "killed" if killer else "survived", killer, seconds)

    def _is_ready(self, test, with_programs=False):
        """Builds a test without a mutant, and sees it pass."""
        with self._changing:
            if test not in self._times:
                built = test.target in self._built or self._workshop.build(*self._targets(test, with_programs))
                passed, seconds = self._workshop.run(test) if built else (False, 0)
                self._times[test] = seconds if passed else None
                if not passed:
                    print(f"{test.name}: {'fails' if built else 'cannot be built'} without a mutant, left out", flush=True)
        return self._times[test] is not None

    def _is_built(self, test):
        """Builds a test with the mutant. One that cannot be built refuses it."""
        return self._times.get(test) is not None and self._workshop.build(*self._targets(test, True))

    @staticmethod
    def _targets(test, with_programs):
        if test.program:
            return [test.target]
        return [test.target, "uav_landing_nodelets"] if test.target else ["all"] if with_programs else []

    def _face_tests(self, tests, library, is_ready):
        """The name of the test that killed, or "", and the seconds that tests took."""
        spent = 0
        for test in tests:
            if spent > self._patience:
                break
            if not is_ready(test):
                continue
            deadline = min(LONGEST, max(SHORTEST, SLOWER * self._times[test]))
            passed, seconds = self._workshop.run(test, library, deadline)
            spent += seconds
            # What waits for others may fail once by itself.
            if not passed and not test.program:
                passed, seconds = self._workshop.run(test, library, deadline)
                spent += seconds
            if not passed:
                return test.name, spent
        return "", spent

    def _note(self, mutant, outcome, by, seconds):
        with self._changing:
            self._report(self._results.add(mutant, outcome, by, seconds, self._source(mutant.path), self._tests))
