"""Recordings of others as stereo frames.

Each source yields (stamp in ns, left image, right image), grey of 8 or 16 bits, with the cameras' CameraInfo in .cameras.
"""

import csv
from pathlib import Path

import cv2
import numpy as np

from . import cameras
from .calibration_files import from_ros_file
from .errors import BrokenPicture, InputError, unreadable
from .pictures import decoded, halves, one_field


def read_image(path):
    try:
        data = Path(path).read_bytes()
    except OSError:
        data = b""
    pixels = decoded(data, cv2.IMREAD_GRAYSCALE | cv2.IMREAD_ANYDEPTH)
    if pixels is None:
        raise BrokenPicture(f"{path}: no such image, or damaged")
    if pixels.dtype not in (np.uint8, np.uint16):
        raise BrokenPicture(f"{path}: pixels are {pixels.dtype}, expected grey or colour of 8 or 16 bits")
    return pixels


class Pictures:
    """Reads the images of a pair, and leaves the pair out where one is broken."""

    def __init__(self, left_out):
        self.left_out = left_out

    def pair(self, left, right):
        """Returns a list with both images, or an empty one."""
        try:
            return [(read_image(left), read_image(right))]
        except BrokenPicture as broken:
            self.left_out.add(broken)
            return []


def read_rows(path, separator):
    """Returns the rows of a text table, without comments."""
    try:
        with open(str(path), newline="") as file:
            return [row for row in csv.reader(file, delimiter=separator, skipinitialspace=True)
                    if row and not row[0].startswith("#")]
    except OSError as error:
        raise unreadable(path, error)
    except (UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"{path}: cannot be read as a table ({error})")


class Euroc:
    """A folder in the ASL format of the EuRoC data: mav0/cam0, mav0/cam1 (Burri et al., IJRR 2016)."""

    def __init__(self, folder, left_out):
        self.pictures = Pictures(left_out)
        folder = Path(folder)
        self.base = folder / "mav0" if (folder / "mav0").is_dir() else folder
        sensors = [self.base / camera / "sensor.yaml" for camera in ("cam0", "cam1")]
        size, left, body_from_left = self.lens(sensors[0])
        right_size, right, body_from_right = self.lens(sensors[1])
        if size != right_size:
            raise InputError(f"{sensors[1]}: resolution {right_size}, that of cam0 is {size}")
        self.cameras = cameras.stereo_rectified(size, left, right, np.linalg.inv(body_from_right) @ body_from_left)

    @staticmethod
    def lens(path):
        """Returns size, (K, D, model) and the transform body <- camera."""
        content = cameras.load_yaml(path)
        model = cameras.field(content, path, "distortion_model")
        if model not in ("radial-tangential", "radtan", "plumb_bob", "equidistant"):
            raise InputError(f"{path}: distortion_model {model}: expected radial-tangential or equidistant")
        fisheye = model == "equidistant"
        fx, fy, cx, cy = cameras.numbers(content, path, ("intrinsics",), 4)
        width, height = cameras.numbers(content, path, ("resolution",), 2)
        pose = cameras.numbers(content, path, ("T_BS", "data"), 16).reshape(4, 4)
        if not np.allclose(pose[:3, :3] @ pose[:3, :3].T, np.eye(3), atol=1e-3) or np.linalg.det(pose[:3, :3]) < 0:
            raise InputError(f"{path}: T_BS.data: expected a rotation in its first three rows and columns")
        distortion = cameras.numbers(content, path, ("distortion_coefficients",), 4)
        return (int(width), int(height)), (np.array([[fx, 0, cx], [0, fy, cy], [0, 0, 1]]),
                                           distortion if fisheye else np.append(distortion, 0),
                                           "equidistant" if fisheye else "plumb_bob"), pose

    def __iter__(self):
        lists = []
        for camera in ("cam0", "cam1"):
            path = self.base / camera / "data.csv"
            rows = read_rows(path, ",")
            if any(len(row) < 2 or not row[0].strip().isdigit() for row in rows):
                raise InputError(f"{path}: expected rows of timestamp [ns], filename")
            lists.append({int(row[0]): self.base / camera / "data" / row[1].strip() for row in rows})
        for stamp in sorted(set(lists[0]) & set(lists[1])):
            for pair in self.pictures.pair(lists[0][stamp], lists[1][stamp]):
                yield (stamp, *pair)


