"""docs/change_indicator.csv: a line for each set and preset that changes only when the estimates do."""

import csv
import hashlib
import io
import math
import os
import platform
import re
import subprocess
from pathlib import Path

import numpy as np

from .columns import VERDICTS, compared, is_claim, key_columns, number, stddev_column
from .programs import ROOT
from evaluation.scores import score, statistics  # programs.py has put them in the path
from evaluation.tables import InputError, join, read_estimates, read_truth

PATH = ROOT / "docs/change_indicator.csv"
COUNTS = ("rows", "valid", "height_valid", "angle_valid")
ERRORS = ("height_mean_cm", "height_95_cm", "height_claim_cm", "angle_mean_deg", "angle_95_deg", "angle_claim_deg")
FINGERPRINTS = ("values", "claims", "verdicts")
HEADER = ("set", "preset", *COUNTS, *ERRORS, *FINGERPRINTS)
# name of the score, column, flag that lets it be used, factor to the summary's unit
QUANTITIES = (("height", "height_m", "height_valid", 100), ("approach_angle", "approach_angle_deg", "angle_valid", 1))
MADE_ON = "# Made by scripts/change_indicator on "
OTHER_MACHINE = 0.01  # errors and claims of another type of machine may differ by this share


def rounded(column, text, row):
    """The field as the fingerprint sees it: to a thousandth of the claimed standard deviation, or to six digits.

    A sum that is added up in another order then keeps the fingerprint, and a change of 1e-5 standard deviations
    changes it where it concerns some hundred rows, as one of them crosses a step.
    """
    value = number(text)
    if column in VERDICTS or value is None:
        return text
    stddev = stddev_column(column, row)
    sigma = number(row[stddev]) if stddev else None
    if sigma:
        exponent = math.floor(math.log10(sigma)) - 3
    elif is_claim(column):
        exponent = math.floor(math.log10(abs(value))) - 5 if value else 0
    else:
        exponent = math.floor(math.log10(max(1, abs(value)))) - 6
    return f"{round(value / 10.0 ** exponent)}e{exponent}"


def group_of(column):
    return "verdicts" if column in VERDICTS else "claims" if is_claim(column) else "values"


def fingerprints(rows):
    """Returns a short hash of each group of columns."""
    digests = {group: hashlib.sha256() for group in FINGERPRINTS}
    columns = compared(rows[0]) if rows else []
    for row in rows:
        key = [row[name] for name in key_columns(row)]
        for group, digest in digests.items():
            fields = [f"{name}={rounded(name, row[name], row)}" for name in columns if group_of(name) == group]
            digest.update((",".join(key + fields) + "\n").encode())
    return {group: digest.hexdigest()[:8] for group, digest in digests.items()}


def bag_errors(estimates, truth, invalid_too):
    """Returns mean and 95 % of the errors by quantity, as evaluate has them. It is empty where there is no truth."""
    try:
        known = read_truth(str(truth))
        quantities = score(known, join(known, read_estimates(str(estimates))), invalid_too)["quantities"]
    except InputError:
        return {}
    return {name: quantities[name] for name, _, _, _ in QUANTITIES if name in quantities}


def campaign_errors(rows, invalid_too):
    """Returns the same for a campaign, which has the truth in its rows."""
    errors = {}
    for name, column, flag, _ in QUANTITIES:
        stem, unit = column.rsplit("_", 1)
        pairs = [(number(row[column]), number(row[f"{stem}_true_{unit}"])) for row in rows
                 if invalid_too or row[flag] == "1"]
        known = np.array([estimate - truth for estimate, truth in pairs if None not in (estimate, truth)])
        if known.size:
            errors[name] = statistics(known, unit)
    return errors


def claim(rows, column, flag, invalid_too):
    """Returns the median of the claimed standard deviations, or None."""
    claims = [number(row[stddev_column(column, row)]) for row in rows if invalid_too or row[flag] == "1"]
    claims = [value for value in claims if value is not None]
    return float(np.median(claims)) if claims else None


def digits(value, factor):
    return "" if value is None else f"{factor * value:.4g}"


def line(name, preset, rows, errors, invalid_too):
    """Returns a line of the summary."""
    cells = {"set": name, "preset": preset, "rows": str(len(rows)), **fingerprints(rows)}
    for flag in COUNTS[1:]:
        cells[flag] = str(sum(row[flag] == "1" for row in rows))
    for (quantity, column, flag, factor), keys in zip(QUANTITIES, (ERRORS[:3], ERRORS[3:])):
        of = errors.get(quantity, {})
        values = of.get("mean"), of.get("percentile_95"), claim(rows, column, flag, invalid_too)
        cells.update(zip(keys, (digits(value, factor) for value in values)))
    return cells


def machine(program):
    """Names processor and libraries, which decide about the last bits besides the code."""
    flags = re.search(r"^flags\s*:(.*)", Path("/proc/cpuinfo").read_text(encoding="utf-8"), re.MULTILINE)
    vectors = [name for name in ("avx2", "fma", "avx512f") if flags and name in flags.group(1).split()]
    listed = subprocess.run(["ldd", str(program)], stdout=subprocess.PIPE, universal_newlines=True, check=False).stdout
    opencv = re.search(r"=> (\S*libopencv_core\.so\S*)", listed)
    version = os.path.realpath(opencv.group(1)).split(".so.")[-1] if opencv else "unknown"
    return f"{platform.machine()} ({' '.join(vectors) or 'no vectors known'}), OpenCV {version}, glibc {platform.libc_ver()[1]}"


def render(lines, made_on):
    """Writes the text of the summary."""
    text = io.StringIO()
    text.write(f"{MADE_ON}{made_on}; docs/change_indicator.md explains it\n")
    writer = csv.DictWriter(text, HEADER, lineterminator="\n")
    writer.writeheader()
    writer.writerows(lines)
    return text.getvalue()


def read(path):
    """Reads the machine and the lines by set and preset of a summary. Both are empty when there is no summary."""
    if not path.exists():
        return "", {}
    first, *rest = path.read_text(encoding="utf-8").splitlines()
    lines = {(row["set"], row["preset"]): row for row in csv.DictReader(rest)}
    return first[len(MADE_ON):].split(";")[0], lines


def agree(name, old, new, same_machine):
    """Says whether a cell is as it was."""
    if old == new or not same_machine and name in FINGERPRINTS:
        return True
    numbers = number(old or ""), number(new)
    if same_machine or name not in ERRORS or None in numbers:
        return False
    return math.isclose(*numbers, rel_tol=OTHER_MACHINE)


def differences(old, new, same_machine):
    """Lists what differs from the old summary. Other machines have to agree with its numbers only, and only nearly."""
    texts = []
    for key, cells in new.items():
        if key not in old:
            texts.append(f"{', '.join(key)}: not in the summary")
            continue
        changed = [f"{name} {old[key].get(name) or 'blank'} -> {cells[name] or 'blank'}" for name in HEADER[2:]
                   if not agree(name, old[key].get(name), cells[name], same_machine)]
        if changed:
            texts.append(f"{', '.join(key)}: {'; '.join(changed)}")
    return texts
