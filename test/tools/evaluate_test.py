"""Scores of evaluate on tables whose errors are known by hand, its messages and its report."""

import base64
import json
import os
import re
import shutil
import tempfile
import unittest
from pathlib import Path

import cv2
import numpy as np
from project import SOURCE_DIR, run

EVALUATE = SOURCE_DIR / "src/tools/evaluate"
FIREFOX = shutil.which("firefox-esr") or shutil.which("firefox")
PAGE_WIDTH = 992  # of the text and the images, px: 62 em
STAMPS = [0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0]  # scored: the last four


def write_csv(path, header, rows):
    lines = [",".join(header)] + [",".join("" if value is None else str(value) for value in row) for row in rows]
    path.write_text("\n".join(lines) + "\n")


class EvaluateTest(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="uav_landing_evaluate_"))
        self.addCleanup(shutil.rmtree, str(self.folder))
        self.truth, self.estimates = self.folder / "frames.csv", self.folder / "E.csv"

    def evaluate(self, *options):
        return run([EVALUATE, "--truth", self.truth, "--estimates", self.estimates, *options])

    def scores(self, *options):
        path = self.folder / "scores.json"
        result = self.evaluate("--json", path, *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(path.read_text())

    def write_example(self, truth_height=10.0):
        """Height errors of the scored frames: +0.1, -0.3, 0.2 and one that is not valid; angle errors 0.1, 0.2, -0.6."""
        write_csv(self.truth, ["stamp_s", "left", "right", "height_m", "approach_angle_deg"],
                  [[stamp, "a.png", "b.png", truth_height, 5] for stamp in STAMPS])
        header = ["stamp_s", "valid", "height_m", "height_stddev_m", "raw_height_m", "approach_angle_deg",
                  "approach_angle_stddev_deg", "raw_approach_angle_deg", "yaw_deg", "compute_ms"]
        rows = [[stamp, 1, 99, 0.1, 99, 99, 1, 99, 0, 4] for stamp in STAMPS[:3]]
        # Off by 0.4 ms: still the same frame.
        rows += [[1.5004, 1, 10.1, 0.1, 10.4, 5.1, 0.1, 5.5, 0, 4],
                 [2.0, 1, 9.7, 0.1, 9.6, 5.2, 0.1, 5.5, 0, 6],
                 [2.5, 0, 50, 0.1, None, None, None, None, None, 5],
                 [3.0, 1, 10.2, 0.1, 10.4, 4.4, 0.5, 5.5, 0, 5]]
        write_csv(self.estimates, header, rows)


class ScoresTest(EvaluateTest):
    def test_errors_are_those_of_the_valid_frames_after_the_first_second(self):
        self.write_example()
        scores = self.scores()
        self.assertEqual((scores["frames"], scores["scored_frames"], scores["valid_frames"]), (7, 4, 3))
        self.assertAlmostEqual(scores["coverage"], 0.75)
        height = scores["quantities"]["height"]
        self.assertAlmostEqual(height["mean"], 0.2)
        self.assertAlmostEqual(height["median"], 0.2)
        self.assertAlmostEqual(height["worst"], 0.3)
        self.assertAlmostEqual(height["signed_mean"], 0.0)
        # Sorted 0.1 0.2 0.3: 95 % lies nine tenths of the way from the second to the third.
        self.assertAlmostEqual(height["percentile_95"], 0.29)
        self.assertAlmostEqual(height["percent"]["worst"], 3.0)
        angle = scores["quantities"]["approach_angle"]
        self.assertAlmostEqual(angle["mean"], 0.3)
        self.assertAlmostEqual(angle["signed_mean"], -0.1)
        self.assertAlmostEqual(scores["quantities"]["raw_approach_angle"]["mean"], 0.5)
        self.assertAlmostEqual(scores["quantities"]["raw_height"]["worst"], 0.4)

    def test_scores_invalid_frames_on_request_and_keeps_the_coverage(self):
        self.write_example()
        scores = self.scores("--invalid-too")
        self.assertAlmostEqual(scores["quantities"]["height"]["worst"], 40.0)
        self.assertEqual(scores["quantities"]["height"]["frames"], 4)
        self.assertAlmostEqual(scores["coverage"], 0.75)

    def test_consistency_is_the_share_within_the_claimed_interval(self):
        self.write_example()
        scores = self.scores()
        # 1.96 sigma is 0.196 m: of 0.1, 0.3 and 0.2 one is inside. Angles: 0.1 of 0.196, 0.2 of 0.196, 0.6 of 0.98.
        self.assertAlmostEqual(scores["quantities"]["height"]["within_claimed_95"], 1 / 3)
        self.assertAlmostEqual(scores["quantities"]["approach_angle"]["within_claimed_95"], 2 / 3)

    def test_names_what_is_not_scored_and_why(self):
        self.write_example()
        scores = self.scores()
        self.assertEqual(scores["missing"]["yaw"], "the truth has no yaw_deg")
        result = self.evaluate()
        self.assertIn("not scored: the truth has no yaw_deg", result.stdout)
        self.assertIn("coverage 75.0 %", result.stdout)

    def test_frames_without_an_estimate_are_not_covered(self):
        self.write_example()
        lines = self.estimates.read_text().splitlines()
        self.estimates.write_text("\n".join(lines[:-1]) + "\n")
        scores = self.scores()
        self.assertEqual(scores["frames_without_estimate"], 1)
        self.assertAlmostEqual(scores["coverage"], 0.5)

    def test_yaw_errors_are_taken_around_the_circle(self):
        write_csv(self.truth, ["stamp_s", "yaw_deg"], [[0, 0], [2, 179.5]])
        write_csv(self.estimates, ["stamp_s", "valid", "height_m", "approach_angle_deg", "yaw_deg"],
                  [[0, 1, 1, 1, 0], [2, 1, 1, 1, -179.5]])
        self.assertAlmostEqual(self.scores()["quantities"]["yaw"]["worst"], 1.0)

    def test_blank_truth_is_not_scored(self):
        write_csv(self.truth, ["stamp_s", "height_m", "approach_angle_deg"], [[0, 1, None], [2, 1, None], [3, None, None]])
        write_csv(self.estimates, ["stamp_s", "valid", "height_m", "approach_angle_deg"],
                  [[0, 1, 1, 1], [2, 1, 1.5, 1], [3, 1, 7, 1]])
        scores = self.scores()
        self.assertEqual(scores["quantities"]["height"]["frames"], 1)
        self.assertEqual(scores["missing"]["approach_angle"], "the truth has no approach_angle_deg")


class MessagesTest(EvaluateTest):
    def assert_refused(self, *texts):
        result = self.evaluate()
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        for text in texts:
            self.assertIn(text, result.stderr)
        self.assertNotIn("Traceback", result.stderr)

    def test_missing_files(self):
        self.assert_refused(str(self.truth), "cannot be read")
        self.write_example()
        self.estimates.unlink()
        self.assert_refused(str(self.estimates), "cannot be read")

    def test_missing_columns(self):
        self.write_example()
        write_csv(self.estimates, ["stamp_s", "height_m"], [[0, 1]])
        self.assert_refused("E.csv: no column valid, approach_angle_deg (there are: stamp_s, height_m)")
        write_csv(self.truth, ["left", "height_m"], [["a", 1]])
        self.assert_refused("frames.csv: no column stamp_s")

    def test_truth_without_any_truth(self):
        self.write_example()
        write_csv(self.truth, ["stamp_s", "left"], [[0, "a.png"]])
        self.assert_refused("frames.csv: no truth", "height_m")

    def test_not_a_number(self):
        self.write_example()
        self.truth.write_text(self.truth.read_text().replace("2.5,", "soon,"))
        self.assert_refused('frames.csv, row 6, column stamp_s: "soon" is not a number')

    def test_row_of_another_length(self):
        self.write_example()
        with self.truth.open("a") as file:
            file.write("4.0,a.png\n")
        self.assert_refused("frames.csv, line 9: 2 fields, the header has 5")

    def test_empty_files(self):
        self.write_example()
        self.estimates.write_text("")
        self.assert_refused("E.csv: empty")
        write_csv(self.estimates, ["stamp_s", "valid", "height_m", "approach_angle_deg"], [])
        self.assert_refused("E.csv: no estimate")

    def test_a_bag_instead_of_a_table(self):
        self.write_example()
        self.truth.write_bytes(b"#ROSBAG V2.0\n\x96\xe3\x00")
        self.assert_refused("frames.csv: not text, expected a CSV file")

    def test_no_common_stamp(self):
        self.write_example()
        write_csv(self.estimates, ["stamp_s", "valid", "height_m", "approach_angle_deg"], [[500, 1, 1, 1]])
        self.assert_refused("no stamp of", "within 1 ms")

    def test_wrong_usage_has_exit_status_2(self):
        self.assertEqual(run([EVALUATE]).returncode, 2)
        self.assertEqual(run([EVALUATE, "--truth", "a", "--estimates", "b", "--nonsense"]).returncode, 2)
        self.assertEqual(run([EVALUATE, "--help"]).returncode, 0)
        self.assertEqual(run([EVALUATE, "--version"]).returncode, 0)


class ReportTest(EvaluateTest):
    def report(self, *options):
        folder = self.folder / "report"
        result = self.evaluate("--report", folder, *options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return folder, (folder / "index.html").read_text()

    def test_names_what_is_missing_without_report_data(self):
        self.write_example()
        folder, page = self.report()
        for name in ("figure6.png", "figure7.png", "errors.png", "consistency.png", "timeline.png"):
            # In the folder and, whole, in the page.
            self.assertIn(base64.b64encode((folder / name).read_bytes()).decode(), page)
        self.assertFalse((folder / "figure4.png").exists())
        missing = page[page.index("Missing"):]
        for title in ("Figure 4", "Figure 5", "Table 1"):
            self.assertIn(title, missing)

    def test_page_needs_no_other_file(self):
        self.write_example()
        _, page = self.report()
        sources = re.findall(r"(?:src|href)='([^']{1,30})", page)
        self.assertGreaterEqual(len(sources), 5)
        for source in sources:
            self.assertTrue(source.startswith("data:"), source)

    @unittest.skipUnless(FIREFOX, "needs a browser: firefox-esr")
    def test_browser_shows_every_picture_whole_and_in_order(self):
        self.write_example()
        folder, _ = self.report()
        screenshot = self.folder / "screenshot.png"
        result = run([FIREFOX, "--headless", "--no-remote", "--profile", self.folder, "--window-size=1200,4600",
                      "--screenshot", screenshot, (folder / "index.html").as_uri()],
                     env=dict(os.environ, HOME=str(self.folder)), timeout=240)
        self.assertTrue(screenshot.is_file(), result.stderr)
        page = cv2.imread(str(screenshot), cv2.IMREAD_GRAYSCALE)
        last = 0
        for name in ("figure6", "figure7", "errors", "consistency", "timeline"):
            picture = cv2.imread(str(folder / f"{name}.png"), cv2.IMREAD_GRAYSCALE)
            scale = PAGE_WIDTH / picture.shape[1]
            picture = cv2.resize(picture, (PAGE_WIDTH, int(round(scale * picture.shape[0]))), interpolation=cv2.INTER_AREA)
            # A difference of some px in height is the browser's rounding: blurred, it does not count.
            match = cv2.matchTemplate(cv2.blur(page, (5, 5)), cv2.blur(picture, (5, 5)), cv2.TM_CCOEFF_NORMED)
            _, score, _, (_, row) = cv2.minMaxLoc(match)
            self.assertGreater(score, 0.9, name)
            self.assertGreater(row, last, name)
            last = row + picture.shape[0] - 5
        self.assertTrue(np.all(page[-20:] == 255), "the page is longer than the screenshot")

    def test_names_the_distributions_that_cannot_be_drawn(self):
        self.write_example()
        write_csv(self.estimates, ["stamp_s", "valid", "height_m", "approach_angle_deg"],
                  [[stamp, 0, 1, 1] for stamp in STAMPS])
        folder, page = self.report()
        self.assertFalse((folder / "errors.png").exists())
        self.assertIn("Errors where height, or the angle, is valid: no valid frame has truth", page[page.index("Missing"):])
        self.assertTrue((folder / "timeline.png").is_file())

    def test_names_the_files_missing_from_report_data(self):
        self.write_example()
        data = self.folder / "data"
        data.mkdir()
        _, page = self.report("--report-data", data)
        missing = page[page.index("Missing"):]
        for text in ("lines_left_*.png", "matches_*.png", "timing.csv"):
            self.assertIn(text, missing)

    def test_table_1_has_the_rows_of_the_paper(self):
        self.write_example()
        data = self.folder / "data"
        data.mkdir()
        write_csv(data / "timing.csv", ["stamp_s", "rectify_ms", "corners_ms", "matching_ms", "kalman_filter_ms", "overlay_ms"],
                  [[0, 1.0, 4, 5, 0.5, 2.0], [1, 2.0, None, 5, None, 2.0], [2, 3.0, 5, 5, 1.0, 2.0]])
        _, page = self.report("--report-data", data)
        for title, mean, paper in (("Pre-process", "2.00", "3.4"), ("RANSAC", "0.00", "6.2"),
                                   ("Feature matching", "8.00", "11.9"), ("Kalman filter", "0.50", "1.2"),
                                   ("Image show", "2.00", "2.8"), ("Total", "12.50", "31.2")):
            self.assertIn(f"<td>{title}</td><td>{mean}</td><td>{paper}</td>", page)
        self.assertIn("<td>corners</td><td>4.50</td><td>4.50</td><td>4.99</td><td>5.00</td>", page)


if __name__ == "__main__":
    unittest.main()
