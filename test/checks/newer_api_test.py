import unittest

import newer_api
from project import SOURCE_DIR


def found(scanner, text):
    return [(finding.line, finding.api, finding.version) for finding in scanner("file", text)]


class NewerApiTest(unittest.TestCase):
    def test_sources_use_nothing_newer_than_ubuntu_20_04(self):
        findings = newer_api.newer_api(SOURCE_DIR)
        self.assertEqual(findings, [], "\n" + "\n".join(
            f"{finding.file}:{finding.line}: {finding.api} came with {finding.version}; "
            "ROS Noetic runs on Ubuntu 20.04, which has an older one" for finding in findings))

    def test_all_languages_are_looked_at(self):
        scanners = {str(path.relative_to(SOURCE_DIR)): newer_api.language(path)
                    for path in newer_api.sources(SOURCE_DIR)}
        for file, scanner in {"CMakeLists.txt": newer_api.in_cmake, "cmake/core.cmake": newer_api.in_cmake,
                              "src/core/kernels/edges/edge_growth.cpp": newer_api.in_cpp, ".ci/run": newer_api.in_shell,
                              "include/uav_landing/base/failure.h": newer_api.in_cpp,
                              "scripts/build": newer_api.in_shell, "scripts/usage.bash": newer_api.in_shell,
                              "scripts/process_bags": newer_api.in_python, "src/tools/evaluate": newer_api.in_python,
                              "test/support/project.py": newer_api.in_python}.items():
            self.assertEqual(scanners.get(file), scanner, file)


class NewerCppTest(unittest.TestCase):
    def test_newer_functions_of_libraries_are_named_with_line_and_version(self):
        for text, expected in {
                "int a;\ncv::stackBlur(image, image, size);": (2, "stackBlur", "OpenCV 4.7"),
                "cv::findHomography(a, b, cv::USAC_MAGSAC);": (1, "USAC_MAGSAC", "OpenCV 4.5"),
                "auto lsd = cv::createLineSegmentDetector();":
                    (1, "createLineSegmentDetector", "OpenCV 4.5.4 (4.2 throws)"),
                "cv::v_extract_n<1>(row);": (1, "v_extract_n", "OpenCV after 4.1"),
                "rows(Eigen::seq(1, 3), 0)": (1, "Eigen::seq", "Eigen 3.4"),
                "m = v.reshaped(2, 3);": (1, ".reshaped(", "Eigen 3.4"),
                "Eigen::Matrix3<T> rotation;": (1, "Eigen::Matrix3<", "Eigen 3.4"),
                "std::from_chars(first, last, number, std::chars_format::fixed);":
                    (1, "std::from_chars", "GCC 11"),
                "#include <execution>": (1, "#include <execution>",
                                         "C++17's parallel algorithms (TBB, which is no dependency)"),
                "/* two\nlines */ #include <span>": (2, "#include <span>", "C++20"),
                "if (name.starts_with(prefix))": (1, ".starts_with(", "C++20"),
        }.items():
            with self.subTest(text=text):
                self.assertIn(expected, found(newer_api.in_cpp, text))

    def test_old_functions_comments_and_texts_are_no_finding(self):
        for text in ("cv::GaussianBlur(a, b, {}, 1);", "Eigen::Matrix<double, 3, 3> m;", "std::from_chars(a, b, count);",
                     "// cv::stackBlur", "/* std::span */", 'throw Error("cv::stackBlur is missing");',
                     "std::filesystem::path p;", "char c = '\"'; // std::span \"", "int concepts, requires_more;"):
            with self.subTest(text=text):
                self.assertEqual(found(newer_api.in_cpp, text), [])

    def test_a_quote_within_a_character_or_comment_hides_nothing(self):
        for text in ("char c = '\"'; std::span s;", "// it's \"\nstd::span s;", 'call("//"); std::span s;',
                     'R"x(")x" std::span s;'):
            with self.subTest(text=text):
                self.assertIn("std::span", [api for _, api, _ in found(newer_api.in_cpp, text)])


