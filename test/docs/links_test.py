import re
import unittest

from project import SOURCE_DIR


class LinksTest(unittest.TestCase):
    def test_files_that_pages_link_to_exist(self):
        pages = [SOURCE_DIR / "README.md", *(SOURCE_DIR / "docs").glob("*.md"), *(SOURCE_DIR / "test").glob("*.md")]
        for page in pages:
            for target in re.findall(r"\]\(([^)#]+)", page.read_text(encoding="utf-8")):
                if "://" not in target:
                    with self.subTest(page=str(page), target=target):
                        self.assertTrue((page.parent / target).exists())

    def test_source_files_that_pages_name_exist(self):
        text = (SOURCE_DIR / "docs/how_it_works.md").read_text(encoding="utf-8")
        names = re.findall(r"`([\w/]+\.(?:cpp|h))`", text)
        self.assertGreater(len(names), 30)
        for name in names:
            with self.subTest(name=name):
                self.assertTrue((SOURCE_DIR / "src/core" / name).exists())
