"""scripts/change_indicator: what counts as a difference, the summary, and that it names what a preset changes."""

import importlib.util
import io
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from contextlib import redirect_stdout
from importlib.machinery import SourceFileLoader
from pathlib import Path
from unittest import mock

from project import DEVEL_DIR, SOURCE_DIR, run

SCRIPT = SOURCE_DIR / "scripts/change_indicator"
sys.path.insert(0, str(SOURCE_DIR / "scripts"))
from measurement import base_build, columns, indicator_runs, indicator_summary, programs  # noqa: E402
from measurement.row_comparison import Comparison, read_rows  # noqa: E402


def load_script():
    loader = SourceFileLoader("change_indicator", str(SCRIPT))
    module = importlib.util.module_from_spec(importlib.util.spec_from_loader(loader.name, loader))
    loader.exec_module(module)
    return module


# Estimates as process_bag writes them, with few columns. The claimed standard deviation of the height is 0.1 m.
HEADER = "stamp_s,valid,height_m,height_stddev_m,pitch_deg,status,compute_ms,height_valid,angle_valid,approach_angle_deg," \
         "approach_angle_stddev_deg,reason"
ROWS = ("100.0,0,,,,searching,3.5,0,0,,,not_yet",
        "100.1,1,20,0.1,-5,tracking,3.6,1,1,3,0.05,",
        "100.2,1,19,0.1,-5,tracking,3.7,1,1,3,0.05,")


class TemporaryFolder(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="uav_landing_indicator_")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def table(self, *rows, header=HEADER):
        path = self.folder / "rows.csv"
        path.write_text("\n".join([header, *rows]) + "\n")
        return read_rows(path)


