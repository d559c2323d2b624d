#!/usr/bin/env python3
"""Reads result folders of the program apsis and draws them.

    apsis_plot.py case DIR [--out DIR]                fields, f(x, v) and history of one run
    apsis_plot.py mixed --second DIR --third DIR --reference DIR [--out DIR]
                                                      the mixed-regime figure: both orders on the reference

All quantities are dimensionless. Every picture is written as PNG and its axis ranges are printed.
"""
import argparse
import csv
import json
import sys
from dataclasses import dataclass, field
from pathlib import Path

import h5py
import numpy as np

from apsis_picture import BLACK, BLUE, GREEN, ORANGE, PURPLE, VERMILLION, plt

LABELS = {"rho": "density ρ", "u": "bulk velocity u", "T": "temperature T",
          "m": "momentum m", "z": "momentum flux z", "f_plus": "particles of speed 1, f₊", "f_0": "particles at rest, f₀",
          "f_minus": "particles of speed −1, f₋", "u1": "u₁", "u2": "u₂"}


class ResultError(Exception):
    """A result folder that cannot be read; the message names the file."""


@dataclass
class Result:
    """One result folder. `columns` holds fields.csv (all snapshots, one array per column), `history` the
    columns of history.csv; `arrays` f [cells][components], v, x, epsilon of solution.h5, where there is one."""

    folder: Path
    manifest: dict = field(default_factory=dict)
    columns: dict = field(default_factory=dict)
    history: dict = field(default_factory=dict)
    arrays: dict = field(default_factory=dict)

    def fields(self):
        """The last snapshot: {column: array}, without the time."""
        if "t" not in self.columns:
            return self.columns
        last = self.columns["t"] == self.columns["t"].max()
        return {name: values[last] for name, values in self.columns.items() if name != "t"}


def read_table(path):
    """Columns of a CSV file with a header row, as arrays of double (an empty cell is NaN)."""
    try:
        with open(path, newline="", encoding="utf-8") as file:
            rows = list(csv.reader(line for line in file if not line.startswith("#")))
        header, body = rows[0], rows[1:]
        table = np.array([[float(cell) if cell else np.nan for cell in row] for row in body], dtype=float)
        return {name: table[:, k] for k, name in enumerate(header)}
    except OSError as problem:
        raise ResultError(f"cannot read {path} ({problem.strerror}) run the case with --out first") from problem
    except (IndexError, ValueError) as problem:
        raise ResultError(f"{path} is no table of numbers ({problem}) run the case again") from problem


def read_result(folder):
    """Reads what is there of a result folder; fields.csv must be. Raises ResultError."""
    folder = Path(folder)
    result = Result(folder, columns=read_table(folder / "fields.csv"))
    if (folder / "history.csv").exists():
        result.history = read_table(folder / "history.csv")
    if (folder / "manifest.json").exists():
        result.manifest = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))
    if (folder / "solution.h5").exists():
        with h5py.File(folder / "solution.h5") as file:
            result.arrays = {name: item[()] for name, item in file.items() if isinstance(item, h5py.Dataset)}
    return result


def save(figure, path, axes=()):
    """Writes the figure and prints the ranges of the axes that carry results."""
    path = Path(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path)
    plt.close(figure)
    ranges = "; ".join(f"{a.get_ylabel()} {a.get_ylim()[0]:.4g} to {a.get_ylim()[1]:.4g}" for a in axes)
    print(f"{path}" + (f"  ({ranges})" if ranges else ""))
    return path


def label_of(name):
    return f"{LABELS.get(name, name)} (dimensionless)"


