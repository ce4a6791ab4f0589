import json
import math
import re
import shutil
import sys
import tarfile
import tempfile
import unittest
from pathlib import Path

import cv2
import numpy as np
import rosbag
import rospy
import yaml
from cv_bridge import CvBridge
from sensor_msgs.msg import CompressedImage, Image

from project import DEVEL_DIR, SOURCE_DIR, run
from python_program import run_here
from test_data import dataset

sys.path.insert(0, str(SOURCE_DIR / "src/tools"))
from calibration import checks, rig  # noqa: E402
from calibration.errors import InputError  # noqa: E402

BOARD = ["--size", "8x6", "--square", "0.1"]


def calibrate(images, output, *options, board=BOARD):
    return run_here(SOURCE_DIR / "scripts/calibrate", "--images", images, "--output", output, *board, *options)


def rays(pixels, K, D):
    """Unit vectors (n, 3) of raw pixels (n, 1, 2)."""
    points = cv2.undistortPointsIter(pixels, np.array(K, float), np.array(D, float), None, None,
                                     (cv2.TERM_CRITERIA_COUNT, 100, 0))[:, 0]
    directions = np.concatenate([points, np.ones((len(points), 1))], axis=1)
    return directions / np.linalg.norm(directions, axis=1, keepdims=True)


class TemporaryFolderTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.output = self.folder / "output"

    def assert_refused(self, result, *words, status=1):
        self.assertEqual(result.returncode, status, result.stdout + result.stderr)
        self.assertNotIn("Traceback", result.stderr)
        for word in words:
            self.assertIn(str(word), result.stderr)
        self.assertFalse(self.output.exists())


