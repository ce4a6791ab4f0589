"""The folders of the core depend on each other in one direction, as the table of docs/how_it_works.md has them."""

import re
import unittest

from project import SOURCE_DIR

INCLUDE = re.compile(r'^#include "(?:uav_landing/)?([a-z]+)/[a-z0-9_/]+\.h"', re.MULTILINE)


def documented_folders():
    """Rank of each folder: those in one row of the table may use each other in one direction, too."""
    table = (SOURCE_DIR / "docs/how_it_works.md").read_text().split("| folder | what is in it |")[1].split("\n\n")[0]
    rows = [re.findall(r"`([a-z]+)`", row.split("|")[1]) for row in table.splitlines()[2:]]
    return {folder: rank for rank, folder in enumerate(folder for row in rows for folder in row)}


class CoreFoldersTest(unittest.TestCase):
    def test_each_folder_is_in_the_table(self):
        there = {path.name for root in ("src/core", "include/uav_landing") for path in (SOURCE_DIR / root).iterdir()
                 if path.is_dir()}
        self.assertEqual(there, set(documented_folders()))

    def test_a_folder_uses_those_above_it_only(self):
        ranks = documented_folders()
        wrong = []
        for root in (SOURCE_DIR / "src/core", SOURCE_DIR / "include/uav_landing"):
            for path in sorted([*root.glob("*/*.cpp"), *root.glob("*/*.h")]):
                rank = ranks[path.parent.name]
                used = INCLUDE.findall(path.read_text())
                wrong += [f"{path.relative_to(SOURCE_DIR)} includes {folder}/" for folder in used
                          if ranks.get(folder, len(ranks)) > rank]
                if "uav_landing/pipeline.h" in path.read_text():
                    wrong.append(f"{path.relative_to(SOURCE_DIR)} includes pipeline.h, which uses all folders")
        self.assertEqual(wrong, [])


if __name__ == "__main__":
    unittest.main()