class NewerCMakeTest(unittest.TestCase):
    def test_newer_commands_policies_and_flags_are_found(self):
        for text, expected in {
                "cmake_minimum_required(VERSION 3.20)": (1, "cmake_minimum_required", "CMake 3.20"),
                "# first\ncmake_path(GET file STEM name)": (2, "cmake_path", "CMake 3.20"),
                "file(REAL_PATH a b)": (1, "REAL_PATH", "CMake 3.19"),
                "add_custom_command(OUTPUT a DEPFILE b)": (1, "DEPFILE", "CMake 3.20"),
                "cmake_policy(SET CMP0115 NEW)": (1, "CMP0115", "CMake 3.20"),
                "foreach(a b IN ZIP_LISTS c d)": (1, "ZIP_LISTS", "CMake 3.17"),
                "add_compile_options(-std=c++20)": (1, "-std=c++20", "GCC 10"),
        }.items():
            with self.subTest(text=text):
                self.assertIn(expected, found(newer_api.in_cmake, text))

    def test_old_commands_and_comments_are_no_finding(self):
        text = "cmake_minimum_required(VERSION 3.16)\n# cmake_path\nfile(CREATE_LINK a b SYMBOLIC)\ncmake_policy(SET CMP0097 NEW)"
        self.assertEqual(found(newer_api.in_cmake, text), [])


class NewerPythonTest(unittest.TestCase):
    def test_newer_syntax_names_and_arguments_are_found(self):
        for text, api, version in (
                ("match x:\n  case 1: pass", "syntax", "Python 3.10"),
                ("with (open(a) as b, open(c) as d): pass", "syntax", "Python 3.9"),
                ("name.removeprefix('a')", "removeprefix", "Python 3.9"),
                ("path.is_relative_to(root)", "is_relative_to", "Python 3.9"),
                ("from functools import cache", "cache", "Python 3.9"),
                ("import functools\n@functools.cache\ndef f(): pass", "cache", "Python 3.9"),
                ("x = {**a} | b", "dict | dict", "Python 3.9"),
                ("def f(x: list[int]): pass", "list[...]", "Python 3.9"),
                ("def f() -> int | None: pass", "X | Y for types", "Python 3.10"),
                ("zip(a, b, strict=True)", "zip(strict=)", "Python 3.10"),
                ("import tomllib", "tomllib", "Python 3.11"),
                ("from math import nextafter", "nextafter", "Python 3.9"),
                ("plt.subplots(layout='constrained')", "subplots(layout=)", "matplotlib 3.5"),
                ("cv2.stackBlur(a, (3, 3))", "stackBlur", "OpenCV 4.7")):
            with self.subTest(text=text):
                findings = newer_api.in_python("file", text)
                self.assertTrue(any(finding.api.startswith(api) and finding.version == version for finding in findings),
                                findings)

    def test_python_3_8_is_no_finding(self):
        for text in ("if (n := len(a)) > 1: pass", "def f(a, /, b): pass", "shutil.copytree(a, b, dirs_exist_ok=True)",
                     "from __future__ import annotations\ndef f(x: list[int] | None): pass", "flags = a | b",
                     "message.pose.covariance", "# name.removeprefix('a')", "lists[0]"):
            with self.subTest(text=text):
                self.assertEqual(found(newer_api.in_python, text), [])


class NewerShellTest(unittest.TestCase):
    def test_newer_options_are_found(self):
        for text, expected in {
                "cd build\nctest -j2 --test-dir build": (2, "ctest -j2 --test-dir", "CMake 3.20"),
                "wait -p finished": (1, "wait -p", "bash 5.1"),
                'echo "${name@U}"': (1, "${name@U}", "bash 5.1"),
                "cmake --fresh -B build": (1, "cmake --fresh", "CMake 3.24"),
        }.items():
            with self.subTest(text=text):
                self.assertIn(expected, found(newer_api.in_shell, text))

    def test_old_options_and_comments_are_no_finding(self):
        for text in ("cmake -S . -B build", "wait $pid", "# ctest --test-dir build", "echo ${#files[@]} ${name@Q}"):
            with self.subTest(text=text):
                self.assertEqual(found(newer_api.in_shell, text), [])
