"""scripts/accuracy: the tables of its sections, by numbers worked out here, and what it keeps."""

import importlib.machinery
import importlib.util
import math
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import numpy as np

from project import SOURCE_DIR

sys.path.insert(0, str(SOURCE_DIR / "scripts"))
from measurement import ablation, approaches, consistency, far, kept, markdown, noise, readme, sensors, sets, yaw  # noqa: E402


def cells(line):
    return [cell.strip() for cell in line.strip("|").split("|")]


class SetsTest(unittest.TestCase):
    def test_row_has_heights_in_centimetres_and_angles_in_degrees(self):
        scores = {"frames": 120, "coverage": 0.9917, "compute_ms": {"mean": 3.14159}, "quantities": {
            "height": {"mean": 0.0012, "median": 0.001, "percentile_95": 0.003, "worst": 0.0045, "within_claimed_95": 0.96},
            "approach_angle": {"mean": 0.05, "median": 0.04, "percentile_95": 0.12, "worst": 0.2, "signed_mean": -0.01,
                               "within_claimed_95": 0.9},
            "pitch": {"percentile_95": 0.0504}, "roll": {"percentile_95": 0.07},
            "speed": {"percentile_95": 0.0611, "within_claimed_95": 0.98}}}
        self.assertEqual(markdown.line(*sets.row("lab", scores)),
                         "| lab | 120 | 99.2% | 0.12 | 0.10 | 0.30 | 0.45 | 96% "
                         "| 0.050 | 0.040 | 0.120 | 0.200 | -0.010 | 90% | 0.050 | 0.070 | 0.061 | 98% | 3.1 |")

    def test_row_has_dashes_for_what_has_no_truth(self):
        row = sets.row("kitti_raw", {"frames": 30, "coverage": 0.5, "quantities": {
            "height": {"mean": 0.02, "median": 0.02, "percentile_95": 0.03, "worst": 0.04, "within_claimed_95": None}}})
        self.assertEqual(row, ["kitti_raw", 30, "50.0%", "2.00", "2.00", "3.00", "4.00"] + 12 * ["–"])
        self.assertEqual(len(row), len(sets.HEADER))


class MarkdownTest(unittest.TestCase):
    def test_table_refuses_a_row_of_another_length(self):
        with self.assertRaises(ValueError):
            markdown.table(("a", "b"), [["1"]])

    def test_table_has_a_line_for_the_header_the_rule_and_every_row(self):
        self.assertEqual(markdown.table(("a", "b"), [[1, 2]]), "| a | b |\n|---|---|\n| 1 | 2 |\n")


class AblationTest(unittest.TestCase):
    def test_row_fits_the_header_also_when_nothing_is_valid(self):
        self.assertEqual(ablation.row("x", {"coverage": 0.0, "quantities": {}}), ["x", "0.0%"] + 7 * ["–"])
        self.assertEqual(len(ablation.HEADER), 9)

    def test_every_variant_differs_from_the_default_in_its_own_file(self):
        with tempfile.TemporaryDirectory(prefix="uav_landing_accuracy_") as folder, \
                mock.patch.object(ablation, "WORK", Path(folder)):
            path = ablation.config_of({"approach_angle": {"refine_lines": False}}, 3)
            self.assertIn("refine_lines: false", path.read_text())


def approach_row(time, height, error, **values):
    row = {"seed": "1", "time_s": time, "valid": 1, "height_true_m": height, "height_m": height + error, "x_true_m": -100,
           "y_true_m": 1, "y_m": 1, "approach_angle_deg": 3, "approach_angle_true_deg": 3, "pitch_deg": 0,
           "pitch_true_deg": 0, "roll_deg": 0, "roll_true_deg": 0}
    row.update(values)
    return {name: str(value) for name, value in row.items()}