class ComparisonTest(TemporaryFolder):
    def compare(self, *rows):
        """With the rows above as those of the base."""
        return Comparison(self.table(*ROWS), self.table(*rows))

    def only_change(self, comparison):
        self.assertEqual(len(comparison.changes), 1, comparison.lines())
        return next(iter(comparison.changes.values()))

    def test_the_same_rows_are_no_difference(self):
        comparison = self.compare(*ROWS)
        self.assertTrue(comparison.same())
        self.assertEqual((comparison.title(), comparison.lines()), ("3 rows, no difference", []))

    def test_times_are_not_compared(self):
        self.assertTrue(self.compare(*ROWS[:2], ROWS[2].replace(",3.7,", ",99,")).same())

    def test_a_ten_millionth_of_a_standard_deviation_is_no_difference(self):
        self.assertTrue(self.compare(*ROWS[:2], ROWS[2].replace(",19,", ",19.00000001,")).same())

    def test_ten_millionths_of_a_standard_deviation_are_one(self):
        comparison = self.compare(*ROWS[:2], ROWS[2].replace(",19,", ",19.000001,"))
        self.assertFalse(comparison.same())
        self.assertAlmostEqual(self.only_change(comparison).size, 1e-5, 9)

    def test_the_worst_row_is_named_with_its_size_in_standard_deviations(self):
        comparison = self.compare(ROWS[0], ROWS[1].replace(",20,", ",20.01,"), ROWS[2].replace(",19,", ",18.98,"))
        change = self.only_change(comparison)
        self.assertEqual((change.column, change.rows, change.unit, change.where), ("height_m", 2, "sigma", "100.2"))
        self.assertAlmostEqual(change.size, 0.2)
        self.assertEqual(comparison.title(), "2 of 3 rows differ")
        self.assertEqual(comparison.lines(), ["height_m: 2 rows, worst 0.2 sigma at 100.2: 19 -> 18.98"])

    def test_columns_without_a_claim_are_compared_in_their_unit(self):
        change = self.only_change(self.compare(*ROWS[:2], ROWS[2].replace(",-5,", ",-5.002,")))
        self.assertEqual((change.column, change.unit), ("pitch_deg", "deg"))
        self.assertAlmostEqual(change.size, 0.002)
        self.assertTrue(self.compare(*ROWS[:2], ROWS[2].replace(",-5,", ",-5.000000001,")).same())
        self.assertFalse(self.compare(*ROWS[:2], ROWS[2].replace(",-5,", ",-5.00000001,")).same())

    def test_a_changed_claim_is_a_difference_of_its_own(self):
        change = self.only_change(self.compare(*ROWS[:2], ROWS[2].replace(",0.1,", ",0.11,")))
        self.assertEqual((change.column, change.unit), ("height_stddev_m", "m"))

    def test_blank_against_number_is_a_difference_of_its_own_kind(self):
        for text in ("", "nan"):
            comparison = self.compare(*ROWS[:2], ROWS[2].replace(",19,", f",{text},"))
            self.assertEqual(self.only_change(comparison).kind, "blank")
            self.assertEqual(comparison.lines(),
                             [f"height_m: blank against number in 1 rows, first at 100.2: 19 -> {text or 'blank'}"])
        self.assertTrue(self.compare(ROWS[0].replace(",,,,s", ",nan,,,s"), *ROWS[1:]).same(), "NaN is blank")

    def test_flags_that_flip_are_counted_each_way(self):
        comparison = self.compare(ROWS[0].replace("100.0,0", "100.0,1"), *(row.replace(",1,1,3,", ",1,0,3,") for row in ROWS[1:]))
        self.assertEqual({(change.column, change.kind): change.rows for change in comparison.changes.values()},
                         {("valid", "gained"): 1, ("angle_valid", "lost"): 2})
        self.assertEqual(comparison.lines(), ["valid: 0 -> 1 in 1 rows, first at 100.0",
                                              "angle_valid: 1 -> 0 in 2 rows, first at 100.1"])

    def test_text_is_compared_literally(self):
        change = self.only_change(self.compare(ROWS[0].replace("not_yet", "no_plane"), *ROWS[1:]))
        self.assertEqual((change.column, change.kind, change.before, change.after), ("reason", "text", "not_yet", "no_plane"))
        self.assertEqual(self.only_change(self.compare(*ROWS[:2], ROWS[2] + "rejected")).kind, "text")

    def test_missing_and_new_rows_are_named(self):
        comparison = self.compare(ROWS[0], ROWS[2], ROWS[2].replace("100.2", "100.3"))
        self.assertFalse(comparison.same())
        self.assertEqual((comparison.differing, comparison.compared), (0, 2))
        self.assertEqual(comparison.lines(), ["1 rows are no longer there, first 100.1", "1 rows are new, first 100.3"])
        self.assertFalse(Comparison(self.table(*ROWS), []).same())

    def test_missing_and_new_columns_are_named(self):
        other = self.table(*ROWS, header=HEADER.replace("pitch_deg", "tilt_deg"))
        comparison = Comparison(self.table(*ROWS), other)
        self.assertFalse(comparison.same())
        self.assertEqual(comparison.lines(), ["column pitch_deg is no longer there", "column tilt_deg is new"])

    def test_another_truth_of_a_snippet_says_that_the_simulator_changed(self):
        header = "seed,cell_height_m,noise,frame,height_true_m,height_m,height_stddev_m,runway_width_m"
        base = self.table("1,10,2,12,10.5,10.4,0.1,30", "1,10,5,12,10.5,10.4,0.1,30", header=header)
        comparison = Comparison(base, self.table("1,10,2,12,10.5,10.4,0.1,30", "1,10,5,12,10.6,10.4,0.1,31", header=header))
        self.assertFalse(comparison.same())
        self.assertEqual(len(comparison.lines()), 2)
        self.assertIn("height_true_m is drawn otherwise in 1 rows: the simulator changed", comparison.lines()[0])
        self.assertEqual(comparison.changes, {})

    def test_every_column_of_the_programs_has_a_role(self):
        """One that is neither known as text nor has a unit would be compared without a thought."""
        for source in ("offline/estimate_csv.cpp", "simulation/campaign_csv.cpp"):
            text = (SOURCE_DIR / "src/tools" / source).read_text().split("kHeader =")[1].split(";")[0]
            header = "".join(part for part in text.split('"')[1::2]).split(",")
            self.assertTrue(columns.key_columns(header), source)
            for column in columns.compared(header):
                self.assertTrue(column in columns.VERDICTS or columns.unit_of(column), column)


