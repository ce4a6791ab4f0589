"""A short soak, and whether the soak can tell a leak."""

import importlib.machinery
import importlib.util
import shutil
import tempfile
import unittest
from pathlib import Path

from project import SOURCE_DIR, run

SOAK = SOURCE_DIR / "scripts/soak"


def load_soak():
    loader = importlib.machinery.SourceFileLoader("soak", str(SOAK))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("soak", loader))
    loader.exec_module(module)
    return module


class SoakTest(unittest.TestCase):
    def test_growth_is_that_of_the_line_after_the_warm_up(self):
        soak = load_soak()
        warm_up = [(t, 50 + 2 * t) for t in range(20)]
        level = warm_up + [(t, 90 + (t % 3)) for t in range(20, 100)]
        self.assertLess(abs(soak.growth(level)), 0.002)
        leaking = warm_up + [(t, 90 + 0.1 * (t - 20)) for t in range(20, 100)]
        self.assertAlmostEqual(soak.growth(leaking), 7.9 / 90, delta=0.005)

    def test_memory_stays_for_a_short_while(self):
        folder = tempfile.mkdtemp(prefix="uav_landing_soak_test_")
        self.addCleanup(shutil.rmtree, folder)
        result = run([SOAK, "--output", folder, "--offline", "8", "--nodelets", "25", "--limit", "10"])
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertIn("| offline |", result.stdout)
        self.assertIn("| nodelets |", result.stdout)
        self.assertTrue((Path(folder) / "soak.png").stat().st_size > 0)


if __name__ == "__main__":
    unittest.main()
