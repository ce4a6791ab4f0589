"""Section `sensors`: whether errors are as large as the claims say with rolling shutters, vibration and an inertial sensor."""

from . import consistency, kept
from .campaign import fly
from .markdown import table

# What is drawn: title, options of simulate_campaign.
SENSORS = (("rolling shutter", ("--rolling-shutter",)),
           ("rolling shutter, vibration", ("--rolling-shutter", "--vibration")),
           ("the same with an inertial sensor", ("--rolling-shutter", "--vibration", "--imu")))
NOISE, HEIGHTS = 2, consistency.HEIGHTS
NAMES = ("height", *consistency.OVER_FLAT)
TEXT = """{count} snippets for each row, drawn like those above, with noise of {noise} grey levels and over flat ground. They have a rolling shutter
of 5 to 40 ms, a fifth of them from bottom to top. The stamp is that of the middle row or of one at an edge (`--rolling-shutter`). With
`--vibration` the rig is shaken at 15 to 120 Hz by up to 0.2°, less when it is faster. The chain is told the readout time. *Valid* is the
share of snippets with a valid height, and with a valid angle. The other columns are those of [true uncertainty](#true-uncertainty).

A snippet is over after 0.6 s, so these are the first pairs of a flight that shakes. Weak vibration is not found yet, nor is one of less than
a third of a cycle in a readout. Angles claim too little then.

"""


def score(rows):
    """Scores the snippets of one height."""
    valid = [sum(row[flag] == "1" for row in rows) / len(rows) for flag in ("height_valid", "angle_valid")]
    return {"valid": valid, **{name: consistency.score(rows, name, unit, flag)
                               for name, unit, flag in consistency.QUANTITIES if name in NAMES}}


def measure(options):
    rows = []
    for title, drawn in SENSORS:
        flown = fly("snippets", 1, options.sensor_snippets, 10, options.jobs, *drawn, "--noise", NOISE, "--heights", *HEIGHTS)
        rows += [[title, height, score([row for row in flown if float(row["cell_height_m"]) == height])] for height in HEIGHTS]
    kept.keep("sensors", {"count": options.sensor_snippets, "rows": rows})


def render(results):
    header = ("drawn", "height", "valid: height", "valid: angle", *(consistency.TITLES[name] for name in NAMES))
    rows = [[title, f"{height} m", *(f"{valid:.0%}" for valid in scores["valid"]),
             *(consistency.entry(scores[name]) for name in NAMES)] for title, height, scores in results["rows"]]
    return TEXT.format(count=results["count"], noise=NOISE) + table(header, rows)
