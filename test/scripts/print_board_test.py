import re
import tempfile
import unittest
import zlib
from pathlib import Path

from project import SOURCE_DIR, run


class PrintBoardTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = Path(folder.name) / "board.pdf"

    def print_board(self, *options):
        return run([SOURCE_DIR / "scripts/print_board", "--output", self.file, *options])

    def test_squares_have_their_true_size_on_the_page(self):
        result = self.print_board("--size", "8x6", "--square", "0.025")
        self.assertEqual(result.returncode, 0, result.stderr)
        data = self.file.read_bytes()
        page = [float(number) for number in re.search(rb"/MediaBox \[ ?([\d. ]+)\]", data)[1].split()]
        for points, metres in zip(page[2:], (0.297, 0.210)):
            self.assertAlmostEqual(points, metres / 0.0254 * 72, delta=0.01)
        drawing = b"".join(zlib.decompress(stream) for stream in re.findall(rb"stream\r?\n(x.*?)\r?\nendstream", data, re.S)
                           if stream[:1] == b"x")
        # Closed paths of four corners: "x y m x y l x y l x y l h".
        corner = rb"([\d.]+) ([\d.]+) "
        squares = [[float(number) for number in match] for match in
                   re.findall(corner + rb"m\s+" + (corner + rb"l\s+") * 3 + rb"h", drawing)]
        side = 0.025 / 0.0254 * 72
        squares = [s for s in squares if abs(max(s[0::2]) - min(s[0::2]) - side) < 0.01
                   and abs(max(s[1::2]) - min(s[1::2]) - side) < 0.01]
        self.assertEqual(len(squares), 32, "the dark ones of 9x7, the corners dark")

    def test_a_board_larger_than_the_paper_is_refused(self):
        result = self.print_board("--square", "0.04")
        self.assertEqual(result.returncode, 1)
        self.assertIn("9x7 squares of 0.04 m do not fit A4: at most 0.027 m", result.stderr)

    def test_squares_of_less_than_a_millimetre_are_refused(self):
        result = self.print_board("--size", "500x500")
        self.assertEqual(result.returncode, 1)
        self.assertIn("501x501 squares of a millimetre do not fit A4", result.stderr)

    def test_a_place_that_cannot_be_written_is_named(self):
        self.file = self.file / "below/board.pdf"
        result = self.print_board()
        self.assertEqual(result.returncode, 1)
        self.assertIn(f"print_board: {self.file}: cannot be written", result.stderr)

    def test_wrong_usage(self):
        self.assertEqual(self.print_board("--size", "8").returncode, 2)
        self.assertEqual(self.print_board("--square", "-1").returncode, 2)
