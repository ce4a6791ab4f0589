import shutil
import unittest

from project import SOURCE_DIR, run

WITHOUT_MKDOCS = ["make_site: mkdocs is missing: apt install mkdocs", "reference: THE SITE OF THE DOCUMENTS IS LEFT OUT"]


@unittest.skipUnless(shutil.which("doxygen"), "doxygen is not installed")
class ReferenceTest(unittest.TestCase):
    def test_doxygen_has_no_warnings(self):
        result = run([SOURCE_DIR / "scripts/reference"])
        complaints = [line for line in result.stderr.splitlines() if line not in WITHOUT_MKDOCS]
        self.assertEqual((result.returncode, complaints), (0, []), result.stdout)
