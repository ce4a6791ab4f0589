import os
import tempfile
import unittest
from importlib.machinery import SourceFileLoader
from pathlib import Path

from project import SOURCE_DIR, run

PROGRAM = SOURCE_DIR / "scripts/flightgear"


class FlightgearTest(unittest.TestCase):
    def test_what_is_missing_is_one_line_that_says_what_to_install(self):
        with tempfile.TemporaryDirectory() as folder:
            result = run(["/usr/bin/python3", PROGRAM, "--output", Path(folder) / "out"],
                         env=dict(os.environ, PATH="/nonexistent"))
        self.assertEqual((result.returncode, result.stdout), (1, ""))
        self.assertEqual(len(result.stderr.splitlines()), 1)
        self.assertIn("apt install", result.stderr)
        self.assertIn("xvfb", result.stderr)

    def test_wrong_usage(self):
        self.assertEqual(run([PROGRAM]).returncode, 2)

    def test_launch_file_starts_the_script_with_a_bag_to_play(self):
        result = run(["roslaunch", "--args", "flightgear", "uav_landing", "flightgear.launch", "output:=/there/landing"])
        self.assertEqual(result.returncode, 0, result.stderr)
        command = result.stdout.split()
        self.assertEqual(Path(command[0]).resolve(), PROGRAM)
        self.assertEqual(command[1:6], ["--output", "/there/landing", "--bag", "/there/landing.bag", "--play"])
        # What roslaunch appends is no wrong usage: only what is missing is complained of.
        result = run(["/usr/bin/python3", *command], env=dict(os.environ, PATH="/nonexistent"))
        self.assertEqual((result.returncode, len(result.stderr.splitlines())), (1, 1), result.stderr)

    def test_places_along_the_runway_are_metres_on_the_ellipsoid(self):
        runway = SourceFileLoader("flightgear", str(PROGRAM)).load_module().Runway(0.0, 10.0, 90.0)
        latitude, longitude = runway.place(1000.0)
        # A degree of the equator is 111319.49 m.
        self.assertAlmostEqual(latitude, 0.0, places=12)
        self.assertAlmostEqual(longitude, 10 + 1000 / 111319.49, places=8)
        # A degree of latitude at 45 degrees is 111132.95 m (WGS84: 111132.954 - 559.822 cos 2 phi + ...), to 2 m.
        north = SourceFileLoader("flightgear", str(PROGRAM)).load_module().Runway(45.0, 10.0, 0.0)
        self.assertAlmostEqual(north.place(111132.95)[0], 46.0, delta=2e-5 * 5)
