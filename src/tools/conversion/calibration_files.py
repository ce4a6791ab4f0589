"""Reads calibration files of others: ROS's .ini, Kalibr camchains and stereo files of OpenCV (FileStorage)."""

import re
from collections import namedtuple

import cv2
import numpy as np

from .cameras import camera_info, field, from_ros_yaml, load_yaml, model_of, numbers, ros_yaml, stereo_rectified
from .errors import InputError, unreadable

SIDES = ("left", "right")
UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001}
KALIBR_MODELS = {"radtan": "plumb_bob", "equidistant": "equidistant", "none": "plumb_bob"}
# The names that OpenCV's samples, its users and ORB-SLAM give to the parts of a stereo calibration.
OPENCV_NAMES = {
    "K": ("M{n}", "K{n}", "cameraMatrix{n}", "CameraMatrix{n}", "camera_matrix_{n}", "cameraMatrix_{side}",
          "{side}_camera_matrix", "{SIDE}.K", "K_{side}", "mtx{n}", "mtx{S}"),
    "D": ("D{n}", "distCoeffs{n}", "DistCoeffs{n}", "dist_coeffs_{n}", "distCoeffs_{side}", "{side}_distortion_coefficients",
          "{SIDE}.D", "D_{side}", "dist{n}", "dist{S}"),
    "R": ("R", "rotation", "rotation_matrix"),
    "T": ("T", "translation", "translation_vector")}


def read_text(path):
    try:
        with open(str(path)) as file:
            return file.read()
    except OSError as error:
        raise unreadable(path, error)
    except UnicodeDecodeError as error:
        raise InputError(f"{path}: is no text ({error.reason})")


def significant_lines(text):
    lines = (re.split(r"[#;]", line)[0].strip() for line in text.splitlines())
    return [line for line in lines if line]


def is_ini(text):
    return next(iter(significant_lines(text)), "").startswith("[")


def ini_sections(path, text):
    """Returns each section's name with its labels, each with the numbers below it; an [image] stands before each camera."""
    sections, label = [], None
    for line in significant_lines(text):
        words = line.split()
        if line.startswith("["):
            sections.append((line.strip("[] "), {}))
            label = None
            continue
        try:
            values = [float(word) for word in words]
        except ValueError:
            label = line.lower()
            sections[-1][1][label] = []
            continue
        if label is None:
            raise InputError(f"{path}: '{line}' is below no name")
        sections[-1][1][label] += values
    return sections


def from_ros_ini(path, text, side):
    """Reads a camera from an .ini file of camera_calibration (also saved as ost.txt). If the file has two, it takes this side's."""
    size, found = {}, []
    for name, section in ini_sections(path, text):
        if name == "image":
            size = section
        elif "camera matrix" in section:
            found.append((name, {**size, **section}))
    if not found:
        raise InputError(f"{path}: no section with a 'camera matrix'")
    if len(found) > 1:
        found = [camera for camera in found if camera[0].split("/")[-1] == side]
        if len(found) != 1:
            raise InputError(f"{path}: has several cameras, and not one named {side}")
    content = found[0][1]
    distortion = numbers(content, path, ("distortion",), len(field(content, path, "distortion")))
    size = [numbers(content, path, (name,), 1)[0] for name in ("width", "height")]
    return camera_info(size, numbers(content, path, ("camera matrix",), 9), distortion,
                       numbers(content, path, ("rectification",), 9), numbers(content, path, ("projection",), 12),
                       model_of(distortion))


def from_ros_file(path, side):
    """Reads a calibration file of ROS for one camera. It may be YAML or .ini, whatever its name says."""
    text = read_text(path)
    return from_ros_ini(path, text, side) if is_ini(text) else from_ros_yaml(path)


# Intrinsics of one camera; parts: K, D, model.
Lens = namedtuple("Lens", "size parts")


def kalibr_lens(content, path, name):
    model, distortion = field(content, path, name, "camera_model"), field(content, path, name, "distortion_model")
    if model != "pinhole" or distortion not in KALIBR_MODELS:
        raise InputError(f"{path}: {name}: camera_model {model} with distortion_model {distortion}, expected pinhole with "
                         f"{', '.join(KALIBR_MODELS)}: calibrate with --models pinhole-radtan or pinhole-equi")
    fx, fy, cx, cy = numbers(content, path, (name, "intrinsics"), 4)
    width, height = numbers(content, path, (name, "resolution"), 2)
    D = np.zeros(4) if distortion == "none" else numbers(content, path, (name, "distortion_coeffs"), 4)
    K = np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]])
    return Lens((int(width), int(height)), (K, D, KALIBR_MODELS[distortion]))


def from_kalibr(content, path):
    """Returns both lenses and the transform from cam0 to cam1."""
    lenses = [kalibr_lens(content, path, name) for name in ("cam0", "cam1")]
    if "T_cn_cnm1" in content["cam1"]:
        pose = numbers(content, path, ("cam1", "T_cn_cnm1"), 16).reshape(4, 4)
    else:
        first, second = (numbers(content, path, (name, "T_cam_imu"), 16).reshape(4, 4) for name in ("cam0", "cam1"))
        pose = second @ np.linalg.inv(first)
    return lenses, pose