class LabCalibrationTest(unittest.TestCase):
    """The chessboard images of the laboratory replica, whose lenses are known exactly."""

    @classmethod
    def setUpClass(cls):
        cls.images = dataset("lab_chessboard")
        cls.exact = json.loads((cls.images / "cameras.json").read_text())
        cls.folder = Path(tempfile.mkdtemp(prefix="uav_landing_calibrate_"))
        cls.addClassCleanup(shutil.rmtree, str(cls.folder))
        cls.result = calibrate(cls.images, cls.folder, "--baseline", "0.65")
        assert cls.result.returncode == 0, cls.result.stderr
        cls.cameras = {side: yaml.safe_load((cls.folder / f"{side}.yaml").read_text()) for side in ("left", "right")}

    def test_lenses_are_those_of_the_cameras(self):
        for side, camera in self.cameras.items():
            fx, fy, cx, cy = self.exact[side]["K"]
            K = camera["camera_matrix"]["data"]
            with self.subTest(side):
                self.assertEqual((camera["image_width"], camera["image_height"]), (320, 240))
                self.assertEqual(camera["camera_name"], side)
                self.assertEqual(camera["distortion_model"], "plumb_bob")
                self.assertAlmostEqual(K[0] / fx, 1, delta=0.003)
                self.assertAlmostEqual(K[4] / fy, 1, delta=0.003)
                # Each lens alone is good to a pixel only; fitted together they are better.
                self.assertAlmostEqual(K[2], cx, delta=0.5)
                self.assertAlmostEqual(K[5], cy, delta=0.5)

    def test_rays_of_all_pixels_are_those_of_the_exact_lens(self):
        # Apart from one turn of the whole camera, which the pose between the cameras takes care of.
        pixels = np.array([[[u, v]] for u in range(20, 320, 40) for v in range(20, 240, 40)], np.float64)
        for side, camera in self.cameras.items():
            fx, fy, cx, cy = self.exact[side]["K"]
            true = rays(pixels, [[fx, 0, cx], [0, fy, cy], [0, 0, 1]], self.exact[side]["D"])
            found = rays(pixels, np.reshape(camera["camera_matrix"]["data"], (3, 3)),
                         camera["distortion_coefficients"]["data"])
            U, _, V = np.linalg.svd(true.T @ found)
            off = np.linalg.norm(found - true @ U @ V, axis=1) * fx
            with self.subTest(side):
                self.assertLess(off.max(), 1 / 3)  # px

    def test_baseline_is_that_of_the_rig(self):
        P = self.cameras["right"]["projection_matrix"]["data"]
        self.assertAlmostEqual(-P[3] / P[0], math.hypot(*self.exact["right"]["position_m"]), delta=0.002 * 0.65)

    def rows_after_rectification(self, side, points):
        """Rows, in the rectified image, of points (n, 3) in the left camera's frame seen by the exact camera; NaN where it
        does not see them."""
        exact, camera = self.exact[side], self.cameras[side]
        fx, fy, cx, cy = exact["K"]
        in_camera = (points - exact["position_m"]) @ cv2.Rodrigues(np.array(exact["rotvec"], float))[0]
        K = np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]])
        pixels = cv2.projectPoints(in_camera, np.zeros(3), np.zeros(3), K, np.array(exact["D"], float))[0]
        rectified = cv2.undistortPointsIter(
            pixels, np.reshape(camera["camera_matrix"]["data"], (3, 3)),
            np.array(camera["distortion_coefficients"]["data"]),
            np.reshape(camera["rectification_matrix"]["data"], (3, 3)),
            np.reshape(camera["projection_matrix"]["data"], (3, 4)), (cv2.TERM_CRITERIA_COUNT, 100, 0))
        seen = np.all((pixels[:, 0] > 0) & (pixels[:, 0] < (320, 240)), axis=1)
        return np.where(seen, rectified[:, 0, 1], np.nan)

    def test_rows_of_the_laboratory_agree_to_a_seventh_of_a_pixel(self):
        # The floor as both cameras see it on the approach: from 0.6 and 2 m height, 12 degrees nose down.
        for height in (0.6, 2.0):
            along, across = np.meshgrid(np.linspace(1, 12, 40), np.linspace(-3, 3, 25))
            tilt = math.radians(12)
            down, forward = np.full(along.size, height), along.ravel()
            points = np.stack([across.ravel() + 0.3, down * math.cos(tilt) - forward * math.sin(tilt),
                               down * math.sin(tilt) + forward * math.cos(tilt)], axis=1)
            off = self.rows_after_rectification("left", points) - self.rows_after_rectification("right", points)
            off = off[np.isfinite(off)]
            self.assertGreater(off.size, 100)
            self.assertLess(math.sqrt(np.mean(off ** 2)), 0.15)

    def test_shows_where_the_corners_were(self):
        picture = cv2.imread(str(self.folder / "coverage.png"))
        self.assertGreater(picture.shape[1], 1000)

    def test_bag_gives_the_same_as_the_folder(self):
        bag = self.folder / "board.bag"
        with rosbag.Bag(str(bag), "w") as out:
            for number, left in enumerate(sorted((self.images / "left").glob("*.png"))):
                for side in ("left", "right"):
                    message = CvBridge().cv2_to_imgmsg(cv2.imread(str(self.images / side / left.name), 0), "mono8")
                    message.header.stamp = rospy.Time(100 + number)
                    out.write(f"/rig/{side}/image_raw", message, message.header.stamp)
        result = calibrate(bag, self.folder / "of_bag", "--baseline", "0.65", "--camera", "rig")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("27 of 30 pairs used", result.stdout)
        for side in ("left", "right"):
            self.assertEqual((self.folder / "of_bag" / f"{side}.yaml").read_text(),
                             (self.folder / f"{side}.yaml").read_text())
        missing = calibrate(bag, self.folder / "none")
        self.assertEqual(missing.returncode, 1)
        self.assertIn("no topic /stereo/left/image_raw, /stereo/right/image_raw", missing.stderr)

    def test_says_how_good_it_is_in_words(self):
        for words in ("27 of 30 pairs used; board not found whole in: 000003, 000016, 000018", "reprojection error",
                      "epipolar error", "than the measured 0.65 m", "none in: upper left, middle left, lower left",
                      "good to 1 % up to"):
            self.assertIn(words, self.result.stdout)
        self.assertEqual(self.result.stderr, "")

    def test_heights_of_the_approach_are_right_to_a_centimetre(self):
        lab = dataset("lab")
        copy = self.folder / "lab"
        copy.mkdir()
        for name in ("left", "right", "frames.csv"):
            (copy / name).symlink_to(lab / name)
        for side in self.cameras:
            shutil.copy(str(self.folder / f"{side}.yaml"), str(copy))
        programs = DEVEL_DIR / "lib/uav_landing"
        bag, estimates, scores = (self.folder / name for name in ("lab.bag", "lab.csv", "lab.json"))
        run([programs / "dataset_to_bag", "--dataset", copy, "--output", bag], check=True)
        run([programs / "process_bag", "--input", bag, "--csv", estimates], check=True)
        run([SOURCE_DIR / "src/tools/evaluate", "--truth", copy / "frames.csv", "--estimates", estimates, "--json",
             scores], check=True)
        result = json.loads(scores.read_text())
        self.assertGreater(result["coverage"], 0.98)
        self.assertLess(result["quantities"]["height"]["mean"], 0.01)
        self.assertLess(result["quantities"]["approach_angle"]["mean"], 0.1)


