import unittest
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader

from project import SOURCE_DIR


def load(name):
    """A program of scripts/ as a module."""
    loader = SourceFileLoader(name, str(SOURCE_DIR / "scripts" / name))
    module = module_from_spec(spec_from_loader(name, loader))
    loader.exec_module(module)
    return module


class AccuracyTest(unittest.TestCase):
    accuracy = load("accuracy")

    def test_row_has_heights_in_centimetres_and_angles_in_degrees(self):
        scores = {"frames": 120, "coverage": 0.9917, "compute_ms": {"mean": 3.14159}, "quantities": {
            "height": {"mean": 0.0012, "median": 0.001, "percentile_95": 0.003, "worst": 0.0045, "within_claimed_95": 0.96},
            "approach_angle": {"mean": 0.05, "median": 0.04, "percentile_95": 0.12, "worst": 0.2, "signed_mean": -0.01,
                               "within_claimed_95": 0.9}}}
        self.assertEqual(self.accuracy.row("lab", scores),
                         "| lab | 120 | 99.2% | 0.12 | 0.10 | 0.30 | 0.45 | 96% "
                         "| 0.050 | 0.040 | 0.120 | 0.200 | -0.010 | 90% | 3.1 |")

    def test_row_has_dashes_for_what_has_no_truth(self):
        line = self.accuracy.row("kitti_raw", {"frames": 30, "coverage": 0.5, "quantities": {
            "height": {"mean": 0.02, "median": 0.02, "percentile_95": 0.03, "worst": 0.04, "within_claimed_95": None}}})
        self.assertEqual(line, "| kitti_raw | 30 | 50.0% | 2.00 | 2.00 | 3.00 | 4.00 | – | – | – | – | – | – | – | – |")

    def test_header_and_rows_have_the_same_number_of_columns(self):
        line = self.accuracy.row("x", {"frames": 0, "coverage": None, "quantities": {}})
        self.assertTrue(all(part.count("|") == line.count("|") for part in self.accuracy.HEADER.strip().splitlines()))
