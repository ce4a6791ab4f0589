"""Runs programs for arm64 in qemu, and counts what they execute."""

import os
import subprocess

from .commands import Unusable, logged

LIBRARY = "libuav_landing_core.so"
SILENCE = 3600  # s that a program may take; an emulated one takes some ten times as long as another


class Emulator:
    def __init__(self, work, log):
        self.work, self.log, self.sysroot = work, log, work / "sysroot"
        self.plugin = work / "count_blocks.so"

    def command(self, program, *arguments, counts=None):
        """counts: file to write how often each block of the core's instructions was executed."""
        libraries = [self.work / "core", *(self.sysroot / "usr/lib/aarch64-linux-gnu" / name for name in ("blas", "lapack"))]
        # blas and lapack are two of several packages' libraries: Debian links the chosen ones while it installs.
        command = ["qemu-aarch64", "-L", self.sysroot, "-E", f"LD_LIBRARY_PATH={os.pathsep.join(map(str, libraries))}"]
        if counts:
            command += ["-plugin", f"{self.plugin},library={LIBRARY},output={counts}"]
        return [str(part) for part in (*command, program, *arguments)]

    def build_plugin(self, source):
        logged(self.log, "gcc", "-O2", "-Wall", "-shared", "-fPIC", "-o", self.plugin, source)

    def test(self, program):
        """Number of tests that passed, and what a failing program says."""
        try:
            result = subprocess.run(self.command(program), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=SILENCE,
                                    universal_newlines=True, errors="replace")
        except subprocess.TimeoutExpired:
            return 0, f"took longer than {SILENCE} s"
        passed = sum(line.startswith("[       OK ]") for line in result.stdout.splitlines())
        if result.returncode == 0 and passed:
            return passed, ""
        return passed, f"exit status {result.returncode}, {passed} tests passed\n{result.stdout[-3000:]}"

    def fly(self, csv, counts, *options):
        logged(self.log, *self.command(self.work / "core/simulate_campaign", "snippets", "--csv", csv, *options, counts=counts))
        if not counts.exists():
            raise Unusable(f"qemu wrote no counts to {counts}: this version of it has no plugins")