class LabInputTest(TemporaryFolderTest):
    """Other ways to give the images, and what is wrong with them."""

    def setUp(self):
        super().setUp()
        self.images = dataset("lab_chessboard")

    def copy(self, count=30):
        """A folder with links to the first views."""
        folder = self.folder / "images"
        for side in ("left", "right"):
            (folder / side).mkdir(parents=True)
            for file in sorted((self.images / side).glob("*.png"))[:count]:
                (folder / side / file.name).symlink_to(file)
        return folder

    def test_archive_of_camera_calibration_gives_the_same_as_the_folder(self):
        archive = self.folder / "calibrationdata.tar.gz"
        with tarfile.open(str(archive), "w:gz") as tar:
            for side in ("left", "right"):
                for file in sorted((self.images / side).glob("*.png")):
                    tar.add(str(file), f"{side}-{file.stem[2:]}.png")
        for source, output in ((archive, self.output), (self.images, self.folder / "other")):
            self.assertEqual(calibrate(source, output).returncode, 0)
        for name in ("left.yaml", "right.yaml"):
            self.assertEqual((self.output / name).read_text(), (self.folder / "other" / name).read_text())

    def test_board_that_moved_between_the_exposures_is_left_out(self):
        folder = self.copy()
        (folder / "right/000005.png").unlink()
        (folder / "right/000005.png").symlink_to(self.images / "right/000006.png")
        result = calibrate(folder, self.output)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("do not fit the others: 000005", result.stdout)
        P = yaml.safe_load((self.output / "right.yaml").read_text())["projection_matrix"]["data"]
        self.assertAlmostEqual(-P[3] / P[0], 0.65, delta=0.0013)

    def test_image_without_its_partner_is_named(self):
        folder = self.copy()
        (folder / "left/000010.png").unlink()
        result = calibrate(folder, self.output)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("without the other image: 000010", result.stdout)

    def test_refuses_too_few_views(self):
        self.assert_refused(calibrate(self.copy(count=6), self.output), "images", "only 5 views", "8 are needed", "000003")

    def test_refuses_wrong_board_size(self):
        result = calibrate(self.images, self.output, board=["--size", "9x7", "--square", "0.1"])
        self.assert_refused(result, self.images, "9x7 inner corners", "not squares")

    def test_refuses_swapped_cameras(self):
        folder = self.folder / "images"
        folder.mkdir()
        (folder / "left").symlink_to(self.images / "right")
        (folder / "right").symlink_to(self.images / "left")
        self.assert_refused(calibrate(folder, self.output), "swapped")

    def test_refuses_baseline_that_shows_a_wrong_square(self):
        result = calibrate(self.images, self.output, "--baseline", "0.65", board=["--size", "8x6", "--square", "0.105"])
        self.assert_refused(result, "baseline: not good enough", "--square", "nothing written")
        self.assertIn("5.00 % more than the measured 0.65 m", result.stdout)

    def test_refuses_images_of_different_sizes(self):
        folder = self.copy()
        wrong = folder / "right/000007.png"
        image = cv2.imread(str(wrong))
        wrong.unlink()
        cv2.imwrite(str(wrong), cv2.resize(image, (640, 480)))
        self.assert_refused(calibrate(folder, self.output), wrong, "640x480", "left/000000.png 320x240")

    def test_refuses_damaged_image(self):
        folder = self.copy()
        (folder / "left/000002.png").unlink()
        (folder / "left/000002.png").write_bytes((self.images / "left/000002.png").read_bytes()[:30])
        self.assert_refused(calibrate(folder, self.output), folder / "left/000002.png", "damaged")


