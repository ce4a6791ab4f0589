"""Scores a fault campaign by fault, per frame and per approach, with the bounds that the counts support."""

import datetime
import math
import platform
import re
import textwrap
from collections import defaultdict
from typing import NamedTuple

from .markdown import table
from .programs import save_figure

TITLE = "# Fault campaign\n"
SUMMARY_BEGIN = "<!-- Summary: made by scripts/fault_campaign. -->\n"
SUMMARY_END = "<!-- End of summary. -->\n"
DATASETS = ("fg_noon", "lab", "kitti_road")
SCENERY = ("town", "fields", "shore", "airport", "hills", "random")
# Ground that is no plane: a height that is refused there is no false alarm.
UNEVEN = ("hills",)
# Nothing in the images or between the sources tells these: docs/integrity.md says why.
UNOBSERVABLE = ("baseline_2", "baseline_8")
MOST_FALSE_ALARMS = 0.005
LEAST_DRAWN = 0.01  # error over protection level, where the plot begins
AIM = 100000  # faulted frames
HEADER = ("fault", "runs", "frames", "available", "misleading", "95 % bound", "runs misled", "95 % bound",
          "error / level, worst", "error / limit, worst", "longest, s")
OUTPUT_HEADER = ("fault", "runs", "frames", "available", "misleading", "95 % bound", "runs misled", "95 % bound",
                 "error / bound, worst", "longest, s")


class Output(NamedTuple):
    """An output besides the height. Its name is in the columns of inject_faults."""
    name: str
    plural: str
    title: str
    text: str
    unobservable: tuple  # faults that nothing could tell, of this output
    without_truth: tuple  # sources


SIGMAS = "Misleading frames are off by more than 5 claimed standard deviations and by more than "
OUTPUTS = (
    Output("angle", "angles", "Approach angles",
           f"Available are valid angles. {SIGMAS}0.3°. A monitor of a glide path of 3° may leave a tenth of it unnoticed (ICAO Annex 10). "
           "Runs of `kitti_road` are left out. The truth there is the road's 0° and not the car's own movement on its springs.",
           (), ("kitti_road",)),
    Output("yaw", "yaws", "Yaw",
           f"Available are known yaws. {SIGMAS}0.5°. Runs with `camera_info` are left out. A wrong principal point turns all directions "
           "alike, and nothing can tell.", ("camera_info",), ("kitti_road",)),
    Output("x", "places along the runway", "Place along the runway",
           f"Available are frames with a known `x`. {SIGMAS}3 m and by more than 3 % of the distance to the threshold.", UNOBSERVABLE, ()),
    Output("y", "places beside the centre line", "Place beside the centre line",
           f"Available are frames with a known `y`. {SIGMAS}1.5 m and by more than 3 % of the runway's width.",
           UNOBSERVABLE, ("kitti_road",)),
    Output("velocity", "velocities", "Velocity",
           "Available are frames with a velocity. The error is a vector, and of recordings the error of the speed. "
           f"{SIGMAS}0.3 m/s and by more than 3 % of the speed.", UNOBSERVABLE, ()),
    Output("runway_height", "heights above the runway", "Height above the runway",
           "Available are frames on which it is known. Misleading ones are off by more than their protection level.",
           UNOBSERVABLE, ("kitti_road",)),
)
OUTPUT_TEXT = ("{text} Error / bound is over what misleads. Longest is the time to alert. On the {frames} frames of the runs without a fault "
               "it is available on {known}, and {healthy} are misleading.")
