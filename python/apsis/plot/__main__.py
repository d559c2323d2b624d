"""python -m apsis.plot: pictures of results and methods. `apsis plot` is the same command."""
from __future__ import annotations

import argparse
import sys
from collections.abc import Iterable
from itertools import chain
from pathlib import Path
from typing import Any

from . import comparison, methods, pictures, results, run_result
from .style import FORMATS, PictureError, exit_code_of, picture_path, pictures_in, printable, save, save_beside_results

DESCRIPTION = """Draws what apsis computed, as WHAT/pictures/*.png:

  folder of a run              fields, f(x, v), history
  folder of a study            convergence with slope triangles, every picture of a reproduction
  picture.json                 the pictures in it
  method, FILE.toml            NAME-tableau and NAME-stability, in the present folder

  --compare draws runs of one model into one picture, and one of every probe that they share, and prints how far they are from the
  one with most cells, the last of several."""


def parse(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="apsis plot", description=DESCRIPTION, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", nargs="+", metavar="WHAT", help="a folder of results, a picture.json, a method; "
                        "with --compare also LABEL=FOLDER")
    parser.add_argument("--out", type=Path, help="folder for the pictures")
    parser.add_argument("--format", choices=FORMATS, default="png")
    parser.add_argument("--slice", metavar="AXIS=PLACE", help="of a result in space: this plane in place of those in the middle or of symmetry")
    parser.add_argument("--frames", action="store_true", help="also every snapshot as frame-NUMBER, with one range of colours")
    parser.add_argument("--compare", metavar="NAME", help="one picture NAME of all these runs")
    return parser.parse_args(arguments)


def method_description(name: str) -> dict[str, Any]:
    """Returns name and Butcher form of a method of the catalogue or a file. Raises PictureError."""
    try:
        import apsis  # imported here: all other pictures need no compiled module
        method = apsis.read_method(name) if Path(name).is_file() else apsis.method(name)
    except ImportError as problem:
        raise PictureError(f"'{name}' is neither a folder nor a file of results ({problem}); give one of these") from problem
    except apsis.Error as problem:
        raise PictureError(str(problem), problem.exit_code) from problem
    return {"name": method.name, "A_hat": method.A_hat, "A": method.A, "A_dot": method.A_dot}


def of_method(description: dict[str, Any]) -> Iterable[tuple[str, Any]]:
    """Returns the pictures of a Butcher form. Raises PictureError for methods without one."""
    if any(description.get(part) is None for part in ("A_hat", "A", "A_dot")):
        raise PictureError(f"'{description['name']}' cannot be drawn (an exponential method has no Butcher form); give a Runge-Kutta method, "
                           f"or see 'apsis check {description['name']}'")
    yield f"{description['name']}-tableau", methods.tableau_figure(description)
    yield f"{description['name']}-stability", methods.stability_figure(description)


def of_document(document: dict[str, Any], path: Path) -> Iterable[tuple[str, Any]]:
    if "A_hat" in document:
        yield from of_method(document)
        return
    found = pictures.pictures_of(document)
    if not found:
        raise PictureError(f"'{path}' holds no picture (no \"panels\"); give a file that apsis wrote")
    for picture in found:
        try:
            yield picture["name"], pictures.draw(picture)
        except (KeyError, TypeError, ValueError) as problem:
            raise PictureError(f"'{path}' holds a damaged picture ({type(problem).__name__}: {problem}); make it anew") from problem


def drawn(what: str, options: argparse.Namespace) -> tuple[Path, Iterable[tuple[str, Any]]]:
    """Returns the folder for the pictures of a result, and the pictures."""
    path = Path(what)
    folder = path if path.is_dir() else path.parent
    pictures_here = options.out or pictures_in(folder)
    if path.is_dir():
        for name in ("picture.json", "reproduce.json", "validate.json"):
            if (path / name).exists():
                return pictures_here, of_document(run_result.read_json(path / name), path / name)
        result = run_result.read_result(path)
        made = results.figures(result, options.slice).items()
        return pictures_here, chain(made, results.frames(result, options.slice)) if options.frames else made
    if path.suffix == ".json":
        document = run_result.read_json(path)
        return Path() if "A_hat" in document else pictures_here, of_document(document, path)
    return Path(), of_method(method_description(what))


def compare(what: list[str], slice_at: str | None) -> Iterable[tuple[str, Any]]:
    """Prints the differences of runs, and returns suffixes and pictures of them. Raises PictureError."""
    runs = []
    for word in what:
        label, separator, folder = word.rpartition("=")
        if not Path(folder).is_dir():
            raise PictureError(f"cannot compare '{folder}' (no folder of this name); give the folders of apsis run --out", 2)
        runs.append((label if separator else Path(folder).resolve().name, run_result.read_result(folder)))
    for line in comparison.differences(runs):
        print(printable(line))
    return comparison.comparisons(runs, slice_at)


def draw_all(options: argparse.Namespace) -> None:
    if options.compare:
        for suffix, figure in compare(options.what, options.slice):
            print(printable(str(save(figure, (options.out or Path()) / f"{options.compare}{suffix}.{options.format}"))))
        return
    for what in options.what:
        folder, figures = drawn(what, options)
        for name, figure in figures:
            beside = options.out is None and folder != Path()
            write = save_beside_results if beside else save
            print(printable(str(write(figure, picture_path(options.out or folder, str(name), options.format)))))


def main(arguments: list[str] | None = None) -> int:
    options = parse(arguments)
    return exit_code_of(lambda: draw_all(options))


if __name__ == "__main__":
    sys.exit(main())
