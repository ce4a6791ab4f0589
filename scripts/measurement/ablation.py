"""Section `ablation`: each improvement over the paper switched off in turn."""

import os
from concurrent.futures import ThreadPoolExecutor

import cv2
import numpy as np
import rosbag
import yaml

from . import kept
from .markdown import number, table
from .programs import ROOT, WORK, fingerprint, run
from .sets import find_sets, make_bag, quantity, score

SETS = ("lab", "fg_noon", "kitti_road", "simulator/full_scale", "simulator/bent_rig")
# Photographed scenery. Nobody may publish it, so its rows are printed and kept, but stay off the page.
UNPUBLISHED = ("photo_town", "photo_valley", "photo_sea")
# What parts may be worth something for and those sets do not have: title, file in config/simulator, what is changed in it, and the quality
# of JPEG images where they are such.
CONDITIONS = (
    ("noise of 5 grey levels", "demo.yaml", {"image": {"noise": 5}}, None),
    ("noise of 8 grey levels", "demo.yaml", {"image": {"noise": 8}}, None),
    ("JPEG images of quality 60", "demo.yaml", {}, 60),
    ("ground that bends", "scenes/sloped.yaml", {"path": {"duration": 14, "start_height": 25}}, None),
    ("a dark night", "scenes/night.yaml", {"path": {"duration": 12}}, None),
    ("from 200 m", "scenes/far.yaml", {}, None),
)
# what is changed: title and values by section
VARIANTS = (
    ("all as by default", {}),
    ("upright windows, parabola (`warp_window`)", {"stereo_depth": {"warp_window": False}}),
    ("plain squared differences (`matching_cost: ssd`)", {"stereo_depth": {"matching_cost": "ssd"}}),
    ("no photometric refinement of the plane (`direct_refinement`)", {"stereo_depth": {"direct_refinement": False}}),
    ("rows as rectification leaves them (`vertical_disparities`)", {"stereo_depth": {"vertical_disparities": False}}),
    ("flat surface ahead (`surface_curvature`)", {"stereo_depth": {"surface_curvature": False}}),
    ("no rig watch (`rig_watch`)", {"kalman_height": {"rig_watch": False}}),
    ("lines by the probabilistic Hough transform (`hough_method`)", {"approach_angle": {"hough_method": "probabilistic"}}),
    ("lines as Hough gives them (`refine_lines`)", {"approach_angle": {"refine_lines": False}}),
    ("sides of narrow stripes as blur shows them (`stripe_centres`)", {"approach_angle": {"stripe_centres": False}}),
    ("plane without the vanishing point (`fuse_vanishing_point`)", {"kalman_height": {"fuse_vanishing_point": False}}),
    ("plane without the motion's normal (`fuse_motion_normal`)", {"kalman_height": {"fuse_motion_normal": False}}),
    ("angle's normal from the vanishing points alone (`normal_source`)",
     {"approach_angle": {"normal_source": "vanishing_line"}}),
    ("focus of expansion by the paper's vote (`foe_method`)", {"approach_angle": {"foe_method": "sliding_window"}}),
    ("the same with rotation in it (`remove_rotation`)",
     {"approach_angle": {"foe_method": "sliding_window", "remove_rotation": False}}),
    ("angle by the paper's eq (1) (`angle_formula: eq1`)", {"approach_angle": {"angle_formula": "eq1"}}),
    ("angle of one step (`angle_window: 0`)", {"approach_angle": {"angle_window": 0}}),
    ("angle of the chord, late (`angle_smoothing: chord`)", {"approach_angle": {"angle_smoothing": "chord"}}),
    ("height filter without the sink rate (`use_motion`)", {"kalman_height": {"use_motion": False}}),
    ("pitch and roll of each pair alone (`average_attitude`)", {"kalman_height": {"average_attitude": False}}),
    ("height without the runway's width (`fuse_width_height`)", {"kalman_height": {"fuse_width_height": False}}),
    ("height averaged over points (`height_source`)", {"kalman_height": {"height_source": "points"}}),
    ("whatever the tests of integrity say (`integrity_monitor`)", {"kalman_height": {"integrity_monitor": False}}),
    ("angle without stereo (`use_stereo`)", {"approach_angle": {"use_stereo": False}}),
)
PAPER = "the paper's choices, also on frames that are not valid"
HEADER = ("changed", "coverage", "height, cm: 95 %", "angle, °: mean", "95 %", "pitch, °: 95 %", "roll, °: 95 %", "yaw, °: 95 %",
          "lateral, m: 95 %")
