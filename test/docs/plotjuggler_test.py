import unittest
import xml.etree.ElementTree as ElementTree

from project import SOURCE_DIR
from uav_landing.msg import LandingEstimate


class PlotjugglerTest(unittest.TestCase):
    def test_curves_are_fields_of_the_estimate(self):
        layout = ElementTree.parse(str(SOURCE_DIR / "config/plotjuggler.xml"))
        curves = [curve.get("name") for curve in layout.iter("curve")]
        self.assertGreaterEqual(len(curves), 10)
        for curve in curves:
            topic, field = curve.rsplit("/", 1)
            self.assertIn(topic, ("/uav_landing/landing_estimate", "/truth/landing_estimate"))
            self.assertIn(field, LandingEstimate.__slots__)
