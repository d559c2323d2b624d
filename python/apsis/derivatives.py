"""Derivatives of functions of arrays: given ones, complex steps and differences."""
from __future__ import annotations

import warnings
from functools import partial
from typing import Any, Callable, Iterable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import InputError

Array = NDArray[np.float64]


class Derivatives:
    """Q'(u) x and Q''(u)[k, x] of a function of arrays of one shape.

    by      "jacobian", "complex steps" or "finite differences"

    A jacobian returns an array or a sparse matrix. `columns`, a function of arrays of shape (n, k) for u of shape (n,), gives all
    columns of Q' in one call. The kind of derivatives is found at u, and at `others` if there are any. With `rows`, u is an array of m points, of shape (m, n), to which Q applies one by one; a jacobian
    then returns an array of shape (m, n, n).
    """

    def __init__(self, collision: Callable[[Array], ArrayLike], jacobian: Callable[[Array], Any] | None, u: Array,
                 columns: Callable[[Array], ArrayLike] | None = None, rows: bool = False, others: Iterable[Array] = ()) -> None:
        self._collision, self._jacobian, self._columns, self._rows = collision, jacobian, columns, rows
        self._known: tuple[bytes, Any] | None = None
        self.by = "jacobian" if jacobian is not None else "complex steps" if all(map(self._is_analytic, (u, *others))) else "finite differences"

    def product(self, u: Array, x: Array) -> Array:
        """Returns Q'(u) x."""
        if not np.any(x):
            return np.zeros(u.shape)
        if self._jacobian is not None or self._columns is not None:
            return np.asarray(self.matrix(u) @ x[..., None] if self._rows else self.matrix(u) @ x.ravel()).reshape(u.shape)
        return self._complex_step(u, x) if self.by == "complex steps" else self.difference(u, x)

    def curvature(self, u: Array, k: Array, x: Array) -> Array:
        """Returns Q''(u)[k, x] to a few digits."""
        if not np.any(k) or not np.any(x):
            return np.zeros(u.shape)
        h = _length(u, k, 1e-3 if self.by == "finite differences" else 1e-5, self._rows)
        return (self.product(u + h * k, x) - self.product(u - h * k, x)) / (2 * h)

    def matrix(self, u: Array) -> Any:
        """Returns Q'(u), for u of n numbers an array or a sparse matrix of shape (n, n), and keeps it until u is another."""
        key = u.tobytes()
        if self._known is None or self._known[0] != key:
            self._known = key, self._all_columns(u) if self._jacobian is None else self._given(self._jacobian(_fixed(u)), u)
        return self._known[1]

    def forget(self) -> None:
        """Evaluates the next matrix again, because Q has changed."""
        self._known = None

    def _given(self, found: Any, u: Array) -> Any:
        return as_matrices("jacobian returned", found, *u.shape) if self._rows else as_square_matrix("jacobian returned", found, u.size)

    def _all_columns(self, u: Array) -> Array:
        assert self._columns is not None
        if self.by == "complex steps":
            h = 1e-30 * max(_size(u), 1e-200)
            return np.imag(np.asarray(self._columns(_fixed(u[:, None] + 1j * h * np.eye(u.size))))) / h
        steps = 6e-6 * np.maximum(np.abs(u), 1e-6 * (_size(u) or 1.0))
        upper, lower = (np.asarray(self._columns(_fixed(u[:, None] + sign * np.diag(steps))), dtype=np.float64) for sign in (1, -1))
        return (upper - lower) / (2 * steps)

    def _complex_step(self, u: Array, x: Array) -> Array:
        h = 1e-30 * np.maximum(_sizes(u, self._rows), 1e-200) / _or_one(_sizes(x, self._rows))
        return np.asarray(np.imag(np.asarray(self._collision(_fixed(u + 1j * h * x)))) / h)

    def difference(self, u: Array, x: Array) -> Array:
        """Returns Q'(u) x by a central difference, to about ten digits."""
        h = _length(u, x, 6e-6, self._rows)
        return (np.asarray(self._collision(_fixed(u + h * x)), dtype=np.float64) -
                np.asarray(self._collision(_fixed(u - h * x)), dtype=np.float64)) / (2 * h)

    def _is_analytic(self, u: Array) -> bool:
        """Whether complex steps work, and agree with differences in two directions that excite every unknown."""
        found = self._collision(_fixed(u))  # its own exceptions come from real numbers
        try:
            if found is None or np.shape(found) != u.shape:
                return False  # refused at its first use
        except ValueError:
            return False
        for x in _directions(u, self._rows):
            try:
                with np.errstate(all="ignore"), warnings.catch_warnings():
                    warnings.simplefilter("error")  # an imaginary part that is cut off is a warning of NumPy
                    exact = self._complex_step(u, x)
            except Exception:  # noqa: BLE001 - whatever a function for real numbers does with complex ones
                return False
            near = self.difference(u, x)
            sizes = 1e-4 * _sizes(near, self._rows) + 1e-7 * _sizes(exact, self._rows) if exact.shape == u.shape else 0.0
            if exact.shape != u.shape or not np.all(np.abs(exact - near) <= sizes):
                return False
        return True


