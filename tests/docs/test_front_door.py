"""Commands of README.md, CONTRIBUTING.md and docs/first-steps.md that build and test everything. Only the existence of their make
targets is checked here, since a test cannot run all tests; test_long.py executes `make run`."""
import re
import subprocess
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


if __name__ == "__main__":
    unittest.main()