TEXT = """One improvement over the paper is switched off at a time, by the parameter in brackets. Scored as above, on the frames that are valid.

What makes a number worse was worth having on that set. What changes nothing there earns its place elsewhere. The rig watch and the
motion's normal help on a rig that has turned (`simulator/bent_rig`). The runway's width helps where stereo is out, the tests of
integrity under faults ([integrity](integrity.md)). A variant with fewer valid frames shows easier ones.
"""


def known_parameters():
    """Returns the names of all parameters of the build, as section/name."""
    names, section = set(), ""
    for line in run("process_bag", "--list-parameters").splitlines():
        if line.startswith("## "):
            section = line.strip("# `").split()[0].strip("`")
        elif line.startswith("| `"):
            names.add(f"{section}/{line.split('`')[1]}")
    return names


def variants():
    """Yields the variants whose parameters this build has."""
    known = known_parameters()
    for title, changes in VARIANTS:
        missing = [f"{section}/{name}" for section, values in changes.items() for name in values
                   if f"{section}/{name}" not in known]
        if missing:
            print(f"no parameter {', '.join(missing)}: '{title}' is left out")
        else:
            yield title, changes


def config_of(changes, number_of_variant):
    """Writes a config file: the default preset with these changes."""
    config = yaml.safe_load((ROOT / "config/stereo.yaml").read_text(encoding="utf-8")) or {}
    for section, values in changes.items():
        config[section] = {**(config.get(section) or {}), **values}
    path = WORK / "ablation" / f"variant_{number_of_variant}.yaml"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(yaml.safe_dump(config), encoding="utf-8")
    return path


def row(title, scores):
    return [title, number(scores["coverage"], ".1%"), number(quantity(scores, "height", "percentile_95"), ".2f", 100),
            number(quantity(scores, "approach_angle", "mean"), ".3f"),
            *(number(quantity(scores, name, "percentile_95"), ".3f") for name in ("approach_angle", "pitch", "roll", "yaw", "y"))]


def compress(bag, quality):
    """Puts the bag's images through a JPEG encoder and back."""
    compressed = bag.with_suffix(".compressed.bag")
    with rosbag.Bag(str(bag)) as source, rosbag.Bag(str(compressed), "w") as result:
        for topic, message, stamp in source.read_messages():
            if message._type == "sensor_msgs/Image":
                pixels = np.frombuffer(message.data, np.uint8).reshape(message.height, message.width)
                _, data = cv2.imencode(".jpg", pixels, [cv2.IMWRITE_JPEG_QUALITY, quality])
                message.data = cv2.imdecode(data, cv2.IMREAD_GRAYSCALE).tobytes()
            result.write(topic, message, stamp)
    os.replace(str(compressed), str(bag))


def make_condition(title, file, changes, quality):
    """Makes the bag of one of CONDITIONS and returns name, bag and truth."""
    name = "conditions/" + title.replace(" ", "_")
    config = yaml.safe_load((ROOT / "config/simulator" / file).read_text(encoding="utf-8"))
    for section, values in changes.items():
        config[section] = {**(config.get(section) or {}), **values}
    path = WORK / "ablation" / f"{title.replace(' ', '_')}.yaml"
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(yaml.safe_dump(config), encoding="utf-8")
    bag, truth = make_bag(name, path)
    if quality:
        compress(bag, quality)
    return name, bag, truth


def inputs(data):
    """Returns for all inputs the title and a function that makes name, bag and truth."""
    for name, source in find_sets(data, SETS):
        yield f"`{name}`", lambda name=name, source=source: (name, *make_bag(name, source))
    for name in UNPUBLISHED:
        if (data / name).is_dir():
            yield name, lambda name=name: (name, *make_bag(name, data / name))
    for condition in CONDITIONS:
        yield condition[0][0].upper() + condition[0][1:], lambda condition=condition: make_condition(*condition)


def measure(options):
    runs = [(title, config_of(changes, i), ()) for i, (title, changes) in enumerate(variants())]
    runs.append((PAPER, ROOT / "config/paper.yaml", ("--invalid-too",)))
    library = fingerprint()
    before = kept.recall("ablation")
    results = before[1]["rows"] if before and before[1]["library"] == library else {}
    for heading, make in inputs(options.data):
        if heading in results:
            continue
        name, bag, truth = make()

        def one(variant):
            title, config, evaluate_options = variant
            scores = score(name, bag, truth, config, evaluate_options)
            print(name, "|", " | ".join(map(str, row(title, scores))), flush=True)
            return [title, scores]

        with ThreadPoolExecutor(options.jobs) as pool:
            results[heading] = list(pool.map(one, runs))
        os.remove(str(bag))
        kept.keep("ablation", {"library": library, "rows": results})


def render(results):
    return TEXT + "".join(f"\n### {heading}\n\n" + table(HEADER, [row(*entry) for entry in entries])
                          for heading, entries in results["rows"].items() if heading not in UNPUBLISHED)
