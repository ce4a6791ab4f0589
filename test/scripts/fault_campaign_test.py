"""scripts/fault_campaign: what it counts, and a short campaign without a misleading frame."""

import csv
import importlib.machinery
import importlib.util
import shutil
import sys
import tempfile
import unittest
from pathlib import Path

from project import BUILD_DIR, SOURCE_DIR, run

sys.path.insert(0, str(SOURCE_DIR / "scripts"))
from measurement import faults  # noqa: E402 (only there after the line before)

PROGRAM = BUILD_DIR / "devel/lib/uav_landing/inject_faults"


def output(name):
    return next(output for output in faults.OUTPUTS if output.name == name)


def row(name, **counts):
    numbers = dict(healthy=0, healthy_valid=0, healthy_uncertain=0, healthy_misleading=0, faulted=0, faulted_valid=0, misleading=0,
                   worst_level_ratio=0, worst_limit_ratio=0, time_to_alert_s=0, healthy_tests="")
    columns = ("healthy_known", "healthy_misleading", "known", "misleading", "worst_ratio", "time_to_alert_s")
    numbers.update({f"{output.name}_{column}": 0 for output in faults.OUTPUTS for column in columns})
    return {"faults": name, "source": "simulator", "seed": "1", **{key: str(value) for key, value in
                                                                  {**numbers, **counts}.items()}}


