"""Walls of bodies in a plane: their pieces as lines, and the part of each cut cell that lies in a body."""
from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from matplotlib.collections import LineCollection, PolyCollection

from .run_result import Array
from .style import BLACK

SOLID = "#D9D9D9"


def behind(corners: Array, piece: Array) -> Array:
    """Returns the part of a convex polygon on the left of a piece [ends, 2], on the side of its body."""
    first, along = piece[0], piece[1] - piece[0]
    sides = along[0] * (corners[:, 1] - first[1]) - along[1] * (corners[:, 0] - first[0])
    kept: list[Array] = []
    for here, there, side, beyond in zip(corners, np.roll(corners, -1, axis=0), sides, np.roll(sides, -1)):
        if side >= 0:
            kept.append(here)
        if side * beyond < 0:
            kept.append(here + (there - here) * side / (side - beyond))
    return np.array(kept).reshape(-1, 2)


def solid_parts(pieces: Array, x: Array, y: Array) -> Iterator[Array]:
    """Returns the solid part of the cell of each piece [piece, ends, 2], between the edges x and y of the cells."""
    for piece in pieces:
        along = piece[1] - piece[0]
        inside = piece.mean(axis=0) + 1e-6 * np.array([along[1], -along[0]])  # in the gas, if the piece is a side of the cell
        i, j = np.searchsorted(x, inside[0]) - 1, np.searchsorted(y, inside[1]) - 1
        if not (0 <= i < len(x) - 1 and 0 <= j < len(y) - 1):
            continue
        part = behind(np.array([[x[i], y[j]], [x[i + 1], y[j]], [x[i + 1], y[j + 1]], [x[i], y[j + 1]]]), piece)
        if len(part) > 2:
            yield part


def cut_of(polygons: Array, normal: int, place: float) -> Array:
    """Returns the segments [segment, end, 2] in which polygons [piece, corner, 3] meet a plane across an axis, the body on their left."""
    height = polygons[..., normal] - place
    above = height >= 0
    segments = []
    for corners, h, up in zip(polygons, height, above):
        following, beyond = np.roll(up, -1), np.roll(h, -1)
        share = np.divide(h, h - beyond, out=np.zeros_like(h), where=up != following)
        points = np.delete(corners + share[:, None] * (np.roll(corners, -1, axis=0) - corners), normal, axis=1)
        # Corners are counter-clockwise seen from the gas: the body is on the left from where they descend to where they ascend next.
        first, last = np.flatnonzero(up & ~following), np.flatnonzero(~up & following)
        if len(first):
            last = np.roll(last, -int(np.searchsorted(last, first[0])))
            segments += list(np.stack([points[first], points[last]], axis=1))
    found = np.array(segments).reshape(-1, 2, 2)
    return found[:, ::-1] if normal == 1 else found  # (x, z) is left-handed


def solid_cells(polygons: Array, edges: Sequence[Array], normal: int, place: float) -> Iterator[Array]:
    """Returns the corners of cut cells that a plane meets only inside a body: their nearest piece of wall lies before the
    middle of the cell, and does not reach the plane."""
    following = np.roll(polygons, -1, axis=1)
    outward = np.cross(polygons - polygons[:, :1], following - polygons[:, :1]).sum(axis=1)
    middle = polygons.mean(axis=1)
    inside = middle + 1e-6 * min(float(np.diff(one).min()) for one in edges) * outward / np.linalg.norm(outward, axis=1, keepdims=True)
    cells = np.stack([np.searchsorted(one, inside[:, k]) - 1 for k, one in enumerate(edges)], axis=1)
    layer = int(np.searchsorted(edges[normal], place)) - 1
    height = polygons[..., normal] - place
    beside = (cells[:, normal] == layer) & np.all(cells >= 0, axis=1) & np.all(cells < [len(one) - 1 for one in edges], axis=1)
    nearest: dict[tuple[int, ...], tuple[float, bool, bool]] = {}
    for k in np.flatnonzero(beside):
        centre = np.array([0.5 * (one[i] + one[i + 1]) for one, i in zip(edges, cells[k])])
        crosses = bool((height[k] >= 0).any() and (height[k] < 0).any())
        found = (float(np.linalg.norm(centre - middle[k])), crosses, bool((centre - middle[k]) @ outward[k] < 0))
        cell = tuple(int(i) for i in cells[k])
        nearest[cell] = min(nearest.get(cell, found), found)
    for cell, (_, crosses, is_behind) in nearest.items():
        if is_behind and not crosses:
            (x, i), (y, j) = ((edges[k], cell[k]) for k in range(3) if k != normal)
            yield np.array([[x[i], y[j]], [x[i + 1], y[j]], [x[i + 1], y[j + 1]], [x[i], y[j + 1]]])


def cover(panel: Any, parts: list[Array]) -> None:
    panel.add_collection(PolyCollection(parts, facecolors=SOLID, edgecolors=SOLID, linewidths=0.5, antialiaseds=False, zorder=2.5), autolim=False)


def draw_walls(panel: Any, walls: dict[str, Array], x: Array, y: Array) -> None:
    """Covers the solid parts of cut cells, between the edges x and y of the cells, and draws the walls."""
    for pieces in walls.values():
        cover(panel, list(solid_parts(pieces, x, y)))
        panel.add_collection(LineCollection(list(pieces), colors=BLACK, linewidths=1.3, capstyle="round", zorder=2.6), autolim=False)


def draw_slice(panel: Any, walls: dict[str, Array], edges: Sequence[Array], normal: int, place: float) -> None:
    """Covers and draws the same in a plane through bodies in space, between the edges of the cells along x, y and z."""
    for polygons in walls.values():
        cover(panel, list(solid_cells(polygons, edges, normal, place)))
    x, y = (one for k, one in enumerate(edges) if k != normal)
    draw_walls(panel, {name: cut_of(polygons, normal, place) for name, polygons in walls.items()}, x, y)
