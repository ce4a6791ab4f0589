"""Decodes the images of messages, cuts them in two, and removes the second field of interlaced video."""

import os
import re
import sys
from contextlib import contextmanager

import cv2
import numpy as np
from sensor_msgs.msg import Image

from .errors import BrokenPicture, InputError

SIDE_BY_SIDE, TOP_AND_BOTTOM = "side-by-side", "top-and-bottom"
LAYOUTS = (SIDE_BY_SIDE, TOP_AND_BOTTOM)
YUV = ("yuv422", "uyvy", "yuv422_yuy2", "yuyv")
JPEG_END, JPEG_SCAN, PROGRESSIVE = b"\xff\xd9", b"\xff\xda", b"\xff\xc2"  # markers


@contextmanager
def without_stderr():
    """Keeps the output of C libraries off the terminal."""
    sys.stderr.flush()
    kept = os.dup(2)
    with open(os.devnull, "w") as nothing:
        os.dup2(nothing.fileno(), 2)
    try:
        yield
    finally:
        os.dup2(kept, 2)
        os.close(kept)


def decoded_without_end(data, flags):
    """Pixels of a JPEG file without its end marker, as some cameras send it; nothing where more than that is missing.

    libjpeg fills what is missing with grey and says so on stderr alone. But where it still waits for data, it takes any more that come
    for some, and the pixels are others: after the last block it skips them. A cut within the last block may pass.
    """
    if PROGRESSIVE in data or data.count(JPEG_SCAN) != 1:
        return None  # further scans may be missing
    if data.endswith(b"\0"):  # what buffers are filled up with; one may be of the image
        data = data.rstrip(b"\0") + b"\0"
    some = 1024 * b"\x55"  # for several blocks, as the first ones may lie outside the image
    more = b"\0" + some + b"".join(bytes([0xff, restart]) + some for restart in range(0xd0, 0xd8))
    with without_stderr():
        pixels, others = (cv2.imdecode(np.frombuffer(data + rest + JPEG_END, np.uint8), flags) for rest in (b"", more))
    return pixels if pixels is not None and np.array_equal(pixels, others) else None


def decoded(data, flags):
    """Returns the pixels of an image file, or None if it cannot be decoded or is cut. Decoders themselves report no cut."""
    if data.startswith(b"\xff\xd8") and data.rfind(JPEG_END) <= data.rfind(JPEG_SCAN):
        return decoded_without_end(data, flags)
    if not data or data.startswith(b"\x89PNG") and b"IEND" not in data[-64:]:
        return None
    return cv2.imdecode(np.frombuffer(data, np.uint8), flags)


def encoding_of(pixels, compressed_format):
    """Returns the encoding of pixels, or None if they are no image. Only the format text tells a Bayer mosaic from grey."""
    bits = {np.dtype(np.uint8): "8", np.dtype(np.uint16): "16"}.get(pixels.dtype)
    channels = 1 if pixels.ndim == 2 else pixels.shape[2]
    name = {1: "mono", 3: "bgr", 4: "bgra"}.get(channels)
    if not bits or not name:
        return None
    mosaic = re.match(rf"(bayer_[rgb]{{4}}){bits}\s*;", compressed_format)
    return (mosaic.group(1) if mosaic and channels == 1 else name) + bits


def to_image(message, topic):
    """Returns a raw image. OpenCV decodes a compressed one, with the bits and channels that it has."""
    if message._type == "sensor_msgs/Image":
        return message
    data = bytes(message.data)
    # What the transport plugin puts before the image (compressedDepth) or another codec (theora) is no image file.
    pixels = decoded(data, cv2.IMREAD_UNCHANGED)
    encoding = None if pixels is None else encoding_of(pixels, message.format)
    if encoding is None:
        raise BrokenPicture(f"{topic}: an image with format '{message.format}' at {message.header.stamp.to_sec():.6f} s "
                            "cannot be decoded to grey or colour of 8 or 16 bits")
    image = Image(header=message.header, height=pixels.shape[0], width=pixels.shape[1], encoding=encoding,
                  step=pixels.strides[0])
    image.data = pixels.tobytes()
    return image


def rows_of(image, topic):
    """Returns the pixels of a raw image: (rows, columns, bytes of a pixel)."""
    known = re.fullmatch(r"(mono|rgb|bgr|rgba|bgra|bayer_[a-z]{4}|)(8|16)(?:[US]C([1-4]))?", image.encoding)
    channels = {"rgb": 3, "bgr": 3, "rgba": 4, "bgra": 4}.get(known[1], int(known[3] or 1)) if known else 0
    size = 2 if image.encoding in YUV else channels * (2 if known and known[2] == "16" else 1)
    if not size:
        raise InputError(f"{topic}: encoding {image.encoding}: cannot be cut in two or deinterlaced")
    if image.step < image.width * size or len(image.data) < image.step * image.height:
        raise BrokenPicture(f"{topic}: an image at {image.header.stamp.to_sec():.6f} s has {len(image.data)} bytes, expected "
                            f"{max(image.step, image.width * size) * image.height}")
    rows = np.frombuffer(image.data, np.uint8)[:image.step * image.height].reshape(image.height, image.step)
    return rows[:, :image.width * size].reshape(image.height, image.width, size)


def image_of(pixels, like):
    """Makes a raw image of pixels as rows_of() returns them."""
    pixels = np.ascontiguousarray(pixels)
    image = Image(header=like.header, height=pixels.shape[0], width=pixels.shape[1], encoding=like.encoding,
                  is_bigendian=like.is_bigendian, step=pixels.shape[1] * pixels.shape[2])
    image.data = pixels.tobytes()
    return image


def halves(pixels, layout, where):
    """Cuts an image that holds those of both cameras; the left or upper half comes first."""
    axis = 1 if layout == SIDE_BY_SIDE else 0
    if pixels.shape[axis] % 2:
        raise InputError(f"{where}: an image of {pixels.shape[1]}x{pixels.shape[0]} pixels cannot be cut in two, {layout}")
    return np.split(pixels, 2, axis)


def raw_halves(image, layout, topic):
    """Cuts a raw image by halves() into raw images. The second half has to begin where the colours of its encoding begin."""
    pixels = rows_of(image, topic)
    along = pixels.shape[1] if layout == SIDE_BY_SIDE else pixels.shape[0]
    pairs_of_pixels = image.encoding.startswith("bayer") or image.encoding in YUV and layout == SIDE_BY_SIDE
    if pairs_of_pixels and along % 4:
        raise InputError(f"{topic}: an image of {pixels.shape[1]}x{pixels.shape[0]} pixels {image.encoding} cannot be cut in two, "
                         f"{layout}: {along} is no multiple of 4, and the right colours would be lost")
    return [image_of(part, image) for part in halves(pixels, layout, topic)]


def one_field(pixels):
    """Keeps the upper field of interlaced video and fills the rows between with means, so that the image keeps its size."""
    field = pixels[::2]
    between = ((field[:-1].astype(np.uint32) + field[1:]) // 2).astype(pixels.dtype)
    result = pixels.copy()
    result[::2] = field
    result[1:2 * len(between):2] = between
    if len(pixels) % 2 == 0:
        result[-1] = field[-1]
    return result


def deinterlaced(image, topic):
    """Applies one_field() to a raw image."""
    if image.encoding.startswith("bayer"):
        raise InputError(f"{topic}: encoding {image.encoding}: only images with the same colours in all rows are deinterlaced")
    pixels = rows_of(image, topic)
    if "16" in image.encoding:
        pixels = pixels.view(">u2" if image.is_bigendian else "<u2")
    return image_of(one_field(pixels).view(np.uint8), image)
