"""Pages say what the files say: methods, cases, and who makes the pictures."""
import re
import sys
import tomllib
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "docs"))
import blocks  # noqa: E402
import execute  # noqa: E402

PAGES = {page: page.read_text(encoding="utf-8") for pattern in execute.PAGES for page in ROOT.glob(pattern)}


def outputs_of(text):
    """Patterns of the pictures that a program names, {…} of formatted names for anything."""
    names = re.findall(r"([\w-]+(?:\{[^}]*\}[\w-]*)?)\.png", text)
    return [re.sub(r"\{[^}]*\}", r"[\\w-]+", name) for name in names]


class Pages(unittest.TestCase):
    def test_the_table_of_methods_agrees_with_the_catalogue(self):
        listed = re.findall(r"^\| `([a-z0-9-]+)` \| (\d+) \|", PAGES[ROOT / "README.md"], re.MULTILINE)
        self.assertGreater(len(listed), 4)
        for name, order in listed:
            data = tomllib.loads((ROOT / "methods" / f"{name}.toml").read_text(encoding="utf-8"))
            self.assertEqual(order, str(data["claims"]["order"]), name)

    def test_every_case_that_is_named_exists(self):
        for page, text in PAGES.items():
            for case in re.findall(r"(?:paper|benchmarks)/[a-z0-9-]+[a-z0-9]", re.sub(r"\]\([^)]*\)", "", text)):
                self.assertTrue((ROOT / "cases" / f"{case}.toml").exists(), f"{page}: {case}")

    def test_every_picture_is_made_by_a_command_of_the_repository(self):
        recipe = re.search(r"^figures:.*\n((?:\t.*\n)+)", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE)[1]
        made = re.findall(r"[\w-]+", recipe)
        for report in ("studies/report.py", "bench/report.py"):
            made += outputs_of((ROOT / report).read_text(encoding="utf-8"))
        for text in PAGES.values():
            for block in blocks.read_blocks(text):
                if block.runs:
                    made += re.findall(r"\bimages/([\w-]+)\.png", block.text)
        for picture in (ROOT / "docs" / "images").iterdir():
            self.assertTrue(any(re.fullmatch(name, picture.stem) for name in made), f"no command makes {picture.name}")

    def test_every_picture_is_shown(self):
        shown = {name for text in PAGES.values() for name in re.findall(r"\bimages/([\w.-]+)\)", text)}
        self.assertEqual({picture.name for picture in (ROOT / "docs" / "images").iterdir()}, shown)


if __name__ == "__main__":
    unittest.main()
