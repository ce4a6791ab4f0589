"""Sets, bags and runs of scripts/change_indicator. What is there already and made of the same things is not made again."""

import hashlib
import shutil
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import yaml

from .base_build import Unusable
from .indicator_summary import bag_errors, campaign_errors
from .programs import fingerprint, run_built
from .row_comparison import read_rows
from .sets import PRESETS

SNIPPETS = "snippets"
SNIPPET_HEIGHTS, SNIPPET_NOISE = (3, 10, 30), (1, 2, 5)
# Rendering them takes most of the time: 63 rows of the default preset, 18 of the others.
SNIPPET_SEEDS, SNIPPET_SEEDS_OF_OTHERS = 7, 2
PROBE = 0.5  # s of each configuration, to see whether the simulator changed
SIMULATOR = ("src/core/simulator", "include/uav_landing/simulator", "src/tools/simulation", "src/tools/bags")
STAGES = {"stereo_depth", "approach_angle", "kalman_height"}


class Side:
    """One of the two builds that are compared, with its presets."""

    def __init__(self, name, root, devel):
        self.name, self.root, self.devel = name, root, devel

    def program(self, name):
        return self.devel / "lib/uav_landing" / name

    def preset(self, name):
        return self.root / f"config/{name}.yaml"

    def presets(self):
        """Returns the names of the files that set parameters of the stages, the one without changes first."""
        files = sorted((self.root / "config").glob("*.yaml"), key=lambda file: (file.stem != "stereo", file.stem))
        return [file.stem for file in files if STAGES & set(yaml.safe_load(file.read_text(encoding="utf-8")) or {})]

    def sources(self, folders):
        return [file for folder in folders for file in files_below(self.root / folder)]

    def fingerprint(self, program, *files):
        return fingerprint(self.program(program), *files, devel=self.devel)


def invalid_too(preset):
    """Says whether errors of this preset count on all frames, as in docs/accuracy.md."""
    return any(name == preset and "--invalid-too" in options for _, name, options in PRESETS)


def files_below(folder):
    return sorted(file for file in folder.rglob("*") if file.is_file())


def digest(files):
    """Returns a digest of the contents of all these files."""
    total = hashlib.sha256()
    for file in files:
        with file.open("rb") as content:
            for block in iter(lambda: content.read(1 << 20), b""):
                total.update(block)
    return total.hexdigest()[:12]


def kept(path, make):
    """The file, made by make(path) when it is not there. It gets its name when it is complete, and both sides may make
    the same one at once."""
    if not path.exists():
        path.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=str(path.parent)) as folder:
            temporary = Path(folder) / path.name
            make(temporary)
            temporary.replace(path)
    return path


def is_dataset(folder):
    return all((folder / name).exists() for name in ("frames.csv", "left", "right", "left.yaml", "right.yaml"))


def find_sets(data, root):
    """Returns the sets by name, and what of the data folder is left out."""
    folders = sorted(folder for folder in data.iterdir() if folder.is_dir()) if data.is_dir() else []
    sets = [BagSet(folder.name, folder) for folder in folders if is_dataset(folder)]
    left_out = [folder.name for folder in folders if not is_dataset(folder)]
    sets += [BagSet(f"simulator/{file.stem}", file) for file in sorted((root / "config/simulator").glob("*.yaml"))]
    return [*sets, SnippetSet()], left_out


