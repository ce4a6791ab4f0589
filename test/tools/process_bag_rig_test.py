"""Rigs and images that are not the usual ones: process_bag on one approach, told in other ways."""

import csv
import shutil
import tempfile
import unittest
from pathlib import Path

import numpy as np
import rosbag

from project import BUILD_DIR, run

PROGRAMS = BUILD_DIR / "devel/lib/uav_landing"
SIDES = ("left", "right")
SCENE = """image: {{width: 320, height: 240{image}}}
left_camera: {{fx: 280, fy: 280, cx: 159.5, cy: 119.5{lens}}}
right_camera: {{fx: 280, fy: 280, cx: 159.5, cy: 119.5{lens}}}
rig: {{stretch: {stretch}}}
path: {{duration: {duration}, rate: 20, start_height: 6, start_x: 60, glide_angle_deg: 4, flare_height: 0, pitch_deg: -6}}
"""


def pixels(image):
    return np.frombuffer(image.data, np.uint8).reshape(image.height, image.width)


def put(image, values, encoding="mono8"):
    values = np.ascontiguousarray(values)
    image.encoding, image.step, image.data = encoding, values.strides[0], values.tobytes()


class ProcessBagRigTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp(prefix="uav_landing_rig_"))
        cls.addClassCleanup(shutil.rmtree, str(cls.folder))
        cls.bag, cls.truth = cls.simulated("usual")
        cls.usual = cls.estimates(cls.bag)

    @classmethod
    def simulated(cls, name, lens="", stretch=0, image="", duration=0.6):
        config, bag = cls.folder / f"{name}.yaml", cls.folder / f"{name}.bag"
        config.write_text(SCENE.format(lens=lens, stretch=stretch, image=image, duration=duration))
        run([PROGRAMS / "simulate_approach", "--config", config, "--output", bag, "--dataset", cls.folder / name], check=True)
        with open(cls.folder / name / "frames.csv", encoding="utf-8") as file:
            return bag, list(csv.DictReader(file))

    @classmethod
    def estimates(cls, bag, rig=""):
        config, table = cls.folder / "config.yaml", cls.folder / "estimates.csv"
        config.write_text(f"rig: {{{rig}}}")
        cls.said = run([PROGRAMS / "process_bag", "--input", bag, "--csv", table, "--config", config], check=True).stderr
        with table.open() as file:
            return [{name: value for name, value in row.items() if name != "compute_ms"} for row in csv.DictReader(file)]

    def reasons(self, bag):
        result = self.folder / "result.bag"
        run([PROGRAMS / "process_bag", "--input", bag, "--output", result], check=True)
        with rosbag.Bag(str(result)) as messages:
            return [message.reason for topic, message, _ in messages.read_messages() if topic.endswith("/landing_estimate")]

    def changed(self, change, bag=None):
        """The bag with each pair's messages, {"left/image_raw": ...}, changed."""
        path = self.folder / "changed.bag"
        with rosbag.Bag(str(bag or self.bag)) as bag, rosbag.Bag(str(path), "w") as result:
            pairs = {}
            for topic, message, _ in bag.read_messages():
                if topic.startswith("/stereo/"):
                    pairs.setdefault(message.header.stamp, {})[topic[len("/stereo/"):]] = message
            for stamp, messages in sorted(pairs.items()):
                change(messages)
                for name, message in messages.items():
                    result.write(f"/stereo/{name}", message, stamp)
        return path

    def errors(self, rows, truth):
        """Errors of the valid heights, and what was claimed, m."""
        pairs = [(float(row["height_m"]) - float(true["height_m"]), float(row["height_stddev_m"]))
                 for row, true in zip(rows, truth) if row["height_valid"] == "1"]
        self.assertGreater(len(pairs), len(truth) - 5)
        return np.transpose(pairs)

    @staticmethod
    def turn_over(messages):
        """As the same cameras see it when they hang: calibrated so."""
        pictures = {side: pixels(messages[f"{side}/image_raw"])[::-1, ::-1] for side in SIDES}
        for side, other in zip(SIDES, SIDES[::-1]):
            put(messages[f"{side}/image_raw"], pictures[other])
            info = messages[f"{side}/camera_info"]
            K, P = list(info.K), list(info.P)
            K[2], K[5], P[2], P[6] = 319 - K[2], 239 - K[5], 319 - P[2], 239 - P[6]
            info.K, info.P = K, P

    def test_a_rig_upside_down_is_told_within_three_seconds(self):
        bag, _ = self.simulated("long", duration=3)
        reasons = self.reasons(self.changed(self.turn_over, bag))
        self.assertEqual(reasons[-1], "no_plane: what looks like the ground is above the horizon: if this stays, the cameras may be "
                         "mounted upside down: set rig/upside_down: true")

    def test_a_rig_upside_down_gives_the_same(self):
        bag = self.changed(self.turn_over)
        self.assertEqual({row["reason"] for row in self.estimates(bag)}, {"not_yet", "no_plane"})
        self.assertEqual(self.estimates(bag, "upside_down: true"), self.usual)
        self.assertEqual(self.said, "")

    def test_rows_of_a_rig_upside_down_have_their_times(self):
        self.bag, _ = self.simulated("rolling", image=", readout_time: 0.03, stamp_row: 0")
        upright = self.estimates(self.bag, "readout_time: 0.03, stamp_row: 0")
        # Its images come the other way up: the last row is the one that is exposed first.
        given = "upside_down: true, readout_time: -0.03, stamp_row: "
        hanging = self.changed(self.turn_over)
        for row, usual in zip(self.estimates(hanging, given + "1"), upright):
            self.assertEqual(row["height_valid"], usual["height_valid"])
            for name in ("height_m", "pitch_deg", "approach_angle_deg"):
                if usual[name]:
                    self.assertAlmostEqual(float(row[name]), float(usual[name]), places=5)
        wrong = self.estimates(hanging, given.replace("-", "") + "0")
        self.assertNotAlmostEqual(float(wrong[-1]["pitch_deg"]), float(upright[-1]["pitch_deg"]), places=2)

    def test_the_left_camera_need_not_be_the_origin(self):
        def change(messages):
            for side in SIDES:
                P = list(messages[f"{side}/camera_info"].P)
                P[3] += 28.0
                messages[f"{side}/camera_info"].P = P
        for row, usual in zip(self.estimates(self.changed(change)), self.usual):
            self.assertEqual(row["height_valid"], usual["height_valid"])
            if usual["height_m"]:
                self.assertAlmostEqual(float(row["height_m"]), float(usual["height_m"]), places=9)

    def test_bits_that_are_used_are_found_or_given(self):
        for name, fill, rig in (("10 bits", lambda grey: grey * 4, ""), ("14 bits", lambda grey: grey * 64, ""),
                                ("thermal", lambda grey: grey * 2 + 29000, ""), ("given", lambda grey: grey * 16, "bits: 12")):
            def change(messages):
                for side in SIDES:
                    image = messages[f"{side}/image_raw"]
                    put(image, fill(pixels(image).astype(np.uint16)), "mono16")
            with self.subTest(name):
                error, claimed = self.errors(self.estimates(self.changed(change), rig), self.truth)
                self.assertLess(np.abs(error).max(), 0.03)
                self.assertTrue((np.abs(error) < 3 * claimed).all(), error / claimed)

    def test_bits_that_are_given_and_exceeded_are_told_once(self):
        def change(messages):
            for side in SIDES:
                image = messages[f"{side}/image_raw"]
                put(image, pixels(image).astype(np.uint16) * 256, "mono16")
        self.estimates(self.changed(change), "bits: 12")
        self.assertEqual(self.said.count("rig/bits: 12: more than 1 % of an image's values are above 4095"), 1, self.said)

    def test_fisheye_lenses(self):
        bag, truth = self.simulated("fisheye", ", lens: equidistant, k1: -0.02, k2: 0.01, k3: -0.004, k4: 0.0005")
        error, claimed = self.errors(self.estimates(bag), truth)
        self.assertLess(np.abs(error).max(), 0.03)
        self.assertTrue((np.abs(error) < 3 * claimed).all(), error / claimed)

    def test_a_baseline_that_is_uncertain_is_so_in_the_claims_and_in_no_height(self):
        bag, truth = self.simulated("stretched", stretch=0.01)
        sure, unsure = self.estimates(bag), self.estimates(bag, "baseline_stddev: 0.01")
        self.assertEqual([row["height_m"] for row in unsure], [row["height_m"] for row in sure])
        error, claimed = self.errors(sure, truth)
        self.assertEqual(np.mean(np.abs(error) < 1.96 * claimed), 0)
        error, claimed = self.errors(unsure, truth)
        self.assertEqual(np.mean(np.abs(error) < 1.96 * claimed), 1)
        for row in unsure:
            if row["height_valid"] == "1":
                self.assertGreater(float(row["height_protection_level_m"]), 0.04 * float(row["height_m"]))


if __name__ == "__main__":
    unittest.main()
