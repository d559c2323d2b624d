"""Runs of cases, as by `apsis run`."""
from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Callable, Union, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from .arguments import number, type_of, whole_number
from .case_text import CaseText
from .errors import InputError
from .library_warnings import LibraryWarnings
from .methods import html_table

Array = NDArray[np.float64]
Case = Union[str, Path, Mapping[str, Any]]
Progress = Callable[[int, int, float, float], Any]
Initial = Union[ArrayLike, Callable[..., ArrayLike], Mapping[str, Union[ArrayLike, Callable[..., ArrayLike]]]]


@dataclass(frozen=True, eq=False)
class Result:
    """The result of a run. Arrays are not copied.

        state                    how the run ended
        f[cell, component]       the state at the end
        x, y, z                  cell centres along each direction
        v[component]             speeds of the components; v[component, dimension] with two or three velocity dimensions
        v_weights[component]     quadrature weights of the velocities: f @ v_weights is the density
        axes["v_x"], …           nodes of the velocities, where they are a tensor product
        marginals["v_x"], …      [cell, node]: f integrated over the other components of the velocity
        epsilon[cell]            Knudsen number at the centres; empty where the model has none
        t[k]                     times of the fields, ending with the final time
        fields[name][k, cell]    macroscopic fields at these times
        labels[name]             axis label of a field
        history[name][n]         checked quantities after step n
        summary                  a mapping with the keys of `apsis run --json`
        probes[name]             columns of probes/NAME.csv
        surfaces[name]           columns of surfaces/NAME.csv
        walls[name]              the wall of a body, in the plane [piece, end], in space [piece, corner]

    In two and three space dimensions [cell] stands for [i, j] or [i, j, k], the numbers of the cell along x, y and z: a field has the
    shape (nt, nx, ny). walls has the ends (x, y) of the pieces of a wall in the plane, with the body on their left. In space it has the
    corners (x, y, z) of the polygons, in the order of the rows of surfaces. Polygons with fewer corners repeat the last one."""

    state: str
    f: Array
    x: Array
    v: Array
    epsilon: Array
    t: Array
    fields: dict[str, Array]
    history: dict[str, Array]
    summary: dict[str, Any]
    labels: dict[str, str] = field(default_factory=dict)
    v_weights: Array = field(default_factory=lambda: np.zeros(0))
    axes: dict[str, Array] = field(default_factory=dict)
    marginals: dict[str, Array] = field(default_factory=dict)
    y: Array = field(default_factory=lambda: np.zeros(0))
    z: Array = field(default_factory=lambda: np.zeros(0))
    probes: dict[str, dict[str, Array]] = field(default_factory=dict)
    surfaces: dict[str, dict[str, NDArray[Any]]] = field(default_factory=dict)
    walls: dict[str, Array] = field(default_factory=dict)

    @property
    def title(self) -> str:
        """Title of the case."""
        return str(self.summary.get("case", {}).get("title", ""))

    def _size(self) -> str:
        *shape, components = self.f.shape
        cells = " x ".join(str(n) for n in shape)
        return f"{cells} cells, {components} components" if len(self.x) else f"{components} components"

    def __repr__(self) -> str:
        return f"<apsis.Result {self.title!r}: {self.state} at t = {self.summary['t']:g}, {self.summary['steps']} steps, {self._size()}>"

    def _repr_html_(self) -> str:
        about = self.summary
        return html_table({"title": self.title, "state": self.state, "t": f"{about['t']:g}", "steps": str(about["steps"]),
                           "method": str(about["method"]), "state of": self._size(), "smallest value": f"{about['min_value']:g}",
                           "conservation defect": f"{about['conservation_defect']:.2g} (relative)",
                           "fields": ", ".join(self.fields)})

    def plot(self, kind: str = "fields") -> Any:
        """A Matplotlib figure: "fields" over x or t, "distribution" f(x, v) or, with several velocity dimensions, its marginal over
        v_x, "history", "probe-NAME" or "surface-NAME". Raises InputError if there is nothing to draw."""
        from .plot.results import figures  # needs Matplotlib, which runs do not
        from .plot.run_result import RunResult
        every = {"f": self.f, "x": self.x, "y": self.y, "z": self.z, "v": self.v, "v_weights": self.v_weights, "epsilon": self.epsilon, **self.axes}
        arrays = {name: value for name, value in every.items() if value.size}
        last = {name: values[-1] for name, values in self.fields.items()}
        stored = RunResult(Path("run"), {"case": self.summary.get("case", {})}, last, {**self.fields, "t": self.t}, arrays, self.history,
                           self.labels, "", self.marginals, self.probes, self.surfaces, self.walls)
        made = figures(stored)
        if kind not in made:
            raise InputError(f"unknown picture '{kind}' (this result has no such picture); valid: {', '.join(made) or 'none'}")
        return made[kind]

    def __eq__(self, other: object) -> bool:
        """Bitwise equality of everything but wall times, including NaN."""
        if not isinstance(other, Result):
            return False
        def same(a: Mapping[str, NDArray[Any]], b: Mapping[str, NDArray[Any]]) -> bool:
            return a.keys() == b.keys() and all(np.array_equal(a[name], b[name], equal_nan=a[name].dtype.kind == "f") for name in a)
        def same_tables(a: Mapping[str, Mapping[str, NDArray[Any]]], b: Mapping[str, Mapping[str, NDArray[Any]]]) -> bool:
            return a.keys() == b.keys() and all(same(a[name], b[name]) for name in a)
        arrays = ("f", "x", "y", "z", "v", "v_weights", "epsilon", "t")
        return (self.state == other.state and self.summary.get("case") == other.summary.get("case")
                and same({name: getattr(self, name) for name in arrays}, {name: getattr(other, name) for name in arrays})
                and same(self.fields, other.fields) and same(self.history, other.history)
                and same(self.axes, other.axes) and same(self.marginals, other.marginals) and same(self.walls, other.walls)
                and same_tables(self.probes, other.probes) and same_tables(self.surfaces, other.surfaces))


