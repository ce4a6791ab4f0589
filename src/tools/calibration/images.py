"""Pairs of calibration images, from a folder or from a tar archive."""

import re
import tarfile
from pathlib import Path

import cv2
import numpy as np

from .errors import InputError

# left/000001.png, or left-0001.png as in the archives of camera_calibration: side and name of the view.
IMAGE_FILE = re.compile(r"(?:^|/)(left|right)(?:[-_/]|(?=\d))([^/]+)\.(?:png|pgm|jpg)$")


class Image:
    """One encoded image: where it comes from, for messages, and a function that reads its bytes."""

    def __init__(self, source, read):
        self.source, self.read = source, read

    def decode(self):
        """Grey image (rows, columns), uint8."""
        data = self.read()
        pixels = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_GRAYSCALE) if data else None
        if pixels is None:
            raise InputError(f"{self.source}: not an image, or damaged")
        return pixels


def list_images(path):
    """{"left": {view name: Image}, "right": ...} of a folder or an archive."""
    path = Path(path)
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
    """Image files of an archive in one pass: going back in a compressed one would unpack it again each time."""
    try:
        with tarfile.open(str(path)) as archive:
            contents = [(member.name, archive.extractfile(member).read()) for member in archive
                        if member.isfile() and IMAGE_FILE.search(member.name)]
    except (tarfile.TarError, EOFError, OSError) as error:
        raise InputError(f"{path}: neither a folder nor a tar archive that can be read ({error})")
    return [(name, f"{path}: {name}", lambda data=data: data) for name, data in contents]


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
    """Names of views that only one camera has."""
    return sorted(set(images["left"]) ^ set(images["right"]))
