"""Errors on the frames that may be used to fly, coverage, and whether the claimed uncertainty is true."""

import numpy as np

SETTLING_TIME = 1.0  # s after the first frame that are not scored
SIGMAS_95 = 1.959964  # half width of a normal distribution's central 95 %

# name of the score, column of the estimates, column of the truth, unit
QUANTITIES = (
    ("height", "height_m", "height_m", "m"),
    ("raw_height", "raw_height_m", "height_m", "m"),
    ("approach_angle", "approach_angle_deg", "approach_angle_deg", "deg"),
    ("raw_approach_angle", "raw_approach_angle_deg", "approach_angle_deg", "deg"),
    ("pitch", "pitch_deg", "pitch_deg", "deg"),
    ("roll", "roll_deg", "roll_deg", "deg"),
    ("yaw", "yaw_deg", "yaw_deg", "deg"),
    ("x", "x_m", "x_m", "m"),
    ("y", "y_m", "y_m", "m"),
    ("foe_u", "foe_u_px", "foe_u_px", "px"),
    ("foe_v", "foe_v_px", "foe_v_px", "px"),
    ("speed", "speed_m_s", "speed_m_s", "m/s"),
)
CLAIMED = {"height": "height_stddev_m", "approach_angle": "approach_angle_stddev_deg", "x": "x_stddev_m",
           "y": "y_stddev_m", "speed": "speed_stddev_m_s"}


def statistics(error, unit):
    """Returns the statistics of the errors (estimate minus truth) that are not NaN."""
    size = np.abs(error)
    return {"unit": unit, "frames": int(error.size), "mean": float(np.mean(size)), "median": float(np.median(size)),
            "percentile_95": float(np.percentile(size, 95)), "worst": float(np.max(size)),
            "signed_mean": float(np.mean(error))}


def consistency(error, stddev):
    """Returns the share of the frames whose error is within the claimed 95 % interval."""
    known = np.isfinite(error) & np.isfinite(stddev)
    if not np.any(known):
        return None
    return float(np.mean(np.abs(error[known]) <= SIGMAS_95 * stddev[known]))


def score_quantity(truth, joined, used, name, column, truth_column, unit):
    """Returns the scores of one quantity, or the text that says why there are none."""
    if not truth.has(truth_column):
        return f"the truth has no {truth_column}"
    if column not in joined.estimates.text:
        return f"the estimates have no column {column}"
    error = joined.estimate(column) - truth.number(truth_column)
    if unit == "deg":
        error = (error + 180) % 360 - 180
    known = used & np.isfinite(error)
    if not np.any(known):
        return "no scored frame has it"
    scores = statistics(error[known], unit)
    if truth_column == "height_m":
        percent = statistics(100 * (error / truth.number(truth_column))[known], "%")
        scores["percent"] = {key: value for key, value in percent.items() if key not in ("unit", "frames")}
    if name in CLAIMED:
        scores["within_claimed_95"] = consistency(error[known], joined.estimate(CLAIMED[name])[known])
    return scores


def score(truth, joined, invalid_too=False):
    """Returns all scores as a dictionary, ready for JSON. invalid_too: errors of all frames, not of the valid ones only."""
    stamp = joined.stamp
    scored = stamp > stamp[0] + SETTLING_TIME + 1e-6
    valid = scored & (joined.estimate("valid") == 1)
    used = scored if invalid_too else valid
    scores = {
        "frames": int(truth.rows), "frames_without_estimate": int(np.sum(~joined.found)),
        "scored_frames": int(np.sum(scored)), "valid_frames": int(np.sum(valid)),
        "invalid_scored_too": invalid_too, "coverage": float(np.mean(valid[scored])) if np.any(scored) else None,
        "quantities": {}, "missing": {},
    }
    for name, column, truth_column, unit in QUANTITIES:
        result = score_quantity(truth, joined, used, name, column, truth_column, unit)
        scores["missing" if isinstance(result, str) else "quantities"][name] = result
    compute = joined.estimate("compute_ms")
    if np.any(np.isfinite(compute)):
        compute = compute[np.isfinite(compute)]
        scores["compute_ms"] = {"mean": float(np.mean(compute)), "median": float(np.median(compute)),
                                "percentile_99": float(np.percentile(compute, 99)), "worst": float(np.max(compute))}
    return scores


COLUMNS = (("mean", "mean"), ("median", "median"), ("95 %", "percentile_95"), ("worst", "worst"),
           ("signed", "signed_mean"))


def summary(scores):
    """Returns the scores as a table for people."""
    coverage = "unknown" if scores["coverage"] is None else f"{100 * scores['coverage']:.1f} %"
    lines = [f"{scores['frames']} frames, {scores['frames_without_estimate']} without an estimate; "
             f"{scores['scored_frames']} later than {SETTLING_TIME:g} s after the first, "
             f"{scores['valid_frames']} of them valid: coverage {coverage}"
             + ("; errors are those of invalid frames, too" if scores["invalid_scored_too"] else ""),
             f"{'error':<20} {'unit':<5}" + "".join(f"{title:>10}" for title, _ in COLUMNS) + "  within claimed 95 %"]
    for name, values in scores["quantities"].items():
        lines.append(row(name, values["unit"], values, values.get("within_claimed_95")))
        if "percent" in values:
            lines.append(row("", "%", values["percent"], None))
    lines += [f"{name:<20} not scored: {why}" for name, why in scores["missing"].items()]
    if "compute_ms" in scores:
        times = scores["compute_ms"]
        lines.append(f"compute time per pair: mean {times['mean']:.2f} ms, median {times['median']:.2f} ms, "
                     f"99 % {times['percentile_99']:.2f} ms, worst {times['worst']:.2f} ms")
    return "\n".join(lines)


def row(name, unit, values, within):
    numbers = "".join(f"{values[key]:>10.4f}" for _, key in COLUMNS)
    return f"{name:<20} {unit:<5}{numbers}" + ("" if within is None else f"  {100 * within:.1f} %")
