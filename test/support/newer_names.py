"""Names that Debian 12 has and Ubuntu 20.04 (ROS Noetic) has not, with the version in which each came.

Ubuntu 20.04: CMake 3.16, GCC 9, OpenCV 4.2, Eigen 3.3.7, yaml-cpp 0.6.2, Python 3.8, numpy 1.17, matplotlib 3.1, bash 5.0,
coreutils 8.30. The names of OpenCV, Eigen and yaml-cpp are missing in the headers of OpenCV 4.1.1, Eigen 3.3.7 and
yaml-cpp 0.6.2. Where only that is known, the version reads "after 4.1".

Each table: version, then patterns of that version. A pattern is a regular expression of whole words; parentheses and
dots stand for themselves when escaped.
"""

CPP = {
    "OpenCV after 4.1": (r"v_extract_n", r"v_broadcast_element", r"v_broadcast_highest", r"imcount", r"divSpectrums",
                         r"calibrateRobotWorldHandEye", r"CALIB_CB_(MARKER|LARGER)", r"estimateChessboardSharpness",
                         r"COLORMAP_DEEPGREEN", r"COLOR_Bayer(RGGB|BGGR|GRBG|GBRG)2\w+", r"IMWRITE_EXR_COMPRESSION\w*",
                         r"HOUGH_GRADIENT_ALT", r"INTER_NEAREST_EXACT", r"CCL_(SPAGHETTI|BOLELLI|SAUF|BBDT)",
                         r"fisheye::CALIB_ZERO_DISPARITY"),
    "OpenCV 4.4": (r"cv::SIFT",),
    "OpenCV 4.5": (r"USAC_[A-Z_]+", r"UsacParams", r"cv::(Dual)?Quat[df]?", r"setParallelForBackend",
                   r"reduceArg(Max|Min)", r"FaceDetectorYN", r"QRCodeEncoder", r"initInverseRectificationMap"),
    "OpenCV 4.5.4 (4.2 throws)": (r"createLineSegmentDetector", r"LineSegmentDetector"),
    "OpenCV 4.6": (r"transposeND",),
    "OpenCV 4.7": (r"stackBlur", r"hasNonZero", r"flipND", r"VTraits", r"v_(add|sub|mul|div|and|or|xor|eq|lt|gt)",
                   r"ArucoDetector"),
    "Eigen 3.4": (r"Eigen::(seq|seqN|all|last|lastp1|fix|placeholders|indexing)", r"Eigen::lastN", r"\.reshaped\(",
                  r"Eigen::((Row)?Vector[234X]?|(Matrix|Array)[234X]+)<", r"Eigen::bfloat16", r"\.(colwise|rowwise)\(\)\.begin\(",
                  r"completeOrthogonalDecomposition<"),
    "yaml-cpp 0.7": (r"YAML::(AnchorDict|DepthGuard|DeepRecursion)", r"YAML_CPP_STATIC_DEFINE"),
    "GCC 10": (r"__has_builtin", r"_mm256_(loadu2|storeu2)_m128i?"),
    "GCC 11": (r"_mm_(loadu|storeu)_si(16|32)", r"__builtin_bit_cast",
               r"std::(from|to)_chars(?=\([^;]*(double|float|std::chars_format))", r"std::chars_format"),
    "GCC 12": (r"hardware_(destructive|constructive)_interference_size", r"__builtin_assoc_barrier"),
    "C++17's parallel algorithms (TBB, which is no dependency)": (r"std::execution", r"#include <execution>"),
    "C++20": (r"#include <(span|bit|ranges|concepts|numbers|format|source_location|compare|coroutine|latch|barrier|"
              r"semaphore|stop_token|syncstream)>", r"std::(span|bit_cast|ranges|numbers|format|source_location|jthread|"
              r"midpoint|lerp|ssize|remove_cvref_t|type_identity_t|erase_if|countr_zero|countl_zero|popcount|bit_width|"
              r"strong_ordering|is_constant_evaluated|make_unique_for_overwrite)", r"\.(starts_with|ends_with)\(",
              r"(consteval|constinit|co_await|co_yield|co_return|requires|concept)"),
    "C++23": (r"#include <(expected|print|stacktrace|generator|mdspan|flat_map)>", r"std::(expected|print|println|"
              r"byteswap|to_underlying|unreachable)", r"if consteval"),
}

