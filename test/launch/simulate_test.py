#!/usr/bin/python3
"""simulate.launch: cameras that run, a clock that never goes ahead of them, and an estimate that agrees with the truth."""

import signal
import sys
import tempfile
import unittest
from pathlib import Path

import rosbag
import rosgraph
import rospy
import yaml
from launch_test import SOURCE_DIR, Listener, Process, chain_is_connected, eventually, launch_file
from rosgraph_msgs.msg import Clock
from uav_landing.msg import LandingEstimate

TRUTH = "/truth/landing_estimate"


def is_recorded():
    _, subscribers, _ = rosgraph.Master(rospy.get_name()).getSystemState()
    return any(node.startswith("/record") for node in dict(subscribers).get(TRUTH, []))


def write_approach(folder, duration):
    config = yaml.safe_load((SOURCE_DIR / "config/simulator/lab.yaml").read_text())
    config["path"].update(duration=duration)
    file = Path(folder) / "approach.yaml"
    file.write_text(yaml.safe_dump(config))
    return file


class SimulateTest(unittest.TestCase):
    def test_who_is_slow_to_connect_misses_nothing(self):
        clock, truth = Listener("/clock", Clock), Listener(TRUTH, LandingEstimate)
        with tempfile.TemporaryDirectory() as folder:
            bag = Path(folder) / "truth.bag"
            with Process("rosrun", "rosbag", "record", "-O", bag, TRUTH) as record:
                self.assertTrue(eventually(is_recorded), record.text())
                with launch_file("simulate.launch", f"simulation:={write_approach(folder, 2)}", "loop:=false") as launched:
                    record.process.send_signal(signal.SIGSTOP)
                    try:
                        self.assertTrue(eventually(chain_is_connected), launched.text())
                        ticks = len(clock.all())
                        self.assertTrue(eventually(lambda: len(clock.all()) > ticks + 50), launched.text())
                    finally:
                        record.process.send_signal(signal.SIGCONT)
                    self.assertTrue(eventually(lambda: len(truth.all()) > 10), launched.text())
            stamps = [message.header.stamp for _, message, _ in rosbag.Bag(str(bag)).read_messages()]
            self.assertEqual(stamps[:1], [rospy.Time(100)])

    def test_estimate_agrees_with_the_truth_and_the_clock_goes_on(self):
        clock, truth = Listener("/clock", Clock), Listener(TRUTH, LandingEstimate)
        estimates = Listener("/uav_landing/landing_estimate", LandingEstimate)
        with tempfile.TemporaryDirectory() as folder:
            with launch_file("simulate.launch", f"simulation:={write_approach(folder, 3)}", "loop:=true") as launched:
                # Into the second round, which goes on in time.
                self.assertTrue(eventually(lambda: len(truth.all()) > 40), launched.text())
                last = truth.all()[39].header.stamp
                self.assertTrue(eventually(lambda: any(e.header.stamp >= last for e in estimates.all())), launched.text())
        stamps = [message.header.stamp for message in truth.all()]
        self.assertEqual(stamps, sorted(set(stamps)))
        self.assertEqual(stamps[0], rospy.Time(100))
        self.assertEqual((stamps[1] - stamps[0]).to_sec(), 0.1)
        times = [message.clock for message in clock.all()]
        self.assertEqual(times, sorted(times))
        heights = {message.header.stamp: message.height for message in truth.all()}
        valid = [e for e in estimates.all() if e.height_valid and e.header.stamp in heights]
        self.assertGreater(len(valid), 15)
        for estimate in valid:
            self.assertAlmostEqual(estimate.height, heights[estimate.header.stamp], delta=0.02)


if __name__ == "__main__":
    import rostest

    rospy.init_node("simulate_test", disable_rostime=True)
    rostest.rosrun("uav_landing", "simulate", SimulateTest, sys.argv)
