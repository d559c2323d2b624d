"""Pages name cases and pictures that exist. test_tables.py compares their tables with the program."""
import re
import sys
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "docs"))
import execute  # noqa: E402

PAGES = {page: page.read_text(encoding="utf-8") for pattern in execute.PAGES for page in ROOT.glob(pattern)}


class Pages(unittest.TestCase):
    def test_every_case_that_is_named_exists(self):
        for page, text in PAGES.items():
            for case in re.findall(r"apsis (?:run|converge|show) ([a-z]+/[a-z0-9-]+)", text):
                self.assertTrue((ROOT / "cases" / f"{case}.toml").exists(), f"{page}: {case}")

    def test_every_picture_is_shown(self):  # docs/execute.py checks that every shown picture is drawn
        shown = {name for text in PAGES.values() for name in re.findall(r"\bimages/([\w.-]+)\)", text)}
        self.assertEqual({picture.name for picture in (ROOT / "docs" / "images").iterdir()}, shown)


if __name__ == "__main__":
    unittest.main()
