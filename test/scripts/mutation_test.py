"""scripts/mutation: which mutants it makes, which tests it takes for them, what it keeps and what it says."""

import shutil
import sys
import tempfile
import unittest
from contextlib import contextmanager
from pathlib import Path

from project import SOURCE_DIR, run

sys.path.insert(0, str(SOURCE_DIR / "scripts"))
from mutants import candidates, operators, page  # noqa: E402 (only there after the line before)
from mutants.bench import Bench, TestTimes  # noqa: E402
from mutants.candidates import Mutant  # noqa: E402
from mutants.concern import Concern, Test  # noqa: E402
from mutants.results import Results, code_fingerprint  # noqa: E402
from mutants.source_text import without_comments_and_texts  # noqa: E402
from mutants.workshop import Workshop  # noqa: E402

MUTANT = Mutant("abc", "src/core/a.cpp", 2, 0, "sign", "x = a - b;", "x = a + b;")


def changed(kind, line):
    """The line after each change of a kind."""
    return [line[:start] + replacement + line[end:] for start, end, replacement in operators.KINDS[kind](line)]


class OperatorsTest(unittest.TestCase):
    def test_terms_are_dropped_whole(self):
        self.assertEqual(changed("term", "v = a + b * f(c, d) - e;"),
                         ["v = a - e;", "v = a + b - e;", "v = a + b * f(c, d);"])

    def test_a_term_that_goes_on_in_the_next_line_stays(self):
        self.assertEqual(changed("term", "v = a + b *"), [])

    def test_a_leading_factor_is_dropped(self):
        self.assertEqual(changed("factor", "return 0.5 * t * t;"), ["return t * t;"])

    def test_a_square_becomes_the_number_itself(self):
        self.assertEqual(changed("function", "v = std::pow(s * h, 2);"), ["v = (s * h);"])

    def test_signs_are_turned(self):
        self.assertEqual(changed("sign", "x += f(-a) - b;"), ["x += f(-a) + b;", "x -= f(-a) - b;", "x += f(a) - b;"])

    def test_templates_and_pointers_are_no_comparisons(self):
        self.assertEqual(changed("comparison", "const std::vector<int> a = p->b;"), [])

    def test_neighbouring_fields_are_mixed_up(self):
        self.assertEqual(changed("field", "a = p.x() + q[0];"), ["a = p.y() + q[0];", "a = p.x() + q[1];"])

    def test_a_forgotten_reset(self):
        self.assertEqual(changed("statement", "  if (late) velocity_.reset();"), ["  if (late) {}"])
        self.assertEqual(changed("statement", "  count_ = 0;"), ["  {}"])

    def test_a_declaration_is_no_statement_to_forget(self):
        self.assertEqual(changed("statement", "  const double a = b;"), [])
        self.assertEqual(changed("statement", "  return f(a);"), [])

    def test_an_error_that_is_swallowed(self):
        self.assertEqual(changed("error", "  if (failure) return failure;"), ["  "])


class SourceTextTest(unittest.TestCase):
    def test_lines_and_columns_stay(self):
        source = 'a = "x - y";  // b - c\n/* d -\n e */ f - g;'
        blank = without_comments_and_texts(source)
        self.assertEqual([len(line) for line in blank.split("\n")], [len(line) for line in source.split("\n")])
        self.assertNotIn("-", blank.split("\n")[0])
        self.assertEqual(blank.split("\n")[2].strip(), "f - g;")


class TreeTest(unittest.TestCase):
    def setUp(self):
        self.tree = Path(tempfile.mkdtemp(prefix="uav_landing_mutation_"))
        self.addCleanup(shutil.rmtree, str(self.tree))

    def write(self, path, text):
        (self.tree / path).parent.mkdir(parents=True, exist_ok=True)
        (self.tree / path).write_text(text)


