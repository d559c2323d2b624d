"""Derivatives of functions of time and of arrays."""
from __future__ import annotations

import warnings
from functools import partial
from typing import Any, Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .derivative_checks import ComplexStepCheck
from .derivatives import Derivatives, _directions, _first_check, _fixed, _size

Array = NDArray[np.float64]


class TimedDerivatives:
    """Q'(t, u) x, Q''(t, u)[k, x] and ∂Q(t, u)/∂t of a function of time and of arrays of one shape.

    `interval`: times at which Q may be called."""

    def __init__(self, collision: Callable[[Any, Array], ArrayLike], jacobian: Callable[[float, Array], Any] | None, u: Array,
                 interval: tuple[float, float], columns: Callable[[float, Array], ArrayLike] | None = None) -> None:
        self._collision, self._interval, self._t = collision, interval, interval[0]
        self._last: tuple[float, Array] | None = None
        self.check, self._check_in_time = (ComplexStepCheck(first, self._place, "jac") for first in (_first_check(u), 1))
        self._at = Derivatives(lambda v: collision(self._t, v), self._now(jacobian), u, self._now(columns), check=self.check)
        self._complex_time = self._is_analytic_in_time(u)

    @property
    def by(self) -> str:
        """How derivatives by u are evaluated."""
        return self._at.by

    def restart_if_wrong(self, restarts: bool) -> None:
        """Sets whether derivatives are a part of the solution, so that wrong ones raise NotAnalytic."""
        self.check.restarts = self._check_in_time.restarts = restarts

    def compare_again(self) -> None:
        """Compares complex steps with differences at the last state."""
        if self._last is not None and self.by == "complex steps":
            self._at_time(self._last[0]).compare(self._last[1])

    @property
    def kinds(self) -> tuple[bool, bool]:
        """Whether derivatives by u and by t are complex steps."""
        return self.by == "complex steps", self._complex_time

    def use_at_most(self, kinds: tuple[bool, bool]) -> None:
        """Replaces complex steps by differences where they are not among the `kinds`."""
        if not kinds[0]:
            self._at.use_differences()
        self._complex_time = self._complex_time and kinds[1]

    def _place(self) -> str:
        return f" at t = {self._t:g}"

    def error_of_jacobian(self, u: Array) -> float:
        """Returns how much products with a given jacobian at the start differ from differences, relative to these."""
        at = self._at_time(self._interval[0])
        return max((_size(at.product(u, x) - near) / (_size(near) or 1.0) for x in _directions(u) for near in [at.difference(u, x)]))

    def product(self, t: float, u: Array, x: Array) -> Array:
        """Returns Q'(t, u) x."""
        self._last = t, u
        return self._at_time(t).product(u, x)

    def curvature(self, t: float, u: Array, k: Array, x: Array) -> Array:
        """Returns Q''(t, u)[k, x] to a few digits."""
        return self._at_time(t).curvature(u, k, x)

    def time_derivative(self, t: float, u: Array) -> Array:
        """Returns ∂Q(t, u)/∂t, by a complex step where that agrees with differences."""
        self._at_time(t)
        if self._complex_time and self._check_in_time.is_due() and not self._agrees_in_time(t, u):
            self._complex_time = False
            self._check_in_time.fail()
        if self._complex_time:
            try:
                return self._complex_step(t, u)
            except Exception:  # noqa: BLE001 - whatever a function for real numbers does with a complex one
                self._collision(t, _fixed(u.copy()))  # its own exceptions come from real numbers
                self._complex_time = False
                self._check_in_time.fail(wrong=False)
        return self._difference(t, u)

    def _agrees_in_time(self, t: float, u: Array) -> bool:
        """Whether a complex step agrees with differences. Differences that cannot be computed, or those across a jump, decide nothing."""
        h = 6e-6 * self._scale(t)
        if t - h < self._interval[0] or t + h > self._interval[1]:
            return True
        try:
            with np.errstate(all="ignore"):
                exact = self._complex_step(t, u)
                lower, at, upper = (np.asarray(self._collision(one, _fixed(u.copy())), dtype=np.float64) for one in (t - h, t, t + h))
                near, rounding = (upper - lower) / (2 * h), 16 * np.finfo(np.float64).eps * _size(at) / h
                same = np.abs(exact - near) <= 1e-4 * _size(near) + 1e-7 * _size(exact) + rounding
        except Exception:  # noqa: BLE001 - Q may not be defined there
            return True
        return bool(np.all(same)) or not np.all(np.isfinite(near)) or self._at.bends(at, upper, lower)

    def _now(self, function: Callable[[float, Array], Any] | None) -> Callable[[Array], Any] | None:
        return None if function is None else partial(self._call, function)

    def _call(self, function: Callable[[float, Array], Any], u: Array) -> Any:
        return function(self._t, u)

    def _at_time(self, t: float) -> Derivatives:
        if t != self._t:
            self._t = t
            self._at.forget()
        return self._at

    def _scale(self, t: float) -> float:
        return max(abs(t), min(1.0, self._interval[1] - self._interval[0]))

    def _complex_step(self, t: float, u: Array) -> Array:
        h = 1e-30 * self._scale(t)
        return np.asarray(np.imag(np.asarray(self._collision(complex(t, h), _fixed(u.copy())))) / h)

    def _difference(self, t: float, u: Array) -> Array:
        """Returns a difference of second order, one-sided at the ends of the interval."""
        h = 6e-6 * self._scale(t)
        first, last = self._interval
        shifts, weights = (((0, 1, 2), (-1.5, 2.0, -0.5)) if t - h < first else
                           ((0, -1, -2), (1.5, -2.0, 0.5)) if t + h > last else ((1, -1), (0.5, -0.5)))
        values = [np.asarray(self._collision(t + k * h, _fixed(u.copy())), dtype=np.float64) for k in shifts]
        return np.asarray(sum(w * value for w, value in zip(weights, values)) / h)

    def _is_analytic_in_time(self, u: Array) -> bool:
        try:
            with np.errstate(all="ignore"), warnings.catch_warnings():
                warnings.simplefilter("error")
                exact = self._complex_step(self._interval[0], u)
        except Exception:  # noqa: BLE001 - whatever a function for real numbers does with a complex one
            return False
        near = self._difference(self._interval[0], u)
        return exact.shape == u.shape and bool(np.all(np.abs(exact - near) <= 1e-4 * _size(near) + 1e-7 * _size(exact)))
