"""Bags with other topic names or compressed images."""

import re

import cv2
import numpy as np
import rosbag
from sensor_msgs.msg import Image

from .errors import InputError

SIDES = ("left", "right")
IMAGE_TYPES = ("sensor_msgs/Image", "sensor_msgs/CompressedImage")


def encoding_of(pixels, compressed_format):
    """Of decoded pixels; None where they are no picture. The transport says in front that grey ones are a Bayer mosaic."""
    bits = {np.dtype(np.uint8): "8", np.dtype(np.uint16): "16"}.get(pixels.dtype)
    channels = 1 if pixels.ndim == 2 else pixels.shape[2]
    name = {1: "mono", 3: "bgr", 4: "bgra"}.get(channels)
    if not bits or not name:
        return None
    mosaic = re.match(rf"(bayer_[rgb]{{4}}){bits}\s*;", compressed_format)
    return (mosaic.group(1) if mosaic and channels == 1 else name) + bits


def to_image(message, topic):
    """A raw image; a compressed one is decoded by OpenCV, with the bits and channels that it has."""
    if message._type == "sensor_msgs/Image":
        return message
    # What the transport plugin puts before the picture (compressedDepth) or another codec (theora) is no picture file.
    pixels = cv2.imdecode(np.frombuffer(message.data, np.uint8), cv2.IMREAD_UNCHANGED) if message.data else None
    encoding = None if pixels is None else encoding_of(pixels, message.format)
    if encoding is None:
        raise InputError(f"{topic}: an image with format '{message.format}' at {message.header.stamp.to_sec():.6f} s "
                         "cannot be decoded to grey or colour of 8 or 16 bits")
    image = Image(header=message.header, height=pixels.shape[0], width=pixels.shape[1], encoding=encoding,
                  step=pixels.strides[0])
    image.data = pixels.tobytes()
    return image


def check_topics(bag, path, topics):
    """The topics of the images are there and are images; None where there is no camera_info to be taken."""
    known = bag.get_type_and_topic_info().topics
    images = [name for name, info in known.items() if info.msg_type in IMAGE_TYPES]
    for side in SIDES:
        topic = topics[f"{side}/image_raw"]
        if topic not in known:
            raise InputError(f"{path}: no topic {topic}; images are on: {', '.join(sorted(images)) or 'no topic'}")
        if topic not in images:
            raise InputError(f"{path}: {topic} is {known[topic].msg_type}, expected an image")
        info = topics.get(f"{side}/camera_info")
        if info and info not in known:
            raise InputError(f"{path}: no topic {info}; give a calibration file (--{side}-calibration) instead")


def convert_bag(path, output, camera, topics, calibrations):
    """Copies a bag's images and calibrations to the names the launch file expects; counts messages by name.

    topics: {"left/image_raw": name in the bag, ...}; calibrations: {"left": CameraInfo, ...} instead of those in the bag.
    """
    names = {topic: name for name, topic in topics.items()}
    counts = dict.fromkeys([f"{side}/{kind}" for side in SIDES for kind in ("image_raw", "camera_info")], 0)
    with rosbag.Bag(str(path)) as bag:
        check_topics(bag, path, topics)
        with rosbag.Bag(str(output), "w") as result:
            for topic, message, time in bag.read_messages(list(names)):
                name = names[topic]
                side = name.split("/")[0]
                if name.endswith("image_raw"):
                    message = to_image(message, topic)
                    if side in calibrations:
                        calibrations[side].header = message.header
                        result.write(f"/{camera}/{side}/camera_info", calibrations[side], time)
                        counts[f"{side}/camera_info"] += 1
                result.write(f"/{camera}/{name}", message, time)
                counts[name] += 1
    return counts
