"""Pictures of runs. Quantities are dimensionless unless the manifest of a run has units."""
from __future__ import annotations

import textwrap
from collections.abc import Iterator
from typing import Any

import numpy as np

from . import maps
from .probes import probe_figures
from .run_result import Array, RunResult
from .style import BLACK, BLUE, COLOURS, GREY, PictureError, earlier_times, panels, plt, show_literally
from .surfaces import surface_figures


def fields_figure(result: RunResult, slice_at: str | None = None) -> Any:
    """Draws a panel for each macroscopic field: over x at the end and, thin, at earlier snapshots; without space over t; in several dimensions
    a map, on planes in the middle, of symmetry, or at "z=0.5". Returns None if there is nothing to draw."""
    if maps.dimensions(result) > 1:
        return maps.maps_figure(result, title_of(result), end_of(result), slice_at)
    if slice_at is not None:
        raise PictureError(f"the slice '{slice_at}' has no meaning (the result is not in space); leave it out", 2)
    if not result.fields or (not result.has_space and len(result.t) < 2):
        return None
    figure, axes = panels(len(result.fields))
    shown = earlier_times(len(result.t) - 1)
    for panel, name in zip(axes, result.fields):
        if result.has_space:
            x = result.arrays["x"]
            for k, colour in zip(shown, plt.cm.Greys(np.linspace(0.3, 0.6, len(shown)))):
                panel.plot(x, result.snapshots[name][k], color=colour, linewidth=0.9, label=result.moment(result.t[k]))
            panel.plot(x, result.fields[name], color=BLUE, marker=".", markersize=4, linewidth=1, label=result.moment(end_of(result)))
        else:
            panel.plot(result.t, result.snapshots[name][:, 0], color=BLUE, marker=".", markersize=4, linewidth=1)
        axis = "x" if result.has_space else "t"
        panel.set_xlabel(f"{axis} ({result.unit(axis)})")
        panel.set_ylabel(result.label(name))
        show_rounding_as_zero(panel, result, name)
    if result.has_space:
        axes[0].legend(fontsize=8)
    figure.suptitle(title_of(result))
    return figure


def show_rounding_as_zero(panel: Any, result: RunResult, name: str) -> None:
    """Draws a component of the velocity that is zero up to rounding on the scale of the others."""
    sizes = {other: float(np.abs(result.snapshots.get(other, values)).max())
             for other, values in result.fields.items() if other.startswith("u_")}
    largest = max(sizes.values(), default=0.0)
    if sizes.get(name, largest) < 1e-12 * largest:
        panel.set_ylim(-largest, largest)


def end_of(result: RunResult) -> float:
    return float(result.history["t"][-1])


def title_of(result: RunResult) -> str:
    return str(result.manifest.get("case", {}).get("title", "")) or result.folder.resolve().name


def is_reduced(result: RunResult) -> bool:
    """Returns whether a row of f has two functions of one velocity component, g = ∫ f dη followed by h."""
    v, f = result.arrays.get("v"), result.arrays.get("f")
    return v is not None and f is not None and v.ndim == 1 and f.ndim == 2 and f.shape[1] == 2 * len(v)


def distribution_name(result: RunResult) -> str:
    """Returns f over one velocity component: f itself, or its integral over the others and over components η that the grid does not resolve."""
    if is_reduced(result):
        return "∫ f dη"
    return {2: "∫ f dv_y", 3: "∫ f dv_y dv_z"}.get(result.velocity_dimensions, "f")


def distribution_over_velocity(result: RunResult) -> tuple[Array, Array] | None:
    """Returns the nodes of v, or of v_x with several velocity dimensions, and f[cell, node] over them, integrated over the other
    components. Returns None for a model without a velocity grid, also if it has a few speeds."""
    if result.velocity_dimensions > 1:
        found = result.arrays.get("v_x"), result.marginals.get("v_x")
    else:
        found = result.arrays.get("v"), result.arrays.get("f")
    v, f = found
    if f is not None and v is not None and is_reduced(result):
        f = f[:, :len(v)]
    if v is None or f is None or f.shape[1:] != v.shape or len(np.unique(v)) < max(8, len(v)):
        return None
    return v, f


