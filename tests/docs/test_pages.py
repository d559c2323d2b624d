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

    def test_every_page_stands_on_one_shelf(self):
        shelves = read_shelves()
        self.assertEqual(list(shelves), ["Guide", "Theory", "Supplement"])
        listed = [page for pages in shelves.values() for page in pages]
        self.assertEqual(sorted(listed), sorted(set(listed)))
        docs = {page.resolve() for page in (ROOT / "docs").glob("**/*.md")} - {ROOT / "docs" / "index.md"}
        self.assertEqual(docs - set(listed), set())
        self.assertEqual([page for page in listed if not page.is_file()], [])

    def test_the_guide_is_short_and_has_what_every_user_needs(self):
        guide = read_shelves()["Guide"]
        self.assertLessEqual(len(guide), 15)
        self.assertLessEqual(sum(len(page.read_text(encoding="utf-8").split()) for page in guide), 25000)
        self.assertLess({"first-steps", "initial-data", "boundaries", "dimensions", "scales", "bodies", "results"}, {page.stem for page in guide})

    def test_linking_names_every_optional_library_and_its_component(self):
        test = (ROOT / "tests/install/without_libraries.cmake").read_text(encoding="utf-8")
        libraries = re.search(r"^set\(libraries (.*)\)$", test, re.M)[1].split()
        components = dict(re.findall(r"^set\(component_(\w+) (\w+)\)$", test, re.M))
        section = PAGES[ROOT / "docs/linking.md"].partition("## Without optional libraries\n")[2].partition("\n## ")[0]
        rows = re.findall(r"^\| (\w+)[^|]* \| ([^|]*) \|", section, re.M)[1:]  # without the head
        self.assertEqual({name for name, _ in rows}, set(libraries))
        for name, left_out in rows:
            named = re.search(r"component `(\w+)`", left_out)
            self.assertEqual(named and named[1], components.get(name), name)


def read_shelves():
    """Returns the pages that each section of docs/index.md lists."""
    sections = re.split(r"^## (.*)$", PAGES[ROOT / "docs" / "index.md"], flags=re.M)[1:]
    return {title: [(ROOT / "docs" / page).resolve() for page in re.findall(r"^- \[[^\]]*\]\(([^)]+)\)", text, re.M)]
            for title, text in zip(sections[::2], sections[1::2])}


if __name__ == "__main__":
    unittest.main()