def cases() -> list[str]:
    """Returns the names of the built-in cases."""
    return _core.case_names()


@overload
def run(case: Case, *overrides: str, out: str | Path | None = None, restart: str | Path | None = None,
        wall: float | None = None, threads: int | None = None, device: str | int | None = None, progress: Progress | None = None,
        initial: Initial | None = None, jumps: Sequence[float] = (), comm: None = None) -> Result: ...


@overload
def run(case: Case, *overrides: str, out: str | Path | None = None, restart: str | Path | None = None,
        wall: float | None = None, threads: int | None = None, device: str | int | None = None, progress: Progress | None = None,
        initial: Initial | None = None, jumps: Sequence[float] = (), comm: Any) -> Result | None: ...


def run(case: Case, *overrides: str, out: str | Path | None = None, restart: str | Path | None = None,
        wall: float | None = None, threads: int | None = None, device: str | int | None = None, progress: Progress | None = None,
        initial: Initial | None = None, jumps: Sequence[float] = (), comm: Any = None) -> Result | None:
    """Runs a case: the name of a built-in one, a file, or a mapping such as {"model": {"name": "bgk"}, …}.

    Values of a mapping are numbers, text, lists and mappings; arrays, numbers of NumPy, tuples and paths become these.

        overrides   "key=value", such as "space.cells=80"
        out         folder for the results
        restart     checkpoint to continue from, such as "results/one/checkpoint.h5"
        wall        limit of the wall time in seconds
        progress    called as progress(step, steps, t, smallest) about 20 times a second; False ends the run, with a checkpoint in out
        initial     initial data in place of those of the case
        jumps       places at which functions of `initial` jump
        threads     0 for all processors; by default OMP_NUM_THREADS, otherwise all for a large case and 1 for a small one
        device      a device of this machine (`apsis info`) by its number or place; results have the bits of the host
        comm        communicator of mpi4py, whose processes share the mesh and call the function together; the first one gets the
                    result, the others None

    `initial` is an array [cells, components], a function that returns all components, or a mapping of the variables of the model,
    {"rho": lambda x: 1 + x, "T": 1}. The mapping has numbers, functions of the coordinates x, y, z, or arrays with a value for each
    cell. The arguments of a function of all components are the coordinates, which are numbers. In a model with a velocity grid v_x,
    v_y, v_z follow, an array [components] for each velocity dimension. The functions "f", or "g" and "h", of a mapping have the same
    arguments, with arrays [velocities], and return an array [velocities]. Functions are averaged over cells like formulas, exactly
    between their `jumps`. Results and restarts name the data `from = "python"`; a restart takes the state of the checkpoint.

    Releases the GIL. Raises InputError, NumericalError, FileError and KeyboardInterrupt, on all processes. After KeyboardInterrupt,
    and after an exception of `progress`, `out` has a checkpoint and the results so far. A warning is an ApsisWarning of the module
    `warnings`; a filter that makes it an exception ends the run as an exception of `progress` does."""
    handle = _handle(comm)
    try:
        text = CaseText(case) if isinstance(case, Mapping) else None
        warned = LibraryWarnings(text.with_keys if text is not None else lambda message: message)
        arguments = (*_arguments(case, text, overrides, out, restart, wall, threads, device, _watch(warned, progress), initial, jumps), handle)
    except Exception as problem:
        if handle is not None:
            _core.refuse_on_all(handle, str(problem))
        raise
    try:
        with warned:
            got = _core.run(*arguments)
    except InputError as problem:
        message = str(problem) if text is None else text.with_keys(str(problem))
        if message == str(problem):
            raise
        raise InputError(message) from problem.__cause__
    if got is None:
        return None
    return Result(summary=json.loads(got.pop("json")), **got)


