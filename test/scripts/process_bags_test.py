import csv
import os
import shutil
import tempfile
import unittest
from pathlib import Path

from project import DEVEL_DIR, SOURCE_DIR, run
from stereo_bag import noise_frames, write_bag

PROCESS_BAGS = SOURCE_DIR / "scripts/process_bags"


class ProcessBagsTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.bags, self.output = Path(folder.name) / "in", Path(folder.name) / "out"
        self.bags.mkdir()

    def bag(self, name, frames=3):
        path = self.bags / name
        path.parent.mkdir(exist_ok=True)
        write_bag(path, noise_frames(frames))
        return path

    def process(self, *inputs, options=()):
        return run([PROCESS_BAGS, *inputs, "--output", self.output, *options])

    def rows(self):
        with open(self.output / "summary.csv", newline="") as file:
            return {row["bag"]: row for row in csv.DictReader(file)}

    def test_every_bag_of_a_folder_gets_estimates_and_a_row(self):
        self.bag("first.bag", 3)
        self.bag("rainy day/it's second.bag", 5)
        result = self.process(self.bags)
        self.assertEqual(result.returncode, 0, result.stderr)
        rows = self.rows()
        self.assertEqual({name: row["pairs"] for name, row in rows.items()}, {"first": "3", "rainy day/it's second": "5"})
        self.assertEqual(rows["first"]["valid_share"], "0.000")
        self.assertRegex(rows["first"]["reason"], r"^never valid: \w+ \d(, \w+ \d)*$")
        self.assertTrue((self.output / "rainy day/it's second.csv").exists())
        self.assertIn("2 bags, 0 failed", (self.output / "report.html").read_text())

    def test_a_bag_that_fails_is_named_with_its_reason_and_the_others_are_done(self):
        self.bag("good.bag")
        (self.bags / "broken.bag").write_bytes(b"no bag at all")
        result = self.process(self.bags)
        self.assertEqual(result.returncode, 1)
        self.assertIn("failed: broken: process_bag: ", result.stderr)
        self.assertIn("broken.bag", result.stderr)
        rows = self.rows()
        self.assertEqual((rows["broken"]["result"], rows["good"]["result"]), ("failed", "done"))
        self.assertIn("2 bags, 1 failed", (self.output / "report.html").read_text())

    def test_the_reason_is_the_message_and_not_the_list_below_it(self):
        frames = noise_frames(3)
        for frame in frames:
            frame.messages["right/image_raw"] = frame.messages["right/camera_info"] = None
        write_bag(self.bags / "one_camera.bag", frames)
        result = self.process(self.bags)
        self.assertEqual(result.returncode, 1)
        reason = (f"process_bag: {self.bags}/one_camera.bag: no topic /stereo/right/image_raw (sensor_msgs/Image); "
                  "no topic /stereo/right/camera_info (sensor_msgs/CameraInfo)")
        self.assertIn(f"failed: one_camera: {reason}\n", result.stderr)
        self.assertEqual(self.rows()["one_camera"]["reason"], reason)
        self.assertIn(f"<td>{reason}</td>", (self.output / "report.html").read_text())
        self.assertIn("  /stereo/left/image_raw", (self.output / "one_camera.log").read_text())

    def test_the_program_is_found_as_rosrun_finds_it(self):
        """In a clone that is not built, as in the source space of a catkin workspace."""
        clone = self.bags.parent / "src/uav_landing"
        for folder in ("scripts", "src/tools/evaluation"):
            shutil.copytree(str(SOURCE_DIR / folder), str(clone / folder))
        self.bag("first.bag")
        environment = {name: value for name, value in os.environ.items() if name != "UAV_LANDING_DEVEL_DIR"}

        def process(spaces):
            return run([clone / "scripts/process_bags", self.bags, "--output", self.output],
                       env=dict(environment, CMAKE_PREFIX_PATH=spaces))
        result = process("/usr")
        self.assertEqual(result.returncode, 1)
        self.assertIn("process_bag is missing (build first: scripts/build, or catkin_make", result.stderr)
        result = process(f"/nowhere:{DEVEL_DIR}:/usr")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(self.rows()["first"]["result"], "done")

    def test_what_is_done_is_not_done_again(self):
        self.bag("first.bag")
        self.assertEqual(self.process(self.bags).returncode, 0)
        before = (self.output / "first.csv").stat().st_mtime_ns
        self.bag("second.bag")
        result = self.process(self.bags)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("1 of 2 bags are done already", result.stdout)
        self.assertEqual((self.output / "first.csv").stat().st_mtime_ns, before)
        self.assertEqual(set(self.rows()), {"first", "second"})

    def test_a_bag_that_changed_is_done_again_and_leaves_no_old_estimates(self):
        bag = self.bag("first.bag")
        self.assertEqual(self.process(self.bags).returncode, 0)
        bag.write_bytes(b"now broken")
        later = (self.output / "first.csv").stat().st_mtime + 10
        os.utime(bag, (later, later))
        self.assertEqual(self.process(self.bags).returncode, 1)
        self.assertFalse((self.output / "first.csv").exists())

    def test_another_config_or_camera_is_not_taken_for_done(self):
        self.bag("first.bag")
        config = self.bags / "config.yaml"
        config.write_text("kalman_height: {max_age: 0.2}\n")
        for options in ([], ["--config", config], ["--camera", "rig"]):
            self.assertNotIn("done already", self.process(self.bags, options=options).stdout, options)
        self.assertEqual(self.process(self.bags, options=["--config", config]).returncode, 0)
        self.assertIn("1 of 1 bags are done already", self.process(self.bags, options=["--config", config]).stdout)
        before = config.stat().st_mtime
        config.write_text("kalman_height: {max_age: 0.25}\n")
        os.utime(config, (before, before))
        self.assertNotIn("done already", self.process(self.bags, options=["--config", config]).stdout)

    def test_truth_beside_the_bag_gives_errors(self):
        self.bag("first.bag")
        (self.bags / "first.frames.csv").write_text("stamp_s,left,right,pitch\n10,a,b,0\n")
        result = self.process(self.bags)
        self.assertEqual(result.returncode, 1)
        self.assertIn("first.frames.csv", result.stderr)
        (self.bags / "first.frames.csv").write_text("stamp_s,left,right,height_m\n10,a,b,5\n")
        result = self.process(self.bags)
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_hosts_are_those_of_the_list(self):
        self.bag("first.bag")
        hosts = self.bags / "hosts"
        hosts.write_text("1/:\n")
        result = self.process(self.bags, options=["--hosts", hosts])
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("\t:\t", (self.output / "jobs.log").read_text())

    def test_bags_are_spread_over_machines_by_ssh(self):
        """With a stand-in for ssh, which runs the command here and notes the machine; no $SHELL is set there."""
        ssh = self.bags / "ssh"
        ssh.write_text('#!/bin/sh\nwhile [ "${1#-}" != "$1" ]; do shift; done\n'
                       f'echo "$1" >>"{self.bags}/machines"\nshift\n[ "$1" != -- ] || shift\nunset SHELL\nexec sh -c "$*"\n')
        ssh.chmod(0o755)
        for name in ("first", "it's second"):
            self.bag(f"{name}.bag")
        (self.bags / "broken.bag").write_bytes(b"no bag at all")
        hosts = self.bags / "hosts"
        hosts.write_text("1/north\n1/south\n")
        result = run([PROCESS_BAGS, self.bags, "--output", self.output, "--hosts", hosts],
                     env=dict(os.environ, PARALLEL_SSH=str(ssh)))
        self.assertEqual(result.returncode, 1, result.stderr)
        self.assertIn("failed: broken: ", result.stderr)
        self.assertEqual({name: row["result"] for name, row in self.rows().items()},
                         {"first": "done", "it's second": "done", "broken": "failed"})
        machines = (self.bags / "machines").read_text().split()
        self.assertEqual(set(machines), {"north", "south"})
        self.assertIn("\tsouth\t", (self.output / "jobs.log").read_text())

    def test_an_interrupted_batch_goes_on_where_it_was(self):
        for name in ("a", "b", "c"):
            self.bag(f"{name}.bag")
        self.assertEqual(self.process(self.bags).returncode, 0)
        before = (self.output / "a.csv").stat().st_mtime_ns
        # As after a kill: one bag half done under its temporary name, one not begun.
        (self.output / "b.csv").rename(self.output / "b.csv.part")
        (self.output / "c.csv").unlink()
        result = self.process(self.bags)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("1 of 3 bags are done already", result.stdout)
        self.assertEqual((self.output / "a.csv").stat().st_mtime_ns, before)
        self.assertEqual({row["result"] for row in self.rows().values()}, {"done"})

    def test_parts_of_a_split_recording_are_one(self):
        frames = noise_frames(9)
        for number, part in enumerate((frames[:4], frames[4:6], frames[6:])):
            write_bag(self.bags / f"flight_{number}.bag", part, begin=1000 + number)
        write_bag(self.bags / "flight_7.bag", noise_frames(2), begin=1003)
        write_bag(self.bags / "other_0.bag", noise_frames(2))
        write_bag(self.bags / "other_1.bag", noise_frames(2), begin=5000)
        result = self.process(self.bags)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual({name: row["pairs"] for name, row in self.rows().items()},
                         {"flight_0": "9", "flight_7": "2", "other_0": "2", "other_1": "2"})
        self.assertIn("4 of 4 bags are done already", self.process(self.bags).stdout)

    def test_a_recording_that_was_not_closed_is_named(self):
        self.bag("good.bag")
        self.bag("late.bag.active")
        result = self.process(self.bags)
        self.assertEqual(result.returncode, 1)
        self.assertIn(f"failed: late.bag: process_bag: {self.bags}/late.bag.active: this recording was never closed", result.stderr)

    def test_a_bag_of_which_most_is_left_out_is_named(self):
        frames = noise_frames(5)
        for frame in frames[2:]:
            frame.messages["right/image_raw"] = None
        write_bag(self.bags / "one_eyed.bag", frames)
        result = self.process(self.bags)
        self.assertEqual(result.returncode, 3)
        reason = "process_bag: most of the recording was left out: 2 pairs of 5 left and 2 right images (exit status 3)"
        self.assertIn(f"left_out: one_eyed: {reason}", result.stderr)
        row = self.rows()["one_eyed"]
        self.assertEqual((row["result"], row["pairs"]), ("left_out", "2"))
        self.assertIn(reason, row["reason"])

    def test_bad_inputs_are_named(self):
        for inputs, complaint in (([self.bags / "none.bag"], "none.bag: no such file or folder"),
                                  ([self.bags], "no *.bag in this folder")):
            result = self.process(*inputs)
            self.assertEqual(result.returncode, 1)
            self.assertIn(complaint, result.stderr)
        one, two = self.bag("a/x.bag"), self.bag("b/x.bag")
        self.assertIn("would both be x.csv", self.process(one, two).stderr)
        self.assertIn("missing.yaml: no such file", self.process(one, options=["--config", "missing.yaml"]).stderr)
        self.assertEqual(run([PROCESS_BAGS]).returncode, 2)