class BagSet:
    """A dataset folder or an approach of the simulator. Both sides read the same bag of it."""

    def __init__(self, name, source):
        self.name, self.source = name, source
        self.bag = self.truth = self.contents = self.ready = None

    def key(self, tree, work):
        """Returns a name for what the bag is made of."""
        if self.source.is_file():
            # Rendering takes minutes, and most changes of the core library do not touch the simulator.
            made_of = probe(tree, self.source, work) + digest([self.source, *tree.sources(SIMULATOR)])
        else:
            stats = [(str(file), file.stat().st_size, file.stat().st_mtime_ns) for file in files_below(self.source)]
            made_of = tree.fingerprint("dataset_to_bag") + str(stats)
        return hashlib.sha256(made_of.encode()).hexdigest()[:12]

    def prepare(self, jobs, tree, work):
        """Begins to make the bag with the tree's programs. Runs wait for it."""
        self.ready = jobs.submit(self._prepare, tree, work)

    def _prepare(self, tree, work):
        place = work / "bags" / self.name
        folder = place / self.key(tree, work)
        if not folder.exists():
            shutil.rmtree(str(place), ignore_errors=True)  # bags are large: only the newest is kept
            self._make(tree, folder)
        self.bag = folder / "input.bag"
        self.truth = folder / "frames.csv"
        self.contents = (folder / "digest").read_text(encoding="utf-8")

    def _make(self, tree, folder):
        part = folder.with_name(folder.name + ".part")
        part.mkdir(parents=True)
        bag = part / "input.bag"
        if self.source.is_dir():
            run_built(tree.devel, "dataset_to_bag", "--dataset", self.source, "--output", bag)
            shutil.copy(str(self.source / "frames.csv"), str(part))
        else:
            dataset = part / "dataset"
            run_built(tree.devel, "simulate_approach", "--config", self.source, "--output", bag, "--dataset", dataset)
            shutil.move(str(dataset / "frames.csv"), str(part))
            shutil.rmtree(str(dataset))
        (part / "digest").write_text(digest([bag]), encoding="utf-8")
        part.rename(folder)

    def tasks(self, side, preset, work):
        """Returns functions that each write a file of rows and return its name."""
        return [lambda: self._run(side, preset, work)]

    def _run(self, side, preset, work):
        self.ready.result()
        config = side.preset(preset)
        name = f"{preset}-{side.fingerprint('process_bag', config)}-{self.contents}.csv"
        return kept(work / "results" / self.name / name, lambda rows: run_built(
            side.devel, "process_bag", "--input", self.bag, "--config", config, "--csv", rows))

    def errors(self, files, _rows, preset):
        return bag_errors(files[0], self.truth, invalid_too(preset))


class SnippetSet:
    """Random snippets. simulate_campaign renders them itself, so each side has its own."""

    name = SNIPPETS

    def prepare(self, jobs, tree, work):
        """There is no bag."""

    def tasks(self, side, preset, work):
        return [lambda height=height: self._run(side, preset, work, height) for height in SNIPPET_HEIGHTS]

    @staticmethod
    def _run(side, preset, work, height):
        config = side.preset(preset)
        seeds = SNIPPET_SEEDS if preset == "stereo" else SNIPPET_SEEDS_OF_OTHERS
        name = f"{preset}-{height}-{seeds}-{side.fingerprint('simulate_campaign', config)}.csv"
        return kept(work / "results" / SNIPPETS / name, lambda rows: run_built(
            side.devel, "simulate_campaign", "snippets", "--csv", rows, "--config", config, "--first", 1, "--count", seeds,
            "--heights", height, "--noise", *SNIPPET_NOISE))

    @staticmethod
    def errors(_files, rows, preset):
        return campaign_errors(rows, invalid_too(preset))


class Jobs:
    """Runs programs beside each other, in the order in which they are submitted. After an error no other one begins."""

    def __init__(self, count):
        self.pool, self.futures = ThreadPoolExecutor(count), []

    def __enter__(self):
        return self

    def submit(self, task, *arguments):
        self.futures.append(self.pool.submit(task, *arguments))
        return self.futures[-1]

    def __exit__(self, error, *_):
        if error:
            for future in self.futures:
                future.cancel()
        self.pool.shutdown()


class Runs:
    """One side over all sets, with those presets that the side has."""

    def __init__(self, jobs, side, sets, presets, work):
        there = side.presets()
        self.futures = {(one.name, preset): [jobs.submit(task) for task in one.tasks(side, preset, work)]
                        for one in sets for preset in presets if preset in there}

    def __contains__(self, key):
        return key in self.futures

    def files(self, key):
        """Waits for the files of rows of a set and preset, and returns them."""
        return [future.result() for future in self.futures[key]]

    def rows(self, key):
        return [row for file in self.files(key) for row in read_rows(file)]


def probe(side, config, work):
    """Returns a digest of what a side's simulator renders first, or its message if it does not know the configuration."""
    name = f"{side.fingerprint('simulate_approach', config)}.txt"
    file = kept(work / "probes" / name, lambda text: text.write_text(render_probe(side, config, text.parent), encoding="utf-8"))
    return file.read_text(encoding="utf-8")


def render_probe(side, config, folder):
    try:
        run_built(side.devel, "simulate_approach", "--config", config, "--output", folder / "probe.bag", "--dataset",
                  folder / "dataset", "--duration", PROBE)
    except SystemExit as failure:
        return str(failure)
    return digest(files_below(folder / "dataset"))


def check_built(side):
    """Checks that every program that is needed has been built."""
    for name in ("process_bag", "simulate_approach", "simulate_campaign"):
        if not side.program(name).exists():
            raise Unusable(f"{side.program(name)} is missing")
