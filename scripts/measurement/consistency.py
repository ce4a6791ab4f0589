"""Section `consistency`: whether errors are as large as the claimed standard deviations say."""

import math

import numpy as np

from . import kept
from .campaign import fly, number
from .markdown import DASH, table
from .programs import ROOT, save_figure

SIGMAS_95 = 1.959964
NOISE, HEIGHTS = (1, 2, 5), (3, 10, 30)
# name, unit, the flag that must be set for the value to be used
QUANTITIES = (("height", "m", "height_valid"), ("approach_angle", "deg", "angle_valid"), ("pitch", "deg", "height_valid"),
              ("roll", "deg", "height_valid"), ("y", "m", "height_valid"), ("speed", "m_s", "height_valid"))
TITLES = {"height": "height", "approach_angle": "approach angle", "pitch": "pitch", "roll": "roll", "y": "lateral", "speed": "speed"}
OVER_FLAT = ("approach_angle", "pitch", "roll", "speed")
IMAGE = ROOT / "docs/images/consistency.png"
TEXT = """{count} snippets for each noise and height, drawn like the approaches above. A snippet has {frames} frames at 20 Hz, and only its last frame
counts: samples are independent. Every snippet has another scene and path, and other errors of calibration, drawn from what the estimator
expects:

- the rotation of the right camera and the baseline (`disparity_bias_stddev`, `height_model_error`),
- rows of the right image that lie `row_bias_stddev` (0.03 px, 1 σ) too low,
- rows that are inclined: as much again at 0.3 focal lengths from the middle, as a lens's calibration leaves them.

Each cell has three numbers. The first is the share of the errors within the claimed 95 % interval. Its own 95 % confidence interval
(Wilson) stands in brackets. The last is the ratio of errors to claimed standard deviations, root mean square. It is 1 when the claim is
true, and less when it is too cautious. Counted are valid frames; *n* is their number for the columns that follow.

**Ground.** The height is that over ground that bends as much and as often as the estimator is told to expect. Of 100 snippets 60 are
flat. The others have one vertical curve of 100 m. It changes the slope by 1/16, 1/4, 1 or 2 times `slope_change_deg` (1 σ), for ten
snippets each. It lies somewhere from 100 m behind the aircraft to 300 m ahead. The other quantities are over flat ground: where it bends, the surface ahead has no one
direction. One column shows the height there. It must be too cautious: from 30 m most of its claim is for a bend between the ground seen
and the ground below.

**What stands out**
- Roll is claimed a little too cautiously at 10 m. Most of what pairs of a second share is what rows may be off by; a pixel is up to 8° of
  roll. The row of a single match claims 0.04 px at best, and the simulator's lenses show half of that. With half of it, heights of the
  cars' recordings, made through real lenses, were less often within their claims.
- Under noise of 5 grey levels roll and speed from 3 m and pitch from 10 m claim an eighth to a fifth too little.
- Height from 30 m under little noise is wrong by what bends more than expected.
- Lateral from 10 m under little noise has its ratio from one snippet of 372, which is 1.25 m off, 17 times its claim.
- Where the aircraft has been seen for 0.6 s only, most of the angle's claim at 30 m is for a gust that may just have begun.

![Share of errors within the claimed interval, and ratio of errors to the claim](images/consistency.png)

"""


def wilson(good, count):
    """Returns the 95 % confidence interval of a share (Wilson 1927)."""
    z2 = SIGMAS_95 ** 2
    share = good / count
    middle = (share + z2 / (2 * count)) / (1 + z2 / count)
    half = SIGMAS_95 * math.sqrt(share * (1 - share) / count + z2 / (4 * count * count)) / (1 + z2 / count)
    return middle - half, middle + half


def score(rows, name, unit, flag):
    """Returns count, share within 95 %, its interval, and root mean square of error over claim, or None if nothing is valid."""
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


def cells(rows, quantities):
    """Returns the scores of the quantities by height and noise."""
    found = {}
    for height in HEIGHTS:
        for noise in NOISE:
            inside = [row for row in rows if float(row["cell_height_m"]) == height and float(row["noise"]) == noise]
            found[height, noise] = {name: score(inside, name, unit, flag) for name, unit, flag in quantities}
    return found


def flights(options):
    """Returns rows over ground that bends and over flat ground. Rows of the first that happen not to bend are flat."""
    cell = ("--noise", *NOISE, "--heights", *HEIGHTS)
    bent = fly("snippets", 1, options.snippets, 10, options.jobs, "--bend", *cell)
    flat = [row for row in bent if float(row["slope_change_deg"]) == 0]
    fewest = min(sum(float(row["cell_height_m"]) == height for row in flat) // len(NOISE) for height in HEIGHTS)
    more = fly("snippets", options.snippets + 1, options.snippets - fewest, 10, options.jobs, *cell)
    return bent, flat + more


def measure(options):
    bent, flat = flights(options)
    heights = cells(bent, QUANTITIES[:1])
    kept.keep("consistency", {
        "count": options.snippets, "frames": 1 + max(int(row["frame"]) for row in flat),
        "cells": [{"height": height, "noise": noise, "flat_height": scores["height"],
                   "quantities": {**scores, **heights[height, noise]}}
                  for (height, noise), scores in cells(flat, QUANTITIES).items()]})


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
    figure, axes = plt.subplots(2, len(QUANTITIES), figsize=(17, 5.5), sharex=True, sharey="row")
    labels = [f"{cell['height']} m, {cell['noise']}" for cell in cells]
    for column, (name, _, _) in enumerate(QUANTITIES):
        upper, lower = axes[0][column], axes[1][column]
        upper.axhspan(93, 97, color="#cfe8cf")
        upper.axhline(95, color="green", linewidth=0.8)
        lower.axhline(1, color="green", linewidth=0.8)
        for i, cell in enumerate(cells):
            scores = cell["quantities"].get(name)  # an older result may lack it
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
    axes[1][0].yaxis.set_major_locator(FixedLocator((0.2, 0.3, 0.5, 0.6, 0.7, 0.8, 0.9, 1, 1.1, 1.2, 1.5, 2, 5, 10, 50, 100)))
    axes[1][0].yaxis.set_major_formatter(FormatStrFormatter("%g"))
    axes[1][0].yaxis.set_minor_locator(NullLocator())
    axes[1][len(QUANTITIES) // 2].set_xlabel("height, noise in grey levels")
    save_figure(figure, IMAGE)


def render(results):
    plot(results["cells"])
    header = ["height", "noise", "n", TITLES["height"], "n", *(TITLES[name] for name in OVER_FLAT), "height, flat ground", "n",
              TITLES["y"]]
    rows = [[f"{cell['height']} m", cell["noise"], count(cell["quantities"]["height"]), entry(cell["quantities"]["height"]),
             count(cell["flat_height"]), *(entry(cell["quantities"].get(name)) for name in OVER_FLAT), entry(cell["flat_height"]),
             count(cell["quantities"]["y"]), entry(cell["quantities"]["y"])]
            for cell in results["cells"]]
    return TEXT.format(**results) + table(header, rows)
