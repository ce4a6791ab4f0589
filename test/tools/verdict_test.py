"""What process_bag says of a whole recording that is spoiled in one way: the likely cause, with its cure."""

import tempfile
import unittest
from pathlib import Path

import cv2
import numpy as np
import rosbag

from project import BUILD_DIR, SOURCE_DIR, run

PROGRAMS = BUILD_DIR / "devel/lib/uav_landing"


def swapped(side, pictures, number):
    return pictures["right" if side == "left" else "left"][number]


def late(side, pictures, number):
    return pictures[side][max(0, number - 2) if side == "right" else number]


def blurred(side, pictures, number):
    return cv2.GaussianBlur(pictures[side][number], (0, 0), 25)


def moved(matrix):
    """The right images are those of a camera that has moved since the calibration."""
    def spoiled(side, pictures, number):
        pixels = pictures[side][number]
        if side == "left":
            return pixels
        return cv2.warpAffine(pixels, matrix, pixels.shape[::-1], borderMode=cv2.BORDER_REPLICATE)
    return spoiled


SIDEWAYS = np.float32([[1, 0, 7], [0, 1, 0]])  # a degree
ABOUT_ITS_AXIS = cv2.getRotationMatrix2D((240, 180), 2, 1)
CAUSES = {
    "swapped": (swapped, "left and right images are swapped"),
    "late": (late, "the images of a pair were not taken at the same time"),
    "blurred": (blurred, "the images show hardly any texture or are blurred"),
    "sideways": (moved(SIDEWAYS), "a camera has turned sideways since the calibration: calibrate again"),
    "about its axis": (moved(ABOUT_ITS_AXIS), "the rows of left and right images do not belong together"),
}


class VerdictTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        made = run([PROGRAMS / "simulate_approach", "--config", SOURCE_DIR / "config/simulator/demo.yaml", "--duration", "2.5",
                    "--output", cls.folder / "approach.bag"])
        assert made.returncode == 0, made.stderr

    def said(self, spoil=None):
        bag = self.folder / "spoiled.bag"
        with rosbag.Bag(str(self.folder / "approach.bag")) as approach, rosbag.Bag(str(bag), "w") as result:
            topics = {side: f"/stereo/{side}/image_raw" for side in ("left", "right")}
            pictures = {side: [np.frombuffer(message.data, np.uint8).reshape(message.height, message.width)
                               for _, message, _ in approach.read_messages(topic)] for side, topic in topics.items()}
            counts = dict.fromkeys(topics, 0)
            for topic, message, stamp in approach.read_messages():
                for side in topics:
                    if spoil and topic == topics[side]:
                        message.data = np.ascontiguousarray(spoil(side, pictures, counts[side])).tobytes()
                        counts[side] += 1
                result.write(topic, message, stamp)
        processed = run([PROGRAMS / "process_bag", "--input", bag, "--csv", self.folder / "estimates.csv"])
        return processed.stdout + processed.stderr

    def test_a_good_recording_has_no_cause(self):
        self.assertNotIn("likely cause", self.said())

    def test_each_cause_is_named(self):
        for name, (spoil, cause) in CAUSES.items():
            with self.subTest(name):
                self.assertIn("likely cause: ", text := self.said(spoil))
                self.assertIn(cause, text)


if __name__ == "__main__":
    unittest.main()
