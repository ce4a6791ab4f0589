"""Figures beyond the paper's: how errors are distributed, whether the claimed uncertainty is true, and what the estimate
said of itself over time."""

import numpy as np

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402 (the backend must be chosen first)

from evaluation.pending_file import pending  # noqa: E402
from evaluation.scores import SETTLING_TIME, SIGMAS_95  # noqa: E402

# Title, column of estimates and truth, standard deviation, validity, unit in the figure, factor to it.
ERRORS = (("height", "height_m", "height_stddev_m", "height_valid", "cm", 100),
          ("approach angle", "approach_angle_deg", "approach_angle_stddev_deg", "angle_valid", "deg", 1))
STATUSES = ("tracking", "coasting", "searching", "lost")
STATUS_COLOURS = {"tracking": "tab:green", "coasting": "gold", "searching": "0.7", "lost": "tab:red"}


class Missing(Exception):
    """A part of the report cannot be made. The message says why."""


def scored_errors(truth, joined):
    """Returns (title, unit, errors, standard deviations) of the valid frames later than SETTLING_TIME after the first."""
    found = []
    for title, column, stddev, valid, unit, factor in ERRORS:
        if not truth.has(column):
            continue
        usable = joined.estimate(valid if joined.estimates.has(valid) else "valid") == 1
        usable &= joined.stamp > joined.stamp[0] + SETTLING_TIME + 1e-6
        errors = factor * (joined.estimate(column) - truth.number(column))
        usable &= np.isfinite(errors)
        if np.any(usable):
            found.append((title, unit, errors[usable], factor * joined.estimate(stddev)[usable]))
    if not found:
        raise Missing("no valid frame has truth")
    return found


def save(figure, path):
    figure.tight_layout()
    with pending(path) as temporary:
        figure.savefig(temporary, dpi=110)
    plt.close(figure)


def draw_histograms(path, truth, joined, _report_data):
    """Draws the errors on the frames where each quantity is valid by itself."""
    found = scored_errors(truth, joined)
    figure, axes = plt.subplots(1, len(found), figsize=(10, 3.4), squeeze=False)
    for axis, (title, unit, errors, _) in zip(axes[0], found):
        axis.hist(errors, bins=max(10, min(60, len(errors) // 5)), color="tab:blue")
        axis.axvline(0, color="k", linewidth=0.8)
        axis.axvline(np.mean(errors), color="tab:red", linewidth=1.2, label=f"mean {np.mean(errors):.3g} {unit}")
        axis.set_xlabel(f"error of {title}, {unit}")
        axis.set_ylabel("frames")
        axis.legend()
    save(figure, path)


def draw_consistency(path, truth, joined, _report_data):
    """Draws the share of errors within k claimed standard deviations, against that of a normal distribution."""
    found = [(title, errors / stddevs) for title, _, errors, stddevs in scored_errors(truth, joined)
             if np.all(stddevs > 0)]
    if not found:
        raise Missing(f"{joined.estimates.path}: no standard deviations")
    sigmas = np.linspace(0, 4, 81)
    # erf by its integral: numpy has none, and scipy would be one more package.
    fine = np.linspace(0, 4, 4001)
    density = np.sqrt(2 / np.pi) * np.exp(-fine ** 2 / 2)
    normal = np.concatenate([[0], np.cumsum((density[1:] + density[:-1]) / 2 * (fine[1] - fine[0]))])
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 3.8))
    left.plot(fine, normal, "k--", linewidth=1, label="normal distribution")
    for title, normalised in found:
        left.plot(sigmas, [np.mean(np.abs(normalised) <= k) for k in sigmas], label=title)
        right.hist(normalised, bins=np.linspace(-5, 5, 41), density=True, alpha=0.5, label=title)
    left.axvline(SIGMAS_95, color="0.7", linewidth=0.8)
    left.set(xlabel="k", ylabel="share of errors within k claimed sigma", ylim=(0, 1.02))
    right.plot(np.concatenate([-fine[::-1], fine]), np.concatenate([density[::-1], density]) / 2, "k--", linewidth=1)
    right.set(xlabel="error / claimed sigma", ylabel="density")
    for axis in (left, right):
        axis.grid(alpha=0.3)
        axis.legend(fontsize="small")
    save(figure, path)


def spans(flags, time):
    """Returns (start, length) of each run of True, for broken_barh. A frame lasts until the next one."""
    ends = np.append(time[1:], 2 * time[-1] - time[-2] if len(time) > 1 else time[-1] + 1)
    return [(time[i], ends[i] - time[i]) for i in np.flatnonzero(flags)]


def draw_timeline(path, _truth, joined, _report_data):
    """Draws the status, and when height, angle and both were valid, frame by frame."""
    time = joined.stamp - joined.stamp[0]
    rows = [(name.replace("_", " "), joined.estimate(name) == 1)
            for name in ("valid", "angle_valid", "height_valid") if joined.estimates.has(name)]
    figure, axis = plt.subplots(figsize=(10, 0.55 * len(rows) + 1.9))
    names = []
    for height, (name, flags) in enumerate(rows):
        axis.broken_barh(spans(flags, time), (height - 0.3, 0.6), color="tab:blue")
        names.append(f"{name}, {100 * np.mean(flags):.1f} %")
    text = joined.estimates.text.get("status")
    if text:
        status = np.where(joined.found, np.array(text)[joined.row], "no estimate")
        for name in [name for name in STATUSES + ("no estimate",) if np.any(status == name)]:
            axis.broken_barh(spans(status == name, time), (len(rows) - 0.3, 0.6), color=STATUS_COLOURS.get(name, "k"),
                             label=f"{name}, {100 * np.mean(status == name):.1f} %")
        names.append("status")
        axis.legend(loc="upper center", bbox_to_anchor=(0.5, 1.2), ncol=5, fontsize="small", frameon=False)
    axis.set(yticks=range(len(names)), yticklabels=names, xlabel="time, s",
             xlim=(0, max(time[-1], 1e-3)), ylim=(-0.6, len(names) - 0.4))
    save(figure, path)
