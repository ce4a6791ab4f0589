"""Builds another commit beside this tree."""

import os
import shutil
import subprocess
import sys

TARGETS = ("process_bag", "simulate_approach", "simulate_campaign")


class Unusable(Exception):
    """Something is wrong. The message tells the user what, and what to do."""


def git(root, *arguments):
    """Returns the output of git, or None when git refuses."""
    result = subprocess.run(["git", "-C", str(root), *arguments], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                            universal_newlines=True, check=False)
    return result.stdout.strip() if result.returncode == 0 else None


def find_commit(root, revision):
    """Returns the full name of a commit."""
    if git(root, "rev-parse", "--git-dir") is None:
        raise Unusable(f"{root} is not a git checkout: there is no base to compare with")
    commit = git(root, "rev-parse", "--verify", "--quiet", f"{revision}^{{commit}}")
    if not commit:
        raise Unusable(f"--base {revision}: no such commit in {root}")
    return commit


def build(root, commit, work):
    """Builds a commit once and returns the folder of its sources; the programs are in build/devel."""
    folder = work / f"base-{commit[:12]}"
    if (folder / "built").exists():
        return folder
    if not folder.exists():
        extract(root, commit, folder)
    print(f"building {commit[:12]} in {folder}", flush=True)
    log = folder / "build.log"
    environment = {**os.environ, "CCACHE_BASEDIR": str(folder)}
    launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
    commands = [["cmake", "-S", str(folder), "-B", str(folder / "build"), "-DPYTHON_EXECUTABLE=/usr/bin/python3",
                 "-DCATKIN_ENABLE_TESTING=OFF", "-DUAV_LANDING_BENCHMARK=OFF", *launcher],
                ["cmake", "--build", str(folder / "build"), f"-j{os.cpu_count()}", "--target", *TARGETS]]
    with log.open("w", encoding="utf-8") as file:
        for command in commands:
            if subprocess.run(command, stdout=file, stderr=subprocess.STDOUT, env=environment, check=False).returncode != 0:
                tail = "\n".join(log.read_text(encoding="utf-8").splitlines()[-8:])
                raise Unusable(f"commit {commit[:12]} does not build ({log}):\n{tail}")
    (folder / "built").touch()
    return folder


def extract(root, commit, folder):
    """Extracts the commit's files, either completely or not at all."""
    folder.parent.mkdir(parents=True, exist_ok=True)
    part, archive = folder.with_name(folder.name + ".part"), folder.with_name(folder.name + ".tar")
    shutil.rmtree(str(part), ignore_errors=True)
    subprocess.run(["git", "-C", str(root), "archive", f"--output={archive}", commit], check=True)
    shutil.unpack_archive(str(archive), str(part))
    archive.unlink()
    part.rename(folder)


def build_tree(root):
    """Builds what this tree needs. The output is shown only when the build fails."""
    result = subprocess.run([str(root / "scripts/build"), "--target", *TARGETS, "dataset_to_bag"], stdout=subprocess.PIPE,
                            stderr=subprocess.STDOUT, universal_newlines=True, check=False)
    if result.returncode != 0:
        sys.exit("\n".join(["scripts/build failed:", *result.stdout.splitlines()[-20:]]))
