"""A dataset folder becomes the same thing in a bag, and an unusable one a message that says where it is wrong."""

import math
import shutil
import tempfile
import unittest
from pathlib import Path

import cv2
import numpy as np
import rosbag

from dataset_folder import CALIBRATION, HEADER, HEIGHT, ROWS, WIDTH, picture, write_dataset
from project import BUILD_DIR, run

PROGRAM = BUILD_DIR / "devel/lib/uav_landing/dataset_to_bag"


class DatasetToBagTest(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="uav_landing_dataset_to_bag_"))
        self.addCleanup(shutil.rmtree, str(self.folder))
        self.dataset, self.bag = self.folder / "set", self.folder / "out.bag"
        write_dataset(self.dataset)

    def convert(self, *options):
        return run([PROGRAM, "--dataset", self.dataset, "--output", self.bag, *options])

    def assert_refused(self, *texts):
        """Exit status 1, a message with these texts, and neither bag nor unfinished bag."""
        result = self.convert()
        self.assertEqual(result.returncode, 1, result.stderr)
        for text in texts:
            self.assertIn(text, result.stderr)
        self.assertEqual([path.name for path in self.folder.iterdir()], ["set"])


class RoundTripTest(DatasetToBagTest):
    def messages(self, *options):
        """Topic to messages, in order."""
        result = self.convert(*options)
        self.assertEqual(result.returncode, 0, result.stderr)
        found = {}
        with rosbag.Bag(str(self.bag)) as bag:
            for topic, message, stamp in bag.read_messages():
                self.assertEqual(stamp, message.header.stamp)
                found.setdefault(topic, []).append(message)
        return found

    def test_topics_and_number_of_messages(self):
        self.assertEqual({topic: len(messages) for topic, messages in self.messages().items()},
                         {"/stereo/left/image_raw": 2, "/stereo/left/camera_info": 2, "/stereo/right/image_raw": 2,
                          "/stereo/right/camera_info": 2, "/truth/landing_estimate": 2})

    def test_stamps_to_the_nanosecond(self):
        for messages in self.messages().values():
            self.assertEqual([(m.header.stamp.secs, m.header.stamp.nsecs) for m in messages],
                             [(1700000000, 123456789), (1700000000, 200000000)])

    def test_images_are_the_same_pixels(self):
        messages = self.messages()
        for side, first in (("left", 0), ("right", 2)):
            for i, message in enumerate(messages[f"/stereo/{side}/image_raw"]):
                self.assertEqual((message.width, message.height, message.encoding), (WIDTH, HEIGHT, "mono8"))
                pixels = np.frombuffer(message.data, np.uint8).reshape(HEIGHT, message.step)[:, :WIDTH]
                np.testing.assert_array_equal(pixels, picture(first + i))

    def test_calibrations_and_frames(self):
        messages = self.messages()
        for side, shift in (("left", 0), ("right", -25)):
            info = messages[f"/stereo/{side}/camera_info"][1]
            self.assertEqual((info.width, info.height, info.distortion_model), (WIDTH, HEIGHT, "plumb_bob"))
            self.assertEqual(list(info.K), [50, 0, 24, 0, 51, 16, 0, 0, 1])
            self.assertEqual(list(info.D), [-0.1, 0.01, 0.001, -0.001, 0.002])
            self.assertEqual(list(info.R), [1, 0, 0, 0, 1, 0, 0, 0, 1])
            self.assertEqual(list(info.P), [50, 0, 24, shift, 0, 50, 16, 0, 0, 0, 1, 0])
            self.assertEqual(info.header.frame_id, f"stereo_{side}_optical_frame")
            self.assertEqual(messages[f"/stereo/{side}/image_raw"][1].header.frame_id, info.header.frame_id)

    def test_truth_in_radians(self):
        truth = self.messages()["/truth/landing_estimate"][1]
        self.assertEqual((truth.header.frame_id, truth.child_frame_id), ("runway", "stereo_left_optical_frame_rect"))
        self.assertEqual((truth.height, truth.height_variance), (12.25, 0))
        self.assertAlmostEqual(truth.approach_angle, math.radians(3), 12)
        self.assertAlmostEqual(truth.roll, math.radians(1), 12)
        self.assertAlmostEqual(truth.yaw, math.radians(-2), 12)
        self.assertAlmostEqual(truth.vertical_speed, -20 * math.sin(math.radians(3)), 12)
        self.assertEqual(list(truth.foe), [26, 18.5])
        self.assertTrue(truth.valid and truth.height_valid and truth.angle_valid)

    def test_attitude_and_place_each_in_its_field(self):
        truth, second = self.messages()["/truth/landing_estimate"]
        self.assertAlmostEqual(truth.pitch, math.radians(-5), 12)
        self.assertAlmostEqual(truth.roll, math.radians(1.5), 12)
        self.assertAlmostEqual(truth.yaw, math.radians(-2), 12)
        self.assertEqual((truth.x, truth.y, second.x, second.y), (-100, 0.25, -99, 0.5))
        self.assertTrue(truth.x_known and truth.y_known)
        self.assertEqual((truth.raw_height, truth.points_height, second.raw_approach_angle),
                         (truth.height, truth.height, second.approach_angle))
        # The truth has no variance.
        self.assertEqual([truth.pitch_variance, truth.roll_variance, truth.yaw_variance, truth.x_variance, truth.y_variance,
                          truth.raw_height_variance, second.vertical_speed_variance, second.raw_approach_angle_variance], [0] * 8)

    def test_velocity_leads_to_the_focus_of_expansion_at_the_speed(self):
        velocity = np.array(self.messages()["/truth/landing_estimate"][1].velocity)
        self.assertAlmostEqual(np.linalg.norm(velocity), 20, 9)
        np.testing.assert_allclose(velocity[:2] / velocity[2], [(26 - 24) / 50, (18.5 - 16) / 50], atol=1e-12)

    def test_what_is_blank_is_not_a_number(self):
        first, second = self.messages()["/truth/landing_estimate"]
        self.assertTrue(all(math.isnan(value) for value in (
            first.approach_angle, first.approach_angle_variance, first.vertical_speed, *first.foe, *first.velocity,
            second.pitch, second.pitch_variance)))
        self.assertTrue(first.height_valid)
        self.assertFalse(first.valid or first.angle_valid)

    def test_columns_go_by_name_and_truth_columns_may_be_absent(self):
        write_dataset(self.dataset, "right,height_m,left,note,stamp_s", ["a.png,3,b.png,hello,5"])
        messages = self.messages()
        pixels = np.frombuffer(messages["/stereo/left/image_raw"][0].data, np.uint8)
        np.testing.assert_array_equal(pixels, picture(1).ravel())
        truth = messages["/truth/landing_estimate"][0]
        self.assertEqual(truth.height, 3)
        self.assertTrue(math.isnan(truth.pitch))

    def test_lines_may_end_as_on_windows(self):
        (self.dataset / "frames.csv").write_bytes("\r\n".join([HEADER, *ROWS, ""]).encode())
        self.assertEqual(len(self.messages()["/truth/landing_estimate"]), 2)

    def test_another_namespace(self):
        messages = self.messages("--camera", "uav1/front")
        self.assertIn("/uav1/front/left/image_raw", messages)
        self.assertEqual(messages["/uav1/front/left/image_raw"][0].header.frame_id, "uav1_front_left_optical_frame")


