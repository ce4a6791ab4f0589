#!/usr/bin/python3
"""split_images: live images that have both images in them become those of two cameras."""

import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
import rospy
from launch_test import Listener, Process, eventually
from sensor_msgs.msg import CameraInfo, Image
from stereo_bag import CALIBRATION_FILE, HEIGHT, WIDTH


class SplitImagesTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        self.publisher = rospy.Publisher("/usb_cam/image_raw", Image, queue_size=10)
        self.heard = {(side, name): Listener(f"/rig/{side}/{name}", kind) for side in ("left", "right")
                      for name, kind in (("image_raw", Image), ("camera_info", CameraInfo))}
        self.addCleanup(lambda: [listener.close() for listener in self.heard.values()])

    def split(self, option="--side-by-side", width=WIDTH):
        files = []
        for side, shift in (("left", 0), ("right", -75)):
            file = self.folder / f"{side}.yaml"
            file.write_text(CALIBRATION_FILE.format(side=side, shift=shift, width=width))
            files += [f"--{side}-calibration", file]
        return Process("rosrun", "uav_landing", "split_images", option, "/usb_cam/image_raw", "--camera", "rig", *files)

    def send(self, pixels, stamp):
        image = Image(height=pixels.shape[0], width=pixels.shape[1], step=pixels.shape[1], encoding="mono8", data=pixels.tobytes())
        image.header.stamp, image.header.frame_id = rospy.Time(stamp), "usb_cam"
        self.publisher.publish(image)

    def test_each_half_comes_with_its_calibration(self):
        random = np.random.RandomState(1)
        for option, axis in (("--side-by-side", 1), ("--top-and-bottom", 0)):
            with self.subTest(option), self.split(option) as process:
                self.assertTrue(eventually(lambda: self.publisher.get_num_connections() == 1 and all(
                    listener.subscriber.get_num_connections() == 1 for listener in self.heard.values())), process.text())
                halves = {side: random.randint(0, 256, (HEIGHT, WIDTH)).astype(np.uint8) for side in ("left", "right")}
                stamp = 1000 + axis

                def found():
                    self.send(np.concatenate(list(halves.values()), axis), stamp)
                    return all(any(message.header.stamp == rospy.Time(stamp) for message in listener.all())
                               for listener in self.heard.values())
                self.assertTrue(eventually(found), process.text())
                for side, pixels in halves.items():
                    image, info = (next(message for message in self.heard[side, name].all() if message.header.stamp == rospy.Time(stamp))
                                   for name in ("image_raw", "camera_info"))
                    self.assertEqual((image.width, image.height, image.data), (WIDTH, HEIGHT, pixels.tobytes()))
                    self.assertEqual((info.width, info.P[3]), (WIDTH, 0 if side == "left" else -75))
                    self.assertEqual((image.header.frame_id, info.header.frame_id), 2 * (f"usb_cam_{side}",))
            self.assertTrue(eventually(lambda: self.publisher.get_num_connections() == 0))

    def test_a_calibration_of_the_whole_picture_is_named(self):
        with self.split(width=2 * WIDTH) as process:
            def said():
                self.send(np.zeros((HEIGHT, 2 * WIDTH), np.uint8), 2000)
                return "each half (side-by-side) has 160x120 pixels, the left calibration is for 320x120" in process.text()
            self.assertTrue(eventually(said), process.text())


if __name__ == "__main__":
    import rostest

    rospy.init_node("split_images_test", disable_rostime=True)
    rostest.rosrun("uav_landing", "split_images", SplitImagesTest, sys.argv)
