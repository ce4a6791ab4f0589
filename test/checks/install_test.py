import os
import shutil
import tempfile
import unittest
from pathlib import Path

from project import BUILD_DIR, SOURCE_DIR, run


def configured_prefix():
    for line in (BUILD_DIR / "CMakeCache.txt").read_text().splitlines():
        if line.startswith("CMAKE_INSTALL_PREFIX:"):
            return Path(line.split("=", 1)[1])
    raise AssertionError("no CMAKE_INSTALL_PREFIX in CMakeCache.txt")


class InstallTest(unittest.TestCase):
    """The install space, made from the build tree in a temporary folder, works on its own."""

    @classmethod
    def setUpClass(cls):
        root = Path(tempfile.mkdtemp(prefix="uav_landing_install_"))
        cls.addClassCleanup(shutil.rmtree, str(root))
        # Not by --prefix: catkin's own files would still go to the configured one, which only root may write.
        run(["cmake", "--install", BUILD_DIR], check=True, env=dict(os.environ, DESTDIR=str(root)))
        cls.prefix = root / configured_prefix().relative_to("/")
        cls.environment = dict(os.environ)
        # As in a fresh shell with only this install space: neither the checkout nor the development space is on a path.
        for variable in ("CMAKE_PREFIX_PATH", "ROS_PACKAGE_PATH", "LD_LIBRARY_PATH", "PYTHONPATH", "PKG_CONFIG_PATH"):
            cls.environment.pop(variable, None)
        cls.environment["ROS_PACKAGE_PATH"] = os.pathsep.join([str(cls.prefix / "share"), "/opt/ros/share", "/usr/share"])
        cls.environment["CMAKE_PREFIX_PATH"] = str(cls.prefix)
        cls.environment["LD_LIBRARY_PATH"] = str(cls.prefix / "lib")
        cls.environment["PYTHONPATH"] = str(cls.prefix / "lib/python3/dist-packages")

    def run_installed(self, *command):
        return run(command, env=self.environment, cwd=str(self.prefix))

    def test_rospack_finds_the_installed_package(self):
        result = self.run_installed("rospack", "find", "uav_landing")
        self.assertEqual(result.stdout.strip(), str(self.prefix / "share/uav_landing"), result.stderr)

    def test_launch_file_resolves(self):
        result = self.run_installed("roslaunch", "--files", "uav_landing", "stereo.launch")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(result.stdout.split()[-1], str(self.prefix / "share/uav_landing/launch/stereo.launch"))

    def test_programs_start(self):
        for program in ("process_bag", "dataset_to_bag", "simulate_approach", "simulate_campaign", "evaluate",
                        "convert_recording", "split_images"):
            with self.subTest(program=program):
                result = self.run_installed("rosrun", "uav_landing", program, "--help")
                self.assertEqual(result.returncode, 0, result.stdout + result.stderr)
                self.assertIn("usage", (result.stdout + result.stderr).lower())

    def test_every_nodelet_loads_from_the_install_space(self):
        library = self.prefix / "lib/libuav_landing_nodelets.so"
        self.assertTrue(library.is_file())
        result = self.run_installed("ldd", library)
        self.assertNotIn("not found", result.stdout)
        self.assertIn(str(self.prefix / "lib/libuav_landing_core.so"), result.stdout)

    def test_configurations_and_layout_are_installed(self):
        for folder in ("config", "launch", "rviz"):
            for path in (SOURCE_DIR / folder).rglob("*.*"):
                with self.subTest(file=str(path)):
                    self.assertTrue((self.prefix / "share/uav_landing" / path.relative_to(SOURCE_DIR)).is_file())
