"""Estimates of two files of simulate_campaign --csv, value by value: how many claimed standard deviations lie between them."""

import csv
import math

from measurement.columns import VERDICTS, compared, is_claim, is_truth, key_columns, number, stddev_column
from measurement.row_comparison import by_key

from .commands import Unusable

NEAR = 0.05  # claimed standard deviations
SHARE = 0.99  # of the values have to be that near
DRAWN = 1e-6  # of what the simulator draws, or of 1: libraries of other processors round otherwise


class Comparison:
    """values: how many were compared. far: a line for each that is not near."""

    def __init__(self, here, there):
        """here: the file of this machine; there: that of the emulator."""
        self.values, self.far = 0, []
        here, there = read(here), read(there)
        check_alike(here, there)
        for key, row in here.items():
            for column in compared(row):
                self._compare(key, column, row, there[key])

    def _compare(self, key, column, here, there):
        apart = distance(column, here, there)
        if apart is None:
            return
        self.values += 1
        if not apart <= NEAR:
            size = "" if math.isinf(apart) else f", {apart:.3g} sigma apart"
            self.far.append(f"{column} at {key}: {here[column] or 'blank'} here, {there[column] or 'blank'} on arm64{size}")

    @property
    def near(self):
        return self.values - len(self.far)

    def passed(self):
        return self.values > 0 and self.near >= SHARE * self.values

    def __str__(self):
        return f"{self.near} of {self.values} values within {NEAR} sigma"


def distance(column, here, there):
    """Between two values in claimed standard deviations, of a claim in itself; None when neither file has one."""
    old, new = number(here[column]), number(there[column])
    if column in VERDICTS:
        return 0 if here[column] == there[column] else math.inf
    if old is None and new is None:
        return None
    if old is None or new is None:
        return math.inf
    if old == new:
        return 0
    claim = column if is_claim(column) else stddev_column(column, here)
    sigma = number(here[claim]) if claim else None
    return abs(new - old) / sigma if sigma else math.inf


def read(path):
    """Rows of a file by the text that names them."""
    try:
        with open(str(path), newline="", encoding="utf-8") as file:
            reader = csv.DictReader(file)
            header, rows = reader.fieldnames or (), list(reader)
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise Unusable(f"{path}: cannot be read ({getattr(error, 'strerror', None) or error})")
    if "seed" not in key_columns(header):
        raise Unusable(f"{path}: has no columns seed, cell_height_m, noise and frame; expected is a file of "
                       "simulate_campaign --csv")
    if not rows:
        raise Unusable(f"{path}: has no rows")
    if any(None in row or None in row.values() for row in rows):
        raise Unusable(f"{path}: a row has not as many fields as the header")
    return by_key(rows)


def check_alike(here, there):
    """Raises when the files are not of the same flights."""
    columns = [set(next(iter(rows.values()))) for rows in (here, there)]
    if columns[0] != columns[1]:
        raise Unusable(f"only one of the files has the column {min(columns[0] ^ columns[1])}: build this machine's "
                       "programs anew (scripts/build)")
    if set(here) != set(there):
        raise Unusable(f"only one of the files has the row {min(set(here) ^ set(there))}")
    for key, row in here.items():
        for column in row:
            if is_truth(column, row) and not same_drawn(row[column], there[key][column]):
                raise Unusable(f"{column} at {key} is drawn otherwise: {row[column]} here, {there[key][column]} on arm64; "
                               "build this machine's programs anew (scripts/build)")


def same_drawn(here, there):
    old, new = number(here), number(there)
    if old is None or new is None:
        return here == there
    return abs(new - old) <= DRAWN * max(1, abs(old))
