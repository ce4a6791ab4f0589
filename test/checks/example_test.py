"""The example program: the core is used without ROS, by the public headers alone."""

import re
import unittest

from project import BUILD_DIR, SOURCE_DIR, run

PROGRAM = BUILD_DIR / "examples/height_without_ros"


class ExampleTest(unittest.TestCase):
    def test_heights_are_those_of_the_simulator(self):
        result = run([PROGRAM, "6"])
        self.assertEqual((result.returncode, result.stderr), (0, ""), result.stdout)
        rows = [line.split() for line in result.stdout.splitlines()[1:]]
        self.assertEqual(len(rows), 6)
        for row in rows[2:]:
            height, stddev, true_height = map(float, row[1:4])
            self.assertLess(abs(height - true_height), max(5 * stddev, 0.01 * true_height), row)
        self.assertEqual(rows[-1][-1], "yes", result.stdout)

    def test_it_includes_no_header_of_ros_or_of_the_core_inside(self):
        text = (SOURCE_DIR / "examples/height_without_ros.cpp").read_text(encoding="utf-8")
        included = re.findall(r'#include "([^"]+)"', text)
        self.assertTrue(included)
        for name in included:
            self.assertTrue((SOURCE_DIR / "include" / name).is_file(), name)


if __name__ == "__main__":
    unittest.main()
