"""Estimates of two builds side by side: which columns differ, in how many rows, and where by most."""

import csv
from collections import Counter

from .columns import FLAGS, compared, is_truth, key_columns, number, stddev_column, unit_of

SIGMAS = 1e-6  # differences below this share of the claimed standard deviation are none
RELATIVE = 1e-9  # for columns without one; of 1 m, degree or pixel for smaller values
SIGMA = "sigma"


class Change:
    """What one column does in some rows. kind: number, blank, text, or gained and lost of a flag."""

    def __init__(self, column, kind):
        self.column, self.kind, self.rows = column, kind, 0
        self.size, self.unit, self.where, self.before, self.after = -1.0, "", "", "", ""

    def add(self, size, unit, where, before, after):
        self.rows += 1
        # A size in standard deviations says more than one in metres, whichever is the larger number.
        if (unit == SIGMA, size) > (self.unit == SIGMA, self.size):
            self.size, self.unit, self.where, self.before, self.after = size, unit, where, before, after

    def __str__(self):
        values = f"{self.before or 'blank'} -> {self.after or 'blank'}"
        if self.kind == "number":
            return f"{self.column}: {self.rows} rows, worst {self.size:.3g} {self.unit} at {self.where}: {values}"
        names = {"blank": "blank against number in", "text": "other text in", "gained": "0 -> 1 in", "lost": "1 -> 0 in"}
        return f"{self.column}: {names[self.kind]} {self.rows} rows, first at {self.where}" \
            + ("" if self.kind in ("gained", "lost") else f": {values}")


class Comparison:
    """Rows of the base and of the tree, and what differs between them."""

    def __init__(self, base, tree):
        self.changes, self.truth_changes, self.differing, self.compared = {}, {}, 0, 0
        base, tree = by_key(base), by_key(tree)
        self.missing = [key for key in base if key not in tree]
        self.added = [key for key in tree if key not in base]
        header = next(iter(base.values()), {}), next(iter(tree.values()), {})
        both = bool(base) and bool(tree)
        self.removed_columns = [name for name in header[0] if name not in header[1]] if both else []
        self.added_columns = [name for name in header[1] if name not in header[0]] if both else []
        columns = self.columns = [name for name in header[0] if name in header[1]]
        truth = [name for name in columns if is_truth(name, columns)]
        estimates = compared(columns)
        for key in base:
            if key in tree:
                self._compare(key, base[key], tree[key], truth, estimates)

    def _compare(self, key, before, after, truth, estimates):
        self.compared += 1
        differs = False
        for column in truth:
            if before[column] != after[column]:
                self._note(self.truth_changes, column, "text", 0, "", key, before, after)
        for column in estimates:
            difference = difference_of(column, before, after)
            if difference:
                differs = True
                self._note(self.changes, column, *difference, key, before, after)
        self.differing += differs

    @staticmethod
    def _note(changes, column, kind, size, unit, key, before, after):
        change = changes.setdefault((column, kind), Change(column, kind))
        change.add(size, unit, key, before[column], after[column])

    def same(self):
        return not (self.differing or self.missing or self.added or self.truth_changes or self.removed_columns
                    or self.added_columns)

    def title(self):
        if self.same():
            return f"{self.compared} rows, no difference"
        return f"{self.differing} of {self.compared} rows differ"

    def lines(self):
        """Says what differs, a line each. What makes the rest hard to compare comes first."""
        lines = [f"{column} is drawn otherwise in {change.rows} rows: the simulator changed, or what it draws by"
                 for (column, _), change in self.truth_changes.items()]
        for keys, text in ((self.missing, "no longer there"), (self.added, "new")):
            if keys:
                lines.append(f"{len(keys)} rows are {text}, first {keys[0]}")
        lines += [f"column {name} is no longer there" for name in self.removed_columns]
        lines += [f"column {name} is new" for name in self.added_columns]
        changes = sorted(self.changes.values(), key=lambda change: self.columns.index(change.column))
        return lines + [str(change) for change in changes]


def read_rows(path):
    with open(str(path), newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def by_key(rows):
    """Returns the rows by the text that names them. Rows with the same name get numbers."""
    seen, named = Counter(), {}
    for row in rows:
        names = key_columns(row)
        key = row["stamp_s"] if names == ("stamp_s",) else ", ".join(f"{name} {row[name]}" for name in names)
        seen[key] += 1
        named[key if seen[key] == 1 else f"{key} ({seen[key]})"] = row
    return named


def difference_of(column, before, after):
    """Returns (kind, size, unit) of a column's difference, or None."""
    old, new = before[column], after[column]
    if old == new:
        return None
    if column in FLAGS:
        return "gained" if new == "1" else "lost", 0, ""
    numbers = number(old), number(new)
    if None not in numbers:
        return number_difference(column, *numbers, before)
    # No number beside a number, whether it is blank or "nan".
    unknown = all(value is not None or field.lower() in ("", "nan", "inf", "-inf")
                  for value, field in zip(numbers, (old, new)))
    if unknown:
        return None if numbers == (None, None) else ("blank", 0, "")
    return "text", 0, ""


def number_difference(column, old, new, before):
    size = abs(new - old)
    stddev = stddev_column(column, before)
    sigma = number(before[stddev]) if stddev else None
    if sigma:
        return ("number", size / sigma, SIGMA) if size > SIGMAS * sigma else None
    limit = RELATIVE * max(1, abs(old), abs(new))
    return ("number", size, unit_of(column).strip("_").replace("m_s", "m/s")) if size > limit else None
