import shutil
import unittest

from project import SOURCE_DIR, run


@unittest.skipUnless(shutil.which("doxygen"), "doxygen is not installed")
class ReferenceTest(unittest.TestCase):
    def test_doxygen_has_no_warnings(self):
        result = run([SOURCE_DIR / "scripts/reference"])
        self.assertEqual((result.returncode, result.stderr), (0, ""), result.stdout)
