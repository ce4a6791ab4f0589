import re
import unittest

from project import SOURCE_DIR


class VersionTest(unittest.TestCase):
    def found(self, file, pattern):
        return re.findall(pattern, (SOURCE_DIR / file).read_text(encoding="utf-8"), re.MULTILINE)[0]

    def test_all_places_have_the_same_version(self):
        version = self.found("package.xml", r"<version>(.*)</version>")
        for file, pattern in (("CHANGELOG.rst", r"^(\d+\.\d+\.\d+) \("), ("CITATION.cff", r"^version: (.*)$"),
                              ("README.md", r"Version (\d+\.\d+\.\d+)"), ("src/tools/evaluate", r"evaluate (\d+\.\d+\.\d+)\"")):
            with self.subTest(file=file):
                self.assertEqual(self.found(file, pattern), version)

    def test_change_log_is_short(self):
        lines = (SOURCE_DIR / "CHANGELOG.rst").read_text(encoding="utf-8").split("1.0.0 (")[1].splitlines()
        self.assertLessEqual(len(lines), 40)
