import re
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import cv2
import numpy as np
import rosbag
import rospy
from sensor_msgs.msg import CameraInfo, CompressedImage, Image

from project import BUILD_DIR, SOURCE_DIR, run
from python_program import run_here
from stereo_bag import CALIBRATION_FILE, HEIGHT, WIDTH, image, noise, noise_frames, write_bag

sys.path.insert(0, str(SOURCE_DIR / "src/tools"))
from conversion.errors import LeftOut  # noqa: E402
from conversion.pictures import decoded  # noqa: E402
from conversion.sources import Videos  # noqa: E402

CONVERT = SOURCE_DIR / "src/tools/convert_recording"
PROCESS = BUILD_DIR / "devel/lib/uav_landing/process_bag"

SENSOR = """%YAML:1.0
T_BS:
  cols: 4
  rows: 4
  data: {pose}
resolution: [160, 120]
distortion_model: {model}
intrinsics: [150.0, 151.0, 79.0, 60.5]
distortion_coefficients: [-0.2, 0.05, 0.001, -0.0005]
"""


class ConvertRecordingTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.output = self.folder / "out.bag"

    def convert(self, kind, *arguments):
        return run_here(CONVERT, kind, *arguments, "--output", self.output)

    def converted(self, *arguments):
        """Messages by topic."""
        result = self.convert(*arguments)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.said = result.stderr
        messages = {}
        with rosbag.Bag(str(self.output)) as bag:
            for topic, message, _ in bag.read_messages():
                messages.setdefault(topic, []).append(message)
        return messages

    def refused(self, complaint, *arguments):
        result = self.convert(*arguments)
        self.assertEqual(result.returncode, 1, result.stdout)
        self.assertIn(complaint, result.stderr)
        self.assertNotIn("Traceback", result.stderr)
        self.assertFalse(self.output.exists())
        self.assertFalse(self.output.with_suffix(".bag.part").exists())

    def calibrations(self):
        files = [self.folder / "left.yaml", self.folder / "right.yaml"]
        for file, shift in zip(files, (0, -75)):
            file.write_text(CALIBRATION_FILE.format(side=file.stem, shift=shift, width=160))
        return ["--left-calibration", files[0], "--right-calibration", files[1]]

    def euroc(self, model="radial-tangential", baseline=0.4):
        # Body axes as EuRoC's: the cameras look along the body's z, a quarter turn about it, right camera at +x of the left.
        turn = np.array([[0, -1, 0, 0.1], [1, 0, 0, 0.2], [0, 0, 1, 0.3], [0, 0, 0, 1.0]])
        shift = np.eye(4)
        shift[0, 3] = baseline
        for camera, pose in (("cam0", turn), ("cam1", turn @ shift)):
            data = self.folder / "mav0" / camera / "data"
            data.mkdir(parents=True)
            (data.parent / "sensor.yaml").write_text(SENSOR.format(pose=pose.ravel().tolist(), model=model))
            stamps = [1403636579763555584 + 50000000 * i for i in range(4)]
            if camera == "cam1":
                del stamps[1]
            rows = ["#timestamp [ns],filename"]
            for number, stamp in enumerate(stamps):
                cv2.imwrite(str(data / f"{stamp}.png"), noise(number))
                rows.append(f"{stamp},{stamp}.png")
            (data.parent / "data.csv").write_text("\r\n".join(rows) + "\r\n")

    def test_euroc_folder_becomes_a_rectifiable_pair_of_cameras(self):
        self.euroc()
        messages = self.converted("euroc", self.folder)
        left, right = (messages[f"/stereo/{side}/image_raw"] for side in ("left", "right"))
        self.assertEqual([m.header.stamp.to_nsec() for m in left],
                         [1403636579763555584 + 50000000 * i for i in (0, 2, 3)])
        self.assertEqual([m.header.stamp for m in left], [m.header.stamp for m in right])
        info = messages["/stereo/right/camera_info"][0]
        self.assertEqual(info.K[:6], (150.0, 0, 79.0, 0, 151.0, 60.5))
        self.assertEqual(info.D, (-0.2, 0.05, 0.001, -0.0005, 0.0))
        self.assertAlmostEqual(-info.P[3] / info.P[0], 0.4, places=9)
        np.testing.assert_allclose(np.reshape(info.R, (3, 3)), np.eye(3), atol=1e-9)  # no turn between the cameras

    def test_euroc_folder_of_deep_pictures_keeps_their_bits(self):
        self.euroc()
        for file in sorted((self.folder / "mav0").glob("cam*/data/*.png")):
            cv2.imwrite(str(file), cv2.imread(str(file), cv2.IMREAD_UNCHANGED).astype(np.uint16) * 16 + 5)
        for message in self.converted("euroc", self.folder)["/stereo/left/image_raw"][:1]:
            self.assertEqual((message.encoding, message.step), ("mono16", 320))
            pixels = np.frombuffer(message.data, "<u2").reshape(120, 160)
            np.testing.assert_array_equal(pixels, noise(0).astype(np.uint16) * 16 + 5)

    def test_euroc_mistakes_are_named(self):
        self.refused("sensor.yaml: no such file", "euroc", self.folder)
        self.euroc(model="omni")
        self.refused("distortion_model omni: expected radial-tangential or equidistant", "euroc", self.folder)

    def test_euroc_folder_of_fisheye_lenses(self):
        self.euroc(model="equidistant")
        info = self.converted("euroc", self.folder)["/stereo/left/camera_info"][0]
        self.assertEqual((info.distortion_model, info.D), ("equidistant", (-0.2, 0.05, 0.001, -0.0005)))

    def test_euroc_tables_and_poses_that_are_none_are_named(self):
        self.euroc()
        table = self.folder / "mav0/cam0/data.csv"
        text = table.read_text()
        for bad in (b"\xff\xfe1", b"1," + b"x" * 200000):
            table.write_bytes(bad)
            self.refused("cam0/data.csv: cannot be read as a table", "euroc", self.folder)
        table.write_text(text)
        (self.folder / "mav0/cam1/sensor.yaml").write_text(SENSOR.format(pose=[0.0] * 16, model="radial-tangential"))
        self.refused("cam1/sensor.yaml: T_BS.data: expected a rotation", "euroc", self.folder)

    def test_a_namespace_is_a_name(self):
        self.euroc()
        result = self.convert("euroc", self.folder, "--camera", "/stereo")
        self.assertEqual(result.returncode, 2)
        self.assertIn("'/stereo' is not a name like stereo", result.stderr)

    def test_euroc_cameras_in_the_wrong_order_are_refused(self):
        self.euroc(baseline=-0.4)
        self.refused("not to the right of the first", "euroc", self.folder)

    def test_a_folder_that_is_no_kitti_sequence_is_named_by_what_is_missing(self):
        self.refused("calib.txt: no such file", "kitti", self.folder)

    def test_kitti_sequence_keeps_its_calibration(self):
        for side in ("image_0", "image_1"):
            (self.folder / side).mkdir()
            for number in range(3):
                cv2.imwrite(str(self.folder / side / f"{number:06d}.png"), noise(number))
        (self.folder / "times.txt").write_text("0.000000e+00\n1.000000e-01\n2.000000e-01\n")
        (self.folder / "calib.txt").write_text("P0: 700 0 80 0 0 700 60 0 0 0 1 0 \nP1: 700 0 80 -378 0 700 60 0 0 0 1 0 \n")
        messages = self.converted("kitti", self.folder)
        stamps = [m.header.stamp.to_sec() for m in messages["/stereo/right/image_raw"]]
        self.assertEqual(stamps, [1.0, 1.1, 1.2])  # zero is no time in ROS
        self.assertAlmostEqual(messages["/stereo/right/camera_info"][0].P[3], -378)
        self.assertEqual(messages["/stereo/left/image_raw"][2].data, noise(2).tobytes())
        (self.folder / "times.txt").write_text("0\n")
        self.output.unlink()
        self.refused("times.txt: 1 times for 3 images", "kitti", self.folder)
        (self.folder / "times.txt").write_text("0\nnan\n2\n")
        self.refused("times.txt: expected one number of seconds a line", "kitti", self.folder)

    def video(self, name, count, size=(WIDTH, HEIGHT)):
        path = self.folder / name
        writer = cv2.VideoWriter(str(path), cv2.VideoWriter_fourcc(*"MJPG"), 20, size)
        for number in range(count):
            writer.write(np.full((size[1], size[0], 3), 20 * number + 20, np.uint8))
        writer.release()
        return path

    def test_videos_are_paired_by_number_after_what_is_skipped(self):
        left, right = self.video("l.avi", 6), self.video("r.avi", 5)
        messages = self.converted("videos", left, right, *self.calibrations(), "--skip-left", 2)
        grey = {side: [np.mean(np.frombuffer(m.data, np.uint8)) for m in messages[f"/stereo/{side}/image_raw"]]
                for side in ("left", "right")}
        np.testing.assert_allclose(grey["left"], [60, 80, 100, 120], atol=3)
        np.testing.assert_allclose(grey["right"], [20, 40, 60, 80], atol=3)
        stamps = [m.header.stamp.to_sec() for m in messages["/stereo/left/image_raw"]]
        np.testing.assert_allclose(np.diff(stamps), 0.05, atol=1e-6)
        self.assertEqual(messages["/stereo/right/camera_info"][0].P[3], -75)

    def test_a_video_that_ends_early_is_told_unless_its_header_is_about_right(self):
        for count, said in ((98, []), (97, ["ends after 97 images, 100 by its header: the rest is damaged or missing"])):
            left_out, video = LeftOut(), self.folder / f"{count}.avi"
            reader = Videos([video], [], left_out)
            capture = mock.Mock()
            capture.grab.side_effect = count * [True] + [False]
            capture.retrieve.return_value = (True, np.zeros((4, 4, 3), np.uint8))
            capture.get.side_effect = {cv2.CAP_PROP_FPS: 20, cv2.CAP_PROP_FRAME_COUNT: 100}.get
            with self.subTest(count), mock.patch("cv2.VideoCapture", return_value=capture):
                self.assertEqual(len(list(reader.frames(video, 0))), count)
                self.assertEqual(left_out.lines(), [f"{video}: {text}" for text in said])

    def test_video_mistakes_are_named(self):
        good, large = self.video("l.avi", 2), self.video("large.avi", 2, (320, 240))
        self.refused("none.avi: no such video", "videos", good, self.folder / "none.avi", *self.calibrations())
        self.refused("320x240 pixels, its calibration is for 160x120", "videos", good, large, *self.calibrations())
        self.refused("l.avi: given twice; if it has both images in one, give it once, with --side-by-side", "videos", good, good,
                     *self.calibrations())
        self.refused("l.avi: each half, side-by-side, 80x120 pixels, its calibration is for 160x120", "videos", good,
                     "--side-by-side", *self.calibrations())
        self.assertEqual(self.convert("videos", good, *self.calibrations()).returncode, 2)

    def test_numbers_that_are_none_in_a_calibration_are_named(self):
        good, files, other = self.video("l.avi", 2), self.calibrations(), self.video("r.avi", 2)
        text = files[1].read_text()
        for old, new, complaint in (("cols: 5, data: [0, 0, 0, 0, 0]", "data: 5", "data: expected a list of numbers"),
                                    ("data: [0, 0, 0, 0, 0]", "data: [0, x]", "data: expected 2 finite numbers"),
                                    ("image_width: 160", "image_width: wide", "image_width: expected 1 finite numbers")):
            with self.subTest(new):
                files[1].write_text(text.replace(old, new))
                self.refused(f"{files[1]}: ", "videos", good, other, *files)
                self.refused(complaint, "videos", good, other, *files)

    def test_calibration_files_are_read_as_ros_reads_them(self):
        good, also, files = self.video("l.avi", 2), self.video("r.avi", 2), self.calibrations()
        plain = [file.read_text() for file in files[1::2]]
        tagged = [re.sub(r": \{rows: (\d+), cols: (\d+), data: (.*)\}", r": !!opencv-matrix\n  rows: \1\n  cols: \2\n"
                         r"  dt: d\n  data: \3", "%YAML:1.0\n---\n" + text) for text in plain]
        nameless = [text.replace("distortion_model: plumb_bob\n", "") for text in plain]
        section = "# oST version 5.0 parameters\n\n[image]\n\nwidth\n160\n\nheight\n120\n\n[{}]\n\ncamera matrix\n150 0 80\n" \
                  "0 150 60\n0 0 1\n\ndistortion\n0 0 0 0 0\n\nrectification\n1 0 0\n0 1 0\n0 0 1\n\nprojection\n150 0 80 {}\n" \
                  "0 150 60 0\n0 0 1 0\n\n"
        ini = [section.format("camera", shift) for shift in (0, -75)]
        both = [section.format("narrow_stereo/left", 0) + section.format("narrow_stereo/right", -75)] * 2
        expected = self.converted("videos", good, also, *files)["/stereo/right/camera_info"][0]
        for name, texts in (("tags", tagged), ("no distortion_model", nameless), ("ini", ini), ("ost.txt", both)):
            with self.subTest(name):
                for file, text in zip(files[1::2], texts):
                    file.write_text(text)
                info = self.converted("videos", good, also, *files)["/stereo/right/camera_info"][0]
                self.assertEqual(info, expected)

    def test_a_file_of_a_stereo_pair_is_named_as_such(self):
        good, also, files = self.video("l.avi", 2), self.video("r.avi", 2), self.calibrations()
        files[1].write_text("cam0: {resolution: [160, 120]}\ncam1: {}\n")
        self.refused("is of a stereo pair, not of one camera: make left.yaml and right.yaml of it by convert_recording "
                     "calibration", "videos", good, also, *files)

    # The right camera's axes are turned, and it stands 0.3 m to the right of, below and before the left one, by hand:
    # x_right = R (x_left - c).
    PLACE = np.array([0.3, 0.006, -0.01])

    def pose(self):
        R = cv2.Rodrigues(np.array([0.01, -0.02, 0.015]))[0]
        return R, -R @ self.PLACE

    def camchain(self, distortion="radtan", swapped=False):
        R, t = self.pose()
        pose = np.vstack([np.column_stack([R, t]), [0, 0, 0, 1]])
        pose = np.linalg.inv(pose) if swapped else pose
        lens = (f"camera_model: pinhole, distortion_model: {distortion}, distortion_coeffs: [-0.1, 0.02, 0.001, -0.002], "
                "intrinsics: [150.0, 151.0, 79.0, 60.5], resolution: [160, 120]")
        path = self.folder / "camchain.yaml"
        path.write_text(f"cam0: {{{lens}, rostopic: /a}}\ncam1: {{{lens}, T_cn_cnm1: {pose.tolist()}}}\n")
        return path

    def opencv_files(self, scale):
        R, t = self.pose()
        K = np.array([[150.0, 0, 79], [0, 151, 60.5], [0, 0, 1]])
        D = np.array([[-0.1, 0.02, 0.001, -0.002, 0]])
        paths = self.folder / "intrinsics.yml", self.folder / "extrinsics.yml"
        for path, entries in zip(paths, ({"M1": K, "D1": D, "M2": K, "D2": D}, {"R": R, "T": scale * t.reshape(3, 1)})):
            storage = cv2.FileStorage(str(path), cv2.FILE_STORAGE_WRITE)
            for name, value in entries.items():
                storage.write(name, value)
            storage.release()
        return paths

    def made_from(self, *arguments):
        """What was printed, and the two cameras that came of it."""
        folder = self.folder / "made"
        result = run_here(CONVERT, "calibration", *arguments, "--output", folder)
        self.assertEqual(result.returncode, 0, result.stderr)
        good, also = self.video("v.avi", 2), self.video("w.avi", 2)
        messages = self.converted("videos", good, also, "--left-calibration", folder / "left.yaml", "--right-calibration",
                                  folder / "right.yaml")
        return result.stdout, [messages[f"/stereo/{side}/camera_info"][0] for side in ("left", "right")]

    def assert_right_pair(self, left, right):
        """A point 5 m ahead lies in one row, and as far apart as the distance of the cameras makes it."""
        R, t = self.pose()
        point = np.array([0.4, -0.3, 5.0])
        pixels = []
        for info, x in ((left, point), (right, R @ point + t)):
            projected = np.reshape(info.P, (3, 4))[:, :3] @ np.reshape(info.R, (3, 3)) @ x
            pixels.append(projected[:2] / projected[2])
            depth = projected[2]
        distance = np.linalg.norm(self.PLACE)
        self.assertAlmostEqual(-right.P[3] / right.P[0], distance, places=9)
        self.assertAlmostEqual(pixels[0][1], pixels[1][1], places=6)
        self.assertAlmostEqual(pixels[0][0] - pixels[1][0], left.P[0] * distance / depth, places=6)

    def test_stereo_calibrations_of_others_become_those_of_ros(self):
        for arguments in ([self.camchain()], [*self.opencv_files(1000), "--unit", "mm", "--size", "160x120"]):
            with self.subTest(arguments[0].name):
                said, cameras = self.made_from(*arguments)
                self.assertIn("baseline 0.3002 m", said)
                self.assertEqual(cameras[0].distortion_model, "plumb_bob")
                self.assert_right_pair(*cameras)

    def test_a_camchain_of_fisheye_lenses_and_one_that_begins_with_the_right_camera(self):
        said, cameras = self.made_from(self.camchain("equidistant", swapped=True))
        self.assertIn("the second camera is the left one", said)
        self.assertEqual([info.distortion_model for info in cameras], ["equidistant"] * 2)
        self.assert_right_pair(*cameras)

    def test_what_a_stereo_calibration_does_not_say_is_asked_for(self):
        def refusal(*arguments):
            result = run_here(CONVERT, "calibration", *arguments, "--output", self.folder / "made")
            self.assertEqual((result.returncode, "Traceback" in result.stderr), (1, False), result.stderr)
            return result.stderr
        files = self.opencv_files(1000)
        self.assertIn("do not say how large the images are: give --size WIDTHxHEIGHT", refusal(*files))
        self.assertIn("T is 300.2 long, in the unit of the board's squares: say which gives the baseline: --unit m "
                      "(300.2 m), --unit cm (3.002 m), --unit mm (0.3002 m)", refusal(*files, "--size", "160x120"))
        self.assertIn("no R, the pose between the cameras: expected one of R, rotation",
                      refusal(files[0], "--size", "160x120"))
        self.assertIn("expected pinhole with radtan, equidistant, none", refusal(self.camchain("fov")))
        self.assertIn("is a calibration file of ROS already", refusal(self.calibrations()[1]))
        (self.folder / "notes.txt").write_text("no calibration")
        self.assertIn("notes.txt: cannot be read as a FileStorage of OpenCV", refusal(self.folder / "notes.txt"))

    def test_compressed_images_keep_their_bits_and_channels(self):
        pixels = noise(5)
        deep = pixels.astype(np.uint16) * 4
        colour = np.dstack([pixels, pixels[::-1], 255 - pixels])
        cases = ((".png", deep, "mono16; png compressed ", "mono16"), (".png", pixels, "bayer_grbg8; png compressed ", "bayer_grbg8"),
                 (".png", deep, "bayer_rggb16; png compressed ", "bayer_rggb16"), (".png", colour, "bgr8; png compressed bgr8", "bgr8"),
                 (".png", np.dstack([colour, pixels]), "bgra8; png compressed ", "bgra8"),
                 (".jpg", colour, "bayer_rggb8; jpeg compressed bgr8", "bgr8"), (".jpg", pixels, "jpeg", "mono8"))
        for suffix, picture, compressed_format, encoding in cases:
            with self.subTest(compressed_format):
                path = self.folder / "deep.bag"
                with rosbag.Bag(str(path), "w") as bag:
                    for side in ("left", "right"):
                        message = CompressedImage(format=compressed_format, data=cv2.imencode(suffix, picture)[1].tobytes())
                        message.header.stamp.secs = 10
                        bag.write(f"/{side}/compressed", message)
                messages = self.converted("bag", path, "--left", "/left/compressed", "--right", "/right/compressed",
                                          *self.calibrations())
                image = messages["/stereo/left/image_raw"][0]
                self.assertEqual(image.encoding, encoding)
                if suffix == ".png":
                    self.assertEqual(image.data, picture.tobytes())

    def renamed_bag(self, compressed):
        """A bag of /cam0/image... and /cam1/image..."""
        path = self.folder / "in.bag"
        write_bag(self.folder / "plain.bag", noise_frames())
        suffix = "/compressed" if compressed else ""
        with rosbag.Bag(str(self.folder / "plain.bag")) as bag, rosbag.Bag(str(path), "w") as result:
            for topic, message, time in bag.read_messages():
                _, _, side, name = topic.split("/")
                camera = {"left": "cam0", "right": "cam1"}[side]
                if name == "image_raw":
                    if compressed:
                        pixels = np.frombuffer(message.data, np.uint8).reshape(HEIGHT, WIDTH)
                        message = CompressedImage(header=message.header, format="mono8; png compressed",
                                                  data=cv2.imencode(".png", pixels)[1].tobytes())
                    result.write(f"/{camera}/image{suffix}", message, time)
                else:
                    result.write(f"/{camera}/camera_info", message, time)
        return path

    def test_bag_with_other_names_and_compressed_images_runs_through_the_chain(self):
        for suffix in ("", "/compressed"):
            bag = self.renamed_bag(bool(suffix))
            messages = self.converted("bag", bag, "--left", "/cam0/image" + suffix, "--right", "/cam1/image" + suffix)
            self.assertEqual({topic: len(found) for topic, found in messages.items()},
                             {f"/stereo/{side}/{kind}": 3 for side in ("left", "right") for kind in ("image_raw", "camera_info")})
            self.assertEqual(messages["/stereo/right/image_raw"][1].data, noise(3).tobytes())
            result = run([PROCESS, "--input", self.output])
            self.assertEqual(result.returncode, 0, result.stderr)

    def test_calibration_files_replace_those_of_the_bag(self):
        messages = self.converted("bag", self.renamed_bag(False), "--left", "/cam0/image", "--right", "/cam1/image",
                                  *self.calibrations())
        infos = messages["/stereo/right/camera_info"]
        self.assertEqual([info.header.stamp for info in infos],
                         [m.header.stamp for m in messages["/stereo/right/image_raw"]])
        self.assertEqual((len(infos), infos[0].K[2]), (3, 80))

    def late_bag(self, seconds):
        """A bag whose right camera stamps its messages late by a constant, with stamps of the left one from 10.0 s on."""
        path = self.folder / "late.bag"
        write_bag(self.folder / "plain.bag", noise_frames(4))
        with rosbag.Bag(str(self.folder / "plain.bag")) as bag, rosbag.Bag(str(path), "w") as result:
            for topic, message, time in bag.read_messages():
                if "/right/" in topic:
                    message.header.stamp += rospy.Duration.from_sec(seconds)
                result.write(topic, message, time)
        return path

    def test_stamps_of_a_late_right_camera_are_made_earlier(self):
        topics = ("--left", "/stereo/left/image_raw", "--right", "/stereo/right/image_raw")
        for seconds in (0.015, -0.02):
            for calibrations in ([], self.calibrations()):
                with self.subTest(seconds=seconds, files=bool(calibrations)):
                    messages = self.converted("bag", self.late_bag(seconds), *topics, *calibrations, f"--right-delay={seconds}")
                    for topic, found in messages.items():
                        self.assertEqual([m.header.stamp.to_nsec() for m in found], [10 ** 10 + 10 ** 8 * i for i in range(4)], topic)
                    self.assertIn("4 pairs, ", run([PROCESS, "--input", self.output]).stdout)

    def test_a_message_without_a_stamp_has_none_after_a_delay_was_taken_out(self):
        bag = self.late_bag(0)
        with rosbag.Bag(str(bag), "a") as result:
            result.write("/stereo/right/camera_info", CameraInfo(), rospy.Time(11))
        messages = self.converted("bag", bag, "--left", "/stereo/left/image_raw", "--right", "/stereo/right/image_raw",
                                  "--right-delay", "0.015")
        self.assertIn(rospy.Time(0), [m.header.stamp for m in messages["/stereo/right/camera_info"]])

    def test_a_delay_that_cannot_be_is_refused(self):
        topics = ("--left", "/stereo/left/image_raw", "--right", "/stereo/right/image_raw")
        self.refused("/stereo/right/image_raw: the stamp 10.015000 s cannot be made earlier by 11 s: give a smaller --right-delay",
                     "bag", self.late_bag(0.015), *topics, "--right-delay", "11")
        for text in ("nan", "inf", "86401", "-86401", "soon"):
            result = self.convert("bag", self.late_bag(0.015), *topics, f"--right-delay={text}")
            self.assertEqual(result.returncode, 2)
            self.assertIn(f"'{text}' is not a number of seconds from -86400 to 86400", result.stderr)
        result = self.convert("bag", self.late_bag(0), "--side-by-side", "/usb_cam/image_raw", "--right-delay", "0.1")
        self.assertEqual(result.returncode, 2)
        self.assertIn("--right-delay is for two topics: both images of --side-by-side have the same stamp", result.stderr)

    def compressed_bag(self, broken, count=12, suffix=".jpg", times=1):
        """Images of two cameras; broken: {number: data of the left one}; times: of 16 bits when more than 1."""
        path = self.folder / "jpeg.bag"
        with rosbag.Bag(str(path), "w") as result:
            for number, frame in enumerate(noise_frames(count)):
                for side in ("left", "right"):
                    message = CompressedImage(format="mono8; jpeg compressed ")
                    message.header.stamp = rospy.Time.from_sec(frame.stamp)
                    pixels = np.frombuffer(frame.messages[f"{side}/image_raw"].data, np.uint8).reshape(HEIGHT, WIDTH)
                    deep = pixels if times == 1 else pixels.astype(np.uint16) * times
                    message.data = cv2.imencode(suffix, deep)[1].tobytes()
                    if side == "left" and number in broken:
                        message.data = broken[number](message.data)
                    result.write(f"/cam/{side}/image_raw/compressed", message, message.header.stamp)
        return path

    def test_broken_pictures_of_many_are_left_out_named_and_counted(self):
        bag = self.compressed_bag({3: lambda data: b"", 5: lambda data: data[:len(data) // 2], 8: lambda data: b"no image"})
        messages = self.converted("bag", bag, "--left", "/cam/left/image_raw/compressed", "--right", "/cam/right/image_raw/compressed",
                                  *self.calibrations())
        numbers = [round(10 * m.header.stamp.to_sec()) - 100 for m in messages["/stereo/left/image_raw"]]
        self.assertEqual(numbers, [0, 1, 2, 4, 6, 7, 9, 10, 11])
        self.assertEqual(len(messages["/stereo/right/image_raw"]), 12)
        self.assertEqual(self.said, "".join(
            f"convert_recording: left out: /cam/left/image_raw/compressed: an image with format 'mono8; jpeg compressed ' at {stamp} "
            "s cannot be decoded to grey or colour of 8 or 16 bits\n" for stamp in ("10.300000", "10.500000", "10.800000"))
            + "convert_recording: 3 broken images were left out\n")
        result = run([PROCESS, "--input", self.output])
        self.assertEqual(result.returncode, 0)
        self.assertIn("9 pairs, ", result.stdout)

    def test_broken_pictures_of_16_bits_are_left_out(self):
        bag = self.compressed_bag({3: lambda data: data[:len(data) // 2], 5: lambda data: data[:100]}, 12, ".png", 16)
        messages = self.converted("bag", bag, "--left", "/cam/left/image_raw/compressed", "--right", "/cam/right/image_raw/compressed",
                                  *self.calibrations())
        found = messages["/stereo/left/image_raw"]
        self.assertEqual((len(found), {m.encoding for m in found}), (10, {"mono16"}))
        self.assertIn("convert_recording: 2 broken images were left out\n", self.said)

    def test_jpegs_without_an_end_marker_are_used_unless_they_are_cut(self):
        def cut(share):
            return lambda data: data[:int(share * len(data))]

        def cut_and_filled_up(data):
            return data[:-400] + 300 * b"\0"

        bag = self.compressed_bag({1: cut(0.3), 2: cut(0.98), 3: lambda data: data[:-2], 4: lambda data: data[:-2] + 300 * b"\0",
                                   5: cut_and_filled_up, 6: lambda data: data[:60]})
        messages = self.converted("bag", bag, "--left", "/cam/left/image_raw/compressed", "--right", "/cam/right/image_raw/compressed",
                                  *self.calibrations())
        found = {round(10 * m.header.stamp.to_sec()) - 100: m for m in messages["/stereo/left/image_raw"]}
        self.assertEqual(sorted(found), [0, 3, 4, 7, 8, 9, 10, 11])
        self.assertEqual(self.said.count("left out: "), 4)
        self.assertNotIn("Corrupt JPEG", self.said)
        with rosbag.Bag(str(bag)) as recorded:
            raw = [m.data for topic, m, _ in recorded.read_messages() if "left" in topic]
        for number in (3, 4):
            pixels = cv2.imdecode(np.frombuffer(raw[number].rstrip(b"\0") + b"\xff\xd9", np.uint8), cv2.IMREAD_UNCHANGED)
            self.assertEqual(found[number].data, pixels.tobytes(), "to its last row")

    def test_a_jpeg_of_any_kind_is_whole_without_its_end_marker_alone(self):
        smooth = cv2.GaussianBlur(noise(1), (0, 0), 3)
        for kind, pixels, options in (("grey", noise(1), []), ("restarts", noise(1), [cv2.IMWRITE_JPEG_RST_INTERVAL, 5]),
                                      ("colour", np.dstack([smooth, noise(2), 255 - smooth]), []),
                                      ("odd size", smooth[:-3, :-5], []), ("progressive", smooth, [cv2.IMWRITE_JPEG_PROGRESSIVE, 1])):
            data = cv2.imencode(".jpg", pixels, options)[1].tobytes()
            whole = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_UNCHANGED)
            with self.subTest(kind):
                np.testing.assert_array_equal(decoded(data, cv2.IMREAD_UNCHANGED), whole)
                if kind != "progressive":  # a further scan may be missing
                    np.testing.assert_array_equal(decoded(data[:-2], cv2.IMREAD_UNCHANGED), whole)
                for end in range(2, len(data) - 60, 37):  # up to the last block
                    self.assertIsNone(decoded(data[:end], cv2.IMREAD_UNCHANGED), f"{end} of {len(data)} bytes")

    def test_where_all_are_broken_the_bag_is_refused(self):
        bag = self.compressed_bag(dict.fromkeys(range(12), lambda data: b""))
        self.refused("/cam/left/image_raw/compressed: an image with format 'mono8; jpeg compressed ' at 10.000000 s cannot be decoded",
                     "bag", bag, "--left", "/cam/left/image_raw/compressed", "--right", "/cam/right/image_raw/compressed",
                     *self.calibrations())

    def test_a_broken_picture_of_a_folder_is_left_out(self):
        self.euroc()
        broken = sorted((self.folder / "mav0/cam1/data").iterdir())[1]
        broken.write_bytes(broken.read_bytes()[:200])
        messages = self.converted("euroc", self.folder)
        self.assertEqual([len(found) for found in messages.values()], 4 * [2])
        self.assertEqual(self.said, f"convert_recording: left out: {broken}: no such image, or damaged\n"
                                    "convert_recording: 1 broken image was left out\n")

    def joined_bag(self, axis, encoding, compressed=False):
        """Both images in one, and the expected halves."""
        path, expected = self.folder / "joined.bag", {"left": [], "right": []}
        with rosbag.Bag(str(path), "w") as result:
            for number, frame in enumerate(noise_frames(4)):
                pictures = [noise(2 * number), noise(2 * number + 1)]
                if encoding in ("bgr8", "yuyv"):
                    pictures = [np.dstack([picture, picture // 2, 255 - picture][:2 if encoding == "yuyv" else 3])
                                for picture in pictures]
                elif encoding.endswith("16"):
                    pictures = [picture.astype(np.uint16) * 16 for picture in pictures]
                for side, picture in zip(expected, pictures):
                    expected[side].append(picture.tobytes())
                joined = np.concatenate(pictures, axis)
                if compressed:
                    message = CompressedImage(format=f"{encoding}; png compressed ", data=cv2.imencode(".png", joined)[1].tobytes())
                else:
                    message = image(joined, encoding)
                message.header.stamp = rospy.Time.from_sec(frame.stamp)
                result.write("/usb_cam/image_raw", message, message.header.stamp)
        return path, expected

    def test_pictures_side_by_side_or_one_above_the_other_are_cut(self):
        for option, axis, encoding, compressed in (("--side-by-side", 1, "mono8", False), ("--side-by-side", 1, "bgr8", False),
                                                   ("--side-by-side", 1, "mono16", False), ("--side-by-side", 1, "mono16", True),
                                                   ("--side-by-side", 1, "bayer_grbg8", False), ("--side-by-side", 1, "yuyv", False),
                                                   ("--side-by-side", 1, "bayer_rggb16", True), ("--top-and-bottom", 0, "bayer_rggb16", False),
                                                   ("--side-by-side", 1, "bgr8", True), ("--top-and-bottom", 0, "mono8", False),
                                                   ("--top-and-bottom", 0, "bgr8", True)):
            with self.subTest(option=option, encoding=encoding, compressed=compressed):
                bag, expected = self.joined_bag(axis, encoding, compressed)
                messages = self.converted("bag", bag, option, "/usb_cam/image_raw", *self.calibrations())
                for side, pictures in expected.items():
                    found = messages[f"/stereo/{side}/image_raw"]
                    self.assertEqual([m.data for m in found], pictures)
                    self.assertEqual({(m.width, m.height, m.encoding) for m in found}, {(WIDTH, HEIGHT, encoding)})
                    infos = messages[f"/stereo/{side}/camera_info"]
                    self.assertEqual([m.header.stamp for m in infos], [m.header.stamp for m in found])
                    self.assertEqual({info.width for info in infos}, {WIDTH})
                self.assertEqual(run([PROCESS, "--input", self.output]).returncode, 0)

    def test_what_is_wrong_with_halves_is_named(self):
        bag, _ = self.joined_bag(1, "mono8")
        both = ("bag", bag, "--left", "/usb_cam/image_raw", "--right", "/usb_cam/image_raw")
        self.refused("left and right must be different topics; if /usb_cam/image_raw has both images in one: --side-by-side "
                     "/usb_cam/image_raw", *both, *self.calibrations())
        self.refused("/usb_cam/image_raw has both images: give the calibration of each half, --left-calibration or --left-info",
                     "bag", bag, "--side-by-side", "/usb_cam/image_raw")
        self.refused("/usb_cam/image_raw: each half (top-and-bottom) has 320x60 pixels, the left calibration is for 160x120: "
                     "calibrate with the halves", "bag", bag, "--top-and-bottom", "/usb_cam/image_raw", *self.calibrations())
        self.assertEqual(self.convert("bag", bag, "--left", "/usb_cam/image_raw").returncode, 2)

    def test_halves_that_begin_with_other_colours_are_refused(self):
        for option, encoding, pixels, size in (("--side-by-side", "bayer_rggb8", np.zeros((8, 10), np.uint8), "10x8"),
                                               ("--top-and-bottom", "bayer_rggb8", np.zeros((6, 8), np.uint8), "8x6"),
                                               ("--side-by-side", "uyvy", np.zeros((8, 10, 2), np.uint8), "10x8")):
            with self.subTest(option=option, encoding=encoding):
                path = self.folder / "odd.bag"
                with rosbag.Bag(str(path), "w") as result:
                    result.write("/usb_cam/image_raw", image(pixels, encoding))
                self.refused(f"an image of {size} pixels {encoding} cannot be cut in two", "bag", path, option, "/usb_cam/image_raw",
                             *self.calibrations())

    def test_one_video_with_both_pictures(self):
        path = self.folder / "both.avi"
        for option, axis in (("--side-by-side", 1), ("--top-and-bottom", 0)):
            size = (2 * WIDTH, HEIGHT) if axis else (WIDTH, 2 * HEIGHT)
            writer = cv2.VideoWriter(str(path), cv2.VideoWriter_fourcc(*"MJPG"), 20, size)
            for number in range(4):
                writer.write(np.concatenate([np.full((HEIGHT, WIDTH, 3), grey, np.uint8) for grey in (50 + number, 200 - number)], axis))
            writer.release()
            messages = self.converted("videos", path, option, *self.calibrations())
            for side, grey, step in (("left", 50, 1), ("right", 200, -1)):
                found = [np.frombuffer(m.data, np.uint8).reshape(HEIGHT, WIDTH)[10:-10, 10:-10] for m in
                         messages[f"/stereo/{side}/image_raw"]]
                np.testing.assert_allclose([[np.min(m), np.max(m)] for m in found], [2 * [grey + step * i] for i in range(4)], atol=2)

    def interlaced_bag(self, encoding, steady):
        """Every second row is of another time."""
        path = self.folder / f"{encoding}.bag"
        with rosbag.Bag(str(path), "w") as result:
            for frame in noise_frames(3):
                for side in ("left", "right"):
                    pixels = steady.copy()
                    pixels[1::2] = 255
                    message = Image(height=HEIGHT, width=WIDTH, encoding=encoding, is_bigendian=steady.dtype == ">u2",
                                    step=WIDTH * steady.itemsize, data=pixels.tobytes())
                    message.header.stamp = rospy.Time.from_sec(frame.stamp)
                    result.write(f"/cam/{side}/image_raw", message, message.header.stamp)
        return path

    def test_one_field_of_interlaced_pictures(self):
        ramp = np.repeat(2 * np.arange(HEIGHT)[:, None], WIDTH, 1)  # rows between are half way
        for encoding, kind, factor in (("mono8", "u1", 1), ("mono16", "<u2", 15), ("16UC1", ">u2", 270)):
            steady = (factor * ramp).astype(kind)
            with self.subTest(kind):
                messages = self.converted("bag", self.interlaced_bag(encoding, steady), "--left", "/cam/left/image_raw", "--right",
                                          "/cam/right/image_raw", "--deinterlace", *self.calibrations())
                for message in messages["/stereo/left/image_raw"]:
                    pixels = np.frombuffer(message.data, kind).reshape(HEIGHT, WIDTH)
                    np.testing.assert_array_equal(pixels[:-1], steady[:-1])
                    np.testing.assert_array_equal(pixels[-1], steady[-2])
                self.output.unlink()
        bayer = self.interlaced_bag("bayer_rggb8", ramp.astype(np.uint8))
        self.refused("bayer_rggb8: only images with the same colours in all rows are deinterlaced", "bag", bayer, "--left",
                     "/cam/left/image_raw", "--right", "/cam/right/image_raw", "--deinterlace", *self.calibrations())

    def test_bag_mistakes_are_named(self):
        bag = self.renamed_bag(True)
        self.refused("no topic /cam2/image; images are on: /cam0/image/compressed, /cam1/image/compressed", "bag", bag,
                     "--left", "/cam0/image/compressed", "--right", "/cam2/image")
        self.refused("must be different topics", "bag", bag, "--left", "/cam0/image", "--right", "/cam0/image")
        with rosbag.Bag(str(bag), "a") as result:
            result.write("/cam3/image/compressed", CompressedImage(format="h264", data=b"no image"))
            result.write("/cam4/image/compressed", CompressedImage(format="png"))
        self.refused("/cam3/image/compressed: an image with format 'h264'", "bag", bag, "--left",
                     "/cam0/image/compressed", "--right", "/cam3/image/compressed", "--right-info", "/cam1/camera_info")
        self.refused("/cam4/image/compressed: an image with format 'png'", "bag", bag, "--left",
                     "/cam0/image/compressed", "--right", "/cam4/image/compressed", "--right-info", "/cam1/camera_info")
        (self.folder / "text.bag").write_text("no bag")
        self.refused("", "bag", self.folder / "text.bag", "--left", "/a", "--right", "/b")
        self.assertEqual(run_here(CONVERT, "bag").returncode, 2)


if __name__ == "__main__":
    unittest.main()
