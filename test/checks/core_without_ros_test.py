import re
import unittest

from project import DEVEL_DIR, SOURCE_DIR, run

ROS_LIBRARY = re.compile(r"^lib(ros|xmlrpcpp|cpp_common|nodelet|class_loader|message_filters|image_transport|cv_bridge|"
                         r"tf2|topic_tools|camera_calibration_parsers|dynamic_reconfigure)")
ROS_HEADER = re.compile(r'^\s*#\s*include\s*[<"]((?:ros|rosbag|nodelet|cv_bridge|image_transport|message_filters|'
                        r"pluginlib|tf2|tf2_ros|tf2_eigen|diagnostic_updater|dynamic_reconfigure|"
                        r"camera_calibration_parsers|image_geometry|[a-z0-9_]+_msgs|uav_landing/[A-Z])[^>\"]*)", re.MULTILINE)


def needed_libraries(library):
    """DT_NEEDED entries of a shared library."""
    output = run(["readelf", "--dynamic", "--wide", library], check=True).stdout
    return re.findall(r"\(NEEDED\).*\[(.*)\]", output)


class CoreWithoutRosTest(unittest.TestCase):
    def test_core_library_links_to_no_ros_library(self):
        needed = needed_libraries(DEVEL_DIR / "lib/libuav_landing_core.so")
        self.assertTrue(any(name.startswith("libopencv_core") for name in needed), needed)
        self.assertEqual([name for name in needed if ROS_LIBRARY.match(name)], [])

    def test_core_sources_include_no_ros_header(self):
        sources = [path for folder in ("include/uav_landing", "src/core") for path in (SOURCE_DIR / folder).rglob("*")
                   if path.suffix in (".h", ".hpp", ".cpp")]
        self.assertTrue(sources)
        found = {str(path): ROS_HEADER.findall(path.read_text()) for path in sources}
        self.assertEqual({path: headers for path, headers in found.items() if headers}, {})
