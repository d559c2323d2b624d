"""Profiles along the probes of a run, and of several runs in one picture."""
from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np

from .maps import AXES
from .run_result import Array, RunResult
from .style import BLUE, COLOURS, LINES, earlier_times, panels, plt

Probe = dict[str, Array]


def fields_of(probe: Probe) -> list[str]:
    return [name for name in probe if name not in ("t", "s", *AXES)]


def instants(probe: Probe) -> Array:
    """Returns the times of the rows of a probe; zeros without snapshots."""
    return np.asarray(probe.get("t", np.zeros(len(probe["s"]))))


def ends(probe: Probe) -> str:
    """Returns the first and last point of a probe as text, "from (0, 0.5) to (1, 0.5)"."""
    points = [", ".join(f"{float(probe[axis][k]) + 0.0:.4g}" for axis in AXES if axis in probe) for k in (0, -1)]
    return f"from ({points[0]}) to ({points[1]})"


def probe_figures(result: RunResult, title: str) -> Iterator[tuple[str, Any]]:
    """Yields names and figures of the profiles along the probes of a run, the last one in blue over earlier ones in grey."""
    for name, probe in result.probes.items():
        names, times = fields_of(probe), instants(probe)
        figure, axes = panels(len(names))
        *before, last = np.unique(times)
        shown = earlier_times(len(before))
        greys = plt.cm.Greys(np.linspace(0.3, 0.6, len(shown)))
        for panel, field in zip(axes, names):
            for k, colour in zip(shown, greys):
                at = times == before[k]
                panel.plot(probe["s"][at], probe[field][at], color=colour, linewidth=0.9, label=result.moment(before[k]))
            at = times == last
            panel.plot(probe["s"][at], probe[field][at], color=BLUE, linewidth=1.3, label=result.moment(last))
            panel.set_xlabel(f"s ({result.unit('x')})")
            panel.set_ylabel(result.label(field))
        if before:
            axes[0].legend(fontsize=8)
        figure.suptitle(f"{title}: probe {name} {ends(probe)}")
        yield f"probe-{name}", figure


def probe_comparisons(runs: Sequence[tuple[str, RunResult]]) -> Iterator[tuple[str, Any]]:
    """Yields names and figures of the final profiles along the probes that all runs have, a line for each run."""
    first = runs[0][1]
    for name in first.probes:
        probes = [run.probes.get(name, {}) for _, run in runs]
        names = [field for field in fields_of(first.probes[name]) if all(field in probe for probe in probes)]
        if not names:
            continue
        figure, axes = panels(len(names))
        for panel, field in zip(axes, names):
            for k, ((label, _), probe) in enumerate(zip(runs, probes)):
                at = instants(probe) == instants(probe).max()
                panel.plot(probe["s"][at], probe[field][at], label=label, color=COLOURS[k % len(COLOURS)], linestyle=LINES[k % len(LINES)],
                           linewidth=1.3)
            panel.set_xlabel(f"s ({first.unit('x')})")
            panel.set_ylabel(first.label(field))
        axes[0].legend(fontsize=8)
        figure.suptitle(f"probe {name} {ends(first.probes[name])}")
        yield f"probe-{name}", figure
