"""Section `noise`: errors of the stereo plane against the Cramér–Rao bound."""

import csv

from . import kept
from .campaign import number
from .markdown import table
from .programs import DEVEL, ROOT, WORK, run, save_figure

PROGRAM = "measure_noise_bound"
IMAGE = ROOT / "docs/images/noise.png"
QUANTITIES = (("height_m", "height, cm", 100), ("pitch_deg", "pitch, °", 1), ("roll_deg", "roll, °", 1))
TEXT = """`measure_noise_bound` renders pairs without noise, adds it, and fits the plane of a single pair. Errors are root mean squares over scenes
and pairs. They are compared with the Cramér–Rao bound, the least error that any unbiased estimator could have. It follows from the
gradients of the same images, with gain and offset between the cameras unknown. Asked is a ratio of at most 2 at noise of 2 grey levels
and more. *Claimed* is the standard deviation that the estimate comes with.

This bound knows the gradients without noise. The ratio in brackets is to another bound. That one has to tell the texture from the noise,
by the spectrum of each part of the image (the delay between two receivers, Knapp and Carter 1976). Who does not know the texture can
hardly come nearer to the first bound than that. The rest is the estimator's. At noise of 1 these are errors that are not noise, of
interpolation for instance. Under much noise it is what it takes to find out which of the texture to believe.

![Errors of the plane over noise, with the bound](images/noise.png)

"""


def measure(options):
    if not (DEVEL / "lib/uav_landing" / PROGRAM).exists():
        print(f"{PROGRAM} is not built: noise is left out")
        return
    path = WORK / "noise" / "bound.csv"
    path.parent.mkdir(parents=True, exist_ok=True)
    run(PROGRAM, "--output", path, "--scenes", 24, "--pairs", 8)
    with path.open() as file:
        kept.keep("noise", [{name: number(row, name) for name in row} for row in csv.DictReader(file)])


def plot(rows):
    import matplotlib  # only here: it takes longer to load than everything else
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    from matplotlib.ticker import NullFormatter, StrMethodFormatter
    figure, axes = plt.subplots(1, len(QUANTITIES), figsize=(14, 4.5))
    heights = sorted({row["height_m"] for row in rows})
    for axis, (name, title, factor) in zip(axes, QUANTITIES):
        for i, height in enumerate(heights):
            cells = sorted((row for row in rows if row["height_m"] == height), key=lambda row: row["noise"])
            noise = [row["noise"] for row in cells]
            axis.loglog(noise, [factor * row[f"rms_{name}"] for row in cells], "o-", color=f"C{i}", label=f"{height:g} m")
            axis.loglog(noise, [factor * row[f"bound_{name}"] for row in cells], "--", color=f"C{i}")
        axis.set_title(title)
        axis.set_xlabel("noise, grey levels")
        axis.set_xticks(noise)
        axis.xaxis.set_major_formatter(StrMethodFormatter("{x:g}"))
        axis.xaxis.set_minor_formatter(NullFormatter())
        axis.grid(True, which="both", linewidth=0.3)
    axes[-1].legend(title="height; dashed: bound", loc="upper left", bbox_to_anchor=(1.02, 1), fontsize=8)
    save_figure(figure, IMAGE)


def render(results):
    plot(results)
    header = ["height", "noise", "pairs"]
    for _, title, _ in QUANTITIES:
        header += [f"{title}: error", "bound", "ratio", "claimed"]
    rows = []
    for row in sorted(results, key=lambda row: (row["height_m"], row["noise"])):
        cells = [f"{row['height_m']:g} m", f"{row['noise']:g}", f"{row['pairs']:g}"]
        for name, _, factor in QUANTITIES:
            error, bound, unknown, claimed = (
                factor * row[f"{kind}_{name}"] for kind in ("rms", "bound", "unknown_texture_bound", "claimed"))
            cells += [f"{error:.3g}", f"{bound:.3g}", f"{error / bound:.2f} ({error / unknown:.2f})", f"{claimed:.3g}"]
        rows.append(cells)
    return TEXT + table(header, rows)
