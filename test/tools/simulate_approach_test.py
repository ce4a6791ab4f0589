"""simulate_approach: bag and dataset folder hold the same approach, and a bad configuration says what is wrong."""

import csv
import math
import shutil
import tempfile
import unittest
from pathlib import Path

import numpy as np
import rosbag
import yaml

from project import BUILD_DIR, SOURCE_DIR, run

PROGRAMS = BUILD_DIR / "devel/lib/uav_landing"
LAB = SOURCE_DIR / "config/simulator/lab.yaml"


def messages(path):
    """All messages of a bag as topic and serialised content."""
    with rosbag.Bag(str(path)) as bag:
        return [(topic, raw[1]) for topic, raw, _ in bag.read_messages(raw=True)]


class SimulateApproachTest(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="uav_landing_simulate_approach_"))
        self.addCleanup(shutil.rmtree, str(self.folder))
        self.bag = self.folder / "out.bag"

    def simulate(self, config, *options, output=None):
        return run([PROGRAMS / "simulate_approach", "--config", config, "--output", output or self.bag, *options])

    def simulate_short(self, *options, output=None):
        result = self.simulate(LAB, "--duration", 0.2, *options, output=output)
        self.assertEqual(result.returncode, 0, result.stderr)

    def assert_refused(self, result, *texts):
        """Exit status 1, a message with these texts, and nothing left behind."""
        self.assertEqual(result.returncode, 1, result.stderr)
        for text in texts:
            self.assertIn(text, result.stderr)
        self.assertEqual([path.name for path in self.folder.iterdir() if path.suffix != ".yaml"], [])


class OutputTest(SimulateApproachTest):
    def test_every_scene_flies_to_its_end_and_is_listed(self):
        scenes = sorted((SOURCE_DIR / "config/simulator/scenes").glob("*.yaml"))
        listed = (SOURCE_DIR / "config/simulator/scenes/README.md").read_text()
        self.assertGreater(len(scenes), 5)
        for scene in scenes:
            with self.subTest(scene=scene.name):
                self.assertIn(f"`{scene.name}`", listed)
                config = yaml.safe_load(scene.read_text())
                config.setdefault("path", {})["rate"] = 0.25
                seldom = self.folder / scene.name
                seldom.write_text(yaml.safe_dump(config))
                dataset = self.folder / scene.stem
                result = self.simulate(seldom, "--dataset", dataset, output=self.folder / f"{scene.stem}.bag")
                self.assertEqual(result.returncode, 0, result.stderr)
                with open(dataset / "frames.csv", newline="") as file:
                    heights = [float(row["height_m"]) for row in csv.DictReader(file)]
                self.assertGreater(heights[0], 3 * heights[-1])

    def test_every_pair_has_its_calibration_and_truth(self):
        self.simulate_short()
        topics = [topic for topic, _ in messages(self.bag)]
        self.assertEqual({topic: topics.count(topic) for topic in topics},
                         {"/stereo/left/image_raw": 3, "/stereo/left/camera_info": 3, "/stereo/right/image_raw": 3,
                          "/stereo/right/camera_info": 3, "/truth/landing_estimate": 3})

    def test_an_inertial_sensor_flies_along_when_asked_for(self):
        config = yaml.safe_load(LAB.read_text())
        config["imu"] = {"rate": 50, "attitude_noise_deg": 0, "gyro_noise_deg": 0, "pitch_error_deg": 1}
        with_imu = self.folder / "imu.yaml"
        with_imu.write_text(yaml.safe_dump(config))
        result = self.simulate(with_imu, "--duration", 0.2)
        self.assertEqual(result.returncode, 0, result.stderr)
        with rosbag.Bag(str(self.bag)) as bag:
            imu = [message for _, message, _ in bag.read_messages("/imu/data")]
            mounting = [message for _, message, _ in bag.read_messages("/tf_static")]
            truth = [message for _, message, _ in bag.read_messages("/truth/landing_estimate")]
        self.assertEqual([round(message.header.stamp.to_sec(), 6) for message in imu],
                         [round(100 + 0.02 * i, 6) for i in range(11)])
        self.assertEqual(len(mounting), 1)
        self.assertEqual((mounting[0].transforms[0].header.frame_id, mounting[0].transforms[0].child_frame_id),
                         ("stereo_left_optical_frame", imu[0].header.frame_id))
        # The forward axis rises by the pitch; the sensor says one degree more.
        q = imu[0].orientation
        rise = math.degrees(math.asin(2 * (q.x * q.z - q.w * q.y)))
        self.assertAlmostEqual(rise - math.degrees(truth[0].pitch), 1, delta=0.02)

    def test_the_dataset_folder_holds_what_the_bag_holds(self):
        self.simulate_short("--dataset", self.folder / "set")
        again = self.folder / "again.bag"
        converted = run([PROGRAMS / "dataset_to_bag", "--dataset", self.folder / "set", "--output", again])
        self.assertEqual(converted.returncode, 0, converted.stderr)
        self.assertEqual(len(messages(self.bag)), len(messages(again)))
        with rosbag.Bag(str(self.bag)) as first, rosbag.Bag(str(again)) as second:
            for (topic, message, stamp), (other_topic, other, other_stamp) in zip(first.read_messages(),
                                                                                 second.read_messages()):
                self.assertEqual((topic, stamp), (other_topic, other_stamp))
                if topic.endswith("landing_estimate"):
                    for field in ("height", "approach_angle", "pitch", "roll", "yaw", "vertical_speed"):
                        np.testing.assert_allclose(getattr(message, field), getattr(other, field), rtol=1e-10)
                    np.testing.assert_allclose(message.foe, other.foe, rtol=1e-10)
                    np.testing.assert_allclose(message.velocity, other.velocity, atol=1e-10)
                else:
                    self.assertEqual(message, other)

    def test_truth_of_the_laboratory(self):
        self.simulate_short("--dataset", self.folder / "set")
        with (self.folder / "set/frames.csv").open() as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([row["stamp_s"] for row in rows], ["100.000000000", "100.100000000", "100.200000000"])
        self.assertEqual(rows[0]["approach_angle_deg"], "")
        # 0.5612 m/s at 12 degrees from 2 m.
        self.assertAlmostEqual(float(rows[2]["height_m"]), 2 - 0.2 * 0.5612 * math.sin(math.radians(12)), 9)
        self.assertAlmostEqual(float(rows[2]["approach_angle_deg"]), 12, 6)
        self.assertAlmostEqual(float(rows[2]["speed_m_s"]), 0.5612, 9)

    def test_seed_decides_about_every_byte(self):
        other, same = self.folder / "other.bag", self.folder / "same.bag"
        self.simulate_short("--seed", 5)
        self.simulate_short("--seed", 5, output=same)
        self.simulate_short("--seed", 6, output=other)
        self.assertEqual(messages(self.bag), messages(same))
        self.assertNotEqual(messages(self.bag), messages(other))

    def test_another_namespace(self):
        self.simulate_short("--camera", "front")
        self.assertIn("/front/left/image_raw", [topic for topic, _ in messages(self.bag)])


