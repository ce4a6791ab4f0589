#!/usr/bin/python3
"""Tests of scripts/built_space.bash: bash scripts find the built package as rosrun does."""

import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

from project import DEVEL_DIR, SOURCE_DIR

SCRIPT = 'set -euo pipefail\n. "$(dirname "$0")/built_space.bash"\necho "$devel"\nrospack find uav_landing\n'


class BuiltSpaceTest(unittest.TestCase):
    """In a clone that is not built, as in the source space of a catkin workspace."""

    def setUp(self):
        self.folder = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, str(self.folder))
        scripts = self.folder / "uav_landing/scripts"
        scripts.mkdir(parents=True)
        shutil.copy(str(SOURCE_DIR / "scripts/built_space.bash"), str(scripts))
        self.script = scripts / "where"
        self.script.write_text(SCRIPT)

    def look(self, **environment):
        usual = {name: value for name, value in os.environ.items()
                 if name not in ("UAV_LANDING_DEVEL_DIR", "CMAKE_PREFIX_PATH", "ROS_PACKAGE_PATH")}
        return subprocess.run(["bash", str(self.script), "an argument that setup.bash must not see"],
                              env=dict(usual, **environment), stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                              universal_newlines=True, timeout=60)

    def test_the_sourced_space_that_has_the_package_is_taken(self):
        result = self.look(CMAKE_PREFIX_PATH=f"/nowhere:{DEVEL_DIR}:/usr")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stdout.splitlines(), [str(DEVEL_DIR.resolve()), str(SOURCE_DIR)])

    def test_a_colon_too_many_is_no_space(self):
        for path in (f":{DEVEL_DIR}", f"/nowhere::{DEVEL_DIR}:"):
            result = self.look(CMAKE_PREFIX_PATH=path)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(result.stdout.splitlines()[0], str(DEVEL_DIR.resolve()))

    def test_the_space_that_is_named_goes_first(self):
        result = self.look(CMAKE_PREFIX_PATH="/usr", UAV_LANDING_DEVEL_DIR=str(DEVEL_DIR))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stdout.splitlines()[0], str(DEVEL_DIR))

    def test_without_any_it_says_what_to_do(self):
        for environment in ({}, {"CMAKE_PREFIX_PATH": "/usr"}, {"UAV_LANDING_DEVEL_DIR": "/nowhere"}):
            result = self.look(**environment)
            self.assertEqual(result.returncode, 1)
            self.assertTrue(result.stderr.startswith("where: build first: scripts/build, or catkin_make"), result.stderr)


if __name__ == "__main__":
    unittest.main()
