"""measure_noise_bound: errors, bounds and claims of the plane fit together."""

import csv
import shutil
import tempfile
import unittest
from pathlib import Path

from project import BUILD_DIR, run

PROGRAM = BUILD_DIR / "devel/lib/uav_landing/measure_noise_bound"
QUANTITIES = ("height_m", "pitch_deg", "roll_deg")


class MeasureNoiseBoundTest(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="uav_landing_noise_bound_"))
        self.addCleanup(shutil.rmtree, str(self.folder))
        self.output = self.folder / "bound.csv"

    def measure(self, *options):
        return run([PROGRAM, "--output", self.output, *options])

    def test_no_error_is_smaller_than_the_bound_and_claims_are_near_the_errors(self):
        result = self.measure("--noise", 2, 4, "--heights", 5, "--scenes", 2, "--pairs", 4)
        self.assertEqual(result.returncode, 0, result.stderr)
        with self.output.open() as file:
            rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
        # The first pair of a place may be without a plane.
        self.assertEqual([(row["noise"], row["height_m"], row["pairs"] + row["failed"]) for row in rows], [(2, 5, 8), (4, 5, 8)])
        for row in rows:
            self.assertLessEqual(row["failed"], 2)
            for name in QUANTITIES:
                bound, unknown = row[f"bound_{name}"], row[f"unknown_texture_bound_{name}"]
                # Who does not know the texture knows less, but at this noise nearly as much.
                self.assertGreater(unknown, bound)
                self.assertLess(unknown, 1.5 * bound)
                self.assertGreater(row[f"claimed_{name}"], bound)
                self.assertLess(row[f"claimed_{name}"], 3 * bound)
                # Of a few pairs; an error may be half of its standard deviation by chance.
                self.assertGreater(row[f"rms_{name}"], 0.5 * bound)
                self.assertLess(row[f"rms_{name}"], 3 * row[f"claimed_{name}"])
        for name in QUANTITIES:
            self.assertAlmostEqual(rows[1][f"bound_{name}"] / rows[0][f"bound_{name}"], 2, delta=1e-3)

    def test_wrong_usage_has_exit_status_2(self):
        for options in (["--noise", "0"], ["--heights", "0"], ["--scenes", "0"], ["--pairs", "0"]):
            with self.subTest(options=options):
                self.assertEqual(self.measure(*options).returncode, 2)
        self.assertEqual(run([PROGRAM]).returncode, 2)

    def test_an_output_that_cannot_be_written_is_named(self):
        self.output = self.folder / "nowhere/bound.csv"
        result = self.measure("--scenes", 1, "--pairs", 1)
        self.assertEqual(result.returncode, 1)
        self.assertIn(f"{self.output}: cannot be written", result.stderr)


if __name__ == "__main__":
    unittest.main()