class CountsTest(unittest.TestCase):
    def test_bounds_are_those_of_clopper_and_pearson(self):
        # None of n: 1 - 0.05^(1 / n). One of 100: from tables.
        self.assertAlmostEqual(faults.upper_bound(0, 100), 1 - 0.05 ** 0.01, places=9)
        self.assertAlmostEqual(faults.upper_bound(1, 100), 0.0466, places=4)
        self.assertEqual(faults.upper_bound(5, 5), 1)

    def test_a_misleading_frame_is_a_problem_unless_nothing_could_have_seen_it(self):
        misled = dict(faulted=40, faulted_valid=40, misleading=3)
        self.assertEqual(faults.Campaign([row("baseline_8", **misled), row("dirt+baseline_2", **misled)]).problems(), [])
        self.assertIn("dirt: 3 misleading frames (dirt simulator 1)", faults.Campaign([row("dirt", **misled)]).problems())

    def test_a_misleading_angle_is_a_problem_also_where_nothing_could_have_seen_the_height(self):
        misled = dict(faulted=40, angle_known=20, angle_misleading=3, angle_worst_ratio=1.5)
        rows = [row("baseline_8", **misled), row("dirt", faulted=40), {**row("dirt", **misled), "seed": "2"}]
        self.assertEqual(faults.Campaign(rows).problems(), ["baseline_8: 3 misleading angles (baseline_8 simulator 1)",
                                                            "dirt: 3 misleading angles (dirt simulator 2)"])
        # Of 80 frames 20 are valid and 3 misled; at most 9.5 % with 95 %. Of two runs one misled: 1 - 0.05 = 97.5 % squared.
        self.assertRegex(faults.Campaign(rows).output_table(output("angle")), r"\n\| *dirt *\| *2 *\| *80 *\| *25% *\| *3 *\| *9.\d+% *\| *1 *\| "
                                                              r"*97.5% *\| *1.50 *\| *0.00 *\|")

    def test_angles_are_counted_only_where_they_are_known(self):
        misled = dict(faulted=40, angle_known=20, angle_misleading=3, healthy=9, healthy_valid=9,
                      angle_healthy_misleading=2)
        road = [{**row(name, **misled), "source": "kitti_road"} for name in ("none", "dirt")]
        self.assertEqual(faults.Campaign(road).problems(), [])
        self.assertNotIn("dirt", faults.Campaign(road).output_table(output("angle")))
        self.assertIn("2 misleading angles without a fault", faults.Campaign([row("none", **misled)]).problems())

    def test_a_misleading_yaw_is_a_problem_unless_nothing_could_have_seen_it(self):
        misled = dict(faulted=40, yaw_known=20, yaw_misleading=3, yaw_worst_ratio=1.5, yaw_time_to_alert_s=0.15)
        rows = [row("camera_info", **misled), row("camera_info+dirt", **misled), {**row("dirt", **misled), "source": "town"},
                {**row("none", healthy=9, yaw_healthy_known=6, yaw_healthy_misleading=2, healthy_valid=9), "source": "town"}]
        campaign = faults.Campaign(rows)
        self.assertEqual(campaign.problems(), ["2 misleading yaws without a fault", "dirt: 3 misleading yaws (dirt town 1)"])
        self.assertRegex(campaign.output_table(output("yaw")), r"\n\| *dirt *\| *1 *\| *40 *\| *50% *\| *3 *\|.*\| *1 *\| *100.0% *\| *1.50 *\| *0.15 *\|")
        self.assertNotIn("camera info", campaign.output_table(output("yaw")))
        self.assertIn("On the 9 frames of the runs without a fault it is available on 6, and 2 are misleading",
                      campaign.page("seed 1").replace("\n", " "))

    def test_healthy_frames_of_every_scenery_and_seed_count_and_those_of_a_dataset_once(self):
        rows = [{**row("none", healthy=10, healthy_valid=10), "source": source, "seed": seed}
                for source in ("simulator", "town", "lab") for seed in "12"]
        self.assertEqual(faults.Campaign(rows).healthy()[0], 50)

    def test_false_alarms_are_counted_on_healthy_runs_only_and_half_a_per_cent_is_too_much(self):
        rows = [row("none", healthy=1000, healthy_valid=996), row("dirt", healthy=1000, healthy_valid=0)]
        self.assertEqual(faults.Campaign(rows).problems(), [])
        self.assertEqual(faults.Campaign(rows + rows).healthy(), (1000, 4, 0), "the same frames do not count twice")
        rows[0]["healthy_valid"] = "994"
        self.assertEqual(faults.Campaign(rows).problems(), ["6 false alarms on 1000 healthy frames"])

    def test_a_height_that_is_not_valid_over_a_hill_is_no_false_alarm_and_a_wrong_one_counts(self):
        hills = {**row("none", healthy=50, healthy_valid=10, healthy_misleading=1), "source": "hills"}
        self.assertEqual(faults.Campaign([hills, row("none", healthy=100, healthy_valid=99)]).healthy(), (100, 1, 1))

    def test_what_is_too_uncertain_by_itself_is_no_false_alarm(self):
        rows = [row("none", healthy=1000, healthy_valid=900, healthy_uncertain=98)]
        self.assertEqual(faults.Campaign(rows).healthy(), (902, 2, 0))

    def test_each_tests_failures_on_healthy_frames_are_counted(self):
        rows = [row("none", healthy=50, healthy_valid=50, healthy_tests="tilt 40 1;innovation 50 0"),
                {**row("none", healthy=50, healthy_valid=50, healthy_tests="tilt 60 1"), "seed": "2"},
                row("dirt", healthy=50, healthy_valid=50, healthy_tests="tilt 60 60")]
        table = faults.Campaign(rows).false_alarms()
        self.assertRegex(table, r"`tilt` *\| *100 *\| *2 *\| *2.00%")
        self.assertRegex(table, r"`innovation` *\| *50 *\| *0 *\|")


