"""Draws where in the images the board was, because a calibration extrapolates where no corner is."""

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402 (the backend must be chosen first)

from evaluation.pending_file import pending  # noqa: E402
from .checks import GRID, occupied  # noqa: E402
import numpy as np  # noqa: E402


def draw_coverage(path, calibrator, views):
    """Draws the corners of all views into both images, coloured by the view's reprojection error. Cells without any are red."""
    width, height = calibrator.size
    figure, axes = plt.subplots(1, 2, figsize=(12, 1.2 + 5.6 * height / width), constrained_layout=True)
    for side, axis in enumerate(axes):
        corners = np.concatenate([view[1 + side][:, 0] for view in views])
        errors = np.repeat(calibrator.view_errors[:, side], [len(view[1 + side]) for view in views])
        for row, column in np.argwhere(~occupied(corners, calibrator.size, GRID)):
            axis.add_patch(plt.Rectangle((column * width / GRID[1], row * height / GRID[0]), width / GRID[1],
                                         height / GRID[0], color="#f4c7c3"))
        points = axis.scatter(*corners.T, c=errors, s=9, cmap="viridis", vmin=0, vmax=float(calibrator.view_errors.max()))
        axis.set(xlim=(0, width), ylim=(height, 0), aspect="equal", title=("left", "right")[side])
    figure.suptitle("Corners of the board; red: never any, the lens is extrapolated there")
    figure.colorbar(points, ax=axes, label="reprojection error of the view, px", shrink=0.8)
    with pending(path) as temporary:
        figure.savefig(temporary, dpi=100)
    plt.close(figure)