class ApproachesTest(unittest.TestCase):
    def test_heights_have_the_tolerance_of_their_band(self):
        # Below 30 m: 5 cm up to 10 m, then 0.5 %; from 30 to 60 m: 1 %.
        rows = [approach_row(2, 5, 0.049), approach_row(2, 5, 0.051), approach_row(2, 20, -0.099), approach_row(2, 20, 0.101),
                approach_row(2, 40, 0.39), approach_row(2, 40, 0.39), approach_row(2, 40, 0.39), approach_row(2, 40, 0.41)]
        scores = approaches.score(rows)
        self.assertEqual((scores["low"], scores["high"]), (0.5, 0.75))

    def test_lateral_offsets_have_a_tolerance_that_grows_with_the_distance(self):
        rows = [approach_row(2, 5, 0, x_true_m=-100, y_m=1.9), approach_row(2, 5, 0, x_true_m=10, y_m=1.2),
                approach_row(2, 5, 0, x_true_m=10, y_m=1.14), approach_row(2, 5, 0, y_m="")]
        scores = approaches.score(rows)
        self.assertAlmostEqual(scores["lateral"], 2 / 3)
        self.assertAlmostEqual(scores["lateral_known"], 3 / 4)

    def test_first_second_and_invalid_frames_are_not_scored(self):
        rows = [approach_row(1, 5, 1), approach_row(2, 5, 1, valid=0), approach_row(3, 5, 0)]
        scores = approaches.score(rows)
        self.assertEqual((scores["low"], scores["coverage"], scores["frames"]), (1.0, 0.5, 3))

    def test_lag_is_the_time_by_which_the_angle_comes_late(self):
        def flight(late, duration=20, off=0):
            return [approach_row(t, 20, 0, angle_valid=int(t > 3), approach_angle_deg=3 + off + math.sin(t - late),
                                 approach_angle_true_deg=3 + math.sin(t)) for t in np.arange(0, duration, 0.05)]
        self.assertAlmostEqual(approaches.lag_of(flight(0)), 0, 6)
        self.assertAlmostEqual(approaches.lag_of(flight(0.15)), 0.15, 2)
        self.assertAlmostEqual(approaches.lag_of(flight(0.15, off=0.3)), 0.15, 2)
        self.assertIsNone(approaches.lag_of(flight(2)))
        self.assertIsNone(approaches.lag_of(flight(0.15, 4)))

    def test_row_fits_the_header(self):
        scores = {**approaches.score([approach_row(2, 5, 0)]), "lag": None}
        self.assertEqual(len(approaches.line("1", scores)), len(approaches.HEADER))
        self.assertEqual(len(approaches.TARGET), len(approaches.HEADER))


class ConsistencyTest(unittest.TestCase):
    def test_wilson_interval_is_that_of_the_literature(self):
        # 81 of 263: 0.2553 to 0.3662 (Newcombe 1998, table I, score method).
        low, high = consistency.wilson(81, 263)
        self.assertAlmostEqual(low, 0.2553, 4)
        self.assertAlmostEqual(high, 0.3662, 4)

    def test_share_and_ratio_count_valid_rows_only(self):
        rows = [{"height_valid": valid, "height_m": str(10 + error), "height_true_m": "10", "height_stddev_m": "0.1"}
                for valid, error in (("1", 0.1), ("1", -0.19), ("1", 0.2), ("1", 0), ("0", 9))]
        scores = consistency.score(rows, "height", "m", "height_valid")
        self.assertEqual((scores["count"], scores["share"]), (4, 0.75))
        self.assertAlmostEqual(scores["ratio"], ((1 + 1.9 ** 2 + 4) / 4) ** 0.5)

    def test_nothing_valid_gives_no_score(self):
        self.assertIsNone(consistency.score([], "height", "m", "height_valid"))

    def test_page_has_a_row_for_every_cell_and_a_plot(self):
        scores = {"count": 4, "share": 0.75, "interval": [0.3, 0.95], "ratio": 1.25}
        cell = {"height": 3, "noise": 1, "flat_height": {**scores, "ratio": 0.5},
                "quantities": {name: scores for name, _, _ in consistency.QUANTITIES}}
        cell["quantities"]["y"] = None
        with tempfile.TemporaryDirectory(prefix="uav_landing_accuracy_") as folder, \
                mock.patch.object(consistency, "IMAGE", Path(folder) / "images" / "consistency.png"):
            text = consistency.render({"count": 4, "frames": 13, "cells": [cell, cell]})
            self.assertTrue(consistency.IMAGE.exists())
        rows = [line for line in text.splitlines() if line.startswith("| 3 m")]
        self.assertEqual(len(rows), 2)
        self.assertEqual(cells(rows[0]), ["3 m", "1", "4", "75.0 (30.0–95.0); 1.25", "4"] + 4 * ["75.0 (30.0–95.0); 1.25"]
                         + ["75.0 (30.0–95.0); 0.50", "–", "–"])

    def test_flat_ground_is_that_which_happens_not_to_bend_and_more(self):
        def fly(kind, begin, count, piece, jobs, *options):
            # Every third seed's ground bends at 3 m, every second one's elsewhere.
            return [{"seed": str(seed), "cell_height_m": str(height), "noise": str(level),
                     "slope_change_deg": "0.1" if "--bend" in options and seed % (3 if height == 3 else 2) == 0 else "0"}
                    for seed in range(begin, begin + count) for height in consistency.HEIGHTS for level in consistency.NOISE]

        with mock.patch.object(consistency, "fly", fly):
            bent, flat = consistency.flights(mock.Mock(snippets=12, jobs=1))
        self.assertEqual(len(bent), 12 * 9)
        for height, count in ((3, 14), (10, 12), (30, 12)):
            cell = [row["seed"] for row in flat if row["cell_height_m"] == str(height) and row["noise"] == "2"]
            self.assertEqual(len(cell), count)
            self.assertEqual(len(set(cell)), count)


