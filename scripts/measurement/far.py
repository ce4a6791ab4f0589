"""Section `far`: approaches from 3 to 5 km before the threshold, with and without the chart's width and length."""

import math

from . import consistency, kept
from .campaign import fly, number
from .markdown import DASH, table

NOISE = 2
FIRST = 301  # seed: below it are those that the estimators were worked on with
NEAREST = (2500, 1500, 750, 300, 100)  # m before the threshold: where bands of distance end
# name, unit, what is said of it, and the error that matters, by the distance
OUTPUTS = (("height_above_runway", "m", "% of it", lambda row: 0.01 * number(row, "height_above_runway_true_m")),
           ("y", "m", "m", lambda row: 1), ("x", "m", "% of the distance", lambda row: 0.01 * abs(number(row, "x_true_m"))))
TITLES = {"height_above_runway": "height above the runway", "y": "y", "x": "x"}
HEADER = ("chart", "distance, km", "frames", *(f"{TITLES[name]}: {what}" for name, _, unit, _ in OUTPUTS
                                               for what in ("given", f"95 %, {unit}", "within claimed 95 %")),
          "height above the runway: known")
TEXT = """{flights} approaches of `simulate_campaign far --chart`, drawn at random, with noise of {noise} grey levels and an exact calibration:

| drawn | range |
|---|---|
| rig | baseline 1 m, 640×480, 10 Hz |
| runway | from 600 × 18 m to 4000 × 60 m; broad ones are mostly long; all or few markings |
| path | from 3 to 5 km before the threshold down to 20 m; glide of 2.5 to 4°, 35 to 75 m/s, up to ±0.5° off the runway's direction |
| air | visibility of 6 to 40 km |
| ground | a quarter has a hill of 3 to 15 m before the threshold |

Each is flown twice: the chain is told the runway's width and length, or nothing. *Given* is the share of frames with a number. The
errors are those of these frames. *Known* is the share where the height above the runway is said to be known: where its protection level,
which holds for a wrong chart, too, is within its limit.

"""


def band_of(row):
    """Returns the nearer end of the band of distance that a row belongs to, m, or None where it is nearer than all."""
    distance = -number(row, "x_true_m")
    return next((nearest for nearest in NEAREST if distance > nearest), None)


def score(rows, name, unit, matters):
    """Returns the share of rows with a value, its 95 % error by what matters, and the share within its claimed 95 %."""
    errors = []
    for row in rows:
        error = abs(number(row, f"{name}_{unit}") - number(row, f"{name}_true_{unit}"))
        if math.isfinite(error):
            errors.append((error / matters(row), error / number(row, f"{name}_stddev_{unit}")))
    if not errors:
        return {"given": 0, "error": None, "claimed": None}
    by_size = sorted(error for error, _ in errors)
    within = sum(ratio <= consistency.SIGMAS_95 for _, ratio in errors) / len(errors)
    return {"given": len(errors) / len(rows), "error": by_size[min(len(errors) - 1, int(0.95 * len(errors)))], "claimed": within}


def band_scores(rows):
    scores = {name: score(rows, name, unit, matters) for name, unit, _, matters in OUTPUTS}
    known = sum(row["height_above_runway_known"] == "1" for row in rows) / len(rows)
    return {"frames": len(rows), "known": known, "outputs": scores}


def measure(options):
    rows = fly("far", FIRST, options.far, 1, options.jobs, "--chart", "--noise", NOISE)
    bands = []
    for chart in ("1", "0"):
        for nearest in NEAREST:
            inside = [row for row in rows if row["chart"] == chart and band_of(row) == nearest]
            if inside:
                bands.append({"chart": chart == "1", "nearest": nearest, **band_scores(inside)})
    kept.keep("far", {"flights": options.far, "bands": bands})


def distance_text(nearest):
    """Names the band of distance that ends here."""
    index = NEAREST.index(nearest)
    return f"beyond {nearest / 1000:g}" if index == 0 else f"{nearest / 1000:g} to {NEAREST[index - 1] / 1000:g}"


def cells_of(scores):
    if scores["error"] is None:
        return ["0%", DASH, DASH]
    return [f"{scores['given']:.0%}", f"{scores['error']:.1f}", f"{scores['claimed']:.0%}"]


def line(band):
    cells = ["given" if band["chart"] else "none", distance_text(band["nearest"]), band["frames"]]
    for name, *_ in OUTPUTS:
        cells += cells_of(band["outputs"][name])
    return [*cells, f"{band['known']:.0%}"]


def render(results):
    return TEXT.format(noise=NOISE, **results) + table(HEADER, [line(band) for band in results["bands"]])
