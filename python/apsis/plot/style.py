"""Sets the style of all pictures (colours, markers, fonts), and writes picture files."""
from __future__ import annotations

import os
import sys
import unicodedata
import zlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, BinaryIO

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402  (the backend comes first)
import numpy as np  # noqa: E402
from matplotlib.axis import Axis  # noqa: E402
from matplotlib.text import Text  # noqa: E402

__all__ = ["BLACK", "BLUE", "COLOURS", "FORMATS", "GREEN", "GREY", "LINES", "MARKERS", "ORANGE", "PURPLE", "PictureError", "SKY",
           "UNDATED", "VERMILLION", "earlier_times", "exit_code_of", "palette", "panels",
           "picture_path", "pictures_in", "plt", "printable", "save", "save_beside_results", "show_literally",
           "whole_file"]

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


def printable(text: str) -> str:
    """Returns a text that a terminal shows and does not obey: controls and marks of the direction of writing become "\\u001b"."""
    return "".join(f"\\u{ord(c):04x}" if c not in "\n\t" and unicodedata.category(c) in ("Cc", "Cf", "Cs", "Zl", "Zp") else c for c in text)


class PictureError(Exception):
    """A picture that cannot be drawn. exit_code is the exit code of the program."""

    def __init__(self, message: str, exit_code: int = 4) -> None:
        super().__init__(printable(message))
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
    """Returns the snapshots of `count` to draw below the last one: at most five, equally far apart."""
    return [int(k) for k in np.unique(np.linspace(0, count - 1, 5).astype(int))] if count > 0 else []


def picture_path(folder: Path, name: str, kind: str) -> Path:
    """Returns the path of a picture in a folder, whose name may come from a file that apsis did not write. Raises PictureError."""
    if Path(name).name != name or name.startswith(".") or "\0" in name:
        raise PictureError(f"'{folder.parent}' names a picture '{name}' (it must be a file name without folder); correct the name")
    return folder / f"{name}.{kind}"


def pictures_in(folder: Path) -> Path:
    """Returns the folder of the pictures of a result. Raises PictureError if it is a link: nothing is written through one."""
    pictures = folder / "pictures"
    if pictures.is_symlink():
        raise PictureError(f"'{pictures}' is a symbolic link (pictures would be written to another place); remove it")
    return pictures


@contextmanager
def whole_file(path: Path) -> Iterator[BinaryIO]:
    """Yields a file of a temporary name, and renames it when it is complete. The file is new, because a link of the temporary name may
    lead to any file of the user. Raises PictureError."""
    partial = path.with_name(f".{path.name}.partial")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        with suppress(FileNotFoundError):
            partial.unlink()
        with os.fdopen(os.open(partial, os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_NOFOLLOW", 0), 0o666), "wb") as file:
            yield file
        partial.replace(path)
    except OSError as problem:
        with suppress(OSError):
            partial.unlink()
        raise PictureError(f"cannot write '{path}' ({problem.strerror}); choose another folder or free some space") from problem


def show_literally(figure: Any) -> Any:
    """Makes titles and labels of a figure plain text, because they may come from a file. Matplotlib takes "$…$" as a formula, and fails if
    it cannot read the formula. Numbers at ticks and texts with the gid "formula" do not change."""
    numbers = {label for axis in figure.findobj(Axis) for label in (*axis.get_ticklabels(which="both"), axis.get_offset_text())}
    for one in figure.findobj(Text):
        if one not in numbers and one.get_gid() != "formula":
            one.set_parse_math(False)
    return figure


def save(figure: Any, path: Path) -> Path:
    """Writes the figure in the format of the extension, without a date, so that equal data give equal files."""
    with whole_file(path) as file:
        show_literally(figure).savefig(file, format=path.suffix[1:], metadata=UNDATED.get(path.suffix))
    plt.close(figure)
    return path


def save_beside_results(figure: Any, path: Path) -> Path:
    """Writes a figure into the folder of pictures of a result, and adds it to the list `.written` of this folder. The next run into the
    folder of the result removes the pictures of the list that nobody changed (src/apsis/output/drawn_pictures.hpp). A line of the list has
    the CRC-32, the size and the name."""
    save(figure, path)
    content = path.read_bytes()
    record = path.with_name(".written")
    known = record.read_text(encoding="utf-8", errors="replace").splitlines() if record.is_file() and not record.is_symlink() else []
    lines = [line for line in known if line.split(" ", 2)[2:] != [path.name]]
    lines.append(f"{zlib.crc32(content):08x} {len(content)} {path.name}")
    with whole_file(record) as file:
        file.write("".join(f"{line}\n" for line in lines).encode("utf-8"))
    return path
