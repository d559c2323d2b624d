"""Pictures of runs, from the folders that they leave. All quantities are dimensionless."""
from __future__ import annotations

import csv
import json
import textwrap
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py
import numpy as np
from numpy.typing import NDArray

from .style import BLACK, BLUE, COLOURS, GREY, MARKERS, PictureError, plt

Array = NDArray[np.float64]
SHOWN_TIMES = 5  # so many earlier snapshots, at most, beside the last


@dataclass(frozen=True)
class RunResult:
    """What a run left. fields[name][cell] are the macroscopic fields at the end, snapshots[name][k, cell] at the times t[k];
    arrays has f[cell, component], x, v, epsilon, those that the model has; history[column][step] what was checked; labels the
    words for an axis; case the case file."""

    folder: Path
    manifest: dict[str, Any]
    fields: dict[str, Array]
    snapshots: dict[str, Array]
    arrays: dict[str, Array]
    history: dict[str, Array]
    labels: dict[str, str]
    case: str

    @property
    def t(self) -> Array:
        return self.snapshots.get("t", np.zeros(0))

    @property
    def has_space(self) -> bool:
        return len(self.arrays.get("x", ())) > 1

    def label(self, name: str) -> str:
        return textwrap.fill(self.labels.get(name, f"{name} (dimensionless)"), 36)


def read_history(path: Path) -> dict[str, Array]:
    """Columns of a table with a header, an empty cell as NaN. Raises PictureError."""
    try:
        with open(path, newline="", encoding="utf-8") as file:
            header, *rows = csv.reader(file)
        table = np.array([[float(cell) if cell else np.nan for cell in row] for row in rows], dtype=float)
        return {name: table[:, k] for k, name in enumerate(header)}
    except OSError as problem:
        raise PictureError(f"cannot read '{path}' ({problem.strerror}); run the case with --out first") from problem
    except (IndexError, ValueError) as problem:
        raise PictureError(f"'{path}' is no table of numbers ({problem}); run the case again") from problem


def read_any_json(path: Path) -> Any:
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except OSError as problem:
        raise PictureError(f"cannot read '{path}' ({problem.strerror}); give what apsis wrote") from problem
    except ValueError as problem:
        raise PictureError(f"'{path}' is not JSON ({problem}); give what apsis wrote") from problem


def read_json(path: Path) -> dict[str, Any]:
    """An object of JSON. Raises PictureError."""
    document = read_any_json(path)
    if not isinstance(document, dict):
        raise PictureError(f"'{path}' is no object of JSON (it is a {type(document).__name__}); give what apsis wrote")
    return document


def read_json_list(path: Path) -> list[dict[str, Any]]:
    """A list of objects of JSON. Raises PictureError."""
    document = read_any_json(path)
    if not isinstance(document, list) or not all(isinstance(one, dict) for one in document):
        raise PictureError(f"'{path}' is no list of objects of JSON (it is damaged); make it anew")
    return document


def read_result(folder: str | Path) -> RunResult:
    """Reads the folder of a run. Raises PictureError."""
    folder = Path(folder)
    manifest = read_json(folder / "manifest.json")
    history = read_history(folder / "history.csv")
    path = folder / "solution.h5"
    arrays: dict[str, Array] = {}
    groups: dict[str, dict[str, Array]] = {"fields": {}, "snapshots": {}}
    labels: dict[str, str] = {}
    try:
        with h5py.File(path) as file:
            arrays = {name: np.asarray(item, dtype=float) for name, item in file.items() if isinstance(item, h5py.Dataset)}
            for group, found in groups.items():
                for name, item in file.get(group, {}).items():
                    found[name] = np.asarray(item, dtype=float)
                    labels[name] = words(item.attrs.get("long_name", f"{name} (dimensionless)"))
            case = words(file.attrs.get("case", ""))
    except OSError as problem:
        raise PictureError(f"cannot read '{path}' ({problem}); run the case again with --out") from problem
    fields = groups["fields"]
    in_order = {name: fields[name] for name in (*columns_of(folder / "fields.csv"), *fields) if name in fields}
    return RunResult(folder, manifest, in_order, groups["snapshots"], arrays, history, labels, case)


def columns_of(path: Path) -> list[str]:
    """Names in the order of the model, which HDF5 does not keep."""
    try:
        with open(path, encoding="utf-8") as file:
            return file.readline().strip().split(",")
    except OSError:
        return []


def words(attribute: Any) -> str:
    return attribute.decode("utf-8") if isinstance(attribute, bytes) else str(attribute)


