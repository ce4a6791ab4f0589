import os
import sys
import tempfile
import unittest
from pathlib import Path
from unittest import mock

from project import SOURCE_DIR, run

sys.path.insert(0, str(SOURCE_DIR / "scripts"))

from container.checks import check, check_image  # noqa: E402 (they stand in scripts/)
from container.dockerfile import NotUnderstood, parse  # noqa: E402
from container.rooms import Failed, Room, copy, ignored  # noqa: E402

TWO_STAGES = """# Comment
FROM debian:12 AS build
RUN one && \\
    # a comment between
    two
COPY a b folder/
FROM debian:12-slim
COPY --from=build /opt/x /opt/x
ENV A=1 B="two words"
USER pilot
ENTRYPOINT ["/bin/entry", "x"]
"""


class DockerfileTest(unittest.TestCase):
    def refusal(self, text):
        with self.assertRaises(NotUnderstood) as caught:
            parse(text)
        return str(caught.exception)

    def test_ours_has_two_stages_and_ends_with_a_user_who_is_not_root(self):
        stages = parse((SOURCE_DIR / "Dockerfile").read_text())
        self.assertEqual([stage.name for stage in stages], ["build", "runtime"])
        users = [step.arguments for step in stages[-1].steps if step.kind == "USER"]
        self.assertTrue(users and users[-1] not in ("root", "0"), users)
        self.assertEqual([step.kind for step in stages[-1].steps][-1], "ENTRYPOINT")

    def test_instructions_become_stages_of_steps(self):
        build, last = parse(TWO_STAGES)
        self.assertEqual((build.base, last.base, last.name), ("debian:12", "debian:12-slim", "1"))
        self.assertEqual([tuple(step) for step in build.steps],
                         [(3, "RUN", "one && two"), (6, "COPY", (None, ["a", "b"], "folder/"))])
        self.assertEqual([step.arguments for step in last.steps],
                         [("build", ["/opt/x"], "/opt/x"), {"A": "1", "B": "two words"}, "pilot", ["/bin/entry", "x"]])

    def test_what_is_not_understood_is_refused_with_its_line(self):
        for text, wanted in (
                ("FROM debian:12\nLABEL a=b\n", "line 2: LABEL is not understood, only FROM, RUN, COPY, ENV, USER, WORKDIR, ENTRYPOINT"),
                ("FROM debian:12\nENV A=$B\n", "line 2: ENV has a variable; write out its value"),
                ("FROM debian:12\n\nCOPY --from=build a b\n", "line 3: COPY --from=build: there is no such stage before"),
                ("FROM debian:12 AS build\nCOPY --from=build a b\n", "line 2: COPY --from=build: there is no such stage before"),
                ("FROM debian:12\nCOPY *.cpp b\n", "line 2: COPY has to be names of sources and a destination, without * ? ["),
                ("FROM debian:12\nENTRYPOINT entry\n", 'line 2: ENTRYPOINT has to be a list, for example ["/bin/entry"]'),
                ("FROM --platform=arm64 debian:12\n", "line 1: FROM has to be FROM IMAGE or FROM IMAGE AS STAGE"),
                ("RUN make\n", "line 1: RUN before the first FROM"),
                ("FROM debian:12\nRUN make \\\n", "line 2: ends in a backslash, and nothing follows"),
                ("FROM debian:12\nRUN cat <<EOF\n", "line 2: RUN has to be a plain command of the shell: no list, no options, no text "
                                                    "that follows"),
                ("", "has no FROM")):
            with self.subTest(text=text):
                self.assertEqual(self.refusal(text), wanted)


class RoomTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.context, self.room = Path(folder.name, "context"), Path(folder.name, "room")
        (self.context / "src/build").mkdir(parents=True)
        (self.context / "build-x").mkdir()
        (self.context / "src/build/a.cpp").write_text("a")
        (self.context / "b").write_text("b")
        self.room.mkdir()

    def test_a_copied_folder_leaves_out_what_is_ignored_at_the_top(self):
        copy(self.context, ["."], self.room, True, ["build*"])
        self.assertEqual(sorted(os.listdir(str(self.room))), ["b", "src"])
        self.assertTrue((self.room / "src/build/a.cpp").is_file())

    def test_files_go_into_a_folder_or_get_the_name_of_the_destination(self):
        copy(self.context, ["b", "src/build/a.cpp"], self.room / "to", True, [])
        copy(self.context, ["b"], self.room / "as/c", False, [])
        self.assertEqual(sorted(os.listdir(str(self.room / "to"))), ["a.cpp", "b"])
        self.assertEqual((self.room / "as/c").read_text(), "b")
        with self.assertRaises(Failed) as caught:
            copy(self.context, ["c"], self.room, True, [])
        self.assertEqual(str(caught.exception), "COPY c: there is no such file")

    def test_patterns_that_only_an_engine_knows_are_refused(self):
        (self.context / ".dockerignore").write_text("# x\nbuild*\n!build\n")
        with self.assertRaises(Failed):
            ignored(self.context)
        self.assertIn(".git", ignored(SOURCE_DIR))

    def test_a_user_who_does_not_exist_is_refused(self):
        (self.room / "etc").mkdir()
        (self.room / "etc/passwd").write_text("root:x:0:0:root:/root:/bin/bash\n")
        room = Room(self.room)
        self.assertEqual(room.home(), "/root")
        room.user = "pilot"
        with self.assertRaises(Failed):
            room.home()


class LastStage:
    """A room whose commands end as given."""

    def __init__(self, status=0, output="", user="pilot", entry=("/bin/entry",)):
        self.result = mock.Mock(returncode=status, stdout=output)
        self.user, self.entry, self.commands = user, entry, []

    def run(self, words, **_):
        self.commands.append(words)
        return self.result


class ChecksTest(unittest.TestCase):
    def refusal(self, function, *arguments):
        with self.assertRaises(Failed) as caught:
            function(*arguments)
        return str(caught.exception)

    def test_a_last_stage_of_root_or_without_entry_point_is_refused(self):
        self.assertEqual(self.refusal(check_image, LastStage(user="root")), "the last stage has no USER: it would run as root")
        self.assertEqual(self.refusal(check_image, LastStage(entry=())),
                         "the last stage has no ENTRYPOINT: commands would not find the package")

    def test_a_check_fails_by_its_status_or_for_want_of_the_text(self):
        self.assertEqual(self.refusal(check, LastStage(status=1, output="libx.so => not found"), "libraries", "true"),
                         "libraries: failed:\nlibx.so => not found")
        self.assertEqual(self.refusal(check, LastStage(output="a"), "text", "true", "b"), "text: failed:\na")

    def test_checks_go_through_the_entry_point(self):
        room = LastStage(output="yes")
        self.assertEqual(check(room, "all", "true", "yes"), "yes")
        self.assertEqual(room.commands, [["/bin/entry", "bash", "-c", "true"]])


class TestContainerTest(unittest.TestCase):
    def test_a_missing_dockerfile_is_one_line(self):
        result = run([SOURCE_DIR / "scripts/test_container", "--dockerfile", "/nowhere/Dockerfile"])
        self.assertEqual((result.returncode, len(result.stderr.splitlines())), (1, 1))
        self.assertIn("/nowhere/Dockerfile", result.stderr)
