"""Writes small bags of stereo images for tests of the programs."""

import numpy as np
import rosbag
import rospy
from sensor_msgs.msg import CameraInfo, Image

WIDTH, HEIGHT, FOCAL_LENGTH, BASELINE = 160, 120, 150.0, 0.5

# A calibration file of ROS: of such a camera, or of a wider image.
CALIBRATION_FILE = """image_width: {width}
image_height: 120
camera_name: {side}
camera_matrix: {{rows: 3, cols: 3, data: [150, 0, 80, 0, 150, 60, 0, 0, 1]}}
distortion_model: plumb_bob
distortion_coefficients: {{rows: 1, cols: 5, data: [0, 0, 0, 0, 0]}}
rectification_matrix: {{rows: 3, cols: 3, data: [1, 0, 0, 0, 1, 0, 0, 0, 1]}}
projection_matrix: {{rows: 3, cols: 4, data: [150, 0, 80, {shift}, 0, 150, 60, 0, 0, 0, 1, 0]}}
"""


def camera_info(right=False):
    """Returns an ideal camera whose images are rectified already."""
    info = CameraInfo(width=WIDTH, height=HEIGHT, distortion_model="plumb_bob", D=[0.0] * 5)
    info.K = [FOCAL_LENGTH, 0, WIDTH / 2, 0, FOCAL_LENGTH, HEIGHT / 2, 0, 0, 1]
    info.R = [1, 0, 0, 0, 1, 0, 0, 0, 1]
    shift = -FOCAL_LENGTH * BASELINE if right else 0
    info.P = [FOCAL_LENGTH, 0, WIDTH / 2, shift, 0, FOCAL_LENGTH, HEIGHT / 2, 0, 0, 0, 1, 0]
    return info


def image(pixels, encoding="mono8"):
    """Makes an image message of a numpy array (rows, columns[, channels])."""
    pixels = np.ascontiguousarray(pixels)
    message = Image(height=pixels.shape[0], width=pixels.shape[1], encoding=encoding)
    message.step = pixels.strides[0]
    message.data = pixels.tobytes()
    return message


def noise(seed):
    return np.random.RandomState(seed).randint(0, 256, (HEIGHT, WIDTH)).astype(np.uint8)


def noise_frames(count=3, start=10.0, period=0.1):
    """Returns frames of a camera that sees nothing sensible: enough for the chain to run and to find nothing."""
    return [Frame(start + i * period, image(noise(2 * i)), image(noise(2 * i + 1))) for i in range(count)]


class Frame:
    """One image pair with its calibrations. Set a message to None to leave it out."""

    def __init__(self, stamp, left, right):
        self.stamp = stamp
        self.messages = {"left/image_raw": left, "left/camera_info": camera_info(),
                         "right/image_raw": right, "right/camera_info": camera_info(right=True)}

    @property
    def left(self):
        return self.messages["left/image_raw"]

    @property
    def left_info(self):
        return self.messages["left/camera_info"]

    @property
    def right_info(self):
        return self.messages["right/camera_info"]


def write_bag(path, frames, camera="/stereo", begin=1000):
    """Writes frames in this order. They are recorded from this second on, whatever their stamps are."""
    with rosbag.Bag(str(path), "w") as bag:
        for number, frame in enumerate(frames):
            recorded = rospy.Time.from_sec(begin + 0.01 * number)
            for topic, message in frame.messages.items():
                if message is None:
                    continue
                message.header.stamp = rospy.Time(0, round(frame.stamp * 1e9))
                message.header.frame_id = topic.split("/")[0]
                bag.write(f"{camera}/{topic}", message, recorded)
