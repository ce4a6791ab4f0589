"""Calibrations of a stereo pair as sensor_msgs/CameraInfo."""

import cv2
import numpy as np
import yaml
from sensor_msgs.msg import CameraInfo

from .errors import InputError, unreadable


def camera_info(size, K, D, R, P, model="plumb_bob"):
    """CameraInfo of matrices; size is (width, height)."""
    info = CameraInfo(width=int(size[0]), height=int(size[1]), distortion_model=model)
    info.D, info.K, info.R, info.P = ([float(x) for x in np.ravel(values)] for values in (D, K, R, P))
    return info


def load_yaml(path):
    """Content of a YAML file; OpenCV's own tags are left out."""
    try:
        with open(str(path)) as file:
            text = "\n".join(line for line in file.read().splitlines() if not line.startswith("%"))
        content = yaml.safe_load(text)
    except OSError as error:
        raise unreadable(path, error)
    except (UnicodeDecodeError, yaml.YAMLError) as error:
        raise InputError(f"{path}: cannot be read as YAML ({error})")
    if not isinstance(content, dict):
        raise InputError(f"{path}: expected names and values")
    return content


def field(content, path, *names):
    """A field of nested dictionaries."""
    for depth, name in enumerate(names):
        if not isinstance(content, dict) or name not in content:
            raise InputError(f"{path}: no field {'.'.join(names[:depth + 1])}")
        content = content[name]
    return content


def numbers(content, path, names, count):
    """A list of that many finite numbers in a field."""
    values = field(content, path, *names)
    try:
        array = np.array(values, float).ravel()
    except (TypeError, ValueError):
        array = np.array([])
    if array.size != count or not np.isfinite(array).all():
        raise InputError(f"{path}: {'.'.join(names)}: expected {count} finite numbers")
    return array


def from_ros_yaml(path):
    """Calibration file of ROS (camera_calibration_parsers)."""
    content = load_yaml(path)
    size = numbers(content, path, ("image_width",), 1)[0], numbers(content, path, ("image_height",), 1)[0]
    distortion = field(content, path, "distortion_coefficients", "data")
    if not isinstance(distortion, list):
        raise InputError(f"{path}: distortion_coefficients.data: expected a list of numbers")
    return camera_info(size, numbers(content, path, ("camera_matrix", "data"), 9),
                       numbers(content, path, ("distortion_coefficients", "data"), len(distortion)),
                       numbers(content, path, ("rectification_matrix", "data"), 9),
                       numbers(content, path, ("projection_matrix", "data"), 12),
                       field(content, path, "distortion_model"))


def rectified(K, baseline, size):
    """Both cameras of a rig whose images are rectified already; baseline in metres."""
    K = np.reshape(K, (3, 3))
    shift = np.zeros((3, 1))
    right = shift.copy()
    right[0] = -K[0, 0] * baseline
    return tuple(camera_info(size, K, np.zeros(5), np.eye(3), np.hstack([K, column])) for column in (shift, right))


def stereo_rectified(size, left, right, right_from_left):
    """Both cameras from their lenses, each (K, plumb_bob D), and the 4x4 transform from left to right camera axes."""
    R, t = right_from_left[:3, :3], right_from_left[:3, 3]
    R_left, R_right, P_left, P_right = cv2.stereoRectify(left[0], left[1], right[0], right[1], size, R, t,
                                                         flags=cv2.CALIB_ZERO_DISPARITY, alpha=0)[:4]
    if not P_right[0, 3] < 0 or P_right[1, 3] != 0:
        raise InputError("the second camera is not to the right of the first: "
                         f"it is at {np.round(-R.T @ t, 4).tolist()} in its axes (x right, y down, z forward)")
    return camera_info(size, left[0], left[1], R_left, P_left), camera_info(size, right[0], right[1], R_right, P_right)
