"""Draws pictures that the program apsis writes as data.

A picture has name, title, caption and panels; a panel has curves {label, x, y, style, colour} or one map {x, y, value}. null
is NaN. A document may hold one picture, or several in a list "pictures" (also inside "claims" and "quantities").
"""
from __future__ import annotations

import textwrap
from collections.abc import Mapping
from typing import Any

import numpy as np
from matplotlib.ticker import LogFormatterSciNotation, LogLocator, NullFormatter
from numpy.typing import NDArray

from .style import BLACK, MARKERS, palette, plt

STYLES = {"line": ("-", False), "dashed": ("--", False), "dash_dot": ("-.", False), "markers": ("none", True),
          "line_and_markers": ("-", True), "dashed_and_markers": ("--", True)}
Document = Mapping[str, Any]


def numbers(values: list[float | None]) -> NDArray[np.float64]:
    return np.array([np.nan if v is None else v for v in values], dtype=float)


def draw_curves(axes: Any, panel: Document) -> None:
    following = 0
    colours = palette(1 + max((c["colour"] for c in panel["curves"]), default=0)
                      + sum(c["colour"] == -1 for c in panel["curves"]))
    for curve in panel["curves"]:
        x, y = numbers(curve["x"]), numbers(curve["y"])
        shown = np.isfinite(x) & np.isfinite(y)
        if panel["log_x"]:
            shown &= x > 0
        if panel["log_y"]:
            shown &= y > 0
        index = curve["colour"]
        if index == -1:
            index, following = following, following + 1
        colour = BLACK if index < 0 else colours[index % len(colours)]
        line, marked = STYLES[curve["style"]]
        # Dashed curves often coincide with solid ones: larger open markers keep both visible.
        is_open = line in ("none", "--")
        axes.plot(x[shown], y[shown], linestyle=line, color=colour, linewidth=1.3, markersize=7 if line == "--" else 4.5,
                  marker=MARKERS[max(index, 0) % len(MARKERS)] if marked else "none",
                  fillstyle="none" if is_open else "full", label=curve["label"] or None)


def draw_slopes(axes: Any, slopes: list[float]) -> None:
    """Draws slope triangles of the given orders in the corner that such curves leave empty."""
    if not slopes or not axes.lines:
        return
    (left, right), (bottom, top) = np.log10(axes.get_xlim()), np.log10(axes.get_ylim())
    for k, slope in enumerate(slopes):
        width = min(0.16 * (right - left), 0.5 * (top - bottom) / abs(slope))
        y0 = bottom + 0.06 * (top - bottom)
        if slope > 0:
            x0 = right - (0.22 + 0.24 * k) * (right - left)
            upright = x0 + width
        else:
            x0 = left + (0.08 + 0.24 * k) * (right - left)
            upright = x0
        corner = 10 ** np.array([[x0, y0], [x0 + width, y0], [upright, y0 + abs(slope) * width]])
        axes.fill(*corner.T, facecolor="#00000018", edgecolor=BLACK, linewidth=0.8)
        axes.text(*(10 ** np.array([upright + (0.08 if slope > 0 else -0.08) * width, y0 + 0.4 * abs(slope) * width])),
                  f"{slope:g}", fontsize=8, va="center", ha="left" if slope > 0 else "right")
    axes.set_xlim(10**left, 10**right)
    axes.set_ylim(10**bottom, 10**top)


def label_ticks(axis: Any, limits: tuple[float, float]) -> None:
    """Labels 2 and 5 on logarithmic axes shorter than two decades."""
    axis.set_minor_formatter(NullFormatter())
    if np.ptp(np.log10(limits)) < 2:
        axis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.set_major_formatter(LogFormatterSciNotation(minor_thresholds=(np.inf, np.inf)))


def edges(values: list[float], logarithmic: bool) -> NDArray[np.float64]:
    """Returns the cell boundaries of a map from the centres."""
    centres = np.log10(values) if logarithmic else np.asarray(values, dtype=float)
    if len(centres) == 1:
        borders = np.array([centres[0] - 0.5, centres[0] + 0.5])
    else:
        middle = 0.5 * (centres[1:] + centres[:-1])
        borders = np.concatenate([[2 * centres[0] - middle[0]], middle, [2 * centres[-1] - middle[-1]]])
    return 10**borders if logarithmic else borders