class SensorsTest(unittest.TestCase):
    def test_every_sensor_has_a_row_for_each_height(self):
        flown = []

        def fly(kind, begin, count, piece, jobs, *options):
            flown.append(options)
            return [{"cell_height_m": str(height), "height_valid": str(seed % 2), "angle_valid": "0", "height_m": "10.1",
                     "height_true_m": "10", "height_stddev_m": "0.1", **{f"{name}_{unit}": "" for name, end, _ in consistency.QUANTITIES
                     if name != "height" for unit in (end, f"true_{end}", f"stddev_{end}")}}
                    for seed in range(count) for height in sensors.HEIGHTS]

        with tempfile.TemporaryDirectory(prefix="uav_landing_accuracy_") as folder, \
                mock.patch.object(kept, "WORK", Path(folder)), mock.patch.object(sensors, "fly", fly), \
                mock.patch.object(sensors, "flights", lambda: []):
            sensors.measure(mock.Mock(sensor_snippets=4, jobs=1))
            results = kept.recall("sensors")[1]
        self.assertEqual(len(results["rows"]), len(sensors.SENSORS) * len(sensors.HEIGHTS))
        self.assertTrue(all("--rolling-shutter" in options for options in flown))
        self.assertTrue(any("--vibration" in options and "--imu" in options for options in flown))
        lines = [cells(line) for line in sensors.render(results).splitlines()]
        self.assertIn(["rolling shutter", "3 m", "50%", "0%", "100.0 (34.2–100.0); 1.00"] + 4 * ["–"], lines)

    def test_a_flight_is_scored_after_its_first_second_where_it_is_valid(self):
        with tempfile.TemporaryDirectory(prefix="uav_landing_accuracy_") as folder:
            estimates, truth = Path(folder) / "estimates.csv", Path(folder) / "frames.csv"
            rows = ((5, 1, 9), (6, 1, 9), (6.5, 1, 0.1), (7, 1, -0.3), (7.5, 0, 9), (8, 1, 0.2))  # stamp, valid, error
            estimates.write_text(
                "stamp_s,valid,height_valid,height_m,height_stddev_m,angle_valid,approach_angle_deg,approach_angle_stddev_deg\n"
                + "".join(f"{stamp},0,{valid},{10 + error},0.1,0,,\n" for stamp, valid, error in rows), encoding="utf-8")
            truth.write_text("stamp_s,height_m,approach_angle_deg\n" + "".join(f"{stamp},10,3\n" for stamp, _, _ in rows),
                             encoding="utf-8")
            scores = sensors.score_flight(estimates, truth)
        self.assertEqual((scores["height"]["valid"], scores["height"]["within_claimed_95"]), (0.75, 1 / 3))
        self.assertAlmostEqual(scores["height"]["percent"]["mean"], 2.0)
        self.assertAlmostEqual(scores["height"]["percent"]["percentile_95"], 2.9)
        self.assertEqual(sensors.flight_row("vibration", "nothing", scores)[2:], ["75.0%", "2.90", "33%", "0.0%"] + 3 * ["–"])


