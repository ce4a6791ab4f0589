"""Parameters that pages tell people to set exist, and take the values that are given there."""

import re
import unittest

import yaml

from project import SOURCE_DIR

# Those of bad_configurations.md are wrong on purpose, and migration.md names what is gone.
LEFT_OUT = ("bad_configurations.md", "migration.md", "mutation.md")


def documented():
    """Range or choices of each parameter, by section and name."""
    found, section = {}, None
    for line in (SOURCE_DIR / "docs/parameters.md").read_text(encoding="utf-8").splitlines():
        if line.startswith("## "):
            section = line[3:].strip("`")
        cells = [cell.strip() for cell in line.split(" | ")]
        if line.startswith("| `") and section != "Moved":
            found[section, cells[0].strip("| `")] = cells[2]
    return found


def given():
    """Page, section, name and value of all settings such as `rig: {readout_time: 0.03}`."""
    for page in [SOURCE_DIR / "README.md", *(SOURCE_DIR / "docs").glob("*.md")]:
        if page.name not in LEFT_OUT:
            text = page.read_text(encoding="utf-8")
            for snippet in re.findall(r"(?:`|^ *)([a-z_]+: \{[^`{}]*\})(?:`|$)", text, re.MULTILINE):
                for section, values in yaml.safe_load(snippet.replace("…", "''")).items():
                    for name, value in values.items():
                        yield page.name, section, name, value


class NamedParametersTest(unittest.TestCase):
    def test_parameters_exist_and_values_are_in_their_range(self):
        parameters, settings = documented(), list(given())
        self.assertGreater(len(parameters), 80)
        self.assertGreater(len(settings), 40)
        for page, section, name, value in settings:
            with self.subTest(page=page, parameter=f"{section}/{name}"):
                self.assertIn((section, name), parameters)
                limits = parameters[section, name]
                if value == "":
                    continue
                if re.search(r" to ", limits):
                    low, high = map(float, limits.split(" to "))
                    self.assertTrue(low <= float(value) <= high, f"{value} is not in {limits}")
                elif limits:
                    self.assertIn(str(value).lower(), limits.split(", "))


if __name__ == "__main__":
    unittest.main()
