#!/usr/bin/python3
"""Builds the site: docs/build.py [--build build/release] [--work build/docs] [--cases NAME …] [--methods NAME …] [--rooms NAME …],
pages in WORK/html.

The pages of docs are written for GitHub. A copy in WORK/source adds the parts that only the site has: reference pages from the
program, a gallery of all cases, a page for each method and for each room of the library, new pictures from the blocks executed by
execute.py, tables of contents from the lists of docs/index.md, and links to pages of the site or to copies of files.
"""
import argparse
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from gallery import GalleryError, write_gallery
from headers import Header, read_headers
from reference import write_reference

ROOT = Path(__file__).resolve().parents[1]
KATEX = Path("/usr/share/javascript/katex")
NORMALIZE = Path("/usr/share/javascript/normalize.css/normalize.css")
# Pages outside docs, and folders that have a page.
PLACES = {"README.md": "overview.md", "CONTRIBUTING.md": "contributing.md", "CHANGELOG.md": "changelog.md",
          "bench/README.md": "bench.md", "packaging/README.md": "packaging.md", "methods": "reference/methods.md",
          "cases": "reference/cases.md"}
LINK = re.compile(r"(\]\()([^)\s]+)(\))")
ENTRY = re.compile(r"\[([^\]]+)\]\(([^)\s]+\.md)\)")


def rooms() -> list[str]:
    """In the order in which they depend on each other."""
    return re.findall(r"^apsis_room\((\w+)", (ROOT / "src" / "apsis" / "CMakeLists.txt").read_text(encoding="utf-8"), re.M)


class Site:
    """Markdown pages in a separate folder, with links converted to locations on the site."""

    def __init__(self, source: Path):
        self.source, self.problems = source, []
        shutil.rmtree(source, ignore_errors=True)
        source.mkdir(parents=True)
        self.places = dict(PLACES)
        self.places |= {str(page.relative_to(ROOT)): str(page.relative_to(ROOT / "docs")) for page in ROOT.glob("docs/**/*.md")}
        self.places |= {f"docs/api/{room}.md": f"api/{room}.md" for room in [*rooms(), "index"]}
        self.places |= {f"src/apsis/{room}{file}": f"api/{room}.md" for room in rooms() for file in ("", "/README.md")}

    def add(self, place: str, text: str, origin: str | None = None):
        """Adds a page; `origin` is the file of the repository to which its links are relative, if it is not the site."""
        page = self.source / place
        page.parent.mkdir(parents=True, exist_ok=True)
        parts = re.split(r"(^ *```.*?^ *```|`[^`\n]+`)", text, flags=re.M | re.S)  # no links in code
        parts[::2] = [LINK.sub(lambda m: m[1] + self.link(m[2], place, origin or f"docs/{place}") + m[3], p) for p in parts[::2]]
        page.write_text("".join(parts), encoding="utf-8")

    def link(self, target: str, place: str, origin: str) -> str:
        """Converts a link of a page of the repository to one from its location on the site."""
        path, mark, anchor = target.partition("#")
        if re.match(r"[a-z]+:", target) or not path:
            return target
        file = os.path.normpath(os.path.join(os.path.dirname(origin), path))
        to = self.places.get(file)
        if file.startswith(("docs/reference/", "docs/images/")):
            to = file.removeprefix("docs/")
        if to is None and (ROOT / file).is_dir():  # part of a folder that has a page
            to = next((self.places[str(folder)] for folder in Path(file).parents if str(folder) in self.places), None)
        if to is None and (ROOT / file).is_file():
            to = f"files/{file}"  # a copy of the file, under the name that it has here
            (self.source / to).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / file, self.source / to)
        if to is None:
            self.problems.append(f"{origin}: there is no {target} (neither a page nor a file); correct the link")
            return target
        return os.path.relpath(to, os.path.dirname(place) or ".") + mark + anchor


def assemble(site: Site, program: Path, work: Path, cases: list[str] | None, methods: list[str] | None, shown: list[str]):
    """All pages, with entries of the rooms `shown` and pictures of these cases and methods; None: of all. doxygen has been run."""
    shutil.copytree(ROOT / "docs" / "_static", site.source / "_static")
    unused = shutil.ignore_patterns("*.mjs", "contrib", "*.ttf", "*.woff")
    shutil.copytree(KATEX, site.source / "_static" / "katex", ignore=unused)
    shutil.copytree(ROOT / "docs" / "images", site.source / "images")
    for picture in work.glob("run/*/images/*.png"):
        shutil.copy(picture, site.source / "images" / picture.name)
    site.add("gallery.md", write_gallery(program, work / "gallery", site.source / "images", cases))
    reference = write_reference(program, site.source / "reference", site.source / "images", methods)
    generated = {"Reference": ["gallery", *(f"reference/{name}" for name in reference)],
                 "C++ interface": ["api/index"], "Python interface": ["python-api"]}
    for page in (site.source / "reference").rglob("*.md"):
        site.add(str(page.relative_to(site.source)), page.read_text(encoding="utf-8"))
    for file, place in site.places.items():
        if file.endswith(".md") and not place.startswith("api/") and place != "index.md":
            site.add(place, (ROOT / file).read_text(encoding="utf-8"), file)
    add_interfaces(site, read_headers(work / "doxygen" / "xml"), shown)
    index = (ROOT / "docs" / "index.md").read_text(encoding="utf-8")
    site.add("index.md", with_contents(index, site, generated), "docs/index.md")


