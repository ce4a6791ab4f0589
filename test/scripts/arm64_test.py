"""scripts/test_arm64: how it compares estimates, finds vector instructions, and what it says of machines that it cannot use."""

import csv
import os
import shutil
import sys
import tempfile
import unittest
from pathlib import Path

from project import SOURCE_DIR, run

sys.path.insert(0, str(SOURCE_DIR / "scripts"))
from arm64 import kernels  # noqa: E402 (only there after the line before)
from arm64.commands import PACKAGES  # noqa: E402

SCRIPT = SOURCE_DIR / "scripts/test_arm64"
ROW = {"cell_height_m": "10", "noise": "1", "frame": "12", "valid": "1", "reason": "", "compute_ms": "104",
       "height_true_m": "10.0276", "height_m": "10.04", "height_stddev_m": "0.02", "x_m": "", "x_stddev_m": "",
       "runway_width_m": "45.8374795303"}


def rows(number=20, **changed):
    """Rows of as many seeds; changed: fields of the last one."""
    made = [{"seed": str(seed), **ROW} for seed in range(1, number + 1)]
    made[-1].update(changed)
    return made


class FolderTest(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.folder)


class ComparisonTest(FolderTest):
    def write(self, name, table):
        path = self.folder / name
        with open(str(path), "w", newline="", encoding="utf-8") as file:
            writer = csv.DictWriter(file, list(table[0]))
            writer.writeheader()
            writer.writerows(table)
        return path

    def compare(self, here, there):
        """Exit status and what it says, of rows or of files."""
        files = [self.write(name, table) if isinstance(table, list) else table
                 for name, table in (("here.csv", here), ("arm64.csv", there))]
        result = run([SCRIPT, "--compare", *files])
        return result.returncode, (result.stdout + result.stderr).strip()

    def assert_unusable(self, here, there, message):
        status, said = self.compare(here, there)
        self.assertEqual(status, 2, said)
        self.assertNotIn("\n", said)
        self.assertIn(message, said)

    def test_equal_files_pass(self):
        # valid, reason, height and its claim of 20 rows; x is blank in all of them.
        self.assertEqual(self.compare(rows(), rows()),
                         (0, "passed: 80 of 80 values within 0.05 sigma\ntest_arm64: 80 of 80 values within 0.05 sigma: passed"))

    def test_a_difference_below_a_twentieth_of_the_claim_is_none(self):
        self.assertEqual(self.compare(rows(), rows(height_m="10.0409", compute_ms="9000"))[0], 0)

    def test_a_larger_difference_is_listed(self):
        status, said = self.compare(rows(40), rows(40, height_m="10.0412"))
        self.assertEqual(status, 0, said)
        self.assertIn("height_m at seed 40, cell_height_m 10, noise 1, frame 12: 10.04 here, 10.0412 on arm64, 0.06 sigma apart",
                      said)
        self.assertIn("159 of 160 values", said)

    def test_more_than_one_value_in_a_hundred_apart_fails(self):
        status, said = self.compare(rows(), rows(height_m="10.0412"))
        self.assertEqual(status, 1, said)
        self.assertTrue(said.endswith("79 of 80 values within 0.05 sigma: FAILED"), said)

    def test_other_claims_verdicts_and_blanks_are_apart(self):
        for changed in (dict(height_stddev_m="0.022"), dict(valid="0"), dict(reason="no_plane"), dict(height_m=""), dict(x_m="3"),
                        dict(height_m="nan")):
            with self.subTest(changed):
                self.assertEqual(self.compare(rows(), rows(**changed))[0], 1)

    def test_the_same_flights_are_rounded_otherwise(self):
        self.assertEqual(self.compare(rows(), rows(height_true_m="10.0276001"))[0], 0)

    def test_other_flights_are_refused(self):
        self.assert_unusable(rows(), rows(height_true_m="10.03"), "height_true_m at seed 20")
        self.assert_unusable(rows(), rows(runway_width_m="45"), "build this machine's programs anew")
        self.assert_unusable(rows(), rows(seed="99"), "only one of the files has the row seed 20")
        self.assert_unusable(rows(), rows(19), "only one of the files has the row seed 20")

    def test_other_columns_are_refused(self):
        self.assert_unusable(rows(), [{**row, "y_m": "3"} for row in rows()], "only one of the files has the column y_m")

    def test_files_that_are_no_campaigns_are_refused(self):
        self.assert_unusable(self.folder / "none.csv", rows(), "none.csv: cannot be read (No such file or directory)")
        self.assert_unusable(rows(), self.folder, "cannot be read (Is a directory)")
        self.assert_unusable([{"stamp_s": "1", "height_m": "2"}], rows(), "has no columns seed")
        (self.folder / "empty.csv").write_text("")
        self.assert_unusable(self.folder / "empty.csv", rows(), "has no columns seed")
        (self.folder / "header.csv").write_text("seed,cell_height_m,noise,frame\n")
        self.assert_unusable(rows(), self.folder / "header.csv", "header.csv: has no rows")
        (self.folder / "picture.csv").write_bytes(b"\x89PNG\xff")
        self.assert_unusable(self.folder / "picture.csv", rows(), "picture.csv: cannot be read")
        (self.folder / "cut.csv").write_text("seed,cell_height_m,noise,frame\n1,10,1\n")
        self.assert_unusable(self.folder / "cut.csv", rows(), "a row has not as many fields as the header")