class SummaryTest(TemporaryFolder):
    def line(self, *rows, errors=None):
        return indicator_summary.line("lab", "stereo", self.table(*rows), errors or {}, False)

    def changed(self, *rows):
        """Fingerprints that are not those of the rows above."""
        old, new = self.line(*ROWS), self.line(*rows)
        return [name for name in indicator_summary.FINGERPRINTS if old[name] != new[name]]

    def test_a_line_has_counts_errors_and_claims(self):
        line = self.line(*ROWS, errors={"height": {"mean": 0.0123456, "percentile_95": 0.0345},
                                        "approach_angle": {"mean": 0.02, "percentile_95": 0.05}})
        self.assertEqual([line[name] for name in indicator_summary.HEADER[:12]],
                         ["lab", "stereo", "3", "2", "2", "2", "1.235", "3.45", "10", "0.02", "0.05", "0.05"])
        self.assertEqual(set(line), set(indicator_summary.HEADER))

    def test_without_truth_errors_are_blank(self):
        self.assertEqual(self.line(*ROWS)["height_mean_cm"], "")

    def test_the_last_bits_and_times_change_no_fingerprint(self):
        self.assertEqual(self.changed(*ROWS[:2], ROWS[2].replace(",19,", ",19.0000000001,").replace(",3.7,", ",9,")), [])
        self.assertEqual(self.changed(*ROWS[:2], ROWS[2].replace(",-5,", ",-5.00000000001,")), [])

    def test_each_group_of_columns_has_a_fingerprint_of_its_own(self):
        self.assertEqual(self.changed(*ROWS[:2], ROWS[2].replace(",19,", ",19.001,")), ["values"])
        self.assertEqual(self.changed(*ROWS[:2], ROWS[2].replace(",-5,", ",-5.0001,")), ["values"])
        self.assertEqual(self.changed(*ROWS[:2], ROWS[2].replace(",0.05,", ",0.0501,")), ["claims"])
        self.assertEqual(self.changed(ROWS[0].replace("not_yet", "no_plane"), *ROWS[1:]), ["verdicts"])
        self.assertEqual(self.changed(*ROWS[:2]), ["values", "claims", "verdicts"])

    def test_a_blank_is_no_number(self):
        self.assertEqual(self.changed(*ROWS[:2], ROWS[2].replace(",-5,", ",,")), ["values"])

    def test_what_is_written_is_read_again(self):
        path = self.folder / "summary.csv"
        line = self.line(*ROWS)
        path.write_text(indicator_summary.render([line], "a machine"))
        self.assertEqual(len(path.read_text().splitlines()), 3)
        self.assertEqual(indicator_summary.read(path), ("a machine", {("lab", "stereo"): line}))
        self.assertEqual(indicator_summary.read(self.folder / "none.csv"), ("", {}))

    def test_differences_name_set_preset_and_number(self):
        old, new = self.line(*ROWS), self.line(ROWS[0].replace("100.0,0", "100.0,1"), *ROWS[1:])
        texts = indicator_summary.differences({("lab", "stereo"): old}, {("lab", "stereo"): new}, True)
        self.assertEqual(texts, [f"lab, stereo: valid 2 -> 3; verdicts {old['verdicts']} -> {new['verdicts']}"])
        self.assertEqual(indicator_summary.differences({("lab", "stereo"): old}, {("lab", "stereo"): new}, False),
                         ["lab, stereo: valid 2 -> 3"])
        self.assertEqual(indicator_summary.differences({("lab", "stereo"): old}, {("lab", "stereo"): old}, True), [])
        self.assertEqual(indicator_summary.differences({}, {("lab", "stereo"): old}, True), ["lab, stereo: not in the summary"])

    def test_another_machine_is_held_to_the_numbers_and_to_one_per_cent_of_errors(self):
        old = self.line(*ROWS, errors={"height": {"mean": 0.02, "percentile_95": 0.05}})
        for mean, rows, same in ((0.02019, "3", True), (0.0203, "3", False), (0.02, "4", False)):
            new = {**old, "height_mean_cm": f"{100 * mean:.4g}", "rows": rows, "values": "another"}
            texts = indicator_summary.differences({("lab", "stereo"): old}, {("lab", "stereo"): new}, False)
            self.assertEqual(texts == [], same, texts)

    def test_errors_of_a_campaign_are_those_of_valid_rows(self):
        header = "seed,height_valid,height_true_m,height_m,angle_valid,approach_angle_true_deg,approach_angle_deg"
        rows = self.table("1,1,10,10.1,0,3,3.5", "2,1,10,9.7,0,3,", "3,0,10,99,0,3,3.1", header=header)
        errors = indicator_summary.campaign_errors(rows, False)
        self.assertAlmostEqual(errors["height"]["mean"], 0.2)
        self.assertNotIn("approach_angle", errors)
        self.assertAlmostEqual(indicator_summary.campaign_errors(rows, True)["approach_angle"]["mean"], 0.3)

    def test_the_committed_summary_has_every_preset_and_every_approach_of_the_simulator(self):
        _, lines = indicator_summary.read(SOURCE_DIR / "docs/change_indicator.csv")
        tree = indicator_runs.Side("this tree", SOURCE_DIR, DEVEL_DIR)
        names = [f"simulator/{file.stem}" for file in (SOURCE_DIR / "config/simulator").glob("*.yaml")]
        self.assertEqual(set(), {(name, preset) for name in [*names, "lab", "photo_town", "snippets"]
                                 for preset in tree.presets()} - set(lines))


