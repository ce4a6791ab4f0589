import json
import math
import os
import subprocess
import sys
import tempfile
import unittest
from importlib.machinery import SourceFileLoader
from pathlib import Path

from project import SOURCE_DIR, rosrun

PROGRAMS = {"uav_landing", "the paper, literally", "stereo_image_proc BM + plane", "stereo_image_proc SGBM + plane",
            "StereoBM alone", "image floor"}


class BenchmarkTest(unittest.TestCase):
    def test_measures_all_peers_on_every_sequence_and_the_picture_shows_them(self):
        with tempfile.TemporaryDirectory() as folder:
            numbers, picture = Path(folder) / "numbers.json", Path(folder) / "picture.png"
            result = rosrun("benchmark", "--widths", "160", "320", "--pairs", "6", "--json", numbers)
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
            measured = json.loads(numbers.read_text(encoding="utf-8"))
            self.assertEqual([(s["width"], s["height"]) for s in measured["sequences"]], [(160, 120), (320, 240)])
            for sequence in measured["sequences"]:
                self.assertEqual(set(sequence["programs"]), PROGRAMS)
                for times in sequence["programs"].values():
                    self.assertGreater(times["median"], 0)
                    self.assertLessEqual(times["median"], times["percentile_99"])
                    self.assertLessEqual(times["percentile_99"], times["worst"])
                self.assertIn("rectify", sequence["stages"])
                self.assertGreater(sequence["allocations"], sequence["image_allocations"])
                # Two images in 8 bit and two in float at least.
                self.assertGreater(sequence["peak_memory_mb"], 10 * sequence["width"] * sequence["height"] / 2**20)
                self.assertEqual(len(sequence["pairs_per_second"]), min(4, os.cpu_count()))
            small, large = (s["programs"]["uav_landing"]["median"] for s in measured["sequences"])
            self.assertAlmostEqual(measured["growth"], math.log(large / small) / math.log(4), delta=1e-3)
            subprocess.run([sys.executable, str(SOURCE_DIR / "benchmark/plot"), str(numbers), str(picture)], check=True)
            self.assertEqual(picture.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")

    def test_measures_pair_by_pair_from_the_first_one_on(self):
        with tempfile.TemporaryDirectory() as folder:
            numbers, scene = Path(folder) / "numbers.json", Path(folder) / "short.yaml"
            scene.write_text("image: {width: 160, height: 120}\nleft_camera: {fx: 138, fy: 138, cx: 79.5, cy: 59.5}\n"
                             "right_camera: {fx: 138, fy: 138, cx: 79.5, cy: 59.5}\npath: {duration: 0.4}\n",
                             encoding="utf-8")
            result = rosrun("benchmark", "--widths", "160", "--pairs", "4", "--searching", scene, "--json", numbers)
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
            self.assertIn("### Searching", result.stdout)
            (searching,) = json.loads(numbers.read_text(encoding="utf-8"))["searching"]
            self.assertEqual((searching["name"], searching["width"], searching["height"]), ("short", 160, 120))
            self.assertEqual(len(searching["pairs"]), 9)
            self.assertAlmostEqual(max(searching["pairs"]), searching["worst"], delta=1e-3)
            self.assertGreater(min(searching["pairs"]), 0)
            self.assertGreater(searching["steady"], 0)

    def test_picture_names_stages_of_a_tenth_of_some_sequence_only(self):
        plot = SourceFileLoader("benchmark_plot", str(SOURCE_DIR / "benchmark/plot")).load_module()
        small = {"stages": {"rectify": {"median": 0.1}, "ransac": {"median": 0.5}, "corners": {"median": 5.0}}}
        large = {"stages": {"rectify": {"median": 9.0}, "corners": {"median": 20.0}}}
        self.assertEqual(plot.large_stages([small, large]), ["corners", "rectify"])

    def test_refuses_a_dataset_that_is_not_there(self):
        result = rosrun("benchmark", "--widths", "160", "--pairs", "4", "--datasets", "/nowhere")
        self.assertEqual(result.returncode, 1)
        self.assertIn("/nowhere", result.stderr)


if __name__ == "__main__":
    unittest.main()
