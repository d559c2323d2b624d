"""Runs of solve_ivp: their records, restarts with other derivatives, and smaller tolerances until the result is accurate."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Callable

import numpy as np
from numpy.typing import NDArray

from . import _core
from .dense import StepOutput, Steps
from .derivative_checks import NotAnalytic
from .errors import NumericalError
from .system import System

Array = NDArray[np.float64]
Function = Callable[..., Any]


class Record:
    """The times and states of a result, and its dense output, collected step by step."""

    def __init__(self, evolution: Any, wanted: list[float] | None, inside: Steps | None, t0: float, y0: Array) -> None:
        self._evolution, self._wanted, self._inside = evolution, wanted, inside
        self.t: list[float] = [t0] if wanted is None or wanted[:1] == [t0] else []
        self.y: list[Array] = [y0] if self.t else []
        self.ends, self.steps = [t0], list[StepOutput]()
        self._before = y0
        self.follows_times = wanted is not None

    def add_step(self) -> None:
        """Adds the last step of the evolution."""
        begin, t, y = self._evolution.begin_of_step, self._evolution.t, self._evolution.u
        if self._inside is not None:
            self.ends.append(t)
            self.steps.append(StepOutput(self._inside, begin, self._before, t, y))
            self._before = y
        if self._wanted is None:
            self.t.append(t)
            self.y.append(y)
            return
        for x in self._wanted[len(self.t):]:
            if x > t:
                break
            self.t.append(x)
            self.y.append(self._evolution.at(x))


def march_to_end(evolution: Any, record: Record, span: tuple[float, float], start: Array, events: list[Function]) -> tuple[int, str]:
    """Advances to the end, to the last event or to a failure; returns status and message."""
    evolution.start(span[0], start.tolist())
    try:
        while evolution.advance(span[1], record.add_step):
            last = evolution.found[-1][0]
            if sum(k == last for k, _, _ in evolution.found) >= endings_of(events[last]):
                return 1, f"event {last} ended the integration"
    except NumericalError as failure:
        return -1, str(failure)
    return 0, "the end of the interval was reached"


@dataclass
class Run:
    """An integration, and how it ended."""
    evolution: Any
    record: Record
    status: int
    message: str


def run_until_accurate(march: Callable[[float], Run], problem: System, relative: list[float],
                       absolute: list[float]) -> tuple[list[Run], dict[str, float]]:
    """Returns all runs until the last one is accurate, and its estimated error."""
    runs: list[Run] = []

    def solve(factor: float) -> Run:
        runs.append(run_with_restarts(lambda: march(factor), problem))
        if runs[-1].status < 0:
            raise NumericalError(runs[-1].message)
        return runs[-1]

    def difference(coarse: Run, fine: Run) -> float:
        return max(_in_tolerances(u, v, relative, absolute) for u, v in _pairs(coarse, fine))

    try:
        _, factor, error = _core.refine_until_accurate(solve, difference)
    except NumericalError as failure:
        runs[-1].status, runs[-1].message = -1, str(failure)
        return runs, {}
    return runs, {"error": error, "refined": factor}


def _pairs(coarse: Run, fine: Run) -> list[tuple[Array, Array]]:
    """The values of two runs that are compared: those at the same t_eval and at the end."""
    at_times = list(zip(coarse.record.y, fine.record.y)) if coarse.record.follows_times else []
    return [*at_times, (coarse.evolution.u, fine.evolution.u)]


def _in_tolerances(u: Array, v: Array, relative: list[float], absolute: list[float]) -> float:
    change, scale = np.abs(u - v), np.asarray(relative) * np.maximum(np.abs(u), np.abs(v)) + np.asarray(absolute)
    return float(np.max(np.divide(change, scale, out=np.zeros_like(change), where=change > 0)))


def run_with_restarts(march: Callable[[], Run], problem: System) -> Run:
    """Returns what march() returns with derivatives that are right, as far as checks of complex steps show it."""
    while True:  # derivatives by y and by t may each become differences, once
        try:
            found = march()
            if found.status < 0 and problem.compare_again():
                continue
            return found
        except NotAnalytic:
            continue


def endings_of(event: Function) -> int:
    """The number of zeros of an event after which the integration ends; 0: it never does."""
    return int(getattr(event, "terminal", False) or 0)
