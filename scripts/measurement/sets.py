"""Section `sets`: every dataset and simulator configuration with each preset."""

import json
import os
import shutil

from . import kept
from .markdown import DASH, number, table
from .programs import ROOT, WORK, run

DATASETS = ("lab", "fg_noon", "kitti_road", "kitti_raw")
# title, file name, what evaluate is told besides
PRESETS = (("Default preset", "stereo", ()),
           ("For slow computers", "fast", ()),
           ("The paper's choices, also on frames that are not valid", "paper", ("--invalid-too",)))
HEADER = ("set", "frames", "coverage", "height, cm: mean", "median", "95 %", "worst", "in 95 %",
          "angle, °: mean", "median", "95 %", "worst", "signed", "in 95 %", "pitch, °: 95 %", "roll, °: 95 %",
          "speed, m/s: 95 %", "in 95 %", "ms")
TEXT = """Each set goes through `dataset_to_bag` (or `simulate_approach`), `process_bag --config config/<preset>.yaml` and `evaluate`. One parameter
set serves all.

| column | meaning |
|---|---|
| coverage | share of the frames later than 1 s after the first on which `valid` is 1; the other columns are of these |
| mean, median, 95 %, worst | of the absolute error; *signed* is the mean with sign |
| in 95 % | share of the errors within the 95 % interval that the estimate itself claims |
| ms | mean time of all stages for a pair while this was measured. It is no benchmark: see [performance](performance.md) |

| set | what it is | truth |
|---|---|---|
| `lab` | ray-traced replica of the paper's laboratory, with a lens model and noise | exact |
| `fg_noon` | FlightGear approach | exact |
| `kitti_road` | recording from a car (Geiger et al., CC BY-NC-SA 3.0), cameras 1.65 m above the road | ±2 cm by the suspension. The angle is scored against the road's 0°, although the car moves on its springs: errors beyond the claim are mostly real movement |
| `kitti_raw` | the same, on a patched and uneven street | the car pitches by 2° within 0.6 s, so its height is then not 1.65 m to 2 cm |
| `simulator/*` | `simulate_approach` with `config/simulator/*.yaml` | exact. The right camera of `bent_rig` has turned by ten (pitch) to twenty (yaw) times what a good calibration leaves |

The paper reports for its own laboratory: height mean 1.57 cm, worst 5.97 cm; approach angle mean 0.66°. The paper's choices are seldom
certain enough to be valid. Their errors are those of all frames that have a number.
"""


def find_sets(data, names=None):
    """Returns name and source (dataset folder or configuration) of all sets, or of those named."""
    sets = [(name, data / name) for name in DATASETS if (data / name).is_dir()]
    sets += [(f"simulator/{path.stem}", path) for path in sorted((ROOT / "config/simulator").glob("*.yaml"))]
    for name in DATASETS:
        if not (data / name).is_dir() and (not names or name in names):
            print(f"no dataset {data / name}: left out (set UAV_LANDING_DATA)")
    return [(name, source) for name, source in sets if not names or name in names]


def make_bag(name, source):
    """Makes the bag of a set and returns it with the truth."""
    folder = WORK / name
    shutil.rmtree(str(folder), ignore_errors=True)
    folder.mkdir(parents=True)
    bag = folder / "input.bag"
    if source.is_dir():
        run("dataset_to_bag", "--dataset", source, "--output", bag)
        return bag, source / "frames.csv"
    run("simulate_approach", "--config", source, "--output", bag, "--dataset", folder / "dataset")
    return bag, folder / "dataset" / "frames.csv"


def score(name, bag, truth, config, options=()):
    """Returns the scores of one run as evaluate --json writes them."""
    estimates, scores = (WORK / name / f"{config.stem}.{ending}" for ending in ("csv", "json"))
    run("process_bag", "--input", bag, "--config", config, "--csv", estimates)
    run("evaluate", "--truth", truth, "--estimates", estimates, "--json", scores, *options)
    return json.loads(scores.read_text(encoding="utf-8"))


def quantity(scores, name, key):
    return (scores["quantities"].get(name) or {}).get(key)


def row(name, scores):
    """Makes one row of the table."""
    def cells(quantity_name, keys, factor, form):
        for key in keys:
            share = key == "within_claimed_95"
            yield number(quantity(scores, quantity_name, key), ".0%" if share else form, 1 if share else factor)
    milliseconds = f"{scores['compute_ms']['mean']:.1f}" if "compute_ms" in scores else DASH
    return [name, scores["frames"], number(scores["coverage"], ".1%"),
            *cells("height", ("mean", "median", "percentile_95", "worst", "within_claimed_95"), 100, ".2f"),
            *cells("approach_angle", ("mean", "median", "percentile_95", "worst", "signed_mean", "within_claimed_95"),
                   1, ".3f"),
            *cells("pitch", ("percentile_95",), 1, ".3f"), *cells("roll", ("percentile_95",), 1, ".3f"),
            *cells("speed", ("percentile_95", "within_claimed_95"), 1, ".3f"), milliseconds]


def measure(options):
    """Measures the scores by preset and set. With only some sets (options.sets) they are printed and not kept."""
    sets = find_sets(options.data, options.sets)
    if not sets:
        raise SystemExit("no set to measure")
    results = {preset: {} for _, preset, _ in PRESETS}
    for name, source in sets:
        bag, truth = make_bag(name, source)
        for _, preset, evaluate_options in PRESETS:
            results[preset][name] = score(name, bag, truth, ROOT / f"config/{preset}.yaml", evaluate_options)
            print(preset, "|", " | ".join(map(str, row(name, results[preset][name]))), flush=True)
        os.remove(str(bag))
    if not options.sets:
        kept.keep("sets", results)


def render(results):
    parts = [TEXT]
    for title, preset, _ in PRESETS:
        parts.append(f"### {title} (`config/{preset}.yaml`)\n\n"
                     + table(HEADER, [row(name, scores) for name, scores in results[preset].items()]))
    return "\n".join(parts)
