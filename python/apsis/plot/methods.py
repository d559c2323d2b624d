"""Pictures of a method: coefficients and stability regions."""
from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .style import BLACK, COLOURS, SKY, plt

Description = Mapping[str, Any]
Complex = NDArray[np.complex128]

STIFF = ((0.0, "z_Q = 0", "-"), (-1.0, "z_Q = −1", "--"), (-10.0, "z_Q = −10", "-."), (-100.0, "z_Q = −100", ":"))


def matrices(method: Description) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Butcher form: coefficients of T, Q and Q̇ (s × s each)."""
    A_hat, A, A_dot = (np.asarray(method[name], dtype=float) for name in ("A_hat", "A", "A_dot"))
    return A_hat, A, A_dot


def stability_function(method: Description, z_T: Any, z_Q: Any) -> Any:
    """R(z_T, z_Q) = u^{n+1}/u^n for u′ = λ_T u + λ_Q u with z = λΔt, where Q̇ = λ_Q² u:
    y_i = 1 + Σ_j (z_T â_ij + z_Q a_ij + z_Q² ȧ_ij) y_j, R = y_s. Arrays of any shape that can be broadcast."""
    z_T, z_Q = np.broadcast_arrays(np.asarray(z_T, dtype=complex), np.asarray(z_Q, dtype=complex))
    A_hat, A, A_dot = matrices(method)
    stages: list[Complex] = []
    for i in range(len(A)):
        total = np.ones_like(z_T)
        for j, y in enumerate(stages):
            if A_hat[i, j] or A[i, j] or A_dot[i, j]:
                total = total + (z_T * A_hat[i, j] + z_Q * A[i, j] + z_Q * z_Q * A_dot[i, j]) * y
        stages.append(total / (1.0 - z_Q * A[i, i] - z_Q * z_Q * A_dot[i, i]))
    return stages[-1]


def stable_extent(method: Description, z_Q: float) -> tuple[float, float]:
    """Returns the extent of the stability region of T along −Re z and |Im z|."""
    x, y = np.meshgrid(np.linspace(-60, 4, 257), np.linspace(0, 30, 121))
    with np.errstate(all="ignore"):
        inside = np.abs(stability_function(method, x + 1j * y, z_Q)) <= 1.0
    return (float(-x[inside].min()), float(y[inside].max())) if inside.any() else (0.0, 0.0)


def region(axes: Any, size: Any, x: Any, y: Any, **line: Any) -> bool:
    """Draws |R| = 1 and returns whether it passes through the window."""
    crosses = bool(size.min() < 1.0 < size.max())
    if crosses:
        axes.contour(x, y, size, levels=[1.0], **line)
    return crosses


def stability_figure(method: Description) -> Any:
    """Draws |R| ≤ 1 for Q alone and for T with Q of several stiffnesses, if the method has these parts."""
    A_hat, A, A_dot = matrices(method)
    explicit = np.array_equal(A_hat, A)
    parts = [part for part, there in (("Q", not explicit and (A.any() or A_dot.any())), ("T", A_hat.any())) if there]
    figure, grid = plt.subplots(1, len(parts), figsize=(5.0 * len(parts), 4.6), squeeze=False)
    for axes, part in zip(grid.flat, parts):
        if part == "Q":
            draw_implicit(axes, method)
        else:
            draw_explicit(axes, method, stiff="Q" in parts)
        axes.axhline(0.0, color=BLACK, linewidth=0.5)
        axes.axvline(0.0, color=BLACK, linewidth=0.5)
        axes.set_aspect("equal")
        axes.set_xlabel(f"Re z_{part} (dimensionless)")
        axes.set_ylabel(f"Im z_{part} (dimensionless)")
    figure.suptitle(f"{method['name']}: where |R(z)| ≤ 1", fontsize=11)
    return figure


def draw_implicit(axes: Any, method: Description) -> None:
    x, y = np.meshgrid(np.linspace(-12, 12, 481), np.linspace(-12, 12, 481))
    with np.errstate(all="ignore"):
        size = np.nan_to_num(np.abs(stability_function(method, 0.0, x + 1j * y)), nan=1e9, posinf=1e9)
    axes.contourf(x, y, size, levels=[0.0, 1.0], colors=[SKY], alpha=0.6)
    region(axes, size, x, y, colors=[BLACK], linewidths=0.8)
    axes.set_title("Q alone (shaded)", fontsize=10)


def draw_explicit(axes: Any, method: Description, stiff: bool) -> None:
    shown = STIFF if stiff else STIFF[:1]
    # With stiff Q the regions of some methods grow without bound; the window is that of moderate steps.
    reach = [stable_extent(method, z) for z, _, _ in shown[:2]]
    left, high = (1.3 * max([1.0, *(r[k] for r in reach)]) for k in (0, 1))
    x, y = np.meshgrid(np.linspace(-left, 0.3 * left, 401), np.linspace(-high, high, 401))
    for (z, label, line), colour in zip(shown, COLOURS):
        with np.errstate(all="ignore"):
            size = np.nan_to_num(np.abs(stability_function(method, x + 1j * y, z)), nan=1e9, posinf=1e9)
        if region(axes, size, x, y, colors=[colour], linestyles=[line], linewidths=1.3) and stiff:
            axes.plot([], [], color=colour, linestyle=line, label=label)
    axes.set_title("T beside Q (inside the curves)" if stiff else "T (inside the curve)", fontsize=10)
    if stiff:
        axes.legend(fontsize=8, loc="upper left")


def tableau_figure(method: Description) -> Any:
    """Draws the Butcher form as maps of coefficients (dimensionless): zeros blank, row sums on the left, u^{n+1} last."""
    A_hat, A, A_dot = matrices(method)
    named = [(r"$\hat A$ of $T$ and of $Q$", A)] if np.array_equal(A_hat, A) else [
        (r"$\hat A$ of $T$", A_hat), (r"$A$ of $Q$", A), (r"$\dot A$ of $\dot Q$", A_dot)]
    parts = [(name, m) for name, m in named if m.any()]
    stages = len(parts[0][1])
    size = 1.2 + 0.42 * stages if stages <= 10 else 5.4
    figure, grid = plt.subplots(1, len(parts), figsize=((size + 1.3) * len(parts), size + 0.5), squeeze=False)
    for axes, (name, m) in zip(grid.flat, parts):
        largest = float(np.abs(m).max())
        image = axes.imshow(np.where(m == 0.0, np.nan, m), cmap="RdBu", vmin=-largest, vmax=largest)
        axes.grid(False)
        axes.set_xticks(range(stages), [str(j + 1) for j in range(stages)], fontsize=7)
        axes.set_yticks(range(stages), [f"{c:.3g}" for c in m.sum(axis=1)], fontsize=7)
        axes.set_xlabel("stage")
        axes.set_ylabel("row sum")
        axes.set_title(name, fontsize=10, gid="formula")
        figure.colorbar(image, ax=axes, shrink=0.8)
        if stages <= 10:
            write_numbers(axes, m, largest)
    figure.suptitle(f"{method['name']}: Butcher form", fontsize=11)
    return figure


def write_numbers(axes: Any, m: NDArray[np.float64], largest: float) -> None:
    for i, j in zip(*np.nonzero(m)):
        axes.text(j, i, f"{m[i, j]:.2g}", fontsize=6, ha="center", va="center",
                  color="white" if abs(m[i, j]) > 0.6 * largest else "black")
