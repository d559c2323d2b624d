"""Parts of a report page, a single HTML file that opens offline."""
from __future__ import annotations

import base64
import html
import io
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

from ..plot.style import UNDATED, picture_path, printable, save_beside_results, show_literally

STYLE = """
:root { color-scheme: light; }
body { font: 16px/1.5 system-ui, sans-serif; color: #1a1a1a; background: #fff; max-width: 62rem; margin: 0 auto; padding: 1rem; }
h1 { font-size: 1.6rem; } h2 { font-size: 1.2rem; margin-top: 2.2rem; border-top: 1px solid #ccc; padding-top: .8rem; }
h1, h2, p, td, figcaption { overflow-wrap: break-word; }
table { border-collapse: collapse; font-size: .9rem; } .wide { overflow-x: auto; margin: .6rem 0; }
th, td { text-align: left; padding: .2rem .7rem .2rem 0; border-bottom: 1px solid #e2e2e2; vertical-align: top; }
caption { text-align: left; font-weight: 600; padding: .3rem 0; }
td.number { font-variant-numeric: tabular-nums; white-space: nowrap; }
.yes::before { content: "\\2713\\00a0"; } .no::before { content: "\\2717\\00a0"; }
.yes { color: #00664b; white-space: nowrap; } .no { color: #a33b00; font-weight: 700; }
figure { margin: 1rem 0; overflow-x: auto; } figure img { max-width: 100%; height: auto; } figcaption { font-size: .9rem; color: #333; max-width: 50rem; }
pre { background: #f6f6f6; padding: .6rem; overflow-x: auto; font-size: .85rem; }
.small { color: #555; font-size: .85rem; } a { color: #00508a; }
@media (max-width: 48rem) { table { font-size: .8rem; } th, td { padding-right: .4rem; } }
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


class Html(str):
    """Markup of this program. Any other text is escaped where it enters a page: a result folder may come from others."""


def page(title: str, body: str) -> str:
    return PAGE.format(title=text(title), style=STYLE, body=body)


def text(value: Any) -> Html:
    """Returns a value as escaped text; markup stays."""
    return value if isinstance(value, Html) else Html(html.escape(printable(str(value))))


def number(value: float | None) -> str:
    """Formats a number: counts as integers, measurements to four digits."""
    if value is None:
        return "not a number"
    if not isinstance(value, (int, float)):
        raise TypeError(f"{value!r} is not a number")
    return f"{value:.0f}" if float(value).is_integer() and abs(value) < 1e6 else f"{value:.4g}"


def verdict(good: bool, words: tuple[str, str] = ("holds", "fails")) -> Html:
    return Html(f'<span class="{"yes" if good else "no"}">{text(words[0] if good else words[1])}</span>')


def table(columns: Sequence[str], rows: Iterable[Sequence[Any]], title: str = "") -> str:
    """Returns an HTML table; without columns a table of names and values."""
    head = "<thead><tr>" + "".join(f"<th>{text(c)}</th>" for c in columns) + "</tr></thead>" if columns else ""
    body = "".join("<tr>" + "".join(f"<td>{text(cell)}</td>" for cell in row) + "</tr>\n" for row in rows)
    caption = f"<caption>{text(title)}</caption>" if title else ""
    return f'<div class="wide"><table>{caption}{head}<tbody>\n{body}</tbody></table></div>\n'


def embedded(figure: Any, name: str, title: str, caption: str, folder: Path) -> str:
    """Returns the figure as an <img> with embedded data and writes it to <folder>/<name>.png. Raises PictureError."""
    path = picture_path(folder, name, "png")
    stream = io.BytesIO()
    width = figure.get_figwidth()
    show_literally(figure).savefig(stream, format="svg", metadata=UNDATED[".svg"])
    data = base64.b64encode(stream.getvalue()).decode("ascii")
    save_beside_results(figure, path)
    # 10-point letters remain 7.7 pixels high on a narrow screen, where wide pictures scroll.
    return (f'<figure><img style="min-width: {0.58 * 96 * width:.0f}px" alt="{text(title)}" src="data:image/svg+xml;base64,{data}">'
            f'<figcaption><b>{text(title)}.</b> {text(caption)}</figcaption></figure>\n')


def provenance(document: dict[str, Any], version: str) -> str:
    """Returns one line with version, machine and time."""
    build, machine = document["build"], document["machine"]
    return (f'apsis {text(version)}, {text(build["compiler"])}, {text(build["build_type"])}, '
            f'{text(build["instruction_set"])}; {text(machine["processor"])}, {text(machine["threads"])} threads')
