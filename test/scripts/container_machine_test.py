import os
import stat
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

from project import SOURCE_DIR, run

sys.path.insert(0, str(SOURCE_DIR / "scripts"))

from container import machine  # noqa: E402 (it stands in scripts/)
from container.rooms import Failed, why_no_base  # noqa: E402

SETTLED = ("mmdebstrap", "unshare", "chroot", "dpkg")


class ContainerMachineTest(unittest.TestCase):
    """Each thing that the machine lacks is one line that says what to do."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name).resolve()

    def programs(self, **contents):
        """A PATH with these programs alone: scripts of the shell, by name."""
        programs = self.folder / "programs"
        programs.mkdir()
        for name, content in contents.items():
            file = programs / name
            file.write_text(f"#!/bin/sh\n{content}\n")
            file.chmod(file.stat().st_mode | stat.S_IXUSR)
        return mock.patch.dict(os.environ, PATH=str(programs))

    def refusal(self, function, *arguments):
        with mock.patch("os.geteuid", return_value=0), self.assertRaises(Failed) as caught:
            function(*arguments)
        self.assertNotIn("\n", str(caught.exception))
        return str(caught.exception)

    def test_without_root_it_says_sudo(self):
        with mock.patch("os.geteuid", return_value=1000), self.assertRaises(Failed) as caught:
            machine.check_programs()
        self.assertEqual(str(caught.exception), "needs root for chroot: sudo scripts/test_container")

    def test_a_missing_program_is_named_with_its_package(self):
        with self.programs(mmdebstrap="", chroot="", dpkg=""):
            self.assertEqual(self.refusal(machine.check_programs), "unshare is missing: apt-get install util-linux")

    def test_an_architecture_that_debian_12_lacks_is_refused(self):
        with self.programs(**{**dict.fromkeys(SETTLED, ""), "dpkg": "echo riscv64"}):
            self.assertRegex(self.refusal(machine.check_programs),
                             "^Debian 12 has no packages for this machine's riscv64: run this on one of amd64, arm64, ")

    def test_a_machine_that_has_all_is_accepted(self):
        with self.programs(**{**dict.fromkeys(SETTLED, ""), "dpkg": "echo arm64"}), mock.patch("os.geteuid", return_value=0):
            machine.check_programs()

    def test_without_network_it_says_so(self):
        messages = "I: apt\nErr:1 http://x bookworm InRelease\n  Temporary failure resolving 'x'\nE: apt-get update failed\n"
        self.assertRegex(why_no_base(messages), r"^Debian's packages cannot be fetched: look at the network .* apt-get update works$")
        self.assertEqual(why_no_base("I: apt\nE: no space\nE: more\n"), "mmdebstrap did not make a Debian 12: E: no space")

    def test_a_folder_of_somebody_else_is_not_removed(self):
        theirs = self.folder / "theirs"
        theirs.mkdir()
        (theirs / "flight.bag").touch()
        self.assertEqual(self.refusal(machine.check_work, theirs, SOURCE_DIR),
                         f"--work {theirs}: is not from test_container and would be removed; give a new folder")

    def test_an_old_folder_of_stages_is_made_anew(self):
        work = self.folder / "work"
        machine.clear(work)
        (work / "old").touch()
        machine.check_work(work, SOURCE_DIR)
        machine.clear(work)
        self.assertEqual(os.listdir(str(work)), [machine.MARKER])

    def test_stages_are_not_copied_into_themselves(self):
        machine.check_work(SOURCE_DIR / "build-stages", SOURCE_DIR)
        for work in (SOURCE_DIR / "stages", SOURCE_DIR / "docs/build-stages"):
            self.assertEqual(self.refusal(machine.check_work, work, SOURCE_DIR),
                             f"--work {work}: would be copied into itself; give a folder outside of {SOURCE_DIR}")

    def test_a_full_disk_is_refused(self):
        with mock.patch("shutil.disk_usage") as usage:
            usage.return_value.free = 1.25e9
            self.assertRegex(self.refusal(machine.clear, self.folder / "work"), "1.2 GB are free there, [0-9]+ GB are needed; give a")

    def test_a_missing_compiler_cache_is_refused(self):
        self.assertRegex(self.refusal(machine.check_cache, self.folder / "no"), "/no: there is no such folder; ccache -k cache_dir")

    def test_each_refusal_is_one_line_of_the_program(self):
        result = run([SOURCE_DIR / "scripts/test_container", "--ccache", "/nowhere"])
        self.assertEqual((result.returncode, result.stdout, len(result.stderr.splitlines())), (1, "", 1))
        self.assertRegex(result.stderr, "^test_container: (needs root|.* is missing|--ccache /nowhere: )")
