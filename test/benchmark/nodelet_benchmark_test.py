#!/usr/bin/python3
"""The nodelets' benchmark: what it writes, and that no image is copied or allocated on the way through the nodelets."""

import json
import tempfile
import unittest
from pathlib import Path

import rostest
from project import rosrun

WIDTH, HEIGHT = 640, 480  # so large that lists of corners are no images


class NodeletBenchmarkTest(unittest.TestCase):
    def test_no_image_is_copied_or_allocated_between_the_nodelets(self):
        with tempfile.TemporaryDirectory() as folder:
            numbers = Path(folder) / "numbers.json"
            result = rosrun("nodelet_benchmark", "--width", str(WIDTH), "--pairs", "54", "--idle", "1", "--json",
                            str(numbers), timeout=180)
            self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
            measured = json.loads(numbers.read_text(encoding="utf-8"))
        nodelets, chain = measured["nodelets"], measured["chain"]
        for way in (nodelets, chain):
            self.assertGreater(way["median"], 0)
            self.assertLessEqual(way["median"], way["percentile_99"])
            self.assertLessEqual(way["percentile_99"], way["worst"])
            self.assertGreater(way["copied_bytes"], WIDTH * HEIGHT, "the chain itself copies images")
        # Of all pairs together less than one: a single image too many in every pair would be 1.
        self.assertLess(nodelets["copied_bytes"] - chain["copied_bytes"], WIDTH * HEIGHT / 2)
        self.assertLess(nodelets["image_allocations"] - chain["image_allocations"], 0.5)
        self.assertGreater(measured["idle_cpu_share"], 0)
        self.assertEqual(measured["pairs"], 54)
        self.assertIn(measured["late_pairs"], range(55))

    def test_refuses_a_dataset_that_is_not_there(self):
        result = rosrun("nodelet_benchmark", "--dataset", "/nowhere")
        self.assertEqual(result.returncode, 1)
        self.assertIn("/nowhere", result.stderr)


if __name__ == "__main__":
    rostest.rosrun("uav_landing", "nodelet_benchmark", NodeletBenchmarkTest)
