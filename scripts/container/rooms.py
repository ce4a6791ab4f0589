"""Runs the stages of a Dockerfile in folders with a Debian of their own (chroot), for want of a container engine.

Each command has its own mount and process namespace, so that nothing stays mounted and nothing runs on.
"""

import fnmatch
import os
import re
import shutil
import subprocess
from pathlib import Path

IMAGES = {"debian:12", "debian:12-slim", "debian:bookworm", "debian:bookworm-slim"}
PATH = "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin"


class Failed(Exception):
    """A step did not work, or something that is needed is missing."""


def make_base(folder):
    """What an image debian:12 has: the essential packages and apt. The machine's own settings for fetching go along."""
    settings = subprocess.run(["apt-config", "dump"], stdout=subprocess.PIPE, universal_newlines=True, check=True).stdout
    fetching = [line for line in settings.splitlines() if line.startswith(("Acquire::Check", "Acquire::http", "Acquire::Retries"))
                and not line.endswith('"";')]
    # In a namespace of its own: mmdebstrap mounts, and what is mounted has to go also when somebody ends it.
    command = ["unshare", "--mount", "--pid", "--fork", "--kill-child", "mmdebstrap", "--variant=minbase", "--mode=root",
               "--dpkgopt=force-unsafe-io", *(f"--aptopt={line.rstrip(';')}" for line in fetching), "bookworm", str(folder)]
    result = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
    if result.returncode != 0:
        raise Failed(why_no_base(result.stdout))


def why_no_base(messages):
    """One line from the messages of mmdebstrap and apt."""
    if re.search("Could not (resolve|connect)|Temporary failure resolving|Unable to connect|Network is unreachable|timed out", messages):
        return "Debian's packages cannot be fetched: look at the network and at apt's proxy, until apt-get update works"
    errors = [line for line in messages.splitlines() if line.startswith("E:")] or messages.splitlines() or ["no message"]
    return f"mmdebstrap did not make a Debian 12: {errors[0]}"


class Room:
    """One stage: its folder, and what ENV, USER and WORKDIR have set."""

    def __init__(self, root, mounts=()):
        self.root = root
        self.mounts = list(mounts)  # (folder of the machine, path within)
        self.environment = {"PATH": PATH}
        self.user, self.folder, self.entry = "root", "/", []

    def inside(self, path):
        """The file of the machine behind a path of the room; relative paths begin at WORKDIR."""
        return self.root / os.path.normpath(os.path.join(self.folder, path)).lstrip("/")

    def home(self):
        for line in (self.root / "etc/passwd").read_text().splitlines():
            fields = line.split(":")
            if fields[0] == self.user:
                return fields[5]
        raise Failed(f"USER {self.user}: there is no such user")

    def run(self, words, **options):
        """Runs a command with the room's user, folder and environment; returns its CompletedProcess."""
        root = str(self.root)
        mounts = "".join(f'mkdir -p "{root}{within}" && mount --bind "{outside}" "{root}{within}" && '
                         for outside, within in self.mounts)
        script = (f'mount -t proc proc "{root}/proc" && mount --rbind /dev "{root}/dev" && {mounts}'
                  'exec chroot --userspec="$1" --groups="$2" "$3" /usr/bin/env -i -C "$4" "${@:5}"')
        environment = [f"{name}={value}" for name, value in {"HOME": self.home(), **self.environment}.items()]
        return subprocess.run(["unshare", "--mount", "--pid", "--fork", "--kill-child", "bash", "-c", script, "room",
                               self.user + ":", self.groups(), root, self.folder, *environment, *words], **options)

    def groups(self):
        """All groups of the user, which chroot does not look up by itself."""
        lines = [line.split(":") for line in (self.root / "etc/group").read_text().splitlines()]
        return ",".join(fields[2] for fields in lines if self.user in fields[3].split(","))

    def carry_out(self, step, context, rooms):
        if step.kind == "ENV":
            self.environment.update(step.arguments)
        elif step.kind == "USER":
            self.user = step.arguments
            self.home()
        elif step.kind == "WORKDIR":
            self.folder = os.path.join(self.folder, step.arguments)
            self.inside(".").mkdir(parents=True, exist_ok=True)
        elif step.kind == "ENTRYPOINT":
            self.entry = step.arguments
        elif step.kind == "COPY":
            stage, sources, destination = step.arguments
            copy(context if stage is None else rooms[stage].root, sources, self.inside(destination),
                 destination.endswith("/") or destination == ".", ignored(context) if stage is None else [])
        elif self.run(["/bin/sh", "-c", step.arguments]).returncode != 0:
            raise Failed(f"line {step.line}: RUN {step.arguments}: failed; see above")


def ignored(context):
    """Patterns of .dockerignore, of which only names at the top are understood."""
    file = context / ".dockerignore"
    lines = [line.strip() for line in file.read_text().splitlines()] if file.is_file() else []
    patterns = [line for line in lines if line and not line.startswith("#")]
    for pattern in patterns:
        if pattern.startswith("!") or "/" in pattern:
            raise Failed(f".dockerignore: {pattern}: only names without / and ! are understood")
    return patterns


def copy(base, sources, destination, into_folder, patterns):
    """As COPY does: of a folder what is in it, a file into the destination if that is a folder, else as it."""
    for source in sources:
        path = base / source.lstrip("/")
        if path.is_dir():
            top = path.resolve() == base.resolve()
            shutil.copytree(str(path), str(destination), symlinks=True, dirs_exist_ok=True,
                            ignore=lambda folder, names: [name for name in names if top and Path(folder) == path and
                                                          any(fnmatch.fnmatch(name, pattern) for pattern in patterns)])
        elif path.is_file():
            if into_folder or len(sources) > 1 or destination.is_dir():
                destination.mkdir(parents=True, exist_ok=True)
                shutil.copy2(str(path), str(destination / path.name))
            else:
                destination.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy2(str(path), str(destination))
        else:
            raise Failed(f"COPY {source}: there is no such file")
