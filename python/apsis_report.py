#!/usr/bin/env python3
"""Makes the report of `apsis reproduce`: one self-contained page that opens without a network.

    apsis_report.py DIR        reads DIR/reproduce.json, writes DIR/report.html, DIR/claims.md and DIR/pictures/*.png
"""
import argparse
import base64
import html
import io
import sys
from pathlib import Path

import apsis_picture
from apsis_picture import plt

STYLE = """
:root { color-scheme: light; }
body { font: 16px/1.5 system-ui, sans-serif; color: #1a1a1a; background: #fff; max-width: 62rem; margin: 0 auto; padding: 1rem; }
h1 { font-size: 1.6rem; } h2 { font-size: 1.2rem; margin-top: 2.2rem; border-top: 1px solid #ccc; padding-top: .8rem; }
table { border-collapse: collapse; font-size: .9rem; } .wide { overflow-x: auto; margin: .6rem 0; }
th, td { text-align: left; padding: .2rem .7rem .2rem 0; border-bottom: 1px solid #e2e2e2; vertical-align: top; }
caption { text-align: left; font-weight: 600; padding: .3rem 0; }
td.number { font-variant-numeric: tabular-nums; white-space: nowrap; }
.yes::before { content: "\\2713\\00a0"; } .no::before { content: "\\2717\\00a0"; }
.yes { color: #00664b; white-space: nowrap; } .no { color: #a33b00; font-weight: 700; white-space: nowrap; }
figure { margin: 1rem 0; } figure img { max-width: 100%; height: auto; } figcaption { font-size: .9rem; color: #333; max-width: 50rem; }
.small { color: #555; font-size: .85rem; } a { color: #00508a; }
@media (max-width: 40rem) { table { font-size: .8rem; } th, td { padding-right: .4rem; } }
@media print { body { max-width: none; font-size: 11px; } h2, figure, tr { break-inside: avoid; } a { color: inherit; text-decoration: none; } }
"""

PAGE = """<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}</title><link rel="icon" href="data:,"><style>{style}</style></head>
<body>
<h1>{title}</h1>
{body}
</body></html>
"""


def text(value):
    return html.escape(str(value))


def number(value):
    """Figures as a reader wants them: counts whole, measurements to four digits."""
    if value is None:
        return "not a number"
    return f"{value:.0f}" if float(value).is_integer() and abs(value) < 1e6 else f"{value:.4g}"


def verdict(good, words=("holds", "fails")):
    return f'<span class="{"yes" if good else "no"}">{words[0] if good else words[1]}</span>'


def table(columns, rows, title=""):
    head = "".join(f"<th>{text(c)}</th>" for c in columns)
    body = "".join("<tr>" + "".join(f"<td>{cell}</td>" for cell in row) + "</tr>\n" for row in rows)
    caption = f"<caption>{text(title)}</caption>" if title else ""
    return f'<div class="wide"><table>{caption}<thead><tr>{head}</tr></thead><tbody>\n{body}</tbody></table></div>\n'


def overview(claims):
    rows = [[f'<a href="#{text(c["id"])}">{text(c["id"])}</a>', verdict(c["holds"]), text(c["statement"]), deciding(c)]
            for c in claims]
    return table(["claim", "verdict", "statement", "measured"], rows)


def deciding(claim):
    """The figure to show in the overview: the first that fails, else the first."""
    if claim.get("error"):
        return text(claim["error"])
    findings = claim["findings"]
    chosen = next((f for f in findings if not f["holds"]), findings[0])
    return f"{text(chosen['what'])}: {shown(chosen)}"


def shown(finding):
    if finding["condition"] == "true":
        return "yes" if finding["value"] else "no"
    return f"{number(finding['value'])} ({text(finding['condition'])})"


def embedded(picture, folder):
    """The picture as an <img> with its data inside, and as a PNG in the folder."""
    figure = apsis_picture.draw(picture)
    folder.mkdir(parents=True, exist_ok=True)
    figure.savefig(folder / f"{picture['name']}.png")
    stream = io.BytesIO()
    figure.savefig(stream, format="svg", metadata={"Date": None})
    plt.close(figure)
    data = base64.b64encode(stream.getvalue()).decode("ascii")
    return (f'<figure><img alt="{text(picture["title"])}" src="data:image/svg+xml;base64,{data}">'
            f'<figcaption><b>{text(picture["title"])}.</b> {text(picture["caption"])}</figcaption></figure>\n')


