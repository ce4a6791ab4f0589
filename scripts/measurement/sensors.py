"""Section `sensors`: rolling shutters, vibration and an inertial sensor: two scenes, and claims over random snippets."""

import numpy as np

from . import consistency, kept, sets
from .campaign import fly
from .indicator_summary import QUANTITIES
from .markdown import number as cell
from .markdown import table
from .programs import ROOT, WORK, run
from evaluation.scores import SETTLING_TIME, score_quantity  # programs.py has put them in the path
from evaluation.tables import join, read_estimates, read_truth

# By the scene: what is told, and the parameters that tell it.
SCENES = {"rolling_shutter": (("the readout time", "rig: {readout_time: 0.03}"),
                              ("nothing", "{}")),
          "vibration": (("the readout time, with an inertial sensor", "rig: {readout_time: 0.02}"),
                        ("the readout time", "{rig: {readout_time: 0.02}, approach_angle: {use_imu: false}}"),
                        ("nothing", "{}"))}
FLIGHT_HEADER = ("scene", "told", "height valid", "error, %: 95 %", "in 95 %", "angle valid", "error, °: mean", "95 %", "in 95 %")
FLIGHT_TEXT = """### Two scenes
Whole approaches of `config/simulator/scenes`, later than 1 s after the first frame. `rolling_shutter` reads its rows within 30 ms in bumpy air.
`vibration` has 20 ms, and shakes by 0.1° at 45 Hz. Its gyroscope has 400 Hz.

"""

# What is drawn: title, options of simulate_campaign.
SENSORS = (("rolling shutter", ("--rolling-shutter",)),
           ("rolling shutter, vibration", ("--rolling-shutter", "--vibration")),
           ("the same with an inertial sensor", ("--rolling-shutter", "--vibration", "--imu")))
NOISE, HEIGHTS = 2, consistency.HEIGHTS
NAMES = ("height", *consistency.OVER_FLAT)
TEXT = """
### Random snippets
{count} snippets for each row, drawn like those above, with noise of {noise} grey levels and over flat ground. They have a rolling shutter
of 5 to 40 ms, a fifth of them from bottom to top. The stamp is that of the middle row or of one at an edge (`--rolling-shutter`). With
`--vibration` the rig is shaken at 15 to 120 Hz by up to 0.2°, less when it is faster. The chain is told the readout time. *Valid* is the
share of snippets with a valid height, and with a valid angle. The other columns are those of [true uncertainty](#true-uncertainty).

A snippet is over after 0.6 s, so these are the first pairs of a flight that shakes. Pitch and roll of stereo's plane claim too little
where vibration is not found yet, or is slower than a third of a cycle in a readout. The inertial sensor has eight messages in a cycle of
the vibration, and noise and bias as `imu_rate_stddev_deg` and `imu_rate_bias_deg` say. Below 25 Hz it is slower than 200 Hz, so it is not
used within images.

"""


def score_flight(estimates, truth):
    """Scores a flight by its files. Each quantity counts where its own flag is set: heights do without an angle."""
    known = read_truth(str(truth))
    joined = join(known, read_estimates(str(estimates)))
    scored = joined.stamp > joined.stamp[0] + SETTLING_TIME
    scores = {}
    for name, column, flag, _ in QUANTITIES:
        valid = scored & (joined.estimate(flag) == 1)
        result = score_quantity(known, joined, valid, name, column, column, column.rsplit("_", 1)[1])
        scores[name] = {"valid": float(np.mean(valid[scored])), **(result if isinstance(result, dict) else {})}
    return scores


def flights():
    """Flies the scenes, and returns scene, what was told, and scores."""
    found = []
    config, estimates = WORK / "sensors" / "told.yaml", WORK / "sensors" / "estimates.csv"
    for scene, runs in SCENES.items():
        bag, truth = sets.make_bag(f"sensors/{scene}", ROOT / f"config/simulator/scenes/{scene}.yaml")
        for told, parameters in runs:
            config.write_text(parameters + "\n", encoding="utf-8")
            run("process_bag", "--input", bag, "--config", config, "--csv", estimates)
            found.append([scene, told, score_flight(estimates, truth)])
            print("sensors:", found[-1], flush=True)
        bag.unlink()
    return found


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
    kept.keep("sensors", {"count": options.sensor_snippets, "rows": rows, "flights": flights()})


def flight_row(scene, told, scores):
    height, angle = scores["height"], scores["approach_angle"]
    percent = height.get("percent", {}).get("percentile_95")
    return [f"`{scene}`", told, f"{height['valid']:.1%}", cell(percent, ".2f"), cell(height.get("within_claimed_95"), ".0%"),
            f"{angle['valid']:.1%}", cell(angle.get("mean"), ".3f"), cell(angle.get("percentile_95"), ".3f"),
            cell(angle.get("within_claimed_95"), ".0%")]


def render(results):
    header = ("drawn", "height", "valid: height", "valid: angle", *(consistency.TITLES[name] for name in NAMES))
    rows = [[title, f"{height} m", *(f"{valid:.0%}" for valid in scores["valid"]),
             *(consistency.entry(scores[name]) for name in NAMES)] for title, height, scores in results["rows"]]
    return (FLIGHT_TEXT + table(FLIGHT_HEADER, [flight_row(*flight) for flight in results["flights"]])
            + TEXT.format(count=results["count"], noise=NOISE) + table(header, rows))
