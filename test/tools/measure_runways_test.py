"""measure_runways: the runway of a photograph with a known vanishing point, and what it says of unusable ones."""

import math
import shutil
import tempfile
import unittest
from pathlib import Path

import cv2
import numpy
from project import BUILD_DIR, run

PROGRAM = BUILD_DIR / "devel/lib/uav_landing/measure_runways"
HEADER = "image,focal_px,cx_px,cy_px,vp_u_px,vp_v_px"
FOCAL, CENTRE, HEIGHT = 800.0, (320.0, 180.0), 30.0


def photograph(heading_deg=3.0, runway=True):
    """Of a dark runway of 45 m by 1500 m with a white edge line, 300 m ahead, from a camera that looks down by 4 degrees."""
    pitch, heading = math.radians(4), math.radians(heading_deg)
    u, v = numpy.meshgrid(numpy.arange(640), numpy.arange(360))
    x, y = (u - CENTRE[0]) / FOCAL, (v - CENTRE[1]) / FOCAL
    down = y * math.cos(pitch) + math.sin(pitch)
    forward = math.cos(pitch) - y * math.sin(pitch)
    with numpy.errstate(divide="ignore", invalid="ignore"):
        along, right = HEIGHT * forward / down, HEIGHT * x / down
    on = along * math.cos(heading) + right * math.sin(heading)
    across = abs(right * math.cos(heading) - along * math.sin(heading))
    grey = numpy.where(down > 0, 120.0, 200.0)
    if runway:
        surface = (down > 0) & (on > 300) & (on < 1800)
        grey[surface & (across < 22.5)] = 60
        grey[surface & (across < 22.5) & (across > 20)] = 230
    grey += numpy.random.default_rng(1).normal(0, 2, grey.shape)
    direction = (math.sin(heading), -math.sin(pitch) * math.cos(heading), math.cos(pitch) * math.cos(heading))
    vanishing = [FOCAL * direction[i] / direction[2] + CENTRE[i] for i in range(2)]
    return cv2.GaussianBlur(numpy.clip(grey, 0, 255).astype(numpy.uint8), (0, 0), 0.7), vanishing


class MeasureRunwaysTest(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="uav_landing_runways_"))
        self.addCleanup(shutil.rmtree, str(self.folder))

    def write(self, image, u, v):
        cv2.imwrite(str(self.folder / "a.png"), image)
        (self.folder / "vanishing_points.csv").write_text(
            f"{HEADER}\na.png,{FOCAL},{CENTRE[0]},{CENTRE[1]},{u},{v}\n")

    def measure(self, *options):
        return run([PROGRAM, "--photos", self.folder, *options])

    def test_finds_the_runway(self):
        image, vanishing = photograph()
        self.write(image, *vanishing)
        for options in (["--draws", 5], ["--normal-unknown"]):
            result = self.measure(*options)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertRegex(result.stdout.splitlines()[-1], r"all  found 100.0 % of \d, of those more than 1 deg off 0.0 %")

    def test_says_that_another_direction_is_wrong(self):
        image, vanishing = photograph()
        self.write(image, vanishing[0] + 30, vanishing[1])  # 2 degrees
        self.assertIn("found 100.0 % of 5, of those more than 1 deg off 100.0 %", self.measure("--draws", 5).stdout)

    def test_finds_none_where_there_is_none(self):
        image, vanishing = photograph(runway=False)
        self.write(image, *vanishing)
        self.assertIn("found 0.0 % of 5", self.measure("--draws", 5).stdout)

    def test_names_what_cannot_be_used(self):
        self.assertIn("vanishing_points.csv", self.measure().stderr)
        (self.folder / "vanishing_points.csv").write_text(f"{HEADER}\nb.png,800,320,180,320,100\n")
        result = self.measure()
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr, r"line 2, column image: .*b.png is no image")
        image, _ = photograph()
        self.write(image, "", 100)
        result = self.measure()
        self.assertEqual(result.returncode, 1)
        self.assertRegex(result.stderr, r"line 2, column vp_u_px: a number is needed")

    def test_wrong_usage_has_exit_status_2(self):
        self.assertEqual(run([PROGRAM]).returncode, 2)
        self.assertEqual(self.measure("--draws", 0).returncode, 2)