class CellDerivatives:
    """Q'(u) x and Q''(u)[k, x] of cells, for a function collision(u, cells) of u of shape (m, n) and of the indices of m cells."""

    def __init__(self, collision: Callable[[Array, Any], ArrayLike], jacobian: Callable[[Array, Any], Any] | None, u: Array) -> None:
        self._cells = some_cells(len(u))
        given = partial(self._call, jacobian) if jacobian else None
        self._of_cells = Derivatives(partial(self._call, collision), given, u[self._cells], rows=True)

    @property
    def by(self) -> str:
        """How derivatives are evaluated."""
        return self._of_cells.by

    def product(self, u: Array, x: Array, cells: Any) -> Array:
        """Returns Q'(u) x."""
        return self._at(cells).product(u, x)

    def curvature(self, u: Array, k: Array, x: Array, cells: Any) -> Array:
        """Returns Q''(u)[k, x] to a few digits."""
        return self._at(cells).curvature(u, k, x)

    def _call(self, function: Callable[[Array, Any], Any], u: Array) -> Any:
        return function(u, self._cells)

    def _at(self, cells: Any) -> Derivatives:
        if not np.array_equal(cells, self._cells):
            self._cells = cells
            self._of_cells.forget()
        return self._of_cells


class TimedDerivatives:
    """Q'(t, u) x, Q''(t, u)[k, x] and ∂Q(t, u)/∂t of a function of time and of arrays of one shape.

    `interval`: times at which Q may be called."""

    def __init__(self, collision: Callable[[Any, Array], ArrayLike], jacobian: Callable[[float, Array], Any] | None, u: Array,
                 interval: tuple[float, float], columns: Callable[[float, Array], ArrayLike] | None = None) -> None:
        self._collision, self._interval, self._t = collision, interval, interval[0]
        self._at = Derivatives(lambda v: collision(self._t, v), self._now(jacobian), u, self._now(columns))
        self._complex_time = self._is_analytic_in_time(u)

    @property
    def by(self) -> str:
        """How derivatives by u are evaluated."""
        return self._at.by

    def error_of_jacobian(self, u: Array) -> float:
        """Returns how much products with a given jacobian at the start differ from differences, relative to these."""
        at = self._at_time(self._interval[0])
        return max((_size(at.product(u, x) - near) / (_size(near) or 1.0) for x in _directions(u) for near in [at.difference(u, x)]))

    def product(self, t: float, u: Array, x: Array) -> Array:
        """Returns Q'(t, u) x."""
        return self._at_time(t).product(u, x)

    def curvature(self, t: float, u: Array, k: Array, x: Array) -> Array:
        """Returns Q''(t, u)[k, x] to a few digits."""
        return self._at_time(t).curvature(u, k, x)

    def time_derivative(self, t: float, u: Array) -> Array:
        """Returns ∂Q(t, u)/∂t, by a complex step where that agrees with differences at the start."""
        return self._complex_step(t, u) if self._complex_time else self._difference(t, u)

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


def some_cells(count: int) -> NDArray[np.int64]:
    """Returns the indices of up to 64 cells, at which the kind of derivatives is found."""
    return np.unique(np.linspace(0, count - 1, 64).astype(np.int64))


def as_square_matrix(subject: str, found: Any, n: int) -> Any:
    """`found`, an array or a sparse matrix, as one of n × n real numbers. Raises InputError if it is not: "{subject} an array of …"."""
    if not hasattr(found, "tocsr"):
        found = np.asarray(found)
    if found.dtype.kind not in "biuf" or (found.shape != (n, n) and (hasattr(found, "tocsr") or n > 1 or found.size != 1)):
        raise InputError(f"{subject} an array of shape {found.shape} and type {found.dtype} (real numbers of shape ({n}, {n}) are needed); "
                         "give such")
    return found.tocsr().astype(np.float64) if hasattr(found, "tocsr") else found.astype(np.float64).reshape(n, n)


def as_matrices(subject: str, found: Any, m: int, n: int) -> Array:
    """`found` as m matrices of n × n real numbers. Raises InputError if it is not: "{subject} an array of …"."""
    matrices = np.asarray(found)
    if matrices.dtype.kind not in "biuf" or matrices.shape != (m, n, n):
        raise InputError(f"{subject} an array of shape {matrices.shape} and type {matrices.dtype} (real numbers of shape ({m}, {n}, {n}) "
                         "are needed, a matrix for each cell); give such")
    return matrices.astype(np.float64)


def _directions(u: Array, rows: bool = False) -> tuple[Array, Array]:
    """Returns two directions that change every unknown in proportion to its size."""
    scales = np.where(u != 0, np.abs(u), _or_one(_sizes(u, rows)))
    angles = np.arange(1, u.size + 1).reshape(u.shape)
    return scales * np.sin(angles), scales * np.cos(3 * angles)


def _fixed(u: Any) -> Any:
    u.setflags(write=False)
    return u


def _size(u: Array) -> float:
    return float(np.max(np.abs(u), initial=0.0))


def _sizes(u: Array, rows: bool) -> Array:
    """Returns the largest absolute value, or with `rows` the column of those of the rows."""
    return np.asarray(np.max(np.abs(u), axis=-1 if rows else None, keepdims=rows, initial=0.0), dtype=np.float64)


def _or_one(sizes: Array) -> Array:
    return np.where(sizes > 0.0, sizes, 1.0)


def _length(u: Array, x: Array, part: float, rows: bool = False) -> Array:
    """Returns the step h with which u + hx changes every component by at most `part` of itself, or 1e-6 of the largest where it is smaller.

    With `rows` it returns the column of the steps of the rows. Where x is zero, the step is of no importance."""
    least = np.maximum(np.abs(u), 1e-6 * _or_one(_sizes(u, rows)))
    with np.errstate(over="ignore", divide="ignore"):  # of quotients by tiny or no changes, which larger ones bound
        steps = least / np.abs(x)
    h = np.min(steps, axis=-1 if rows else None, keepdims=rows)
    return np.where(np.isfinite(h), part * h, 1.0)
