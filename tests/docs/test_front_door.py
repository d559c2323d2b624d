"""README.md, CONTRIBUTING.md and docs/first-steps.md have commands that build and test everything. Only the existence of their
make targets is checked here, since a test cannot run all tests; test_long.py executes `make run`."""
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
TARGET = re.compile(r"`make ([a-z][a-z-]*)`|^make ([a-z][a-z-]*)", re.MULTILINE)


class FrontDoor(unittest.TestCase):
    def test_make_knows_every_target_that_a_page_names(self):
        pages = [*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md"), *ROOT.glob("src/apsis/*/README.md"), *ROOT.glob("bench/*.md")]
        targets = {a or b: page for page in pages for a, b in TARGET.findall(page.read_text(encoding="utf-8"))}
        self.assertTrue({"run", "test", "test-all", "docs"} <= targets.keys())
        for target, page in targets.items():
            done = subprocess.run(["make", "-n", "-C", ROOT, target], text=True, capture_output=True)
            self.assertEqual(done.returncode, 0, f"{page}: make {target}: {done.stderr}")

    def test_make_help_names_every_target_except_internal_ones(self):
        help_text = subprocess.run(["make", "-C", ROOT], text=True, capture_output=True).stdout
        named = set(re.findall(r"^  make ([a-z-]+)", help_text, re.M))
        phony = set(re.search(r"^\.PHONY: (.*)$", (ROOT / "Makefile").read_text(encoding="utf-8"), re.M)[1].split())
        self.assertEqual(phony - named, {"test-slow", "format-check"})

    def test_the_readme_is_short(self):
        lines = (ROOT / "README.md").read_text(encoding="utf-8").splitlines()
        self.assertLessEqual(len(lines), 110)
        self.assertIn("cannot do.**", "\n".join(lines[:35]))


class Repository(unittest.TestCase):
    def test_files_follow_the_rules_of_editorconfig(self):
        kinds = ("cpp", "hpp", "py", "md", "toml", "sh", "cmake", "txt", "json", "yml")
        for path in (path for kind in kinds for path in ROOT.rglob(f"*.{kind}")):
            if {"build", "results", "env", ".git"} & set(path.relative_to(ROOT).parts):
                continue
            text = path.read_bytes().decode("utf-8")
            self.assertNotIn("\r", text, path)
            self.assertNotRegex(text, r"(?m)^\t", path)
            self.assertTrue(not text or text.endswith("\n"), path)
            self.assertIsNone(re.search(r"(?m)[ \t]$", text), path)

    def test_the_changelog_sorts_entries_by_their_kind(self):
        text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
        self.assertIn("**Stability.**", text.partition("## Unreleased")[0])
        for version in re.split(r"(?m)^## ", text)[1:]:
            name = version.splitlines()[0]
            self.assertRegex(name, r"^(Unreleased|\d+\.\d+\.\d+ \(\d{4}-\d\d-\d\d\))$")
            kinds = re.findall(r"(?m)^### (.*)$", version)
            self.assertLessEqual(set(kinds), {"Numerics changed", "Changed", "Fixed", "Added"})
            self.assertTrue(kinds or "First version." in version, name)


class Packages(unittest.TestCase):
    """Runs scripts/install-packages.sh with substitutes: commands only record their calls, and dpkg-query finds no package."""

    def install(self, user="1000", commands=("apt-get", "sudo"), **variables):
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            for name in ("bash", "awk", "dirname", "readlink", "env"):
                (folder / name).symlink_to(Path("/usr/bin") / name)
            bodies = {"dpkg-query": "exit 1", "id": f"echo {user}"} | {name: f'echo "{name} $*" >> {folder}/calls' for name in commands}
            for name, body in bodies.items():
                (folder / name).write_text(f"#!/bin/bash\n{body}\n", encoding="utf-8")
                (folder / name).chmod(0o755)
            done = subprocess.run(["/bin/bash", ROOT / "scripts" / "install-packages.sh", "run"], text=True, capture_output=True,
                                  env={"PATH": str(folder)} | variables)
            calls = (folder / "calls").read_text(encoding="utf-8") if (folder / "calls").exists() else ""
        return done, calls

    def test_it_states_packages_and_rights_before_it_installs(self):
        done, calls = self.install()
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"^This installs Debian packages with root's rights, which sudo grants you: g\+\+-12 make ")
        self.assertIn("NO_INSTALL=1", done.stdout)
        self.assertRegex(calls, r"^sudo apt-get update.*\nsudo env .*apt-get install .*g\+\+-12")
        self.assertRegex(self.install(user="0")[0].stdout, r"^This installs Debian packages with your rights \(root\): ")

    def test_no_install_installs_nothing_and_names_what_is_missing(self):
        for variables in ({"NO_INSTALL": "1"}, {"NO_INSTALL": "yes"}):
            done, calls = self.install(**variables)
            self.assertEqual((done.returncode, calls), (0, ""))
            self.assertRegex(done.stderr, r"packages are missing \(NO_INSTALL=\w+\); .*g\+\+-12")
        for variables in ({"NO_INSTALL": ""}, {"NO_INSTALL": "0"}):
            self.assertIn("apt-get install", self.install(**variables)[1])

    def test_without_root_and_sudo_it_explains_what_to_do(self):
        done, calls = self.install(commands=("apt-get",))
        self.assertEqual((done.returncode, calls), (2, ""))
        self.assertRegex(done.stderr, r"as root run: apt-get install .*; or build without installing: make … NO_INSTALL=1")

    def test_make_passes_no_install_on(self):
        done = subprocess.run(["make", "-s", "-C", ROOT, "-f", "Makefile", "--eval", "print: ; @echo [$$NO_INSTALL]", "print",
                               "NO_INSTALL=1"], text=True, capture_output=True, env={k: v for k, v in os.environ.items() if k != "NO_INSTALL"})
        self.assertEqual(done.stdout.strip(), "[1]", done.stderr)


if __name__ == "__main__":
    unittest.main()
