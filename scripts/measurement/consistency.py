"""Section `consistency`: whether errors are as large as the claimed standard deviations say."""

import math

import numpy as np

from . import kept
from .campaign import fly, number
from .markdown import DASH, table
from .programs import ROOT, save_figure

SIGMAS_95 = 1.959964
NOISE, HEIGHTS = (1, 2, 5), (3, 10, 30)
BENT_NOISE = 2
# name, unit, the flag that must be set for the value to be used
QUANTITIES = (("height", "m", "height_valid"), ("approach_angle", "deg", "angle_valid"), ("pitch", "deg", "height_valid"),
              ("roll", "deg", "height_valid"), ("y", "m", "height_valid"))
TITLES = {"height": "height", "approach_angle": "approach angle", "pitch": "pitch", "roll": "roll", "y": "lateral"}
IMAGE = ROOT / "docs/images/consistency.png"
TEXT = """{count} snippets for each noise and height, of {frames} frames at 20 Hz and drawn like the approaches above, one sample each: the last
frame. Every snippet has another scene, path and another error of calibration, drawn from what the parameters say of it.
The table shows which share of the errors is within the claimed 95 % interval, and in brackets the 95 % confidence interval
(Wilson) of that share; then the ratio of errors to claimed standard deviations, root mean square: 1 when the claim is true,
less when it is too cautious. Counted are the valid ones; *n* is the number of them for height and lateral.

The ground is flat here and the estimator does not know. From 30 m most of the height's claim is for a bend of the surface
between the ground seen and the ground below (`slope_change_deg`), so that the height must be found too cautious; the table
below it has ground that bends. From 10 m on the roll is claimed too cautiously: for what vertical disparities leave open of
the rig's rotation (a third of the claim at 10 m and noise of 1), for the share of a pair's error that the next pairs repeat
(kept as it is at 3 m, where it is largest), and single pairs claim more than their error, too. Claims as small as pairs without
lenses and noise would allow still fit at 10 m, but are 1.17 times too small at 3 m. Where the aircraft has been seen for 0.6 s
only, most of the angle's claim at 30 m is for a gust that may just have begun. A lateral offset is at worst off by 5.7 times
its claim (0.26 m), where of a thin edge line one side is seen from afar only.

![Share of errors within the claimed interval, and ratio of errors to the claim](images/consistency.png)

"""
BENT_TEXT = """
Height where the ground bends, by as much and as often as the estimator is told to expect: flat in 60 of 100 snippets, in 10
each with one vertical curve of 100 m that changes the slope by 1/16, 1/4, 1 and 2 times `slope_change_deg` (1 sigma),
somewhere from 100 m behind the aircraft to 300 m ahead.

"""


def wilson(good, count):
    """95 % confidence interval of a share (Wilson 1927)."""
    z2 = SIGMAS_95 ** 2
    share = good / count
    middle = (share + z2 / (2 * count)) / (1 + z2 / count)
    half = SIGMAS_95 * math.sqrt(share * (1 - share) / count + z2 / (4 * count * count)) / (1 + z2 / count)
    return middle - half, middle + half


def score(rows, name, unit, flag):
    """Count, share within 95 %, its interval, and root mean square of error over claim; None when nothing is valid."""
    used = [row for row in rows if row[flag] == "1"]
    error = np.array([number(row, f"{name}_{unit}") - number(row, f"{name}_true_{unit}") for row in used])
    stddev = np.array([number(row, f"{name}_stddev_{unit}") for row in used])
    known = np.isfinite(error) & np.isfinite(stddev)
    if not np.any(known):
        return None
    ratio = np.abs(error[known]) / stddev[known]
    good = int(np.sum(ratio <= SIGMAS_95))
    return {"count": int(ratio.size), "share": good / ratio.size, "interval": wilson(good, ratio.size),
            "ratio": float(np.sqrt(np.mean(ratio ** 2)))}


