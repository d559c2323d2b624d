"""Sphinx, called by build.py, which sets APSIS_BUILD and APSIS_DOCS and assembles the pages."""
import os
import re
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from breathe.finder import stack
from breathe.finder.index import DoxygenTypeSubItemFinder
from breathe.renderer.filter import FilterFactory
from docutils.nodes import SkipNode
from sphinx.domains.cpp import ASTDeclaration

ROOT = Path(__file__).resolve().parents[1]
BUILD, WORK = Path(os.environ["APSIS_BUILD"]), Path(os.environ["APSIS_DOCS"])
KATEX = Path("/usr/share/javascript/katex")  # libjs-katex: pages load nothing from elsewhere
sys.path[:0] = [str(BUILD / "python")]

project = "Apsis"
author = copyright = "The Apsis authors"
release = version = re.search(r"project\(apsis VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text(encoding="utf-8"))[1]
extensions = ["myst_parser", "breathe", "sphinx.ext.autodoc"]
html_theme = "furo"
html_title = f"Apsis {version}"
html_static_path = [str(WORK / "source" / "_static")]
html_css_files = ["katex/katex.min.css", "site.css"]
html_js_files = ["katex/katex.min.js", "site.js"]
html_copy_source = False
html_show_sphinx = False
highlight_language = "text"
smartquotes = False  # --out is two hyphens

myst_enable_extensions = ["dollarmath", "deflist"]
myst_heading_anchors = 4
myst_dmath_allow_digits = False  # "2$ and 3$" is no formula

breathe_projects = {"apsis": str(WORK / "doxygen" / "xml")}
breathe_default_project = "apsis"
breathe_default_members = ("members",)
breathe_show_include = False

autodoc_member_order = "bysource"
autodoc_type_aliases = {name: name for name in ("Array", "ArrayLike", "Case", "Coefficient", "Face", "Function", "Initial", "Interval", "OptimizeResult",
                                                "Progress", "Quantity", "Tableau", "Velocities")}

# Names of others, whose documentation is elsewhere.
index = ElementTree.parse(WORK / "doxygen" / "xml" / "index.xml").getroot()
nitpick_ignore = [("cpp:identifier", part) for entry in index.iterfind("compound[@kind='namespace']")
                  for part in (entry.findtext("name"), entry.findtext("name").rpartition("::")[2])]
nitpick_ignore_regex = [
    ("cpp:identifier", r"scalar::.*|target_shape"),  # formulas have no pages
    ("cpp:identifier", r"lanes"),  # in an inner namespace, from which apsis takes it
    ("cpp:identifier", r".*<double>::progress"),  # members of class templates have no page of their own
    (r"py:.*", r"(numpy|collections|pathlib|typing|apsis\._core)\..*|Path|.*Fraction|.*ForwardRef.*|"
     + "|".join(autodoc_type_aliases)),
    (r"cpp:identifier", r"(std|boost|nlohmann|Eigen|hwy|fmt)(::.*)?|.*@\d+"),  # @: without a name
]


def render_inline(self, node):
    self.body.append(self.starttag(node, "span", "", CLASS="math") + self.encode(node.astext()) + "</span>")
    raise SkipNode


def render_block(self, node):
    self.body.append(self.starttag(node, "div", "", CLASS="math") + self.encode(node.astext()) + "</div>\n")
    raise SkipNode


def newest_id(declaration, compute=ASTDeclaration.get_newest_id):
    """Sphinx asks for the same names again and again: half of the time of a build."""
    if declaration.objectType == "enumerator":  # that of an enumerator changes
        return compute(declaration)
    if not hasattr(declaration, "newest_id"):
        declaration.newest_id = compute(declaration)
    return declaration.newest_id


def noting_words(create):
    """Wraps a function that makes a filter for entries of the index, so that the filter has the words it looks for."""
    def made(self, *words):
        found = create(self, *words)
        found.words = words
        return found
    return made


def search_index(self, ancestors, filter_, matches, search=DoxygenTypeSubItemFinder.filter_):
    """breathe would look into the files of all entries for every directive: a quarter of the time of a build."""
    if not hasattr(filter_, "words"):
        return search(self, ancestors, filter_, matches)
    here = stack(self.data_object, ancestors)
    entries = [stack(entry, here) for entry in self.data_object.get_compound() if entry.get_name() in filter_.words]
    matches += filter(filter_.allow, entries)


def show_as_written(app, what, name, item, options, lines):
    """Indented lines of a docstring are formulas or code, and `names` are code."""
    text = re.sub(r"(?<!`)`([^`]+)`(?!`)", r"``\1``", "\n".join(lines))
    lines[:] = re.sub(r"(?<!::)\n\n(?=    )(?<!\n    )", r"\n\n::\n\n", text).splitlines()


def setup(app):
    app.connect("autodoc-process-docstring", show_as_written)
    ASTDeclaration.get_newest_id = newest_id
    DoxygenTypeSubItemFinder.filter_ = search_index
    for make in ("create_compound_finder_filter", "create_finder_filter"):
        setattr(FilterFactory, make, noting_words(getattr(FilterFactory, make)))
    app.add_html_math_renderer("katex", (render_inline, None), (render_block, None))


html_math_renderer = "katex"
