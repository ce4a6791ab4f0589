"""Estimates the readout time of a rolling shutter from consecutive views of a board that moves."""

from collections import namedtuple

import cv2
import numpy as np

MIN_VIEWS = 4
LONGEST_GAP = 0.12  # s between neighbours: a hand moves a board steadily for about so long
GOOD_STDDEV = 0.002  # s; a worse one says nothing of common cameras, whose rows take 5 to 40 ms
LONGEST = 0.1  # s
PARABOLA = 0.015  # share of the time by which a hand's movement differs from a parabola over three pairs at 20 Hz
SIGNIFICANT = 4  # standard deviations

# A view with the pairs before and after it: seconds to them (the first is negative), and their corners as in the view.
Moment = namedtuple("Moment", "view times before after")
Readout = namedtuple("Readout", "time stddev views")


def seen(points, camera):
    """Returns pixels (n, 2) of points (n, 3) in camera axes, their derivatives (n, 2, 3), and those by the lens (2 n, 8 or 9)."""
    zero = np.zeros(3)
    pixels, derivatives = cv2.projectPoints(points, zero, zero, camera.intrinsics, camera.distortion)
    lens = 8 + int(np.ravel(camera.distortion)[4] != 0)  # k3 where it was not held
    return pixels[:, 0], derivatives[:, 3:6].reshape(-1, 2, 3), derivatives[:, 6:6 + lens]


def crosses(points):
    """Returns matrices that make the vector product of each point with another vector."""
    x, y, z = points.T
    zero = np.zeros_like(x)
    return np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=1).reshape(-1, 3, 3)


def movements(points):
    """Returns what turns and shifts do to points (n, 3, 6)."""
    return np.concatenate([-crosses(points), np.broadcast_to(np.eye(3), (len(points), 3, 3))], axis=2)


def residuals(calibrator, points, rotation, translation, corners):
    """Returns how far the corners (left above right) are off a board's pose, and its change with pose and calibration."""
    inside = points @ rotation.T + translation
    turned = inside @ calibrator.R.T + calibrator.T.ravel()
    left, by_left, left_lens = seen(inside, calibrator.l)
    right, by_right, right_lens = seen(turned, calibrator.r)
    by_pose = np.concatenate([by_left, by_right @ calibrator.R]) @ np.tile(movements(inside), (2, 1, 1))
    by_rig = (by_right @ movements(turned - calibrator.T.ravel())).reshape(-1, 6)
    half, zero = len(by_rig), np.zeros
    by_calibration = np.block([[left_lens, zero((half, right_lens.shape[1])), zero((half, 6))],
                               [zero((half, left_lens.shape[1])), right_lens, by_rig]])
    return (corners - np.concatenate([left, right])).ravel(), by_pose.reshape(-1, 6), by_calibration


def fit_pose(calibrator, points, corners):
    """Returns the residuals of the corners from the board's best pose, and their derivatives there (see residuals())."""
    half = len(points)
    _, vector, translation = cv2.solvePnP(points, corners[:half, None], calibrator.l.intrinsics, calibrator.l.distortion)
    rotation, translation = cv2.Rodrigues(vector)[0], translation.ravel()
    for _ in range(6):
        off, by_pose, _ = residuals(calibrator, points, rotation, translation, corners)
        step = np.linalg.lstsq(by_pose, off, rcond=None)[0]
        turn = cv2.Rodrigues(step[:3])[0]
        rotation, translation = turn @ rotation, turn @ translation + step[3:]
    return residuals(calibrator, points, rotation, translation, corners)


def both(left, right):
    return np.concatenate([left[:, 0], right[:, 0]]).astype(float)


def row_times(corners, height):
    """Returns when rows are exposed, as a share of the readout time, after the middle row."""
    return (corners[:, 1] + 0.5) / height - 0.5


