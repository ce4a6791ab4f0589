import re
import unittest
import xml.etree.ElementTree as ElementTree

from project import SOURCE_DIR

# Keys of package.xml that rosdep knows for Ubuntu 20.04 with ROS Noetic, and the packages that it installs. Keys of ROS
# stand in Noetic's list of packages, the others in rosdep's base.yaml and python.yaml.
ROS = ("camera_calibration", "camera_calibration_parsers", "catkin", "class_loader", "cv_bridge", "diagnostic_aggregator",
       "diagnostic_updater", "dynamic_reconfigure", "geometry_msgs", "image_geometry", "image_transport",
       "message_filters", "message_generation", "message_runtime", "nodelet", "pluginlib", "rosbag", "roscpp",
       "roslaunch", "rostest", "rviz", "sensor_msgs", "std_msgs", "std_srvs", "stereo_image_proc", "tf2", "tf2_eigen",
       "tf2_msgs", "tf2_ros", "visualization_msgs")
PACKAGES = {key: "ros-noetic-" + key.replace("_", "-") for key in ROS}
PACKAGES.update({
    "bzip2": "libbz2-dev", "eigen": "libeigen3-dev", "libexpected-dev": "libexpected-dev",
    "libopencv-dev": "libopencv-dev", "python3-matplotlib": "python3-matplotlib", "python3-numpy": "python3-numpy",
    "python3-opencv": "python3-opencv", "yaml-cpp": "libyaml-cpp-dev",
})
# Ubuntu 20.04 has no package for these keys: package.xml must not ask for them there.
MISSING = {"cli11"}
NOT_THERE = "$ROS_DISTRO != noetic"


def problems(manifest):
    """What rosdep cannot install on Ubuntu 20.04, one line for each."""
    found = []
    for element in ElementTree.fromstring(manifest):
        if not re.fullmatch(r"(\w+_)?depend", element.tag) or element.get("condition") == NOT_THERE:
            continue
        key = (element.text or "").strip()
        if key in MISSING:
            found.append(f"{key}: Ubuntu 20.04 has no such package; write <{element.tag} condition=\"{NOT_THERE}\">")
        elif key not in PACKAGES:
            found.append(f"{key}: rosdep's lists must know it for Ubuntu 20.04; look it up there, then add it to this test")
    return found


class PackageKeysTest(unittest.TestCase):
    def test_rosdep_knows_all_keys_of_the_manifest_on_ubuntu_20_04(self):
        self.assertEqual(problems((SOURCE_DIR / "package.xml").read_text()), [])

    def test_the_table_has_no_key_that_the_manifest_does_not_name(self):
        manifest = ElementTree.parse(str(SOURCE_DIR / "package.xml")).getroot()
        keys = {element.text.strip() for element in manifest if element.tag.endswith("depend")}
        self.assertEqual((set(PACKAGES) | MISSING) - keys, set())

    def test_unknown_and_missing_keys_are_named(self):
        found = problems("<package><depend>opencv42</depend><build_depend>cli11</build_depend><depend>eigen</depend>"
                         "<build_depend condition=\"$ROS_DISTRO != noetic\">cli11</build_depend></package>")
        self.assertEqual([line.split(":")[0] for line in found], ["opencv42", "cli11"])
