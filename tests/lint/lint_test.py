#!/usr/bin/env python3
"""Every rule of the lint can fail, and passes what it should pass."""

import tempfile
import unittest
from pathlib import Path

import cpp
import rules
from tree import Tree

HOME = "/ho" + "me/"  # spelt apart, or the rule would find it here


def findings(rule, files):
    with tempfile.TemporaryDirectory() as root:
        for path, text in files.items():
            file = Path(root, path)
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_bytes(text if isinstance(text, bytes) else text.encode())
        return [str(finding) for finding in rule(Tree(root))]


class LintTest(unittest.TestCase):
    def assert_finds(self, rule, path, text, words):
        found = findings(rule, {path: text})
        self.assertEqual(len(found), 1, found)
        self.assertIn(path, found[0])
        self.assertIn(words, found[0])

    def assert_clean(self, rule, path, text):
        self.assertEqual(findings(rule, {path: text}), [])


class Layers(LintTest):
    def test_lower_folder_may_not_include_higher(self):
        for path, include in (("capture/run.cc", "optics/a.h"), ("capture/base/a.cc", "capture/run.h"),
                              ("optics/a.cc", "capture/camera/camera.h"), ("optics/a.cc", "fit/a.h"),
                              ("fit/a.cc", "capture/recording/reader.h"), ("fit/a.cc", "service/a.h"),
                              ("service/a.cc", "tests/support/a.h"), ("fit/a.cc", "eyebox/v1/rig.pb.h"),
                              ("capture/camera/a.cc", "eyebox/v1/rig.pb.h")):
            with self.subTest(path=path, include=include):
                self.assert_finds(rules.layers, path, f'#include "{include}"\n', "may not include")

    def test_higher_folder_may_include_lower(self):
        for path, include in (("capture/camera/replay/a.cc", "capture/recording/reader.h"),
                              ("optics/a.cc", "capture/base/frame.h"), ("fit/a.cc", "optics/a.h"),
                              ("service/a.cc", "eyebox/v1/rig.pb.h"), ("tests/fit/a.cc", "service/a.h"),
                              ("capture/recording/a.cc", "eyebox/v1/rig.pb.h")):
            with self.subTest(path=path, include=include):
                self.assert_clean(rules.layers, path, f'#include "{include}"\n')

    def test_include_in_a_comment_or_string_does_not_count(self):
        self.assert_clean(rules.layers, "fit/a.cc",
                          '/*\n#include "service/a.h"\n*/\nauto s = R"(\n#include "service/a.h"\n)";\n')

    def test_cpp_in_an_unknown_folder_is_found(self):
        self.assert_finds(rules.layers, "misc/a.cc", "int a;\n", "does not know")


class ThirdParty(LintTest):
    def test_library_outside_its_place_is_found(self):
        for path, include in (("service/a.cc", "hdf5.h"), ("capture/recording/a.h", "hdf5.h"),
                              ("capture/run.cc", "arv.h"), ("capture/camera/v4l2.cc", "linux/videodev2.h"),
                              ("service/a.cc", "gpiod.h"), ("optics/a.cc", "iio.h"),
                              ("capture/a.cc", "opencv2/imgproc.hpp"), ("fit/a.cc", "opencv2/core.hpp"),
                              ("optics/a.cc", "png.h"), ("fit/a.h", "ceres/ceres.h"),
                              ("optics/a.cc", "ceres/ceres.h"), ("fit/a.cc", "grpcpp/grpcpp.h"),
                              ("service/a.cc", "CLI/App.hpp"), ("fit/a.cc", "iostream"),
                              ("optics/a.cc", "spdlog/spdlog.h"), ("service/a.cc", "gtest/gtest.h"),
                              ("optics/a.cc", "google/protobuf/message.h"),
                              ("capture/recording/a.cc", "eyebox/v1/rig.grpc.pb.h")):
            with self.subTest(path=path, include=include):
                self.assert_finds(rules.third_party, path, f"#include <{include}>\n", "belongs in")

    def test_library_in_its_place_passes(self):
        for path, include in (("capture/recording/a.cc", "hdf5.h"), ("optics/a.cc", "opencv2/imgproc.hpp"),
                              ("capture/base/png.cc", "png.h"), ("fit/a.h", "vector"),
                              ("capture/camera/v4l2/a.cc", "linux/videodev2.h"), ("fit/a.cc", "ceres/ceres.h"),
                              ("service/cli/a.h", "CLI/App.hpp"), ("tests/fit/a.cc", "ceres/ceres.h")):
            with self.subTest(path=path, include=include):
                self.assert_clean(rules.third_party, path, f"#include <{include}>\n")

    def test_unknown_library_is_found(self):
        self.assert_finds(rules.third_party, "fit/a.cc", "#include <fftw3.h>\n", "in no row")

    def test_include_beside_instead_of_from_the_root_is_found(self):
        self.assert_finds(rules.third_party, "fit/a.cc", '#include "a.h"\n', "from the root")


