"""The check of the layout sees what breaks its rules, or its verdict means nothing."""

import pathlib
import tempfile
import unittest

import check
import file_names


def tree(folder, files):
    for name, text in files.items():
        path = pathlib.Path(folder) / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


class Layout(unittest.TestCase):
    def complaints(self, files):
        with tempfile.TemporaryDirectory() as folder:
            tree(folder, {"gateway/a/CMakeLists.txt": "rmac_room(a)", "gateway/b/CMakeLists.txt": "rmac_room(b USES rmac_a)", **files})
            before, check.ROOT = check.ROOT, pathlib.Path(folder).resolve()
            try:
                found, sources = [], check.sources()
                check.check_folders(sources, found)
                check.check_circles(check.arrows(sources), found)
                check.check_arrows(sources, found)
                check.check_classes(sources, found)
                return found + list(file_names.shared_names(sources, check.ROOT))
            finally:
                check.ROOT = before

    def test_passes_an_arrow_that_the_target_names(self):
        self.assertEqual(self.complaints({"gateway/a/x.hpp": "", "gateway/b/y.cpp": '#include "gateway/a/x.hpp"\n'}), [])

    def test_refuses_an_arrow_that_the_target_does_not_name(self):
        found = self.complaints({"gateway/b/y.hpp": "", "gateway/a/x.cpp": '#include "gateway/b/y.hpp"\n'})
        self.assertEqual(len(found), 1)
        self.assertIn("gateway/a/CMakeLists.txt names none of rmac_b", found[0])

    def test_refuses_a_circle(self):
        found = self.complaints({"gateway/a/x.hpp": '#include "gateway/b/y.hpp"\n', "gateway/b/y.hpp": '#include "gateway/a/x.hpp"\n'})
        self.assertIn("gateway/a -> gateway/b -> gateway/a", found[0])

    def test_refuses_what_motion_must_not_know(self):
        found = self.complaints({"fieldbus/include/rmac/fieldbus/x.hpp": "", "motion/CMakeLists.txt": "add_library(rmac_motion x.cpp)",
                                 "motion/src/y.cpp": '#include "rmac/fieldbus/x.hpp"\n'})
        self.assertIn("motion must not know fieldbus", found[0])

    def test_refuses_an_include_of_a_program(self):
        found = self.complaints({"gateway/p/CMakeLists.txt": "add_executable(p main.cpp)", "gateway/p/x.hpp": "",
                                 "gateway/b/y.cpp": '#include "gateway/p/x.hpp"\n'})
        self.assertIn("which belongs to a program", found[0])

    def test_refuses_a_crowded_folder(self):
        found = self.complaints({f"gateway/a/x{i}.hpp": "" for i in range(26)})
        self.assertEqual(found, ["gateway/a: 26 source files; 25 is the most, give parts of it rooms of their own"])

    def test_counts_methods_and_fields_of_a_class(self):
        def body(methods, fields):
            return "class X {\n public:\n" + "".join(f"  void m{i}(int a, int b = 0) const noexcept;\n" for i in range(methods)) + \
                " private:\n" + "".join(f"  std::map<int, std::function<void(int)>> f{i}_{{}};  ///< a (b)\n" for i in range(fields)) + "};\n"
        self.assertEqual(self.complaints({"gateway/a/x.hpp": body(30, 20)}), [])
        self.assertIn("X has 31 methods", self.complaints({"gateway/a/x.hpp": body(31, 20)})[0])
        self.assertIn("X has 21 fields", self.complaints({"gateway/a/x.hpp": body(30, 21)})[0])

    def test_counts_methods_that_are_written_in_the_class(self):
        inline = "class X {\n" + "".join(f"  int m{i}() const {{ return f(); }}\n" for i in range(31)) + "};\n"
        self.assertIn("X has 31 methods", self.complaints({"gateway/a/x.hpp": inline})[0])

    def test_counts_members_of_a_class_that_a_source_keeps_to_itself(self):
        def source(methods, fields):
            return "struct X::Impl {\n" + "".join(f"  void m{i}() {{ f(); }}\n" for i in range(methods)) + \
                "".join(f"  int f{i} = 0;\n" for i in range(fields)) + "};\nvoid X::call() { impl_->m0(); }\n"
        self.assertEqual(self.complaints({"gateway/a/x.cpp": source(30, 20)}), [])
        self.assertEqual(self.complaints({"gateway/a/x.cpp": source(31, 20)}), ["gateway/a/x.cpp: X::Impl has 31 methods; 30 is the most"])
        self.assertEqual(self.complaints({"gateway/a/x.cpp": source(30, 21)}), ["gateway/a/x.cpp: X::Impl has 21 fields; 20 is the most"])

    def test_takes_no_literal_and_no_comment_for_code(self):
        for text in ('R"({"a": {")"', 'R"x({ )" )x"', '"https://a{"', '"\\"{"', "'{'", "'\"'", "'\\''", "10'000 + 1'0", "0; // {\n  int c = 0", "0 /* { */"):
            source = f"class X {{\n  T a = {text};\n  int b = 0;\n}};\nclass Y {{\n  int c = 0;\n}};\n"
            found = [(name, check.members(body)[0]) for name, body in check.bodies(source)]
            self.assertEqual(found, [("X", 0), ("Y", 0)], text)

    def test_refuses_a_name_of_one_source_that_another_says(self):
        for own, kind in {"namespace {\nint check(int a) { return a; }\n}": "check(2)", "static int check(int);": "check<int>(2)",
                          "namespace {\nconstexpr int kMost{2};\n}": "kMost + 1", "namespace {\nstruct Options {\n  int a;\n};\n}": "Options()",
                          "namespace a {\nnamespace {\nenum class Way { A };\n}\n}": "Way::A", "using Json = int;": "Json()"}.items():
            found = self.complaints({"gateway/a/x.cpp": own + "\n", "gateway/a/y.cpp": f"int other() {{ return {kind}; }}\n"})
            self.assertEqual(len(found), 1, own)
            self.assertIn("is this file's own, and y.cpp says it too", found[0])

    def test_refuses_all_names_of_a_namespace_but_literals(self):
        self.assertIn("name those that it uses", self.complaints({"gateway/a/x.cpp": "using namespace b;\n"})[0])
        self.assertEqual(self.complaints({"gateway/a/x.cpp": "using namespace std::string_view_literals;\n"}), [])

    def test_passes_what_means_the_same_beside_any_source(self):
        own = "namespace {\nint check(int a) { return a; }\nconstexpr int kMost = 2;\n}\nusing std::vector;\nint shared() { return 1; }\n"
        for said in ("int a() { return x.check(2) + p->check(2) + n::check(2); }", "int a(int check) { return check; }", '// kMost\nauto a = "kMost";',
                     "using std::vector;\nvector<int> a;", "int a() { return shared(); }", "#define A kMost", "int check_all(int);"):
            self.assertEqual(self.complaints({"gateway/a/x.cpp": own, "gateway/a/y.cpp": said + "\n"}), [], said)
        self.assertEqual(self.complaints({"gateway/a/x.cpp": own, "gateway/a/main.cpp": "int main() { return check(2); }\n"}), [])

    def test_refuses_a_class_that_is_cut_into_many_sources(self):
        found = self.complaints({f"gateway/a/x{i}.cpp": f"void Slice::part{i}() {{\n}}\n" for i in range(4)})
        self.assertEqual(found, ["Slice is cut into 4 sources: x0.cpp, x1.cpp, x2.cpp, x3.cpp"])


if __name__ == "__main__":
    unittest.main()
