#!/usr/bin/python3
import csv
import math
import subprocess
import tempfile
import time
import unittest
from pathlib import Path

import rosbag
import rospy
import rostest
from sensor_msgs.msg import CameraInfo
from uav_landing.msg import LandingEstimate

RECORDER = Path(__file__).resolve().parents[2] / "scripts/record_estimates"
STAMPS = [rospy.Time(100), rospy.Time(100, 100000000)]


def estimate(stamp, height):
    message = LandingEstimate(status=LandingEstimate.TRACKING, valid=True, height_valid=True, angle_valid=True)
    message.header.stamp = stamp
    message.height = height
    message.height_variance = 1e-4
    message.approach_angle = math.radians(5)
    message.yaw = math.nan
    return message


class RecordEstimatesTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.bag, self.csv = Path(folder.name) / "a.bag", Path(folder.name) / "a.csv"
        with rosbag.Bag(str(self.bag), "w") as bag:
            for stamp in STAMPS:
                info = CameraInfo()
                info.header.stamp = stamp
                bag.write("/stereo/left/camera_info", info, stamp)

    def start(self, *options):
        process = subprocess.Popen([str(RECORDER), "--bag", str(self.bag), "--output", str(self.csv), *options],
                                   stderr=subprocess.PIPE, universal_newlines=True)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def test_a_file_that_is_no_bag_is_named(self):
        self.bag.write_text("no bag")
        process = self.start()
        self.assertEqual(process.wait(timeout=30), 1)
        self.assertIn(f"{self.bag}: cannot be read as a bag", process.stderr.read())

    def test_fails_when_no_estimate_comes(self):
        process = self.start("--deadline", "1")
        self.assertEqual(process.wait(timeout=30), 1)
        self.assertIn("no landing estimate within 1 s", process.stderr.read())
        self.assertFalse(self.csv.exists())

    def test_writes_one_row_per_image_pair_and_ends_after_the_last(self):
        publisher = rospy.Publisher("/uav_landing/landing_estimate", LandingEstimate, queue_size=10)
        process = self.start("--deadline", "30")
        deadline = time.monotonic() + 30
        while publisher.get_num_connections() == 0 and time.monotonic() < deadline:
            time.sleep(0.05)
        publisher.publish(estimate(rospy.Time(99), 9.0))  # of no image: what is said while none comes
        for stamp, height in zip(STAMPS, (2.0, 1.9)):
            publisher.publish(estimate(stamp, height))
        self.assertEqual(process.wait(timeout=30), 0)
        with self.csv.open() as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([row["stamp_s"] for row in rows], ["100.000000000", "100.100000000"])
        self.assertEqual([float(row["height_m"]) for row in rows], [2.0, 1.9])
        self.assertAlmostEqual(float(rows[0]["height_stddev_m"]), 0.01)
        self.assertAlmostEqual(float(rows[0]["approach_angle_deg"]), 5)
        self.assertEqual((rows[0]["yaw_deg"], rows[0]["valid"], rows[0]["status"]), ("", "1", "tracking"))


if __name__ == "__main__":
    rospy.init_node("record_estimates_test")
    rostest.rosrun("uav_landing", "record_estimates", RecordEstimatesTest)
