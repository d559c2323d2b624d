"""Sphinx, called by build.py, which sets APSIS_BUILD and APSIS_DOCS and assembles the pages."""
import os
import re
import sys
from pathlib import Path

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

myst_enable_extensions = ["dollarmath", "deflist"]
myst_heading_anchors = 4
myst_dmath_allow_digits = False  # "2$ and 3$" is no formula

breathe_projects = {"apsis": str(WORK / "doxygen" / "xml")}
breathe_default_project = "apsis"
breathe_default_members = ("members",)
breathe_show_include = False

autodoc_member_order = "bysource"
autodoc_typehints = "signature"

# Names of others, whose documentation is elsewhere.
nitpick_ignore_regex = [
    (r"py:.*", r"(numpy|collections|pathlib|typing)\..*|Array|ArrayLike|NDArray|Path|Tableau|Case|Progress|.*Fraction"),
    (r"cpp:identifier", r"(std|boost|nlohmann|Eigen|hwy|fmt|H5|CLI)(::.*)?"),
]


def render_inline(self, node):
    self.body.append(self.starttag(node, "span", "", CLASS="math") + self.encode(node.astext()) + "</span>")
    raise SkipNode


def render_block(self, node):
    self.body.append(self.starttag(node, "div", "", CLASS="math") + self.encode(node.astext()) + "</div>\n")
    raise SkipNode


from docutils.nodes import SkipNode  # noqa: E402


def setup(app):
    app.add_html_math_renderer("katex", (render_inline, None), (render_block, None))


html_math_renderer = "katex"
