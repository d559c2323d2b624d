"""The front page says what the files say: example, methods, commands and links."""
import re
import tomllib
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
DOCUMENTS = [p for p in [*ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md"), *ROOT.glob("src/apsis/**/*.md")]]


class Readme(unittest.TestCase):
    def test_the_example_is_the_file(self):
        file = (ROOT / "examples" / "quickstart.cpp").read_text(encoding="utf-8")
        blocks = re.findall(r"```cpp\n(.*?)```", README, re.DOTALL)
        self.assertEqual(blocks, [file])

    def test_the_table_of_methods_agrees_with_the_catalogue(self):
        listed = re.findall(r"^\| `([a-z0-9-]+)` \| (\d+) \|", README, re.MULTILINE)
        self.assertGreater(len(listed), 4)
        for name, order in listed:
            data = tomllib.loads((ROOT / "methods" / f"{name}.toml").read_text(encoding="utf-8"))
            self.assertEqual(order, str(data["claims"]["order"]), name)

    def test_every_make_target_that_is_named_exists(self):
        targets = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.MULTILINE))
        for document in DOCUMENTS:
            named = set(re.findall(r"`make ([a-z-]+)`|^make ([a-z-]+)", document.read_text(encoding="utf-8"), re.M))
            for target in {a or b for a, b in named}:
                self.assertIn(target, targets, document)

    def test_every_case_that_is_named_exists(self):
        for document in DOCUMENTS:
            for case in re.findall(r"apsis run ([a-z]+/[a-z0-9-]+)", document.read_text(encoding="utf-8")):
                self.assertTrue((ROOT / "cases" / f"{case}.toml").exists(), f"{document}: {case}")

    def test_every_local_link_leads_somewhere(self):
        for document in DOCUMENTS:
            prose = re.sub(r"```.*?```", "", document.read_text(encoding="utf-8"), flags=re.DOTALL)
            for link in re.findall(r"\]\(([^)#\s]+)[^)]*\)", prose):
                if not link.startswith(("http:", "https:")):
                    self.assertTrue((document.parent / link).exists(), f"{document}: {link}")

    def test_every_room_says_what_it_is(self):
        for room in (ROOT / "src" / "apsis").iterdir():
            if room.is_dir() and any(room.glob("*.[ch]pp")):
                self.assertTrue((room / "README.md").exists(), room.name)


if __name__ == "__main__":
    unittest.main()