def section(claim, folder):
    out = [f'<h2 id="{text(claim["id"])}">{text(claim["id"])}: {text(claim["statement"])}</h2>\n',
           f'<p>{verdict(claim["holds"])} &middot; paper, {text(claim["section"])} &middot; shown by: {text(claim["how"])} '
           f'<span class="small">({claim["wall_s"]:.1f} s)</span></p>\n']
    if claim.get("error"):
        out.append(f'<p class="no">{text(claim["error"])}</p>\n')
    if claim["findings"]:
        out.append(table(["figure", "measured", "must be", ""],
                         [[text(f["what"]), "yes" if f["condition"] == "true" and f["value"] else
                           "no" if f["condition"] == "true" else number(f["value"]),
                           text(f["condition"]), verdict(f["holds"], ("", "fails"))] for f in claim["findings"]]))
    out += [table(t["columns"], [[text(cell) for cell in row] for row in t["rows"]], t["title"]) for t in claim["tables"]]
    out += [embedded(p, folder) for p in claim["pictures"]]
    out += [f"<p>{text(remark)}</p>\n" for remark in claim["remarks"]]
    return "".join(out)


def page(document, folder):
    claims = document["claims"]
    good = sum(c["holds"] for c in claims)
    machine = document["machine"]
    intro = (f"<p>{good} of {len(claims)} claims hold"
             + ("." if good == len(claims) else "; those that do not are marked below.")
             + " Every figure was measured by this run through the library's own methods, stepper and operators. All"
               " quantities are dimensionless.</p>"
             + f'<p class="small">apsis {text(document["version"])}, {text(document["build"]["compiler"])}, '
               f'{text(document["build"]["build_type"])}, {text(document["build"]["instruction_set"])}; '
               f'{text(machine["processor"])}, {machine["threads"]} threads; {document["wall_s"]:.0f} s. '
               f'Source of the statements: {text(document["paper"])}.</p>')
    body = intro + overview(claims) + "".join(section(c, folder) for c in claims)
    return PAGE.format(title="The paper, claim by claim", style=STYLE, body=body)


def markdown(document):
    """The verdict table alone, for documentation."""
    def plain(value):
        return html.unescape(str(value)).replace("|", "\\|").replace("\n", " ")

    claims = document["claims"]
    machine = document["machine"]
    lines = ["# The paper, claim by claim", "",
             f"Made by `apsis reproduce`: {sum(c['holds'] for c in claims)} of {len(claims)} claims hold. Measured with version "
             f"{document['version']}, {document['build']['compiler']}, on {machine['threads']} threads of "
             f"{machine['processor']}, {document['wall_s']:.0f} s. All quantities are dimensionless. The report has every figure, table "
             "and picture; here is one figure for each claim.", "",
             "| claim | statement | shown by | measured (must be) | verdict |", "|---|---|---|---|---|"]
    lines += [f"| {c['id']} | {plain(c['statement'])} | {plain(c['how'])} | {plain(deciding(c))} | {'holds' if c['holds'] else 'fails'} |"
              for c in claims]
    remarks = [f"- **{c['id']}** {plain(r)}" for c in claims for r in c["remarks"]]
    if remarks:
        lines += ["", "## Corrections and remarks", "", *remarks]
    return "\n".join(lines) + "\n"


def write(path, content):
    """Appears complete or not at all."""
    partial = path.with_name(f".{path.name}.partial")
    partial.write_text(content, encoding="utf-8")
    partial.replace(path)


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path)
    folder = parser.parse_args(arguments).folder
    try:
        document = apsis_picture.read_json(folder / "reproduce.json")
    except apsis_picture.PictureError as problem:
        print(f"apsis_report: {problem}", file=sys.stderr)
        return 4
    write(folder / "report.html", page(document, folder / "pictures"))
    write(folder / "claims.md", markdown(document))
    print(folder / "report.html")
    return 0


if __name__ == "__main__":
    sys.exit(main())