def draw_map(figure: Any, axes: Any, panel: Document) -> None:
    image = panel["maps"][0]
    value = np.array([numbers(row) for row in image["value"]])
    axes.grid(False)
    mesh = axes.pcolormesh(edges(image["x"], panel["log_x"]), edges(image["y"], panel["log_y"]),
                           value, cmap="cividis", vmin=image["lowest"], vmax=image["highest"])
    figure.colorbar(mesh, ax=axes, label=image["label"])
    if value.size > 400:
        return
    middle = 0.5 * (image["lowest"] + image["highest"])
    for row, y in zip(value, image["y"]):
        for number, x in zip(row, image["x"]):
            if np.isfinite(number):
                axes.text(x, y, f"{number:.1f}", fontsize=6, ha="center", va="center",
                          color="white" if number < middle else "black")


def share_y_range(panels: list[Any]) -> None:
    """Gives all panels with curves a common range, so that heights can be compared."""
    drawn = [axes for axes in panels if axes.lines and any(len(line.get_xdata()) for line in axes.lines)]
    limits = np.array([axes.get_ylim() for axes in drawn])
    for axes in drawn:
        axes.set_ylim(limits.min(), limits.max())


def measure_of(picture: Document) -> str:
    """Returns the axis label of the quantity that a study measured. It comes from the first sentence of the caption, "The l2 norm of the
    difference to ….", because a difference to the next finer run is not an error."""
    measure = str(picture["caption"]).partition(". ")[0].removeprefix("The ").removesuffix(".")
    return textwrap.fill(f"{measure} (dimensionless)", 44)


def finish(axes: Any, panel: Document, y_label: str) -> None:
    """Adds slope triangles, ticks, labels and legend to a panel with curves."""
    with_slopes = panel["log_x"] and panel["log_y"] and not panel["maps"]
    if with_slopes:
        draw_slopes(axes, panel["slopes"])
    if panel["log_x"]:
        label_ticks(axes.xaxis, axes.get_xlim())
    if panel["log_y"]:
        label_ticks(axes.yaxis, axes.get_ylim())
    axes.set_xlabel(panel["x_label"])
    axes.set_ylabel(y_label)
    axes.set_title(panel["title"], fontsize=10)
    labels = sum(bool(curve["label"]) for curve in panel["curves"])
    if labels:
        # Triangles and curves leave no corner empty in every study, and a long legend none at all: it goes below the panel.
        crowded = (with_slopes and panel["slopes"]) or labels > 6
        below = {"loc": "upper center", "bbox_to_anchor": (0.5, -0.2)} if crowded else {}
        axes.legend(fontsize=7, ncols=2 if labels > 6 else 1, handlelength=3, **below)


def draw(picture: Document) -> Any:
    """Returns the picture as a Matplotlib figure."""
    panels = picture["panels"]
    columns = min(len(panels), 3) if len(panels) != 4 else 2
    rows = -(-len(panels) // columns)
    figure, grid = plt.subplots(rows, columns, figsize=(5.0 * columns if columns > 1 else 6.4, 3.9 * rows), squeeze=False)
    for axes in grid.flat[len(panels):]:
        axes.remove()
    for axes, panel in zip(grid.flat, panels):
        axes.set_xscale("log" if panel["log_x"] else "linear")
        axes.set_yscale("log" if panel["log_y"] else "linear")
        if panel["maps"]:
            draw_map(figure, axes, panel)
        draw_curves(axes, panel)
    study = picture["name"] == "converge"
    if study:
        share_y_range(list(grid.flat[:len(panels)]))
    for axes, panel in zip(grid.flat, panels):
        finish(axes, panel, measure_of(picture) if study else panel["y_label"])
    figure.suptitle(picture["title"], fontsize=11)
    return figure


def pictures_of(document: Document) -> list[Document]:
    """Returns all pictures of a parsed JSON document."""
    if "panels" in document:
        return [document]
    found = list(document.get("pictures", []))
    for part in [*document.get("claims", []), *document.get("quantities", [])]:
        found += pictures_of(part)
    return found