class YawTest(unittest.TestCase):
    def row(self, error, stddev=0.1, height=10):
        return {"cell_height_m": str(height), "yaw_true_deg": "5", "yaw_deg": "" if error is None else str(5 + error),
                "yaw_stddev_deg": "" if error is None else str(stddev)}

    def test_known_yaws_are_scored_and_those_of_something_else_counted(self):
        # Errors of 1, 1.9, 2.1 and 80 claimed standard deviations.
        scores = yaw.score([self.row(error) for error in (0.1, -0.19, 0.21, -8, None, None)])
        self.assertEqual((scores["snippets"], scores["known"], scores["wrong"], scores["claims"]["share"]), (6, 4, 1, 0.5))
        self.assertAlmostEqual(scores["claims"]["ratio"], ((1 + 1.9 ** 2 + 2.1 ** 2 + 6400) / 4) ** 0.5)
        self.assertAlmostEqual(scores["errors"][-1], 8)
        self.assertEqual(yaw.score([self.row(359.8, 0.3)])["wrong"], 0, "once round")

    def test_one_degree_is_the_limit_of_another_direction(self):
        self.assertEqual([yaw.score([self.row(error)])["wrong"] for error in (0.99, 1.01, -1.01)], [0, 1, 1])

    def test_row_fits_the_header_also_when_none_is_known(self):
        self.assertEqual(yaw.line("3 m", yaw.score([self.row(None)])), ["3 m", 1, "0 (0%)"] + 4 * ["–"] + [0])
        cells = [["3 m", yaw.score([self.row(0.1), self.row(None)])], ["all", yaw.score([self.row(None)])]]
        text = yaw.render({"snippets": 2, "frames": 13, "cells": cells})
        self.assertIn("| 3 m | 2 | 1 (50%) | 100.0 (20.7–100.0); 1.00 | 0.100 | 0.100 | 0.100 | 0 |", text)


class FarTest(unittest.TestCase):
    def row(self, distance=2000, chart="1", height_error=None, x_error=None, known="0"):
        def estimate(name, truth, error, stddev):
            return {f"{name}_true_m": str(truth), f"{name}_m": "" if error is None else str(truth + error),
                    f"{name}_stddev_m": "" if error is None else str(stddev)}
        return {"chart": chart, "height_above_runway_known": known, **estimate("x", -distance, x_error, 50), **estimate("y", 3, None, 1),
                **estimate("height_above_runway", 100, height_error, 4)}

    def test_bands_end_at_their_nearer_distance(self):
        self.assertEqual([far.band_of(self.row(distance)) for distance in (4000, 2501, 2499, 700, 110, 90, -5)],
                         [2500, 2500, 1500, 300, 100, None, None])

    def test_errors_are_in_per_cent_of_height_and_distance(self):
        rows = [self.row(height_error=error, x_error=10 * error, known="1") for error in (2, -3, 9)] + [self.row()]
        scores = far.band_scores(rows)
        self.assertEqual(scores["known"], 0.75)
        self.assertEqual(scores["outputs"]["height_above_runway"], {"given": 0.75, "error": 9.0, "claimed": 2 / 3})
        self.assertEqual(scores["outputs"]["x"], {"given": 0.75, "error": 4.5, "claimed": 1.0})
        self.assertEqual(scores["outputs"]["y"], {"given": 0, "error": None, "claimed": None})

    def test_line_fits_the_header(self):
        line = far.line({"chart": False, "nearest": 1500, **far.band_scores([self.row(chart="0", height_error=5)])})
        self.assertEqual(len(line), len(far.HEADER))
        self.assertEqual(line[:6], ["none", "1.5 to 2.5", 1, "100%", "5.0", "100%"])
        self.assertEqual(line[-1], "0%")


