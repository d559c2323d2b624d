"""The style of all pictures (colours, markers, fonts), and writing of picture files."""
from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend comes first)
import numpy as np  # noqa: E402

__all__ = ["BLACK", "BLUE", "COLOURS", "FORMATS", "GREEN", "GREY", "LINES", "MARKERS", "ORANGE", "PURPLE", "PictureError", "SKY",
           "UNDATED", "VERMILLION", "earlier_times", "exit_code_of", "palette", "panels", "plt", "save", "whole_file"]

# Okabe and Ito: distinct for colour-blind readers, and in lightness for print.
BLACK, BLUE, VERMILLION, GREEN, PURPLE, ORANGE = "#000000", "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00"
SKY, GREY = "#56B4E9", "#7F7F7F"
COLOURS = (BLUE, VERMILLION, GREEN, PURPLE, ORANGE, SKY, GREY)
# Markers differ as well, so that curves are distinguishable without colour.
LINES = ("-", "--", "-.", ":")
MARKERS = ("o", "s", "^", "D", "v", "P", "X", "<", ">", "*", "h")
FORMATS = ("png", "svg", "pdf")
UNDATED = {".pdf": {"CreationDate": None}, ".svg": {"Date": None}}

plt.rcParams.update({"font.size": 10, "axes.grid": True, "grid.alpha": 0.3, "savefig.dpi": 150,
                     "figure.constrained_layout.use": True, "svg.fonttype": "path", "svg.hashsalt": "apsis"})


class PictureError(Exception):
    """A picture that cannot be drawn. exit_code is the exit code of the program."""

    def __init__(self, message: str, exit_code: int = 4) -> None:
        super().__init__(message)
        self.exit_code = exit_code


def exit_code_of(command: Callable[[], None]) -> int:
    """Runs a command and returns its exit code; the message of a PictureError goes to standard error."""
    try:
        command()
    except PictureError as problem:
        print(f"error: {problem}", file=sys.stderr)
        return problem.exit_code
    return 0


def palette(count: int) -> list[Any]:
    """Returns `count` colours: named ones if there are enough, else samples of a colour map that prints in grey."""
    return list(COLOURS) if count <= len(COLOURS) else [plt.cm.viridis(t) for t in np.linspace(0.0, 0.9, count)]


def panels(count: int, width: float = 4.2, height: float = 3.6) -> tuple[Any, list[Any]]:
    """Returns a figure with `count` panels, at most three in a row."""
    columns = min(count, 3)
    rows = -(-count // columns)
    figure, grid = plt.subplots(rows, columns, figsize=(width * columns if columns > 1 else 6.0, height * rows), squeeze=False)
    for unused in grid.flat[count:]:
        unused.remove()
    return figure, list(grid.flat[:count])


def earlier_times(count: int) -> list[int]:
    """Which of `count` snapshots to draw below the last one: at most five, equally far apart."""
    return [int(k) for k in np.unique(np.linspace(0, count - 1, 5).astype(int))] if count > 0 else []


@contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """Yields a temporary path that is renamed when complete. Raises PictureError."""
    partial = path.with_name(f".{path.name}.partial")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        yield partial
        partial.replace(path)
    except OSError as problem:
        with suppress(OSError):
            partial.unlink()
        raise PictureError(f"cannot write '{path}' ({problem.strerror}); choose another folder or free some space") from problem


def save(figure: Any, path: Path) -> Path:
    """Writes the figure in the format of the extension, without a date, so that equal data give equal files."""
    with whole_file(path) as partial:
        figure.savefig(partial, format=path.suffix[1:], metadata=UNDATED.get(path.suffix))
    plt.close(figure)
    return path
