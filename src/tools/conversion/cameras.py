"""Reads and makes calibrations of a stereo pair as sensor_msgs/CameraInfo."""

import re

import cv2
import numpy as np
import yaml
from sensor_msgs.msg import CameraInfo

from .errors import InputError, unreadable


def camera_info(size, K, D, R, P, model="plumb_bob"):
    """Makes a CameraInfo of matrices. size is (width, height)."""
    info = CameraInfo(width=int(size[0]), height=int(size[1]), distortion_model=model)
    info.D, info.K, info.R, info.P = ([float(x) for x in np.ravel(values)] for values in (D, K, R, P))
    return info


class TagLoader(yaml.SafeLoader):
    """Reads a value with a tag, such as OpenCV's matrices, as if it had none."""


def without_tag(loader, _, node):
    if isinstance(node, yaml.MappingNode):
        return loader.construct_mapping(node, deep=True)
    return loader.construct_sequence(node, deep=True) if isinstance(node, yaml.SequenceNode) else loader.construct_scalar(node)


TagLoader.add_multi_constructor("", without_tag)

# What says that a file is of a whole stereo pair.
STEREO_FILE = re.compile(r"^\s*(cam0|M1|K1|cameraMatrix1|CameraMatrix1|camera_matrix_1|LEFT\.K|mtx1|mtxL)\s*:", re.MULTILINE)


def model_of(distortion):
    """Returns the distortion model of a file that names none. The number of coefficients tells it."""
    return "rational_polynomial" if len(distortion) > 5 else "plumb_bob"


def ros_yaml(info, name):
    """Writes a calibration file of ROS."""
    def matrix(values, columns):
        return f"{{rows: {len(values) // columns}, cols: {columns}, data: [{', '.join(repr(float(x)) for x in values)}]}}"
    return (f"image_width: {info.width}\nimage_height: {info.height}\ncamera_name: {name}\n"
            f"camera_matrix: {matrix(info.K, 3)}\ndistortion_model: {info.distortion_model}\n"
            f"distortion_coefficients: {matrix(info.D, len(info.D))}\n"
            f"rectification_matrix: {matrix(info.R, 3)}\nprojection_matrix: {matrix(info.P, 4)}\n")


def load_yaml(path):
    """Returns the content of a YAML file, without OpenCV's tags and first line."""
    try:
        with open(str(path)) as file:
            text = "\n".join(line for line in file.read().splitlines() if not line.startswith("%"))
        content = yaml.load(text, TagLoader)
    except OSError as error:
        raise unreadable(path, error)
    except (UnicodeDecodeError, yaml.YAMLError) as error:
        raise InputError(f"{path}: cannot be read as YAML ({error})")
    if not isinstance(content, dict):
        raise InputError(f"{path}: expected names and values")
    return content


def field(content, path, *names):
    """Returns a field of nested dictionaries."""
    for depth, name in enumerate(names):
        if not isinstance(content, dict) or name not in content:
            raise InputError(f"{path}: no field {'.'.join(names[:depth + 1])}")
        content = content[name]
    return content


def numbers(content, path, names, count):
    """Returns a field's list of that many finite numbers."""
    values = field(content, path, *names)
    try:
        array = np.array(values, float).ravel()
    except (TypeError, ValueError):
        array = np.array([])
    if array.size != count or not np.isfinite(array).all():
        raise InputError(f"{path}: {'.'.join(names)}: expected {count} finite numbers")
    return array


def from_ros_yaml(path):
    """Reads a calibration file of ROS (camera_calibration_parsers)."""
    content = load_yaml(path)
    if "camera_matrix" not in content and any(STEREO_FILE.match(f"{name}:") for name in content):
        raise InputError(f"{path}: is of a stereo pair, not of one camera: make left.yaml and right.yaml of it by "
                         "convert_recording calibration")
    size = numbers(content, path, ("image_width",), 1)[0], numbers(content, path, ("image_height",), 1)[0]
    distortion = field(content, path, "distortion_coefficients", "data")
    if not isinstance(distortion, list):
        raise InputError(f"{path}: distortion_coefficients.data: expected a list of numbers")
    return camera_info(size, numbers(content, path, ("camera_matrix", "data"), 9),
                       numbers(content, path, ("distortion_coefficients", "data"), len(distortion)),
                       numbers(content, path, ("rectification_matrix", "data"), 9),
                       numbers(content, path, ("projection_matrix", "data"), 12),
                       content.get("distortion_model") or model_of(distortion))


def rectified(K, baseline, size):
    """Makes both cameras of a rig whose images are rectified already; baseline in metres."""
    K = np.reshape(K, (3, 3))
    shift = np.zeros((3, 1))
    right = shift.copy()
    right[0] = -K[0, 0] * baseline
    return tuple(camera_info(size, K, np.zeros(5), np.eye(3), np.hstack([K, column])) for column in (shift, right))


def stereo_rectified(size, left, right, right_from_left):
    """Makes both cameras from their lenses, each (K, D, model), and the 4x4 transform from left to right camera axes."""
    R, t = right_from_left[:3, :3], right_from_left[:3, 3]
    fisheye = [lens[2] == "equidistant" and np.any(lens[1]) for lens in (left, right)]
    if fisheye[0] != fisheye[1]:
        raise InputError("one lens is a fisheye, the other one is not: expected two of one kind")
    if fisheye[0]:
        R_left, R_right, P_left, P_right = cv2.fisheye.stereoRectify(left[0], left[1], right[0], right[1], size, R, t,
                                                                     cv2.CALIB_ZERO_DISPARITY)[:4]
    else:
        R_left, R_right, P_left, P_right = cv2.stereoRectify(left[0], left[1], right[0], right[1], size, R, t,
                                                             flags=cv2.CALIB_ZERO_DISPARITY, alpha=0)[:4]
    if not P_right[0, 3] < 0 or P_right[1, 3] != 0:
        raise InputError("the second camera is not to the right of the first: "
                         f"it is at {np.round(-R.T @ t, 4).tolist()} in its axes (x right, y down, z forward)")
    return (camera_info(size, left[0], left[1], R_left, P_left, left[2]),
            camera_info(size, right[0], right[1], R_right, P_right, right[2]))
