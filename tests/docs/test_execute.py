"""docs/execute.py, which runs the blocks of pages, accepts correct pages and reports one planted error of a page with its line."""
import os
import subprocess
import sys
import tempfile
import textwrap
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("APSIS_BUILD", ROOT / "build" / "release"))
sys.path.insert(0, str(ROOT / "docs"))
import blocks  # noqa: E402
import execute  # noqa: E402

CASE = '[model]\nname = "ode"\n[time]\nmethod = "md-imex-3-2"\nend = 1.0\ndt = 0.5\n'


def block(language, text, *marks):
    return "".join(f"<!-- {mark} -->\n" for mark in marks) + f"```{language}\n{text}\n```\n"


class Pages(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        holder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(holder.cleanup)
        cls.tools = execute.Tools(BUILD, Path(holder.name))

    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.root = Path(holder.name)

    def run_page(self, *parts):
        (self.root / "docs").mkdir(exist_ok=True)
        path = self.root / "docs" / "page.md"
        path.write_text("# Page\n\n" + "\n".join(parts), encoding="utf-8")
        return execute.run_pages([path], self.root, self.tools, 1)[0]

    def assert_accepted(self, *parts):
        self.assertEqual([str(p) for p in self.run_page(*parts).problems], [])

    def assert_refused(self, line, why, *parts):
        problems = self.run_page(*parts).problems
        self.assertEqual(len(problems), 1, problems)
        self.assertEqual(problems[0].line, line, problems)
        self.assertIn(why, str(problems[0]))


class Shell(Pages):
    def test_a_block_runs_with_the_program_and_the_package(self):
        self.assert_accepted(block("sh", "apsis list models --names"), block("text", "…\node\n…", "output"),
                             block("sh", "python3 -c 'import apsis; print(len(apsis.methods()) > 4)'"),
                             block("text", "True", "output"))

    def test_a_command_that_fails_in_the_middle_is_reported_with_its_message(self):
        self.assert_refused(3, "is called 'nonsense'", block("sh", "apsis show nonsense\ntrue"))

    def test_a_pipe_that_fails_at_its_beginning_fails(self):
        self.assert_refused(3, "exit code 3", block("sh", "(exit 3) | cat"))

    def test_a_variable_that_is_not_set_fails(self):
        self.assert_refused(3, "unbound", block("sh", "echo $nowhere"))

    def test_an_exit_code_that_is_named_must_come(self):
        self.assert_accepted(block("sh", "apsis show nonsense", "exit: 2"),
                             block("text", "error: nothing is called 'nonsense' …", "output"))
        self.assert_refused(4, "not 2", block("sh", "true", "exit: 2"))
        self.assert_refused(4, "not a number", block("sh", "true", "exit: two"))
        self.assert_refused(4, "belongs to a program", block("python", "1 / 0", "exit: 1"))

    def test_a_block_that_does_not_end_is_ended(self):
        limit, execute.LIMIT = execute.LIMIT, 0.5
        self.addCleanup(setattr, execute, "LIMIT", limit)
        self.assert_refused(3, "too long", block("sh", "sleep 100 & sleep 100"))
        self.assert_refused(3, "too long", block("python", "while True: pass"))

    def test_the_folder_is_fresh_and_shared_by_the_blocks(self):
        page = (block("sh", "test ! -e file && touch file"), block("sh", "test -e file"))
        self.assert_accepted(*page)
        self.assert_accepted(*page)


class Python(Pages):
    def test_blocks_share_one_namespace(self):
        self.assert_accepted(block("python", "x = 1"), block("sh", "true"), block("python", "print(x + 1)"),
                             block("text", "2", "output"))

    def test_an_exception_is_reported_with_its_line(self):
        self.assert_refused(3, "docs/page.md:3\", line 2", block("python", "x = 1\nx / 0"))

    def test_an_interpreter_that_ends_is_noticed(self):
        self.assert_refused(3, "the interpreter ended", block("python", "import os; os._exit(0)"))

    def test_output_of_programs_that_python_starts_counts(self):
        self.assert_accepted(block("python", "import os; os.system('echo one')"), block("text", "one", "output"))


class Cpp(Pages):
    MAIN = "#include <apsis/core/version.hpp>\n#include <cstdio>\nint main() { std::puts(apsis::version()); }"

    def test_a_program_is_compiled_against_the_installed_library_and_run(self):
        self.assert_accepted(block("cpp", self.MAIN), block("text", "…", "output"))

    def test_a_program_that_does_not_compile_is_reported(self):
        self.assert_refused(3, "was not declared", block("cpp", "int main() { return nowhere; }"))

    def test_a_program_that_fails_is_reported(self):
        self.assert_refused(3, "exit code 7", block("cpp", "int main() { return 7; }"))

    def test_a_fragment_without_main_needs_its_source_file(self):
        self.assert_refused(3, "no main", block("cpp", "int x;"))

    def test_a_file_is_written_for_the_commands_that_compile_it(self):
        self.assert_accepted(block("cpp", "int main() {}", "file: own.cpp"), block("sh", "$CXX own.cpp -o own && ./own"))
        self.assert_refused(4, "not used", block("cpp", "int main() {}", "file: own.cpp"))

    def test_a_file_cannot_leave_its_folder(self):
        self.assert_refused(4, "is outside", block("cpp", "int x;", "file: ../own.cpp"), block("sh", "ls ../own.cpp"))


class Excerpts(Pages):
    FILE = "void f() {\n  int x = 1;\n  int y = 2;\n  int z = 3;\n}\n"

    def setUp(self):
        super().setUp()
        (self.root / "file.cpp").write_text(self.FILE, encoding="utf-8")

    def test_an_excerpt_that_is_also_written_is_still_compared(self):
        used = block("sh", "grep -q 'y = 2' own.cpp")
        self.assert_accepted(block("cpp", self.FILE.strip(), "from: file.cpp", "file: own.cpp"), used)
        self.assert_refused(5, "not in file.cpp", block("cpp", "int y = 2; // mine", "from: file.cpp", "file: own.cpp"), used)

    def test_lines_of_a_file_at_any_indentation(self):
        self.assert_accepted(block("cpp", "int x = 1;\nint y = 2;", "from: file.cpp"))

    def test_lines_may_be_omitted_where_marked(self):
        self.assert_accepted(block("cpp", "void f() {\n  int x = 1;\n  // …\n  int z = 3;\n}", "from: file.cpp"))
        self.assert_refused(4, "not in file.cpp", block("cpp", "int x = 1;\nint z = 3;", "from: file.cpp"))

    def test_a_missing_excerpt_is_rejected(self):
        self.assert_refused(4, "not in file.cpp", block("cpp", "int x = 2;", "from: file.cpp"))
        self.assert_refused(4, "not in file.cpp", block("cpp", "int z = 3;\n// …\nint x = 1;", "from: file.cpp"))
        self.assert_refused(4, "not in file.cpp", block("cpp", "// …", "from: file.cpp"))
        self.assert_refused(4, "there is no nowhere.cpp", block("cpp", "int x = 1;", "from: nowhere.cpp"))

    def test_a_file_that_the_page_has_written_counts(self):
        self.assert_accepted(block("sh", "echo 'a = 1' > made.toml"), block("toml", "a = 1", "from: made.toml"))


class Cases(Pages):
    def test_a_case_is_loaded(self):
        self.assert_accepted(block("toml", CASE, "file: own.toml"))
        self.assert_refused(4, "md-imex-3-1", block("toml", CASE.replace("3-2", "3-1"), "file: own.toml"))

    def test_a_method_is_certified(self):
        text = (ROOT / "methods" / "imdrk-1-2.toml").read_text(encoding="utf-8")
        self.assert_accepted(block("toml", text, "file: own.toml"))
        self.assert_refused(4, "exit code 5", block("toml", text.replace("order = 2", "order = 3"), "file: own.toml"))


class Outputs(Pages):
    def test_another_output_is_shown(self):
        self.assert_refused(8, "+two", block("sh", "echo two"), block("text", "one", "output"))

    def test_numbers_have_a_tolerance(self):
        self.assert_accepted(block("sh", "echo x=1.0000001"), block("text", "x=1", "output"))
        self.assert_refused(8, "another one", block("sh", "echo x=1.001"), block("text", "x=1", "output"))
        self.assert_accepted(block("sh", "echo x=1.001"), block("text", "x=1", "output: 1e-2"))

    def test_a_tolerance_is_a_number(self):
        self.assert_refused(8, "not a number", block("sh", "echo 1"), block("text", "1", "output: some"))

    def test_an_output_needs_a_block_before_it(self):
        self.assert_refused(4, "no block before", block("text", "one", "output"))

    def test_every_picture_is_drawn_by_a_block_or_report(self):
        (self.root / "docs" / "images").mkdir(parents=True)
        for name in ("a.png", "work-b.png", "c.png"):
            (self.root / "docs" / "images" / name).touch()
        self.assert_refused(3, "nothing draws a.png", "![a](images/a.png)")
        self.assert_refused(3, "docs/images has no d.png", "![d](images/d.png)", block("sh", "mkdir images; touch images/d.png"))
        self.assert_accepted("![a](images/a.png)", block("sh", "mkdir images; touch images/a.png"))
        (self.root / "studies").mkdir()
        (self.root / "studies" / "report.py").write_text('figure.savefig(images / f"work-{name}.png")', encoding="utf-8")
        (self.root / "Makefile").write_text("figures:\n\tapsis plot --compare c --out results\n", encoding="utf-8")
        self.assert_accepted("![b](images/work-b.png)\n![c](images/c.png)")

    def test_update_writes_outputs_and_pictures(self):
        page = self.run_page("![one](images/one.png)", block("sh", "mkdir images; echo p > images/one.png; printf '1\\n2\\n'"),
                             "- item\n" + textwrap.indent(block("text", "one", "output"), "  "))
        self.assertEqual(len(page.problems), 2, page.problems)
        self.assertIn("nothing is shown", str(page.problems[-1]))
        page.update()
        self.assertIn("```text\n  1\n  2\n  ```", page.path.read_text(encoding="utf-8"))
        again = execute.run_pages([page.path], self.root, self.tools, 1)[0]
        self.assertEqual([str(p) for p in again.problems], [])


class OptionalComponents(Pages):
    def lacking(self, *components):
        self.addCleanup(setattr, self.tools, "lacking", self.tools.lacking)
        self.tools.lacking = set(components)

    def test_only_blocks_that_need_an_absent_component_are_left_out_with_their_outputs(self):
        self.lacking("petsc")
        page = (block("sh", "false", "needs: petsc"), block("text", "one", "output"), block("sh", "echo two", "needs: sundials"),
                block("text", "2", "output"))
        self.assert_refused(19, "+two", *page)
        self.assertEqual([b.line for b in self.run_page(*page).left_out], [4])
        self.lacking()
        self.assert_refused(4, "exit code 1", *page)

    def test_a_program_that_is_not_compiled_is_still_written(self):
        self.lacking("petsc")
        self.assert_accepted(block("cmake", "find_package(apsis COMPONENTS petsc)", "file: CMakeLists.txt"),
                             block("sh", "cmake -B build", "needs: petsc"), block("sh", "grep petsc CMakeLists.txt"))

    def test_a_picture_may_be_drawn_by_a_block_that_is_left_out(self):
        (self.root / "docs" / "images").mkdir(parents=True)
        (self.root / "docs" / "images" / "a.png").touch()
        page = ("![a](images/a.png)", block("sh", "true", "needs: design"))
        self.lacking("design")
        self.assert_accepted(*page)
        self.lacking()
        self.assert_refused(3, "nothing draws a.png", *page)

    def test_a_need_has_the_name_of_an_optional_component_and_stands_before_a_program(self):
        self.assert_refused(4, "name one of design, sundials, petsc", block("sh", "true", "needs: kinetic"))
        self.assert_refused(9, "leaves nothing out", block("sh", "echo x"), block("text", "x", "needs: design", "output"))

    def test_programs_that_need_an_optional_component_say_so(self):
        self.assert_refused(3, "needs the component design", block("sh", "apsis design --order 2"))
        for component in ("design", "sundials", "petsc"):
            self.assert_refused(4, f"needs the component {component}",
                                block("cmake", f"find_package(apsis COMPONENTS c {component})", "file: CMakeLists.txt"),
                                block("sh", "cmake -B build"))

    def test_components_are_those_of_the_build(self):
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "apsisConfig.cmake").write_text("set(apsis_known integrate design petsc)\nset(apsis_built integrate;c;sundials)\n",
                                                            encoding="utf-8")
            self.assertEqual(execute.lacking_components(Path(folder)), {"design", "petsc"})