class Bans(LintTest):
    def test_printing_below_service_is_found(self):
        for line in ('std::cout << 1;', 'printf("a");', 'std::fprintf(f, "a");', 'fmt::print("a");',
                     'spdlog::info("a");', 'puts("a");'):
            with self.subTest(line=line):
                self.assert_finds(rules.banned_code, "fit/a.cc", f"void F() {{ {line} }}\n", "printing")
                self.assert_clean(rules.banned_code, "service/a.cc", f"void F() {{ {line} }}\n")

    def test_formatting_is_no_printing(self):
        self.assert_clean(rules.banned_code, "fit/a.cc", 'snprintf(b, 9, "%d", 1);  // printf(\n')

    def test_exceptions_are_found(self):
        self.assert_finds(rules.banned_code, "optics/a.cc", "throw 1;\n", "throw")

    def test_using_namespace_in_a_header_is_found(self):
        self.assert_finds(rules.banned_code, "fit/a.h", "using namespace std;\n", "using namespace")
        self.assert_clean(rules.banned_code, "fit/a.cc", "using namespace std::chrono_literals;\n")

    def test_path_of_a_machine_is_found(self):
        self.assert_finds(rules.banned_text, "README.md", f"see {HOME}me/data\n", "one machine")
        self.assert_clean(rules.banned_text, "README.md", "tests/home/a and $HOME/root/b\n")

    def test_folder_beside_the_project_is_found_outside_tests(self):
        self.assert_finds(rules.banned_text, "fit/a.cc", "// ../shared/reference\n", "beside the project")
        self.assert_clean(rules.banned_text, "tests/a.cc", "// ../shared/reference\n")

    def test_globbed_sources_are_found(self):
        self.assert_finds(rules.banned_text, "fit/CMakeLists.txt", "file(GLOB s *.cc)\n", "by name")

    def test_fast_math_is_found(self):
        self.assert_finds(rules.banned_text, "CMakePresets.json", '"-ffast-math"\n', "fast-math")


class Sizes(LintTest):
    def test_file_of_401_lines_is_found(self):
        self.assert_finds(rules.file_length, "fit/a.cc", "int a;\n" * 401, "401 lines")
        self.assert_clean(rules.file_length, "fit/a.cc", "int a;\n" * 400)

    def test_function_of_61_lines_is_found(self):
        body = "  Do();\n"
        for head in ("void F() {\n", "TEST(A, B) {\n", "int A::F(int x) const noexcept {\n",
                     "A::A(int x) : a_{x}, b_(x) {\n", "auto F() -> std::vector<int> {\n",
                     "bool operator==(const A& a) {\n", "const auto f = [](int x) {\n",
                     "void F(const Options& o = {}) {\n", "template <typename T>requires C<T>T F() {\n"):
            with self.subTest(head=head):
                self.assert_finds(rules.function_length, "fit/a.cc",
                                  "namespace a {\n" + head + body * 59 + "}\n}\n", "61 lines")
                self.assert_clean(rules.function_length, "fit/a.cc",
                                  "namespace a {\n" + head + body * 58 + "}\n}\n")

    def test_python_function_of_61_lines_is_found(self):
        self.assert_finds(rules.function_length, "a.py", "def f():\n" + "    g()\n" * 60, "61 lines")

    def test_classes_tables_and_namespaces_are_no_functions(self):
        text = ("namespace a {\nclass alignas(8) A : public B {\n public:\n  int f() { return 1; }\n"
                + "  int a = 0;\n" * 70 + "};\nconst int t[] = {\n" + "  1,\n" * 70 + "};\n}\n")
        self.assertEqual([f.name for f in cpp.functions_of(text)], ["f"])
        self.assert_clean(rules.function_length, "fit/a.cc", text)

    def test_braces_in_strings_and_macros_do_not_count(self):
        text = ('#define OPEN \\\n  {\nvoid F() {\n  a = "{{{";\n  b = \'{\';\n  c = 1\'000;\n}\n'
                'void G() {\n  d = R"x({)x";\n}\n')
        self.assertEqual([(f.name, f.lines) for f in cpp.functions_of(text)], [("F", 5), ("G", 3)])


class Form(LintTest):
    def test_guard_that_is_not_the_path_is_found(self):
        guard = "EYEBOX_FIT_A_H_"
        text = "// About.\n#ifndef {0}\n#define {0}\n#endif  // {0}\n"
        self.assert_clean(rules.include_guards, "fit/a.h", text.format(guard))
        self.assert_finds(rules.include_guards, "fit/a.h", text.format("A_H"), guard)
        self.assert_finds(rules.include_guards, "fit/a.h", "#pragma once\n", guard)

    def test_space_at_the_end_of_a_line_is_found(self):
        self.assert_finds(rules.whitespace, "a.txt", "a \n", "space at the end")
        self.assert_finds(rules.whitespace, "a.txt", "a", "newline")

    def test_binary_files_are_left_alone(self):
        self.assert_clean(rules.whitespace, "a.npy", b"\0 \n")

    def test_link_to_nothing_is_found(self):
        self.assert_finds(rules.links, "doc/README.md", "[a](gone.md#there)\n", "does not exist")
        self.assert_clean(rules.links, "doc/README.md", "[a](README.md#there) [b](https://a.org/)\n")

    def test_unformatted_code_is_found(self):
        self.assert_finds(rules.formatted, "fit/a.cc", "int  a ;\n", "clang-format -i")
        self.assert_clean(rules.formatted, "fit/a.cc", "int a;\n")


if __name__ == "__main__":
    unittest.main()
