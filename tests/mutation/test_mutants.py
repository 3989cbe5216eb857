"""What the mutation run changes in a source, and what it leaves alone."""
import unittest

from mutants import mutants_of


def changed(source):
    """Every mutant of this source, as text."""
    return [mutant.apply(source) for mutant in mutants_of("x.cpp", source)]


def body(statement):
    return f"int f(int a, int b) {{\n  {statement}\n}}\n"


class Mutants(unittest.TestCase):
    def assert_mutant(self, statement, mutant):
        self.assertIn(body(mutant), changed(body(statement)))

    def assert_left_alone(self, source):
        self.assertEqual([], changed(source))

    def test_operators_are_swapped(self):
        for one, other in (("<", "<="), (">", "<="), ("==", "!="), ("&&", "||"), ("+", "-"), ("*", "/"), ("+=", "-=")):
            self.assert_mutant(f"g(a {one} b);", f"g(a {other} b);")

    def test_brackets_of_templates_and_pointers_are_no_operators(self):
        self.assert_left_alone("std::map<int, std::vector<T>> made;\n")
        self.assert_left_alone("template <typename T, std::size_t N = 3>\nvoid f(const T* p, T&& r);\n")
        self.assertNotIn(body("std::array<int, (4 + 1)> a;"), changed(body("std::array<int, 4> a;")))

    def test_comments_texts_and_directives_are_left_alone(self):
        self.assert_left_alone('#include <a> // 1 < 2\n/* true && false */\n')
        self.assert_left_alone('const char* k = "1 < 2";\n')
        self.assert_left_alone('const char* k = R"x(a && b; c = 1;)x";\n')

    def test_declarations_of_members_are_left_alone(self):
        self.assert_left_alone("struct S {\n  int a = 1;\n  virtual int f(int b) = 0;\n  enum class E { A = 1, B };\n};\n")

    def test_bodies_of_members_are_not_left_alone(self):
        source = "struct S {\n  int f() { return a < b; }\n};\n"
        self.assertIn(source.replace("a < b", "a <= b"), changed(source))

    def test_what_nobody_notices_is_left_alone(self):
        for statement in ("v.reserve(10);", "spdlog::info(a < b);", "static_assert(sizeof(int) == 4);"):
            self.assert_left_alone(f"void f() {{\n  {statement}\n}}\n")

    def test_statements_are_dropped(self):
        self.assert_mutant("v.clear();", ";")
        self.assert_mutant("a = b;", ";")
        self.assert_mutant("if (a) b = c;", ";")

    def test_declarations_are_not_dropped(self):
        for statement in ("Lock lock(mutex);", "auto x = b;", "std::vector<int> v(3);", "const Foo& y = x;"):
            self.assertNotIn(body(";"), changed(body(statement)))
        self.assert_left_alone("Foo::Foo(Foo&&) noexcept = default;\n")

    def test_conditions_and_results_are_negated(self):
        self.assert_mutant("if (auto x = g(); x) h();", "if (auto x = g(); !(x)) h();")
        self.assert_mutant("return a < b;", "return !(a < b);")
        self.assert_mutant("return a;", "return -(a);")
        self.assert_mutant("return a;", "return {};")

    def test_truth_is_negated_as_truth(self):
        for source in ("bool f(int a) {\n  return a;\n}\n", "bool C::f(int a) const {\n  for (;;) {\n    if (b) return a;\n  }\n}\n",
                       "void f() {\n  auto g = [](int a) -> bool { return a; };\n}\n"):
            self.assertIn(source.replace("return a", "return !(a)"), changed(source))
            self.assertNotIn(source.replace("return a", "return -(a)"), changed(source))
        for source in ("int f(bool a) {\n  return a;\n}\n", "bool f() {\n  auto g = [](int a) { return a; };\n}\n"):
            self.assertIn(source.replace("return a", "return -(a)"), changed(source))

    def test_constants_change(self):
        self.assert_mutant("g(0.5);", "g((0.5 + 1));")
        self.assert_mutant("g(0.5);", "g((-0.5));")
        self.assert_mutant("wait(10ms);", "wait(11ms);")
        self.assert_mutant("g(true);", "g(false);")

    def test_arguments_and_branches_are_swapped(self):
        self.assert_mutant("g(a, h(b, c), d);", "g(h(b, c), a, d);")
        self.assert_mutant("g(a ? b : c);", "g(a ? c : b);")
        for symmetric in ("std::max", "dot"):
            self.assertNotIn(body(f"{symmetric}(b, a);"), changed(body(f"{symmetric}(a, b);")))


if __name__ == "__main__":
    unittest.main()