def with_contents(text: str, site: Site, generated: dict[str, list[str]]) -> str:
    """Returns the front page with a table of contents for each section: the pages of its list, then generated ones."""
    contents = {}
    for section in text.split("\n## ")[1:]:
        contents[section.splitlines()[0]] = [f"{title} <{site.link(target, 'index.md', 'docs/index.md')}>"
                                             for title, target in ENTRY.findall(section)]
    for title, pages in generated.items():
        contents[title] = contents.get(title, []) + pages
    return text + "".join(f"\n```{{toctree}}\n:caption: {title}\n:hidden:\n\n" + "\n".join(pages) + "\n```\n"
                          for title, pages in contents.items())


def add_interfaces(site: Site, headers: dict[str, Header], shown: list[str]):
    """A page for each room, with all its headers and, in the rooms `shown`, their entries; and one for the Python package."""
    listed = ""
    for room in rooms():
        about = (ROOT / "src" / "apsis" / room / "README.md").read_text(encoding="utf-8")
        text = about.replace("\n", "\n\n", 1)
        for name in sorted(name for name in headers if name.startswith(f"apsis/{room}/")):
            text += f"\n## {name.removeprefix(f'apsis/{room}/')}\n\n```cpp\n#include <{name}>\n```\n\n"
            text += headers[name].directives(name) if room in shown else ""
        site.add(f"api/{room}.md", text, f"src/apsis/{room}/README.md")
        listed += f"- [{room}]({room}.md): {about.split(chr(10), 1)[1].split('. ')[0].strip().rstrip('.')}.\n"
    site.add("api/index.md", "# C++ interface\n\n`src/apsis` is a sequence of rooms, each a library that links only those "
             f"before it. `find_package(apsis)` provides all as `apsis::apsis`, [components](../linking.md) a part."
             f"\n\n{listed}\n```{{toctree}}\n:hidden:\n\n"
             + "\n".join(rooms()) + "\n```\n")
    site.add("python-api.md", "# Python interface\n\n```{eval-rst}\n.. automodule:: apsis\n   :members:\n   :undoc-members:\n"
             "```\n")


def mend_theme(static: Path):
    """Debian's furo is packaged as in its sources: its script is a module, which browsers load only from servers, and its style
    sheet loads another one from a path of the machine."""
    scripts, sheet = static / "scripts", static / "styles" / "furo.css"
    script = (scripts / "furo.js").read_text(encoding="utf-8")
    needed = (scripts / "gumshoe-patched.js").read_text(encoding="utf-8")
    (scripts / "furo.js").write_text(script.replace('import Gumshoe from "./gumshoe-patched.js";', needed), encoding="utf-8")
    shutil.copy(NORMALIZE, sheet.parent)
    style = sheet.read_text(encoding="utf-8")
    sheet.write_text(style.replace(f"/javascript/{NORMALIZE.parent.name}/{NORMALIZE.name}", NORMALIZE.name), encoding="utf-8")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=ROOT / "build" / "release")
    parser.add_argument("--work", type=Path, default=ROOT / "build" / "docs")
    parser.add_argument("--cases", nargs="+", help="cases of the gallery; without them all, which takes many minutes")
    parser.add_argument("--methods", nargs="+", help="methods whose pages have pictures; without them all, which takes a minute")
    parser.add_argument("--rooms", nargs="+", choices=rooms(), default=rooms(), metavar="NAME",
                        help="rooms of the library whose entries are shown; references are checked if all are")
    given = parser.parse_args()
    build, work = given.build.resolve(), given.work.resolve()
    xml = work / "doxygen" / "xml"
    known = {file.name for file in xml.glob("*")}
    shutil.rmtree(work / "doxygen", ignore_errors=True)
    (work / "doxygen").mkdir(parents=True, exist_ok=True)
    doxygen = subprocess.run(["doxygen", "-"], cwd=ROOT, text=True, input=(
        (ROOT / "docs" / "Doxyfile").read_text(encoding="utf-8") + f"\nOUTPUT_DIRECTORY = {work / 'doxygen'}\n"
        + os.environ.get("APSIS_DOXYGEN", "")))
    if known - {file.name for file in xml.glob("*")}:  # breathe stops at a page whose type was renamed or removed
        shutil.rmtree(work / "doctrees", ignore_errors=True)
    site = Site(work / "source")
    try:
        assemble(site, build / "app" / "apsis", work, given.cases, given.methods, given.rooms)
    except GalleryError as problem:
        print(f"docs/build.py: the gallery is incomplete ({problem}); correct the case, or the sizes in docs/gallery.py", file=sys.stderr)
        return 1
    for problem in dict.fromkeys(site.problems):
        print(problem, file=sys.stderr)
    shutil.rmtree(work / "html", ignore_errors=True)
    environment = {"APSIS_BUILD": str(build), "APSIS_DOCS": str(work), "PYTHONDONTWRITEBYTECODE": "1"}
    strict = ["-n"] if set(given.rooms) == set(rooms()) else []
    sphinx = subprocess.run(["/usr/bin/python3", "-m", "sphinx", "-W", "--keep-going", *strict, "-q", "-b", "html", "-d",
                             work / "doctrees", "-c", ROOT / "docs", site.source, work / "html"], env=os.environ | environment)
    if (work / "html" / "_static").is_dir():
        mend_theme(work / "html" / "_static")
    if site.problems or doxygen.returncode or sphinx.returncode:
        return 1
    print(f"the site is {work / 'html' / 'index.html'}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
