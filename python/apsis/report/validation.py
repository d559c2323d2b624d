"""The page of `apsis validate`: reference values of gas flows."""
from __future__ import annotations

from pathlib import Path
from typing import Any

from ..plot.pictures import draw
from ..plot.style import pictures_in
from . import page
from .page import number, table, text, verdict

Quantity = dict[str, Any]


def difference(value: float | None) -> str:
    return "not a number" if value is None else f"{value:+.1e}"


def section(quantity: Quantity, folder: Path) -> str:
    rows = [[" ".join(v["settings"]) or "as is", number(v["value"]), f"{number(v['reference'])} ({text(v['origin'])})", difference(v["difference"]),
             f"{v['tolerance']:.0e}", verdict(v["holds"]), f"{v['wall_s']:.1f}"] for v in quantity["values"]]
    out = [f'<h2 id="{text(quantity["name"])}">{text(quantity["name"])}</h2>\n<p>{text(quantity["description"])}. Source of the references: '
           f'{text(quantity["source"])}.</p>\n',
           table(["parameters", "computed", "reference", "relative difference", "tolerance", "", "seconds"], rows)]
    out += [page.embedded(draw(p), p["name"], p["title"], p["caption"], folder) for p in quantity["pictures"]]
    return "".join(out)


def report(document: dict[str, Any], folder: Path) -> str:
    """Returns the page; pictures are also written to <folder>/pictures."""
    values = [v for q in document["quantities"] for v in q["values"]]
    good = sum(v["holds"] for v in values)
    intro = (f"<p>{good} of {len(values)} reference values are met"
             + ("." if good == len(values) else "; those that are not are marked below.")
             + " Each was computed by one run of a case of the program. All quantities are dimensionless.</p>"
             + f'<p class="small">{page.provenance(document, document["version"])}; {document["wall_s"]:.0f} s.</p>')
    return page.page("Reference values of gas flows",
                     intro + "".join(section(q, pictures_in(folder)) for q in document["quantities"]))