def _arguments(case: Case, text: CaseText | None, overrides: Sequence[str], out: str | Path | None, restart: str | Path | None, wall: float | None,
               threads: int | None, device: str | int | None, progress: Progress, initial: Initial | None,
               jumps: Sequence[float]) -> tuple[Any, ...]:
    """Returns the arguments of the compiled part but the communicator. Raises InputError."""
    if not isinstance(case, (str, Path, Mapping)):
        raise InputError(f"case is {type_of(case)} (it must be a name, a file or a mapping); see apsis.cases()")
    for one in overrides:
        if not isinstance(one, str):
            raise InputError(f"override {one!r} is {type_of(one)} (it must be text); write \"key=value\"")
    everything = list(overrides) + ([] if initial is None else ["initial.from=python"])
    return (None if text is None else text.text, str(case) if text is None else "case", everything, _path(out), _path(restart),
            None if wall is None else number("wall", wall, positive=True),
            None if threads is None else whole_number("threads", threads),
            None if device is None else str(device), progress,
            dict(initial) if isinstance(initial, Mapping) else initial, sorted(number("jumps", x) for x in jumps))


def _watch(warned: LibraryWarnings, progress: Progress | None) -> Progress:
    """Returns a function that passes warnings on while the run continues, and then calls `progress`. Raises InputError."""
    if progress is not None and not callable(progress):
        raise InputError(f"progress is {type_of(progress)} (it must be callable); give a function")

    def watch(step: int, steps: int, t: float, smallest: float) -> Any:
        warned.pass_on()
        return None if progress is None else progress(step, steps, t, smallest)

    return watch


def _handle(comm: Any) -> int | None:
    if comm is None:
        return None
    if not hasattr(comm, "py2f"):
        raise InputError(f"comm is {type_of(comm)} (it must be a communicator of mpi4py); give MPI.COMM_WORLD")
    return int(comm.py2f())


def _path(path: str | Path | None) -> str | None:
    return None if path is None else str(path)
