"""Pictures of several runs of one model, and the differences of their fields."""
from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import product
from typing import Any

import numpy as np

from . import maps
from .probes import probe_comparisons
from .run_result import Array, RunResult
from .style import BLACK, COLOURS, LINES, MARKERS, PictureError, panels

Runs = Sequence[tuple[str, RunResult]]  # labels and results


def comparisons(runs: Runs, slice_at: str | None = None) -> Iterator[tuple[str, Any]]:
    """Returns suffixes and figures: "" for the fields, and "-probe-NAME" for profiles along every common probe. Raises PictureError."""
    yield "", comparison_figure(runs, slice_at)
    for name, figure in probe_comparisons(runs):
        yield f"-{name}", figure


def comparison_figure(runs: Runs, slice_at: str | None = None) -> Any:
    """Draws the fields that all runs have: on a line a panel of each, in several dimensions a row of maps of each. Raises PictureError."""
    check_units(runs)
    names = shared_fields(runs)
    return lines(runs, names) if maps.dimensions(runs[0][1]) == 1 else rows_of_maps(runs, names, slice_at)


def shared_fields(runs: Runs) -> list[str]:
    """Returns the names of the fields over space that all runs have. Raises PictureError if there is no common field, or dimensions differ."""
    dimensions = {maps.dimensions(run) for _, run in runs}
    if len(dimensions) > 1:
        raise PictureError("nothing to compare (the runs have different space dimensions); give runs of one model")
    names = [name for name, values in runs[0][1].fields.items() if values.ndim == max(dimensions)
             and all(name in run.fields and run.has_space for _, run in runs)]
    if not names:
        raise PictureError("nothing to compare (the runs share no field over x); give runs of one model")
    return names


def check_units(runs: Runs) -> None:
    """Raises PictureError if a field, x or t has different units in two runs."""
    first_label, first = runs[0]
    for label, run in runs[1:]:
        for name in ("x", "t", *first.fields):
            if (name in ("x", "t") or name in run.fields) and run.unit(name) != first.unit(name):
                raise PictureError(f"'{first_label}' and '{label}' cannot be compared (the unit of {name} is {first.unit(name)} in one, "
                                   f"{run.unit(name)} in the other); run both with the same output.units", 2)


def lines(runs: Runs, names: list[str]) -> Any:
    """Draws a panel for each field: the run with most cells as a line, the others with markers; runs with equally many cells as lines."""
    finest = finest_of(runs)
    equal = len({len(run.arrays["x"]) for _, run in runs}) == 1
    figure, axes = panels(len(names))
    for panel, name in zip(axes, names):
        others = 0
        style: dict[str, Any]
        for k, (label, run) in enumerate(runs):
            if equal:
                style = {"color": COLOURS[k % len(COLOURS)], "linestyle": LINES[k % len(LINES)], "linewidth": 1.3}
            elif k == finest:
                style = {"color": BLACK, "linewidth": 1.2, "zorder": 1}
            else:
                style = {"color": COLOURS[others % len(COLOURS)], "marker": ((6, 2, 0), *MARKERS)[others % len(MARKERS)],
                         "linestyle": "none", "fillstyle": "none", "markersize": 6}
                others += 1
            panel.plot(run.arrays["x"], run.fields[name], label=label, **style)
        panel.set_xlabel(f"x ({runs[0][1].unit('x')})")
        panel.set_ylabel(runs[0][1].label(name))
    axes[0].legend(fontsize=8)
    return figure


def rows_of_maps(runs: Runs, names: list[str], slice_at: str | None) -> Any:
    """Draws a row of maps for each field and the speed, a column for each run, with one range of colours in a row; in space on one plane."""
    planes = [maps.planes_of(run, slice_at)[0] for _, run in runs]
    fields = [{name: run.fields[name] for name in names} for _, run in runs]
    shown = [maps.with_length(each, plane) for each, plane in zip(fields, planes)]
    colours = maps.colours_of({name: np.concatenate([each[name].ravel() for each in shown]) for name in shown[0]})
    sizes = [maps.sizes_of(run, [plane])[0] for (_, run), plane in zip(runs, planes)]
    figure, panels = maps.sheet(sizes, len(shown[0]) * len(runs))
    for panel, (name, (k, (label, run))) in zip(panels, product(shown[0], enumerate(runs))):
        maps.draw_map(panel, run, name, shown[k][name], planes[k], colours[name], sizes[k], label)
        if name in maps.VECTORS.values():
            maps.draw_streamlines(panel, run, fields[k], planes[k], sizes[k])
    return figure


def cells_of(run: RunResult) -> int:
    return max(values.size for values in run.fields.values())


def finest_of(runs: Runs) -> int:
    """Returns the index of the run with most cells, the last one of several."""
    return max(range(len(runs)), key=lambda k: (cells_of(runs[k][1]), k))


def averaged(values: Array, shape: tuple[int, ...]) -> Array | None:
    """Returns means over blocks of cells, one for each cell of a coarser mesh with this shape; None if the shapes do not match."""
    if values.ndim != len(shape) or any(fine % coarse != 0 for fine, coarse in zip(values.shape, shape)):
        return None
    blocks = [number for fine, coarse in zip(values.shape, shape) for number in (coarse, fine // coarse)]
    return np.asarray(values.reshape(blocks).mean(axis=tuple(range(1, 2 * len(shape), 2))))


def differences(runs: Runs) -> list[str]:
    """Returns the largest differences between every run and the finest one, whose values are averaged over the coarser cells. Cells
    in a solid box of either run are omitted. Raises PictureError if units differ."""
    check_units(runs)
    finest = finest_of(runs)
    label_of_finest, fine = runs[finest]
    found = []
    for k, (label, run) in enumerate(runs):
        largest = {}
        for name, values in run.fields.items():
            reference = averaged(fine.fields[name], values.shape) if name in fine.fields else None
            if reference is not None:
                largest[name] = float(np.nanmax(np.abs(values - reference), initial=0.0))
        if k != finest and largest:
            found.append(f"{label} against {label_of_finest}: " + ", ".join(f"{name} {d:.2e}" for name, d in largest.items()))
    return found