class BadInputTest(DatasetToBagTest):
    def test_missing_folder(self):
        shutil.rmtree(str(self.dataset))
        self.assertEqual(self.convert().returncode, 1)
        self.assertIn(f"{self.dataset}: no such folder", self.convert().stderr)

    def test_missing_files(self):
        for name in ("left.yaml", "right.yaml", "frames.csv", "left/b.png", "right/a.png"):
            with self.subTest(file=name):
                write_dataset(self.dataset)
                (self.dataset / name).unlink()
                self.assert_refused(name)

    def test_a_missing_table_does_not_exist(self):
        (self.dataset / "frames.csv").unlink()
        self.assert_refused("frames.csv: no such file")

    def test_a_missing_image_is_named_with_its_line_and_column(self):
        (self.dataset / "right/b.png").unlink()
        self.assert_refused("frames.csv, line 3, column right:", "right/b.png: no such file")

    def test_a_blank_image_is_named_with_its_line_and_column(self):
        write_dataset(self.dataset, rows=[ROWS[0], ROWS[1].replace(",b.png,b.png", ",b.png,")])
        self.assert_refused("frames.csv, line 3, column right: blank, expected the name of an image")

    def test_missing_columns(self):
        for column in ("stamp_s", "left", "right"):
            with self.subTest(column=column):
                write_dataset(self.dataset, HEADER.replace(column, "other", 1))
                self.assert_refused("frames.csv", f"no column {column}")

    def test_a_column_that_is_there_twice(self):
        write_dataset(self.dataset, HEADER.replace("x_m", "y_m"))
        self.assert_refused("frames.csv", "column y_m is there twice")

    def test_a_row_with_a_field_too_few(self):
        write_dataset(self.dataset, rows=[ROWS[0], "1700000000.2,b.png,b.png"])
        self.assert_refused("frames.csv, line 3: 3 fields, the header has 13")

    def test_no_frames(self):
        write_dataset(self.dataset, rows=[])
        self.assert_refused("frames.csv: no frames")

    def test_an_empty_table(self):
        (self.dataset / "frames.csv").write_text("")
        self.assert_refused("frames.csv: empty")

    def test_a_number_that_is_none(self):
        for bad in ("low", "1e999", "nan", "3 m"):
            with self.subTest(value=bad):
                write_dataset(self.dataset, rows=[ROWS[0].replace("12.5", bad)])
                self.assert_refused("frames.csv, line 2, column height_m:", bad)

    def test_bad_stamps(self):
        for bad in ("", "now", "-1", "1e3", "4294967296", "0", "1.2.3"):
            with self.subTest(stamp=bad):
                write_dataset(self.dataset, rows=[",".join([bad, *ROWS[0].split(",")[1:]])])
                self.assert_refused("frames.csv, line 2, column stamp_s:")

    def test_a_stamp_that_repeats_or_goes_back(self):
        for rows in ((ROWS[0], ROWS[0]), (ROWS[1], ROWS[0])):
            with self.subTest(rows=rows):
                write_dataset(self.dataset, rows=rows)
                self.assert_refused("frames.csv, line 3, column stamp_s:", "not after the stamp of the frame before")

    def test_an_image_of_another_size(self):
        cv2.imwrite(str(self.dataset / "right/b.png"), np.zeros((HEIGHT, WIDTH + 1), np.uint8))
        self.assert_refused("right/b.png: 49x32, the calibration says 48x32")

    def test_images_that_are_not_mono8(self):
        for pixels in (np.zeros((HEIGHT, WIDTH, 3), np.uint8), np.zeros((HEIGHT, WIDTH), np.uint16)):
            with self.subTest(type=pixels.dtype):
                cv2.imwrite(str(self.dataset / "left/a.png"), pixels)
                self.assert_refused("left/a.png: expected 8-bit grey (mono8)")

    def test_a_file_that_is_not_a_png(self):
        cv2.imwrite(str(self.dataset / "photo.jpg"), picture(0))
        for content in (b"", b"not an image", (self.dataset / "photo.jpg").read_bytes()):
            with self.subTest(size=len(content)):
                (self.dataset / "left/b.png").write_bytes(content)
                self.assert_refused("left/b.png: not a PNG image")

    def test_a_png_that_was_cut_off(self):
        path = self.dataset / "left/b.png"
        path.write_bytes(path.read_bytes()[:200])
        self.assert_refused("left/b.png: damaged PNG image")

    def test_calibrations_that_are_none(self):
        for content in ("", "hello", "image_width: 48", "{"):
            with self.subTest(content=content):
                (self.dataset / "left.yaml").write_text(content)
                self.assert_refused("left.yaml: not a ROS camera calibration file")

    def test_matrices_whose_numbers_do_not_fit_together(self):
        good = CALIBRATION.format(width=48, height=32, name="left", shift=0)
        wrong = {good.replace("[50,", "["): "camera_matrix: 3 rows, 3 cols and 8 numbers",
                 good.replace("rows: 3", "rows: 2", 1): "camera_matrix: 2 rows, 3 cols and 9 numbers",
                 good.replace("cols: 4", "cols: 400000000"): "projection_matrix: 3 rows, 400000000 cols and 12 numbers",
                 good.replace("cols: 5", "cols: 2000000000"): "distortion_coefficients: 1 rows, 2000000000 cols"}
        for content, problem in wrong.items():
            with self.subTest(problem=problem):
                self.assertNotEqual(content, good)
                (self.dataset / "left.yaml").write_text(content)
                self.assert_refused("left.yaml: " + problem)

    def test_a_calibration_without_a_size(self):
        (self.dataset / "right.yaml").write_text(CALIBRATION.format(width=0, height=0, name="right", shift=0))
        self.assert_refused("right.yaml: image_width and image_height must be positive")

    def test_a_bag_that_cannot_be_written(self):
        self.bag = self.folder / "nowhere" / "out.bag"
        self.assert_refused(str(self.bag))


class UsageTest(DatasetToBagTest):
    def test_wrong_usage_has_exit_status_2(self):
        for options in ([], ["--dataset", "a"], ["--dataset", "a", "--output", "b", "--nonsense"],
                        ["--dataset", "a", "--output", "b", "--camera", "no camera"]):
            with self.subTest(options=options):
                self.assertEqual(run([PROGRAM, *options]).returncode, 2)


if __name__ == "__main__":
    unittest.main()
