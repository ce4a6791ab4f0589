"""docs/make_site: what it makes of links, lists and tables; and the site itself, where mkdocs is installed."""

import importlib.machinery
import importlib.util
import json
import os
import subprocess
import sys
import unittest
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote

import yaml

from project import SOURCE_DIR, run

LOADER = importlib.machinery.SourceFileLoader("make_site", str(SOURCE_DIR / "docs/make_site"))
make_site = importlib.util.module_from_spec(importlib.util.spec_from_loader("make_site", LOADER))
LOADER.exec_module(make_site)
HAS_MKDOCS = subprocess.run([sys.executable, "-m", "mkdocs", "--version"], stdout=subprocess.DEVNULL,
                            stderr=subprocess.DEVNULL).returncode == 0


class PagesTest(unittest.TestCase):
    def translated(self, target, page="docs/index.md"):
        self.files = {}
        return make_site.translated(target, SOURCE_DIR / page, make_site.page_names(), self.files)

    def test_links_between_pages_lead_to_their_names_in_the_site(self):
        self.assertEqual(self.translated("../README.md"), "readme.md")
        self.assertEqual(self.translated("docs/frames.md#signs", "README.md"), "frames.md#signs")
        self.assertEqual(self.translated("../config/simulator/scenes"), "scenes.md")
        self.assertEqual((self.translated("#start"), self.translated("https://a.b/c")), ("#start", "https://a.b/c"))
        self.assertEqual(self.files, {})

    def test_other_files_are_copied_as_something_that_a_browser_shows(self):
        self.assertEqual(self.translated("../config/stereo.yaml"), "files/config/stereo.yaml.txt")
        self.assertEqual(self.files, {SOURCE_DIR / "config/stereo.yaml": "files/config/stereo.yaml.txt"})
        self.assertEqual(self.translated("docs/images/rviz.jpg", "README.md"), "files/docs/images/rviz.jpg")

    def test_a_link_to_nothing_is_named(self):
        with self.assertRaisesRegex(FileNotFoundError, "index.md: nowhere.md"):
            self.translated("nowhere.md")

    def test_lists_tables_and_code_in_lists_get_what_mkdocs_needs(self):
        self.assertEqual(make_site.spaced("Text:\n- one\n  more\n- two\n"), "Text:\n\n- one\n    more\n- two\n")
        self.assertEqual(make_site.spaced("Text:\n| a |\n|---|\n"), "Text:\n\n| a |\n|---|\n")
        self.assertEqual(make_site.spaced("1. Do:\n   ```\n   make\n   ```\n   Wait.\n2. Done\n"),
                         "1. Do:\n\n        make\n\n    Wait.\n\n2. Done\n")
        self.assertEqual(make_site.spaced("```\n- no list\ntext\n- none\n```\n"), "```\n- no list\ntext\n- none\n```\n")

    def test_code_keeps_what_looks_like_a_link(self):
        text = "```\n[a](nowhere)\n```\n"
        self.assertEqual(make_site.rewritten(text, SOURCE_DIR / "docs/index.md", {}, {}), text)

    def test_every_page_of_docs_is_in_the_navigation(self):
        text = (SOURCE_DIR / "docs/mkdocs.yml").read_text().replace("!!python/name:markdown.extensions.toc.slugify_unicode", "x")
        listed = {name for section in yaml.safe_load(text)["nav"] for pages in section.values() for page in pages
                  for name in page.values()}
        self.assertEqual({page.name for page in (SOURCE_DIR / "docs").glob("*.md")} - listed, set())
        self.assertEqual(listed - set(make_site.page_names().values()), set())


class Links(HTMLParser):
    """Links, names of places, and what is loaded, of one page."""

    def __init__(self, page):
        super().__init__()
        self.links, self.names, self.loaded = [], set(), []
        self.feed(page.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        attributes = dict(attributes)
        self.names |= {attributes[key] for key in ("id", "name") if attributes.get(key)}
        if tag == "a" and attributes.get("href"):
            self.links.append(attributes["href"])
        if tag in ("script", "img", "link") and attributes.get("rel") not in ("canonical",):
            self.loaded.append(attributes.get("src") or attributes.get("href") or "")


class SiteTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        if not HAS_MKDOCS:  # nose does not heed decorators of classes
            raise unittest.SkipTest("mkdocs is not installed: the site is not made")
        result = run([sys.executable, SOURCE_DIR / "docs/make_site"], env=dict(os.environ))
        assert result.returncode == 0, result.stdout + result.stderr
        cls.site = SOURCE_DIR / "build/reference/site"
        cls.pages = {page: Links(page) for page in cls.site.rglob("*.html") if page.name not in ("404.html", "search.html")}

    def test_links_lead_to_pages_and_headings_that_are_there(self):
        wrong = []
        for page, content in self.pages.items():
            for link in content.links:
                if "://" in link or link.startswith(("mailto:", "javascript:")):
                    continue
                name, _, anchor = link.partition("#")
                target = (page.parent / unquote(name)).resolve() if name else page
                target = target / "index.html" if target.is_dir() else target
                if not target.exists() or (anchor and target in self.pages and unquote(anchor) not in self.pages[target].names):
                    wrong.append(f"{page.name}: {link}")
        self.assertGreater(len(self.pages), 30)
        self.assertEqual(wrong, [])

    def test_nothing_is_loaded_from_the_network(self):
        self.assertEqual([(page.name, name) for page, content in self.pages.items() for name in content.loaded
                          if "://" in name or name.startswith("//")], [])

    def test_search_finds_words_of_the_pages(self):
        index = json.loads((self.site / "search/search_index.json").read_text(encoding="utf-8"))
        found = {entry["location"].split("#")[0] for entry in index["docs"] if "protection level" in entry["text"].lower()}
        self.assertTrue({"integrity.html", "glossary.html"} <= found, found)
