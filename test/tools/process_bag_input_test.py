"""What process_bag says of input that it cannot use, or not fully."""

import csv
import math
import shutil
import tempfile
import unittest
from pathlib import Path

import cv2
import numpy as np
import rosbag
import rospy
from geometry_msgs.msg import TransformStamped
from sensor_msgs.msg import Imu
from tf2_msgs.msg import TFMessage

from project import BUILD_DIR, run
from stereo_bag import HEIGHT, WIDTH, image, noise, noise_frames, write_bag
from test_data import dataset

PROGRAMS = BUILD_DIR / "devel/lib/uav_landing"


class ProcessBagTest(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="uav_landing_process_bag_"))
        self.addCleanup(shutil.rmtree, str(self.folder))
        self.bag, self.csv = self.folder / "input.bag", self.folder / "estimates.csv"

    def process(self, *options):
        return run([PROGRAMS / "process_bag", "--input", self.bag, "--csv", self.csv, *options])

    def process_frames(self, frames, *options):
        write_bag(self.bag, frames)
        return self.process(*options)

    def rows(self):
        with self.csv.open() as file:
            return list(csv.DictReader(file))

    def assert_refused(self, result, *texts):
        """Exit status 1, a message with these texts, and no file left behind."""
        self.assertEqual(result.returncode, 1, result.stderr)
        for text in texts:
            self.assertIn(text, result.stderr)
        left = [path.name for path in self.folder.iterdir() if path != self.bag and path.suffix != ".yaml"]
        self.assertEqual(left, [])

    def assert_nothing_valid(self, rows):
        for row in rows:
            self.assertEqual(row["valid"], "0", row)
            self.assertEqual(row["height_valid"], "0", row)


