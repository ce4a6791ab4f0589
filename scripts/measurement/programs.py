"""Runs the package's programs, and says which version of them made a result."""

import hashlib
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "src/tools"))
from evaluation.pending_file import pending  # noqa: E402,F401 (stands beside evaluate)


def built_space():
    """Where the built package is: UAV_LANDING_DEVEL_DIR, else the first space of the sourced setup.bash that has it, as
    rosrun searches, else that of scripts/build, built or not."""
    if os.environ.get("UAV_LANDING_DEVEL_DIR"):
        return Path(os.environ["UAV_LANDING_DEVEL_DIR"])
    sourced = [Path(space) for space in os.environ.get("CMAKE_PREFIX_PATH", "").split(os.pathsep) if space]
    return next((space for space in sourced if (space / "lib/uav_landing").is_dir()), ROOT / "build/devel")


WORK = ROOT / "build" / "accuracy"
DEVEL = built_space()
NOT_BUILT = "build first: scripts/build, or catkin_make and . devel/setup.bash in a catkin workspace"
DEADLINE = 7200  # s, for one program


def run(*command):
    """Runs a program of the package in the space where it is built; stops with its message when it fails."""
    result = subprocess.run([str(DEVEL / "env.sh"), "rosrun", "uav_landing", *map(str, command)], stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, universal_newlines=True, timeout=DEADLINE)
    if result.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}\n{result.stdout}")
    return result.stdout


def run_built(devel, program, *arguments):
    """Runs a program of this build with its own libraries; stops with its message when it fails."""
    # A sourced setup.bash puts the libraries of another build first, which would then be measured instead.
    libraries = os.pathsep.join(filter(None, (str(devel / "lib"), os.environ.get("LD_LIBRARY_PATH"))))
    command = [str(part) for part in (devel / "lib/uav_landing" / program, *arguments)]
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True,
                            timeout=DEADLINE, env={**os.environ, "LD_LIBRARY_PATH": libraries})
    if result.returncode != 0:
        sys.exit(f"{' '.join(command)}\n{result.stdout}")
    return result.stdout


def fingerprint(*files, devel=None):
    """Returns a short name for the contents of the core library and these files. Results of other contents are not reused."""
    digest = hashlib.sha256()
    for file in ((devel or DEVEL) / "lib/libuav_landing_core.so", *files):
        digest.update(Path(file).read_bytes())
    return digest.hexdigest()[:12]


def save_figure(figure, path):
    """Writes a figure to a file and closes it, because open figures fill the memory."""
    import matplotlib.pyplot as plt  # only here: it takes longer to load than everything else
    figure.tight_layout()
    path.parent.mkdir(parents=True, exist_ok=True)
    with pending(path) as temporary:
        figure.savefig(temporary, dpi=80)
    plt.close(figure)
