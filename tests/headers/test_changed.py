"""scripts/check_changed.py finds planted problems in files that differ from a commit, and looks at no others."""
import contextlib
import io
import json
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "scripts"))
import check_changed  # noqa: E402
import check_headers  # noqa: E402

GOOD = "#pragma once\n\ninline int one() {\n  return 1;\n}\n"


@unittest.skipIf(check_changed.missing_tools(), f"not installed: {', '.join(check_changed.missing_tools())}")
class Changed(unittest.TestCase):
    """A repository with a header, a source and the commands of a build."""

    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.root = Path(temporary.name).resolve()
        old = check_changed.ROOT, check_headers.ROOT
        self.addCleanup(lambda: (setattr(check_changed, "ROOT", old[0]), setattr(check_headers, "ROOT", old[1])))
        check_changed.ROOT = check_headers.ROOT = self.root
        self.git("init", "-q")
        shutil.copy(SOURCE / ".clang-format", self.root)
        shutil.copy(SOURCE / ".clang-tidy", self.root)
        self.write("app/good.hpp", GOOD)
        self.write("app/good.cpp", '#include "good.hpp"\n\nint two() { return one() + one(); }\n')
        # A file of the first commit is not looked at, however bad it is.
        self.write("app/old.cpp", "int   old( double x ) { int y = x; return y; }\n")
        self.write(".gitignore", "build\n")
        self.commit()

    def git(self, *words):
        return subprocess.run(["git", "-c", "user.name=a", "-c", "user.email=a@b", "-C", self.root, *words], check=True,
                              text=True, capture_output=True).stdout.strip()

    def commit(self):
        self.git("add", "-A")
        self.git("commit", "-q", "-m", "a commit")

    def write(self, name, text):
        file = self.root / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text, encoding="utf-8")

    def check(self, *words):
        """Returns exit code and output of the script."""
        flags = "-std=c++20 -Wall -Wextra -Wconversion -Werror -O2"
        self.write("build/compile_commands.json", json.dumps(
            [{"file": str(file), "directory": str(self.root), "command": f"clang++-19 {flags} -o x.o -c {file}"}
             for file in sorted(self.root.glob("app/*.cpp"))]))
        arguments, sys.argv = sys.argv, ["check_changed.py", str(self.root / "build"), "--jobs", "2", *words]
        output = io.StringIO()
        try:
            with contextlib.redirect_stdout(output), contextlib.redirect_stderr(output):
                return check_changed.main(), output.getvalue()
        finally:
            sys.argv = arguments

    def test_good_changes_pass(self):
        self.write("app/new.cpp", '#include "good.hpp"\n\nint three() {\n  return 3 * one();\n}\n')
        self.write("app/new.hpp", GOOD)
        self.commit()
        code, output = self.check()
        self.assertEqual(code, 0, output)
        for line in ("format: 2 of 2 files, 0 with", "headers: 1 of 1 files, 0 with", "clang: 1 of 1 files", "tidy: 1 of 1 files"):
            self.assertIn(line, output)

    def test_each_job_finds_its_problem(self):
        for name, text, job, words in (
                ("app/format.cpp", "int  three() {\n  return 3;\n}\n", "format", "format.cpp:1:4"),
                ("app/alone.hpp", "#pragma once\nstd::string name_of(int);\n", "headers", "alone.hpp"),
                ("app/warning.cpp", "int cut(double x) { return x; }\n", "clang", "warning.cpp:1:28"),
                ("app/tidy.cpp", "int* none() { return 0; }\n", "tidy", "modernize-use-nullptr")):
            with self.subTest(job):
                self.write(name, text)  # of no commit
                code, output = self.check("--since", "HEAD")
                self.assertEqual(code, 1, output)
                self.assertIn(f"{job}: 1 of 1 files, 1 with problems", output)
                self.assertIn(words, output)
                (self.root / name).unlink()

    def test_files_after_the_end_of_the_time_are_counted(self):
        self.write("app/new.cpp", "int  three() { return 3; }\n")
        code, output = self.check("--since", "HEAD", "--until", "0")
        self.assertEqual(code, 0, output)
        self.assertIn("format: 0 of 1 files, 0 with problems; the time was over for 1", output)

    def test_files_differ_from_the_commit_that_main_had(self):
        first = self.git("rev-parse", "HEAD")
        self.git("update-ref", "refs/remotes/origin/main", first)
        for name in ("a", "b"):
            self.write(f"app/{name}.cpp", f"int {name}() {{ return 1; }}\n")
            self.commit()
        self.assertEqual(check_changed.default_base(), first)
        self.git("update-ref", "refs/remotes/origin/main", "HEAD")
        self.assertEqual(check_changed.default_base(), self.git("rev-parse", "HEAD~1"))

    def test_a_first_commit_has_no_changes(self):
        self.assertEqual(self.check(), (0, "no earlier commit: no file has changed\n"))

    def test_unknown_commits_and_folders_are_refused(self):
        code, output = self.check("--since", "nowhere")
        self.assertEqual((code, output), (2, "check_changed.py: no commit 'nowhere' (unknown to git); give another by --since\n"))
        (self.root / "build/compile_commands.json").unlink()
        arguments, sys.argv = sys.argv, ["check_changed.py", str(self.root / "build")]
        try:
            with contextlib.redirect_stderr(io.StringIO()) as output:
                self.assertEqual(check_changed.main(), 2)
        finally:
            sys.argv = arguments
        self.assertIn("compile_commands.json (not configured); run make changed", output.getvalue())


if __name__ == "__main__":
    unittest.main()
