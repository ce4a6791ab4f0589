"""Programs that are killed while they write leave nothing under the final names."""

import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

from project import BUILD_DIR, SOURCE_DIR
from stereo_bag import noise_frames, write_bag

sys.path.insert(0, str(SOURCE_DIR / "src/tools"))
from evaluation.pending_file import pending  # noqa: E402

PROGRAMS = BUILD_DIR / "devel/lib/uav_landing"
SCENE = SOURCE_DIR / "config/simulator/lab.yaml"


class InterruptedTest(unittest.TestCase):
    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="uav_landing_interrupted_"))
        self.addCleanup(shutil.rmtree, str(self.folder))

    def kill_while_writing(self, command, begun, outputs, number):
        """Starts the command, kills it when the file begun has come up, and looks for outputs."""
        process = subprocess.Popen([str(part) for part in command], stdout=subprocess.DEVNULL,
                                   stderr=subprocess.DEVNULL)
        try:
            deadline = time.monotonic() + 60
            while not begun.exists():
                self.assertIsNone(process.poll(), "done before it could be interrupted")
                self.assertLess(time.monotonic(), deadline)
            process.send_signal(number)
            self.assertEqual(process.wait(timeout=60), -number)
        finally:
            process.kill()
            process.wait()
        for output in outputs:
            self.assertFalse(output.exists(), f"{output.name} is there though not complete")

    def test_process_bag(self):
        bag, csv, out = self.folder / "in.bag", self.folder / "e.csv", self.folder / "out.bag"
        write_bag(bag, noise_frames(count=200))
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
            self.kill_while_writing([PROGRAMS / "process_bag", "--input", bag, "--csv", csv, "--output", out],
                                    self.folder / "out.bag.part", [csv, out], number)
            (self.folder / "out.bag.part").unlink()

    def test_simulate_approach(self):
        bag, dataset = self.folder / "x.bag", self.folder / "x"
        self.kill_while_writing([PROGRAMS / "simulate_approach", "--config", SCENE, "--output", bag,
                                 "--dataset", dataset], self.folder / "x.bag.active", [bag, dataset], signal.SIGKILL)

    def test_python_programs(self):
        path = self.folder / "page.html"
        with self.assertRaises(KeyboardInterrupt):
            with pending(path) as temporary:
                Path(temporary).write_text("half")
                raise KeyboardInterrupt
        self.assertEqual(list(self.folder.iterdir()), [])
        with pending(path) as temporary:
            self.assertTrue(temporary.endswith(".html"))
            Path(temporary).write_text("whole")
            self.assertFalse(path.exists())
        self.assertEqual([file.name for file in self.folder.iterdir()], ["page.html"])


if __name__ == "__main__":
    unittest.main()
