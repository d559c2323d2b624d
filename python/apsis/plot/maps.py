"""Pictures of runs in two and three space dimensions: maps of fields on planes, and frames of an animation."""
from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np

from .run_result import Array, RunResult
from .style import BLACK, PictureError, plt
from .walls import SOLID, draw_slice, draw_walls

AXES = ("x", "y", "z")
FACES = {"x": ("left", "right"), "y": ("bottom", "top"), "z": ("back", "front")}  # ends of the domain along an axis
VECTORS = {"u": "speed", "m": "momentum"}  # fields u_x, u_y, … and the name of their length
Colours = tuple[float, float, str]


@dataclass(frozen=True)
class Plane:
    """Cells of a result in a plane: the axes that span it, and for three dimensions the index along the normal and its place."""

    across: str
    up: str
    normal: str = ""
    index: int = 0
    place: float = 0.0

    def cut(self, values: Array) -> Array:
        """values[x, y(, z)] on the plane, as [up, across]."""
        if self.normal:
            values = np.take(values, self.index, axis=AXES.index(self.normal))
        return values.T

    def title(self) -> str:
        return f"{self.normal} = {self.place:.4g}" if self.normal else ""


def dimensions(result: RunResult) -> int:
    """Number of space dimensions of the fields; 1 without space too."""
    return max((values.ndim for values in result.fields.values()), default=1)


def middle_of(result: RunResult, normal: str) -> int:
    """Returns the cells in the middle along an axis. If only one end is a plane of symmetry, returns the cells beside it, because the flow
    continues beyond it as its mirror image."""
    count = len(result.arrays[normal])
    case = result.manifest.get("case", {})
    usual = case.get("space", {}).get("boundary")
    lower, upper = (case.get("boundary", {}).get(face, {}).get("kind", usual) == "symmetry" for face in FACES[normal])
    return count // 2 if lower == upper else 0 if lower else count - 1


def plane_at(result: RunResult, normal: str, place: float | None = None) -> Plane:
    """Returns the plane of cells nearest to a place along an axis, by default in the middle or at a plane of symmetry."""
    x = result.arrays[normal]
    index = middle_of(result, normal) if place is None else int(np.abs(x - place).argmin())
    across, up = (axis for axis in AXES if axis != normal)
    return Plane(across, up, normal, index, float(x[index]))


def planes_of(result: RunResult, chosen: str | None) -> list[Plane]:
    """Returns all planes to draw: that of a result in the plane; in space those in the middle or at planes of symmetry, or the
    chosen "z=0.5". Raises PictureError."""
    if dimensions(result) == 2:
        if chosen is not None:
            raise PictureError(f"the slice '{chosen}' has no meaning (the result has two dimensions); leave it out", 2)
        return [Plane("x", "y")]
    if chosen is None:
        return [plane_at(result, normal) for normal in reversed(AXES)]
    normal, _, text = chosen.partition("=")
    try:
        place = float(text)
    except ValueError:
        place = float("nan")
    if normal not in AXES or not np.isfinite(place):
        raise PictureError(f"'{chosen}' is no slice (an axis and a number are needed); write for example z=0.5", 2)
    ends = np.round(borders(result.arrays[normal])[[0, -1]], 12) + 0.0  # no rounding, nor -0, in messages
    if not ends[0] <= place <= ends[1]:
        raise PictureError(f"the slice '{chosen}' is outside of the domain ({normal} from {ends[0]:g} to {ends[1]:g}); "
                           "give a place inside", 2)
    return [plane_at(result, normal, place)]


def borders(centres: Array) -> Array:
    """Edges of cells of equal size."""
    half = 0.5 * (centres[1] - centres[0]) if len(centres) > 1 else 0.5
    return np.concatenate([centres - half, centres[-1:] + half])


def limits_of(values: Array, scale: float = 0.0) -> Colours:
    """Returns the smallest and largest value of a colour map, symmetric about 0 for fields of both signs, and its name. Values below
    1e-12 of `scale` are rounding, and have the colour of 0."""
    finite = values[np.isfinite(values)]
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)
    if max(-low, high) < 1e-12 * scale:
        return -scale, scale, "RdBu_r"
    if low < 0.0 < high:
        largest = max(-low, high)
        return -largest, largest, "RdBu_r"
    # A constant field, up to rounding, is one colour in the middle of the map.
    if high - low < 1e-12 * max(abs(low), abs(high), 1e-300):
        spread = max(abs(high), 1.0) * 1e-3
        return low - spread, high + spread, "viridis"
    return low, high, "viridis"


