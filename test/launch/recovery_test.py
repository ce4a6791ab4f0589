#!/usr/bin/python3
"""What stereo.launch does when its manager dies, when there is no clock, and with a configuration that no nodelet takes."""

import os
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest
import xmlrpc.client
from pathlib import Path

import rosbag
import rosgraph
import rospy
from launch_test import INPUTS, Listener, Process, chain_is_connected, eventually, launch
from rosgraph_msgs.msg import Log
from uav_landing.msg import LandingEstimate

SOURCE_DIR = Path(__file__).resolve().parents[2]
MANAGER = "/uav_landing/manager"


def manager_pid():
    """Process of the manager that runs now; None while there is none."""
    try:
        uri = rosgraph.Master(rospy.get_name()).lookupNode(MANAGER)
        return xmlrpc.client.ServerProxy(uri).getPid(rospy.get_name())[2]
    except (rosgraph.MasterException, OSError):
        return None


def topics_of_the_nodelets():
    """What the manager publishes, subscribes and serves, besides what it needs itself."""
    own = ("/rosout", "/clock", MANAGER + "/")
    return [name for kind in rosgraph.Master(rospy.get_name()).getSystemState() for name, nodes in kind
            if MANAGER in nodes and not name.startswith(own)]


class RecoveryTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = Path(tempfile.mkdtemp())
        cls.bag = cls.folder / "approach.bag"
        subprocess.run(["rosrun", "uav_landing", "simulate_approach", "--config",
                        str(SOURCE_DIR / "config/simulator/lab.yaml"), "--duration", "2", "--output", str(cls.bag)],
                       check=True, stdout=subprocess.DEVNULL, timeout=200)
        with rosbag.Bag(str(cls.bag)) as bag:
            cls.first = next(m.header.stamp for _, m, _ in bag.read_messages(["/stereo/left/camera_info"]))

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(str(cls.folder))

    def setUp(self):
        self.log = Listener("/rosout", Log)
        self.addCleanup(self.log.close)

    def tearDown(self):
        for name in ("/use_sim_time", "/uav_landing"):
            if rospy.has_param(name):
                rospy.delete_param(name)

    def assert_comes(self, condition, launched):
        if not eventually(condition):
            self.fail("did not come in time; the launch file says:\n" + launched.text())

    def logged(self, text):
        return any(text in line.msg for line in self.log.all())

    def assert_valid_within_a_second(self, launched):
        """Plays two seconds of good input; an estimate of the first is valid, and that they are over is said."""
        estimates = Listener("/uav_landing/landing_estimate", LandingEstimate)
        self.addCleanup(estimates.close)
        self.assert_comes(lambda: estimates.subscriber.get_num_connections() > 0, launched)
        second = rospy.Duration(1)
        # At half the speed: stopped for a second or so, the chain still hears enough of the first second.
        with Process("rosbag", "play", "--quiet", "--rate=0.5", "--wait-for-subscribers", self.bag, "--topics", *INPUTS):
            self.assert_comes(
                lambda: any(e.valid and e.header.stamp <= self.first + second for e in estimates.all()), launched)
            self.assert_comes(lambda: estimates.all()[-1].status == LandingEstimate.LOST, launched)

    def test_a_manager_that_dies_comes_back_with_its_nodelets(self):
        with launch() as launched:
            self.assert_comes(chain_is_connected, launched)
            self.assert_valid_within_a_second(launched)
            before = manager_pid()
            os.kill(before, signal.SIGKILL)
            self.assert_comes(lambda: manager_pid() not in (None, before) and chain_is_connected(), launched)
            self.assert_valid_within_a_second(launched)

    def test_sim_time_without_a_clock_is_named_and_stops_nothing(self):
        rospy.set_param("/use_sim_time", True)
        with launch() as launched:
            self.assert_comes(chain_is_connected, launched)
            self.assert_valid_within_a_second(launched)
            self.assert_comes(lambda: self.logged("/use_sim_time is set and nobody publishes /clock"), launched)

    def test_a_configuration_that_is_refused_leaves_an_empty_manager(self):
        config = self.folder / "wrong.yaml"
        config.write_text("kalman_height: {gate: -1}\n")
        refusal = f": {config}: kalman_height/gate: -1 is out of range, expected 1 to 20 sigma"
        with launch(f"config:={config}", "respawn:=false") as launched:
            self.assert_comes(manager_pid, launched)
            before = manager_pid()
            for nodelet in ("rectify", "stereo_depth", "approach_angle", "kalman_height", "overlay"):
                own = refusal if nodelet != "kalman_height" else ": kalman_height/gate: -1 is out of range"
                # On the screen: who subscribes the log may be too late for what a manager says as it starts.
                self.assert_comes(lambda: f"/uav_landing/{nodelet}{refusal}" in launched.text()
                                  or f"/uav_landing/{nodelet}{own}" in launched.text(), launched)
            self.assertEqual(topics_of_the_nodelets(), [])
            self.assertEqual(manager_pid(), before)


if __name__ == "__main__":
    import rostest

    # The test's own clock is the wall clock whatever the launch file sets.
    rospy.init_node("recovery_test", disable_rostime=True)
    rostest.rosrun("uav_landing", "recovery", RecoveryTest, sys.argv)
