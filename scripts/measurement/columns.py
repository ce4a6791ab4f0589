"""Says what the columns of estimates are, those of process_bag --csv and of simulate_campaign --csv."""

import math

KEYS = (("stamp_s",), ("seed", "cell_height_m", "noise", "frame"))
TIMING = {"compute_ms"}
FLAGS = ("valid", "height_valid", "angle_valid")
VERDICTS = {*FLAGS, "status", "reason", "protection_source", "failed_tests", "yaw_known", "yaw_reason",
            "height_above_runway_known", "height_origin", "runway_reason"}
# What the simulator drew for a campaign's row, besides the columns with "_true_" in their names.
DRAWN = {"time_s", "stretch", "bend_rx_deg", "bend_ry_deg", "bend_rz_deg", "lens_rows_px", "lens_tilt_deg",
         "slope_change_deg", "readout_time_s", "vibration_hz", "vibration_deg", "chart", "runway_length_m"}
UNITS = ("_m_s", "_m", "_deg", "_px", "_s", "_probability")


def key_columns(header):
    """Returns the columns that name a row, or none when the table is of another kind."""
    return next((keys for keys in KEYS if set(keys) <= set(header)), ())


def is_truth(column, header):
    """Says whether the simulator made the column. The runway's width is drawn in a campaign and estimated elsewhere."""
    campaign = "seed" in header
    return "_true_" in column or campaign and (column in DRAWN or column == "runway_width_m")


def compared(header):
    """Returns the columns by which estimates are judged, in the file's order."""
    left_out = {*key_columns(header), *TIMING}
    return [column for column in header if column not in left_out and not is_truth(column, header)]


def is_claim(column):
    """Says whether the column tells how uncertain another one is."""
    return "_stddev" in column or column in (
        "height_protection_level_m", "height_alert_limit_m", "height_above_runway_protection_level_m",
        "height_above_runway_limit_m", "y_protection_level_m")


def unit_of(column):
    return next((unit for unit in UNITS if column.endswith(unit)), "")


def stddev_column(column, header):
    """Returns the column with the claimed standard deviation of this one, or None."""
    unit = unit_of(column)
    name = f"{column[:-len(unit)]}_stddev{unit}" if unit else None
    return name if name in header else None


def number(text):
    """Returns the field as a number, or None if it is blank, not finite, or text."""
    try:
        value = float(text)
    except ValueError:
        return None
    return value if math.isfinite(value) else None
