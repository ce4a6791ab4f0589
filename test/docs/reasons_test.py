"""docs/reasons.md is what scripts/list_messages makes of the code."""

import importlib.machinery
import importlib.util
import unittest

from project import SOURCE_DIR

LOADER = importlib.machinery.SourceFileLoader("list_messages", str(SOURCE_DIR / "scripts/list_messages"))
list_messages = importlib.util.module_from_spec(importlib.util.spec_from_loader("list_messages", LOADER))
LOADER.exec_module(list_messages)


class ReasonsTest(unittest.TestCase):
    def test_page_is_up_to_date(self):
        self.assertEqual((SOURCE_DIR / "docs/reasons.md").read_text(encoding="utf-8"), list_messages.page(),
                         "Regenerate it: scripts/list_messages")

    def test_every_reason_has_a_meaning(self):
        names, meanings = list_messages.names(), list_messages.meanings()
        self.assertGreater(len(names), 20)
        self.assertEqual(set(names), set(meanings))

    def test_literals_stay_and_the_rest_is_left_open(self):
        self.assertEqual(list_messages.sentence('text("only ", count, " of ", least, " lines")'), "only … of … lines")
        self.assertEqual(list_messages.sentence('"the stamp went " + (back ? "back" : "ahead")'), "the stamp went back or ahead")
        self.assertEqual(list_messages.sentence('"one "\n    "sentence"'), "one sentence")
        self.assertEqual(list_messages.sentence("detail"), "")

    def test_formats_are_sentences_with_ellipses(self):
        self.assertEqual(list_messages.formatted("%s: %.3g s, %d %% of %lu"), "…: … s, … % of …")

    def test_the_log_the_diagnostics_and_the_causes_are_found(self):
        self.assertIn(("every nodelet", "warn", "nothing to work on for … s: …"), list_messages.logged())
        self.assertIn("latency behind the image stamp", list_messages.diagnosed()["every nodelet", "number"])
        self.assertGreater(len(list_messages.causes()), 7)

    def test_an_expression_ends_at_its_own_bracket(self):
        self.assertEqual(list_messages.expression('text("a, (b", c)}; "next"'), 'text("a, (b", c)')
        self.assertEqual(list_messages.expression('"one" + f(a, b), other'), '"one" + f(a, b)')
