"""Walls of bodies in the plane: their pieces as lines, and the part of each cut cell that lies in a body."""
from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from matplotlib.collections import LineCollection, PolyCollection

from .run_result import Array
from .style import BLACK

SOLID = "#D9D9D9"


def behind(corners: Array, piece: Array) -> Array:
    """The part of a convex polygon on the left of a piece [ends, 2], where its body is."""
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
    """The solid part of the cell of each piece [piece, ends, 2], between the edges x and y of the cells."""
    for piece in pieces:
        along = piece[1] - piece[0]
        inside = piece.mean(axis=0) + 1e-6 * np.array([along[1], -along[0]])  # in the gas, if the piece is a side of the cell
        i, j = np.searchsorted(x, inside[0]) - 1, np.searchsorted(y, inside[1]) - 1
        if not (0 <= i < len(x) - 1 and 0 <= j < len(y) - 1):
            continue
        part = behind(np.array([[x[i], y[j]], [x[i + 1], y[j]], [x[i + 1], y[j + 1]], [x[i], y[j + 1]]]), piece)
        if len(part) > 2:
            yield part


def draw_walls(panel: Any, walls: dict[str, Array], x: Array, y: Array) -> None:
    """Covers the solid parts of cut cells, between the edges x and y of the cells, and draws the walls."""
    for pieces in walls.values():
        parts = list(solid_parts(pieces, x, y))
        panel.add_collection(PolyCollection(parts, facecolors=SOLID, edgecolors=SOLID, linewidths=0.5, antialiaseds=False, zorder=2.5), autolim=False)
        panel.add_collection(LineCollection(list(pieces), colors=BLACK, linewidths=1.3, capstyle="round", zorder=2.6), autolim=False)
