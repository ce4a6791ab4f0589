#!/usr/bin/python3
"""What the nodelets share, rig and runway, is that of the launch that runs, whatever earlier ones have left on the master."""

import sys
import tempfile
import unittest

import rospy
from launch_test import Listener, eventually, launch
from visualization_msgs.msg import MarkerArray


def drawn_width(array):
    """How wide the runway is drawn, m."""
    across = [point.y for marker in array.markers if marker.ns == "runway" for point in marker.points]
    return max(across) - min(across)


class SharedParametersTest(unittest.TestCase):
    def shared(self, *arguments):
        """Starts stereo.launch: its rig and runway on the master, and the width in m that kalman_height draws, as it knows none
        by images."""
        markers = Listener("/uav_landing/markers", MarkerArray)
        with launch("overlay:=false", *arguments) as launched:
            self.assertTrue(eventually(markers.all), launched.text())
            shared = {section: rospy.get_param(f"/uav_landing/{section}", {}) for section in ("rig", "runway")}
        markers.close()
        return shared, round(drawn_width(markers.all()[-1]), 2)

    def test_yesterdays_width_does_not_stay(self):
        with tempfile.NamedTemporaryFile("w", suffix=".yaml") as config:
            config.write("rig: {max_baseline: 20}")
            config.flush()
            self.assertEqual(self.shared(f"config:={config.name}", "runway_width:=45"),
                             ({"rig": {"max_baseline": 20}, "runway": {"width": 45}}, 45))
        self.assertEqual(self.shared(), ({"rig": {}, "runway": {}}, 30))
        self.assertEqual(self.shared("runway_width:=25"), ({"rig": {}, "runway": {"width": 25}}, 25))


if __name__ == "__main__":
    import rostest

    # The test's own clock is the wall clock whatever the launch file sets.
    rospy.init_node("shared_parameters_test", disable_rostime=True)
    rostest.rosrun("uav_landing", "shared_parameters", SharedParametersTest, sys.argv)
