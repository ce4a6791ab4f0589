"""Flies rows of simulate_campaign in pieces on several cores. What is there already is not flown again."""

import csv
import math
import subprocess
from concurrent.futures import ThreadPoolExecutor

from .programs import DEADLINE, DEVEL, ROOT, WORK, fingerprint

PROGRAM = DEVEL / "lib/uav_landing/simulate_campaign"


def fly(kind, begin, count, piece, jobs, *options):
    """Flies a number of seeds in pieces, from begin on, and returns the rows as dictionaries."""
    config = ROOT / "config/stereo.yaml"
    folder = WORK / f"{kind}-{fingerprint(PROGRAM, config)}"
    folder.mkdir(parents=True, exist_ok=True)
    name = "_".join(map(str, options)).replace("--", "")

    def one(first):
        rows = folder / f"{name}_{first}_{piece}.csv"
        if not rows.exists():
            result = subprocess.run([str(PROGRAM), kind, "--csv", str(rows), "--config", str(config), "--first", str(first),
                                     "--count", str(piece), *map(str, options)], stdout=subprocess.PIPE,
                                    stderr=subprocess.STDOUT, universal_newlines=True, timeout=DEADLINE)
            if result.returncode != 0:
                raise SystemExit(f"simulate_campaign {kind} --first {first}: {result.stdout}")
            print(f"{kind}: seeds {first} to {first + piece - 1} of {begin} to {begin + count - 1}", flush=True)
        with rows.open() as file:
            return list(csv.DictReader(file))

    with ThreadPoolExecutor(jobs) as pool:
        pieces = list(pool.map(one, range(begin, begin + count, piece)))
    return [row for rows in pieces for row in rows if int(row["seed"]) < begin + count]


def number(row, column):
    return float(row[column]) if row[column] else math.nan
