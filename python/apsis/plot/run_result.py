"""Reads result folders for pictures and reports. Quantities are dimensionless unless the manifest has units."""
from __future__ import annotations

import csv
import json
import re
import textwrap
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from .style import PictureError

Array = NDArray[np.float64]
ARRAYS = ("f", "x", "y", "z", "v", "v_weights", "v_x", "v_y", "v_z", "epsilon")


@dataclass(frozen=True)
class RunResult:
    """The content of a result folder. In several space dimensions [cell] stands for [x, y(, z)].

    fields[name][cell]            macroscopic fields at the end
    snapshots[name][k, cell]      macroscopic fields at the times t[k]
    arrays                        those of f[cell, component], x, v, epsilon that the model has; with several velocity dimensions
                                  also v_weights and the nodes v_x, v_y, v_z
    history[column][step]         checks of every step
    labels, case                  axis labels, and the case file
    marginals[axis][cell, node]   f integrated over the other velocity components
    probes[name][column]          fields along lines
    surfaces[name][column]        fluxes from the gas to faces, solid boxes and bodies
    walls[name][piece, corner]    ends (x, y) of the pieces of a body in the plane, or corners (x, y, z) of its polygons in space"""

    folder: Path
    manifest: dict[str, Any]
    fields: dict[str, Array]
    snapshots: dict[str, Array]
    arrays: dict[str, Array]
    history: dict[str, Array]
    labels: dict[str, str]
    case: str
    marginals: dict[str, Array] = field(default_factory=dict)
    probes: dict[str, dict[str, Array]] = field(default_factory=dict)
    surfaces: dict[str, dict[str, NDArray[Any]]] = field(default_factory=dict)
    walls: dict[str, Array] = field(default_factory=dict)

    @property
    def t(self) -> Array:
        return self.snapshots.get("t", np.zeros(0))

    def moment(self, t: float) -> str:
        """Returns "t = 0.25", or "iteration 25" of a run that finds a steady state."""
        return f"iteration {t:.0f}" if "residual_relative" in self.history else f"t = {t:.4g}"

    @property
    def has_space(self) -> bool:
        return len(self.arrays.get("x", ())) > 1

    @property
    def velocity_dimensions(self) -> int:
        """0 without velocities."""
        v = self.arrays.get("v")
        return 0 if v is None else v.shape[1] if v.ndim == 2 else 1

    def label(self, name: str, width: int = 36) -> str:
        """Returns words and unit of a field; lines break outside of parentheses."""
        words = self.labels.get(name, f"{name} (dimensionless)")
        return textwrap.fill(re.sub(r"\([^()]*\)", lambda part: part[0].replace(" ", "\N{NO-BREAK SPACE}"), words), width)

    def unit(self, name: str) -> str:
        """Returns the unit of a field, of x, or of a column of the history."""
        return str(self.manifest.get("units", {}).get(name, "dimensionless"))


def read_history(path: Path) -> dict[str, Array]:
    """Returns the columns of a table with a header; empty cells become NaN. Raises PictureError."""
    try:
        with open(path, newline="", encoding="utf-8") as file:
            header, *rows = csv.reader(file)
        table = np.array([[float(cell) if cell else np.nan for cell in row] for row in rows], dtype=float)
        return {name: table[:, k] for k, name in enumerate(header)}
    except OSError as problem:
        raise PictureError(f"cannot read '{path}' ({problem.strerror}); run the case with --out first") from problem
    except (IndexError, ValueError) as problem:
        raise PictureError(f"'{path}' is not a table of numbers ({problem}); run the case again") from problem