class CandidatesTest(TreeTest):
    def names(self, seed=1):
        return [m.name for m in candidates.in_random_order(self.tree, ["src"], seed)]

    def test_one_mutant_of_each_line_that_has_any(self):
        self.write("src/a.cpp", "#include <a - b>\n  x = a - b;\n\n  // y = a - b;\n  z = a + b;\n")
        drawn = candidates.in_random_order(self.tree, ["src"], 1)
        self.assertEqual(sorted(m.line for m in drawn), [2, 5])
        for mutant in drawn:
            self.assertNotEqual(mutant.before, mutant.after)

    def test_a_seed_draws_the_same_and_another_one_others(self):
        self.write("src/a.cpp", "".join(f"  x{i} = a{i} - b{i} * c{i};\n" for i in range(40)))
        self.assertEqual(self.names(1), self.names(1))
        self.assertNotEqual(self.names(1), self.names(2))

    def test_names_stay_while_other_lines_change(self):
        self.write("src/a.cpp", "  x = a - b;\n  y = a - b;\n")
        before = self.names()
        self.write("src/a.cpp", "  int other = 1;\n\n  x = a - b;\n  y = a - b;\n")
        self.assertEqual(self.names(), before)

    def test_the_same_statement_has_another_name_wherever_it_stands(self):
        self.write("src/a.cpp", "  x = a - b;\n    x = a - b;\n  x = a - b;\n")
        self.assertEqual(len(set(self.names())), 3)


class ConcernTest(TreeTest):
    def setUp(self):
        super().setUp()
        self.write("include/uav_landing/height/filter.h", "class Filter {\n};\n")
        self.write("src/core/height/filter.cpp", '#include "uav_landing/height/filter.h"\n')
        self.write("src/core/base/gain.h", "class Gain {\n};\n")
        self.write("src/core/base/gain.cpp", '#include "base/gain.h"\n')
        self.write("src/core/height/filter_part.cpp",
                   '#include "base/gain.h"\n#include "uav_landing/height/filter.h"\nvoid Filter::part() {}\n')
        self.write("src/core/other.h", "class Other {\n};\n")
        self.write("src/core/other.cpp", '#include "other.h"\n')
        self.write("src/tools/play.cpp", '#include "uav_landing/height/filter.h"\nint main() {}\n')
        self.write("test/core/filter_test.cpp", '#include "uav_landing/height/filter.h"\n')
        self.write("test/core/gain_test.cpp", '#include "base/gain.h"\n')
        self.write("test/tools/play_test.py", "run play\n")
        self.filter, self.gain = Test("f", "filter_test", True), Test("g", "gain_test", True)
        self.play = Test("nosetests_test_tools_play_test.py", None, False)
        sources = {"filter_test": ["test/core/filter_test.cpp"], "gain_test": ["test/core/gain_test.cpp"]}
        self.concern = Concern(self.tree, [self.gain, self.filter, self.play], sources.get)

    def test_the_test_of_its_name_comes_first_then_those_of_its_users(self):
        self.assertEqual(self.concern.tests_of("src/core/base/gain.cpp"), [self.gain, self.filter])

    def test_a_part_of_a_class_in_a_file_of_its_own(self):
        self.assertEqual(self.concern.tests_of("src/core/height/filter_part.cpp"), [self.filter])

    def test_a_function_of_a_header_with_another_name(self):
        self.write("src/core/base/gain.h", "class Gain {\n};\ndouble gainOf(int index);\n")
        self.write("src/core/base/loud.cpp", '#include "base/gain.h"\ndouble gainOf(int index) { return index; }\n')
        self.write("src/core/base/quiet.cpp", '#include "base/gain.h"\ndouble quiet(int index) { return gainOf(index); }\n')
        sources = {"filter_test": ["test/core/filter_test.cpp"], "gain_test": ["test/core/gain_test.cpp"]}
        concern = Concern(self.tree, [self.gain, self.filter], sources.get)
        self.assertEqual(concern.tests_of("src/core/base/loud.cpp")[0], self.gain)
        self.assertEqual(concern.tests_of("src/core/base/quiet.cpp"), [], "it only calls it")

    def test_a_program_is_tested_by_the_python_tests_that_name_it(self):
        self.assertEqual(self.concern.tests_of("src/tools/play.cpp"), [self.play])

    def test_of_tests_of_a_program_those_of_its_name_come_first_and_then_the_quickest(self):
        tests = [Test(f"nosetests_test_tools_{name}_test.py", None, False) for name in ("slow", "quick", "play_input")]
        for name in ("slow", "quick", "play_input"):
            self.write(f"test/tools/{name}_test.py", "run play\n")
        slow, quick, named = tests
        seconds = {slow: 300, quick: 1, named: 100}
        self.assertEqual(Concern(self.tree, tests, {}.get).tests_of("src/tools/play.cpp", seconds.get), [named, quick, slow])

    def test_a_program_is_tested_by_what_launches_it(self):
        self.write("launch/player.launch", '<node pkg="p" type="play" name="player"/>\n')
        self.write("test/launch/player.test", '<test test-name="player" pkg="p" type="player_test.py"/>\n')
        self.write("test/launch/player_test.py", 'launch_file("player.launch")\n')
        launched = Test("rostest_test_launch_player.test", None, False)
        other = Test("rostest_test_launch_other.test", None, False)
        self.assertEqual(Concern(self.tree, [launched, other], {}.get).tests_of("src/tools/play.cpp"), [launched])

    def test_of_tests_that_are_as_near_the_quickest_comes_first(self):
        self.write("test/core/gain_again_test.cpp", '#include "base/gain.h"\n')
        again = Test("a", "gain_again_test", True)
        sources = {"gain_test": ["test/core/gain_test.cpp"], "gain_again_test": ["test/core/gain_again_test.cpp"]}
        concern = Concern(self.tree, [self.gain, again], sources.get)
        for quick, slow in ((self.gain, again), (again, self.gain)):
            self.assertEqual(concern.tests_of("src/core/base/gain.h", {quick: 1, slow: 2}.get), [quick, slow])

    def test_the_sources_that_see_a_header_and_the_nearest_of_them(self):
        self.write("src/core/base/gains.h", '#include "base/gain.h"\n')
        self.write("src/core/base/gains.cpp", '#include "base/gains.h"\n')
        concern = Concern(self.tree, [], {}.get)
        sources = {"src/core/base/gain.cpp", "src/core/height/filter_part.cpp"}
        self.assertEqual(concern.nearest_sources("src/core/base/gain.h"), sources | {"test/core/gain_test.cpp"})
        self.assertEqual(concern.sources_that_see("src/core/base/gain.h"), sources | {"src/core/base/gains.cpp"})

    def test_what_no_test_reaches(self):
        self.assertEqual(self.concern.tests_of("src/core/other.cpp"), [])


