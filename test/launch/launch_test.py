#!/usr/bin/python3
"""What a user sees who starts stereo.launch: on a bag, on a bag that loops, with a camera that is silent."""

import math
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

import cv2
import numpy as np
import rosbag
import rosgraph
import rospy
import yaml
from rosgraph_msgs.msg import Log
from tf2_msgs.msg import TFMessage
from uav_landing.msg import ApproachAngle, LandingEstimate, StereoDepth

SOURCE_DIR = Path(__file__).resolve().parents[2]
DEADLINE = 60  # s
OUTPUTS = {"stereo_depth": StereoDepth, "approach_angle": ApproachAngle, "landing_estimate": LandingEstimate}
INPUTS = [f"/stereo/{side}/{topic}" for side in ("left", "right") for topic in ("image_raw", "camera_info")]


def eventually(condition, deadline=DEADLINE):
    """Waits for a condition; False after the deadline."""
    end = time.monotonic() + deadline
    while not condition():
        if time.monotonic() > end:
            return False
        time.sleep(0.02)
    return True


class Process:
    """A program that is interrupted at the end of its with-block."""

    def __init__(self, *command):
        self.log = tempfile.TemporaryFile(mode="w+")
        self.process = subprocess.Popen([str(part) for part in command], stdout=self.log, stderr=subprocess.STDOUT)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        if self.process.poll() is None:
            self.process.send_signal(signal.SIGINT)
            try:
                self.process.wait(30)
            except subprocess.TimeoutExpired:
                self.process.kill()
                self.process.wait()
        self.log.close()

    def text(self):
        # At a place of its own: the program goes on writing where the file's place is.
        size = os.fstat(self.log.fileno()).st_size
        return os.pread(self.log.fileno(), size, 0).decode(errors="replace")


class Listener:
    """Keeps what comes on a topic."""

    def __init__(self, topic, message_type):
        self.lock = threading.Lock()
        self.messages = []
        self.subscriber = rospy.Subscriber(topic, message_type, self.receive, queue_size=10000)

    def receive(self, message):
        with self.lock:
            self.messages.append(message)

    def all(self):
        with self.lock:
            return list(self.messages)

    def close(self):
        self.subscriber.unregister()


def launch_file(name, *arguments):
    return Process("roslaunch", "uav_landing", name, *arguments)


def launch(*arguments):
    return launch_file("stereo.launch", "complaint_period:=0.5", *arguments)


def chain_is_connected():
    """rectify listens to the cameras, and everything behind it to each other."""
    _, subscribers, _ = rosgraph.Master(rospy.get_name()).getSystemState()
    listened = {topic for topic, nodes in subscribers if "/uav_landing/manager" in nodes}
    return listened.issuperset([*INPUTS, "/uav_landing/left/image_rect", "/uav_landing/right/time_reference",
                                "/uav_landing/stereo_depth", "/uav_landing/approach_angle", "/imu/data"])


def differences(a, b, path=""):
    """Fields of two messages whose values differ by more than 1e-9, absolutely or relatively."""
    if isinstance(a, float):
        same = math.isclose(a, b, rel_tol=1e-9, abs_tol=1e-9) or (math.isnan(a) and math.isnan(b))
        return [] if same else [f"{path}: {a!r} and {b!r}"]
    if isinstance(a, (list, tuple)):
        if len(a) != len(b):
            return [f"{path}: {len(a)} and {len(b)} elements"]
        return [d for i, (x, y) in enumerate(zip(a, b)) for d in differences(x, y, f"{path}[{i}]")]
    if hasattr(a, "__slots__") and not isinstance(a, rospy.Time):
        return [d for name in a.__slots__ if name not in ("seq", "compute_ms")
                for d in differences(getattr(a, name), getattr(b, name), f"{path}.{name}")]
    return [] if a == b else [f"{path}: {a!r} and {b!r}"]


class LaunchTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp())
        cls.bag = cls.folder / "approach.bag"
        config = yaml.safe_load((SOURCE_DIR / "config/simulator/lab.yaml").read_text())
        config["path"]["duration"] = 4
        config["imu"] = {"rate": 100, "pitch_error_deg": 0.3, "gyro_bias_y_deg": 0.1}
        (cls.folder / "approach.yaml").write_text(yaml.safe_dump(config))
        subprocess.run(["rosrun", "uav_landing", "simulate_approach", "--config", str(cls.folder / "approach.yaml"),
                        "--output", str(cls.bag)], check=True, timeout=200)
        with rosbag.Bag(str(cls.bag)) as bag:
            cls.truth = {m.header.stamp: m for _, m, _ in bag.read_messages(["/truth/landing_estimate"])}
            cls.stamps = [m.header.stamp for _, m, _ in bag.read_messages(["/stereo/left/camera_info"])]
        assert len(cls.stamps) >= 30

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def setUp(self):
        self.listeners = []
        self.estimates = self.listen("/uav_landing/landing_estimate", LandingEstimate)
        self.log = self.listen("/rosout", Log)

    def tearDown(self):
        for listener in self.listeners:
            listener.close()
        if rospy.has_param("/use_sim_time"):
            rospy.delete_param("/use_sim_time")
        if rospy.has_param("/uav_landing"):
            rospy.delete_param("/uav_landing")

    def listen(self, topic, message_type):
        self.listeners.append(Listener(topic, message_type))
        return self.listeners[-1]

    def estimate_of(self, stamp):
        return next((e for e in self.estimates.all() if e.header.stamp == stamp), None)

    def assert_comes(self, condition, launched):
        if not eventually(condition):
            self.fail("did not come in time; the launch file says:\n" + launched.text())

    def logged(self, text):
        return any(text in line.msg for line in self.log.all())

    def test_a_bag_gives_height_and_approach_angle(self):
        transforms = self.listen("/tf", TFMessage)
        with launch(f"bag:={self.bag}", "delay:=5") as launched:
            self.assert_comes(lambda: self.estimate_of(self.stamps[-1]), launched)
            # The transform of a pair comes after its estimate.
            last = max(e.header.stamp for e in self.estimates.all() if e.valid)
            self.assert_comes(lambda: any(t.header.stamp == last for m in transforms.all() for t in m.transforms), launched)
        estimates = [e for e in self.estimates.all() if e.header.stamp in self.truth]
        valid = [e for e in estimates if e.valid]
        self.assertGreater(len(valid), 20)
        for estimate in valid:
            truth = self.truth[estimate.header.stamp]
            self.assertAlmostEqual(estimate.height, truth.height, delta=0.02)
            if estimate.header.stamp > self.stamps[0] + rospy.Duration(1):
                self.assertAlmostEqual(estimate.approach_angle, truth.approach_angle, delta=math.radians(0.66))
        heights = {t.header.stamp: t.transform.translation.z for m in transforms.all() for t in m.transforms
                   if t.header.frame_id == "runway"}
        for estimate in valid:
            self.assertAlmostEqual(heights[estimate.header.stamp], estimate.height, delta=1e-9)
        self.assertEqual(sum(e.header.stamp == self.stamps[-1] for e in estimates), 1)

    def test_a_bag_that_loops_is_followed_again_and_again(self):
        def valid_rounds():
            """Numbers of valid estimates between the jumps back in time."""
            rounds, last = [0], rospy.Time(0)
            for estimate in self.estimates.all():
                if estimate.status == LandingEstimate.LOST:
                    continue
                if estimate.header.stamp < last:
                    rounds.append(0)
                last = estimate.header.stamp
                rounds[-1] += estimate.valid
            return rounds

        with launch(f"bag:={self.bag}", "loop:=true", "rate:=2") as launched:
            # Not the first ones: a machine with other work to do may miss much of a round.
            self.assert_comes(lambda: sum(valid > 10 for valid in valid_rounds()[1:]) >= 2, launched)

    def same_numbers(self, config):
        """What process_bag publishes, by topic, after the nodelets have published the same."""
        offline_bag = self.folder / "offline.bag"
        subprocess.run(["rosrun", "uav_landing", "process_bag", "--input", str(self.bag), "--output",
                        str(offline_bag), "--config", str(config)], check=True, stdout=subprocess.DEVNULL, timeout=200)
        with rosbag.Bag(str(offline_bag)) as bag:
            offline = {name: [m for _, m, _ in bag.read_messages([f"/uav_landing/{name}"])] for name in OUTPUTS}
        # Static transforms are there before the sensors are.
        transforms = rospy.Publisher("/tf_static", TFMessage, queue_size=1, latch=True)
        self.addCleanup(transforms.unregister)
        with rosbag.Bag(str(self.bag)) as bag:
            transforms.publish(next(m for _, m, _ in bag.read_messages(["/tf_static"])))
        listeners = {name: self.listen(f"/uav_landing/{name}", OUTPUTS[name]) for name in OUTPUTS}
        with launch("drop_frames:=false", "overlay:=false", f"config:={config}") as launched:
            self.assert_comes(chain_is_connected, launched)
            self.assert_comes(lambda: transforms.get_num_connections() > 0, launched)
            with Process("rosbag", "play", "--quiet", "--rate=4", "--queue=1000", "--wait-for-subscribers",
                         self.bag, "--topics", *INPUTS, "/imu/data"):
                self.assert_comes(lambda: self.estimate_of(self.stamps[-1]), launched)
        for name, listener in listeners.items():
            self.assertEqual(len(offline[name]), len(self.stamps), name)
            live = listener.all()
            self.assertEqual([m.header.stamp for m in live], [m.header.stamp for m in offline[name]], name)
            for a, b in zip(live, offline[name]):
                self.assertEqual(differences(a, b, name), [], f"at {a.header.stamp.to_sec():.3f} s")
        return offline

    def test_nodelets_and_process_bag_give_the_same_numbers(self):
        offline = self.same_numbers(SOURCE_DIR / "config/stereo.yaml")
        self.assertTrue(any(e.valid for e in offline["landing_estimate"]))
        self.assertTrue(any(math.isfinite(a.runway.width) for a in offline["approach_angle"]))
        self.assertEqual({a.imu.reason for a in offline["approach_angle"]}, {""})
        self.assertTrue(all(math.isfinite(a.imu.rotation[0]) for a in offline["approach_angle"][1:]))

    def test_nodelets_and_process_bag_know_the_same_width_of_the_runway(self):
        config = self.folder / "width.yaml"
        config.write_text("runway: {width: 1.6}\n")
        offline = self.same_numbers(config)
        # The lab's runway is 1.2 m wide. Stereo tells so in spite of the chart.
        self.assertTrue(any("runway_width" in [test.name for test in e.tests if test.failed]
                            for e in offline["landing_estimate"]))
        last = offline["landing_estimate"][-1]
        self.assertAlmostEqual(last.width_height / last.height, 1, delta=0.01)

    def test_nodelets_and_process_bag_leave_out_the_same_pixels(self):
        # A relative path begins at the config file's folder, wherever the programs run.
        config = self.folder / "masked" / "masks.yaml"
        config.parent.mkdir()
        config.write_text("rig: {left_mask: nose.png}\n")
        with rosbag.Bag(str(self.bag)) as bag:
            info = next(m for _, m, _ in bag.read_messages(["/stereo/left/camera_info"]))
        mask = np.full((info.height, info.width), 255, np.uint8)
        mask[:, : info.width // 2] = 0
        cv2.imwrite(str(config.parent / "nose.png"), mask)
        offline = self.same_numbers(config)
        self.assertTrue(any(e.valid for e in offline["landing_estimate"]))
        columns = [u for depth in offline["stereo_depth"] for u in depth.u]
        self.assertGreater(len(columns), 100)
        self.assertGreater(min(columns), info.width // 2 - 20, "the lens moves the mask's edge by some pixels")

    def test_a_silent_right_camera_is_named_and_nothing_is_valid(self):
        with launch() as launched:
            self.assert_comes(chain_is_connected, launched)
            with Process("rosbag", "play", "--quiet", "--loop", self.bag, "--topics",
                         *[topic for topic in INPUTS if "left" in topic]):
                self.assert_comes(
                    lambda: self.logged("no message on /stereo/right/image_raw, /stereo/right/camera_info"), launched)
                self.assert_comes(lambda: self.estimates.all(), launched)
        for estimate in self.estimates.all():
            self.assertEqual(estimate.status, LandingEstimate.LOST)
            self.assertFalse(estimate.valid)
            self.assertTrue(math.isnan(estimate.height))

    def test_a_wrong_config_key_is_named(self):
        config = self.folder / "wrong.yaml"
        config.write_text("stereo_depth: {windowradius: 5}\n")
        with launch(f"config:={config}") as launched:
            self.assert_comes(lambda: self.logged(
                "stereo_depth/windowradius: no such parameter; did you mean window_radius?"), launched)

    def test_a_config_section_that_no_nodelet_has_is_named(self):
        config = self.folder / "section.yaml"
        config.write_text("stereodepth: {window_radius: 5}\n")
        with launch(f"config:={config}") as launched:
            self.assert_comes(lambda: self.logged("section.yaml: stereodepth"), launched)


if __name__ == "__main__":
    import rostest

    # The test's own clock is the wall clock whatever the launch file sets.
    rospy.init_node("launch_test", disable_rostime=True)
    rostest.rosrun("uav_landing", "launch", LaunchTest, sys.argv)
