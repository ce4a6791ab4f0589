"""Judges how good a calibration is, in numbers and words."""

import numpy as np

GOOD_PX, USABLE_PX = 0.25, 1.0  # rms
GOOD_FOCAL_LENGTH, USABLE_FOCAL_LENGTH = 0.003, 0.02  # one sigma, share of it
GOOD_BASELINE, USABLE_BASELINE = 0.005, 0.02  # share of the measured one
LIKELY_BASELINE = (0.01, 10.0)  # m, between the cameras of an aircraft; the chain has the same (geometry/rig_check.h)
USABLE_EMPTY_PARTS = 4  # of nine
# Default of kalman_height's max_height_error, which is three sigma: heights are valid up to this standard deviation.
VALID_SHARE = 0.05 / 3
GRID = (6, 8)  # rows, columns of cells that make the coverage in per cent
REGIONS = (("upper left", "top", "upper right"), ("middle left", "centre", "middle right"), ("lower left", "bottom", "lower right"))


def verdict(value, good, usable):
    return "good" if value <= good else "usable" if value <= usable else "not good enough"


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


def epipolar_errors(calibrator, views):
    """Returns for each view the rms difference of the rows of the same corner in the two rectified images, px."""
    return [float(calibrator.epipolar_error(calibrator.l.undistort_points(view.left),
                                            calibrator.r.undistort_points(view.right))) for view in views]


def height_for_share(share, disparity_error, baseline, rows_below):
    """Height up to which the height error stays below a share of the height, m.

    Disparity d = f b (n.r) / h, so dh/h = dd/d. A level camera sees the nearest ground at the lower edge, rows_below
    pixels under the principal point, with d = b rows_below / h: dh/h = dd h / (b rows_below). An error that is the same
    all over the image turns the fitted plane instead and leaves the height of a level camera as it is; one that grows
    towards the edge, as errors of the lens and of roll between the cameras do, comes in full.
    """
    return share * baseline * rows_below / disparity_error


def occupied(corners, size, shape):
    """Says which cells of a grid of the given shape over the image hold corners."""
    cells = np.zeros(shape, bool)
    columns, rows = (corners[:, 0] * shape[1] / size[0]).astype(int), (corners[:, 1] * shape[0] / size[1]).astype(int)
    cells[np.clip(rows, 0, shape[0] - 1), np.clip(columns, 0, shape[1] - 1)] = True
    return cells


def coverage(corners, size):
    """Returns the share of the image that holds corners, and the names of the ninths of it that hold none."""
    empty = ~occupied(corners, size, (3, 3))
    return float(occupied(corners, size, GRID).mean()), [REGIONS[i][j] for i, j in np.argwhere(empty)]


def coverage_in_words(empty):
    """Judges the ninths of an image that hold no corners."""
    if not empty:
        return "in all parts of it: good"
    return (f"none in: {', '.join(empty)}, where the lens is a guess: show the board there: "
            + ("usable" if len(empty) <= USABLE_EMPTY_PARTS else "poor"))


class Report:
    """Collects lines for people, and what makes the calibration unusable."""

    def __init__(self):
        self.lines, self.faults = [], []

    def add(self, title, text):
        self.lines.append(f"{title:<19} {text}")

    def judge(self, title, text, value, good, usable):
        words = verdict(value, good, usable)  # "not good enough" also for NaN
        self.add(title, f"{text}: {words}")
        if words == "not good enough":
            self.faults.append(f"{title}: {words}")


def make_report(calibrator, views, measured_baseline=None):
    """Makes the report of a calibration that was made from these views."""
    report = Report()
    left, right = (rms(calibrator.view_errors[:, side]) for side in (0, 1))
    report.judge("reprojection error", f"{left:.3f} px left, {right:.3f} px right (rms)", max(left, right),
                 GOOD_PX, USABLE_PX)
    focal_lengths = [100 * share for share in calibrator.focal_length_stddevs(views)]
    report.judge("focal length", f"known to {focal_lengths[0]:.2f} % left, {focal_lengths[1]:.2f} % right (one sigma); "
                 "tilted boards determine it", max(focal_lengths) / 100, GOOD_FOCAL_LENGTH, USABLE_FOCAL_LENGTH)
    errors = epipolar_errors(calibrator, views)
    worst = int(np.argmax(errors))
    epipolar = rms(errors)
    report.judge("epipolar error", f"{epipolar:.3f} px (rms), {errors[worst]:.3f} px in the worst view, "
                 f"{views[worst].name}", epipolar, GOOD_PX, USABLE_PX)
    add_baseline(report, calibrator.baseline, measured_baseline)
    for side in ("left", "right"):
        share, empty = coverage(np.concatenate([getattr(view, side) for view in views])[:, 0], calibrator.size)
        report.add("coverage", f"corners in {100 * share:.0f} % of the {side} image, " + coverage_in_words(empty))
    add_height(report, epipolar, calibrator)
    return report


def add_baseline(report, baseline, measured):
    if not LIKELY_BASELINE[0] <= baseline <= LIKELY_BASELINE[1]:
        report.add("warning", f"baseline {baseline:.4g} m: is --square the side of one square in metres?")
    if measured is None:
        report.add("baseline", f"{baseline:.4f} m. Compare: a wrong --square is wrong in every height by as many per cent")
        return
    off = baseline / measured - 1
    report.judge("baseline", f"{baseline:.4f} m, {abs(off) * 100:.2f} % {'more' if off > 0 else 'less'} than the measured "
                 f"{measured:g} m; heights differ by as many per cent", abs(off), GOOD_BASELINE, USABLE_BASELINE)


def add_height(report, disparity_error, calibrator):
    projection = calibrator.r.P
    rows_below = calibrator.size[1] - projection[1, 2]
    one, valid = (height_for_share(share, disparity_error, calibrator.baseline, rows_below)
                  for share in (0.01, VALID_SHARE))
    report.add("height", f"good to 1 % up to {one:.1f} m, and to the {100 * VALID_SHARE:.1f} % (one sigma) up to which "
               f"estimates are valid by default up to {valid:.1f} m; the error grows with the square of the height.")
    report.add("", f"Assumed: disparities at the lower edge of the image of a level camera are off by the epipolar error, "
               f"{disparity_error:.3f} px; noise of the matching averages out")