class Rules(Pages):
    def test_an_unchecked_block_is_rejected(self):
        for language in ("toml", "cmake", "bash", "json", "c++"):
            self.assert_refused(3, "nothing checks", block(language, "x"))

    def test_commands_cannot_hide_in_plain_blocks(self):
        for line in ("apsis run paper/ode", "make run", "$ ls", "#include <x>", "  cmake -B build", "import apsis", ">>> 1"):
            for language in ("", "text"):
                self.assert_refused(3, "not run", block(language, "u_t = 0\n" + line))
            self.assert_refused(5, "indented text", f"Words:\n\n    {line}\n")

    def test_formulas_stay_plain(self):
        self.assert_accepted(block("", "u_t = T(u)"), block("text", "makes sense"), "Words:\n\n    u_t = T(u)\n")

    def test_a_block_may_be_run_elsewhere_by_a_test_that_names_the_page(self):
        (self.root / "test.py").write_text("docs/page.md", encoding="utf-8")
        self.assert_accepted(block("sh", "false", "elsewhere: test.py"))
        self.assert_refused(4, "does not run", block("sh", "true", "elsewhere: nowhere.py"))
        (self.root / "test.py").write_text("docs/other.md", encoding="utf-8")
        self.assert_refused(4, "does not run", block("sh", "true", "elsewhere: test.py"))

    def test_blocks_in_lists_count_and_those_in_quotations_are_refused(self):
        self.assert_refused(3, "exit code 1", "- " + textwrap.indent(block("sh", "false"), "  ").lstrip())
        self.assert_refused(3, "quotation", textwrap.indent(block("sh", "false"), "> "))

    def test_instructions_stand_before_blocks_and_are_spelled_right(self):
        self.assert_refused(3, "not before a block", "<!-- output -->\n\n" + block("text", "x"))
        self.assert_refused(3, "no instruction", block("text", "x", "outputs"))
        self.assert_refused(3, "does not end", "```sh\ntrue\n")

    def test_the_program_ends_with_1_and_names_page_and_line(self):
        path = self.root / "page.md"
        path.write_text(block("bash", "true"), encoding="utf-8")
        done = subprocess.run([sys.executable, execute.__file__, "--root", self.root, "--build", BUILD, "--work",
                               self.root / "build", path], text=True, capture_output=True)
        self.assertEqual(done.returncode, 1)
        self.assertTrue(done.stderr.startswith("page.md:1: nothing checks"), done.stderr)

    def test_pages_can_be_left_out_by_names_that_exist(self):
        (self.root / "docs").mkdir()
        for name, text in (("right", "# Right\n"), ("wrong", block("bash", "true"))):
            (self.root / "docs" / f"{name}.md").write_text(text, encoding="utf-8")
        for name, code, said in (("wrong", 0, "1 pages, 0 with problems"), ("right", 1, "1 pages, 1 with problems"),
                                 ("absent", 2, "--without names no page")):
            done = subprocess.run([sys.executable, execute.__file__, "--root", self.root, "--build", BUILD, "--work", self.root / "build",
                                   "--without", self.root / "docs" / f"{name}.md"], text=True, capture_output=True)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertIn(said, done.stdout + done.stderr)


class Comparison(unittest.TestCase):
    def test_outputs(self):
        for shown, printed, same in (
                ("a b", "a   b  \n\n", True), ("a\nb", "a b", False), ("a", "a\nb", False), ("1e-8", "1.0E-08", True),
                ("-1", "1", False), ("md-imex-6-3", "md-imex-6-2", False), ("u1 = 2", "u2 = 2", False), ("nan", "nan", True),
                ("1", "x", False), ("0", "1e-17", False), ("…", "anything\nat all", True), ("…", "", True),
                ("a … c", "a b c", True),
                ("a …", "a", True), ("a … c", "a b", False), ("a\n…\nz", "a\nz", True), ("… 2.0 s", "took 2 s", True),
                ("… b … d", "a b c d", True), ("… b … d", "a d b", False), ("a … a", "a", False), ("… a b …", "a a b c", True)):
            self.assertEqual(blocks.is_same_output(shown, printed, 1e-6), same, (shown, printed))


if __name__ == "__main__":
    unittest.main()