class FilesTest(ProcessBagTest):
    def test_a_mask_is_refused_before_the_bag_is_read(self):
        config = self.folder / "rig.yaml"
        config.write_text("rig: {right_mask: nose.png}")
        self.assert_refused(self.process("--config", config), f"rig/right_mask: {self.folder / 'nose.png'}: no such file")

    def test_a_mask_of_another_size(self):
        write_bag(self.bag, noise_frames())
        config, mask = self.folder / "rig.yaml", self.folder / "masks"
        mask.mkdir()
        cv2.imwrite(str(mask / "nose.png"), np.full((2 * HEIGHT, 2 * WIDTH), 255, np.uint8))
        config.write_text("rig: {left_mask: masks/nose.png}")
        result = self.process("--config", config)
        shutil.rmtree(mask)
        self.assert_refused(result, f"no usable image pair: rig/left_mask: {mask / 'nose.png'}: is {2 * WIDTH}x{2 * HEIGHT}, "
                                    f"expected {WIDTH}x{HEIGHT}")

    def test_missing_bag(self):
        self.assert_refused(self.process(), str(self.bag), "no such file")

    def test_a_folder_is_no_bag(self):
        self.bag = self.folder / "flights"
        self.bag.mkdir()
        self.assert_refused(self.process(), f"{self.bag}: is a folder", "scripts/process_bags")

    def test_a_file_that_is_not_a_bag(self):
        self.bag.write_text("height,angle\n1,2\n")
        self.assert_refused(self.process(), str(self.bag), "cannot be read as a bag")

    def test_a_bag_that_was_cut_off(self):
        write_bag(self.bag, noise_frames())
        content = self.bag.read_bytes()
        self.bag.write_bytes(content[:len(content) // 2])
        self.assert_refused(self.process(), str(self.bag), "cannot be read as a bag", "rosbag reindex")

    def test_a_csv_that_cannot_be_written(self):
        write_bag(self.bag, noise_frames())
        self.csv = self.folder / "nowhere" / "estimates.csv"
        self.assert_refused(self.process(), str(self.csv), "cannot be written")

    def test_a_bag_that_cannot_be_written(self):
        write_bag(self.bag, noise_frames())
        output = self.folder / "nowhere" / "output.bag"
        self.assert_refused(self.process("--output", output), str(output), "cannot be written")

    def test_report_data_where_no_folder_can_be_made(self):
        write_bag(self.bag, noise_frames())
        folder = self.bag / "report"
        self.assert_refused(self.process("--report-data", folder), str(folder), "cannot be made")

    def test_a_picture_that_cannot_be_written(self):
        write_bag(self.bag, noise_frames())
        report = self.folder / "report"
        (report / "lines_left_000000.png.part.png").mkdir(parents=True)
        result = self.process("--report-data", report)
        self.assertEqual(result.returncode, 1)
        self.assertIn(f"{report}/lines_left_000000.png: cannot be written", result.stderr)
        self.assertFalse(self.csv.exists())

    def test_an_output_that_is_the_input(self):
        write_bag(self.bag, noise_frames())
        before = self.bag.read_bytes()
        self.assert_refused(self.process("--output", self.bag), "is the input")
        self.assert_refused(self.process("--output", self.csv), str(self.csv), "is the bag to write")
        self.csv = self.bag
        self.assert_refused(self.process(), "is the input")
        self.assertEqual(self.bag.read_bytes(), before)


class UsageTest(ProcessBagTest):
    def test_wrong_usage_has_exit_status_2(self):
        for options in ([], ["--input"], ["--input", "a.bag", "--nonsense"],
                        ["--input", "a.bag", "--camera", "no camera"]):
            with self.subTest(options=options):
                self.assertEqual(run([PROGRAMS / "process_bag", *options]).returncode, 2)

    def test_what_is_wrong_is_said_behind_the_programs_name(self):
        for options, message in ((["--input", "a.bag", "--cvs", "x.csv"], "--cvs: no such option; did you mean --csv?"),
                                 (["--imput=a.bag"], "--imput: no such option; did you mean --input?"),
                                 (["--input", "a.bag", "--nonsense"], "--nonsense: no such option"),
                                 (["--input", "a.bag", "--csv", "x.csv", "b.bag"], "b.bag: not expected"),
                                 ([], "--input is required")):
            with self.subTest(options=options):
                result = run([PROGRAMS / "process_bag", *options])
                self.assertEqual((result.returncode, result.stdout), (2, ""))
                self.assertEqual(result.stderr, f"process_bag: {message}\nRun with --help for more information.\n")

    def test_help_names_every_option(self):
        result = run([PROGRAMS / "process_bag", "--help"])
        self.assertEqual(result.returncode, 0)
        for option in ("--input", "--camera", "--imu", "--config", "--csv", "--output", "--report-data", "--list-parameters",
                       "--list-node-parameters", "--version"):
            self.assertIn(option, result.stdout)

    def test_version_and_parameters_need_no_bag(self):
        version = run([PROGRAMS / "process_bag", "--version"])
        self.assertEqual(version.returncode, 0)
        self.assertRegex(version.stdout, r"^process_bag \d+\.\d+\.\d+\n$")
        parameters = run([PROGRAMS / "process_bag", "--list-parameters"])
        self.assertEqual(parameters.returncode, 0)
        self.assertIn("| `window_radius` |", parameters.stdout)


class ConfigTest(ProcessBagTest):
    def process_with(self, yaml):
        write_bag(self.bag, noise_frames())
        config = self.folder / "config.yaml"
        config.write_text(yaml)
        return self.process("--config", config)

    def test_unknown_key(self):
        self.assert_refused(self.process_with("stereo_depth: {window_raduis: 5}"), "config.yaml",
                            "stereo_depth/window_raduis", "did you mean window_radius?")

    def test_value_out_of_range(self):
        self.assert_refused(self.process_with("stereo_depth: {window_radius: 99}"),
                            "config.yaml: stereo_depth/window_radius: 99 is out of range, expected 2 to 15 px")

    def test_missing_file(self):
        write_bag(self.bag, noise_frames())
        self.assert_refused(self.process("--config", "/nowhere.yaml"), "/nowhere.yaml: no such file")


class TopicsTest(ProcessBagTest):
    def without(self, topic):
        frames = noise_frames()
        for frame in frames:
            frame.messages[topic] = None
        return self.process_frames(frames)

    def test_each_missing_topic_is_named_and_the_others_listed(self):
        topics = ("left/image_raw", "left/camera_info", "right/image_raw", "right/camera_info")
        for missing in topics:
            with self.subTest(missing=missing):
                result = self.without(missing)
                self.assert_refused(result, f"no topic /stereo/{missing}")
                for there in topics:
                    if there != missing:
                        self.assertNotIn(f"no topic /stereo/{there}", result.stderr)
                        self.assertIn(f"\n  /stereo/{there} (sensor_msgs/", result.stderr)

    def test_another_camera_name(self):
        write_bag(self.bag, noise_frames(), camera="/nose")
        self.assert_refused(self.process(), "no topic /stereo/left/image_raw",
                            "/nose/left/image_raw (sensor_msgs/Image)", "\nIts cameras have another namespace: --camera nose\n")
        self.assertEqual(self.process("--camera", "nose").returncode, 0)

    def test_a_topic_of_another_type(self):
        frames = noise_frames()
        for frame in frames:
            frame.messages["left/image_raw"] = frame.messages["left/camera_info"]
        self.assert_refused(self.process_frames(frames), "/stereo/left/image_raw is sensor_msgs/CameraInfo",
                            "expected sensor_msgs/Image")

    def write_imu(self, mounted=True, frame="imu_link"):
        """Adds a sensor at 100 Hz to the bag of noise_frames()."""
        with rosbag.Bag(str(self.bag), "a") as bag:
            if mounted:
                transform = TransformStamped()
                transform.header.frame_id, transform.child_frame_id = "left", frame
                transform.transform.rotation.w = 1
                bag.write("/tf_static", TFMessage([transform]), rospy.Time(999))
            for i in range(40):
                message = Imu()
                message.header.stamp, message.header.frame_id = rospy.Time.from_sec(10 + 0.01 * i), frame
                message.orientation.w = 1
                bag.write("/imu/data", message, rospy.Time.from_sec(1000 + 0.001 * i))

    def test_an_imu_is_optional_unless_it_is_asked_for(self):
        write_bag(self.bag, noise_frames())
        self.assertEqual(self.process().returncode, 0)
        self.csv.unlink()
        result = self.process("--imu", "/mavros/imu/data")
        self.assert_refused(result, "no topic /mavros/imu/data (sensor_msgs/Imu)")
        self.assertNotIn("--camera", result.stderr)
        self.assert_refused(self.process("--imu", "/stereo/left/image_raw"),
                            "topic /stereo/left/image_raw is sensor_msgs/Image, expected sensor_msgs/Imu")
        self.assertEqual(self.process("--imu", "").returncode, 0)

    def test_an_imu_whose_mounting_is_not_known_is_named(self):
        write_bag(self.bag, noise_frames())
        self.write_imu(mounted=False)
        result = self.process()
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("imu: transform_missing: no static transform between the imu's imu_link and left", result.stderr)

    def test_an_imu_is_in_the_messages(self):
        write_bag(self.bag, noise_frames())
        self.write_imu()
        output = self.folder / "output.bag"
        result = self.process("--output", output)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        with rosbag.Bag(str(output)) as bag:
            priors = [message.imu for _, message, _ in bag.read_messages("/uav_landing/approach_angle")]
        # The camera's axes are the sensor's: gravity is along -z.
        self.assertEqual([tuple(round(x, 9) for x in prior.normal) for prior in priors], 3 * [(0, 0, -1)])
        self.assertEqual([prior.rotation for prior in priors[1:]], 2 * [(0, 0, 0)])

    def test_right_camera_that_falls_silent(self):
        frames = noise_frames(5)
        for frame in frames[2:]:
            frame.messages["right/image_raw"] = None
        result = self.process_frames(frames)
        self.assertEqual(result.returncode, 3, result.stderr)
        self.assertEqual(len(self.rows()), 2)
        self.assertEqual(result.stderr.splitlines()[0], "process_bag: 3 of 5 messages on /stereo/left/image_raw belong to no pair; "
                         "the nearest on /stereo/right/image_raw is 200 ms away")
        self.assertEqual(result.stderr.splitlines()[1], "process_bag: most of the recording was left out: 2 pairs of 5 left and "
                         "2 right images (exit status 3)")

    def test_topics_without_a_slash_in_front(self):
        write_bag(self.bag, noise_frames(), camera="stereo")
        result = self.process()
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertEqual(len(self.rows()), 3)

    def test_names_of_other_topics_are_in_the_command_that_takes_them(self):
        frames = noise_frames()
        for frame in frames:
            frame.messages = {"cam0/image_raw": frame.left, "cam1/image_raw": frame.messages["right/image_raw"],
                              "cam1/camera_info": frame.right_info}
        write_bag(self.bag, frames, camera="/rig")
        self.assert_refused(self.process(), "\nThis makes a bag that can be read:\n  rosrun uav_landing convert_recording bag "
                            f"{self.bag} --left /rig/cam0/image_raw --right /rig/cam1/image_raw --left-calibration left.yaml "
                            f"--output {self.folder}/input_stereo.bag\n")

    def test_right_camera_with_other_stamps(self):
        frames = noise_frames(3)
        moved = noise_frames(3, start=50)
        for frame, other in zip(frames, moved):
            frame.messages["right/image_raw"] = other.messages["right/image_raw"] = frame.messages["right/image_raw"]
            frame.messages["right/image_raw"] = None
            other.messages = {"right/image_raw": other.messages["right/image_raw"]}
        self.assert_refused(self.process_frames(frames + moved), "no image pair", "/stereo/")


class OrderTest(ProcessBagTest):
    """The order of the messages in the bag does not matter."""

    def estimates(self):
        return [{name: value for name, value in row.items() if name != "compute_ms"} for row in self.rows()]

    def written(self, messages, *options):
        """Estimates of (frame, topic) in the order of the bag."""
        with rosbag.Bag(str(self.bag), "w") as bag:
            for number, (frame, topic) in enumerate(messages):
                message = frame.messages[topic]
                message.header.stamp = rospy.Time(0, round(frame.stamp * 1e9))
                bag.write(f"/stereo/{topic}", message, rospy.Time.from_sec(1000 + 0.01 * number))
        result = self.process(*options)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return self.estimates()

    def test_one_camera_after_the_other_and_topic_by_topic(self):
        frames = noise_frames(8)
        topics = list(frames[0].messages)
        expected = self.written([(frame, topic) for frame in frames for topic in topics])
        self.assertEqual(len(expected), 8)
        self.assertEqual(self.written([(frame, topic) for side in (topics[:2], topics[2:]) for frame in frames for topic in side]),
                         expected)
        self.assertEqual(self.written([(frame, topic) for topic in topics for frame in frames]), expected)
        mixed = [(frame, topic) for frame in frames for topic in topics]
        np.random.RandomState(1).shuffle(mixed)
        self.assertEqual(self.written(mixed), expected)

    def test_parts_of_a_split_recording(self):
        frames = noise_frames(6)
        expected = self.written([(frame, topic) for frame in frames for topic in frame.messages])
        first, second = self.folder / "flight_0.bag", self.folder / "flight_1.bag"
        write_bag(first, frames[:3])
        write_bag(second, frames[3:], begin=1001)
        for given in ([first, second], [second, first], [first, "--input", second]):
            result = run([PROGRAMS / "process_bag", "--csv", self.csv, "--input", *given])
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            self.assertEqual(self.estimates(), expected)
        result = run([PROGRAMS / "process_bag", "--input", first])
        self.assertEqual(result.stderr, f"process_bag: {second} lies beside the input: if it is the next part of the same "
                                        "recording, give it to --input, too\n")

    def test_a_recording_that_was_not_closed(self):
        write_bag(self.folder / "input.bag.active", noise_frames())
        for given in (self.bag, self.folder / "input.bag.active"):
            result = run([PROGRAMS / "process_bag", "--input", given])
            self.assertEqual(result.returncode, 1)
            self.assertIn(f"{self.folder}/input.bag.active: this recording was never closed", result.stderr)
            self.assertIn("rosbag reindex", result.stderr)

    def test_the_last_camera_info_is_held(self):
        frames = noise_frames(8)
        expected = self.written([(frame, topic) for frame in frames for topic in frame.messages])
        for frame in frames[1:]:
            frame.messages["left/camera_info"] = None
        result = self.process_frames(frames)
        self.assertEqual(result.returncode, 0)
        self.assertEqual(result.stderr, "process_bag: /stereo/left/camera_info: 1 message for 8 images; 7 of 8 pairs take the last "
                                        "one before their image\n")
        self.assertEqual(self.estimates(), expected)

    def test_cameras_without_a_trigger_are_told_how_far_apart_they_are(self):
        frames, others = noise_frames(4), noise_frames(4, start=10.015)
        for frame, other in zip(frames, others):
            for topic in frame.messages:
                (other if topic.startswith("left") else frame).messages[topic] = None
        config = self.folder / "config.yaml"
        config.write_text("rectify: {approximate_sync: true}")
        both = [frame for pair in zip(frames, others) for frame in pair]
        self.assert_refused(self.process_frames(both), "no image pair: the stamps do not match (approximate_sync pairs cameras "
                            "without a hardware trigger, within max_skew, 10 ms): images on /stereo/left/image_raw and "
                            "/stereo/right/image_raw are 15 ms apart\n")
        self.assert_refused(self.process("--config", config), "no image pair: images on /stereo/left/image_raw and "
                            "/stereo/right/image_raw are 15 ms apart, more than max_skew, 10 ms: raise max_skew in the config "
                            "file, rectify: {approximate_sync: true, max_skew: 0.018}\n")
        config.write_text("rectify: {approximate_sync: true, max_skew: 0.018}")
        self.assertEqual((self.process("--config", config).returncode, len(self.rows())), (0, 4))


class CameraInfoTest(ProcessBagTest):
    def process_with(self, change):
        frames = noise_frames()
        for frame in frames:
            change(frame)
        return self.process_frames(frames)

    def test_uncalibrated_camera(self):
        def change(frame):
            frame.left_info.K = [0.0] * 9
        self.assert_refused(self.process_with(change), "camera_info", "left", "K[0]")

    def test_not_a_number(self):
        def change(frame):
            frame.right_info.P = frame.right_info.P[:3] + [math.nan] + frame.right_info.P[4:]
        self.assert_refused(self.process_with(change), "camera_info", "right", "P[3]")

    def test_no_baseline(self):
        def change(frame):
            frame.right_info.P = frame.left_info.P
        self.assert_refused(self.process_with(change), "camera_info", "right", "P[3]")

    def process_scaled(self, factor, *options):
        """With the K of an image that is larger by a factor."""
        frames = noise_frames()
        for frame in frames:
            for info in (frame.left_info, frame.right_info):
                info.K = [factor * k for k in info.K[:8]] + [1]
        return self.process_frames(frames, *options)

    def test_calibration_of_another_picture_size_is_refused(self):
        self.assert_refused(self.process_scaled(2), f"{self.bag}: no usable image pair: camera_info: left K[2]: 160, expected "
                            "48 to 112 in an image 160 px wide: is this the calibration of another image size? If the "
                            "image is cropped off the middle, raise rig/max_principal_point_offset\n")

    def test_picture_cropped_off_the_middle_is_let_through_by_the_config(self):
        config = self.folder / "config.yaml"
        config.write_text("rig: {max_principal_point_offset: 1.1}")
        result = self.process_scaled(2, "--config", config)
        self.assertEqual((result.returncode, result.stderr), (0, ""))

    def test_unlikely_principal_point_is_warned_about_once(self):
        result = self.process_scaled(1.25)
        self.assertEqual(result.returncode, 0)
        self.assertEqual(result.stderr, "".join(
            f"process_bag: camera_info: {side} K[2]: 100, 12.5 % of the image's width off its middle: is this the "
            "calibration of another image size?\n" for side in ("left", "right")))

    def process_with_baseline(self, metres):
        def change(frame):
            frame.right_info.P = frame.right_info.P[:3] + [-150 * metres] + frame.right_info.P[4:]
        return self.process_with(change)

    def test_baseline_in_millimetres_is_refused(self):
        self.assert_refused(self.process_with_baseline(500), "camera_info: baseline 500 m, expected at most 50 m: is right "
                            "P[3] in metres (-fx times the baseline)? If it is, raise rig/max_baseline\n")

    def test_unlikely_baseline_is_warned_about_once(self):
        for metres in (0.005, 20):
            with self.subTest(metres=metres):
                result = self.process_with_baseline(metres)
                self.assertEqual(result.returncode, 0)
                self.assertEqual(result.stderr, f"process_bag: camera_info: baseline {metres} m: is right P[3] in metres "
                                 "(-fx times the baseline)?\n")

    def test_change_in_mid_stream_is_reported_and_followed(self):
        frames = noise_frames(4)
        for frame in frames[2:]:
            frame.left_info.K = [140.0] + frame.left_info.K[1:]
        result = self.process_frames(frames)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("camera_info of the left camera changed at stamp 10.2", result.stderr)
        self.assertEqual(result.stderr.count("changed"), 1)
        self.assertEqual(len(self.rows()), 4)


class ImagesTest(ProcessBagTest):
    def process_with(self, bad, expected):
        """The middle one of three pairs is bad: a message, a row without a value, and on it goes. All three are bad: refused."""
        frames = noise_frames()
        frames[1].messages["left/image_raw"] = bad
        result = self.process_frames(frames)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("/stereo/left/image_raw: " + expected, result.stderr)
        self.assertIn("1 of 3 pairs could not be used", result.stderr)
        rows = self.rows()
        self.assertEqual(len(rows), 3)
        self.assertEqual((rows[1]["status"], rows[1]["reason"], rows[1]["height_m"]), ("lost", "input_invalid", ""))
        self.assert_nothing_valid(rows)
        self.csv.unlink()

        for frame in frames:
            frame.messages["left/image_raw"] = bad
        self.assert_refused(self.process_frames(frames), "no usable image pair", expected)

    def test_another_size_than_camera_info_announces(self):
        self.process_with(image(noise(1)[:100]), f"width, height: {WIDTH}x100, but camera_info announces {WIDTH}x{HEIGHT}")

    def test_unsupported_encoding(self):
        self.process_with(image(noise(1).astype(np.float32), "32FC1"), 'encoding: "32FC1"')

    def test_truncated_data(self):
        bad = image(noise(1))
        bad.data = bad.data[:-1]
        self.process_with(bad, f"data: {WIDTH * HEIGHT - 1} bytes, but step x height is {WIDTH * HEIGHT}")

    def test_no_data(self):
        bad = image(noise(1))
        bad.data = b""
        self.process_with(bad, "data: 0 bytes")

    def test_step_shorter_than_a_row(self):
        bad = image(noise(1))
        bad.step = WIDTH - 1
        self.process_with(bad, f"step: {WIDTH - 1} bytes")

    def test_supported_encodings(self):
        grey = noise(1)
        colour = np.dstack([grey, grey, grey])
        for encoding, pixels in (("mono16", grey.astype(np.uint16) * 257), ("bgr8", colour), ("rgb8", colour),
                                 ("bayer_rggb8", grey), ("bayer_bggr8", grey)):
            with self.subTest(encoding=encoding):
                frames = noise_frames(2)
                frames[0].messages["left/image_raw"] = image(pixels, encoding)
                result = self.process_frames(frames)
                self.assertEqual((result.returncode, result.stderr), (0, ""))

    def test_black_saturated_and_uniform_images(self):
        for grey in (0, 255, 90):
            with self.subTest(grey=grey):
                frames = noise_frames()
                for frame in frames:
                    flat = np.full((HEIGHT, WIDTH), grey, np.uint8)
                    frame.messages["left/image_raw"] = image(flat)
                    frame.messages["right/image_raw"] = image(flat)
                self.assertEqual(self.process_frames(frames).returncode, 0)
                rows = self.rows()
                self.assertEqual(len(rows), 3)
                self.assert_nothing_valid(rows)
                self.assertEqual({row["reason"] for row in rows}, {"uniform_image"})

    def test_the_last_line_counts_valid_pairs_and_reasons(self):
        frames = noise_frames(4)
        for frame in frames[1:]:
            frame.messages["left/image_raw"] = image(np.full((HEIGHT, WIDTH), 90, np.uint8))
        result = self.process_frames(frames)
        other = self.rows()[0]["reason"]
        self.assertEqual(result.stdout.splitlines()[-1], f"4 pairs, 0 valid: uniform_image 3, {other} 1")

    def test_noise_is_never_valid(self):
        self.assertEqual(self.process_frames(noise_frames(4)).returncode, 0)
        self.assert_nothing_valid(self.rows())


class StampsTest(ProcessBagTest):
    def test_repeated_stamp_makes_no_second_row(self):
        frames = noise_frames(4)
        frames[2].stamp = frames[1].stamp
        result = self.process_frames(frames)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual([row["stamp_s"] for row in self.rows()], ["10.000000000", "10.100000000", "10.300000000"])
        self.assertIn("with a repeated stamp", result.stderr)

    def test_pairs_that_come_late_are_put_in_order(self):
        frames = noise_frames(5)
        frames[1], frames[2] = frames[2], frames[1]
        result = self.process_frames(frames)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        self.assertEqual([row["stamp_s"] for row in self.rows()],
                         ["10.000000000", "10.100000000", "10.200000000", "10.300000000", "10.400000000"])

    def test_images_without_a_stamp_are_counted_and_named(self):
        frames = noise_frames(4)
        frames[2].stamp = 0
        result = self.process_frames(frames)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual([row["stamp_s"] for row in self.rows()], ["10.000000000", "10.100000000", "10.300000000"])
        self.assertIn("1 of 4 messages on /stereo/left/image_raw belong to no pair, of them 1 with the stamp 0", result.stderr)
        for frame in frames:
            frame.stamp = 0
        self.csv.unlink()
        self.assert_refused(self.process_frames(frames), "the stamp (header.stamp) is 0 on /stereo/left/image_raw")

    def test_stamps_that_go_back_are_reported_and_followed(self):
        result = self.process_frames(noise_frames(3, start=20) + noise_frames(3, start=10))
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(len(self.rows()), 6)
        self.assertIn("stamps went back", result.stderr)


class DatasetTest(ProcessBagTest):
    """Recorded approaches, with the cameras as they are and swapped."""

    def make_bag(self, folder):
        run([PROGRAMS / "dataset_to_bag", "--dataset", folder, "--output", self.bag], check=True)

    def test_swapped_cameras_are_named_and_never_valid(self):
        source, swapped = dataset("fg_noon"), self.folder / "swapped"
        swapped.mkdir()
        for side, other in (("left", "right"), ("right", "left")):
            (swapped / side).symlink_to(source / other)
            shutil.copy(str(source / f"{side}.yaml"), str(swapped))
        frames = (source / "frames.csv").read_text().splitlines()[:11]
        (swapped / "frames.csv").write_text("\n".join(frames) + "\n")
        self.make_bag(swapped)
        self.assertEqual(self.process().returncode, 0)
        rows = self.rows()
        self.assertEqual(len(rows), 10)
        self.assert_nothing_valid(rows)
        self.assertIn("negative_disparity", {row["reason"] for row in rows})

    def test_writes_everything_that_was_asked_for(self):
        self.make_bag(dataset("lab"))
        output, report = self.folder / "output.bag", self.folder / "report"
        result = self.process("--output", output, "--report-data", report)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        rows = self.rows()
        self.assertEqual(len(rows), 120)
        self.assertGreater(sum(row["valid"] == "1" for row in rows), 110)

        self.assertIn("all stages", result.stdout)
        valid = sum(row["valid"] == "1" for row in rows)
        self.assertEqual(result.stdout.splitlines()[-1], f"120 pairs, {valid} valid: not_yet {120 - valid}")
        timing = (report / "timing.csv").read_text().splitlines()
        self.assertEqual(len(timing), 121)
        self.assertIn("overlay_ms", timing[0].split(","))
        self.assertEqual({line.count(",") for line in timing}, {timing[0].count(",")})
        for name in ("lines_left", "lines_right", "matches", "overlay"):
            self.assertEqual(len(list(report.glob(f"{name}_*.png"))), 5)

        with rosbag.Bag(str(output)) as bag:
            for topic in ("stereo_depth", "approach_angle", "landing_estimate"):
                self.assertEqual(bag.get_message_count(f"/uav_landing/{topic}"), 120)
            for row, (_, message, stamp) in zip(rows, bag.read_messages("/uav_landing/landing_estimate")):
                self.assertEqual(str(message.header.stamp.to_nsec()), row["stamp_s"].replace(".", ""))
                self.assertEqual(stamp, message.header.stamp)
                self.assertEqual(message.valid, row["valid"] == "1")
                self.assertEqual((message.header.frame_id, message.child_frame_id),
                                 ("runway", "stereo_left_optical_frame_rect"))
                if row["height_m"]:
                    self.assertAlmostEqual(message.height, float(row["height_m"]), delta=1e-9)
                if row["approach_angle_deg"]:
                    self.assertAlmostEqual(math.degrees(message.approach_angle), float(row["approach_angle_deg"]),
                                           delta=1e-9)


if __name__ == "__main__":
    unittest.main()
