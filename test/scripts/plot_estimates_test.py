import tempfile
import unittest
from pathlib import Path

import cv2
import numpy as np

from project import SOURCE_DIR, run

TRUTH = "stamp_s,left,right,height_m,approach_angle_deg\n" + "".join(
    f"{100 + 0.1 * i:.3f},{i}.png,{i}.png,{2 - 0.02 * i},{'' if i == 0 else 5}\n" for i in range(50))


def estimates(valid, height_error, gap=()):
    """As the truth but for the error; in the gap nothing is valid."""
    columns = "stamp_s,valid,height_m,height_stddev_m,height_valid,approach_angle_deg,approach_angle_stddev_deg,angle_valid"
    rows = []
    for i in range(50):
        ok = 0 if i in gap else valid
        rows.append(f"{100 + 0.1 * i:.3f},{ok},{2 - 0.02 * i + height_error},0.01,{ok},5.1,0.05,{ok}\n")
    return columns + "\n" + "".join(rows)


def widest_gap(picture):
    """Columns without red along the line of the height's error, which is constant."""
    blue, green, red = (picture[picture.shape[0] // 2:, :picture.shape[1] // 2, k].astype(int) for k in range(3))
    is_red = (red > 150) & (blue < 120) & (green < 120)
    line = is_red[is_red.sum(axis=1).argmax()]
    return np.diff(np.flatnonzero(line)).max()


def with_limits(text, level):
    """The estimates with a protection level and an alert limit of 0.15 m."""
    header, *rows = text.splitlines()
    return "\n".join([f"{header},height_protection_level_m,height_alert_limit_m", *(f"{row},{level},0.15" for row in rows)]) + "\n"


class PlotEstimatesTest(unittest.TestCase):
    def plot(self, name, text, truth=True):
        (self.folder / f"{name}.csv").write_text(text)
        result = run([SOURCE_DIR / "scripts/plot_estimates", *(["--truth", self.folder / "frames.csv"] if truth else []),
                      "--estimates", self.folder / f"{name}.csv", "--output", self.folder / f"{name}.png"])
        self.assertEqual(result.returncode, 0, result.stderr)
        return cv2.imread(str(self.folder / f"{name}.png"))

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        (self.folder / "frames.csv").write_text(TRUTH)

    def test_picture_shows_what_the_estimates_are(self):
        good = self.plot("good", estimates(valid=1, height_error=0))
        self.assertGreater(good.shape[1], 800)
        for name, text in (("wrong", estimates(valid=1, height_error=0.5)), ("invalid", estimates(valid=0, height_error=0))):
            with self.subTest(name):
                self.assertTrue((self.plot(name, text) != good).any())

    def test_no_error_is_drawn_where_nothing_is_valid(self):
        self.assertLess(widest_gap(self.plot("all", estimates(valid=1, height_error=0.5))), 5)
        self.assertGreater(widest_gap(self.plot("gap", estimates(valid=1, height_error=0.5, gap=range(20, 30)))), 40)

    def test_without_truth_the_estimates_are_drawn_with_how_far_they_may_be_off(self):
        text = estimates(valid=1, height_error=0)
        alone = self.plot("alone", with_limits(text, 0.05), truth=False)
        self.assertEqual(alone.shape, self.plot("good", text).shape)
        half, width = alone.shape[0] // 2, alone.shape[1] // 2
        other = self.plot("other", with_limits(text, 0.1), truth=False)
        self.assertTrue((alone[half:, :width] != other[half:, :width]).any(), "the protection level of the height")
        np.testing.assert_array_equal(alone[:half], other[:half], "the estimates themselves")
        np.testing.assert_array_equal(alone[half:, width + 40:], other[half:, width + 40:], "an angle has no level")
        invalid = self.plot("invalid", with_limits(estimates(valid=0, height_error=0), 0.05), truth=False)
        self.assertTrue((alone[half:, :width] != invalid[half:, :width]).any())

    def test_names_the_file_that_is_missing(self):
        result = run([SOURCE_DIR / "scripts/plot_estimates", "--truth", self.folder / "frames.csv",
                      "--estimates", self.folder / "nonsuch.csv", "--output", self.folder / "a.png"])
        self.assertEqual(result.returncode, 1)
        self.assertIn("nonsuch.csv", result.stderr)