def opencv_entries(paths):
    """Returns the matrices and numbers of all files by name."""
    entries = {}
    for path in paths:
        read_text(path)
        try:
            storage = cv2.FileStorage(str(path), cv2.FILE_STORAGE_READ)
        except (cv2.error, SystemError):  # the binding wraps what its constructor throws
            raise InputError(f"{path}: cannot be read as a FileStorage of OpenCV")
        for name in storage.root().keys():
            node = storage.getNode(name)
            value = node.mat() if node.isMap() else node.real() if node.isReal() or node.isInt() else None
            if node.isSeq() and all(node.at(i).isReal() or node.at(i).isInt() for i in range(node.size())):
                value = np.array([node.at(i).real() for i in range(node.size())])
            if value is not None:
                entries[name] = value
    return entries


def opencv_entry(entries, kind, number=0):
    side = SIDES[number]
    names = [name.format(n=number + 1, side=side, SIDE=side.upper(), S=side[0].upper()) for name in OPENCV_NAMES[kind]]
    for name in names:
        if name in entries:
            return np.asarray(entries[name], float)
    raise InputError(f"no {kind} of the {side} camera" if kind in "KD" else f"no {kind}, the pose between the cameras"
                     f": expected one of {', '.join(names)}, found {', '.join(entries) or 'nothing'}")


def opencv_size(entries, given):
    """Returns the image size: as given, or else as the files say."""
    if given:
        return given
    for name in ("size", "imageSize", "image_size", "img_size"):
        if name in entries and np.size(entries[name]) == 2:
            return tuple(int(value) for value in np.ravel(entries[name]))
    for names in (("image_width", "image_height"), ("width", "height"), ("LEFT.width", "LEFT.height")):
        if all(name in entries for name in names):
            return tuple(int(entries[name]) for name in names)
    raise InputError("the files do not say how large the images are: give --size WIDTHxHEIGHT")


def from_opencv(paths, size, fisheye):
    """Returns both lenses and the transform from the left camera to the right one."""
    entries = opencv_entries(paths)
    size, lenses = opencv_size(entries, size), []
    for number in (0, 1):
        K, D = opencv_entry(entries, "K", number), opencv_entry(entries, "D", number).ravel()
        if K.shape != (3, 3):
            raise InputError(f"K of the {SIDES[number]} camera: expected 3x3 numbers")
        if fisheye and D.size != 4:
            raise InputError(f"D of the {SIDES[number]} camera: {D.size} coefficients, a fisheye lens has 4")
        lenses.append(Lens(size, (K, D, "equidistant" if fisheye else model_of(D))))
    pose = np.eye(4)
    R, T = opencv_entry(entries, "R"), opencv_entry(entries, "T").ravel()
    pose[:3, :3] = cv2.Rodrigues(R)[0] if R.size == 3 else R
    pose[:3, 3] = T
    return lenses, pose


def check_unit(pose, unit):
    if unit:
        return UNITS[unit]
    length = np.linalg.norm(pose[:3, 3])
    choices = ", ".join(f"--unit {name} ({length * scale:.4g} m)" for name, scale in UNITS.items())
    raise InputError(f"T is {length:.4g} long, in the unit of the board's squares: say which gives the baseline: {choices}")


def stereo_cameras(paths, unit=None, size=None, fisheye=False):
    """Returns both cameras, left and right, and what was found, in words."""
    first = paths[0]
    text = read_text(first)
    is_kalibr = re.search(r"^cam0:", text, re.MULTILINE)
    if is_ini(text) or re.search(r"^camera_matrix:", text, re.MULTILINE):
        raise InputError(f"{first}: is a calibration file of ROS already, for one camera: drivers and --left-calibration take it")
    if is_kalibr:
        lenses, pose = from_kalibr(load_yaml(first), first)
        scale, kind = UNITS[unit or "m"], "Kalibr"
    else:
        lenses, pose = from_opencv(paths, size, fisheye)
        scale, kind = check_unit(pose, unit), "OpenCV"
    R = pose[:3, :3]
    if not np.allclose(R @ R.T, np.eye(3), atol=1e-3) or np.linalg.det(R) < 0:
        raise InputError(f"{first}: the rotation between the cameras is none")
    if lenses[0].size != lenses[1].size:
        raise InputError(f"{first}: images of {lenses[0].size} and of {lenses[1].size}, expected the same for both")
    pose[:3, 3] *= scale
    second = -R.T @ pose[:3, 3]
    exchanged = second[0] < 0
    if exchanged:
        lenses, pose = lenses[::-1], np.linalg.inv(pose)
    cameras = stereo_rectified(lenses[0].size, lenses[0].parts, lenses[1].parts, pose)
    order = "the second camera is the left one" if exchanged else "the first camera is the left one"
    return cameras, f"{kind}, baseline {np.linalg.norm(second):.4g} m, {order}"


def convert_calibration(paths, folder, unit=None, size=None, fisheye=False):
    """Writes left.yaml and right.yaml of ROS into a folder and returns in words what was found."""
    cameras, found = stereo_cameras(paths, unit, size, fisheye)
    folder.mkdir(parents=True, exist_ok=True)
    files = [folder / f"{side}.yaml" for side in SIDES]
    for file, side, info in zip(files, SIDES, cameras):
        file.write_text(ros_yaml(info, side))
    return f"{files[0]}, {files[1]}: {found}"
