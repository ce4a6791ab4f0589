"""Section `yaw`: how often the yaw is known over random scenery, how true its claims are, and how often it is that of another line."""

import math

from . import consistency, kept
from .campaign import fly, number
from .markdown import DASH, table

HEIGHTS, NOISE, FRAMES = (10, 30, 60, 100), 2, 9
WRONG = 1.0  # deg, from which on the direction is that of something else
HEADER = ("height", "snippets", "yaw known", "within claimed 95 %; ratio", "error, °: median", "95 %", "largest", "more than 1° off")
TEXT = """{snippets} snippets like those above, each with scenery of its own. `simulate_campaign snippets --scenery` puts fields with crop rows (in
half of them), towns, rivers, shores, roads, taxiways, crossing runways and the own nose around the runway at random. Noise is 2 grey
levels. One sample is the last of {frames} frames at 20 Hz, so samples are independent.

The yaw is that of the runway, or not known at all. *More than 1° off* counts those that belong to something else. The other columns are of
the known ones.

"""


def errors(rows):
    """Returns error and claimed standard deviation where the yaw is known, deg."""
    pairs = [(abs(math.remainder(number(row, "yaw_deg") - number(row, "yaw_true_deg"), 360)), number(row, "yaw_stddev_deg"))
             for row in rows]
    return sorted((error, stddev) for error, stddev in pairs if math.isfinite(error))


def score(rows):
    """Counts the snippets and scores those with a known yaw. The scores are None where none is known."""
    known = errors(rows)
    scores = {"snippets": len(rows), "known": len(known), "wrong": sum(error > WRONG for error, _ in known), "claims": None}
    if known:
        ratios = [error / stddev for error, stddev in known]
        good = sum(ratio <= consistency.SIGMAS_95 for ratio in ratios)
        scores["claims"] = {"share": good / len(known), "interval": consistency.wilson(good, len(known)),
                            "ratio": math.sqrt(sum(ratio ** 2 for ratio in ratios) / len(ratios))}
        scores["errors"] = [known[len(known) // 2][0], known[min(len(known) - 1, int(0.95 * len(known)))][0], known[-1][0]]
    return scores


def measure(options):
    rows = fly("snippets", 1, options.yaw_snippets, 5, options.jobs, "--scenery", "--noise", NOISE, "--heights", *HEIGHTS,
               "--frames", FRAMES)
    cells = [[f"{height} m", score([row for row in rows if float(row["cell_height_m"]) == height])] for height in HEIGHTS]
    kept.keep("yaw", {"snippets": len(rows), "frames": FRAMES, "cells": [*cells, ["all", score(rows)]]})


def line(name, scores):
    known, wrong = scores["known"], scores["wrong"]
    cells = [name, scores["snippets"], f"{known} ({known / scores['snippets']:.0%})", consistency.entry(scores["claims"])]
    return cells + ([f"{error:.3f}" for error in scores["errors"]] if known else 3 * [DASH]) + [wrong]


def render(results):
    return TEXT.format(**results) + table(HEADER, [line(*cell) for cell in results["cells"]])
