"""What must be true of the last stage, looked at as its user and by its entry point."""

import socket
import subprocess

from .rooms import Failed

INSTALLED = "/opt/uav_landing"
PROGRAMS = f"export PATH={INSTALLED}/lib/uav_landing:$PATH && cd $(mktemp -d) && "
LIBRARIES = f"""linked=$(ldd {INSTALLED}/lib/*.so {INSTALLED}/lib/uav_landing/* 2>/dev/null)
    grep -q 'libroscpp.so.* => /' <<<"$linked" || {{ echo 'nothing is linked with roscpp'; exit 1; }}
    missing=$(grep 'not found' <<<"$linked" | sort -u); echo "$missing"; test -z "$missing" """
APPROACH = f"""simulate_approach --config {INSTALLED}/share/uav_landing/config/simulator/lab.yaml --output a.bag --dataset d &&
    process_bag --input a.bag --csv a.csv && evaluate --truth d/frames.csv --estimates a.csv"""
# The launch file has to end by the signal that container engines send.
NODELETS = """
    export ROS_MASTER_URI=http://localhost:PORT ROS_IP=127.0.0.1
    roscore -p PORT >~/roscore.log 2>&1 & core=$!
    until rostopic list >/dev/null 2>&1; do kill -0 $core || { cat ~/roscore.log; exit 1; }; sleep 1; done
    roslaunch uav_landing simulate.launch >~/launch.log 2>&1 & launch=$!
    timeout 300 rostopic echo -n 20 /uav_landing/landing_estimate/height || { cat ~/launch.log; exit 1; }
    kill -TERM $launch; timeout 60 tail --pid=$launch -f /dev/null || { echo 'roslaunch goes on after SIGTERM'; exit 1; }"""


def check(room, what, command, wanted=""):
    """The command ends well, and its output has the wanted text."""
    result = room.run([*room.entry, "bash", "-c", command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                      universal_newlines=True, timeout=1200)
    if result.returncode != 0 or wanted not in result.stdout:
        raise Failed(f"{what}: failed:\n{result.stdout[-3000:]}")
    print(f"test_container: {what}: works", flush=True)
    return result.stdout


def free_port():
    with socket.socket() as some:
        some.bind(("localhost", 0))
        return some.getsockname()[1]


def check_image(room):
    """Stops at the first thing that is not as it must be. Prints the size."""
    if room.user == "root":
        raise Failed("the last stage has no USER: it would run as root")
    if not room.entry:
        raise Failed("the last stage has no ENTRYPOINT: commands would not find the package")
    check(room, "no compiler", "! command -v gcc && ! command -v g++ && ! command -v cc && ! command -v clang")
    check(room, "not root", f"test $(id -u) -ne 0 && test ! -w {INSTALLED}")
    check(room, "all libraries are there", LIBRARIES)
    check(room, "a shell when there is no command", f"echo 'rospack find uav_landing' | {' '.join(room.entry)}",
          f"{INSTALLED}/share/uav_landing")
    print(check(room, "an approach through process_bag", PROGRAMS + APPROACH))
    check(room, "nodelets beside a master", NODELETS.replace("PORT", str(free_port())), "---")
    size = subprocess.run(["du", "-sm", str(room.root)], stdout=subprocess.PIPE, universal_newlines=True).stdout.split()[0]
    print(f"test_container: the last stage has {size} MB")