def length_of(fields: Mapping[str, Array], vector: str) -> Array:
    """Returns the lengths of a vector with the components vector_x, vector_y, …"""
    return np.sqrt(sum(fields[f"{vector}_{axis}"]**2 for axis in AXES if f"{vector}_{axis}" in fields))


def vector_in(fields: Mapping[str, Array], plane: Plane) -> str | None:
    """Returns the vector with both components in a plane."""
    return next((name for name in VECTORS if all(f"{name}_{axis}" in fields for axis in (plane.across, plane.up))), None)


def with_length(fields: Mapping[str, Array], plane: Plane) -> dict[str, Array]:
    """Returns the fields and, last, the length of their vector."""
    vector = vector_in(fields, plane)
    return dict(fields) if vector is None else {**fields, VECTORS[vector]: length_of(fields, vector)}


def quantity_of(name: str) -> str:
    """Returns the vector or tensor of a component, such as "stress" of "stress_xy"; "" for other fields."""
    quantity, _, axes = name.rpartition("_")
    return quantity if axes and set(axes) <= set(AXES) else ""


def colours_of(fields: Mapping[str, Array]) -> dict[str, Colours]:
    """Returns the colours of each field. Components of a vector or tensor are zero up to rounding relative to its largest length."""
    quantities = {quantity_of(name) for name in fields} - {""}
    squares = {one: sum(values**2 for name, values in fields.items() if quantity_of(name) == one) for one in quantities}
    lengths = {one: float(np.sqrt(np.nanmax(square, initial=0.0))) for one, square in squares.items()}
    return {name: limits_of(values, lengths.get(quantity_of(name), 0.0)) for name, values in fields.items()}


def without_solids(values: Array) -> Any:
    return np.ma.masked_invalid(values)  # type: ignore[no-untyped-call]


def label_of(result: RunResult, name: str) -> str:
    """Returns name and unit of a field, or of the length of a vector."""
    vector = next((vector for vector, length in VECTORS.items() if length == name), None)
    return result.label(name, 44) if vector is None else f"{name} ({result.unit(f'{vector}_x')})"


def sizes_of(result: RunResult, planes: Sequence[Plane]) -> list[tuple[float, float]]:
    """Returns widths and heights of maps in inches on one scale. A side of less than an inch is enlarged, up to 1/8 of the other side."""
    extents = [tuple(float(np.ptp(borders(result.arrays[axis]))) for axis in (plane.across, plane.up)) for plane in planes]
    inch = max(max(sides) for sides in extents) / (3.4 if all(up > 0.4 * across for across, up in extents) else 4.8)
    sizes = []
    for sides in extents:
        across, up = (side / inch for side in sides)
        more = max(1.0, min(1.0 / min(across, up), 4.8 / max(across, up)))
        across, up = across * more, up * more
        sizes.append((max(across, up / 8), max(up, across / 8)))
    return sizes


def draw_map(panel: Any, result: RunResult, name: str, values: Array, plane: Plane, colours: Colours, size: tuple[float, float],
             title: str = "") -> None:
    """Draws values[x, y(, z)] on a plane, with contours and a colour bar. Cells without a value, those of solids, are grey. So are the
    parts of cells that lie in bodies."""
    across, up = result.arrays[plane.across], result.arrays[plane.up]
    shown = without_solids(plane.cut(values))
    low, high, name_of_map = colours
    width, height = size
    panel.grid(False)
    equal = abs(np.ptp(borders(up)) / np.ptp(borders(across)) * width / height - 1.0) < 1e-9
    panel.set_aspect("equal" if equal else "auto")
    panel.locator_params(axis="x", nbins=max(2, int(1.7 * width)))
    panel.locator_params(axis="y", nbins=max(2, int(2.0 * height)))
    panel.set_facecolor(SOLID)
    image = panel.pcolormesh(borders(across), borders(up), shown, cmap=name_of_map, vmin=low, vmax=high, rasterized=True)
    beside = panel.inset_axes([1.0 + 0.1 / width, 0.0, 0.13 / width, 1.0], label="<colorbar>")
    beside.grid(False)
    panel.figure.colorbar(image, cax=beside)
    levels = np.linspace(low, high, 12)[1:-1]
    if min(shown.shape) > 1 and ((levels > shown.min()) & (levels < shown.max())).any():
        panel.contour(across, up, shown, levels=levels, colors=BLACK, linewidths=0.4, alpha=0.6, linestyles="solid")
    if plane.normal:
        draw_slice(panel, result.walls, [borders(result.arrays[axis]) for axis in AXES], AXES.index(plane.normal), plane.place)
    else:
        draw_walls(panel, result.walls, borders(across), borders(up))
    panel.set_xlabel(f"{plane.across} ({result.unit('x')})")
    panel.set_ylabel(f"{plane.up} ({result.unit('x')})")
    panel.set_title("\n".join(filter(None, [label_of(result, name), plane.title(), title])), fontsize=9)