class BadInputTest(TemporaryFolderTest):
    def write(self, *names):
        for name in names:
            path = self.folder / "images" / name
            path.parent.mkdir(parents=True, exist_ok=True)
            cv2.imwrite(str(path), np.full((48, 64), 128, np.uint8))
        return self.folder / "images"

    def test_missing_folder(self):
        self.assert_refused(calibrate(self.folder / "nonsuch", self.output), self.folder / "nonsuch", "no such file")

    def test_file_that_is_no_archive(self):
        (self.folder / "a.tar").write_text("nothing")
        self.assert_refused(calibrate(self.folder / "a.tar", self.output), "a.tar", "neither a folder nor a tar")

    def test_folder_of_one_camera_missing(self):
        self.assert_refused(calibrate(self.write("left/a.png"), self.output), "images", "no images of the right camera")

    def test_bag_of_images_that_cannot_be_read(self):
        bag = self.folder / "bad.bag"
        for message, words in ((Image(height=4, width=4, encoding="strange", data=bytes(16)), "encoding 'strange'"),
                               (Image(height=4, width=4, step=4, encoding="mono8", data=b"12"), "2 bytes"),
                               (CompressedImage(format="png"), "sensor_msgs/CompressedImage, expected sensor_msgs/Image")):
            with rosbag.Bag(str(bag), "w") as out:
                message.header.stamp = rospy.Time(100)
                for side in ("left", "right"):
                    out.write(f"/stereo/{side}/image_raw", message, message.header.stamp)
            with self.subTest(words):
                self.assert_refused(calibrate(bag, self.output), "/stereo/left/image_raw at 100.000 s", words)

    def test_names_that_do_not_pair(self):
        self.assert_refused(calibrate(self.write("left/a.png", "right/b.png"), self.output), "left/a.png", "right/b.png")

    def test_no_board_in_any_image(self):
        self.assert_refused(calibrate(self.write("left/a.png", "right/a.png"), self.output), "images",
                            "no pair shows a whole board of 8x6 inner corners")

    def test_wrong_usage(self):
        for board, word in ((["--size", "8", "--square", "0.1"], "'8'"), (["--size", "8x2", "--square", "0.1"], "'8x2'"),
                            (["--size", "8x6", "--square", "-1"], "'-1'"), (["--size", "8x6"], "--square")):
            with self.subTest(board):
                self.assert_refused(calibrate(self.folder, self.output, board=board), word, status=2)


def views_of_ideal_cameras(tilt):
    """12 boards seen by cameras of 600 px focal length 0.3 m apart, corners good to 0.05 px."""
    noise = np.random.RandomState(1)
    K = np.array([[600, 0, 320], [0, 600, 240], [0, 0, 1.0]])
    board = rig.ChessboardInfo("chessboard", 8, 6, 0.1)
    corners = np.array([[0.1 * (row - 2.5), 0.1 * (3.5 - column), 0] for row in range(6) for column in range(8)])
    views = []
    for i in range(12):
        turn = (tilt * math.cos(2.4 * i), tilt * math.sin(2.4 * i), math.pi / 2)
        place = np.array([0.15 + 0.2 * math.cos(i), 0.2 * math.sin(2 * i), 2.0 + 0.1 * (i % 4)])
        left, right = (cv2.projectPoints(corners, turn, place - (x, 0, 0), K, None)[0] + noise.normal(0, 0.05, (48, 1, 2))
                       for x in (0, 0.3))
        views.append(rig.View(str(i), left.astype(np.float32), right.astype(np.float32), board))
    return views