class WorkshopTest(TreeTest):
    def test_the_copy_is_changed_for_a_while_and_the_tree_never(self):
        project = self.tree / "project"
        self.write("project/src/core/a.cpp", "x = 1;\nx = a - b;\n")
        run(["git", "init", "-q", project])
        workshop = Workshop(project, self.tree / "work")
        workshop.refresh()
        copy = workshop.tree / "src/core/a.cpp"
        with workshop.changed(MUTANT):
            self.assertEqual(copy.read_text(), "x = 1;\nx = a + b;\n")
            self.assertEqual((project / "src/core/a.cpp").read_text(), "x = 1;\nx = a - b;\n")
        self.assertEqual(copy.read_text(), "x = 1;\nx = a - b;\n")

    def test_the_chosen_sources_alone_are_compiled_with_a_changed_header(self):
        self.write("project/src/core/a.h", "x = 1;\nx = a - b;\n")
        self.write("project/src/core/near.cpp", '#include "a.h"\n')
        self.write("project/src/core/far.cpp", '#include "a.h"\n')
        run(["git", "init", "-q", self.tree / "project"])
        workshop = Workshop(self.tree / "project", self.tree / "work")
        workshop.refresh()

        def times():
            return {name: (workshop.tree / "src/core" / name).stat().st_mtime_ns for name in ("a.h", "near.cpp", "far.cpp")}
        before = times()
        with workshop.changed(MUTANT._replace(path="src/core/a.h"), {"src/core/near.cpp"}):
            during = times()
            self.assertIn("x = a + b;", (workshop.tree / "src/core/a.h").read_text())
        after = times()
        for name in ("a.h", "far.cpp"):
            self.assertEqual([before[name]] * 2, [during[name], after[name]])
        self.assertTrue(before["near.cpp"] < during["near.cpp"] < after["near.cpp"])

    def test_what_is_gone_from_the_tree_goes_from_the_copy(self):
        self.write("project/src/a.cpp", "a\n")
        run(["git", "init", "-q", self.tree / "project"])
        workshop = Workshop(self.tree / "project", self.tree / "work")
        workshop.refresh()
        self.assertTrue((workshop.tree / "src/a.cpp").is_file())
        (self.tree / "project/src/a.cpp").unlink()
        workshop.refresh()
        self.assertFalse((workshop.tree / "src/a.cpp").exists())


