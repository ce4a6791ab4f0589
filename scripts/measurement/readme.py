"""Takes the numbers of README.md from docs/accuracy.md and docs/performance.md, so that each number has one home."""

from .markdown import table

BEGIN = "<!-- Numbers: made by scripts/accuracy from docs/accuracy.md and docs/performance.md. -->\n\n"
END = "<!-- End of numbers. -->\n"
WHAT = {"lab": "replica of the paper's laboratory, 2.0 to 0.6 m", "fg_noon": "FlightGear approach, 27 to 1.7 m",
        "kitti_road": "car on a real street, cameras at 1.65 m", "kitti_raw": "the same, patched road, cars beside it",
        "simulator/full_scale": "own simulator, 40 m to the flare"}
HEADER = ("set", "what it is", "valid", "height error, cm: mean", "95 %", "worst", "angle error, °: mean", "95 %")
# Columns of the set's row in accuracy.md: coverage, height mean, 95 %, worst, angle mean, 95 %.
COLUMNS = (2, 3, 5, 6, 8, 10)


def rows(page, heading):
    """Returns the cells of the first table below a heading, by the first cell."""
    if heading not in page:
        raise ValueError(f"no heading '{heading}'")
    found = {}
    for line in page.split(heading, 1)[1].splitlines():
        if line.startswith("|"):
            cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
            found[cells[0]] = cells
        elif found:
            break
    return found


def render(accuracy, performance):
    """Makes the block between BEGIN and END from the two pages."""
    sets = rows(accuracy, "### Default preset")
    times = rows(performance, "# Performance")
    lines = [[f"`{name}`", what, *(sets[name][column] for column in COLUMNS)] for name, what in WHAT.items() if name in sets]
    small, large = (times[f"simulated {size}"][1] for size in ("640x480", "1280x960"))
    return (f"{BEGIN}{table(HEADER, lines)}\n"
            f"One image pair takes {small} ms of one core of an AMD EPYC at 640x480, and {large} ms at 1280x960.\n\n{END}")


def renew(readme, accuracy, performance):
    """Returns README with the block made anew."""
    before, rest = readme.split(BEGIN)
    return before + render(accuracy, performance) + rest.split(END)[1]
