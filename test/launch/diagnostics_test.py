#!/usr/bin/python3
"""Every nodelet's diagnostics arrive in their group of the aggregator, none among the unknown."""

import sys
import unittest

import rospy
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from launch_test import Listener, eventually

GROUPS = {"Cameras and rectification": "rectify", "Stereo depth": "stereo_depth", "Approach angle": "approach_angle",
          "Height": "kalman_height", "Outputs": "overlay"}


class DiagnosticsTest(unittest.TestCase):
    def test_every_nodelet_is_in_its_group(self):
        aggregated = Listener("/diagnostics_agg", DiagnosticArray)

        def latest():
            messages = aggregated.all()
            return {status.name: status for status in messages[-1].status} if messages else {}

        def complete():
            return all(any(name.startswith(f"/Landing/{group}/") and nodelet in name for name in latest())
                       for group, nodelet in GROUPS.items())

        self.assertTrue(eventually(complete), sorted(latest()))
        self.assertFalse([name for name in latest() if "Other" in name and "uav_landing" in name])
        # What is not known is said in words.
        values = {(name, value.key): value.value for name, status in latest().items() for value in status.values}
        self.assertEqual([key for key, value in values.items() if "nan" in value], [])
        self.assertIn("unknown: there is no height", values.values())
        # No camera publishes, which has to reach the top.
        self.assertTrue(eventually(lambda: latest()["/Landing"].level == DiagnosticStatus.ERROR), latest())


if __name__ == "__main__":
    import rostest

    rospy.init_node("diagnostics_test", disable_rostime=True)
    rostest.rosrun("uav_landing", "diagnostics", DiagnosticsTest, sys.argv)