class ChecksTest(unittest.TestCase):
    def test_height_limit_follows_from_the_disparity_at_the_lower_edge(self):
        # 0.5 m baseline, 100 rows below the horizon, f = 400 px: at 10 m height the ground at the lower edge is
        # 10 * 400 / 100 = 40 m ahead, its disparity 400 * 0.5 / 40 = 5 px, and 0.05 px of it are 1 %.
        self.assertAlmostEqual(checks.height_for_share(0.01, 0.05, baseline=0.5, rows_below=100), 10)

    def test_boards_that_are_never_tilted_are_not_good_enough(self):
        for tilt, faults in ((0.5, []), (0.02, ["focal length: not good enough"])):
            calibrator = rig.make_calibrator(8, 6, 0.1, 2)
            calibrator.size = calibrator.l.size = calibrator.r.size = (640, 480)
            with self.subTest(tilt=tilt):
                views, _ = rig.calibrate(calibrator, views_of_ideal_cameras(tilt))
                self.assertEqual(checks.make_report(calibrator, views).faults, faults)

        calibrator = rig.make_calibrator(8, 6, 0.1, 2)
        calibrator.size = calibrator.l.size = calibrator.r.size = (640, 480)
        with self.assertRaisesRegex(InputError, "tilted"):
            rig.calibrate(calibrator, views_of_ideal_cameras(tilt=0.0))

    def test_coverage_has_a_verdict(self):
        self.assertEqual(checks.coverage_in_words([]), "in all parts of it: good")
        self.assertTrue(checks.coverage_in_words(["top", "bottom"]).endswith("none in: top, bottom, where the lens is a "
                                                                             "guess: show the board there: usable"))
        self.assertTrue(checks.coverage_in_words(5 * ["top"]).endswith(": poor"))

    def test_an_unlikely_baseline_is_questioned(self):
        for baseline, questioned in ((0.009, True), (0.012, False), (9.5, False), (65, True)):
            with self.subTest(baseline=baseline):
                report = checks.Report()
                checks.add_baseline(report, baseline, None)
                warned = [line for line in report.lines if line.startswith("warning")]
                self.assertEqual(len(warned), questioned)
                if questioned:
                    self.assertIn(f"baseline {baseline:g} m: is --square the side of one square in metres?", warned[0])
        self.assertEqual(report.faults, [])

    def test_a_likely_baseline_is_what_it_is_for_the_chain(self):
        header = (SOURCE_DIR / "include/uav_landing/geometry/rig_check.h").read_text()
        limits = re.search(r"kShortestLikelyBaseline = ([\d.]+), kLongestLikelyBaseline = ([\d.]+);", header)
        self.assertEqual(tuple(float(limit) for limit in limits.groups()), checks.LIKELY_BASELINE)

    def test_coverage_names_the_empty_parts(self):
        corners = np.array([[u, v] for u in range(5, 320, 10) for v in range(5, 160, 10)], float)
        share, empty = checks.coverage(corners, (320, 240))
        self.assertAlmostEqual(share, 4 / 6)
        self.assertEqual(empty, ["lower left", "bottom", "lower right"])

    def test_corners_counted_from_the_other_end_are_turned_back(self):
        for columns, rows in ((8, 6), (6, 6)):
            board = rig.ChessboardInfo("chessboard", columns, rows, 0.1)
            grid = np.array([[[10.0 * i + j, 12.0 * j - i] for i in range(columns)] for j in range(rows)])
            reference = grid.reshape(-1, 1, 2)
            for turn in range(4) if columns == rows else (0, 2):
                turned = np.rot90(grid, turn).reshape(-1, 1, 2) + (-60, 3)
                with self.subTest(board=(columns, rows), turn=turn):
                    np.testing.assert_allclose(rig.in_order_of(reference, turned, board), reference + (-60, 3))
