"""What running the stages of a Dockerfile needs of this machine. Each thing that is missing is one line for the user."""

import fnmatch
import os
import shutil
import subprocess
from pathlib import Path

from .rooms import Failed, ignored

ARCHITECTURES = ("amd64", "arm64", "armel", "armhf", "i386", "mips64el", "mipsel", "ppc64el", "s390x")
PROGRAMS = {"mmdebstrap": "mmdebstrap", "unshare": "util-linux", "chroot": "coreutils"}
NEEDED_GB = 6
MARKER = ".test_container"  # in a folder of stages, which may be removed


def check_programs():
    if os.geteuid() != 0:
        raise Failed("needs root for chroot: sudo scripts/test_container")
    for program, package in PROGRAMS.items():
        if not shutil.which(program):
            raise Failed(f"{program} is missing: apt-get install {package}")
    if not shutil.which("dpkg"):
        raise Failed("dpkg is missing: run this on Debian or Ubuntu")
    architecture = subprocess.run(["dpkg", "--print-architecture"], stdout=subprocess.PIPE, universal_newlines=True,
                                  check=True).stdout.strip()
    if architecture not in ARCHITECTURES:
        raise Failed(f"Debian 12 has no packages for this machine's {architecture}: run this on one of {', '.join(ARCHITECTURES)}")


def check_cache(folder):
    if folder is not None and not folder.is_dir():
        raise Failed(f"--ccache {folder}: there is no such folder; ccache -k cache_dir prints yours")


def check_work(work, context):
    """Nothing of somebody else's is removed, and no stage copies all stages into itself."""
    if work.exists() and not (work.is_dir() and ((work / MARKER).is_file() or not any(work.iterdir()))):
        raise Failed(f"--work {work}: is not from test_container and would be removed; give a new folder")
    within = work.parts[len(context.parts):] if context in [work, *work.parents] else None
    if within is not None and not any(fnmatch.fnmatch(name, pattern) for name in within[:1] for pattern in ignored(context)):
        raise Failed(f"--work {work}: would be copied into itself; give a folder outside of {context}")


def remove(work):
    """Removes the stages. What is mounted below them stays as it is."""
    subprocess.run(["rm", "-rf", "--one-file-system", str(work)], check=True)


def clear(work):
    """Makes an empty folder for the stages, on a disk where they fit."""
    remove(work)
    work.mkdir(parents=True)
    Path(work, MARKER).touch()
    free = shutil.disk_usage(str(work)).free / 1e9
    if free < NEEDED_GB:
        raise Failed(f"--work {work}: {free:.1f} GB are free there, {NEEDED_GB} GB are needed; give a folder on another disk")
