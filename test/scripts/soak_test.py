"""A short soak, and whether the soak can tell a leak."""

import importlib.machinery
import importlib.util
import shutil
import tempfile
import unittest
from pathlib import Path

import rosbag
import rospy
from geometry_msgs.msg import TransformStamped
from sensor_msgs.msg import Image
from tf2_msgs.msg import TFMessage

from project import SOURCE_DIR, run

SOAK = SOURCE_DIR / "scripts/soak"


def load_soak():
    loader = importlib.machinery.SourceFileLoader("soak", str(SOAK))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader("soak", loader))
    loader.exec_module(module)
    return module


class SoakTest(unittest.TestCase):
    def test_growth_is_that_of_the_line_after_the_warm_up(self):
        soak = load_soak()
        warm_up = [(t, 50 + 2 * t) for t in range(20)]
        level = warm_up + [(t, 90 + (t % 3)) for t in range(20, 100)]
        self.assertLess(abs(soak.growth(level)), 0.002)
        leaking = warm_up + [(t, 90 + 0.1 * (t - 20)) for t in range(20, 100)]
        self.assertAlmostEqual(soak.growth(leaking), 7.9 / 90, delta=0.005)

    def test_stamps_of_tf_move_with_those_of_the_images(self):
        soak = load_soak()
        folder = Path(tempfile.mkdtemp(prefix="uav_landing_soak_test_"))
        self.addCleanup(shutil.rmtree, folder)
        with rosbag.Bag(str(folder / "a.bag"), "w") as bag:
            transforms = TFMessage([TransformStamped()])
            transforms.transforms[0].header.stamp = rospy.Time(10)
            bag.write("/tf", transforms, rospy.Time(10))
            for second in (10, 11, 12):
                image = Image()
                image.header.stamp = rospy.Time(second)
                bag.write("/stereo/left/image_raw", image, image.header.stamp)
        self.assertEqual(soak.repeated(folder / "a.bag", folder / "b.bag", 2), 6)
        with rosbag.Bag(str(folder / "b.bag")) as bag:
            stamps = [message.transforms[0].header.stamp.to_sec() for _, message, _ in bag.read_messages(["/tf"])]
        self.assertEqual(stamps, [10, 14])

    def test_what_is_said_while_no_image_comes_is_no_pair(self):
        self.assertEqual(load_soak().pairs_in(["%time,field", "1000,1", "2000,3", "3000,2"]), 2)

    def test_memory_stays_for_a_short_while(self):
        folder = tempfile.mkdtemp(prefix="uav_landing_soak_test_")
        self.addCleanup(shutil.rmtree, folder)
        result = run([SOAK, "--output", folder, "--offline", "8", "--nodelets", "25", "--limit", "10"])
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
        self.assertIn("| offline |", result.stdout)
        self.assertIn("| nodelets |", result.stdout)
        self.assertTrue((Path(folder) / "soak.png").stat().st_size > 0)


if __name__ == "__main__":
    unittest.main()