class BaseTest(TemporaryFolder):
    def git(self, *arguments):
        subprocess.run(["git", "-C", str(self.folder), "-c", "user.name=a", "-c", "user.email=a@b.example", *arguments], check=True,
                       stdout=subprocess.DEVNULL)

    def test_a_commit_is_found_and_its_files_are_extracted(self):
        self.git("init", "-q")
        for text in ("old", "new"):
            (self.folder / "file").write_text(text)
            self.git("add", "file")
            self.git("commit", "-q", "-m", text)
        commit = base_build.find_commit(self.folder, "HEAD~1")
        self.assertRegex(commit, "^[0-9a-f]{40}$")
        base_build.extract(self.folder, commit, self.folder / "work/base")
        self.assertEqual((self.folder / "work/base/file").read_text(), "old")
        with self.assertRaisesRegex(base_build.Unusable, "--base moon: no such commit"):
            base_build.find_commit(self.folder, "moon")

    def test_a_folder_without_git_is_named(self):
        with mock.patch.dict(os.environ, {"GIT_CEILING_DIRECTORIES": str(self.folder.parent)}), \
                self.assertRaisesRegex(base_build.Unusable, "is not a git checkout"):
            base_build.find_commit(self.folder, "HEAD")

    def test_a_build_runs_with_its_own_libraries(self):
        program = self.folder / "lib/uav_landing/tell"
        program.parent.mkdir(parents=True)
        program.write_text("#!/bin/sh\necho $LD_LIBRARY_PATH\n")
        program.chmod(0o755)
        with mock.patch.dict(os.environ, {"LD_LIBRARY_PATH": "/another/build"}):
            self.assertEqual(programs.run_built(self.folder, "tell").strip(), f"{self.folder}/lib:/another/build")


