"""Writes the report page of a folder of results."""
from __future__ import annotations

from pathlib import Path

from ..plot.run_result import read_json
from ..plot.style import PictureError, whole_file
from . import claims, run, study, validation


def write(path: Path, content: str) -> None:
    with whole_file(path) as file:
        file.write(content.encode("utf-8", "backslashreplace"))


def make_report(folder: str | Path) -> Path:
    """Writes <folder>/report.html, the pictures and, for a reproduction, claims.md. Raises PictureError."""
    folder = Path(folder)
    try:
        if (folder / "reproduce.json").exists():
            document = read_json(folder / "reproduce.json")
            content = claims.report(document, folder)
            write(folder / "claims.md", claims.markdown(document))
        elif (folder / "validate.json").exists():
            content = validation.report(read_json(folder / "validate.json"), folder)
        elif (rows := study.rows_of(folder)) is not None:
            content = study.report(folder, rows)
        elif (folder / "manifest.json").exists():
            content = run.report(folder)
        else:
            raise PictureError(f"'{folder}' holds no results (neither manifest.json nor reproduce.json); give a folder that "
                               "apsis run --out, apsis converge --out, apsis sweep --out, apsis reproduce or apsis validate wrote")
    except (KeyError, TypeError, ValueError, IndexError, AttributeError) as problem:
        raise PictureError(f"results in '{folder}' are damaged or of another version ({type(problem).__name__}: {problem}); "
                           "make them anew") from problem
    write(folder / "report.html", content)
    return folder / "report.html"
