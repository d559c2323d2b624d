"""Pictures of runs in two and three space dimensions: maps of fields on planes, profiles along probes, frames of an animation."""
from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from .run_result import Array, RunResult
from .style import BLACK, BLUE, COLOURS, PictureError, plt

AXES = ("x", "y", "z")


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


def plane_at(result: RunResult, normal: str, place: float | None = None) -> Plane:
    """The plane of cells nearest to a place along an axis, the middle by default."""
    x = result.arrays[normal]
    index = len(x) // 2 if place is None else int(np.abs(x - place).argmin())
    across, up = (axis for axis in AXES if axis != normal)
    return Plane(across, up, normal, index, float(x[index]))


def planes_of(result: RunResult, chosen: str | None) -> list[Plane]:
    """All planes to draw: that of a result in the plane; in space those through the middle, or the chosen "z=0.5". Raises PictureError."""
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


def limits_of(values: Array) -> tuple[float, float, str]:
    """Smallest and largest value of a colour map, and its name: symmetric about 0 for fields of both signs."""
    finite = values[np.isfinite(values)]
    low, high = (float(finite.min()), float(finite.max())) if finite.size else (0.0, 1.0)
    if low < 0.0 < high:
        largest = max(-low, high)
        return -largest, largest, "RdBu_r"
    # A constant field, up to rounding, is one colour in the middle of the map.
    if high - low < 1e-12 * max(abs(low), abs(high), 1e-300):
        spread = max(abs(high), 1.0) * 1e-3
        return low - spread, high + spread, "viridis"
    return low, high, "viridis"


def without_solids(values: Array) -> Any:
    return np.ma.masked_invalid(values)  # type: ignore[no-untyped-call]


def draw_map(figure: Any, panel: Any, result: RunResult, name: str, values: Array, plane: Plane, colours: tuple[float, float, str]) -> None:
    """Draws values[x, y(, z)] on a plane; cells without a value, those of solid boxes, stay blank with an outline."""
    across, up = result.arrays[plane.across], result.arrays[plane.up]
    shown = without_solids(plane.cut(values))
    low, high, name_of_map = colours
    panel.grid(False)
    panel.set_aspect("equal")
    panel.set_facecolor("#D9D9D9")
    image = panel.pcolormesh(borders(across), borders(up), shown, cmap=name_of_map, vmin=low, vmax=high, rasterized=True)
    # As high as the map, whose axes have equal scales.
    ratio = float(np.ptp(borders(up)) / np.ptp(borders(across)))
    figure.colorbar(image, ax=panel, label=result.label(name), shrink=0.9 * min(1.0, 1.2 * ratio))
    levels = np.linspace(low, high, 12)[1:-1]
    if min(shown.shape) > 1 and ((levels > shown.min()) & (levels < shown.max())).any():
        panel.contour(across, up, shown, levels=levels, colors=BLACK, linewidths=0.4, alpha=0.6, linestyles="solid")
    panel.set_xlabel(f"{plane.across} ({result.unit('x')})")
    panel.set_ylabel(f"{plane.up} ({result.unit('x')})")
    panel.set_title(plane.title(), fontsize=9)


def draw_streamlines(panel: Any, result: RunResult, fields: dict[str, Array], plane: Plane) -> None:
    """Draws streamlines of the bulk velocity in a plane; solid boxes have none."""
    across, up = result.arrays[plane.across], result.arrays[plane.up]
    u, v = (plane.cut(fields[f"u_{axis}"]) for axis in (plane.across, plane.up))
    moves = np.nan_to_num(np.hypot(u, v)).max() > 0.0
    if moves and min(u.shape) > 1:
        panel.streamplot(across, up, without_solids(u), without_solids(v), color=BLACK, linewidth=0.6, arrowsize=0.7,
                         density=1.1)


def maps_of(result: RunResult, fields: dict[str, Array], planes: list[Plane], t: float, title: str,
            colours: dict[str, tuple[float, float, str]] | None = None) -> Any:
    """A panel for each field and plane, and one of the speed with streamlines."""
    with_speed = all(f"u_{axis}" in fields for axis in (planes[0].across, planes[0].up))
    shown = dict(fields)
    if with_speed:
        shown["speed"] = np.sqrt(sum(fields[name]**2 for name in fields if name in ("u_x", "u_y", "u_z")))
    columns = len(planes) if len(planes) > 1 else min(len(shown), 3)
    rows = len(shown) if len(planes) > 1 else -(-len(shown) // columns)
    figure, grid = plt.subplots(rows, columns, figsize=(4.6 * columns, 3.9 * rows), squeeze=False)
    panels = iter(grid.flat)
    for name, values in shown.items():
        limits = (colours or {}).get(name) or limits_of(values)
        for plane in planes:
            panel = next(panels)
            draw_map(figure, panel, result, name, values, plane, limits)
            if name == "speed":
                draw_streamlines(panel, result, fields, plane)
    for unused in panels:
        unused.remove()
    figure.suptitle(f"{title}, t = {t:.4g}")
    return figure


def fields_of_plane(result: RunResult) -> dict[str, Array]:
    return {name: values for name, values in result.fields.items() if values.ndim == dimensions(result)}


def maps_figure(result: RunResult, title: str, t: float, slice_at: str | None = None) -> Any:
    """Maps of all fields at the end. Raises PictureError."""
    return maps_of(result, fields_of_plane(result), planes_of(result, slice_at), t, title)


def frames(result: RunResult, title: str, slice_at: str | None = None) -> Iterator[tuple[str, Any]]:
    """Names and figures of all snapshots, with one range of colours. Raises PictureError."""
    if len(result.t) < 2 or dimensions(result) < 2:
        raise PictureError("there is nothing to animate (frames are snapshots of a run in two or three dimensions); run with output.every", 2)
    planes = planes_of(result, slice_at)
    names = list(fields_of_plane(result))
    colours = {name: limits_of(result.snapshots[name]) for name in names}
    speeds = [np.sqrt(sum(result.snapshots[name][k]**2 for name in names if name in ("u_x", "u_y", "u_z"))) for k in range(len(result.t))]
    colours["speed"] = limits_of(np.array(speeds))
    for k, t in enumerate(result.t):
        yield f"frame-{k + 1:04d}", maps_of(result, {name: result.snapshots[name][k] for name in names}, planes, float(t), title, colours)


def probe_figures(result: RunResult) -> Iterator[tuple[str, Any]]:
    """Names and figures of the profiles along the probes of a run, the last one in blue over earlier ones."""
    for probe, columns in result.probes.items():
        names = [name for name in columns if name not in ("t", "s", *AXES)]
        times = columns.get("t", np.zeros(len(columns["s"])))
        count = min(len(names), 3)
        rows = -(-len(names) // count)
        figure, grid = plt.subplots(rows, count, figsize=(4.2 * count if count > 1 else 6.0, 3.6 * rows), squeeze=False)
        for panel, name in zip(grid.flat, names):
            instants = np.unique(times)
            for k, t in enumerate(instants):
                at = times == t
                last = k == len(instants) - 1
                panel.plot(columns["s"][at], columns[name][at], color=BLUE if last else COLOURS[-1], linewidth=1.3 if last else 0.7)
            panel.set_xlabel(f"s ({result.unit('x')})")
            panel.set_ylabel(result.label(name))
        for unused in grid.flat[len(names):]:
            unused.remove()
        figure.suptitle(f"probe {probe}")
        yield f"probe-{probe}", figure
