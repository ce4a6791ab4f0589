"""What the launch files make of their arguments; no master is needed."""

import tempfile
import unittest

import roslaunch.config
import roslaunch.xmlloader
import yaml
from roslaunch.arg_dump import get_args

from project import SOURCE_DIR, run

LAUNCH = SOURCE_DIR / "launch"


def parameters(*arguments, launch=LAUNCH / "stereo.launch"):
    """Parameters that stereo.launch would set."""
    result = run(["roslaunch", "--dump-params", launch, *arguments])
    assert result.returncode == 0, result.stderr
    return yaml.safe_load(result.stdout)


class ArgumentsTest(unittest.TestCase):
    def test_all_are_explained_and_none_is_listed_as_required(self):
        for file in sorted(LAUNCH.glob("*.launch")):
            with self.subTest(file.name):
                # roslaunch calls those required that have no default, or an empty one.
                lacking = [name for name, (doc, default) in get_args([str(file)]).items() if not doc or not default]
                self.assertEqual(lacking, [])

    def test_an_empty_value_is_the_default(self):
        # From another launch file: on the command line roslaunch itself takes an empty value for the default.
        names = ("approximate_sync", "max_skew", "base_frame", "runway_width", "drawn_runway_width", "bag")
        with tempfile.NamedTemporaryFile("w", suffix=".launch") as file:
            empty = "".join(f'<arg name="{name}" value=""/>' for name in names)
            file.write(f'<launch><include file="{LAUNCH}/stereo.launch">{empty}</include></launch>')
            file.flush()
            self.assertEqual(parameters(launch=file.name), parameters())

    def test_defaults_leave_the_config_file_and_the_clock_alone(self):
        default = parameters()
        rectify = (yaml.safe_load((SOURCE_DIR / "config/stereo.yaml").read_text()) or {}).get("rectify") or {}
        for name in ("approximate_sync", "max_skew"):
            self.assertEqual(default.get(f"/uav_landing/rectify/{name}"), rectify.get(name))
        self.assertEqual(default["/uav_landing/kalman_height/base_frame"], "")
        self.assertNotIn("/use_sim_time", default)

    def test_parameters_of_an_earlier_launch_end_with_it(self):
        for file, nodelets in (("stereo", ("rectify", "stereo_depth", "approach_angle", "kalman_height", "overlay")),
                               ("autopilot", ("autopilot",))):
            config = roslaunch.config.ROSLaunchConfig()
            roslaunch.xmlloader.XmlLoader().load(str(LAUNCH / f"{file}.launch"), config, verbose=False)
            for nodelet in nodelets:
                self.assertIn(f"/uav_landing/{nodelet}/", config.clear_params)
            if file == "stereo":
                for shared in ("rig", "runway"):
                    self.assertIn(f"/uav_landing/{shared}/", config.clear_params)

    def test_topics_of_any_name(self):
        names = ("left_image", "left_info", "right_image", "right_info")
        rig = parameters("camera:=rig")
        self.assertEqual([rig[f"/uav_landing/rectify/{name}"] for name in names],
                         ["/rig/left/image_raw", "/rig/left/camera_info", "/rig/right/image_raw", "/rig/right/camera_info"])
        given = parameters(*(f"{name}:=/cam/{name}" for name in names))
        self.assertEqual([given[f"/uav_landing/rectify/{name}"] for name in names], [f"/cam/{name}" for name in names])

    def test_images_with_both_pictures_start_what_splits_them(self):
        def splitters(*arguments):
            config = roslaunch.config.ROSLaunchConfig()
            loader = roslaunch.xmlloader.XmlLoader()
            loader.load(str(LAUNCH / "stereo.launch"), config, argv=list(arguments), verbose=False)
            return [node.args for node in config.nodes if node.type == "split_images"]
        self.assertEqual(splitters(), [])
        for name, option in (("side_by_side", "--side-by-side"), ("top_and_bottom", "--top-and-bottom")):
            self.assertEqual(splitters(f"{name}:=/usb_cam/image", "left_calibration:=/l.yaml", "right_calibration:=/r.yaml", "camera:=rig"),
                             [f'{option} /usb_cam/image --camera rig --left-calibration "/l.yaml" --right-calibration "/r.yaml"'])

    def test_values_reach_the_nodelets(self):
        given = parameters("approximate_sync:=true", "max_skew:=0.02", "base_frame:=base_link", "bag:=/tmp/a.bag")
        self.assertEqual(given["/uav_landing/rectify/approximate_sync"], True)
        self.assertEqual(given["/uav_landing/rectify/max_skew"], 0.02)
        self.assertEqual(given["/uav_landing/kalman_height/base_frame"], "base_link")
        self.assertEqual(given["/use_sim_time"], True)

    def test_the_runways_width_has_one_place_for_all_nodelets(self):
        def widths(*arguments):
            return {name: value for name, value in parameters(*arguments).items() if "width" in name}

        with tempfile.NamedTemporaryFile("w", suffix=".yaml") as file:
            file.write("runway: {width: 25}")
            file.flush()
            self.assertEqual(widths(), {}, "what is drawn has its default in the nodelet")
            self.assertEqual(widths("runway_width:=45"), {"/uav_landing/runway/width": 45})
            self.assertEqual(widths(f"config:={file.name}"), {"/uav_landing/runway/width": 25})
            self.assertEqual(widths(f"config:={file.name}", "runway_width:=45"), {"/uav_landing/runway/width": 45})
        self.assertEqual(widths("drawn_runway_width:=20"), {"/uav_landing/kalman_height/drawn_runway_width": 20})

    def test_no_inertial_sensor_can_be_asked_for(self):
        self.assertEqual(parameters("imu:=none")["/uav_landing/approach_angle/imu"], "")
        self.assertEqual(parameters("imu:=/my/imu")["/uav_landing/approach_angle/imu"], "/my/imu")


if __name__ == "__main__":
    unittest.main()