class FakeWorkshop:
    """Notes what is built and run. A test of `broken` fails always, one of `killers` with a mutant."""

    def __init__(self, tree, killers=(), broken=()):
        self.tree, self.killers, self.broken, self.ran, self.sources = tree, killers, broken, [], []
        self._mutant = False

    def build(self, *_):
        return True

    @contextmanager
    def changed(self, _, sources=None):
        self._mutant = True
        self.sources.append(sources)
        yield
        self._mutant = False

    def build_library_with(self, mutant):
        return Path(tempfile.mkdtemp(dir=str(self.tree)))

    def run(self, test, library=None, deadline=None):
        mutant = self._mutant or library is not None
        self.ran.append((test.name, mutant))
        return test not in self.broken and not (mutant and test in self.killers), 1.0


class BenchTest(TreeTest):
    def setUp(self):
        super().setUp()
        self.write("src/core/a.cpp", '#include "a.h"\nx = a - b;\n')
        self.write("src/core/a.h", "x = 1;\nx = a - b;\n")
        self.write("test/a_test.cpp", '#include "a.h"\n')
        self.write("test/b_test.cpp", '#include "a.h"\n')
        self.a, self.b = Test("a", "a_test", True), Test("b", "b_test", True)

    def judge(self, mutant=MUTANT, **workshop):
        concern = Concern(self.tree, [self.a, self.b], {"a_test": ["test/a_test.cpp"], "b_test": ["test/b_test.cpp"]}.get)
        self.workshop = FakeWorkshop(self.tree, **workshop)
        said = []
        Bench(self.workshop, concern, Results(self.tree / "results.jsonl"), TestTimes(self.tree / "times.json"), 100, 1,
              said.append).judge([mutant])
        return said[-1]["outcome"], said[-1]["by"]

    def test_a_test_that_fails_without_the_mutant_kills_nothing(self):
        self.assertEqual(self.judge(broken=[self.a]), ("survived", ""))
        self.assertEqual(self.judge(broken=[self.a], killers=[self.b]), ("killed", "b"))
        in_header = MUTANT._replace(path="src/core/a.h")
        self.assertEqual(self.judge(in_header, broken=[self.a]), ("survived", ""))

    def test_a_test_runs_without_the_mutant_only_when_it_failed_with_it(self):
        self.assertEqual(self.judge(killers=[self.b]), ("killed", "b"))
        self.assertEqual(self.workshop.ran, [("a", True), ("b", True), ("b", False)])

    def test_a_header_that_many_see_faces_all_of_them_when_the_nearest_do_not_kill(self):
        self.write("src/core/all.h", '#include "a.h"\n')
        for number in range(10):
            self.write(f"src/core/far{number}.cpp", '#include "all.h"\n')
        in_header = MUTANT._replace(path="src/core/a.h")
        nearest = {"src/core/a.cpp", "test/a_test.cpp", "test/b_test.cpp"}
        self.assertEqual(self.judge(in_header), ("survived", ""))
        self.assertEqual(self.workshop.sources, [nearest, None])
        self.assertEqual(self.judge(in_header, killers=[self.b]), ("killed", "b"))
        self.assertEqual(self.workshop.sources, [nearest])

    def test_times_are_kept(self):
        self.judge(killers=[self.b])
        times = TestTimes(self.tree / "times.json")
        self.assertEqual((times.of(self.a), times.of(self.b)), (1.0, 1.0))
        self.assertEqual(times.of(Test("unknown", None, False)), 0)