class BadInputTest(SimulateApproachTest):
    def simulate_with(self, yaml):
        config = self.folder / "my.yaml"
        config.write_text(yaml)
        return self.simulate(config)

    def test_missing_config(self):
        self.assert_refused(self.simulate("/nowhere.yaml"), "/nowhere.yaml: no such file")

    def test_bad_configs_are_named_with_file_and_key(self):
        for yaml, message in (
                ("rig: {bx: 1}", "rig/bx: no such parameter"),
                ("rigg: {x: 1}", "rigg: no such section; did you mean rig?"),
                ("rig: {x: 0}", "rig/x: 0 is out of range, expected 0.001 to 100 m"),
                ("rig: {x: .nan}", "rig/x: nan is out of range"),
                ("image: {width: 64.5}", "image/width: '64.5' is not a whole number"),
                ("path: [1, 2]", "path: expected a map"),
                ("path: {speed: 1, speed: 2}", "path/speed: is given twice"),
                ("path: {start_height: 1, heave: 0}", "path/heave: no such parameter"),
                ("path: {duration: 60, flare_height: 0}", "path/duration: a camera touches the ground after"),
                ("left_camera: {k1: -1, fx: 200, fy: 200}", "left_camera/k1: the lens's distortion folds back"),
                ("rig: {x: 0.001, y: 10}", "rig: the cameras stand too far out of line"),
                ("path: {", "my.yaml:")):
            with self.subTest(yaml=yaml):
                self.assert_refused(self.simulate_with(yaml), "my.yaml", message)

    def test_a_dataset_folder_with_something_in_it_is_left_alone(self):
        dataset = self.folder / "set"
        dataset.mkdir()
        (dataset / "mine.txt").write_text("keep")
        result = self.simulate(LAB, "--duration", 0, "--dataset", dataset)
        self.assertEqual(result.returncode, 1)
        self.assertIn(f"{dataset}: cannot be written: there is something already", result.stderr)
        self.assertEqual([path.name for path in self.folder.iterdir()], ["set"])
        self.assertEqual((dataset / "mine.txt").read_text(), "keep")

    def test_outputs_that_cannot_be_written(self):
        nowhere = self.folder / "nowhere"
        self.assert_refused(self.simulate(LAB, output=nowhere / "a.bag"), str(nowhere))
        self.assert_refused(self.simulate(LAB, "--dataset", nowhere / "set"), str(nowhere), "cannot be written")

    def test_wrong_usage_has_exit_status_2(self):
        for options in ([], ["--config", LAB], ["--config", LAB, "--output", self.bag, "--seed", "-1"],
                        ["--config", LAB, "--output", self.bag, "--duration", "long"]):
            with self.subTest(options=options):
                self.assertEqual(run([PROGRAMS / "simulate_approach", *options]).returncode, 2)


if __name__ == "__main__":
    unittest.main()