def movement(moment, corners, readout, height):
    """Returns each corner's velocity and acceleration, px/s and px/s^2, by the parabola through its three places in time."""
    rows = row_times(corners, height)
    before, after = both(*moment.before), both(*moment.after)
    past = (moment.times[0] + readout * (row_times(before, height) - rows))[:, None]
    future = (moment.times[1] + readout * (row_times(after, height) - rows))[:, None]
    slope_past, slope_future = (before - corners) / past, (after - corners) / future
    bend = (slope_future - slope_past) / (future - past)
    return slope_past - bend * past, 2 * bend


def explain(calibrator, moment, readout):
    """Returns what a longer readout time and another calibration would change in a view beyond its pose, and the rest; px."""
    points = calibrator.mk_object_points([moment.view.board], True)[0].reshape(-1, 3).astype(float)
    corners = both(moment.view.left, moment.view.right)
    height = calibrator.size[1]
    rows = row_times(corners, height)[:, None]
    # A board is stiff: what its corners do is what six numbers can make them do, and the rest is noise.
    basis = np.linalg.qr(fit_pose(calibrator, points, corners)[1])[0]
    velocity, acceleration = ((basis @ (basis.T @ each.ravel())).reshape(-1, 2)
                              for each in movement(moment, corners, readout, height))
    # A corner is where it was at the stamp, and moves on from there until its row is exposed.
    change = rows * (velocity - readout * rows * acceleration)
    at_stamp = corners - readout * rows * velocity + 0.5 * (readout * rows) ** 2 * acceleration
    off, by_pose, by_calibration = fit_pose(calibrator, points, at_stamp)
    change = without(np.column_stack([change.ravel(), by_calibration]), by_pose)
    return change[:, 0], change[:, 1:], off


def without(values, directions):
    """Returns what is left of the columns when these directions are taken out."""
    basis = np.linalg.qr(directions)[0]
    return values - basis @ (basis.T @ values)


def fit_readout(calibrator, moments):
    """Readout time of both cameras, s, from top to bottom, and its standard deviation; None when there are too few views.

    The pose of the board takes up what all rows have in common. So this says nothing of the row that the stamp belongs to. The
    calibration was made of the same views as if all rows were exposed at once, so its numbers are free here.
    The standard deviation takes what is left in a view as one error, as errors of the lens are alike in all its corners.
    """
    if len(moments) < MIN_VIEWS:
        return None
    time = 0.0
    for _ in range(6):
        changes, by_calibration, offs = zip(*(explain(calibrator, moment, time) for moment in moments))
        scale = np.linalg.norm(np.concatenate(by_calibration), axis=0)
        left = without(np.column_stack([np.concatenate(changes), np.concatenate(offs)]), np.concatenate(by_calibration) / scale)
        change, off = left.T
        weight = change @ change
        time += change @ off / weight if weight > 0 else 0.0
        if weight == 0 or abs(time) > LONGEST:
            return Readout(time, np.inf, len(moments))
    ends = np.cumsum([len(each) for each in offs])[:-1]
    views = sum(np.sum(part) ** 2 for part in np.split(change * off, ends)) * len(moments) / (len(moments) - 1)
    corners = off @ off / (len(off) - 6 * len(moments) - len(scale)) * weight
    noise = float(np.sqrt(max(views, corners))) / weight
    return Readout(float(time), float(np.hypot(noise, PARABOLA * time)), len(moments))


def in_words(readout):
    """Says for people what a fit found."""
    if readout is None:
        return ("not known: a bag with at least 4 views, each with the pairs just before and after it, of a board that is moved "
                "would tell")
    milliseconds = f"{1000 * readout.time:.1f} ms, one sigma {1000 * readout.stddev:.1f} ms, of {readout.views} views"
    if not readout.stddev < GOOD_STDDEV:
        spread = f" (one sigma {1000 * readout.stddev:.0f} ms)" if np.isfinite(readout.stddev) else ""
        return f"not known{spread}: move the board faster, up and down and to the sides, in good light"
    if abs(readout.time) < SIGNIFICANT * readout.stddev:
        return f"{milliseconds}: no rolling shutter is seen"
    direction = "top to bottom" if readout.time > 0 else "bottom to top"
    return f"{milliseconds}: rolling shutters, from {direction}. The stamp's row is not told by this"