CMAKE = {
    "CMake 3.17": (r"ZIP_LISTS", r"CHECK_(START|PASS|FAIL)", r"CMAKE_CURRENT_FUNCTION_LIST_\w+", r"CMP0(098|099|10[0-2])"),
    "CMake 3.18": (r"cmake_language", r"NATURAL", r"ARCHIVE_(CREATE|EXTRACT)", r"file\(CONFIGURE", r"string\(HEX",
                   r"ECHO_(OUTPUT|ERROR)_VARIABLE", r"DEVICE_LINK", r"CMP010[3-8]"),
    "CMake 3.19": (r"string\(JSON", r"COMMAND_ERROR_IS_FATAL", r"file\(CHMOD", r"CHMOD_RECURSE", r"REAL_PATH",
                   r"DEFER", r"CMP0(109|11[0-4])"),
    "CMake 3.20": (r"cmake_path", r"DEPFILE", r"CXX_STANDARD 23", r"ctest --test-dir", r"CMP011[5-9]", r"CMP0120"),
    "CMake 3.21": (r"file\(COPY_FILE", r"NO_CACHE", r"PROJECT_IS_TOP_LEVEL", r"RUNTIME_DEPENDENC(IES|Y_SET)",
                   r"IMPORTED_RUNTIME_ARTIFACTS", r"TARGET_RUNTIME_DLLS", r"CMP012[1-8]"),
    "CMake 3.22": (r"ENVIRONMENT_MODIFICATION",),
    "CMake 3.23": (r"FILE_SET", r"INITIALIZE_FROM_VARIABLE", r"CMP0(129|13[01])"),
    "CMake 3.24": (r"PATH_EQUAL", r"LINK_(LIBRARY|GROUP):", r"OVERRIDE_FIND_PACKAGE", r"COMPILE_WARNING_AS_ERROR",
                   r"CMP013[2-9]"),
    "CMake 3.25": (r"block\(", r"endblock\(", r"PROPAGATE", r"VALIDATOR", r"CMP014[0-9]"),
    "GCC 10": (r"-fanalyzer", r"-fallow-store-data-races", r"-std=(c|gnu)\+\+20", r"CXX_STANDARD 20"),
    "GCC 11": (r"-march=x86-64-v[234]", r"-std=(c|gnu)\+\+23"),
    "GCC 12": (r"-ftrivial-auto-var-init\S*",),
}

SHELL = {
    "bash 5.1": (r"wait -p", r"SRANDOM", r"\$\{\w+@[ULu]\}"),
    "bash 5.2": (r"patsub_replacement", r"varredir_close"),
    "CMake 3.20": (r"ctest (\S+ )*--test-dir",),
    "CMake 3.21": (r"--output-junit",),
    "CMake 3.24": (r"cmake (\S+ )*--fresh",),
    "CMake 3.17": (r"cmake -E (rm|cat)",),
    "coreutils 8.31": (r"basenc",),
    "coreutils 9": (r"ls (-\S+ )*--zero", r"cksum (-\S+ )*-a", r"cp (-\S+ )*--update=\w+"),
}

# Of these a name counts wherever it stands as an attribute or is imported.
PYTHON_NAMES = {
    "Python 3.9": {"removeprefix", "removesuffix", "is_relative_to", "with_stem", "randbytes", "nextafter", "ulp", "lcm",
                   "BooleanOptionalAction", "unparse", "waitstatus_to_exitcode", "pidfd_open", "to_thread"},
    "Python 3.10": {"pairwise", "bit_count", "aclosing", "assertNoLogs", "TypeAlias", "ParamSpec", "hardlink_to"},
    "Python 3.11": {"StrEnum", "ExceptionGroup", "TaskGroup", "file_digest", "cbrt", "exp2", "enterContext",
                    "addModuleCleanup", "UTC"},
    "Python 3.12": {"batched", "walk_up"},
    "numpy 1.20": {"sliding_window_view", "broadcast_shapes"},
    "matplotlib 3.3": {"axline", "subplot_mosaic"},
    "matplotlib 3.4": {"supxlabel", "supylabel", "bar_label", "subfigures"},
    "OpenCV 4.5": {"reduceArgMax", "reduceArgMin", "FaceDetectorYN", "QRCodeEncoder", "USAC_MAGSAC", "USAC_DEFAULT"},
    "OpenCV 4.5.4 (4.2 throws)": {"createLineSegmentDetector"},
    "OpenCV 4.7": {"stackBlur", "hasNonZero", "ArucoDetector", "CharucoDetector"},
}
PYTHON_MODULES = {"zoneinfo": "Python 3.9", "graphlib": "Python 3.9", "tomllib": "Python 3.11"}
# Members of one module, whose names others have as well.
PYTHON_MEMBERS = {("functools", "cache"): "Python 3.9", ("contextlib", "chdir"): "Python 3.11",
                  ("statistics", "covariance"): "Python 3.10", ("statistics", "correlation"): "Python 3.10"}
# Arguments: function's name, argument.
PYTHON_ARGUMENTS = {
    ("zip", "strict"): "Python 3.10", ("dataclass", "slots"): "Python 3.10", ("dataclass", "kw_only"): "Python 3.10",
    ("ArgumentParser", "exit_on_error"): "Python 3.9", ("shutdown", "cancel_futures"): "Python 3.9",
    ("basicConfig", "encoding"): "Python 3.9", ("write_text", "newline"): "Python 3.10",
    ("TemporaryDirectory", "ignore_cleanup_errors"): "Python 3.10", ("TemporaryDirectory", "delete"): "Python 3.12",
    ("rmtree", "onexc"): "Python 3.12", ("run", "process_group"): "Python 3.11", ("Popen", "process_group"): "Python 3.11",
    ("subplots", "layout"): "matplotlib 3.5", ("figure", "layout"): "matplotlib 3.5",
    ("legend", "labelcolor"): "matplotlib 3.3",
}
