"""Calibrates a stereo rig: finds the corners, then fits both lenses and the pose between the cameras at once."""

import contextlib
import io
from collections import namedtuple

import cv2
import numpy as np
from camera_calibration.calibrator import ChessboardInfo, StereoCalibrator

from .errors import InputError

MIN_VIEWS = 8
# A view is left out when its reprojection error is this many times the median, and above a pixel: the board was
# mistaken, or it moved between the exposures.
OUTLIER_FACTOR, OUTLIER_PX = 4, 1.0

# name; corners of the left and right image, (n, 1, 2), in pixels, in the same order; the board.
View = namedtuple("View", "name left right board")


class RigCalibrator(StereoCalibrator):
    """camera_calibration's stereo calibration, refined.

    It fits each lens alone, then the pose between the cameras with the lenses held, in one iteration. But the board has
    one pose for both cameras: fitting everything at once, from that start, uses it, and determines the principal points
    and the baseline several times better.
    """

    def cal_fromcorners(self, good):
        with contextlib.redirect_stdout(io.StringIO()):
            super().cal_fromcorners(good)
        left, right, _, _, boards = zip(*good)
        result = cv2.stereoCalibrateExtended(
            self.mk_object_points(boards, True), left, right, self.l.intrinsics, self.l.distortion, self.r.intrinsics,
            self.r.distortion, self.size, self.R, self.T, flags=self.calib_flags | cv2.CALIB_USE_INTRINSIC_GUESS,
            criteria=(cv2.TERM_CRITERIA_EPS + cv2.TERM_CRITERIA_MAX_ITER, 200, 1e-9))
        self.l.intrinsics, self.l.distortion, self.r.intrinsics, self.r.distortion, self.R, self.T = result[1:7]
        self.view_errors = result[-1]  # (views, 2): rms reprojection error left and right, px
        self.set_alpha(0.0)

    def focal_length_stddevs(self, views):
        """Standard deviation of the horizontal focal length of the left and right lens, as a share of it.

        Of each lens alone, so an upper bound. Boards all parallel to the image leave it open: a longer lens farther away.
        """
        boards = self.mk_object_points([view.board for view in views], True)
        shares = []
        for camera, corners in ((self.l, [view.left for view in views]), (self.r, [view.right for view in views])):
            _, K, _, _, _, stddevs, _, _ = cv2.calibrateCameraExtended(
                boards, corners, self.size, camera.intrinsics.copy(), camera.distortion.copy(),
                flags=self.calib_flags | cv2.CALIB_USE_INTRINSIC_GUESS)
            shares.append(float(stddevs[0, 0] / K[0, 0]))
        return shares

    @property
    def baseline(self):
        """Returns the distance of the cameras in metres."""
        return float(np.linalg.norm(self.T))


def make_calibrator(columns, rows, square, coefficients):
    """Makes a calibrator for columns x rows inner corners, squares of a side in metres, and 2 or 3 radial coefficients."""
    # No fast check: it gives up on boards that fill a small part of a small image.
    return RigCalibrator([ChessboardInfo("chessboard", columns, rows, square)],
                         flags=cv2.CALIB_FIX_K3 if coefficients == 2 else 0, checkerboard_flags=0)


def in_order_of(reference, corners, board):
    """The corners counted from the end of the board from which the reference counts them.

    A chessboard looks the same turned by 180° (a square one by 90°), and each image is searched on its own. The cameras
    of a pair are nearly parallel, so the right order is the one that gives the most similar image.
    """
    grid = corners.reshape(board.n_rows, board.n_cols, 2)
    turns = range(4) if board.n_rows == board.n_cols else (0, 2)
    candidates = [np.rot90(grid, turn).reshape(corners.shape) for turn in turns]
    shape = reference - reference.mean(axis=0)
    best = min(candidates, key=lambda candidate: np.sum((candidate - candidate.mean(axis=0) - shape) ** 2))
    return np.ascontiguousarray(best)


def corners_like(calibrator, view, left_image, right_image):
    """Returns the corners of another pair (left, right) in the view's order, or None if a camera does not see the whole board."""
    found = []
    for image, reference in ((left_image, view.left), (right_image, view.right)):
        corners = calibrator.downsample_and_detect(image)[1]
        if corners is None:
            return None
        found.append(in_order_of(reference, corners, view.board))
    return tuple(found)


def find_views(calibrator, pairs):
    """Returns the views in which both cameras see the whole board, and the names of the others. Notes the image size."""
    views, others = [], []
    for name, left_image, right_image in pairs:
        calibrator.size = calibrator.l.size = calibrator.r.size = left_image.shape[::-1]
        _, left, _, _, board, _ = calibrator.downsample_and_detect(left_image)
        right = calibrator.downsample_and_detect(right_image)[1] if left is not None else None
        if right is None:
            others.append(name)
        else:
            views.append(View(name, left, in_order_of(left, right, board), board))
    return views, others


def calibrate(calibrator, views):
    """Calibrates; returns the views used and the names of those that did not fit the others."""
    require_views(views)
    fit(calibrator, views)
    errors = calibrator.view_errors.max(axis=1)
    limit = max(OUTLIER_PX, OUTLIER_FACTOR * np.median(errors))
    if np.all(errors <= limit):
        return views, []
    kept = [view for view, error in zip(views, errors) if error <= limit]
    require_views(kept)
    fit(calibrator, kept)
    return kept, [view.name for view, error in zip(views, errors) if error > limit]


def require_views(views):
    if len(views) < MIN_VIEWS:
        raise InputError(f"only {len(views)} views show the whole board in both images and fit together, "
                         f"{MIN_VIEWS} are needed, 20 to 40 are good")


def fit(calibrator, views):
    try:
        calibrator.cal_fromcorners([(view.left, view.right, None, None, view.board) for view in views])
    except cv2.error as error:
        raise InputError(f"the views do not determine a calibration: show the board tilted, in different ways ({error.err})")
    across, down, forward = calibrator.T.ravel()
    if abs(forward) > max(abs(across), abs(down)):
        raise InputError("the result has one camera in front of the other: show the board tilted, in different ways")
    if abs(down) > abs(across):
        raise InputError("the cameras stand one above the other; they must stand side by side")
    if across > 0:
        raise InputError("the left camera stands right of the right one: left and right images are swapped")


def yaml_texts(calibrator):
    """Returns {"left": text, "right": text} of the calibration files."""
    return {name: calibrator.lryaml(name, camera.distortion, camera.intrinsics, camera.R, camera.P, calibrator.size,
                                    calibrator.camera_model)
            for name, camera in (("left", calibrator.l), ("right", calibrator.r))}
