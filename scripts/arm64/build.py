"""Cross compiles the core, its tests and simulate_campaign (cmake/core_only.cmake)."""

import os
import shutil

from .commands import logged


def build(root, work, log, jobs):
    """Builds in work/core against the packages in work/sysroot."""
    folder = work / "core"
    options = ["-DUAV_LANDING_CORE_ONLY=ON"]
    if not (folder / "CMakeCache.txt").exists():
        options.append(f"-DCMAKE_TOOLCHAIN_FILE={root / 'scripts/arm64/toolchain.cmake'}")
    if shutil.which("ccache"):
        options.append("-DCMAKE_CXX_COMPILER_LAUNCHER=ccache")
    # ccache keeps files that use compiled headers only when it may trust these two.
    environment = {**os.environ, "CCACHE_BASEDIR": str(root), "CCACHE_SLOPPINESS": "pch_defines,time_macros"}
    print(f"compiling for arm64, see {log}", flush=True)
    logged(log, "cmake", "-S", root, "-B", folder, *options)
    logged(log, "cmake", "--build", folder, f"-j{jobs}", env=environment)


def test_programs(work):
    return sorted(file for file in (work / "core/tests").iterdir() if os.access(file, os.X_OK))
