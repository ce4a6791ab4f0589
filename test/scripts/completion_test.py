import os
import shutil
import tempfile
import unittest
from pathlib import Path

from project import SOURCE_DIR, run

COMPLETE = """
. {file}
COMP_WORDS=({words})
COMP_CWORD={last}
{function}
printf '%s\\n' "${{COMPREPLY[@]}}"
"""


def completions(function, *words, at=SOURCE_DIR):
    """What bash offers for the last word, in that folder."""
    quoted = " ".join(f"'{word}'" for word in words)
    script = COMPLETE.format(file="scripts/completion.bash", words=quoted, last=len(words) - 1, function=function)
    return run(["bash", "-c", script], cwd=str(at)).stdout.split()


ROSBASH = Path("/usr/share/bash-completion/completions/rosrun")


class CompletionTest(unittest.TestCase):
    def test_options_of_programs_come_from_their_help(self):
        self.assertEqual(completions("_uav_landing_rosrun", "rosrun", "uav_landing", "process_bag", "--inp"), ["--input"])
        offered = completions("_uav_landing_rosrun", "rosrun", "uav_landing", "evaluate", "--")
        self.assertTrue({"--truth", "--estimates", "--report", "--report-data", "--help"} <= set(offered))

    def test_options_that_only_an_explanation_names_are_not_offered(self):
        for program, prose, option in (("process_bag", "--report", "--report-data"), ("evaluate", "--csv", "--json")):
            offered = completions("_uav_landing_rosrun", "rosrun", "uav_landing", program, "--")
            self.assertIn(option, offered)
            self.assertNotIn(prose, offered)

    def test_options_of_scripts_without_a_list_come_from_their_comment(self):
        self.assertEqual(completions("_uav_landing_script", "scripts/fuzz", "--s"), ["--seconds"])

    def test_options_of_a_subcommand_are_its_own(self):
        converter = ("_uav_landing_rosrun", "rosrun", "uav_landing", "convert_recording")
        self.assertEqual(completions(*converter, "bag", "flight.bag", "--left-"), ["--left-calibration", "--left-info"])
        self.assertEqual(completions(*converter, "videos", "--r"), ["--rate", "--right-calibration"])
        self.assertEqual(completions(*converter, "euroc", "--left-"), [])
        self.assertEqual(completions(*converter, "nothing", "--"), ["--help"])

    def test_a_script_is_run_for_its_help_only(self):
        """Words that are no subcommand do not reach it."""
        with tempfile.TemporaryDirectory() as folder:
            scripts = Path(folder) / "scripts"
            scripts.mkdir()
            shutil.copy(str(SOURCE_DIR / "scripts/completion.bash"), str(scripts))
            (scripts / "work").write_text(f'#!/bin/sh\necho "$*" >>{folder}/calls\necho "work --hard: all day"\n')
            (scripts / "work").chmod(0o755)
            for command in ("scripts/work", "./scripts/work", f"{scripts}/work"):
                with self.subTest(command):
                    self.assertEqual(completions("_uav_landing_script", command, "all", "--", at=folder), ["--hard"])
            self.assertEqual(set((Path(folder) / "calls").read_text().splitlines()), {"--help"})
            # Of another clone, or another project.
            self.assertEqual(completions("_uav_landing_script", f"{SOURCE_DIR}/scripts/fuzz", "--", at=folder), [])

    @unittest.skipUnless(ROSBASH.exists(), "rosbash's completion is not installed")
    def test_packages_and_programs_still_complete(self):
        self.assertEqual(completions("_uav_landing_rosrun", "rosrun", "uav_lan"), ["uav_landing"])
        self.assertEqual(sorted(completions("_uav_landing_rosrun", "rosrun", "uav_landing", "process_bag")),
                         ["process_bag", "process_bags"])

    def test_options_of_scripts_come_from_their_help(self):
        self.assertEqual(completions("_uav_landing_script", "scripts/calibrate", "--sq"), ["--square"])

    def test_every_script_completes(self):
        result = run(["bash", "-c", ". scripts/completion.bash; complete -p"], cwd=str(SOURCE_DIR))
        completed = {line.split()[-1] for line in result.stdout.splitlines() if "_uav_landing_script" in line}
        scripts = {f"{folder}/{file.name}" for file in (SOURCE_DIR / "scripts").iterdir()
                   if file.is_file() and os.access(str(file), os.X_OK)
                   for folder in ("scripts", "./scripts", SOURCE_DIR / "scripts")}
        self.assertEqual(completed, scripts)
        self.assertIn("./scripts/process_bags", scripts)

    def test_other_words_are_left_to_file_names(self):
        self.assertEqual(completions("_uav_landing_rosrun", "rosrun", "uav_landing", "process_bag", "fli"), [])
