import os
import unittest

from project import SOURCE_DIR, run

COMPLETE = """
. {file}
COMP_WORDS=({words})
COMP_CWORD={last}
{function}
printf '%s\\n' "${{COMPREPLY[@]}}"
"""


def completions(function, *words):
    """What bash offers for the last word."""
    quoted = " ".join(f"'{word}'" for word in words)
    script = COMPLETE.format(file=SOURCE_DIR / "scripts/completion.bash", words=quoted, last=len(words) - 1,
                             function=function)
    return run(["bash", "-c", script], cwd=str(SOURCE_DIR)).stdout.split()


class CompletionTest(unittest.TestCase):
    def test_options_of_programs_come_from_their_help(self):
        self.assertEqual(completions("_uav_landing_rosrun", "rosrun", "uav_landing", "process_bag", "--inp"), ["--input"])
        offered = completions("_uav_landing_rosrun", "rosrun", "uav_landing", "evaluate", "--")
        self.assertTrue({"--truth", "--estimates", "--report", "--report-data", "--help"} <= set(offered))

    def test_options_of_scripts_come_from_their_help(self):
        self.assertEqual(completions("_uav_landing_script", "scripts/calibrate", "--sq"), ["--square"])

    def test_every_script_completes(self):
        result = run(["bash", "-c", ". scripts/completion.bash; complete -p"], cwd=str(SOURCE_DIR))
        completed = {line.split()[-1] for line in result.stdout.splitlines() if "_uav_landing_script" in line}
        scripts = {f"scripts/{file.name}" for file in (SOURCE_DIR / "scripts").iterdir()
                   if file.is_file() and os.access(str(file), os.X_OK)}
        self.assertEqual(completed, scripts)
        self.assertIn("scripts/process_bags", scripts)

    def test_other_words_are_left_to_file_names(self):
        self.assertEqual(completions("_uav_landing_rosrun", "rosrun", "uav_landing", "process_bag", "fli"), [])
