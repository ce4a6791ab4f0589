"""The copy of the tree that mutants are built and tested in; the tree itself is only read."""

import json
import os
import re
import resource
import shlex
import shutil
import subprocess
import time
from contextlib import contextmanager
from pathlib import Path

from .concern import Test

MOST_MEMORY = 16 << 30  # bytes of address space: what a mutant allocates without end is killed by it
LONGEST = 600  # s, of one test
BUSY = 5  # times as long as it takes alone a program may run where the machine is busy


def _limit_memory():
    resource.setrlimit(resource.RLIMIT_AS, (MOST_MEMORY, MOST_MEMORY))


def _limits_of_program(seconds):
    """Returns a function that limits the memory and the processor time of a program."""
    def limit():
        _limit_memory()
        resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))
    return limit


class Workshop:
    """A copy of the tree in work/tree, and its build in work/tree/build."""

    def __init__(self, root, work, jobs=1):
        """jobs: compilers side by side."""
        self._root, self._work, self._jobs = root, work, jobs
        self.tree = (work / "tree").resolve()
        self.build_folder = self.tree / "build"
        self.environment = dict(os.environ, PATH="/usr/bin:" + os.environ["PATH"], CCACHE_BASEDIR=str(self.tree),
                                GTEST_FAIL_FAST="1", NOSE_STOP="1", ROS_HOME=str(work / "ros_home"))
        self.environment.setdefault("UAV_LANDING_DATA", str((root.parent / "shared/data").resolve()))

    def refresh(self):
        """Makes the copy equal to the tree. Files that are the same keep their times, so they are not built again."""
        listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=self._root,
                                stdout=subprocess.PIPE, check=True).stdout.decode().split("\0")
        wanted = {name for name in listed if name and (self._root / name).is_file()}
        for name in wanted:
            source, copy = self._root / name, self.tree / name
            if copy.is_file() and copy.read_bytes() == source.read_bytes():
                continue
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(source, copy)
        for copy in self.tree.rglob("*"):
            name = copy.relative_to(self.tree).as_posix()
            if copy.is_file() and name not in wanted and not name.startswith(("build/", "bin/", ".git/")):
                copy.unlink()

    def configure(self):
        """Configures the build and returns what cmake says when it fails, else None."""
        launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
        # A mutant of the library is no reason to link a test anew.
        made = subprocess.run(["cmake", "-S", ".", "-B", "build", "-DPYTHON_EXECUTABLE=/usr/bin/python3", *launcher,
                               "-DUAV_LANDING_BENCHMARK=OFF", "-DCMAKE_LINK_DEPENDS_NO_SHARED=ON",
                               "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON"], cwd=self.tree,
                              env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)
        return made.stdout if made.returncode else None

    def build(self, *targets):
        """Builds targets and says whether that succeeded."""
        with (self._work / "build.log").open("w") as log:
            return subprocess.run(["cmake", "--build", "build", "--target", *targets, "--", "--keep-going", f"-j{self._jobs}"],
                                  cwd=self.tree, env=self.environment, stdout=log, stderr=subprocess.STDOUT).returncode == 0

    @contextmanager
    def changed(self, mutant, sources=None):
        """The copy with one line changed, and as it was afterwards.

        sources: those that are compiled with the change; None: all that see the changed file.
        """
        path = self.tree / mutant.path
        original = path.read_text(encoding="utf-8")
        self._write(path, self._text_with(mutant), sources)
        try:
            yield
        finally:
            self._write(path, original, sources)

    def _write(self, path, text, sources):
        before = path.stat()
        path.write_text(text, encoding="utf-8")
        if sources is not None:
            # make goes by times.
            os.utime(str(path), ns=(before.st_atime_ns, before.st_mtime_ns))
            for source in sources:
                (self.tree / source).touch()

    def tests(self):
        """Returns all tests of ctest."""
        listed = subprocess.run(["ctest", "--show-only=json-v1"], cwd=self.build_folder, env=self.environment,
                                stdout=subprocess.PIPE, check=True).stdout
        found = []
        for test in json.loads(listed)["tests"]:
            name = test["name"]
            gtest = re.search(r"_gtest_(\w+)$", name)
            nodelet = re.search(r"_rostest_test_nodelets_(\w+)\.test$", name)
            target = gtest.group(1) if gtest else f"{nodelet.group(1)}_test" if nodelet else None
            found.append(Test(name, target, bool(gtest)))
        return found

    def sources_of(self, target):
        """Returns the source files of a target, by the files that cmake has made for it."""
        made = self.build_folder / f"CMakeFiles/{target}.dir/build.make"
        if not made.is_file():
            return set()
        return set(re.findall(r"^CMakeFiles/[^/]+\.dir/(\S+\.cpp)\.o: \S+\.cpp$", made.read_text(), re.MULTILINE))

    def build_library_with(self, mutant):
        """The shared library of a source with one line changed, beside the build; None when it cannot be compiled.

        Returns the folder that the library is in. The build and the copy of the tree stay as they are.
        """
        folder = self._work / "libraries" / mutant.name
        folder.mkdir(parents=True, exist_ok=True)
        changed, made = folder / "mutant.cpp", folder / "mutant.o"
        changed.write_text(self._text_with(mutant), encoding="utf-8")
        commands = json.loads((self.build_folder / "compile_commands.json").read_text())
        original = str(self.tree / mutant.path)
        compiled = next(entry for entry in commands if entry["file"] == original)
        words = shlex.split(compiled["command"])
        object_file = words[words.index("-o") + 1]
        compile_it = [str(made) if word == object_file else str(changed) if word == original else word for word in words]
        # What it includes from its own folder.
        compile_it += ["-iquote", str((self.tree / mutant.path).parent)]
        link = shlex.split((self.build_folder / object_file.split(".dir/")[0]).with_suffix(".dir").joinpath("link.txt").read_text())
        library = link[link.index("-o") + 1]
        link_it = [str(made) if word == object_file else str(folder / Path(library).name) if word == library else word
                   for word in link]
        for command in (compile_it, link_it):
            if self._quietly(command) != 0:
                shutil.rmtree(folder)
                return None
        made.unlink()
        return folder

    def _quietly(self, command):
        return subprocess.run(command, cwd=self.build_folder, env=self.environment, stdout=subprocess.DEVNULL,
                              stderr=subprocess.DEVNULL).returncode

    def _text_with(self, mutant):
        lines = (self.tree / mutant.path).read_text(encoding="utf-8").split("\n")
        assert lines[mutant.line - 1] == mutant.before, mutant
        lines[mutant.line - 1] = mutant.after
        return "\n".join(lines)

    def run(self, test, library=None, deadline=LONGEST):
        """Says whether a test passes, and its seconds. library: the folder of the library to use instead of that of the build."""
        environment = dict(self.environment)
        limit = _limit_memory
        if test.program:
            limit = _limits_of_program(int(deadline))
            deadline *= BUSY
            command = [self.build_folder / "devel/lib/uav_landing" / test.target]
            places = [str(library)] if library else []
            environment["LD_LIBRARY_PATH"] = ":".join(places + [str(self.build_folder / "devel/lib")])
        else:
            command = ["ctest", "--timeout", str(int(deadline)), "-R", f"^{re.escape(test.name)}$"]
            deadline += 60
        begun = time.monotonic()
        try:
            done = subprocess.run(list(map(str, command)), cwd=self.build_folder, env=environment, stdout=subprocess.DEVNULL,
                                  stderr=subprocess.DEVNULL, timeout=deadline, preexec_fn=limit).returncode == 0
        except (subprocess.TimeoutExpired, FileNotFoundError):  # the latter: it could not be built
            done = False
        return done, time.monotonic() - begun
