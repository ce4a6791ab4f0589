"""The paper's Figures 4 to 7 and Table 1 for one run, and what the run says of its own uncertainty, on one page."""

import base64
import html
import os
import re

import numpy as np

import matplotlib
matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402 (the backend must be chosen first)

from evaluation.distributions import Missing, draw_consistency, draw_histograms, draw_timeline  # noqa: E402
from evaluation.pending_file import pending  # noqa: E402
from evaluation.scores import COLUMNS, summary  # noqa: E402
from evaluation.tables import InputError, Table  # noqa: E402

# The paper's Table 1: row, its time in ms per frame of 320x240, and our parts that belong to it (parts that are named
# nowhere are feature matching).
PAPER_ROWS = (("Pre-process", 3.4, ("rectify",)), ("Hough transforms", 4.7, ("lines",)),
              ("RANSAC", 6.2, ("ransac",)), ("Feature matching", 11.9, ()),
              ("Kalman filter", 1.2, ("reconstruction", "kalman_filter")), ("Image show", 2.8, ("overlay",)))
PAPER_TOTAL = 31.2

STYLE = "body{font-family:sans-serif;max-width:62em;margin:2em auto;padding:0 1em}img{max-width:100%}" \
        "table{border-collapse:collapse}td,th{padding:0.15em 0.8em;text-align:right}" \
        "tr+tr{border-top:1px solid #ddd}td:first-child,th:first-child{text-align:left}"


def pictures(report_data, name):
    """Returns the images name_N.png of the report data: frame number -> path."""
    if report_data is None:
        raise Missing("no --report-data given (process_bag --report-data makes it)")
    if not os.path.isdir(report_data):
        raise Missing(f"{report_data}: no such folder")
    found = {}
    for file in os.listdir(report_data):
        match = re.fullmatch(name + r"_(\d+)\.png", file)
        if match:
            found[int(match.group(1))] = os.path.join(report_data, file)
    if not found:
        raise Missing(f"{report_data}: no image {name}_*.png")
    return found


def show_pictures(path, images, titles):
    """Shows images side by side, in their true proportions."""
    images = [plt.imread(image) for image in images]
    height, width = images[0].shape[:2]
    figure, axes = plt.subplots(1, len(images), figsize=(12, 12 / len(images) * height / width + 0.4), squeeze=False)
    for axis, image, title in zip(axes[0], images, titles):
        axis.imshow(image)
        axis.set_title(title)
        axis.axis("off")
    figure.tight_layout()
    with pending(path) as temporary:
        figure.savefig(temporary, dpi=120, bbox_inches="tight")
    plt.close(figure)


