"""Runs other programs, and says what is missing to run them."""

import os
import shutil
import subprocess

PACKAGES = {"aarch64-linux-gnu-g++": "g++-aarch64-linux-gnu", "aarch64-linux-gnu-objdump": "binutils-aarch64-linux-gnu",
            "qemu-aarch64": "qemu-user", "cmake": "cmake", "gcc": "gcc"}


class Unusable(Exception):
    """What cannot be done, in words for the user."""


def check_machine():
    """Raises what keeps this machine from testing for arm64: another kind of computer, or missing programs."""
    if not shutil.which("dpkg"):
        raise Unusable("there is no dpkg: this needs Debian's packages for arm64, and runs on Debian 12 only")
    kind = subprocess.run(["dpkg", "--print-architecture"], stdout=subprocess.PIPE, universal_newlines=True).stdout.strip()
    if kind == "arm64":
        raise Unusable("this machine is arm64 itself: scripts/test tests here what this script emulates")
    if kind != "amd64":
        raise Unusable(f"this machine is of the kind \"{kind}\", and Debian's cross compiler is expected on amd64")
    missing = [name for name in PACKAGES if not shutil.which(name)]
    if missing:
        raise Unusable(f"{', '.join(missing)} not found: apt-get install {' '.join(PACKAGES[name] for name in missing)}")


def logged(log, *command, env=None):
    """Runs a command; what it says goes to the end of the log."""
    command = [str(part) for part in command]
    with open(log, "a", encoding="utf-8") as file:
        file.write(f"$ {' '.join(command)}\n")
        file.flush()
        result = subprocess.run(command, stdout=file, stderr=subprocess.STDOUT, env=env or os.environ)
    if result.returncode != 0:
        raise Unusable(f"{' '.join(command[:3])} failed with status {result.returncode}: see the end of {log}")
