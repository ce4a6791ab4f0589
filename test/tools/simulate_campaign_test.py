"""simulate_campaign: rows of truth beside estimates, the same for a seed whatever is flown besides."""

import csv
import shutil
import tempfile
import unittest
from pathlib import Path

from project import BUILD_DIR, run

PROGRAM = BUILD_DIR / "devel/lib/uav_landing/simulate_campaign"


class SimulateCampaignTest(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="uav_landing_simulate_campaign_"))
        self.addCleanup(shutil.rmtree, str(self.folder))

    def fly(self, *options, frames=5):
        rows = self.folder / "rows.csv"
        result = run([PROGRAM, "snippets", "--csv", rows, "--frames", frames, *options])
        self.assertEqual(result.returncode, 0, result.stderr)
        with rows.open() as file:
            return [{name: value for name, value in row.items() if name != "compute_ms"} for row in csv.DictReader(file)]

    def test_a_row_for_every_seed_height_and_noise_with_an_estimate_near_the_truth(self):
        rows = self.fly("--first", 4, "--count", 2, "--heights", 3, 10, "--noise", 1, 2)
        self.assertEqual([(row["seed"], row["cell_height_m"], row["noise"], row["frame"]) for row in rows],
                         [(seed, height, noise, "4") for seed in "45" for height in ("3", "10") for noise in "12"])
        for row in rows:
            self.assertAlmostEqual(float(row["height_true_m"]), float(row["cell_height_m"]), delta=0.11)
            self.assertAlmostEqual(float(row["height_m"]) / float(row["height_true_m"]), 1, delta=0.02)
            self.assertAlmostEqual(float(row["roll_deg"]), float(row["roll_true_deg"]), delta=0.3)
            self.assertGreater(float(row["height_stddev_m"]), 0)

    def test_a_seed_flies_the_same_whatever_is_flown_besides(self):
        together = self.fly("--first", 4, "--count", 2, "--heights", 3, "--noise", 1, 2)
        self.assertEqual(self.fly("--first", 5, "--count", 1, "--heights", 3, "--noise", 2), together[3:])

    def test_calibration_errors_follow_the_config(self):
        config = self.folder / "exact.yaml"
        config.write_text("stereo_depth: {disparity_bias_stddev: 0, row_bias_stddev: 0}\n"
                          "kalman_height: {height_model_error: 0}\n")
        options = ("--first", 4, "--count", 1, "--heights", 3, "--noise", 1)
        names = ("stretch", "bend_rx_deg", "bend_ry_deg", "bend_rz_deg", "lens_rows_px", "lens_tilt_deg")
        usual, exact_rig = self.fly(*options)[0], self.fly(*options, "--config", config)[0]
        self.assertNotIn(0, [float(usual[name]) for name in names])
        self.assertEqual([float(exact_rig[name]) for name in names], [0] * 6)

    def test_an_inertial_sensor_shows_in_the_estimates_and_nowhere_else(self):
        config = self.folder / "perfect.yaml"
        config.write_text("approach_angle: {imu_attitude_stddev_deg: 0.01, runway_slope_stddev_deg: 0}\n")
        options = ("--first", 4, "--count", 1, "--heights", 30, "--noise", 2, "--config", config)
        without, with_imu = self.fly(*options)[0], self.fly(*options, "--imu")[0]
        self.assertEqual(with_imu["pitch_true_deg"], without["pitch_true_deg"])
        self.assertLess(float(with_imu["pitch_stddev_deg"]), 0.5 * float(without["pitch_stddev_deg"]))
        self.assertLess(abs(float(with_imu["pitch_deg"]) - float(with_imu["pitch_true_deg"])), 0.04)

    def test_ground_bends_under_the_same_height(self):
        options = ("--first", 1, "--count", 6, "--heights", 10, "--noise", 2)
        flat, bent = self.fly(*options), self.fly(*options, "--bend")
        heights = [(float(a["height_true_m"]), float(b["height_true_m"])) for a, b in zip(flat, bent)]
        self.assertTrue(any(abs(a - b) > 1e-9 for a, b in heights), "none of six bends")
        for a, b in heights:
            self.assertAlmostEqual(a, b, delta=0.05)
        refused = run([PROGRAM, "approaches", "--csv", self.folder / "rows.csv", "--bend"])
        self.assertEqual(refused.returncode, 2)
        self.assertIn("--bend: for snippets only", refused.stderr)

    def test_scenery_shows_in_the_estimates_and_changes_no_truth(self):
        options = ("--first", 1, "--count", 3, "--heights", 10, "--noise", 2)
        bare, with_scenery = self.fly(*options), self.fly(*options, "--scenery")
        for a, b in zip(bare, with_scenery):
            self.assertEqual([value for name, value in a.items() if "_true_" in name],
                             [value for name, value in b.items() if "_true_" in name])
            self.assertNotEqual(a["height_m"], b["height_m"])

    def test_rolling_shutter_and_vibration_show_in_the_estimates_and_in_their_columns(self):
        options = ("--first", 1, "--count", 2, "--heights", 10, "--noise", 2)
        plain, rolling = self.fly(*options), self.fly(*options, "--rolling-shutter")
        shaken = self.fly(*options, "--rolling-shutter", "--vibration")
        for at_once, rows, both in zip(plain, rolling, shaken):
            self.assertEqual((float(at_once["readout_time_s"]), float(at_once["vibration_deg"])), (0, 0))
            self.assertGreaterEqual(abs(float(rows["readout_time_s"])), 0.005)
            self.assertGreater(float(both["vibration_deg"]), 0)
            self.assertEqual(both["readout_time_s"], rows["readout_time_s"])
            self.assertEqual([value for name, value in at_once.items() if "_true_" in name],
                             [value for name, value in rows.items() if "_true_" in name], "the truth is that of the stamp")
            self.assertNotEqual(at_once["pitch_true_deg"], both["pitch_true_deg"])
            self.assertNotEqual(at_once["height_m"], rows["height_m"])

    def yaw_error(self, seed, height):
        """Error over scenery and its claim, deg; None where the yaw is not known."""
        row = self.fly("--first", seed, "--count", 1, "--heights", height, "--noise", 2, "--scenery", frames=7)[0]
        if not row["yaw_deg"]:
            return None
        return abs(float(row["yaw_deg"]) - float(row["yaw_true_deg"])), float(row["yaw_stddev_deg"])

    def test_a_field_far_off_the_path_and_a_lone_road_are_not_taken_for_a_distant_runway(self):
        for seed, height in ((25, 60), (66, 60)):
            known = self.yaw_error(seed, height)
            self.assertTrue(known is None or known[0] < 1, f"{seed}: {known}")

    def test_lines_of_a_field_beside_the_runway_do_not_pull_at_its_yaw(self):
        error, stddev = self.yaw_error(25, 30)
        self.assertLess(error, max(0.05, 5 * stddev))

    def test_a_far_approach_is_flown_with_the_chart_and_without(self):
        rows = self.folder / "rows.csv"
        refused = run([PROGRAM, "far", "--csv", rows, "--imu"])
        self.assertEqual(refused.returncode, 2)
        self.assertIn("--imu: for snippets and approaches only", refused.stderr)
        result = run([PROGRAM, "far", "--csv", rows, "--first", 4, "--count", 1, "--noise", 2, "--frames", 12, "--chart"])
        self.assertEqual(result.returncode, 0, result.stderr)
        with rows.open() as file:
            flown = list(csv.DictReader(file))
        self.assertEqual([(row["frame"], row["chart"]) for row in flown], [(str(i), chart) for i in range(12) for chart in "01"])
        for row in flown:
            self.assertLess(float(row["x_true_m"]), -2900)
        last = {row["chart"]: row for row in flown[-2:]}
        self.assertEqual(last["0"]["height_above_runway_m"], "", "nothing tells the scale")
        self.assertLess(abs(float(last["1"]["height_above_runway_m"]) - float(last["1"]["height_above_runway_true_m"])),
                        3 * float(last["1"]["height_above_runway_stddev_m"]))

    def test_bad_config_is_refused_with_its_name(self):
        result = run([PROGRAM, "snippets", "--csv", self.folder / "rows.csv", "--config", self.folder / "none.yaml"])
        self.assertEqual(result.returncode, 1)
        self.assertIn("none.yaml", result.stderr)
        self.assertFalse((self.folder / "rows.csv").exists())
