"""Converts bags with other topic names, with compressed images, or with the images of both cameras in one."""

import copy

import rosbag
import rospy

from .errors import BrokenPicture, InputError
from .pictures import deinterlaced, raw_halves, to_image

SIDES = ("left", "right")
IMAGE_TYPES = ("sensor_msgs/Image", "sensor_msgs/CompressedImage")


def check_topics(bag, path, images, infos):
    """Checks that the topics of the images are there and are images, and that those of camera_info are there."""
    known = bag.get_type_and_topic_info().topics
    there = [name for name, info in known.items() if info.msg_type in IMAGE_TYPES]
    for topic in images:
        if topic not in known:
            raise InputError(f"{path}: no topic {topic}; images are on: {', '.join(sorted(there)) or 'no topic'}")
        if topic not in there:
            raise InputError(f"{path}: {topic} is {known[topic].msg_type}, expected an image")
    for side, topic in infos.items():
        if topic not in known:
            raise InputError(f"{path}: no topic {topic}; give a calibration file (--{side}-calibration) instead")


def check_half(image, side, calibration, topic, layout):
    """Checks that an image that was cut out is as large as its calibration says."""
    if calibration and (image.width, image.height) != (calibration.width, calibration.height):
        raise InputError(f"{topic}: each half ({layout}) has {image.width}x{image.height} pixels, the {side} calibration is for "
                         f"{calibration.width}x{calibration.height}: calibrate with the halves")


class BagConversion:
    """Copies images and calibrations to the names that the launch file expects.

    images: {"left": topic, "right": topic}, the same topic twice with a layout; infos: topics of camera_info by side;
    calibrations: CameraInfo by side, instead of those in the bag. layout: both images are in one, see pictures.py.
    deinterlace: of interlaced video one field is taken. right_delay: seconds by which the right camera's stamps are late; they
    are made earlier by that.
    """

    def __init__(self, camera, images, infos, calibrations, left_out, layout=None, deinterlace=False, right_delay=0.0):
        self.camera, self.images, self.infos, self.calibrations = camera, images, infos, calibrations
        self.left_out, self.layout, self.deinterlace = left_out, layout, deinterlace
        self.right_delay = rospy.Duration.from_sec(right_delay)
        self.counts = dict.fromkeys([f"{side}/{kind}" for side in SIDES for kind in ("image_raw", "camera_info")], 0)

    def convert(self, path, output):
        """Writes the bag and returns how many messages of each name it has."""
        with rosbag.Bag(str(path)) as bag:
            check_topics(bag, path, self.images.values(), self.infos)
            with rosbag.Bag(str(output), "w") as result:
                for topic, message, time in bag.read_messages([*self.images.values(), *self.infos.values()]):
                    if self.right_delay and topic in (self.images["right"], self.infos.get("right")):
                        self.make_earlier(message.header, topic)
                    for side in (side for side in SIDES if self.infos.get(side) == topic):
                        self.write(result, f"{side}/camera_info", message, time)
                    if topic in self.images.values():
                        self.take(result, message, topic, time)
        if self.left_out.count and not all(self.counts[f"{side}/image_raw"] for side in SIDES):
            raise InputError(self.left_out.first)
        return self.counts

    def make_earlier(self, header, topic):
        """Corrects a stamp of the right camera. A stamp of zero stays, because it means that there is none."""
        if header.stamp and header.stamp.to_nsec() <= self.right_delay.to_nsec():
            raise InputError(f"{topic}: the stamp {header.stamp.to_sec():.6f} s cannot be made earlier by "
                             f"{self.right_delay.to_sec():g} s: give a smaller --right-delay")
        if header.stamp:
            header.stamp -= self.right_delay

    def take(self, result, message, topic, time):
        """Writes the images of a message. A broken image is left out."""
        try:
            pictures = self.pictures(message, topic)
        except BrokenPicture as broken:
            return self.left_out.add(broken)
        for side, picture in pictures.items():
            if side in self.calibrations:
                info = copy.copy(self.calibrations[side])
                info.header = picture.header
                self.write(result, f"{side}/camera_info", info, time)
            self.write(result, f"{side}/image_raw", picture, time)

    def pictures(self, message, topic):
        """Returns the raw images of a message by side."""
        image = to_image(message, topic)
        if self.deinterlace:
            image = deinterlaced(image, topic)
        if not self.layout:
            return {side: image for side in SIDES if self.images[side] == topic}
        parts = dict(zip(SIDES, raw_halves(image, self.layout, topic)))
        for side in SIDES:
            check_half(parts[side], side, self.calibrations.get(side), topic, self.layout)
        return parts

    def write(self, result, name, message, time):
        result.write(f"/{self.camera}/{name}", message, time)
        self.counts[name] += 1
