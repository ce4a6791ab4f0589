import contextlib
import io
import tempfile
import unittest
from pathlib import Path

import summarize_results

GTEST = """<testsuites><testsuite name="A">
  <testcase name="good" status="run" result="completed" classname="A"/>
  <testcase name="bad" status="run" result="completed" classname="A"><failure message="1 is not 2"/></testcase>
  <testcase name="absent" status="run" result="skipped" classname="A"><skipped message="no dataset lab"/></testcase>
  <testcase name="disabled" status="notrun" result="suppressed" classname="A"/>
</testsuite></testsuites>"""
PYTHON = """<testsuite><testcase classname="b.B" name="fine"/>
  <testcase classname="b.B" name="broken"><error message="KeyError"/></testcase></testsuite>"""
ONE_PASSED = '<testsuite><testcase classname="C" name="good" status="run"/></testsuite>'


class SummarizeResultsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.build = Path(folder.name)
        self.results = self.build / "test_results" / "uav_landing"
        self.results.mkdir(parents=True)

    def write(self, name, text):
        (self.results / name).write_text(text)

    def ctest_calls_failed(self, *names):
        folder = self.build / "Testing" / "Temporary"
        folder.mkdir(parents=True)
        (folder / "LastTestsFailed.log").write_text("".join(f"{i}:{name}\n" for i, name in enumerate(names, 1)))

    def ctest_took(self, **seconds):
        folder = self.build / "Testing" / "Temporary"
        folder.mkdir(parents=True)
        (folder / "LastTest.log").write_text("".join(
            f'{i}/9 Testing: {name}\n{i}/9 Test: {name}\nCommand: "run"\nOutput:\n-----\nTest time is long\n<end of output>\n'
            f"Test time = {time:6.2f} sec\n-----\nTest Passed.\n" for i, (name, time) in enumerate(seconds.items(), 1)))

    def summary(self):
        output = io.StringIO()
        with contextlib.redirect_stdout(output):
            status = summarize_results.main(self.build)
        return status, output.getvalue().splitlines()

    def test_adds_up_results_of_all_kinds(self):
        self.write("gtest-a.xml", GTEST)
        self.write("nosetests-b.py.xml", PYTHON)
        self.ctest_calls_failed("_ctest_uav_landing_gtest_a", "_ctest_uav_landing_nosetests_b.py")
        status, lines = self.summary()
        self.assertEqual(lines[-1], "2 passed, 2 failed")
        self.assertEqual(status, 1)

    def test_failures_and_skips_are_printed_with_their_reason(self):
        self.write("gtest-a.xml", GTEST)
        lines = self.summary()[1]
        self.assertIn("FAILED A.bad: 1 is not 2", lines)
        self.assertIn("SKIPPED A.absent: no dataset lab", lines)
        self.assertIn("SKIPPED A.disabled: no reason given", lines)
        self.assertIn("2 TESTS DID NOT RUN, see SKIPPED above", lines)

    def test_all_passed_is_success(self):
        self.write("gtest-c.xml", ONE_PASSED)
        self.assertEqual(self.summary(), (0, ["1 passed, 0 failed"]))

    def test_names_the_longest_tests_before_the_last_line(self):
        self.write("gtest-c.xml", ONE_PASSED)
        self.ctest_took(**{f"_ctest_uav_landing_gtest_quick{i}_test": 0.1 * i for i in range(10)},
                        **{"_ctest_uav_landing_nosetests_test_tools_slow_test.py": 61.25})
        status, lines = self.summary()
        self.assertEqual((status, len(lines)), (0, summarize_results.LONGEST + 1))
        self.assertEqual(lines[0], "LONGEST   61.2 s test_tools_slow_test.py")
        self.assertEqual(lines[1], "LONGEST    0.9 s quick9_test")
        self.assertEqual(lines[-1], "1 passed, 0 failed")

    def test_no_test_at_all_is_a_failure(self):
        self.assertEqual(self.summary(), (1, ["no test ran", "0 passed, 0 failed"]))

    def test_only_skipped_tests_are_a_failure(self):
        self.write("gtest-a.xml", '<testsuite><testcase name="x" status="notrun"/></testsuite>')
        status, lines = self.summary()
        self.assertEqual((status, lines[-1]), (1, "0 passed, 0 failed"))

    def test_program_that_crashed_after_its_results_counts_as_a_failure(self):
        self.write("gtest-c.xml", ONE_PASSED)
        self.ctest_calls_failed("_ctest_uav_landing_gtest_c")
        status, lines = self.summary()
        self.assertEqual((status, lines[-1]), (1, "1 passed, 1 failed"))

    def test_rostest_is_not_counted_twice(self):
        self.write("rosunit-inner.xml", GTEST)
        self.write("rostest-test_outer.xml",
                   '<testsuite><testcase classname="rostest.runner.RosTest" name="testinner"/></testsuite>')
        self.ctest_calls_failed("_ctest_uav_landing_rostest_test_outer.test")
        self.assertEqual(self.summary()[1][-1], "1 passed, 1 failed")

    def test_rostest_that_could_not_start_its_test_counts_as_a_failure(self):
        self.write("gtest-c.xml", ONE_PASSED)
        self.write("rostest-test_outer.xml", '<testsuite><testcase classname="rostest.runner.RosTest" name="testinner">'
                                             '<failure message="node does not exist"/></testcase></testsuite>')
        self.ctest_calls_failed("_ctest_uav_landing_rostest_test_outer.test")
        status, lines = self.summary()
        self.assertIn("FAILED rostest.runner.RosTest.testinner: node does not exist", lines)
        self.assertEqual((status, lines[-1]), (1, "1 passed, 1 failed"))

    def test_unreadable_result_file_is_a_failure(self):
        self.write("gtest-c.xml", ONE_PASSED)
        self.write("gtest-d.xml", "<testsuite><testcase")
        self.assertEqual(self.summary()[1][-1], "1 passed, 1 failed")
