"""Draws the fluxes from the gas to a wall: profiles along it in the plane, maps of its faces in space."""
from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .maps import AXES, FACES, borders, dimensions, limits_of, without_solids
from .run_result import Array, RunResult
from .style import BLUE, GREY, plt

Columns = dict[str, NDArray[Any]]
DERIVED = ("pressure", "shear_stress", "heat_flux")
COEFFICIENTS = ("C_p", "C_f", "C_h")  # with reference values
NORMALS = {face: axis for axis, faces in FACES.items() for face in faces}


def quantities(columns: Columns) -> list[str]:
    """Returns the columns to draw: pressure, shear stress and heat flux, or their coefficients if there are reference values. For
    a model without these columns, returns all invariants."""
    names = list(columns)
    derived = [name for name in (COEFFICIENTS if "C_p" in columns else DERIVED) if name in columns]
    return derived or names[names.index("area") + 1:]


def label(result: RunResult, name: str) -> str:
    if name in COEFFICIENTS:
        return f"{name} (dimensionless)"
    return f"{name.replace('_', ' ')} ({result.unit(name)})"


def parts(columns: Columns) -> list[NDArray[np.intp]]:
    """Returns the rows of each stretch of a wall in the plane, from one corner or gap to the next."""
    faces, s, length = columns["face"], columns["s"], columns["area"]
    ends = np.flatnonzero((faces[1:] != faces[:-1]) | (np.diff(s) > 0.75 * (length[1:] + length[:-1]))) + 1
    return np.split(np.arange(len(s)), ends)


def profiles(result: RunResult, title: str, columns: Columns) -> Any:
    """Draws a panel for each quantity over the arc length s, with separate curves for the faces of a box."""
    names = quantities(columns)
    count = min(len(names), 3)
    rows = -(-len(names) // count)
    figure, grid = plt.subplots(rows, count, figsize=(4.2 * count if count > 1 else 6.0, 3.6 * rows), squeeze=False)
    stretches = parts(columns)
    s, half, faces = columns["s"], 0.5 * columns["area"], columns["face"]
    for panel, name in zip(grid.flat, names):
        for rows_of in stretches:
            panel.plot(s[rows_of], columns[name][rows_of], color=BLUE, marker=".", markersize=4, linewidth=1.2)
        if len(set(faces)) > 1:
            for face in dict.fromkeys(faces):
                of_face = faces == face
                first, last = (s - half)[of_face].min(), (s + half)[of_face].max()
                panel.axvline(first, color=GREY, linewidth=0.6)
                panel.axvline(last, color=GREY, linewidth=0.6)
                panel.text(0.5 * (first + last), 1.01, face, ha="center", fontsize=8, transform=panel.get_xaxis_transform())
        panel.set_xlabel(f"s ({result.unit('x')})")
        panel.set_ylabel(label(result, name))
    for unused in grid.flat[len(names):]:
        unused.remove()
    figure.suptitle(title)
    return figure


def stream_of(result: RunResult) -> Array:
    """Returns the unit vector along the stream of the reference values, or along x without them."""
    output = result.manifest.get("case", {}).get("output", {})
    stream: Array = np.array(output.get("reference", {}).get("velocity", [1.0, 0.0, 0.0]), dtype=float)
    return stream / float(np.linalg.norm(stream))


def angle_profiles(result: RunResult, title: str, columns: Columns) -> Any:
    """Draws a panel for each quantity of a body in space, over the angle between its normal and the direction against the stream."""
    names = quantities(columns)
    figure, grid = plt.subplots(1, len(names), figsize=(4.2 * len(names) if len(names) > 1 else 6.0, 3.6), squeeze=False)
    normals = np.stack([columns[f"n_{axis}"] for axis in AXES], axis=1)
    angle = np.degrees(np.arccos(np.clip(-normals @ stream_of(result), -1.0, 1.0)))
    for panel, name in zip(grid.flat, names):
        panel.plot(angle, columns[name], color=BLUE, marker=".", markersize=4, linestyle="none")
        panel.set_xlim(0, 180)
        panel.set_xticks(range(0, 181, 45))
        panel.set_xlabel("angle of the normal to the stream (degrees)")
        panel.set_ylabel(label(result, name))
    figure.suptitle(title)
    return figure


def face_map(result: RunResult, columns: Columns, face: str, name: str) -> tuple[str, str, Array, Array, Array]:
    """Returns the axes that span a face, the cell centres along them, and values[across, up], NaN without gas."""
    across, up = (axis for axis in AXES if axis != NORMALS[face])
    rows = columns["face"] == face
    centres, places = {}, {}
    for axis in (across, up):
        at, every = columns[axis][rows], result.arrays[axis]
        reach = 0.25 * float(np.min(np.diff(every))) if len(every) > 1 else 1.0
        centres[axis] = every[(every > at.min() - reach) & (every < at.max() + reach)]
        places[axis] = np.abs(at[:, None] - centres[axis][None, :]).argmin(axis=1)
    values = np.full((len(centres[across]), len(centres[up])), np.nan)
    values[places[across], places[up]] = columns[name][rows]
    return across, up, centres[across], centres[up], values


def face_maps(result: RunResult, title: str, columns: Columns) -> Any:
    """Draws a panel for each quantity and face, with one range of colours for a quantity."""
    names, faces = quantities(columns), list(dict.fromkeys(columns["face"]))
    figure, grid = plt.subplots(len(names), len(faces), figsize=(max(6.0, 4.2 * len(faces)), 3.6 * len(names)), squeeze=False)
    for name, row in zip(names, grid):
        low, high, colours = limits_of(columns[name])
        for face, panel in zip(faces, row):
            across, up, x, y, values = face_map(result, columns, face, name)
            panel.grid(False)
            panel.set_aspect("equal")
            panel.set_facecolor("#D9D9D9")
            image = panel.pcolormesh(borders(x), borders(y), without_solids(values.T), cmap=colours, vmin=low, vmax=high, rasterized=True)
            figure.colorbar(image, ax=panel, label=label(result, name))
            panel.set_xlabel(f"{across} ({result.unit('x')})")
            panel.set_ylabel(f"{up} ({result.unit('x')})")
            panel.set_title(face, fontsize=9)
    figure.suptitle(title)
    return figure


def surface_figures(result: RunResult) -> Iterator[tuple[str, Any]]:
    """Yields names and figures of the surfaces of a run in several dimensions, if it has taken a step."""
    for name, columns in result.surfaces.items():
        drawn = quantities(columns)
        if dimensions(result) < 2 or not drawn or not len(columns["area"]) or np.isnan(columns[drawn[0]]).all():
            continue
        in_space = angle_profiles if "wall" in columns["face"] else face_maps
        draw = profiles if dimensions(result) == 2 else in_space
        yield f"surface-{name}", draw(result, f"fluxes from the gas to '{name}'", columns)
