"""The page of `apsis reproduce`: the paper, claim by claim."""
from __future__ import annotations

import re
from pathlib import Path
from typing import Any

from ..plot.pictures import draw
from ..plot.style import pictures_in, printable
from . import page
from .page import Html, number, table, text, verdict

Claim = dict[str, Any]


def overview(claims: list[Claim]) -> str:
    rows = [[Html(f'<a href="#{text(c["id"])}">{text(c["id"])}</a>'), verdict(c["holds"]), c["statement"], deciding(c)]
            for c in claims]
    return table(["claim", "verdict", "statement", "measured"], rows)


def deciding(claim: Claim) -> str:
    """Returns the finding for the overview: the first failing one, otherwise the first."""
    if claim.get("error"):
        return str(claim["error"])
    findings = claim["findings"]
    chosen = next((f for f in findings if not f["holds"]), findings[0])
    return f"{chosen['what']}: {shown(chosen)}"


def shown(finding: dict[str, Any]) -> str:
    if finding["condition"] == "true":
        return "yes" if finding["value"] else "no"
    return f"{number(finding['value'])} ({finding['condition']})"


def section(claim: Claim, folder: Path) -> str:
    out = [f'<h2 id="{text(claim["id"])}">{text(claim["id"])}: {text(claim["statement"])}</h2>\n',
           f'<p>{verdict(claim["holds"])} &middot; paper, {text(claim["section"])} &middot; shown by: {text(claim["how"])} '
           f'<span class="small">({claim["wall_s"]:.1f} s)</span></p>\n']
    if claim.get("error"):
        out.append(f'<p class="no">{text(claim["error"])}</p>\n')
    if claim["findings"]:
        out.append(table(["figure", "measured", "must be", ""],
                         [[f["what"], "yes" if f["condition"] == "true" and f["value"] else
                           "no" if f["condition"] == "true" else number(f["value"]),
                           f["condition"], verdict(f["holds"], ("", "fails"))] for f in claim["findings"]]))
    out += [table(t["columns"], t["rows"], t["title"]) for t in claim["tables"]]
    out += [page.embedded(draw(p), p["name"], p["title"], p["caption"], folder) for p in claim["pictures"]]
    out += [f"<p>{text(remark)}</p>\n" for remark in claim["remarks"]]
    return "".join(out)


def report(document: dict[str, Any], folder: Path) -> str:
    """Returns the page; pictures are also written to <folder>/pictures."""
    claims = document["claims"]
    good = sum(c["holds"] for c in claims)
    intro = (f"<p>{good} of {len(claims)} claims hold"
             + ("." if good == len(claims) else "; those that do not are marked below.")
             + " Every figure was measured by this run through the library's own methods, stepper and operators. All"
               " quantities are dimensionless.</p>"
             + f'<p class="small">{page.provenance(document, document["version"])}; {document["wall_s"]:.0f} s. '
               f'Source of the statements: {text(document["paper"])}.</p>')
    body = intro + overview(claims) + "".join(section(c, pictures_in(folder)) for c in claims)
    return page.page("The paper, claim by claim", body)


def markdown(document: dict[str, Any]) -> str:
    """Returns the verdict table as Markdown for the documentation."""
    def plain(value: Any) -> str:
        # A tag is text there too.
        return re.sub(r"<(?=[A-Za-z/!?])", r"\\<", printable(str(value))).replace("|", "\\|").replace("\n", " ")

    claims = document["claims"]
    machine = document["machine"]
    lines = ["# The paper, claim by claim", "",
             f"Made by `apsis reproduce`: {sum(c['holds'] for c in claims)} of {len(claims)} claims hold. Measured with version "
             f"{plain(document['version'])}, {plain(document['build']['compiler'])}, on {plain(machine['threads'])} threads of "
             f"{plain(machine['processor'])}, {document['wall_s']:.0f} s. All quantities are dimensionless. The report has every figure, table "
             "and picture; here is one figure for each claim.", "",
             "| claim | statement | shown by | measured (must be) | verdict |", "|---|---|---|---|---|"]
    lines += [f"| {plain(c['id'])} | {plain(c['statement'])} | {plain(c['how'])} | {plain(deciding(c))} | {'holds' if c['holds'] else 'fails'} |"
              for c in claims]
    remarks = [f"- **{plain(c['id'])}** {plain(r)}" for c in claims for r in c["remarks"]]
    if remarks:
        lines += ["", "## Corrections and remarks", "", *remarks]
    return "\n".join(lines) + "\n"