LONGEST_LINE = 139
TEXT = """Made by `scripts/fault_campaign`{date}, {seeds}, on {machine}. What it shows and what is open: [integrity](integrity.md).

A run is a piece of an approach of at most {frames} frames, with one fault or with two. A fault begins at a random moment. Faults with
*first* in their name, and changes of the scene and the calibration, are there from the first pair on.

| column | meaning |
|---|---|
| frames | frames with the fault, later than 1 s after the start |
| available | share of them with a valid height |
| misleading | valid height with an error beyond the protection level or the alert limit |
| runs misled | runs with at least one misleading frame |
| 95 % bound | by Clopper and Pearson, one sided. Frames of one run are not independent, so the bound per run counts. No campaign of this size proves 1e-5 |
| error / level, error / limit | largest error over the protection level, and over the alert limit, of valid heights |
| longest | longest time with a valid height and an error beyond the alert limit: the time to alert |

Pairs of faults are in one row together, those with an unobservable fault in another.

## Without a fault
There are {all_healthy} healthy frames in {runs} runs. On {uncertain} of them all tests passed, but the protection level was above the
alert limit. Their height is not valid for that reason, fault or no fault, so they are no false alarms.
A false alarm is one of the other {healthy} frames without a valid height. There are {false_alarms} ({share:.2%}, 95 % bound {bound:.2%}).
{healthy_misleading} frames are misleading. Each test on all healthy frames:
"""


def upper_bound(count, total, confidence=0.95):
    """Returns the largest share with which so few would be seen with probability 1 - confidence (Clopper and Pearson)."""
    if total == 0 or count >= total:
        return 1.0
    low, high = 0.0, 1.0
    for _ in range(60):
        share = (low + high) / 2
        logs = [math.lgamma(total + 1) - math.lgamma(k + 1) - math.lgamma(total - k + 1)
                + k * math.log(share) + (total - k) * math.log1p(-share) for k in range(count + 1)]
        low, high = (share, high) if sum(map(math.exp, logs)) > 1 - confidence else (low, share)
    return high


def machine():
    """Returns the name of this machine's processor."""
    try:
        with open("/proc/cpuinfo") as info:
            name = re.search(r"model name\s*:\s*(.*)", info.read()).group(1)
    except (OSError, AttributeError):
        name = platform.processor() or platform.machine()
    return name


def renew_summary(page, summary):
    """Returns docs/integrity.md with this summary."""
    before, rest = page.split(SUMMARY_BEGIN)
    return f"{before}{SUMMARY_BEGIN}\n{summary}\n{SUMMARY_END}{rest.split(SUMMARY_END)[1]}"


