import shutil
import unittest

from project import SOURCE_DIR, run

CATKIN_LINT = shutil.which("catkin_lint")


class CatkinLintTest(unittest.TestCase):
    @unittest.skipUnless(CATKIN_LINT, "catkin_lint is not installed")
    def test_manifest_and_cmake_files_have_no_findings(self):
        result = run([CATKIN_LINT, "--strict", "-W1", "--offline", SOURCE_DIR])
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
