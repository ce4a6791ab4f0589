"""scripts/calibrate: what a board that moves before rolling shutters says of their readout time."""

import shutil
import sys
import tempfile
import unittest
from pathlib import Path

import cv2
import numpy as np
import rosbag
import rospy
from cv_bridge import CvBridge

from project import SOURCE_DIR, run

sys.path.insert(0, str(SOURCE_DIR / "src/tools"))
from calibration import readout, rig  # noqa: E402

COLUMNS, ROWS, SQUARE = 8, 6, 0.05
SIZE = (320, 240)
K = np.array([[300.0, 0, 160], [0, 300, 120], [0, 0, 1]])
D = np.array([-0.1, 0.02, 0, 0, 0.0])
BASELINE = 0.2
STEP = 0.05  # s from pair to pair


class Hand:
    """A board that is moved by hand: its pose in the left camera's axes at any time."""

    def __init__(self, seed, speed=1.0):
        random = np.random.RandomState(seed)
        self.phases, self.frequencies = random.uniform(0, 2 * np.pi, 6), speed * random.uniform(0.3, 0.9, 6)

    def pose(self, time):
        swing = (0.35, 0.35, 0.2, 0.12, 0.1, 0.1) * np.sin(2 * np.pi * self.frequencies * time + self.phases)
        return cv2.Rodrigues(swing[:3])[0], swing[3:] + (BASELINE / 2, 0, 0.95)

    def seen(self, points, time, camera_x):
        rotation, place = self.pose(time)
        return cv2.projectPoints(points, cv2.Rodrigues(rotation)[0], place - (camera_x, 0, 0), K, D)[0][:, 0]


def row_time(row, readout_time):
    """After the stamp, which is that of the middle row."""
    return ((row + 0.5) / SIZE[1] - 0.5) * readout_time


def corners_of_rows(hand, points, time, camera_x, readout_time):
    """Each corner where the row that looks at it at that row's time finds it."""
    found = []
    for point in points:
        row = SIZE[1] / 2
        for _ in range(8):  # the corner moves by a few rows while the camera reads all of them
            pixel = hand.seen(point[None], time + row_time(row, readout_time), camera_x)[0]
            off, row = abs(pixel[1] - row), pixel[1]
        assert off < 1e-6, off
        found.append(pixel)
    return np.array(found)


def exact_calibrator():
    calibrator = rig.make_calibrator(COLUMNS, ROWS, SQUARE, 2)
    calibrator.size = calibrator.l.size = calibrator.r.size = SIZE
    for camera in (calibrator.l, calibrator.r):
        camera.intrinsics, camera.distortion = K.copy(), D.copy()
    calibrator.R, calibrator.T = np.eye(3), np.array([[-BASELINE], [0], [0.0]])
    return calibrator


def moments(calibrator, readout_time, seed, speed=1.0, count=16, noise=0.05):
    board = rig.ChessboardInfo("chessboard", COLUMNS, ROWS, SQUARE)
    points = calibrator.mk_object_points([board], True)[0].reshape(-1, 3).astype(float)
    middle = points - points.mean(axis=0)
    hand, random = Hand(seed, speed), np.random.RandomState(seed)
    views = []
    for i in range(count):
        pairs = [tuple((corners_of_rows(hand, middle, 0.7 * i + step, x, readout_time)
                        + random.normal(0, noise, (len(points), 2)))[:, None].astype(np.float32) for x in (0, BASELINE))
                 for step in (-STEP, 0, STEP)]
        views.append(readout.Moment(rig.View(str(i), *pairs[1], board), [-STEP, STEP], pairs[0], pairs[2]))
    return views