class JobsTest(unittest.TestCase):
    def test_after_an_error_nothing_else_begins(self):
        begun = []
        with self.assertRaises(SystemExit), indicator_runs.Jobs(1) as jobs:
            first = jobs.submit(sys.exit, "wrong")
            for i in range(50):
                jobs.submit(lambda i=i: (begun.append(i), subprocess.run(["sleep", "0.02"], check=True)))
            first.result()
        self.assertLess(len(begun), 25)


class CommandLineTest(TemporaryFolder):
    def indicate(self, *options, **environment):
        return run([SCRIPT, "--no-build", *options], env={**os.environ, "UAV_LANDING_DATA": str(self.folder), **environment})

    def test_without_datasets_it_says_so(self):
        result = self.indicate("--sets", "lab")
        self.assertEqual(result.returncode, 1)
        self.assertIn(f"NO DATASETS in {self.folder}", result.stderr)
        self.assertIn("only the simulator's sets are run", result.stderr)
        self.assertRegex(result.stderr, "--sets: no lab; there are simulator/bent_rig, .*, snippets")

    def test_folders_that_are_no_datasets_are_named(self):
        (self.folder / "photos").mkdir()
        self.assertIn("left out: photos", self.indicate("--sets", "lab").stdout)

    def test_an_unknown_preset_is_refused_with_those_that_there_are(self):
        result = self.indicate("--presets", "moon")
        self.assertEqual(result.returncode, 1)
        self.assertIn("--presets: no moon; there are stereo, fast, paper", result.stderr)

    def test_a_base_that_does_not_exist_is_named(self):
        result = self.indicate("--base", "moon")
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr, "--base moon: no such commit|is not a git checkout")

    def test_a_missing_build_is_named(self):
        result = self.indicate(UAV_LANDING_DEVEL_DIR=str(self.folder))
        self.assertEqual(result.returncode, 1)
        self.assertIn(f"{self.folder}/lib/uav_landing/process_bag is missing (build first", result.stderr)


class CheckTest(TemporaryFolder):
    """What is done with the summary."""

    def setUp(self):
        super().setUp()
        self.script = load_script()
        self.tree = indicator_runs.Side("this tree", SOURCE_DIR, DEVEL_DIR)
        self.summary = self.folder / "summary.csv"
        patch = mock.patch.object(self.script, "SUMMARY", self.summary)
        patch.start()
        self.addCleanup(patch.stop)

    def lines(self, *rows, presets=("stereo",)):
        table = self.table(*rows)
        return {("lab", preset): indicator_summary.line("lab", preset, table, {}, False) for preset in presets}

    def renew(self, lines, whole=True):
        with redirect_stdout(io.StringIO()) as text:
            self.script.renew(lines, self.tree, whole)
        return text.getvalue()

    def check(self, lines, base=None, whole=True, differing=0):
        """Exit status, what is said, and whether rows were compared."""
        against_base = mock.Mock(return_value=differing)
        with redirect_stdout(io.StringIO()) as text:
            status = self.script.check(mock.Mock(base=base), lines, whole, self.tree, against_base)
        return status, text.getvalue(), against_base.called

    def test_status_is_0_when_the_summary_is_what_the_tree_gives(self):
        self.renew(self.lines(*ROWS))
        self.assertEqual(self.check(self.lines(*ROWS)), (0, "the summary is as committed (1 lines)\n", False))
        self.assertEqual(self.check(self.lines(*ROWS), base="main")[::2], (0, True))

    def test_status_is_1_when_it_is_not_and_rows_are_compared(self):
        self.renew(self.lines(*ROWS))
        status, text, compared = self.check(self.lines(*ROWS[1:]))
        self.assertEqual((status, compared), (1, True))
        self.assertIn("summary: lab, stereo: rows 3 -> 2; ", text)

    def test_status_is_1_when_rows_differ_from_the_base(self):
        self.renew(self.lines(*ROWS))
        self.assertEqual(self.check(self.lines(*ROWS), base="main", differing=1)[0], 1)

    def test_a_set_that_is_not_there_any_more_is_a_difference_of_a_whole_run_only(self):
        self.renew(self.lines(*ROWS, presets=("stereo", "fast")))
        status, text, _ = self.check(self.lines(*ROWS))
        self.assertEqual(status, 1)
        self.assertIn("lab, fast: in the summary, but there is no such set or preset here", text)
        self.assertEqual(self.check(self.lines(*ROWS), whole=False)[0], 0)
        self.assertIn("dropped: lab, fast", self.renew(self.lines(*ROWS)))

    def test_a_partial_run_leaves_the_summary_alone(self):
        self.assertIn("the summary is not renewed", self.renew(self.lines(*ROWS), whole=False))
        self.assertFalse(self.summary.exists())
        with self.assertRaisesRegex(base_build.Unusable, "summary.csv is not there yet"):
            self.check(self.lines(*ROWS))