def read_surface(path: Path) -> dict[str, NDArray[Any]]:
    """Returns the columns of a table whose first one is text, the face. Raises PictureError."""
    try:
        with open(path, newline="", encoding="utf-8") as file:
            header, *rows = csv.reader(file)
        numbers = np.array([row[1:] for row in rows], dtype=float).reshape(len(rows), len(header) - 1)
        return {header[0]: np.array([row[0] for row in rows], dtype=str),
                **{name: numbers[:, k] for k, name in enumerate(header[1:])}}
    except OSError as problem:
        raise PictureError(f"cannot read '{path}' ({problem.strerror}); run the case with --out first") from problem
    except (IndexError, ValueError) as problem:
        raise PictureError(f"'{path}' is not the table of a surface ({problem}); run the case again") from problem


def read_any_json(path: Path) -> Any:
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except OSError as problem:
        raise PictureError(f"cannot read '{path}' ({problem.strerror}); give what apsis wrote") from problem
    except ValueError as problem:
        raise PictureError(f"'{path}' is not JSON ({problem}); give what apsis wrote") from problem


_JSON_KINDS: dict[type, str] = {list: "a list", str: "text", int: "a number", float: "a number", bool: "a truth value", type(None): "null"}


def read_json(path: Path) -> dict[str, Any]:
    """Reads a JSON object. Raises PictureError."""
    document = read_any_json(path)
    if not isinstance(document, dict):
        raise PictureError(f"'{path}' is not a JSON object (it is {_JSON_KINDS[type(document)]}); give what apsis wrote")
    return document


def read_json_list(path: Path) -> list[dict[str, Any]]:
    """Reads a JSON list of objects. Raises PictureError."""
    document = read_any_json(path)
    if not isinstance(document, list) or not all(isinstance(one, dict) for one in document):
        raise PictureError(f"'{path}' is not a list of JSON objects (it is damaged); run the case again")
    return document


def read_result(folder: str | Path) -> RunResult:
    """Reads a result folder. Raises PictureError."""
    folder = Path(folder)
    manifest = read_json(folder / "manifest.json")
    history = read_history(folder / "history.csv")
    path = folder / "solution.h5"
    arrays: dict[str, Array] = {}
    groups: dict[str, dict[str, Array]] = {"fields": {}, "snapshots": {}, "marginals": {}}
    labels: dict[str, str] = {}
    try:
        with h5py.File(path) as file:
            arrays = {name: np.asarray(item, dtype=float) for name, item in number_sets(file) if name in ARRAYS}
            for group, found in groups.items():
                for name, item in number_sets(file.get(group)):
                    found[name] = np.asarray(item, dtype=float)
                    labels[name] = words(item.attrs.get("long_name", f"{name} (dimensionless)"))
            walls = {name: np.asarray(item, dtype=float) for name, item in number_sets(file.get("walls")) if len(item.shape) == 3}
            case = words(file.attrs.get("case", ""))
    except (OSError, MemoryError) as problem:
        raise PictureError(f"cannot read '{path}' ({problem}); run the case again with --out") from problem
    fields = groups["fields"]
    in_order = {name: fields[name] for name in (*columns_of(folder / "fields.csv"), *fields) if name in fields}
    return RunResult(folder, manifest, in_order, groups["snapshots"], arrays, history, labels, case, groups["marginals"],
                     {table.stem: read_history(table) for table in sorted((folder / "probes").glob("*.csv"))},
                     {table.stem: read_surface(table) for table in sorted((folder / "surfaces").glob("*.csv"))}, walls)


def number_sets(group: Any) -> Iterator[tuple[str, Any]]:
    """Yields names and datasets of real numbers of a group. Omits texts, other objects and dangling links, which others may add."""
    for name in group if isinstance(group, h5py.Group) else ():
        item = group.get(name)
        if isinstance(item, h5py.Dataset) and item.dtype.kind in "iuf" and item.shape is not None:
            yield name, item


def columns_of(path: Path) -> list[str]:
    """Returns names in the order of the model, which HDF5 does not preserve."""
    try:
        with open(path, encoding="utf-8") as file:
            return file.readline().strip().split(",")
    except OSError:
        return []


def words(attribute: Any) -> str:
    return attribute.decode("utf-8") if isinstance(attribute, bytes) else str(attribute)
