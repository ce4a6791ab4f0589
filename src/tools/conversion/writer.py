"""Writes stereo frames to a bag."""

import sys

import rosbag
import rospy
from sensor_msgs.msg import Image

from .errors import InputError


def write_frames(source, output, camera):
    """Writes all frames of a source. Stamps that start at zero, which is no time in ROS, are moved by a second."""
    offset, count, last = 0, 0, None
    with rosbag.Bag(str(output), "w") as bag:
        for nanoseconds, *pictures in source:
            if count == 0 and nanoseconds == 0:
                offset = 10 ** 9
            if last is not None and nanoseconds <= last:
                raise InputError(f"frame {count}: its stamp {nanoseconds} ns is not after the one before it, {last} ns")
            last = nanoseconds
            stamp = rospy.Time(*divmod(nanoseconds + offset, 10 ** 9))
            for side, pixels, info in zip(("left", "right"), pictures, source.cameras):
                if (pixels.shape[1], pixels.shape[0]) != (info.width, info.height):
                    raise InputError(f"frame {count}: the {side} image has {pixels.shape[1]}x{pixels.shape[0]} pixels, "
                                     f"its calibration is for {info.width}x{info.height}")
                image = Image(height=pixels.shape[0], width=pixels.shape[1], step=pixels.shape[1] * pixels.itemsize,
                              encoding=f"mono{8 * pixels.itemsize}", is_bigendian=sys.byteorder == "big")
                image.data = pixels.tobytes()
                for topic, message in (("image_raw", image), ("camera_info", info)):
                    message.header.stamp, message.header.frame_id = stamp, f"{camera}_{side}"
                    bag.write(f"/{camera}/{side}/{topic}", message, stamp)
            count += 1
    return count