class SmallRunTest(TemporaryFolder):
    """The laboratory, 1.5 s of it, with a side whose preset has another parameter."""

    def setUp(self):
        super().setUp()
        config = self.folder / "config"
        shutil.copytree(str(SOURCE_DIR / "config"), str(config))
        (config / "stereo.yaml").write_text("kalman_height: {rig_watch: false}\n")
        (config / "simulator/lab.yaml").write_text(
            (config / "simulator/lab.yaml").read_text().replace("duration: 12", "duration: 1.5"))
        self.script = load_script()
        self.tree = indicator_runs.Side("this tree", SOURCE_DIR, DEVEL_DIR)
        self.base = indicator_runs.Side("base", self.folder, DEVEL_DIR)
        self.set = indicator_runs.BagSet("simulator/lab", config / "simulator/lab.yaml")
        self.work = self.folder / "work"

    def compare(self):
        options = mock.Mock(all=True)
        with indicator_runs.Jobs(2) as jobs, redirect_stdout(io.StringIO()) as text:
            self.set.prepare(jobs, self.tree, self.work)
            sides = [indicator_runs.Runs(jobs, side, [self.set], ["stereo", "fast"], self.work) for side in (self.tree, self.base)]
            differing = self.script.compare([self.set], ["stereo", "fast"], *sides, options)
        return differing, text.getvalue(), sides[0]

    def test_set_column_and_worst_row_are_named_for_the_preset_that_changed(self):
        differing, text, runs = self.compare()
        self.assertEqual(differing, 1)
        self.assertRegex(text, r"simulator/lab, stereo: \d+ of 16 rows differ\n")
        self.assertRegex(text, r"\n    height_stddev_m: \d+ rows, worst \S+ m at 10\d\.\d+: \S+ -> \S+\n")
        self.assertIn("simulator/lab, fast: 16 rows, no difference\n", text)
        self.assertIn("1 of 2 runs differ", text)

        files = runs.files(("simulator/lab", "stereo"))
        errors = self.set.errors(files, runs.rows(("simulator/lab", "stereo")), "stereo")
        self.assertLess(errors["height"]["mean"], 0.005)

        times = [file.stat().st_mtime_ns for file in (self.set.bag, *files)]
        self.assertEqual(self.compare()[:2], (1, text))
        self.assertEqual([file.stat().st_mtime_ns for file in (self.set.bag, *files)], times, "nothing is made again")

    def test_a_simulator_that_renders_otherwise_is_noticed(self):
        with redirect_stdout(io.StringIO()) as text, indicator_runs.Jobs(2) as jobs, \
                mock.patch.object(self.script, "WORK", self.work):
            self.script.simulator_changes(jobs, self.tree, self.base, [self.set])
            self.assertEqual(text.getvalue(), "")
            with mock.patch.object(indicator_runs, "probe", lambda side, *_: side.name):
                self.script.simulator_changes(jobs, self.tree, self.base, [self.set])
        self.assertIn("the simulator itself changed (simulator/lab)", text.getvalue())