class Campaign:
    def __init__(self, rows):
        self.rows = rows

    @staticmethod
    def kind(row):
        """Returns the row of the table to which a run belongs."""
        names = row["faults"].split("+")
        if len(names) == 1:
            return row["faults"]
        return "pairs, unobservable" if any(name in UNOBSERVABLE for name in names) else "pairs"

    def groups(self, rows):
        groups = defaultdict(list)
        for row in rows:
            groups[self.kind(row)].append(row)
        return groups

    @staticmethod
    def total(rows, column):
        return sum(int(row[column]) for row in rows)

    @staticmethod
    def worst(rows, column):
        return max((float(row[column]) for row in rows), default=0)

    def table(self):
        return table(HEADER, [
            (*cells, f"{self.worst(rows, 'worst_level_ratio'):.2f}", f"{self.worst(rows, 'worst_limit_ratio'):.2f}",
             f"{self.worst(rows, 'time_to_alert_s'):.2f}")
            for rows, cells in self.counts(self.rows, "faulted_valid", "misleading")])

    def output_rows(self, output):
        """Returns the runs in which the truth of an output is known, and could be told."""
        return [row for row in self.rows if row["source"] not in output.without_truth
                and not any(name in output.unobservable for name in row["faults"].split("+"))]

    def output_table(self, output):
        return table(OUTPUT_HEADER, [
            (*cells, f"{self.worst(rows, f'{output.name}_worst_ratio'):.2f}", f"{self.worst(rows, f'{output.name}_time_to_alert_s'):.2f}")
            for rows, cells in self.counts(self.output_rows(output), f"{output.name}_known", f"{output.name}_misleading")])

    def healthy_output(self, output):
        """Counts of frames of healthy runs: those with this output, and misleading ones."""
        rows = [row for row in self.healthy_rows() if row["source"] not in output.without_truth]
        return (self.total(rows, "healthy"), self.total(rows, f"{output.name}_healthy_known"),
                self.total(rows, f"{output.name}_healthy_misleading"))

    def output_section(self, output):
        frames, known, healthy = self.healthy_output(output)
        text = OUTPUT_TEXT.format(text=output.text, frames=frames, known=known, healthy=healthy or "none")
        return f"## {output.title} with a fault\n{textwrap.fill(text, LONGEST_LINE)}\n\n{self.output_table(output)}\n"

    def counts(self, rows, valid, misleading):
        """Yields the runs of each fault with the cells of its row: counts of frames and of runs, with their bounds."""
        for name, group in self.groups(rows).items():
            frames, misled = self.total(group, "faulted"), self.total(group, misleading)
            runs = [row for row in group if int(row["faulted"]) > 0]
            runs_misled = sum(int(row[misleading]) > 0 for row in runs)
            if frames:
                yield group, (name.replace("_", " "), len(runs), frames, f"{self.total(group, valid) / frames:.0%}", misled,
                              f"{upper_bound(misled, frames):.2%}", runs_misled, f"{upper_bound(runs_misled, len(runs)):.1%}")

    def healthy(self):
        """Counts of healthy frames: those whose height is certain enough, those of them without a valid height, misleading ones."""
        frames = self.total(self.even_rows(), "healthy") - self.uncertain()
        return (frames, frames - self.total(self.even_rows(), "healthy_valid"),
                self.total(self.healthy_rows(), "healthy_misleading"))

    def uncertain(self):
        """Healthy frames that passed all tests, but whose protection level is above the alert limit."""
        return self.total(self.even_rows(), "healthy_uncertain")

    def even_rows(self):
        """Healthy runs over ground that is a plane, where a height that is refused would be a false alarm."""
        return [row for row in self.healthy_rows() if row["source"] not in UNEVEN]

    def healthy_rows(self):
        """Returns each approach and each dataset once, because the frames before a fault's onset are the same for all faults."""
        rows = {}
        for row in self.rows:
            if row["faults"] == "none":
                rows.setdefault((row["source"], "" if row["source"] in DATASETS else row["seed"]), row)
        return list(rows.values())

    def false_alarms(self):
        """Makes the table of how often each test failed on healthy frames."""
        made, failed = defaultdict(int), defaultdict(int)
        for row in self.healthy_rows():
            for counts in filter(None, row["healthy_tests"].split(";")):
                name, tested, failures = counts.split()
                made[name] += int(tested)
                failed[name] += int(failures)
        return table(("test", "frames tested", "failed", "share", "95 % bound"),
                     [(f"`{name}`", count, failed[name], f"{failed[name] / count:.2%}", f"{upper_bound(failed[name], count):.2%}")
                      for name, count in sorted(made.items())])

    def problems(self):
        """Lists what should not be: too many false alarms, and misleading frames."""
        problems = []
        frames, alarms, misleading = self.healthy()
        if misleading:
            problems.append(f"{misleading} misleading frames without a fault")
        if alarms > MOST_FALSE_ALARMS * frames:
            problems.append(f"{alarms} false alarms on {frames} healthy frames")
        heights = {name: rows for name, rows in self.groups(self.rows).items()
                   if name not in UNOBSERVABLE and name != "pairs, unobservable"}
        problems += self.misled(heights, "misleading", "frames")
        for output in OUTPUTS:
            problems += self.output_problems(output)
        return problems

    def output_problems(self, output):
        problems = []
        misleading = self.healthy_output(output)[2]
        if misleading:
            problems.append(f"{misleading} misleading {output.plural} without a fault")
        return problems + self.misled(self.groups(self.output_rows(output)), f"{output.name}_misleading", output.plural)

    @staticmethod
    def misled(groups, column, what):
        """Lists the runs of each group that misled."""
        found = []
        for name, rows in groups.items():
            count = Campaign.total(rows, column)
            if count:
                runs = sorted({f"{row['faults']} {row['source']} {row['seed']}" for row in rows if int(row[column])})
                found.append(f"{name}: {count} misleading {what} ({', '.join(runs[:8])})")
        return found

    def page(self, seeds):
        frames, alarms, misleading = self.healthy()
        faulted, misled = self.total(self.rows, "faulted"), self.total(self.rows, "misleading")
        text = TEXT.format(date=datetime.datetime.now().strftime(" on %Y-%m-%d"), seeds=seeds, machine=machine(),
                           frames=max(int(row["healthy"]) + int(row["faulted"]) for row in self.rows), healthy=frames,
                           all_healthy=frames + self.uncertain(), runs=len(self.healthy_rows()), false_alarms=alarms,
                           share=alarms / max(1, frames), bound=upper_bound(alarms, frames), uncertain=self.uncertain(),
                           healthy_misleading=misleading)
        text = text.replace("\n\nA run is", f"\n\n{self.summary()}\nA run is", 1)
        return (f"{TITLE}{text}\n{self.false_alarms()}\n## Heights with a fault\n"
                f"Of {faulted} frames with a fault ({AIM:,} are aimed at) {misled} are misleading, {self.unobservable()} of these by a "
                "baseline that is wrong, which no image shows.\n\n"
                f"{self.table()}\n{''.join(map(self.output_section, OUTPUTS))}"
                f"{self.remarks()}\n## Figure\n"
                "![error over protection level, and availability, by fault](images/integrity.png)\n")

    def summary(self):
        """Says what the campaign shows, with a bullet each for healthy frames, heights and the other outputs."""
        frames, alarms, misleading = self.healthy()
        runs = [row for row in self.rows if int(row["faulted"])]
        misled, unobservable = self.total(self.rows, "misleading"), self.unobservable()
        others = sum(int(row["misleading"]) > 0 for row in self.rows if not self.is_unobservable(row))
        return (f"- **Without a fault**: {frames + self.uncertain()} frames. On {self.uncertain()} the protection level is above the "
                f"alert limit, so\n  the height is not valid. On the other {frames} there are {alarms} false alarms and {misleading} misleading "
                f"heights.\n"
                f"- **Heights with a fault**: {self.total(runs, 'faulted')} frames in {len(runs)} runs. {misled} are misleading, {unobservable} "
                f"of these by a\n  baseline that is wrong, which no image shows. The other {misled - unobservable} are in {others} runs.\n"
                + "".join(map(self.output_summary, OUTPUTS)))

    def output_summary(self, output):
        rows, misleading = self.output_rows(output), f"{output.name}_misleading"
        return (f"- **{output.title} with a fault**: {self.total(rows, f'{output.name}_known')} of {self.total(rows, 'faulted')} frames have it. "
                f"{self.total(rows, misleading)} are misleading, in\n  {sum(int(row[misleading]) > 0 for row in rows)} runs. Without a fault "
                f"{self.healthy_output(output)[2] or 'none'} are.\n")

    @staticmethod
    def is_unobservable(row):
        return any(name in UNOBSERVABLE for name in row["faults"].split("+"))

    def unobservable(self):
        """Counts the misleading heights of faults that nothing can tell."""
        return self.total([row for row in self.rows if self.is_unobservable(row)], "misleading")

    def remarks(self):
        """Writes what should not be as a list."""
        problems = self.problems()
        if not problems:
            return "## What should not be\nNo frame was misleading where there is something to see.\n"
        return "## What should not be\nFault, misleading frames, and the runs that have them:\n\n" + "".join(f"- {problem}\n" for problem in problems)

    def plot(self, file):
        """Plots the worst error over the protection level, and the availability, of each fault."""
        import matplotlib
        matplotlib.use("Agg")
        from matplotlib import pyplot
        groups = {name: rows for name, rows in self.groups(self.rows).items() if self.total(rows, "faulted")}
        names = list(groups)
        figure, (left, right) = pyplot.subplots(1, 2, sharey=True, figsize=(11, 0.2 * len(names) + 1.2))
        for at, name in enumerate(names):
            runs = [max(LEAST_DRAWN, float(row["worst_level_ratio"])) for row in groups[name] if int(row["faulted_valid"])]
            left.plot(runs, [at] * len(runs), "|", color="tab:blue", markersize=7)
            frames = self.total(groups[name], "faulted")
            right.barh(at, 100 * self.total(groups[name], "faulted_valid") / frames, color="tab:blue")
        left.axvline(1, color="tab:red")
        left.set_xscale("log")
        left.set_ylim(-1, len(names))
        left.set_yticks(range(len(names)))
        left.set_yticklabels([name.replace("_", " ") for name in names], fontsize=7)
        left.set_xlabel("worst error of a run over its protection level")
        left.invert_yaxis()
        right.set_xlabel("frames with a valid height, %")
        save_figure(figure, file)
