"""Runs of cases, the same as those of `apsis run`."""
from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable, Union

import numpy as np
from numpy.typing import NDArray

from . import _core

Array = NDArray[np.float64]
Case = Union[str, Path, Mapping[str, Any]]
Progress = Callable[[int, int, float, float], Any]


@dataclass(frozen=True)
class Result:
    """What a run computed. Arrays are not copied.

    f[cell, component] is the state at the end, x the cell centres, v the speeds of the components, epsilon the Knudsen number at
    the centres (empty where the model has none). fields[name][k, cell] are the macroscopic fields at the times t[k], the last
    of which is the end. history[name][n] is what was checked after step n. summary has the keys of `apsis run --json`, state how
    the run ended."""

    state: str
    f: Array
    x: Array
    v: Array
    epsilon: Array
    t: Array
    fields: dict[str, Array]
    history: dict[str, Array]
    summary: dict[str, Any]


def cases() -> list[str]:
    """Names of the built-in cases."""
    return _core.case_names()


def run(case: Case, *overrides: str, out: str | Path | None = None, restart: str | Path | None = None,
        wall: float | None = None, threads: int | None = None, progress: Progress | None = None) -> Result:
    """Runs a case: the name of a built-in one, a file, or a mapping such as {"model": {"name": "bgk"}, …}.

    overrides are "key=value" ("space.cells=80"). `out` is a folder for the results, `restart` a checkpoint to go on from, `wall`
    a limit in seconds. progress(step, steps, t, smallest) is called now and then; False ends the run, with a checkpoint in
    `out`. `threads`: 0 stands for all processors; without it OMP_NUM_THREADS, or all for a large case and 1 for a small one.
    Other threads of Python run meanwhile. Raises InputError, NumericalError, FileError, KeyboardInterrupt."""
    text = to_toml(case) if isinstance(case, Mapping) else None
    got = _core.run(text, "case" if text is not None else str(case), list(overrides), _path(out), _path(restart), wall, threads,
                    progress)
    return Result(summary=json.loads(got.pop("json")), **got)


def to_toml(case: Mapping[str, Any]) -> str:
    """The case as the text of a case file."""
    plain = [f"{key} = {_value(value)}" for key, value in case.items() if not isinstance(value, Mapping)]
    sections = [f"[{key}]\n" + "\n".join(f"{name} = {_value(x)}" for name, x in value.items())
                for key, value in case.items() if isinstance(value, Mapping)]
    return "\n".join(plain + sections) + "\n"


def _value(x: Any) -> str:
    if isinstance(x, (bool, np.bool_)):
        return "true" if x else "false"
    if isinstance(x, (int, np.integer)):
        return str(int(x))
    if isinstance(x, (float, np.floating)):
        return repr(float(x))
    if isinstance(x, (list, tuple, np.ndarray)):
        return "[" + ", ".join(_value(one) for one in x) + "]"
    return json.dumps(str(x), ensure_ascii=False)


def _path(path: str | Path | None) -> str | None:
    return None if path is None else str(path)
