import re
import unittest

from project import SOURCE_DIR

FENCED = re.compile(r"^ *```.*?^ *```", re.MULTILINE | re.DOTALL)


def pages():
    """All pages for people."""
    return [*SOURCE_DIR.glob("*.md"), *(SOURCE_DIR / "docs").rglob("*.md"), *(SOURCE_DIR / "test").glob("*.md"),
            *(SOURCE_DIR / "config").rglob("*.md")]


def prose(page):
    """A page without its blocks of code."""
    return FENCED.sub("", page.read_text(encoding="utf-8"))


def anchors(page):
    """Names of the headings, as the usual viewers make them: lower case, no punctuation, dashes for spaces."""
    found = []
    for heading in re.findall(r"^#+ +(.*)$", prose(page), re.MULTILINE):
        words = re.sub(r"[^\w\- ]", "", heading.strip().lower())
        name = words.replace(" ", "-")
        found.append(f"{name}-{found.count(name)}" if name in found else name)
    return found


class LinksTest(unittest.TestCase):
    def links(self):
        """Page, target and anchor of each link within the project."""
        for page in pages():
            for target in re.findall(r"\]\(([^)\s]+)\)", prose(page)):
                if "://" not in target:
                    name, _, anchor = target.partition("#")
                    yield page, (page.parent / name if name else page), anchor

    def test_files_that_pages_link_to_exist(self):
        links = list(self.links())
        self.assertGreater(len(links), 200)
        self.assertEqual([f"{page}: {target}" for page, target, _ in links if not target.exists()], [])

    def test_headings_that_pages_link_to_exist(self):
        links = [link for link in self.links() if link[2]]
        self.assertGreater(len(links), 40)
        self.assertEqual([f"{page.name}: {target.name}#{anchor}" for page, target, anchor in links
                          if target.exists() and anchor not in anchors(target)], [])

    def test_every_page_of_docs_is_in_the_index(self):
        index = (SOURCE_DIR / "docs/index.md").read_text(encoding="utf-8")
        listed = set(re.findall(r"\]\(([\w/]+\.md)", index))
        there = {page.relative_to(SOURCE_DIR / "docs").as_posix() for page in (SOURCE_DIR / "docs").rglob("*.md")}
        self.assertEqual(there - {"index.md"} - listed, set())

    def test_source_files_that_pages_name_exist(self):
        text = (SOURCE_DIR / "docs/how_it_works.md").read_text(encoding="utf-8")
        names = re.findall(r"`([\w/]+\.(?:cpp|h))`", text)
        self.assertGreater(len(names), 30)
        for name in names:
            with self.subTest(name=name):
                self.assertTrue((SOURCE_DIR / "src/core" / name).exists())

    def test_tests_that_pages_name_exist(self):
        there = {path.stem for path in (SOURCE_DIR / "test").rglob("*") if path.suffix in (".cpp", ".py")}
        names = {(page.name, name) for page in pages() for name in re.findall(r"`(\w+_test)(?:\.py|\.cpp)?`", prose(page))}
        self.assertGreater(len(names), 15)
        self.assertEqual({name for name in names if name[1] not in there and not name[1].startswith("NAME_")}, set())

    def test_test_cases_that_pages_name_exist(self):
        sources = "\n".join(path.read_text() for path in (SOURCE_DIR / "test").rglob("*_test.cpp"))
        there = {f"{suite}.{name}" for suite, name in re.findall(r"^TEST(?:_[FP])?\((\w+),\s*(\w+)\)", sources, re.MULTILINE)}
        names = {name for page in pages() for name in re.findall(r"`([A-Z]\w+\.[A-Z]\w+)`", prose(page))}
        self.assertGreater(len(names), 25)
        self.assertEqual(names - there, set())