def measure(options):
    rows = fly("snippets", options.snippets, 10, options.jobs, "--noise", *NOISE, "--heights", *HEIGHTS)
    frames = 1 + max(int(row["frame"]) for row in rows)
    cells = []
    for height in HEIGHTS:
        for noise in NOISE:
            inside = [row for row in rows if float(row["cell_height_m"]) == height and float(row["noise"]) == noise]
            cells.append({"height": height, "noise": noise,
                          "quantities": {name: score(inside, name, unit, flag) for name, unit, flag in QUANTITIES}})
    kept.keep("consistency", {"count": options.snippets, "frames": frames, "cells": cells, "bent": measure_bent(options)})


def measure_bent(options):
    """Scores of the height alone: pitch, roll and angle are against the surface ahead, which has no one direction then."""
    rows = fly("snippets", options.snippets, 10, options.jobs, "--bend", "--noise", BENT_NOISE, "--heights", *HEIGHTS)
    return [{"height": height, "noise": BENT_NOISE,
             "scores": score([row for row in rows if float(row["cell_height_m"]) == height], *QUANTITIES[0])}
            for height in HEIGHTS]


def entry(scores):
    if scores is None:
        return DASH
    low, high = scores["interval"]
    return f"{100 * scores['share']:.1f} ({100 * low:.1f}–{100 * high:.1f}); {scores['ratio']:.2f}"


def count(scores):
    return DASH if scores is None else scores["count"]


def plot(cells):
    import matplotlib  # only here: it takes longer to load than everything else
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.ticker import FixedLocator, FormatStrFormatter, NullLocator
    figure, axes = plt.subplots(2, len(QUANTITIES), figsize=(15, 5.5), sharex=True, sharey="row")
    labels = [f"{cell['height']} m, {cell['noise']}" for cell in cells]
    for column, (name, _, _) in enumerate(QUANTITIES):
        upper, lower = axes[0][column], axes[1][column]
        upper.axhspan(93, 97, color="#cfe8cf")
        upper.axhline(95, color="green", linewidth=0.8)
        lower.axhline(1, color="green", linewidth=0.8)
        for i, cell in enumerate(cells):
            scores = cell["quantities"][name]
            if scores is None:
                continue
            share, (low, high) = 100 * scores["share"], scores["interval"]
            upper.errorbar(i, share, [[max(share - 100 * low, 0)], [max(100 * high - share, 0)]], fmt="o", color="C0", capsize=3)
            lower.plot(i, scores["ratio"], "o", color="C1")
        upper.set_title(TITLES[name])
        lower.set_xticks(range(len(cells)))
        lower.set_xticklabels(labels, rotation=90, fontsize=8)
    axes[0][0].set_ylabel("within claimed 95 %, %")
    axes[1][0].set_ylabel("rms error / claimed σ")
    axes[1][0].set_yscale("log")  # a single wrong lateral offset is a hundred sigma
    axes[1][0].yaxis.set_major_locator(FixedLocator((0.2, 0.3, 0.5, 0.7, 1, 1.5, 2, 5, 10, 50, 100)))
    axes[1][0].yaxis.set_major_formatter(FormatStrFormatter("%g"))
    axes[1][0].yaxis.set_minor_locator(NullLocator())
    axes[1][len(QUANTITIES) // 2].set_xlabel("height, noise in grey levels")
    save_figure(figure, IMAGE)


def render(results):
    plot(results["cells"])
    header = ["height", "noise", "n", *(TITLES[name] for name, _, _ in QUANTITIES), "n"]
    rows = [[f"{cell['height']} m", cell["noise"], count(cell["quantities"]["height"]),
             *(entry(cell["quantities"][name]) for name, _, _ in QUANTITIES), count(cell["quantities"]["y"])]
            for cell in results["cells"]]
    page = TEXT.format(**results) + table(header, rows)
    if "bent" not in results:  # kept from before they were measured
        return page
    bent = [[f"{cell['height']} m", cell["noise"], count(cell["scores"]), entry(cell["scores"])] for cell in results["bent"]]
    return page + BENT_TEXT + table(["height", "noise", "n", "height in 95 %"], bent)