class PageTest(unittest.TestCase):
    def test_sections_that_are_not_measured_stay_as_they_are(self):
        loader = importlib.machinery.SourceFileLoader("accuracy", str(SOURCE_DIR / "scripts/accuracy"))
        accuracy = importlib.util.module_from_spec(importlib.util.spec_from_loader("accuracy", loader))
        loader.exec_module(accuracy)
        before = (SOURCE_DIR / "docs/accuracy.md").read_text(encoding="utf-8")
        with tempfile.TemporaryDirectory(prefix="uav_landing_accuracy_") as folder, mock.patch.object(kept, "WORK", Path(folder)):
            self.assertEqual(accuracy.page(before), before)
            kept.keep("yaw", {"snippets": 1, "frames": 13, "cells": []})
            after = accuracy.page(before)
        sections = [dict(part.split("\n", 1) for part in text.split("\n## ")[1:]) for text in (before, after)]
        self.assertEqual({title for title in sections[1] if sections[0].get(title) != sections[1][title]}, {"Yaw over scenery"})


class ReadmeTest(unittest.TestCase):
    def page(self, name):
        return (SOURCE_DIR / name).read_text(encoding="utf-8")

    def test_numbers_are_those_of_accuracy_and_performance(self):
        pages = [self.page(name) for name in ("README.md", "docs/accuracy.md", "docs/performance.md")]
        self.assertEqual(readme.renew(*pages), pages[0], "Renew them: scripts/accuracy --page")
        self.assertGreaterEqual(pages[0].count("% |"), 5)

    def test_each_number_comes_from_its_column(self):
        accuracy = ("### Default preset\n\n| set | frames |\n|---|---|\n"
                    "| lab | 120 | 99.0% | 1 | 2 | 3 | 4 | 5% | 6 | 7 | 8 | 9 | 10 |\n\n### Next\n| lab | 0 |\n")
        performance = "# Performance\n| frames | ms |\n|---|---|\n| simulated 640x480 | 11 |\n| simulated 1280x960 | 12 |\n"
        text = readme.render(accuracy, performance)
        self.assertIn("| 99.0% | 1 | 3 | 4 | 6 | 8 |", text)
        self.assertIn("11 ms of one core of an AMD EPYC at 640x480, and 12 ms at 1280x960", text)

    def test_readme_is_short(self):
        self.assertLessEqual(len(self.page("README.md").splitlines()), 150)


class NoiseTest(unittest.TestCase):
    def test_ratio_is_error_over_bound(self):
        row = {"height_m": 10.0, "noise": 2.0, "pairs": 48.0}
        for name, _, _ in noise.QUANTITIES:
            row.update({f"rms_{name}": 0.03, f"bound_{name}": 0.02, f"unknown_texture_bound_{name}": 0.024,
                        f"claimed_{name}": 0.025})
        with tempfile.TemporaryDirectory(prefix="uav_landing_accuracy_") as folder, \
                mock.patch.object(noise, "IMAGE", Path(folder) / "noise.png"):
            text = noise.render([row])
        self.assertEqual(cells(text.splitlines()[-1])[:7], ["10 m", "2", "48", "3", "2", "1.50 (1.25)", "2.5"])


class KeptTest(unittest.TestCase):
    def test_results_come_back_with_their_date(self):
        with tempfile.TemporaryDirectory(prefix="uav_landing_accuracy_") as folder, \
                mock.patch.object(kept, "WORK", Path(folder)):
            self.assertIsNone(kept.recall("sets"))
            kept.keep("sets", {"a": [1, None]})
            date, results = kept.recall("sets")
        self.assertRegex(date, r"^\d{4}-\d\d-\d\d \d\d:\d\d$")
        self.assertEqual(results, {"a": [1, None]})
