#!/usr/bin/env python3
"""Adds up the XML results of gtest, rostest and python tests below <build>/test_results.

Prints failures and skips with their reasons, and which test programs took longest. The last line is "N passed, N failed". The exit
status is 0 only when some test ran and none failed. A test program that ctest calls failed though its results show no failure (it
crashed at exit, or left no results) counts as one failure.
"""

import re
import sys
import xml.etree.ElementTree as ElementTree
from collections import namedtuple
from pathlib import Path

Case = namedtuple("Case", "name outcome message")
LONGEST = 10  # test programs that are named with their time


def read_cases(path):
    """Reads the test cases of one result file. Their outcome is passed, failed or skipped."""
    try:
        root = ElementTree.parse(str(path)).getroot()
    except ElementTree.ParseError as error:
        return [Case(path.stem, "failed", f"unreadable result file {path}: {error}")]
    return [read_case(element, path.stem) for element in root.iter("testcase")]


def read_case(element, source):
    name = f"{element.get('classname') or source}.{element.get('name')}"
    for tag in ("failure", "error"):
        found = element.find(tag)
        if found is not None:
            return Case(name, "failed", (found.get("message") or found.text or "").strip())
    found = element.find("skipped")
    if found is not None or element.get("status") == "notrun" or element.get("result") == "skipped":
        message = "" if found is None else (found.get("message") or found.text or "")
        return Case(name, "skipped", message.strip() or "no reason given")
    return Case(name, "passed", "")


def read_results(build):
    """Reads the cases of all result files but rostest's own, which repeat, by name only, what the rosunit-* files say."""
    return [case for path in sorted((build / "test_results").rglob("*.xml"))
            if not path.name.startswith("rostest-") for case in read_cases(path)]


def failed_in_ctest(build):
    """Returns the names of the tests that ctest calls failed."""
    log = build / "Testing" / "Temporary" / "LastTestsFailed.log"
    return [line.split(":", 1)[1].strip() for line in log.read_text().splitlines()] if log.is_file() else []


def result_files(build, ctest_name):
    """Returns the result files of a test that catkin called _ctest_<project>_<type>_<name>."""
    kind, name = re.match(r"_ctest_.*?_(gtest|rostest|nosetests|roslaunch-check)_(.*)", ctest_name).groups()
    files = list((build / "test_results").rglob(f"{kind}[-_]{name}.xml"))
    if kind == "rostest":
        files = list((build / "test_results").rglob(f"rostest-{name.split('.')[0]}.xml"))
        files += [path.parent / f"rosunit-{case.name.split('.test')[-1]}.xml" for path in files for case in read_cases(path)]
    return [path for path in files if path.is_file()]


def unexplained_failures(build):
    """Returns failed tests whose results show no failure, and what rostest says besides its tests' own results."""
    failures = []
    for name in failed_in_ctest(build):
        cases = [(path, case) for path in result_files(build, name) for case in read_cases(path)
                 if case.outcome == "failed"]
        failures += [case for path, case in cases if path.name.startswith("rostest-")]
        if not cases:
            failures.append(Case(name, "failed", "no failure in its results; see the output above"))
    return failures


def longest(build):
    """Returns names and seconds of the test programs that took longest, by ctest's log."""
    log = build / "Testing" / "Temporary" / "LastTest.log"
    text = log.read_text(errors="replace") if log.is_file() else ""
    times = re.findall(r"^\d+/\d+ Test: (\S+)$.*?^Test time = +([0-9.]+) sec$", text, re.MULTILINE | re.DOTALL)
    times = [(re.sub("^_ctest_.*?_(gtest|rostest|nosetests|roslaunch-check)_", "", name), float(time)) for name, time in times]
    return sorted(times, key=lambda test: -test[1])[:LONGEST]


def main(build):
    cases = read_results(build) + unexplained_failures(build)
    failed = [case for case in cases if case.outcome == "failed"]
    skipped = [case for case in cases if case.outcome == "skipped"]
    passed = len(cases) - len(failed) - len(skipped)
    for case in failed:
        print(f"FAILED {case.name}: {case.message}")
    for case in skipped:
        print(f"SKIPPED {case.name}: {case.message}")
    if skipped:
        print(f"{len(skipped)} TESTS DID NOT RUN, see SKIPPED above")
    if not passed and not failed:
        print("no test ran")
    for name, time in longest(build):
        print(f"LONGEST {time:6.1f} s {name}")
    print(f"{passed} passed, {len(failed)} failed")
    return 0 if passed and not failed else 1


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
