import os
import tempfile
import unittest
from pathlib import Path

from project import SOURCE_DIR, run


class ForeignPythonTest(unittest.TestCase):
    def test_the_package_configures_where_another_python_comes_first(self):
        """As with pyenv: one without the system's modules, PYTHON_EXECUTABLE being the system's."""
        with tempfile.TemporaryDirectory() as folder:
            programs = Path(folder) / "bin"
            programs.mkdir()
            for name in ("python", "python3", "python3.11"):
                (programs / name).write_text('#!/bin/sh\nexec /usr/bin/python3 -S "$@"\n')
                (programs / name).chmod(0o755)
            result = run(["cmake", "-S", SOURCE_DIR, "-B", Path(folder) / "build", "-DPYTHON_EXECUTABLE=/usr/bin/python3",
                          "-DCATKIN_ENABLE_TESTING=OFF"], env=dict(os.environ, PATH=f"{programs}:{os.environ['PATH']}"))
        self.assertEqual(result.returncode, 0, result.stderr)
