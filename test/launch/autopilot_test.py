#!/usr/bin/python3
"""What reaches the inputs of mavros when autopilot.launch runs beside stereo.launch: frames, covariances, rates.

mavros' vision_pose plugin takes east-north-up poses of base_link and the upper triangle of their covariance, its vision_speed
plugin velocities along the same axes; its distance_sensor plugin takes metres that fit 16 bit of centimetres. Both pass on the stamp. PX4 asks for 30 to 50 poses a
second, ArduPilot for at least 4.
"""

import math
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
import rosbag
import rospy
import yaml
from geometry_msgs.msg import PoseWithCovarianceStamped, Quaternion, TransformStamped, TwistWithCovarianceStamped
from launch_test import INPUTS, SOURCE_DIR, Listener, Process, chain_is_connected, eventually
from sensor_msgs.msg import Range
from tf2_msgs.msg import TFMessage
from uav_landing.msg import LandingEstimate

RATE = 30  # pairs a second
HEADING = math.radians(60)  # of the runway


def lever_arm(camera):
    """Static transform of a camera 0.5 m ahead of base_link that looks straight ahead."""
    transform = TransformStamped()
    transform.header.frame_id, transform.child_frame_id = "base_link", camera
    transform.transform.translation.x = 0.5
    transform.transform.rotation = Quaternion(-0.5, 0.5, -0.5, 0.5)
    return TFMessage([transform])


class AutopilotTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp())
        cls.bag = cls.folder / "approach.bag"
        config = yaml.safe_load((SOURCE_DIR / "config/simulator/lab.yaml").read_text())
        config["path"].update(duration=5, rate=RATE)
        (cls.folder / "approach.yaml").write_text(yaml.safe_dump(config))
        subprocess.run(["rosrun", "uav_landing", "simulate_approach", "--config", str(cls.folder / "approach.yaml"),
                        "--output", str(cls.bag)], check=True, timeout=200)
        with rosbag.Bag(str(cls.bag)) as bag:
            cls.truth = {m.header.stamp: m for _, m, _ in bag.read_messages(["/truth/landing_estimate"])}
            cls.frame = next(m.header.frame_id for _, m, _ in bag.read_messages(["/stereo/left/camera_info"]))
        ranges, poses, velocities = (Listener("/mavros/distance_sensor/uav_landing_sub", Range),
                                     Listener("/mavros/vision_pose/pose_cov", PoseWithCovarianceStamped),
                                     Listener("/mavros/vision_speed/speed_twist_cov", TwistWithCovarianceStamped))
        estimates = Listener("/uav_landing/landing_estimate", LandingEstimate)
        static_publisher = rospy.Publisher("/tf_static", TFMessage, queue_size=1, latch=True)
        static_publisher.publish(lever_arm(cls.frame))
        with Process("roslaunch", "uav_landing", "stereo.launch", "drop_frames:=false", "overlay:=false",
                     "base_frame:=base_link") as stereo, \
                Process("roslaunch", "uav_landing", "autopilot.launch", "runway_heading_deg:=60") as autopilot:
            assert eventually(chain_is_connected), stereo.text()
            assert eventually(lambda: static_publisher.get_num_connections() and
                              all(listener.subscriber.get_num_connections() for listener in (ranges, poses, velocities))), \
                autopilot.text()
            last = max(cls.truth)
            with Process("rosbag", "play", "--quiet", "--queue=1000", "--wait-for-subscribers", cls.bag,
                         "--topics", *INPUTS):
                assert eventually(lambda: any(e.header.stamp == last for e in estimates.all())), stereo.text()
            assert eventually(lambda: all(any(m.header.stamp == last for m in listener.all())
                                          for listener in (ranges, poses, velocities))), autopilot.text()
        cls.ranges, cls.poses, cls.velocities = ranges.all(), poses.all(), velocities.all()
        cls.valid = {e.header.stamp: e for e in estimates.all() if e.height_valid}

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.folder)

    def test_ranges_are_finite_metres_along_the_down_axis_of_base_link(self):
        for message in self.ranges:
            truth = self.truth[message.header.stamp]
            self.assertEqual(message.header.frame_id, "base_link")
            self.assertTrue(message.min_range <= message.range <= message.max_range <= 655.35)
            # The camera's axes are those of base_link, 0.5 m ahead of it: nose down it hangs lower.
            height = truth.height - 0.5 * math.sin(truth.pitch)
            self.assertAlmostEqual(message.range * math.cos(truth.pitch) * math.cos(truth.roll), height, delta=0.02)

    def test_poses_are_east_north_up(self):
        for message in self.poses:
            truth = self.truth[message.header.stamp]
            self.assertEqual(message.header.frame_id, "map")
            position = message.pose.pose.position
            forward = np.array([math.sin(HEADING), math.cos(HEADING)])
            left = np.array([-forward[1], forward[0]])
            # base_link is 0.5 m behind the camera, along an axis that is pitched and yawed a little.
            self.assertAlmostEqual(np.dot([position.x, position.y], forward), truth.x - 0.5 * math.cos(truth.pitch),
                                   delta=0.1)
            self.assertAlmostEqual(np.dot([position.x, position.y], left), truth.y, delta=0.1)
            quaternion = message.pose.pose.orientation
            heading = math.atan2(1 - 2 * (quaternion.y ** 2 + quaternion.z ** 2),
                                 2 * (quaternion.x * quaternion.y + quaternion.w * quaternion.z))
            self.assertAlmostEqual(heading, HEADING - truth.yaw, delta=math.radians(1))

    def test_velocities_are_east_north_up_and_as_wrong_as_they_say(self):
        self.assertGreater(len(self.velocities), 2 * RATE)
        forward, up = np.array([math.sin(HEADING), math.cos(HEADING), 0]), np.array([0, 0, 1])
        errors = []
        for message in self.velocities:
            truth = self.truth[message.header.stamp]
            self.assertEqual(message.header.frame_id, "map")
            linear = message.twist.twist.linear
            velocity = np.array([linear.x, linear.y, linear.z])
            covariance = np.reshape(message.twist.covariance, (6, 6))
            speed = np.linalg.norm(truth.velocity)
            # base_link swings with the camera's attitude by less than a hundredth of this.
            error = [np.dot(velocity, forward) - speed * math.cos(truth.approach_angle),
                     velocity[2] + speed * math.sin(truth.approach_angle)]
            errors.append(np.array(error) / speed)
            for value, axis in zip(error, (forward, up)):
                stddev = math.sqrt(axis @ covariance[:3, :3] @ axis)
                self.assertLess(abs(value), 5 * stddev + 0.01 * speed)
                self.assertLess(stddev, 0.1 * speed)
        np.testing.assert_array_less(np.abs(np.mean(errors, axis=0)), 0.01)

    def test_covariances_are_finite_and_positive_definite(self):
        self.assertTrue(self.poses)
        for message in self.poses:
            covariance = np.reshape(message.pose.covariance, (6, 6))
            self.assertTrue(np.all(np.isfinite(covariance)))
            np.testing.assert_allclose(covariance, covariance.T, rtol=1e-9, atol=1e-15)
            self.assertGreater(np.linalg.eigvalsh(covariance)[0], 0)
            self.assertLess(covariance[0, 0], 20 ** 2)

    def test_every_valid_pair_is_passed_on_at_the_rate_of_the_cameras(self):
        self.assertGreater(len(self.valid), 3 * RATE)
        self.assertEqual([m.header.stamp for m in self.ranges], sorted(self.valid))
        # From where the runway is found, to the end.
        poses = [m.header.stamp for m in self.poses]
        self.assertGreater(len(poses), 2 * RATE)
        self.assertEqual(poses, [stamp for stamp in sorted(self.valid) if stamp >= poses[0]])
        rate = (len(poses) - 1) / (poses[-1] - poses[0]).to_sec()
        self.assertAlmostEqual(rate, RATE, delta=1)


if __name__ == "__main__":
    import rostest

    # The test's own clock is the wall clock whatever the launch files set.
    rospy.init_node("autopilot_test", disable_rostime=True)
    rostest.rosrun("uav_landing", "autopilot", AutopilotTest, sys.argv)