def distribution_figure(result: RunResult) -> Any:
    """f(x, v) at the end as a map over the profile of ε(x); with several velocity dimensions the marginal over v_x. None for a
    model without a velocity grid."""
    drawn = distribution_over_velocity(result) if result.has_space else None
    if drawn is None:
        return None
    v, f = drawn
    x, marginal = result.arrays["x"], f.T
    with_epsilon = "epsilon" in result.arrays and bool((result.arrays["epsilon"] > 0).all())
    rows = 1 + with_epsilon
    figure, axes = plt.subplots(rows, 1, figsize=(6, 5.4 if with_epsilon else 4), sharex=True, squeeze=False,
                                height_ratios=[3, 1][:rows])
    panel = axes[0][0]
    panel.grid(False)
    label, axis = distribution_name(result), "v" if result.velocity_dimensions < 2 else "v_x"
    image = panel.pcolormesh(x, v, marginal, shading="nearest", cmap="viridis", rasterized=True)
    figure.colorbar(image, ax=panel, label=f"{label} (dimensionless)")
    # The tails outside are below a thousandth of the maximum.
    seen = v[(marginal > 1e-3 * marginal.max()).any(axis=1)]
    if len(seen) > 1:
        panel.set_ylim(seen.min(), seen.max())
        if len(seen) < len(v):
            title = (f"{axis} from {seen.min():.4g} to {seen.max():.4g} of a grid from {v.min():.4g} to {v.max():.4g}; "
                     f"{label} is below a thousandth of its maximum beyond")
            panel.set_title(textwrap.fill(title, 96), fontsize=7)
    panel.set_ylabel(f"{axis} (dimensionless)")
    if with_epsilon:
        axes[1][0].semilogy(x, result.arrays["epsilon"], color=BLACK)
        axes[1][0].set_ylabel("ε (dimensionless)")
    axes[-1][0].set_xlabel(f"x ({result.unit('x')})")
    figure.suptitle(f"distribution function at {result.moment(end_of(result))}")
    return figure


def history_figure(result: RunResult) -> Any:
    """Draws the checks of every step: smallest value, conservation defects, entropy, a step size that varies, and the coefficients of
    bodies. None after no step. Of iterations to a steady state it draws residual, net rates and smallest value."""
    history = result.history
    if len(history["t"]) < 2:
        return None
    if "residual_relative" in history:
        return iterations_figure(result)
    defects = [name for name in history if name.startswith("conservation")]
    with_entropy = "entropy" in history and bool(np.isfinite(history["entropy"]).any())
    # The last two steps end at time.end, which is not a change of the step size.
    steps = history["dt"][1:-2]
    changing = len(steps) > 1 and float(np.ptp(steps)) > 1e-9 * float(steps.max())
    coefficients = [name for name in history if name.startswith("C_")]
    figure, axes = panels(1 + bool(defects) + with_entropy + changing + bool(coefficients), height=3.4)
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
        panel.semilogy(history["t"][1:-2], steps, color=BLUE)
        panel.set_ylabel(f"Δt ({result.unit('dt')})")
    if coefficients:
        draw_coefficients(next(following), history, coefficients)
    for panel in axes:
        panel.set_xlabel(f"t ({result.unit('t')})")
    figure.suptitle(title_of(result))
    return figure


def iterations_figure(result: RunResult) -> Any:
    """Draws how iterations approach a steady state."""
    history = result.history
    defects = [name for name in history if name.startswith("conservation")]
    figure, axes = panels(2 + bool(defects), height=3.4)
    axes[0].semilogy(history["t"], history["residual_relative"], color=BLUE, label="residual")
    axes[0].semilogy(history["t"], np.maximum(history["change"], 1e-18), color=GREY, label="change of the moments")
    axes[0].set_ylabel("relative to the start, or the scale")
    axes[0].legend(fontsize=8)
    if defects:
        draw_defects(axes[1], history, defects)
        axes[1].set_ylabel("relative net rate of the gas")
    draw_smallest(axes[-1], history)
    for panel in axes:
        panel.set_xlabel("iteration")
    figure.suptitle(title_of(result))
    return figure


def draw_coefficients(panel: Any, history: dict[str, Array], names: list[str]) -> None:
    """Draws coefficients of bodies from the first step on, because the gas gives no force before it."""
    kinds = list(dict.fromkeys(name[:3] for name in names))
    bodies = list(dict.fromkeys(name[4:] for name in names))
    for name in names:
        style = ("-", "--", ":", "-.")[bodies.index(name[4:]) % 4]
        panel.plot(history["t"][1:], history[name][1:], color=f"C{kinds.index(name[:3])}", linestyle=style, label=f"{name[:3]} {name[4:]}")
    panel.set_ylabel("coefficients (dimensionless)")
    panel.legend(fontsize=8, ncols=1 + len(names) // 6)


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
        # An exact zero is drawn at the bottom of the logarithmic axis.
        panel.semilogy(history["t"], np.maximum(history[name], 1e-18), color=colour,
                       label=name.removeprefix("conservation").strip("_.").replace("_", " ") or name)
    panel.set_ylabel("relative conservation defect")
    panel.legend(fontsize=8)


def figures(result: RunResult, slice_at: str | None = None) -> dict[str, Any]:
    """Returns all pictures of a run by name: fields, distribution, history, profiles along probes and walls."""
    made = {"fields": fields_figure(result, slice_at), "distribution": distribution_figure(result), "history": history_figure(result),
            **dict(probe_figures(result, title_of(result))), **dict(surface_figures(result))}
    return {name: show_literally(figure) for name, figure in made.items() if figure is not None}


def frames(result: RunResult, slice_at: str | None = None) -> Iterator[tuple[str, Any]]:
    """Names and pictures of all snapshots (maps.frames)."""
    return maps.frames(result, title_of(result), slice_at)
