"""The site builds without warnings, its internal links are valid, and it loads no external resources.

With --whole all entries of the C++ interface are shown, and each reference in their comments must have a target.
"""
import os
import re
import subprocess
import sys
import unittest
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tests" / "support"))
from browser import Browser  # noqa: E402

BUILD = Path(os.environ.get("APSIS_BUILD", ROOT / "build" / "release"))
WORK = Path(os.environ.get("APSIS_DOCS", ROOT / "build" / "docs"))
# Cases of the gallery that take only seconds, and one method of each kind that has pictures. docs/build.py draws all of them.
CASES = ["paper/bgk-mixed-fd", "gas/couette", "laws/dam-break"]
METHODS = ["md-imex-6-3", "imdrk-2-3", "ssprk-3-3"]
# The entries of all rooms take most of the time of a build.
ROOMS = [] if sys.argv[1:] == ["--whole"] else ["--rooms", "integrate"]
LOADING = {("script", "src"), ("img", "src"), ("iframe", "src"), ("source", "src"), ("object", "data")}


class Reader(HTMLParser):
    """Collects the links, loaded resources and link targets of a page."""

    def __init__(self, text):
        super().__init__()
        self.links, self.loaded, self.places = [], [], {"", "top"}
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.places |= {values[name] for name in ("id", "name") if values.get(name)}
        self.links += [values["href"]] if tag == "a" and values.get("href") else []
        self.loaded += [values[name] for element, name in LOADING if tag == element and values.get(name)]
        if tag == "link" and values.get("rel") not in ("canonical", "license"):
            self.loaded.append(values["href"])


def is_elsewhere(link):
    return bool(urlsplit(link).scheme or urlsplit(link).netloc) and not link.startswith("data:")


class Site(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        done = subprocess.run([sys.executable, ROOT / "docs" / "build.py", "--build", BUILD, "--work", WORK, "--cases", *CASES, "--methods", *METHODS, *ROOMS],
                              text=True, capture_output=True)
        if done.returncode != 0:
            raise AssertionError(done.stdout[-8000:] + done.stderr[-8000:])
        cls.html = WORK / "html"
        cls.pages = {page: Reader(page.read_text(encoding="utf-8")) for page in cls.html.rglob("*.html")}

    def test_every_internal_link_has_a_target(self):
        for page, reader in self.pages.items():
            for link in reader.links + reader.loaded:
                if is_elsewhere(link) or link.startswith("data:"):
                    continue
                target = urlsplit(link)
                file = (page.parent / unquote(target.path)).resolve() if target.path else page
                self.assertTrue(file.is_file(), f"{page.name}: {link}")
                if file in self.pages and target.fragment:
                    self.assertIn(unquote(target.fragment), self.pages[file].places, f"{page.name}: {link}")

    def test_no_external_resource_is_loaded(self):
        for page, reader in self.pages.items():
            self.assertEqual([x for x in reader.loaded if is_elsewhere(x)], [], page)
        for style in self.html.rglob("*.css"):
            text = style.read_text(encoding="utf-8")
            for link in re.findall(r"url\(\s*[\"']?([^\"')]+)", text) + re.findall(r"@import\s+[\"']([^\"']+)", text):
                self.assertFalse(is_elsewhere(link) or link.startswith("/"), f"{style.name}: {link}")
        for script in self.html.rglob("*.js"):
            text = script.read_text(encoding="utf-8")
            self.assertIsNone(re.search(r"(?:fetch|import|importScripts)\(\s*[\"'](?:https?:)?//", text), script.name)

    def test_a_browser_shows_it_at_any_width_without_console_messages(self):
        browser = Browser()
        self.addCleanup(browser.quit)
        inside = self.html.as_uri() + "/"
        for name in ("index", "first-steps", "tutorials/own-pde", "methods", "study", "reference/methods", "reference/methods/md-imex-6-3", "gallery", "api/integrate", "python-api"):
            for width in (400, 1600):
                with self.subTest(page=name, width=width):
                    seen = browser.show(self.html / f"{name}.html", width)
                    self.assertLessEqual(seen["content"], width)
                    self.assertEqual(seen["broken"], 0)
                    self.assertEqual(browser.console(), [])
                    self.assertEqual([x for x in browser.requests() if not x.startswith((inside, "data:"))], [])

    def test_every_page_is_in_the_contents_and_every_header_in_the_interface(self):
        index = self.pages[self.html / "index.html"].links
        for page in ROOT.glob("docs/**/*.md"):
            if page.name != "index.md":
                self.assertIn(f"{page.relative_to(ROOT / 'docs').with_suffix('.html')}", index)
        for header in ROOT.glob("src/apsis/*/**/*.hpp"):
            room = self.html / "api" / f"{header.relative_to(ROOT / 'src' / 'apsis').parts[0]}.html"
            if not header.stem.endswith("-inl") and not {"internal", "formulas"} & set(header.parts):
                self.assertIn(f"apsis/{header.relative_to(ROOT / 'src' / 'apsis')}", room.read_text(encoding="utf-8"))

    def test_names_of_the_program_are_in_the_reference(self):
        for what in ("methods", "models", "cases", "keys", "schemes", "claims"):
            text = (self.html / "reference" / f"{what}.html").read_text(encoding="utf-8")
            listed = subprocess.run([BUILD / "app" / "apsis", "list", what, "--names"], text=True, capture_output=True)
            names = listed.stdout.split()
            self.assertGreater(len(names), 2)
            for name in names:
                self.assertIn(name, text)

    def test_every_method_has_a_page_and_cases_and_methods_have_pictures(self):
        def listed(what):
            return subprocess.run([BUILD / "app" / "apsis", "list", what, "--names"], text=True, capture_output=True, check=True).stdout.split()

        for name in listed("methods"):
            page = (self.html / "reference" / "methods" / f"{name}.html").read_text(encoding="utf-8")
            self.assertIn("When to use it", page)
            for picture in ("stability", "tableau"):
                self.assertEqual(f"{name}-{picture}.png" in page, name in METHODS)
        gallery = (self.html / "gallery.html").read_text(encoding="utf-8")
        self.assertLessEqual(set(CASES), set(listed("cases")))
        for name in CASES:
            self.assertIn(f"apsis run {name}", re.sub(r"<[^>]*>", "", gallery))
            self.assertIn(f"gallery-{name.replace('/', '-')}.png", gallery)

    def test_names_of_the_package_are_in_the_python_interface(self):
        sys.path.insert(0, str(BUILD / "python"))
        import inspect
        import apsis
        places = self.pages[self.html / "python-api.html"].places
        for name in (n for n in apsis.__all__ if inspect.isclass(getattr(apsis, n)) or inspect.isroutine(getattr(apsis, n))):
            self.assertIn(f"apsis.{name}", places)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