class FitTest(unittest.TestCase):
    def test_time_is_that_of_the_rows_within_its_claim(self):
        calibrator = exact_calibrator()
        for true, seed in ((0.03, 1), (0.03, 2), (-0.02, 3), (0.008, 4), (0, 5), (0, 6)):
            with self.subTest(true=true, seed=seed):
                found = readout.fit_readout(calibrator, moments(calibrator, true, seed))
                self.assertLess(found.stddev, 0.001)
                self.assertLess(abs(found.time - true), 3 * found.stddev)

    def test_noise_of_the_corners_is_in_the_standard_deviation(self):
        calibrator = exact_calibrator()
        ratios = []
        for seed in range(8):
            found = readout.fit_readout(calibrator, moments(calibrator, 0, seed, count=6, noise=0.3))
            ratios.append(found.time / found.stddev)
        self.assertLess(np.sqrt(np.mean(np.square(ratios))), 1.8)
        self.assertGreater(np.sqrt(np.mean(np.square(ratios))), 0.4)

    def test_a_board_at_rest_tells_nothing(self):
        calibrator = exact_calibrator()
        for speed in (0, 0.001, 0.01):
            with self.subTest(speed=speed):
                words = readout.in_words(readout.fit_readout(calibrator, moments(calibrator, 0.03, 1, speed, count=6)))
                self.assertIn("not known", words)
                self.assertIn("move the board faster", words)

    def test_few_views_tell_nothing(self):
        calibrator = exact_calibrator()
        self.assertIsNone(readout.fit_readout(calibrator, moments(calibrator, 0.03, 1, count=3)))
        self.assertIn("the pairs just before and after it", readout.in_words(None))

    def test_words_say_which_way_and_how_well(self):
        for time, words in ((0.03, "30.0 ms, one sigma 0.5 ms, of 9 views: rolling shutters, from top to bottom"),
                            (-0.03, "from bottom to top"), (0.001, "no rolling shutter is seen")):
            self.assertIn(words, readout.in_words(readout.Readout(time, 0.0005, 9)))
        self.assertIn("not known (one sigma 3 ms)", readout.in_words(readout.Readout(0.03, 0.003, 9)))


class Picture:
    """Images of the board by rolling shutters: each row by its own rays at its own time."""

    def __init__(self, hand, readout_time):
        self.hand, self.readout_time = hand, readout_time
        u, v = np.meshgrid(np.arange(2 * SIZE[0]) / 2 - 0.25, np.arange(2 * SIZE[1]) / 2 - 0.25)
        pixels = np.stack([u, v], axis=-1).reshape(-1, 1, 2)
        self.rays = cv2.undistortPoints(pixels, K, D).reshape(2 * SIZE[1], 2 * SIZE[0], 2)

    def row(self, index, time, camera_x):
        rotation, place = self.hand.pose(time + row_time(index // 2, self.readout_time))
        rays = np.concatenate([self.rays[index], np.ones((2 * SIZE[0], 1))], axis=1) @ rotation
        eye = rotation.T @ (np.array([camera_x, 0, 0]) - place)
        x, y = (eye[:2] - rays[:, :2] * (eye[2] / rays[:, 2])[:, None]).T / SQUARE
        columns, rows = COLUMNS + 1, ROWS + 1
        x, y = x + columns / 2, y + rows / 2
        white = (np.floor(x) + np.floor(y)) % 2 == 0
        inside = (x > 0) & (x < columns) & (y > 0) & (y < rows)
        return np.where(inside, np.where(white, 220, 30), 220)

    def take(self, time, camera_x, random):
        fine = np.array([self.row(index, time, camera_x) for index in range(2 * SIZE[1])], float)
        picture = fine.reshape(SIZE[1], 2, SIZE[0], 2).mean(axis=(1, 3))
        return np.clip(cv2.GaussianBlur(picture, (0, 0), 0.6) + random.normal(0, 1, picture.shape), 0, 255).astype(np.uint8)


class BagTest(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="uav_landing_readout_"))
        self.addCleanup(shutil.rmtree, str(self.folder))

    def calibrate(self, readout_time, steps):
        """Lines of scripts/calibrate with a bag of groups of pairs at these steps."""
        bag, random = self.folder / "board.bag", np.random.RandomState(1)
        picture = Picture(Hand(11), readout_time)
        with rosbag.Bag(str(bag), "w") as out:
            for time in (0.9 * group + step for group in range(16) for step in steps):
                for side, x in (("left", 0), ("right", BASELINE)):
                    message = CvBridge().cv2_to_imgmsg(picture.take(time, x, random), "mono8")
                    message.header.stamp = rospy.Time.from_sec(100 + time)
                    out.write(f"/stereo/{side}/image_raw", message, message.header.stamp)
        result = run([SOURCE_DIR / "scripts/calibrate", "--images", bag, "--size", f"{COLUMNS}x{ROWS}", "--square", SQUARE,
                      "--output", self.folder / "output"])
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        return [line for line in result.stdout.splitlines() if line.startswith("readout time")]

    def test_a_bag_of_a_moving_board_tells_the_readout_time(self):
        (line,) = self.calibrate(0.025, (-STEP, 0, STEP))
        self.assertIn("rolling shutters, from top to bottom", line)
        self.assertAlmostEqual(float(line.split()[2]), 25, delta=1.5)

    def test_a_bag_of_single_pairs_says_what_is_missing(self):
        (line,) = self.calibrate(0, (0,))
        self.assertIn("not known", line)
        self.assertIn("the pairs just before and after it", line)


if __name__ == "__main__":
    unittest.main()