def draw_streamlines(panel: Any, result: RunResult, fields: Mapping[str, Array], plane: Plane, size: tuple[float, float]) -> None:
    """Draws streamlines of a vector in a plane where it is more than 1e-4 of the largest; solid boxes have none."""
    vector = vector_in(fields, plane)
    if vector is None:
        return
    across, up = result.arrays[plane.across], result.arrays[plane.up]
    u, v = (plane.cut(fields[f"{vector}_{axis}"]) for axis in (plane.across, plane.up))
    moves = np.hypot(u, v) > 1e-4 * np.nanmax(length_of(fields, vector), initial=0.0)
    if moves.any() and min(u.shape) > 1:
        panel.streamplot(across, up, np.where(moves, u, np.nan), np.where(moves, v, np.nan), color=BLACK, linewidth=0.6, arrowsize=0.7,
                         density=tuple(0.33 * side for side in size))


def sheet(sizes: Sequence[tuple[float, float]], count: int, title: str = "") -> tuple[Any, list[Any]]:
    """Returns a figure of `count` maps in rows, the maps of a row with these sizes, and its panels. Panels are placed in inches, because
    Matplotlib's layout reserves no room for labels around a panel of given aspect."""
    left, right, below, above = 0.75, 0.95, 0.5, 0.5  # room for labels, colour bar and title
    rows, height = -(-count // len(sizes)), max(height for _, height in sizes)
    whole = (sum(left + width + right for width, _ in sizes), rows * (below + height + above) + (0.35 if title else 0.0))
    figure = plt.figure(figsize=whole)
    figure.set_layout_engine("none")  # layout="none" above would be forgotten after the first savefig
    panels = []
    for k in range(count):
        row, column = divmod(k, len(sizes))
        width, up = sizes[column]
        x = sum(left + before + right for before, _ in sizes[:column]) + left
        y = (rows - 1 - row) * (below + height + above) + below + 0.5 * (height - up)
        panels.append(figure.add_axes((x / whole[0], y / whole[1], width / whole[0], up / whole[1])))
    if title:
        figure.suptitle(title, y=1.0 - 0.12 / whole[1], va="top")
    return figure, panels


def maps_of(result: RunResult, fields: Mapping[str, Array], planes: list[Plane], title: str,
            colours: Mapping[str, Colours] | None = None) -> Any:
    """Draws a map of each field and, with streamlines, of the speed: one after the other, or with several planes a row of each."""
    shown = with_length(fields, planes[0])
    colours = colours or colours_of(shown)
    sizes = sizes_of(result, planes)
    places = list(zip(planes, sizes))
    if len(planes) == 1:
        sizes *= 2 if len(shown) == 4 else min(len(shown), 3 if sizes[0][0] < 4.0 else 2)
    figure, panels = sheet(sizes, len(shown) * len(planes), title)
    for panel, (name, (plane, size)) in zip(panels, product(shown, places)):
        draw_map(panel, result, name, shown[name], plane, colours[name], size)
        if name in VECTORS.values():
            draw_streamlines(panel, result, fields, plane, size)
    return figure


def fields_of_plane(result: RunResult) -> dict[str, Array]:
    return {name: values for name, values in result.fields.items() if values.ndim == dimensions(result)}


def maps_figure(result: RunResult, title: str, t: float, slice_at: str | None = None) -> Any:
    """Draws maps of all fields at the end. Raises PictureError."""
    return maps_of(result, fields_of_plane(result), planes_of(result, slice_at), f"{title}, {result.moment(t)}")


def frames(result: RunResult, title: str, slice_at: str | None = None) -> Iterator[tuple[str, Any]]:
    """Yields names and figures of all snapshots, with one range of colours. Raises PictureError."""
    if len(result.t) < 2 or dimensions(result) < 2:
        raise PictureError("there is nothing to animate (frames are snapshots of a run in two or three dimensions); run with output.every", 2)
    planes = planes_of(result, slice_at)
    series = {name: result.snapshots[name] for name in fields_of_plane(result)}
    colours = colours_of(with_length(series, planes[0]))
    for k, t in enumerate(result.t):
        yield f"frame-{k + 1:04d}", maps_of(result, {name: values[k] for name, values in series.items()}, planes, f"{title}, {result.moment(t)}",
                                            colours)