def plot_fields(results, path, title=""):
    """One panel per macroscopic field. `results` is a list of (label, Result, style); x is dimensionless."""
    names = [name for name in results[0][1].fields() if name != "x"]
    columns = min(len(names), 3)
    rows = -(-len(names) // columns)
    figure, axes = plt.subplots(rows, columns, figsize=(4.2 * columns, 3.6 * rows), squeeze=False)
    panels = axes.ravel()
    for unused in panels[len(names):]:
        unused.set_visible(False)
    for panel, name in zip(panels, names):
        for label, result, style in results:
            fields = result.fields()
            panel.plot(fields["x"], fields[name], label=label, **style)
        panel.set_xlabel("x (dimensionless)")
        panel.set_ylabel(label_of(name))
    panels[0].legend(fontsize=8)
    figure.suptitle(title)
    return save(figure, path, panels[:len(names)])


def plot_mixed(second, third, reference, path):
    """ρ, u, T: asterisks for second order, circles for third order, a line for the reference; prints the largest
    differences. The reference has an integer multiple of the cells and is averaged onto them."""
    runs = [read_result(folder) for folder in (second, third, reference)]
    styles = [{"linestyle": "none", "marker": (6, 2, 0), "color": VERMILLION, "markersize": 6},
              {"linestyle": "none", "marker": "o", "color": BLUE, "markersize": 7, "fillstyle": "none"},
              {"color": BLACK, "linewidth": 1.2}]
    labels = ["second order", "third order", "explicit reference"]
    for name, values in runs[2].fields().items():
        if name == "x":
            continue
        a, b = (run.fields()[name] for run in runs[:2])
        coarse = values.reshape(len(a), -1).mean(axis=1) if len(values) % len(a) == 0 else None
        text = f"{name}: second against third order {np.abs(a - b).max():.2e}"
        if coarse is not None:
            text += f", to the reference {np.abs(a - coarse).max():.2e} and {np.abs(b - coarse).max():.2e}"
        print(text)
    return plot_fields(list(zip(labels, runs, styles)), path, "BGK in mixed regime")


def plot_phase_space(result, path):
    """f(x, v) as an image over the ε(x) profile; None where the run has no velocity grid (a few speeds are none)."""
    if not {"f", "v", "x"} <= result.arrays.keys() or len(result.arrays["v"]) < 8:
        return None
    x, v, f = (np.asarray(result.arrays[name], dtype=float) for name in ("x", "v", "f"))
    with_epsilon = "epsilon" in result.arrays
    figure, axes = plt.subplots(1 + with_epsilon, 1, figsize=(6, 5.4 if with_epsilon else 4), sharex=True,
                                squeeze=False, height_ratios=[3, 1][:1 + with_epsilon])
    panel = axes[0][0]
    panel.grid(False)
    image = panel.pcolormesh(x, v, f.reshape(len(x), len(v)).T, shading="nearest", cmap="viridis", rasterized=True)
    figure.colorbar(image, ax=panel, label="f (dimensionless)")
    # The tails beyond are below a thousandth of the maximum and would only shrink what is to be seen.
    seen = v[(f.reshape(len(x), len(v)) > 1e-3 * f.max()).any(axis=0)]
    panel.set_ylim(seen.min(), seen.max())
    panel.set_ylabel("v (dimensionless)")
    if with_epsilon:
        axes[1][0].semilogy(x, result.arrays["epsilon"], color=BLACK)
        axes[1][0].set_ylabel("ε (dimensionless)")
    axes[-1][0].set_xlabel("x (dimensionless)")
    figure.suptitle("distribution function")
    return save(figure, path, [panel])


def plot_history(result, path):
    """Smallest value and conservation defects over time; None without history.csv."""
    if not result.history:
        return None
    t = result.history["t"]
    figure, (left, right) = plt.subplots(1, 2, figsize=(8.4, 3.4))
    smallest = result.history["min_value"]
    left.plot(t, smallest, color=BLUE)
    if (smallest > 0).all():
        left.set_yscale("log")
    left.set_ylabel("smallest unknown (dimensionless)")
    defects = [name for name in result.history if name.startswith("conservation")]
    for name, colour in zip(defects, (BLUE, VERMILLION, GREEN, PURPLE, ORANGE)):
        # An exact zero has no logarithm; it is drawn at the bottom instead of being left out.
        right.semilogy(t, np.maximum(result.history[name], 1e-18), color=colour,
                       label=name.removeprefix("conservation").strip("_.") or name)
    right.set_ylabel("relative conservation defect")
    if defects:
        right.legend(fontsize=8)
    for panel in (left, right):
        panel.set_xlabel("t (dimensionless)")
    return save(figure, path, [left, right])


def plot_case(result, out, name):
    """All pictures of one run as <out>/<name>-*.png."""
    style = {"color": BLUE, "marker": ".", "markersize": 4, "linewidth": 1}
    if "x" in result.columns and len(result.fields()["x"]) > 1:
        plot_fields([(name, result, style)], out / f"{name}-fields.png", name)
    plot_phase_space(result, out / f"{name}-f.png")
    plot_history(result, out / f"{name}-history.png")


def parse_arguments(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(dest="command", required=True)
    case = commands.add_parser("case", help="one run")
    case.add_argument("folder", type=Path)
    mixed = commands.add_parser("mixed", help="both orders against the explicit reference")
    for name in ("second", "third", "reference"):
        mixed.add_argument(f"--{name}", type=Path, required=True)
    for command in (case, mixed):
        command.add_argument("--out", type=Path, help="folder of the pictures (default: the result's own, or results)")
    return parser.parse_args(arguments)


def main(arguments=None):
    options = parse_arguments(arguments)
    try:
        if options.command == "case":
            plot_case(read_result(options.folder), options.out or options.folder, options.folder.resolve().name)
        else:
            out = options.out or Path("results")
            plot_mixed(options.second, options.third, options.reference, out / "bgk-mixed.png")
            plot_case(read_result(options.third), out, options.third.resolve().name)
    except ResultError as problem:
        print(f"apsis_plot: {problem}", file=sys.stderr)
        return 4
    return 0


if __name__ == "__main__":
    sys.exit(main())
