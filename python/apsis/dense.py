"""The solution of solve_ivp inside its steps."""
from __future__ import annotations

from typing import Any, Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from .methods import Method
from .system import System

Array = NDArray[np.float64]


class Steps:
    """Makes steps of a method for a problem. It can be pickled if the functions of the problem can be: a copy makes the same steps, bit for bit.

    `arguments` are those of the compiled evolution after the method, without those of events."""

    def __init__(self, problem: System, method: Method, arguments: tuple[Any, ...], evolution: Any = None) -> None:
        self._problem, self._method, self._arguments, self._evolution = problem, method, arguments, evolution

    def from_beginning(self, t0: float, y0: Array, t: float) -> Array:
        """Returns the result of one step from (t0, y0) to t."""
        if self._evolution is None:
            self._evolution = _core.Evolution(self._problem, self._method._core, *(*self._arguments, [], []))
        return np.array(self._evolution.step_from(t0, y0, t))

    def __reduce__(self) -> tuple[Callable[..., Steps], tuple[Any, ...]]:
        return Steps, (self._problem, self._method, self._arguments)


class StepOutput:
    """The solution inside a step, an interpolant of scipy.integrate.OdeSolution: a function of a time or of an array of times."""

    def __init__(self, steps: Steps, t_old: float, y_old: Array, t: float, y: Array) -> None:
        self.t_old, self.t, self.t_min, self.t_max = t_old, t, t_old, t
        self._steps, self._before, self._after = steps, y_old, y

    def __call__(self, t: ArrayLike) -> Array:
        """Returns y(t) of shape (n,), or (n, k) for k times. Equal times cost one step."""
        times = np.asarray(t, dtype=np.float64)
        if times.ndim == 0:
            return self._at(float(times))
        different, places = np.unique(times, return_inverse=True)
        found = np.empty((different.size, self._after.size))
        for k, one in enumerate(different.tolist()):
            found[k] = self._at(one)
        return found[places].T

    def _at(self, t: float) -> Array:
        return self._after.copy() if t == self.t else self._steps.from_beginning(self.t_old, self._before, t)
