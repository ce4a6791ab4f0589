import re
import unittest

from project import SOURCE_DIR

FOREIGN = ("Skipped loading plugin", "stereo_image_proc", "no such package media_export",
           "Unable to register with master node … Will keep trying",
           "Detected jump back in time … Clearing TF buffer", "TF_REPEATED_DATA")


def phrases(message):
    """Pieces of a message that do not depend on the case: three words or more, or a reason's name."""
    fixed = re.sub(r"[/\w]+/[\w/]+|\w*\[\d\]|\w+_link|expected ", "|", message)
    return re.findall(r"[A-Za-z']+(?: [A-Za-z']+){2,}|[a-z]+_[a-z_]+", fixed)


class TroubleshootingTest(unittest.TestCase):
    def test_the_programs_still_say_what_the_table_quotes(self):
        sources = "".join(file.read_text() for folder in ("src", "include") for file in (SOURCE_DIR / folder).rglob("*")
                          if file.suffix in (".cpp", ".h", ".py", "") and file.is_file())
        sources = re.sub(r'f?"\s*\n\s*f?"', "", sources)
        page = (SOURCE_DIR / "docs/troubleshooting.md").read_text()
        rows = [line.split(" | ")[0] for line in page.splitlines() if line.startswith("| ")]
        quoted = [phrase for row in rows for message in re.findall(r"`([^`]+)`", row) if message not in FOREIGN
                  for phrase in phrases(message)]
        self.assertGreater(len(rows), 70)
        self.assertGreater(len(quoted), 100)
        self.assertEqual([phrase for phrase in quoted if phrase not in sources], [])

    def test_what_the_programs_send_people_to_is_there(self):
        """process_bag says: see docs/troubleshooting.md."""
        self.assertIn("see docs/troubleshooting.md", (SOURCE_DIR / "src/tools/offline/verdict.cpp").read_text())
        section = (SOURCE_DIR / "README.md").read_text().split("## Troubleshooting")[1].split("\n## ")[0]
        self.assertIn("(docs/troubleshooting.md)", section)
