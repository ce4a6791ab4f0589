import unittest

from project import rosrun


class RosrunTest(unittest.TestCase):
    def test_every_program_starts_from_the_build_in_the_source_folder(self):
        for program in ("process_bag", "dataset_to_bag", "simulate_approach", "simulate_campaign", "evaluate",
                        "convert_recording"):
            with self.subTest(program=program):
                result = rosrun(program, "--help")
                self.assertEqual(result.returncode, 0, result.stdout + result.stderr)


if __name__ == "__main__":
    unittest.main()