class SummaryTest(unittest.TestCase):
    def test_counts_frames_and_runs_apart_from_what_nothing_can_tell(self):
        misled = dict(faulted=40, faulted_valid=40, misleading=3, angle_misleading=1)
        rows = [row("none", healthy=50, healthy_valid=46, healthy_uncertain=3), row("dirt", **misled), row("dirt", faulted=40), row("baseline_8", **misled),
                row("dirt+baseline_2", **misled), {**row("snow", **misled), "source": "kitti_road"}]
        summary = faults.Campaign(rows).summary().replace("\n  ", " ")
        self.assertIn("50 frames. On 3 the protection level is above the alert limit, so the height is not valid. On the other 47 there are 1 "
                      "false alarms and 0 misleading heights.", summary)
        self.assertIn("Approach angles with a fault**: 0 of 160 frames have it. 3 are misleading, in 3 runs.", summary)
        self.assertIn("200 frames in 5 runs. 12 are misleading, 6 of these by", summary)
        self.assertIn("The other 6 are in 2 runs.", summary)

    def test_both_pages_say_the_same(self):
        integrity, campaign = ((SOURCE_DIR / f"docs/{name}.md").read_text(encoding="utf-8")
                               for name in ("integrity", "integrity_campaign"))
        summary = integrity.split(faults.SUMMARY_BEGIN)[1].split(faults.SUMMARY_END)[0].strip()
        self.assertIn(summary, campaign)
        self.assertEqual(faults.renew_summary(integrity, summary + "\n"), integrity)
        self.assertIn("frames in", summary)


class SeedsTest(unittest.TestCase):
    def test_seeds_in_a_row_are_a_range(self):
        loader = importlib.machinery.SourceFileLoader("fault_campaign", str(SOURCE_DIR / "scripts/fault_campaign"))
        campaign = importlib.util.module_from_spec(importlib.util.spec_from_loader("fault_campaign", loader))
        loader.exec_module(campaign)
        rows = [{"source": "lab", "seed": str(seed)} for seed in (5, 1, 3, 2)]
        self.assertIn("seeds 1-3 5 (lab)", campaign.seeds(rows))


