import re
import unittest

from project import DEVEL_DIR, SOURCE_DIR, run

SETUP = SOURCE_DIR / "scripts/setup"
# Neither to be in a computer in an aircraft: compilers, headers, what draws in a window.
UNWANTED = re.compile(r"^(g\+\+|gcc|cpp|clang|llvm)(-\d+)?$|-dev$|^(rviz|xvfb|python3-matplotlib)$")


def listed(*options):
    """Packages that scripts/setup would install."""
    return run([SETUP, *options, "--list"], check=True).stdout.split()


def installed_dependencies():
    """Packages that each installed package depends on: of alternatives the first that is installed."""
    text = run(["dpkg-query", "-W", "-f", "${Package}|${Provides}|${Pre-Depends}, ${Depends}\n"], check=True).stdout
    rows = [line.split("|", 2) for line in text.splitlines()]
    names = {}
    for name, provides, _ in rows:
        for provided in re.split(r"[ ,]+", re.sub(r"\([^)]*\)", "", provides)):
            names.setdefault(provided, name)
    names.update({name: name for name, _, _ in rows})
    dependencies = {}
    for name, _, text in rows:
        choices = [[re.split(r"[ :(]", choice.strip())[0] for choice in part.split("|")] for part in text.split(",")]
        found = [[names[choice] for choice in part if choice in names] for part in choices]
        dependencies[name] = {part[0] for part in found if part}
    return dependencies


def with_dependencies(packages, dependencies):
    found, new = set(), set(packages)
    while new:
        found |= new
        new = set().union(*(dependencies.get(name, set()) for name in new)) - found
    return found


def needed_libraries():
    """Files of the libraries that the built libraries and programs are linked with, by name."""
    files = [file for folder in (DEVEL_DIR / "lib", DEVEL_DIR / "lib/uav_landing") for file in folder.iterdir()
             if file.is_file() and not file.name.endswith(("_test", ".a", ".py")) and file.read_bytes()[:4] == b"\x7fELF"]
    text = run(["readelf", "--dynamic", "--wide", *files], check=True).stdout
    return set(re.findall(r"\(NEEDED\).*\[(.*)\]", text))


def owner(library, folder):
    """The package that a library of the system comes from."""
    files = [line.split(": ", 1) for line in run(["dpkg-query", "-S", f"{folder}/{library}"]).stdout.splitlines()]
    # dpkg-query finds all files that have this in their name, such as debug information.
    return next((packages.split(":")[0] for packages, file in files if file.endswith(f"lib/{folder}/{library}")), None)


class SetupTest(unittest.TestCase):
    def test_what_running_needs_is_part_of_what_everything_needs(self):
        self.assertLess(set(listed("--runtime")), set(listed()))

    def test_no_package_for_running_needs_a_compiler_or_a_window(self):
        runtime = with_dependencies(listed("--runtime"), installed_dependencies())
        self.assertIn("libopencv-core406", runtime)
        self.assertEqual(sorted(name for name in runtime if UNWANTED.search(name)), [])

    def test_all_libraries_that_the_programs_are_linked_with_are_there_for_running(self):
        runtime = with_dependencies(listed("--runtime"), installed_dependencies())
        folder = run(["gcc", "-print-multiarch"], check=True).stdout.strip()
        needed = {library for library in needed_libraries() if not library.startswith("libuav_landing_")}
        self.assertTrue(any(library.startswith("libroscpp.so") for library in needed), needed)
        owners = {library: owner(library, folder) for library in needed}
        self.assertEqual({library: package for library, package in owners.items() if package not in runtime}, {})

    def test_an_unknown_option_is_refused(self):
        result = run([SETUP, "--run-time"])
        self.assertEqual((result.returncode, result.stdout), (2, ""))
        self.assertEqual(result.stderr, "scripts/setup: no such option --run-time, there are --runtime and --list\n")
