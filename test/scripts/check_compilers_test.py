import sys
import tempfile
import unittest
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path

from project import SOURCE_DIR, run

sys.dont_write_bytecode = True  # none beside the program
PROGRAM = SOURCE_DIR / "scripts/check_compilers"


def load():
    loader = SourceFileLoader("check_compilers", str(PROGRAM))
    module = module_from_spec(spec_from_loader("check_compilers", loader))
    loader.exec_module(module)
    return module


class CheckCompilersTest(unittest.TestCase):
    def setUp(self):
        self.program = load()
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def examine(self, source, headers=()):
        (self.folder / "source.cpp").write_text(source)
        entry = {"file": str(self.folder / "source.cpp"), "directory": str(self.folder),
                 "command": f"/usr/bin/c++ -O3 -std=gnu++14 -o source.o -c {self.folder}/source.cpp"}
        return self.program.examine("g++", entry, headers)

    def test_the_command_has_the_other_compiler_and_builds_nothing(self):
        command = self.program.syntax_command(
            "clang++", "/usr/bin/ccache /usr/bin/c++ -DNAME=\\\"a\\\" -isystem /usr/include/eigen3 -O3 -std=gnu++17 -o a.o -c a.cpp",
            [Path("/old/eigen")])
        self.assertEqual(command[:3], ["clang++", "-isystem", "/old/eigen"])
        self.assertIn("-DNAME=\"a\"", command)
        self.assertTrue({"-fsyntax-only", "-std=c++17", "-pedantic", "-Wall", "-Wextra", "a.cpp"} <= set(command))
        self.assertTrue({"-o", "a.o", "-c", "-O3", "-std=gnu++17", "/usr/bin/ccache"}.isdisjoint(command))

    def test_errors_and_warnings_are_found(self):
        for source, kind in (("int value() { int unused = 1; return 2; }", "warning"), ("int value() { return none; }", "error"),
                             ("#include \"missing.h\"", "fatal error"), ("int f(int n) { int a[n]; return a[0]; }", "warning")):
            with self.subTest(source=source):
                found = self.examine(source)
                self.assertTrue(any("source.cpp:1:" in line and f" {kind}: " in line for line in found), found)

    def test_a_clean_source_has_no_finding(self):
        self.assertEqual(self.examine("#include <optional>\nint value() { return std::optional<int>{2}.value(); }"), [])

    def test_older_headers_come_before_the_systems(self):
        (self.folder / "old/Eigen").mkdir(parents=True)
        (self.folder / "old/Eigen/Core").write_text("namespace Eigen { struct Old {}; }")
        source = "#include <Eigen/Core>\nEigen::Old old() { return {}; }"
        self.assertEqual(self.examine(source, [self.folder / "old"]), [])
        self.assertNotEqual(self.examine(source), [])

    def test_a_compiler_or_folder_that_is_not_there_is_named(self):
        for arguments, expected in ((["g++-0"], "there is no compiler g++-0"), (["--headers", "/no/folder"], "no such folder")):
            result = run([PROGRAM, *arguments])
            self.assertEqual(result.returncode, 2)
            self.assertIn(expected, result.stderr)