class ResultsTest(TreeTest):
    def test_a_killed_mutant_counts_while_its_file_is_the_same_and_a_survivor_faces_new_tests(self):
        results = Results(self.tree / "results.jsonl")
        other = MUTANT._replace(name="def")
        results.add(MUTANT, "killed", "a_test", 1, "source", "tests")
        results.add(other, "survived", "", 1, "source", "tests")
        again = Results(self.tree / "results.jsonl")
        self.assertEqual(again.of(MUTANT, "source", "new tests")["outcome"], "killed")
        self.assertIsNone(again.of(MUTANT, "new source", "tests"))
        self.assertEqual(again.of(other, "source", "tests")["outcome"], "survived")
        self.assertIsNone(again.of(other, "source", "new tests"))
        self.assertEqual(again.of(other, "source", None)["outcome"], "survived")


    def test_the_line_of_a_result_is_that_of_today(self):
        results = Results(self.tree / "results.jsonl")
        results.add(MUTANT, "killed", "a_test", 1, "source", "tests")
        moved = MUTANT._replace(line=MUTANT.line + 5)
        self.assertEqual(results.of(moved, "source", "tests")["line"], moved.line)
        self.assertEqual(results.of(moved, "source", "tests")["by"], "a_test")

    def test_comments_texts_and_lines_do_not_change_the_fingerprint_of_code_and_numbers_do(self):
        def fingerprint(text):
            self.write("src/a.cpp", text)
            return code_fingerprint(self.tree / "src/a.cpp")

        code = fingerprint('int a = 1;  // one\nconst char* b = "b";\n')
        self.assertEqual(fingerprint('// begins\nint a =\n    1;\nconst char* b = "c";\n'), code)
        self.assertNotEqual(fingerprint('int a = 2;  // one\nconst char* b = "b";\n'), code)


class PageTest(TreeTest):
    def result(self, name, outcome, path="src/core/height/a.cpp"):
        return {**MUTANT._replace(name=name, path=path)._asdict(), "outcome": outcome, "by": "", "seconds": 1}

    def test_what_is_equivalent_counts_as_killed_and_is_named_with_its_reason(self):
        results = [self.result("a", "killed"), self.result("b", "survived"), self.result("c", "survived", "src/ros/a.cpp")]
        judged = {"b": {"verdict": "equivalent", "why": "a is zero here"}, "c": {"verdict": "survives", "why": "no test yet"}}
        text = page.render(results, judged, 1, 5)
        self.assertIn("| src/core/height | 2 | 1 | 1 | 0 | 100% |", text)
        self.assertIn("| src/ros | 1 | 0 | 0 | 1 | 0% |", text)
        self.assertIn("| all | 3 | 1 | 1 | 1 | 67% |", text)
        self.assertIn("3 of 5 mutants have been judged", text)
        self.assertIn("a is zero here", text)
        self.assertIn("no test yet", text)

    def test_a_verdict_needs_a_reason(self):
        self.write("judged.yaml", "a: {verdict: equivalent}\n")
        with self.assertRaisesRegex(ValueError, "a: expected where, verdict"):
            page.read_judged(self.tree / "judged.yaml")

    def test_the_verdicts_of_the_project_can_be_read(self):
        page.read_judged(SOURCE_DIR / "test/mutation/judged.yaml")


class ProgramTest(unittest.TestCase):
    def test_a_place_that_does_not_exist(self):
        result = run([SOURCE_DIR / "scripts/mutation", "src/nowhere"])
        self.assertEqual(result.returncode, 2)
        self.assertIn("src/nowhere: no such file or folder in the project", result.stderr)


if __name__ == "__main__":
    unittest.main()
