"""The folders of the core depend on each other in one direction, as the table of docs/how_it_works.md has them."""

import re
import unittest

from project import SOURCE_DIR

INCLUDE = re.compile(r'^#include "((?:uav_landing/)?[a-z0-9_/]+/[a-z0-9_]+\.h)"', re.MULTILINE)
ROOTS = (SOURCE_DIR / "src/core", SOURCE_DIR / "include/uav_landing")


def documented_folders():
    """Rank of each folder and room: those in one row of the table may use each other in one direction, too."""
    table = (SOURCE_DIR / "docs/how_it_works.md").read_text().split("| folder | what is in it |")[1].split("\n\n")[0]
    rows = [re.findall(r"`([a-z]+(?:/[a-z]+)?)`", row.split("|")[1]) for row in table.splitlines()[2:]]
    return {folder: rank for rank, folder in enumerate(folder for row in rows for folder in row)}


def rooms_of_public_headers():
    """Public headers have no rooms of their own: each belongs to the room of the source that implements it."""
    sources = {(path.parent.parent.name, path.stem): f"{path.parent.parent.name}/{path.parent.name}"
               for path in (SOURCE_DIR / "src/core").glob("*/*/*.cpp")}
    return {f"uav_landing/{path.parent.name}/{path.name}": sources[path.parent.name, path.stem]
            for path in (SOURCE_DIR / "include/uav_landing").glob("*/*.h")
            if (path.parent.name, path.stem) in sources}


class CoreFoldersTest(unittest.TestCase):
    def setUp(self):
        self.ranks = documented_folders()
        self.public_rooms = rooms_of_public_headers()

    def folder_of(self, header):
        """The room where there are rooms, else the folder."""
        if header in self.public_rooms:
            return self.public_rooms[header]
        folder = header.replace("uav_landing/", "", 1).rsplit("/", 1)[0]
        return folder if folder in self.ranks else self.first_room(folder)

    def first_room(self, folder):
        """A public header without a source, in a folder of rooms, is for all of these."""
        return min((room for room in self.ranks if room.startswith(folder + "/")), key=self.ranks.get, default=folder)

    def test_each_folder_is_in_the_table(self):
        there = set()
        for root in ROOTS:
            folders = [path for path in root.iterdir() if path.is_dir()]
            rooms = [path for folder in folders for path in folder.iterdir() if path.is_dir()]
            there |= {path.relative_to(root).as_posix() for path in rooms}
            there |= {path.name for path in folders if not any(room.parent == path for room in rooms)}
        with_rooms = {room.split("/")[0] for room in there if "/" in room}
        self.assertEqual(there - with_rooms, set(self.ranks))

    def test_a_folder_uses_those_above_it_only(self):
        wrong = []
        for root in ROOTS:
            for path in sorted([*root.glob("*/**/*.cpp"), *root.glob("*/**/*.h")]):
                own = path.relative_to(root.parent if root.name == "uav_landing" else root).as_posix()
                rank = self.ranks[self.folder_of(own)]
                used = INCLUDE.findall(path.read_text())
                wrong += [f"{path.relative_to(SOURCE_DIR)} includes {header}" for header in used
                          if self.ranks.get(self.folder_of(header), len(self.ranks)) > rank
                          and header != "uav_landing/pipeline.h"]
                if "uav_landing/pipeline.h" in path.read_text():
                    wrong.append(f"{path.relative_to(SOURCE_DIR)} includes pipeline.h, which uses all folders")
        self.assertEqual(wrong, [])

    def test_no_two_files_need_each_other(self):
        """A header with its source is one file here."""
        needs = {}
        for root in ROOTS:
            for path in sorted(root.rglob("*")):
                if path.suffix in (".h", ".cpp"):
                    used = needs.setdefault(self.module_of(path.relative_to(root).as_posix()), set())
                    used |= {self.module_of(header) for header in INCLUDE.findall(path.read_text())}
        pairs = [f"{one} and {other}" for one, used in needs.items() for other in used
                 if one < other and one in needs.get(other, ())]
        self.assertEqual(sorted(pairs), [])

    @staticmethod
    def module_of(path):
        """A public header and the source in its room are the same: rooms are left out."""
        parts = re.sub(r"\.(h|cpp)$", "", path.replace("uav_landing/", "", 1)).split("/")
        return f"{parts[0]}/{parts[-1]}"


if __name__ == "__main__":
    unittest.main()
