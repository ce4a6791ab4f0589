"""Inputs for the fuzzers to start from: make_corpus.py FOLDER writes FOLDER/<harness>/*."""
import os
import random
import sys

import cv2
import numpy
import rosbag
import rospy
from geometry_msgs.msg import TransformStamped
from sensor_msgs.msg import CameraInfo, Image, Imu
from tf2_msgs.msg import TFMessage

SOURCE_DIR = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
WIDTH, HEIGHT = 24, 16
BAG_WIDTH, BAG_HEIGHT = 8, 6
K = [20.0, 0.0, 12.0, 0.0, 20.0, 8.0, 0.0, 0.0, 1.0]


def save(folder, harness, name, content):
    path = os.path.join(folder, harness)
    os.makedirs(path, exist_ok=True)
    with open(os.path.join(path, name), "wb") as file:
        file.write(content)


def files_below(folder, ending):
    for path, _, names in sorted(os.walk(os.path.join(SOURCE_DIR, folder))):
        for name in sorted(names):
            if name.endswith(ending):
                yield os.path.join(path, name)


def calibration(side):
    projection = K[:3] + [-6.0 if side == "right" else 0.0] + K[3:6] + [0.0] + K[6:] + [0.0]
    rotation = [1, 0, 0, 0, 1, 0, 0, 0, 1]
    matrix = "  rows: {}\n  cols: {}\n  data: {}\n"
    return ("image_width: {}\nimage_height: {}\ncamera_name: {}\n".format(WIDTH, HEIGHT, side)
            + "camera_matrix:\n" + matrix.format(3, 3, K)
            + "distortion_model: plumb_bob\ndistortion_coefficients:\n" + matrix.format(1, 5, [-0.1, 0.01, 0, 0, 0])
            + "rectification_matrix:\n" + matrix.format(3, 3, rotation)
            + "projection_matrix:\n" + matrix.format(3, 4, projection)).encode()


def sections(yaml):
    """Its top-level sections, without comments: short inputs are changed sooner."""
    lines = [line for line in yaml.decode().splitlines() if line.strip() and not line.lstrip().startswith("#")]
    found = []
    for line in lines:
        if not line.startswith(" ") or not found:
            found.append([])
        found[-1].append(line.split(" #")[0])
    return ["\n".join(part).encode() for part in found]


def camera_info(side):
    info = CameraInfo(width=BAG_WIDTH, height=BAG_HEIGHT, distortion_model="plumb_bob", D=[0.0] * 5, K=K)
    info.R = [1, 0, 0, 0, 1, 0, 0, 0, 1]
    info.P = K[:3] + [-6.0 if side == "right" else 0.0] + K[3:6] + [0.0] + K[6:] + [0.0]
    return info


def messages():
    """Of everything that is read from bags: topic, message and when it was received."""
    mounting = TransformStamped(child_frame_id="imu_link")
    mounting.header.frame_id = "left"
    mounting.transform.rotation.w = 1
    yield "/tf_static", TFMessage([mounting]), rospy.Time(100)
    for frame in range(2):
        stamp = rospy.Time(100 + frame)
        inertial = Imu()
        inertial.header.stamp = stamp
        inertial.header.frame_id = "imu_link"
        yield "/imu/data", inertial, stamp
        for side in ("left", "right"):
            info = camera_info(side)
            image = Image(width=BAG_WIDTH, height=BAG_HEIGHT, step=BAG_WIDTH, encoding="mono8")
            image.data = bytes((7 * i + frame) % 256 for i in range(BAG_WIDTH * BAG_HEIGHT))
            info.header.stamp = image.header.stamp = stamp
            info.header.frame_id = image.header.frame_id = side
            yield "/stereo/{}/camera_info".format(side), info, stamp
            yield "/stereo/{}/image_raw".format(side), image, stamp


def write_bag(path, compression):
    """Without the definitions of the messages, which nobody reads."""
    with rosbag.Bag(path, "w", compression=compression, chunk_threshold=1000) as bag:
        for topic, message, stamp in messages():
            connection = {"topic": topic, "type": message._type, "md5sum": message._md5sum, "message_definition": ""}
            bag.write(topic, message, stamp, connection_header=connection)


def main():
    folder = sys.argv[1]
    chance = random.Random(1)
    for harness in ("camera_info", "image_message", "image_pair", "imu", "messages"):
        for i in range(20):
            size = chance.choice([0, 10, 100, 1000])
            save(folder, harness, "random_{:02d}".format(i), bytes(chance.randrange(256) for _ in range(size)))
    save(folder, "image_message", "mono8", bytes(5) + bytes(range(256)) + bytes(WIDTH * HEIGHT - 256))
    for side in ("left", "right"):
        save(folder, "calibration_file", side + ".yaml", calibration(side))
    save(folder, "calibration_file", "camera.ini", b"# oST\n[image]\nwidth\n24\nheight\n16\n[narrow_stereo]\n"
         b"camera matrix\n20 0 12\n0 20 8\n0 0 1\ndistortion\n0 0 0 0 0\nrectification\n1 0 0\n0 1 0\n0 0 1\n"
         b"projection\n20 0 12 0\n0 20 8 0\n0 0 1 0\n")
    for path in files_below("config", ".yaml"):
        with open(path, "rb") as file:
            for number, section in enumerate(sections(file.read())):
                name = "{}_{:02d}".format(os.path.relpath(path, SOURCE_DIR).replace("/", "_"), number)
                save(folder, "config", name, section)
    for compression in ("none", "bz2", "lz4"):
        path = os.path.join(folder, "bag", compression)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        write_bag(path, compression)
    save(folder, "bag", "format_1.2", b"#ROSBAG V1.2\n")
    png = cv2.imencode(".png", numpy.arange(WIDTH * HEIGHT, dtype=numpy.uint8).reshape(HEIGHT, WIDTH))[1].tobytes()
    frames = b"stamp_s,left,right,height_m,pitch_deg\n100.000000000,0.png,0.png,2.5,-3\n"
    save(folder, "dataset", "good", b"\n---\n".join([calibration("left"), calibration("right"), frames, png]))


if __name__ == "__main__":
    main()
