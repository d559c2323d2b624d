"""The page of `apsis converge --out` and `apsis sweep --out`: the table and the picture."""
from __future__ import annotations

from pathlib import Path
from typing import Any

from ..plot.pictures import draw
from ..plot.run_result import read_json, read_json_list
from ..plot.style import pictures_in
from . import page
from .page import Html, number, table, text


def cell(value: Any) -> str:
    return "" if value is None else number(value) if isinstance(value, (int, float)) else str(value)


def runs_table(runs: list[dict[str, Any]]) -> str:
    columns = list(dict.fromkeys(key for run in runs for key in run))
    return table(columns, [[cell(run.get(key)) for key in columns] for run in runs])


def rows_of(folder: Path) -> Path | None:
    """Returns the table of a study in the folder, or None where the folder has no such table."""
    return next((folder / name for name in ("converge.json", "sweep.json") if (folder / name).exists()), None)


def report(folder: Path, rows_file: Path) -> str:
    """Returns the page of the table that rows_of() names; the picture is also written to <folder>/pictures. Raises PictureError."""
    manifest = read_json(folder / "manifest.json")
    study: dict[str, Any] = manifest["study"]
    picture = folder / "picture.json"
    drawing = ""
    title = f"{'Steady states' if rows_file.name == 'sweep.json' else 'Convergence'} of {study['case']}"
    if picture.exists():
        data = read_json(picture)
        title = data["title"]
        drawing = page.embedded(draw(data), data["name"], data["title"], data["caption"], pictures_in(folder))
    rows = [[Html(f"<code>{text(name)}</code>"), value] for name, value in study.items()]
    body = (f"<p>{text(manifest['state'])}: {text(study['runs'])} runs; {text(study['measure'])}. All quantities are dimensionless.</p>\n"
            + drawing + "<h2>Runs</h2>\n" + runs_table(read_json_list(rows_file)) + "<h2>Study</h2>\n" + table([], rows)
            + f'<p class="small">{page.provenance(manifest, manifest["apsis"])}</p>\n')
    return page.page(title, body)
