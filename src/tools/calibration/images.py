"""Reads pairs of calibration images from a folder, a tar archive or a bag."""

import re
import tarfile
from pathlib import Path

import cv2
import numpy as np

from .errors import InputError

# left/000001.png, or left-0001.png as in the archives of camera_calibration: side and name of the view.
IMAGE_FILE = re.compile(r"(?:^|/)(left|right)(?:[-_/]|(?=\d))([^/]+)\.(?:png|pgm|jpg)$")


BAG_PAIRS = 60  # of a bag, at most


class Image:
    """One encoded image: where it comes from, for messages, and a function that reads its bytes."""

    def __init__(self, source, read):
        self.source, self.read = source, read

    def decode(self):
        """Returns the grey image (rows, columns), uint8."""
        data = self.read()
        pixels = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_GRAYSCALE) if data else None
        if pixels is None:
            raise InputError(f"{self.source}: not an image, or damaged")
        return pixels


def list_images(path, camera="stereo"):
    """Lists {"left": {view name: Image}, "right": ...} of a folder, an archive or a bag with /camera/{left,right}/image_raw."""
    path = Path(path)
    if path.suffix == ".bag":
        return bag_images(path, camera)
    if path.is_dir():
        files = [(file.relative_to(path).as_posix(), str(file), file.read_bytes)
                 for pattern in ("*", "*/*") for file in sorted(path.glob(pattern)) if file.is_file()]
    elif path.is_file():
        files = archive_files(path)
    else:
        raise InputError(f"{path}: no such file or folder")
    images = {"left": {}, "right": {}}
    for name, source, read in files:
        match = IMAGE_FILE.search(name)
        if match:
            images[match[1]][match[2]] = Image(source, read)
    for side, found in images.items():
        if not found:
            raise InputError(f"{path}: no images of the {side} camera ({side}/*.png, or {side}-*.png)")
    return images


def archive_files(path):
    """Reads the image files of an archive in one pass, because going back in a compressed one would unpack it again each time."""
    try:
        with tarfile.open(str(path)) as archive:
            contents = [(member.name, archive.extractfile(member).read()) for member in archive
                        if member.isfile() and IMAGE_FILE.search(member.name)]
    except (tarfile.TarError, EOFError, OSError) as error:
        raise InputError(f"{path}: neither a folder nor a tar archive that can be read ({error})")
    return [(name, f"{path}: {name}", lambda data=data: data) for name, data in contents]


def grey(message, source):
    """Returns the grey levels of a sensor_msgs/Image."""
    from cv_bridge import CvBridge, CvBridgeError  # only here: folders and archives need no ROS
    if message._type != "sensor_msgs/Image":
        raise InputError(f"{source}: {message._type}, expected sensor_msgs/Image (convert_recording decodes others)")
    try:
        return CvBridge().imgmsg_to_cv2(message, "mono8")
    except (CvBridgeError, TypeError, ValueError) as error:
        raise InputError(f"{source}: {message.width}x{message.height} pixels with encoding '{message.encoding}' and "
                         f"{len(message.data)} bytes cannot be read ({error})")


def bag_topics(camera):
    return {f"/{camera.strip('/')}/{side}/image_raw": side for side in ("left", "right")}


def view_name(stamp):
    return f"{stamp.to_sec():.3f}"


def common_stamps(bag, path, topics):
    """Returns the stamps that both cameras have, in order."""
    present = bag.get_type_and_topic_info().topics
    missing = [topic for topic in topics if topic not in present]
    if missing:
        raise InputError(f"{path}: no topic {', '.join(missing)} (there are: {', '.join(sorted(present))}); "
                         "--camera names another namespace")
    stamps = {side: set() for side in topics.values()}
    for topic, message, _ in bag.read_messages(list(topics)):
        stamps[topics[topic]].add(message.header.stamp)
    common = sorted(stamps["left"] & stamps["right"])
    if not common:
        raise InputError(f"{path}: no left and right image have the same stamp: calibrate with the cameras "
                         "triggered together, or at rest from single images")
    return common


def bag_neighbours(path, camera, names, longest_gap, most):
    """{view name: (seconds, left image, right image) of the pair before, the same of the pair after} of a bag.

    Only for views that have both within the longest gap (s), and for so many of them at most, evenly spaced. The seconds are
    relative to the view.
    """
    import rosbag  # only here: folders and archives need no ROS
    topics = bag_topics(camera)
    with rosbag.Bag(str(path)) as bag:
        common = common_stamps(bag, path, topics)
        near = {view_name(common[i]): [(common[j] - common[i]).to_sec() for j in (i - 1, i + 1)]
                for i in range(1, len(common) - 1)}
        wanted = {name: (common[i - 1], common[i + 1]) for i, name in enumerate(map(view_name, common))
                  if name in names and name in near and max(map(abs, near[name])) <= longest_gap}
        wanted = dict(list(wanted.items())[::max(1, -(-len(wanted) // most))])
        stamps = {stamp for pair in wanted.values() for stamp in pair}
        pixels = {(topics[topic], message.header.stamp): grey(message, f"{path}: {topic}")
                  for topic, message, _ in bag.read_messages(list(topics)) if message.header.stamp in stamps}
    return {name: [(seconds, pixels["left", stamp], pixels["right", stamp]) for seconds, stamp in zip(near[name], pair)]
            for name, pair in wanted.items()}


def bag_images(path, camera):
    """Returns evenly spaced pairs of equal stamp, at most BAG_PAIRS, because neighbours at 20 Hz show the same board twice."""
    import rosbag  # only here: folders and archives need no ROS
    topics = bag_topics(camera)
    try:
        with rosbag.Bag(str(path)) as bag:
            common = common_stamps(bag, path, topics)
            chosen = {common[i] for i in np.linspace(0, len(common) - 1, min(BAG_PAIRS, len(common))).astype(int)}
            images = {"left": {}, "right": {}}
            for topic, message, _ in bag.read_messages(list(topics)):
                if message.header.stamp in chosen:
                    name = view_name(message.header.stamp)
                    pixels = grey(message, f"{path}: {topic} at {name} s")
                    png = cv2.imencode(".png", pixels)[1].tobytes()
                    images[topics[topic]][name] = Image(f"{path}: {topic} at {name} s", lambda data=png: data)
    except rosbag.ROSBagException as error:
        raise InputError(f"{path}: {error}")
    return images


def read_pairs(images):
    """Yields (view name, left image, right image) for every name that both cameras have; all images of one size."""
    names = sorted(set(images["left"]) & set(images["right"]))
    if not names:
        left, right = (next(iter(images[side].values())).source for side in ("left", "right"))
        raise InputError(f"no left and right image have the same name: {left}, {right}")
    first = images["left"][names[0]]
    size = None
    for name in names:
        pair = []
        for side in ("left", "right"):
            image = images[side][name]
            pixels = image.decode()
            size = size or pixels.shape
            if pixels.shape != size:
                raise InputError(f"{image.source} has {pixels.shape[1]}x{pixels.shape[0]} pixels, "
                                 f"{first.source} {size[1]}x{size[0]}: all images must have one size")
            pair.append(pixels)
        yield (name, *pair)


def unpaired(images):
    """Returns the names of views that only one camera has."""
    return sorted(set(images["left"]) ^ set(images["right"]))
