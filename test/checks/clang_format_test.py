import shutil
import unittest

from project import SOURCE_DIR, run


class ClangFormatTest(unittest.TestCase):
    @unittest.skipUnless(shutil.which("clang-format"), "clang-format is not installed")
    def test_sources_are_formatted_as_the_clang_format_file_says(self):
        sources = [path for folder in ("include", "src", "test", "benchmark", "examples")
                   for pattern in ("*.h", "*.cpp") for path in (SOURCE_DIR / folder).rglob(pattern)]
        self.assertTrue(sources)
        result = run(["clang-format", "--dry-run", "--Werror", "--ferror-limit=1", *sources])
        self.assertEqual(result.returncode, 0, "run clang-format -i on:\n" + result.stderr)