def figure_4(path, _truth, _joined, report_data):
    left, right = pictures(report_data, "lines_left"), pictures(report_data, "lines_right")
    frames = sorted(set(left) & set(right))
    if not frames:
        raise Missing(f"{report_data}: no frame has both lines_left_*.png and lines_right_*.png")
    frame = frames[len(frames) // 2]
    show_pictures(path, [left[frame], right[frame]], [f"left, frame {frame}", f"right, frame {frame}"])


def figure_5(path, _truth, _joined, report_data):
    matches = pictures(report_data, "matches")
    frame = sorted(matches)[len(matches) // 2]
    show_pictures(path, [matches[frame]], [f"left and right, frame {frame}"])


def plot_against_truth(path, truth, joined, column, unit, label, curves):
    """Curves (column of the estimates, format, name) over the whole run with the truth, frames that are not valid
    marked below; where there is truth, the deviations from it in a second panel."""
    if not any(joined.estimates.has(name) for name, _, _ in curves):
        raise Missing(f"{joined.estimates.path}: no {' or '.join(name for name, _, _ in curves)}")
    time, known = joined.stamp - joined.stamp[0], truth.has(column)
    figure, axes = plt.subplots(2 if known else 1, 1, figsize=(9, 7 if known else 5), sharex=True, squeeze=False)
    top, bottom = axes[0][0], axes[-1][0]
    for name, style, title in curves:
        top.plot(time, joined.estimate(name), style, label=title, linewidth=1.2)
        if known:
            bottom.plot(time, joined.estimate(name) - truth.number(column), style, linewidth=1.2)
    if known:
        top.plot(time, truth.number(column), "k--", label="truth", linewidth=1)
        bottom.axhline(0, color="k", linewidth=0.8)
        bottom.set_ylabel(f"deviation from truth, {unit}")
    invalid = joined.estimate("valid") != 1
    if np.any(invalid):
        top.plot(time[invalid], np.zeros(np.sum(invalid)), "r|", label="not valid", clip_on=False,
                 transform=top.get_xaxis_transform())
    top.set_ylabel(f"{label}, {unit}")
    top.legend()
    bottom.set_xlabel("time, s")
    for axis in axes[:, 0]:
        axis.grid(alpha=0.3)
    figure.tight_layout()
    with pending(path) as temporary:
        figure.savefig(temporary, dpi=120)
    plt.close(figure)


def figure_6(path, truth, joined, _report_data):
    plot_against_truth(path, truth, joined, "approach_angle_deg", "deg", "approach angle",
                       (("raw_approach_angle_deg", "b:", "last step alone"), ("approach_angle_deg", "b-", "estimate")))


def figure_7(path, truth, joined, _report_data):
    plot_against_truth(path, truth, joined, "height_m", "m", "height",
                       (("raw_height_m", "b:", "matching of feature points"), ("height_m", "b-", "Kalman filter")))


FIGURES = (("figure4.png", "Figure 4: straight edges (in the paper by the Hough transform)", figure_4),
           ("figure5.png", "Figure 5: Harris corners and their matches", figure_5),
           ("figure6.png", "Figure 6: approach angle", figure_6),
           ("figure7.png", "Figure 7: height", figure_7),
           ("errors.png", "Errors where height, or the angle, is valid", draw_histograms),
           ("consistency.png", "Consistency: errors against the claimed uncertainty", draw_consistency),
           ("timeline.png", "Coverage and status", draw_timeline))


def cells(tag, values):
    return "<tr>" + "".join(f"<{tag}>{html.escape(str(value))}</{tag}>" for value in values) + "</tr>"


def timing_table(report_data):
    if report_data is None:
        raise Missing("no --report-data given (process_bag --report-data makes it)")
    try:
        timing = Table(os.path.join(report_data, "timing.csv"))
    except InputError as error:
        raise Missing(str(error))
    parts = [name for name in timing.header if name.endswith("_ms") and timing.has(name)]
    if not parts:
        raise Missing(f"{timing.path}: no column that ends in _ms")
    times = {name[:-3]: timing.number(name) for name in parts}
    return table_1(times, timing.rows) + "<h3>All parts</h3>" + parts_table(times)


def table_1(times, pairs):
    """Makes the paper's Table 1 of means per pair. A part that did not run for a pair took no time."""
    named = {part for _, _, parts in PAPER_ROWS for part in parts}
    rows = [cells("th", ("image process", "mean", "the paper"))]
    total = 0
    for title, paper, parts in PAPER_ROWS:
        ours = parts or [part for part in times if part not in named]
        mean = sum(np.nansum(times[part]) for part in ours if part in times) / pairs
        total += mean
        rows.append(cells("td", (title, f"{mean:.2f}", f"{paper:.1f}")))
    rows.append(cells("td", ("Total", f"{total:.2f}", f"{PAPER_TOTAL:.1f}")))
    return "<table>" + "".join(rows) + "</table>"


def parts_table(times):
    """Makes a table of each part's times over the pairs for which it ran."""
    rows = [cells("th", ("part", "mean", "median", "99 %", "worst"))]
    for name, column in times.items():
        column = column[np.isfinite(column)]
        values = (np.mean(column), np.median(column), np.percentile(column, 99), np.max(column))
        rows.append(cells("td", [name.replace("_", " ")] + [f"{value:.2f}" for value in values]))
    return "<table>" + "".join(rows) + "</table>"


def score_table(scores):
    rows = [cells("th", ("error", "unit") + tuple(title for title, _ in COLUMNS) + ("within claimed 95 %",))]
    for name, values in scores["quantities"].items():
        within = values.get("within_claimed_95")
        rows.append(cells("td", [name.replace("_", " "), values["unit"]] + [f"{values[key]:.4f}" for _, key in COLUMNS]
                          + ["" if within is None else f"{100 * within:.1f} %"]))
    return "<table>" + "".join(rows) + "</table>"


def embedded(path, title):
    """Puts the image into the page itself, so that the page can be sent as one file."""
    with open(path, "rb") as file:
        data = base64.b64encode(file.read()).decode()
    return f"<img src='data:image/png;base64,{data}' alt='{html.escape(title)}'>"


def write_report(folder, truth, joined, scores, report_data):
    """Writes the figures, and index.html, which holds them as well. Returns the path of the latter."""
    os.makedirs(folder, exist_ok=True)
    missing = [f"{name.replace('_', ' ')}: {why}" for name, why in scores["missing"].items()]
    parts = []
    for file, title, draw in FIGURES:
        try:
            draw(os.path.join(folder, file), truth, joined, report_data)
            parts.append(f"<h2>{title}</h2>" + embedded(os.path.join(folder, file), title))
        except Missing as why:
            missing.append(f"{title}: {why}")
    title = "Table 1: time per image pair, ms"
    try:
        parts.append(f"<h2>{title}</h2>" + timing_table(report_data))
    except Missing as why:
        missing.append(f"{title}: {why}")
    absent = "<h2>Missing</h2><ul>" + "".join(f"<li>{html.escape(line)}</li>" for line in missing) + "</ul>" \
        if missing else ""
    path = os.path.join(folder, "index.html")
    with pending(path) as temporary, open(temporary, "w") as page:
        page.write(f"<!DOCTYPE html><html lang='en'><meta charset='utf-8'><title>Landing estimate</title>"
                   f"<style>{STYLE}</style><h1>Landing estimate against truth</h1>"
                   f"<p>{html.escape(summary(scores).splitlines()[0])}</p>"
                   f"{score_table(scores)}{''.join(parts)}{absent}</html>\n")
    return path
