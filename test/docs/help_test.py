import os
import re
import unittest

from project import DEVEL_DIR, SOURCE_DIR, run

FOLDERS = (DEVEL_DIR / "lib/uav_landing", SOURCE_DIR / "src/tools", SOURCE_DIR / "scripts")
OPTION = re.compile(r"\s+(?:-\w, ?)?(?:-\w [^-]*)?--[a-z]")


def programs():
    """All programs of the project, those for its developers as well."""
    files = (file for folder in FOLDERS for file in folder.iterdir() if file.is_file() and os.access(str(file), os.X_OK))
    return sorted(file for file in files if not file.name.endswith("_test"))  # those are GoogleTest's


def unexplained(text):
    """Options of a help text that have no explanation, neither behind them nor on the next line, further in."""
    lines = text.split("\nexamples:")[0].splitlines() + [""]
    start = next((i for i, line in enumerate(lines) if re.match(r"(options|\[?Option.*):?", line, re.I)), len(lines))
    missing = []
    for line, following in zip(lines[start:], lines[start + 1:]):
        if OPTION.match(line):
            behind = re.search(r"\S {2,}\S", line)
            deeper = following.strip() and len(following) - len(following.lstrip()) > 8
            if not behind and not deeper:
                missing.append(line.strip())
    return missing


class HelpTest(unittest.TestCase):
    def test_every_program_explains_itself_and_all_its_options(self):
        names = {program.name for program in programs()}
        self.assertTrue({"process_bag", "simulate_approach", "evaluate", "calibrate", "demo", "test"} <= names)
        converters = [(SOURCE_DIR / "src/tools/convert_recording", kind) for kind in ("euroc", "kitti", "videos", "bag")]
        for command in [(program,) for program in programs()] + converters:
            with self.subTest(command=command):
                result = run([*command, "--help"], timeout=60)
                self.assertEqual((result.returncode, result.stderr), (0, ""))
                self.assertGreater(len(result.stdout), 70)
                self.assertEqual(unexplained(result.stdout), [])

    def test_an_option_without_an_explanation_is_found(self):
        self.assertEqual(unexplained("options:\n  --runway RUNWAY\n  --rate X   pairs a second"), ["--runway RUNWAY"])
        self.assertEqual(unexplained("Options:\n  -h,--help       Print this\n  --a-long-name TEXT=default\n"
                                     "              why it is there"), [])
