"""CSV files as columns of numbers, and truth joined with estimates by stamp."""

import csv

import numpy as np

# Images of one pair may differ by less than this; frames are much farther apart.
STAMP_TOLERANCE = 1e-3  # s

TRUTH_COLUMNS = ("height_m", "approach_angle_deg", "foe_u_px", "foe_v_px", "pitch_deg", "roll_deg", "yaw_deg")
ESTIMATE_COLUMNS = ("stamp_s", "valid", "height_m", "approach_angle_deg")


class InputError(Exception):
    """A file cannot be used. The message says which one and why."""


class Table:
    """The columns of a CSV file by name: arrays of numbers, NaN where blank. Text columns stay out."""

    def __init__(self, path):
        self.path = path
        try:
            with open(path, newline="") as file:
                self._read(csv.reader(file))
        except OSError as error:
            raise InputError(f"{path}: cannot be read: {error.strerror}")
        except UnicodeDecodeError:
            raise InputError(f"{path}: not text, expected a CSV file with a header line")
        except csv.Error as error:
            raise InputError(f"{path}: not a CSV file: {error}")

    def _read(self, reader):
        header = [name.strip() for name in next(reader, [])]
        if not header:
            raise InputError(f"{self.path}: empty, expected a header line")
        columns = [[] for _ in header]
        for row in reader:
            if not row:
                continue
            if len(row) != len(header):
                raise InputError(f"{self.path}, line {reader.line_num}: {len(row)} fields, the header has {len(header)}")
            for column, field in zip(columns, row):
                column.append(field.strip())
        self.header = header
        self.text = dict(zip(header, columns))
        self.rows = len(columns[0])

    def has(self, name):
        """Says whether the column is there and knows something."""
        return name in self.text and any(self.text[name])

    def require(self, *names):
        missing = [name for name in names if name not in self.text]
        if missing:
            raise InputError(f"{self.path}: no column {', '.join(missing)} (there are: {', '.join(self.header)})")

    def number(self, name):
        """Returns the column as numbers, all NaN when it is absent."""
        if name not in self.text:
            return np.full(self.rows, np.nan)
        values = np.empty(self.rows)
        for row, field in enumerate(self.text[name]):
            try:
                values[row] = float(field) if field else np.nan
            except ValueError:
                raise InputError(f"{self.path}, row {row + 1}, column {name}: \"{field}\" is not a number")
        return values


def read_truth(path):
    truth = Table(path)
    truth.require("stamp_s")
    if truth.rows == 0:
        raise InputError(f"{path}: no frame")
    if not any(truth.has(name) for name in TRUTH_COLUMNS):
        raise InputError(f"{path}: no truth, none of the columns {', '.join(TRUTH_COLUMNS)}")
    return truth


def read_estimates(path):
    estimates = Table(path)
    estimates.require(*ESTIMATE_COLUMNS)
    if estimates.rows == 0:
        raise InputError(f"{path}: no estimate")
    return estimates


class Joined:
    """For each frame of the truth the estimate with the nearest stamp; frames without one have NaN."""

    def __init__(self, truth, estimates):
        self.truth, self.estimates = truth, estimates
        self.stamp = truth.number("stamp_s")
        stamps = estimates.number("stamp_s")
        if not np.all(np.isfinite(self.stamp)) or not np.all(np.isfinite(stamps)):
            path = truth.path if not np.all(np.isfinite(self.stamp)) else estimates.path
            raise InputError(f"{path}: column stamp_s has a blank")
        order = np.argsort(stamps, kind="stable")
        right = np.clip(np.searchsorted(stamps[order], self.stamp), 1, len(stamps) - 1) if len(stamps) > 1 else \
            np.zeros(len(self.stamp), int)
        left = np.maximum(right - 1, 0)
        distance = [np.abs(stamps[order][index] - self.stamp) for index in (left, right)]
        self.row = order[np.where(distance[0] <= distance[1], left, right)]
        self.found = np.minimum(*distance) <= STAMP_TOLERANCE

    def estimate(self, name):
        """Returns the column of the estimates, one value per frame of the truth."""
        return np.where(self.found, self.estimates.number(name)[self.row], np.nan)


def join(truth, estimates):
    joined = Joined(truth, estimates)
    if not np.any(joined.found):
        raise InputError(f"no stamp of {estimates.path} is within {STAMP_TOLERANCE * 1000:g} ms of one of {truth.path}")
    return joined