class ShortCampaignTest(unittest.TestCase):
    def test_faults_are_noticed_and_a_healthy_flight_is_valid(self):
        folder = Path(tempfile.mkdtemp(prefix="uav_landing_faults_"))
        self.addCleanup(shutil.rmtree, str(folder))
        names = "none,frozen_left,swapped,unsynchronised,overexposed,night,featureless,bent_roll_1,baseline_8"
        result = run([PROGRAM, "--csv", folder / "rows.csv", "--first", 3, "--count", 1, "--frames", 50, "--faults", names])
        self.assertEqual(result.returncode, 0, result.stderr)
        with (folder / "rows.csv").open() as file:
            rows = {row["faults"]: row for row in csv.DictReader(file)}
        self.assertEqual(list(rows), names.split(","))
        healthy = rows.pop("none")
        self.assertEqual((healthy["healthy"], healthy["healthy_valid"]), ("30", "30"))
        self.assertEqual(rows.pop("baseline_8")["misleading"], "30", "nothing can see the baseline's length")
        for name, faulted in rows.items():
            self.assertEqual(faulted["misleading"], "0", name)
            if name != "overexposed":  # what is not white shows the height as well
                self.assertLess(int(faulted["faulted_valid"]), int(faulted["faulted"]), name)
            self.assertLessEqual(float(faulted["time_to_alert_s"]), 0.35, name)

    def fly(self, *options):
        """Rows of a campaign of one flight by their faults."""
        return {row["faults"]: row for row in self.flights("--count", 1, *options)}

    def flights(self, *options):
        """Rows of a campaign."""
        return self.traced(*options)[0]

    def traced(self, *options):
        """Rows of a campaign and of all its frames."""
        folder = Path(tempfile.mkdtemp(prefix="uav_landing_faults_"))
        self.addCleanup(shutil.rmtree, str(folder))
        files = folder / "rows.csv", folder / "frames.csv"
        result = run([PROGRAM, "--csv", files[0], "--trace", files[1], *options])
        self.assertEqual(result.returncode, 0, result.stderr)
        tables = [list(csv.DictReader(file.open())) for file in files]
        for table in tables:
            for row in table:
                # A field too few is None, one too many has the name None.
                self.assertNotIn(None, [*row, *row.values()])
        return tables

    def test_ground_that_slopes_below_the_aircraft_does_not_mislead(self):
        row = self.fly("--first", 101, "--frames", 110, "--faults", "slope")["slope"]
        self.assertEqual(row["misleading"], "0")
        self.assertGreater(int(row["faulted_valid"]), 0.8 * int(row["faulted"]))

    def test_an_angle_does_not_mislead_by_a_turned_camera_or_a_period_of_a_pattern(self):
        rows = self.fly("--first", 31, "--frames", 110, "--faults", "none,swapped,bent_yaw_0.05,bent_yaw_0.2,repeated_pattern")
        self.assertEqual({name: (row["angle_misleading"], row["angle_healthy_misleading"]) for name, row in rows.items()},
                         {name: ("0", "0") for name in rows})
        self.assertEqual(rows["bent_yaw_0.05"]["angle_known"], rows["bent_yaw_0.05"]["faulted"])
        # Claimed as they are, not thrown away; but a camera turned so far is contradicted more and more on the way down.
        for name, share in (("swapped", 0.7), ("bent_yaw_0.2", 0.4)):
            self.assertGreater(int(rows[name]["angle_known"]), share * int(rows[name]["faulted"]), name)

    def test_a_turned_camera_is_contradicted_in_every_flight_and_misleads_no_height(self):
        # By ten times what a calibration is wrong by. In a single flight chance decides about half of the angles.
        rows, frames = self.traced("--first", 31, "--count", 8, "--frames", 110, "--faults", "bent_yaw_0.2")
        self.assertEqual([row["misleading"] for row in rows], ["0"] * 8)
        for row in rows:
            faulted = [frame for frame in frames if frame["seed"] == row["seed"] and frame["faulted"] == "1"]
            self.assertTrue(any(frame["failed_tests"] for frame in faulted), row["seed"])
        self.assertGreater(sum(int(row["angle_known"]) for row in rows), 0.2 * sum(int(row["faulted"]) for row in rows))

    def test_no_yaw_misleads_over_scenery_when_stereo_is_taken_away(self):
        names = "none,black_right,fogged_right,frozen_right,copied_right"
        for scenery in ("town", "fields"):
            rows = self.fly("--first", 2, "--frames", 50, "--scenery", scenery, "--faults", names)
            self.assertEqual(sorted(rows), sorted(names.split(",")))
            self.assertEqual(rows["none"]["yaw_healthy_known"], rows["none"]["healthy"])
            self.assertGreater(int(rows["fogged_right"]["yaw_known"]), 0, "by the left image")
            for name, row in rows.items():
                self.assertEqual(row["source"], scenery)
                self.assertEqual((row["yaw_misleading"], row["yaw_healthy_misleading"]), ("0", "0"), f"{name} {scenery}")

    def test_scenery_is_for_the_simulator_and_has_to_be_one_that_there_is(self):
        for options in (("--scenery", "desert"), ("--scenery", "town", "--dataset", "/tmp/none")):
            result = run([PROGRAM, "--csv", "/tmp/none.csv", *options])
            self.assertEqual(result.returncode, 2)
            self.assertIn("--scenery", result.stderr)

    def test_a_frozen_scene_does_not_mislead_under_noise(self):
        row = self.fly("--first", 1, "--frames", 60, "--faults", "none,frozen_both,noise", "--pairs", 4)["frozen_both+noise"]
        self.assertEqual(row["misleading"], "0")
        self.assertLess(int(row["faulted_valid"]), 0.3 * int(row["faulted"]))

    def test_an_unknown_fault_is_refused_by_its_name(self):
        result = run([PROGRAM, "--csv", "/tmp/none.csv", "--faults", "moon"])
        self.assertEqual(result.returncode, 1)
        self.assertIn("moon", result.stderr)
