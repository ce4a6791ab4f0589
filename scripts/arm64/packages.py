"""Debian's packages for arm64: unpacks them into a folder, and looks whether others exist. Nothing of this machine's own
packages changes, and nobody needs to be root."""

import os
import subprocess

from .commands import Unusable, logged

# What cmake/core_only.cmake compiles with. What they need comes with them.
NEEDED = ("libboost-dev", "libc6-dev", "libcli11-dev", "libeigen3-dev", "libexpected-dev", "libgtest-dev",
          "libopencv-calib3d-dev", "libopencv-core-dev", "libopencv-imgcodecs-dev", "libopencv-imgproc-dev",
          "libopencv-video-dev", "libyaml-cpp-dev")
# Packages are taken from where this machine takes its own, so that both have the same versions.
CONFIGURATION = """APT::Architecture "arm64";
APT::Architectures {{ "arm64"; }};
APT::Sandbox::User "root";
Debug::NoLocking "true";
Dir::State "{apt}/state";
Dir::State::status "{apt}/status";
Dir::Cache "{apt}/cache";
"""


class Archive:
    """The packages for arm64, with apt's files in the folder work/apt."""

    def __init__(self, work, log):
        self.apt, self.log = work / "apt", log

    def update(self):
        """Reads the list of packages anew."""
        for folder in ("state/lists/partial", "cache/archives/partial"):
            (self.apt / folder).mkdir(parents=True, exist_ok=True)
        (self.apt / "status").write_text("")
        (self.apt / "apt.conf").write_text(CONFIGURATION.format(apt=self.apt))
        self._apt_get("update")

    def missing(self, names):
        """Which of the packages do not exist for arm64, and why they cannot be installed together although they do."""
        shown = self._run("apt-cache", "show", "--no-all-versions", *names).stdout
        there = {line.split()[1] for line in shown.splitlines() if line.startswith("Package: ")}
        missing = [name for name in names if name not in there]
        tried = self._run("apt-get", "--simulate", "--no-install-recommends", "install", *names) if not missing else None
        reason = tried.stderr.strip() or tried.stdout.strip() if tried and tried.returncode else ""
        return missing, reason

    def unpack(self, names, folder):
        """Unpacks packages and those that they need. A folder that is complete already stays as it is."""
        mark = folder / "unpacked"
        if mark.exists() and mark.read_text().split() == list(names):
            return
        self._apt_get("install", "--yes", "--download-only", "--no-install-recommends", *names)
        for package in sorted((self.apt / "cache/archives").glob("*.deb")):
            logged(self.log, "dpkg-deb", "--extract", package, folder)
        mark.write_text("\n".join(names) + "\n")

    def _environment(self):
        return {**os.environ, "APT_CONFIG": str(self.apt / "apt.conf"), "LC_ALL": "C"}

    def _run(self, *command):
        return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, universal_newlines=True,
                              env=self._environment())

    def _apt_get(self, *arguments):
        try:
            logged(self.log, "apt-get", *arguments, env=self._environment())
        except Unusable as failed:
            raise Unusable(f"{failed}; the packages for arm64 come from where this machine takes its own: is the network "
                           "there, and no [arch=amd64] in the package sources?")