def panels(count: int, width: float = 4.2, height: float = 3.6) -> tuple[Any, list[Any]]:
    """A figure with a panel for each of `count` things, at most three in a row."""
    columns = min(count, 3)
    rows = -(-count // columns)
    figure, grid = plt.subplots(rows, columns, figsize=(width * columns if columns > 1 else 6.0, height * rows), squeeze=False)
    for unused in grid.flat[count:]:
        unused.remove()
    return figure, list(grid.flat[:count])


def fields_figure(result: RunResult) -> Any:
    """A panel for each macroscopic field: over x at the end and, thin, at earlier snapshots; without space over t. None if
    there is nothing to draw."""
    if not result.fields or (not result.has_space and len(result.t) < 2):
        return None
    figure, axes = panels(len(result.fields))
    earlier = [k for k in range(len(result.t)) if k < len(result.t) - 1]
    shown = [earlier[k] for k in np.unique(np.linspace(0, len(earlier) - 1, SHOWN_TIMES).astype(int))] if earlier else []
    for panel, name in zip(axes, result.fields):
        if result.has_space:
            x = result.arrays["x"]
            for k, colour in zip(shown, plt.cm.Greys(np.linspace(0.3, 0.6, len(shown)))):
                panel.plot(x, result.snapshots[name][k], color=colour, linewidth=0.9, label=f"t = {result.t[k]:.4g}")
            panel.plot(x, result.fields[name], color=BLUE, marker=".", markersize=4, linewidth=1, label=f"t = {end_of(result):.4g}")
        else:
            panel.plot(result.t, result.snapshots[name][:, 0], color=BLUE, marker=".", markersize=4, linewidth=1)
        panel.set_xlabel("x (dimensionless)" if result.has_space else "t (dimensionless)")
        panel.set_ylabel(result.label(name))
    if result.has_space:
        axes[0].legend(fontsize=8)
    figure.suptitle(title_of(result))
    return figure


def end_of(result: RunResult) -> float:
    return float(result.history["t"][-1])


def title_of(result: RunResult) -> str:
    return str(result.manifest.get("case", {}).get("title", "")) or result.folder.resolve().name


def comparison_figure(runs: Sequence[tuple[str, RunResult]]) -> Any:
    """A panel for each field that all runs have: the run with most cells as a line, the others with markers; runs with equally many
    as lines."""
    names = [name for name in runs[0][1].fields if all(name in run.fields and run.has_space for _, run in runs)]
    if not names:
        raise PictureError("nothing to compare (the runs share no field over x); give runs of one model")
    finest = finest_of(runs)
    equal = len({len(run.arrays["x"]) for _, run in runs}) == 1
    figure, axes = panels(len(names))
    for panel, name in zip(axes, names):
        others = 0
        style: dict[str, Any]
        for k, (label, run) in enumerate(runs):
            if equal:
                style = {"color": COLOURS[k % len(COLOURS)], "linestyle": ("-", "--", "-.", ":")[k % 4], "linewidth": 1.3}
            elif k == finest:
                style = {"color": BLACK, "linewidth": 1.2, "zorder": 1}
            else:
                style = {"color": COLOURS[others % len(COLOURS)], "marker": ((6, 2, 0), *MARKERS)[others % len(MARKERS)],
                         "linestyle": "none", "fillstyle": "none", "markersize": 6}
                others += 1
            panel.plot(run.arrays["x"], run.fields[name], label=label, **style)
        panel.set_xlabel("x (dimensionless)")
        panel.set_ylabel(runs[0][1].label(name))
    axes[0].legend(fontsize=8)
    return figure


def finest_of(runs: Sequence[tuple[str, RunResult]]) -> int:
    return max(range(len(runs)), key=lambda k: (len(runs[k][1].arrays["x"]), k))


def differences(runs: Sequence[tuple[str, RunResult]]) -> list[str]:
    """Largest differences of every run to the one with most cells, the last of several, whose values are averaged onto the coarser
    cells."""
    finest = finest_of(runs)
    label_of_finest, fine = runs[finest]
    lines = []
    for k, (label, run) in enumerate(runs):
        cells = len(run.arrays["x"])
        if k == finest or len(fine.arrays["x"]) % cells != 0:
            continue
        largest = {name: float(np.abs(values - fine.fields[name].reshape(cells, -1).mean(axis=1)).max())
                   for name, values in run.fields.items() if name in fine.fields}
        lines.append(f"{label} against {label_of_finest}: " + ", ".join(f"{name} {d:.2e}" for name, d in largest.items()))
    return lines


def distribution_figure(result: RunResult) -> Any:
    """f(x, v) at the end as a map over the profile of ε(x); with more velocity dimensions, integrated over the others. None
    for a model without a velocity grid (a few speeds are none)."""
    if not result.has_space or not {"f", "v"} <= result.arrays.keys() or len(np.unique(result.arrays["v"])) < 8:
        return None
    x, f = result.arrays["x"], result.arrays["f"]
    v, place = np.unique(result.arrays["v"], return_inverse=True)
    others = round(np.log(f.shape[1]) / np.log(len(v))) - 1
    marginal = np.zeros((len(v), len(x)))
    np.add.at(marginal, place, f.T * (v[1] - v[0]) ** others)
    with_epsilon = "epsilon" in result.arrays and bool((result.arrays["epsilon"] > 0).all())
    rows = 1 + with_epsilon
    figure, axes = plt.subplots(rows, 1, figsize=(6, 5.4 if with_epsilon else 4), sharex=True, squeeze=False,
                                height_ratios=[3, 1][:rows])
    panel = axes[0][0]
    panel.grid(False)
    label = "f" if others == 0 else "∫ f dv_y" if others == 1 else "∫ f dv_y dv_z"
    image = panel.pcolormesh(x, v, marginal, shading="nearest", cmap="viridis", rasterized=True)
    figure.colorbar(image, ax=panel, label=f"{label} (dimensionless)")
    # The tails beyond are below a thousandth of the maximum and would only shrink what is to be seen.
    seen = v[(marginal > 1e-3 * marginal.max()).any(axis=1)]
    if len(seen) > 1:
        panel.set_ylim(seen.min(), seen.max())
        if len(seen) < len(v):
            panel.set_title(f"v from {seen.min():.4g} to {seen.max():.4g} of a grid from {v.min():.4g} to {v.max():.4g}; "
                            f"{label} is below a thousandth of its maximum beyond", fontsize=7)
    panel.set_ylabel("v (dimensionless)")
    if with_epsilon:
        axes[1][0].semilogy(x, result.arrays["epsilon"], color=BLACK)
        axes[1][0].set_ylabel("ε (dimensionless)")
    axes[-1][0].set_xlabel("x (dimensionless)")
    figure.suptitle(f"distribution function at t = {end_of(result):.4g}")
    return figure


def history_figure(result: RunResult) -> Any:
    """What was checked at every step: smallest value, conservation defects, entropy, and the step where it changes. None after
    no step."""
    history = result.history
    if len(history["t"]) < 2:
        return None
    defects = [name for name in history if name.startswith("conservation")]
    with_entropy = "entropy" in history and bool(np.isfinite(history["entropy"]).any())
    # The last two steps share what is left to the end of the run, which is no change.
    steps = history["dt"][1:-2]
    changing = len(steps) > 1 and float(np.ptp(steps)) > 1e-9 * float(steps.max())
    figure, axes = panels(1 + bool(defects) + with_entropy + changing, height=3.4)
    following = iter(axes)
    draw_smallest(next(following), history)
    if defects:
        draw_defects(next(following), history, defects)
    if with_entropy:
        panel = next(following)
        panel.plot(history["t"], history["entropy"], color=BLUE)
        panel.set_ylabel("entropy (dimensionless)")
    if changing:
        panel = next(following)
        panel.semilogy(history["t"][1:], history["dt"][1:], color=BLUE)
        panel.set_ylabel("Δt (dimensionless)")
    for panel in axes:
        panel.set_xlabel("t (dimensionless)")
    figure.suptitle(title_of(result))
    return figure


def draw_smallest(panel: Any, history: dict[str, Array]) -> None:
    smallest = history["min_value"]
    panel.plot(history["t"], smallest, color=BLUE)
    if (smallest > 0).all():
        panel.set_yscale("log")
    else:
        panel.axhline(0.0, color=GREY, linewidth=0.8)
    panel.set_ylabel("smallest unknown (dimensionless)")


def draw_defects(panel: Any, history: dict[str, Array], defects: list[str]) -> None:
    for name, colour in zip(defects, COLOURS):
        # An exact zero has no logarithm; it is drawn at the bottom instead of being left out.
        panel.semilogy(history["t"], np.maximum(history[name], 1e-18), color=colour,
                       label=name.removeprefix("conservation").strip("_.").replace("_", " ") or name)
    panel.set_ylabel("relative conservation defect")
    panel.legend(fontsize=8)


def figures(result: RunResult) -> dict[str, Any]:
    """All pictures of a run by name: fields, distribution, history."""
    made = {"fields": fields_figure(result), "distribution": distribution_figure(result), "history": history_figure(result)}
    return {name: figure for name, figure in made.items() if figure is not None}
