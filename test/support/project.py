"""Finds the project, its build and its built programs."""

import os
import subprocess
from pathlib import Path

SOURCE_DIR = Path(__file__).resolve().parents[2]
BUILD_DIR = Path(os.environ.get("UAV_LANDING_BUILD_DIR") or SOURCE_DIR / "build")
DEVEL_DIR = Path(os.environ.get("UAV_LANDING_DEVEL_DIR") or BUILD_DIR / "devel")


def run(command, **options):
    """Runs a command with a deadline; returns its CompletedProcess with stdout and stderr as text."""
    options.setdefault("timeout", 300)
    return subprocess.run([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          universal_newlines=True, **options)


def rosrun(program, *arguments, **options):
    """Runs a program of this package, as a user does."""
    return run(["rosrun", "uav_landing", program, *arguments], **options)