class KernelsTest(unittest.TestCase):
    def test_vector_instructions_are_those_that_compute_with_whole_vectors(self):
        lines = ("fmul\tv0.4s, v1.4s, v2.4s", "fadd\ts0, s1, s2", "movi\tv0.4s, #0x0", "ldr\tq0, [x1]",
                 "ld1\t{v0.16b}, [x0]", "uaddlv\th0, v0.16b", "fadd\tv0.2s, v1.2s, v2.2s", "dup\tv1.4s, v0.s[0]",
                 "fmla\tv0.2d, v1.2d, v2.2d")
        listing = "".join(f"   {4 * i:x}:\t6e22dc20 \t{line}\n" for i, line in enumerate(lines))
        self.assertEqual(kernels.vector_instructions(listing), {0, 20, 32})

    def test_a_kernel_without_vectors_is_named(self):
        found = [kernels.Function(name) for name in ("vector", "scalar", "not_executed")]
        found[0].executed, found[0].vector, found[1].executed = 100, 30, 100
        self.assertEqual(kernels.judge(found), ["scalar", "not_executed"])

    def test_listed_kernels_exist(self):
        for name in kernels.HOTTEST:
            self.assertTrue((SOURCE_DIR / f"src/core/kernels/{name}.cpp").exists(), name)


class MachineTest(FolderTest):
    def run_with(self, *programs, kind="amd64"):
        """Runs the script where these programs alone are found, and dpkg, which says that the machine is of this kind."""
        for file in self.folder.iterdir():
            file.unlink()
        for name in programs:
            (self.folder / name).write_text("#!/bin/sh\nexit 1\n")
        if kind:
            (self.folder / "dpkg").write_text(f"#!/bin/sh\necho {kind}\n")
        for path in self.folder.iterdir():
            path.chmod(0o755)
        result = run([SCRIPT], env={**os.environ, "PATH": str(self.folder)})
        self.assertEqual(result.returncode, 2, result.stderr)
        self.assertEqual(result.stderr.count("\n"), 1, result.stderr)
        return result.stderr

    def test_each_missing_program_is_named_with_its_package(self):
        for missing, package in PACKAGES.items():
            with self.subTest(missing):
                said = self.run_with(*(name for name in PACKAGES if name != missing))
                self.assertEqual(said, f"test_arm64: {missing} not found: apt-get install {package}\n")

    def test_machines_of_other_kinds_are_refused(self):
        self.assertIn("this machine is of the kind \"riscv64\"", self.run_with(*PACKAGES, kind="riscv64"))
        self.assertIn("scripts/test tests here what this script emulates", self.run_with(*PACKAGES, kind="arm64"))

    def test_a_machine_without_dpkg_is_refused(self):
        self.assertIn("Debian", self.run_with(*PACKAGES, kind=None))

    def test_wrong_numbers_are_refused(self):
        result = run([SCRIPT, "--seeds", "0"])
        self.assertEqual(result.returncode, 2)
        self.assertIn("--seeds and --jobs: at least 1", result.stderr)


if __name__ == "__main__":
    unittest.main()