class KittiOdometry:
    """A sequence of the KITTI odometry data: image_0, image_1, calib.txt, times.txt (Geiger et al., CVPR 2012)."""

    def __init__(self, folder, left_out):
        self.base, self.pictures = Path(folder), Pictures(left_out)
        path = self.base / "calib.txt"
        found = {row[0].rstrip(":"): row[1:] for row in read_rows(path, " ")}
        projections = []
        for name in ("P0", "P1"):
            values = [value for value in found.get(name, []) if value]
            try:
                projections.append(np.array(values, float).reshape(3, 4))
            except ValueError:
                raise InputError(f"{path}: {name}: expected 12 numbers")
        self.files = sorted((self.base / "image_0").glob("*.png"))
        if not self.files:
            raise InputError(f"{self.base}: no image_0/*.png")
        height, width = read_image(self.files[0]).shape
        left, right = projections
        baseline = (left[0, 3] - right[0, 3]) / left[0, 0]
        self.cameras = cameras.rectified(left[:, :3], baseline, (width, height))

    def __iter__(self):
        path = self.base / "times.txt"
        try:
            times = [float(row[0]) for row in read_rows(path, " ")]
        except ValueError:
            times = [float("nan")]
        if not np.isfinite(times).all():
            raise InputError(f"{path}: expected one number of seconds a line")
        if len(times) < len(self.files):
            raise InputError(f"{path}: {len(times)} times for {len(self.files)} images")
        for time, file in zip(times, self.files):
            for pair in self.pictures.pair(file, self.base / "image_1" / file.name):
                yield (round(time * 1e9), *pair)


class Videos:
    """Two video files of synchronised cameras, or one with both images in it, and the calibration files."""

    def __init__(self, paths, calibrations, left_out, skips=(0, 0), rate=None, layout=None, deinterlace=False):
        self.paths, self.skips, self.rate, self.left_out = paths, skips, rate, left_out
        self.layout, self.deinterlace = layout, deinterlace
        self.cameras = tuple(map(from_ros_file, calibrations, ("left", "right")))

    def frames(self, path, skip):
        """Yields time and grey image of each frame of a video after the first `skip`. The image is None if it is broken."""
        video = cv2.VideoCapture(str(path))
        if not video.isOpened():
            raise InputError(f"{path}: no such video, or in a format that cannot be decoded")
        rate = self.rate or video.get(cv2.CAP_PROP_FPS)
        if not 0 < rate < 10000:
            raise InputError(f"{path}: has no frame rate: give --rate")
        number = 0
        while video.grab():
            good, picture = video.retrieve()
            if number >= skip:
                grey = cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY) if good else None
                yield (number - skip) / rate, one_field(grey) if good and self.deinterlace else grey
            number += 1
        expected = round(video.get(cv2.CAP_PROP_FRAME_COUNT))
        # The count of the header is an estimate in many formats, made of duration and rate.
        if 0 < number < 0.98 * expected:
            self.left_out.note(f"{path}: ends after {number} images, {expected} by its header: the rest is damaged or missing")

    def checked(self, picture, path, info):
        """Returns the image if it has the size of its calibration."""
        if picture.shape[1::-1] != (info.width, info.height):
            half = f" each half, {self.layout}," if self.layout else ""
            raise InputError(f"{path}:{half} {picture.shape[1]}x{picture.shape[0]} pixels, its calibration is for "
                             f"{info.width}x{info.height}")
        return picture

    def pairs(self):
        """Yields time and both images, with None for those that are broken."""
        if not self.layout:
            for (seconds, left), (_, right) in zip(*(self.frames(*view) for view in zip(self.paths, self.skips))):
                yield seconds, (left, right)
            return
        for seconds, picture in self.frames(self.paths[0], self.skips[0]):
            yield seconds, (None, None) if picture is None else halves(picture, self.layout, self.paths[0])

    def __iter__(self):
        for number, (seconds, pictures) in enumerate(self.pairs()):
            broken = [path for path, picture in zip(self.paths, pictures) if picture is None]
            if broken:
                self.left_out.add(f"{broken[0]}: image {number} after those skipped cannot be decoded")
                continue
            yield (round(seconds * 1e9), *map(self.checked, pictures, self.paths, self.cameras))
