"""Derivatives of functions of arrays: given ones, complex steps and differences."""
from __future__ import annotations

import warnings
from functools import partial
from typing import Any, Callable, Iterable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .derivative_checks import ComplexStepCheck
from .errors import InputError

Array = NDArray[np.float64]


class Derivatives:
    """Q'(u) x and Q''(u)[k, x] of a function of arrays of one shape.

    by      "jacobian", "complex steps" or "finite differences"

    A jacobian returns an array or a sparse matrix. `columns`, a function of arrays of shape (n, k) for u of shape (n,), gives all
    columns of Q' in one call. The kind of derivatives is found at u, and at `others` if there are any. `check` chooses later states at
    which complex steps are compared with differences. With `rows`, u is an array of m points, of shape (m, n), to which Q applies one by
    one; a jacobian then returns an array of shape (m, n, n).
    """

    def __init__(self, collision: Callable[[Array], ArrayLike], jacobian: Callable[[Array], Any] | None, u: Array,
                 columns: Callable[[Array], ArrayLike] | None = None, rows: bool = False, others: Iterable[Array] = (),
                 check: ComplexStepCheck | None = None) -> None:
        self._collision, self._jacobian, self._columns, self._rows = collision, jacobian, columns, rows
        self._known: tuple[bytes, Any] | None = None
        self.check = check or ComplexStepCheck(_first_check(u))
        self.by = "jacobian" if jacobian is not None else "complex steps" if all(map(self._is_analytic, (u, *others))) else "finite differences"

    def product(self, u: Array, x: Array) -> Array:
        """Returns Q'(u) x."""
        if not np.any(x):
            return np.zeros(u.shape)
        if self._jacobian is not None or self._columns is not None:
            return np.asarray(self.matrix(u) @ x[..., None] if self._rows else self.matrix(u) @ x.ravel()).reshape(u.shape)
        if self.by == "complex steps" and self.check.is_due():
            self.compare(u)
        if self.by == "complex steps":
            try:
                return self._complex_step(u, x)
            except Exception:  # noqa: BLE001 - whatever a function for real numbers does with complex ones
                self._collision(_fixed(u))  # its own exceptions come from real numbers
                self._fail(wrong=False)
        return self.difference(u, x)

    def compare(self, u: Array) -> None:
        """Compares a complex step with differences at u, in a direction that excites every unknown. Continues with differences if they
        differ, and then warns or raises NotAnalytic. Differences that cannot be computed, or those across a kink, decide nothing."""
        x = _directions(u, self._rows)[self.check.checks % 2]
        try:
            with np.errstate(all="ignore"):
                exact = self._complex_step(u, x)
                h, upper, lower = self._two_sides(u, x)
                near = (upper - lower) / (2 * h)
                rounding = 16 * np.finfo(np.float64).eps * _sizes(upper, self._rows) / h
                same = np.abs(exact - near) <= 1e-4 * _sizes(near, self._rows) + 1e-7 * _sizes(exact, self._rows) + rounding
                if np.all(same) or self.bends(np.asarray(self._collision(_fixed(u)), dtype=np.float64), upper, lower):
                    return
        except Exception:  # noqa: BLE001 - u ± hx may be outside of the states for which Q is defined
            return
        if np.all(np.isfinite(near)):
            self._fail()

    def use_differences(self) -> None:
        """Replaces complex steps by differences."""
        if self.by == "complex steps":
            self.by = "finite differences"
            self.forget()

    def _fail(self, wrong: bool = True) -> None:
        self.use_differences()
        self.check.fail(wrong)

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
            if self.by == "complex steps" and self.check.is_due():
                self.compare(u)
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
            try:
                return np.imag(np.asarray(self._columns(_fixed(u[:, None] + 1j * h * np.eye(u.size))))) / h
            except Exception:  # noqa: BLE001 - whatever a function for real numbers does with complex ones
                self._collision(_fixed(u))  # its own exceptions come from real numbers
                self._fail(wrong=False)
        steps = 6e-6 * np.maximum(np.abs(u), 1e-6 * (_size(u) or 1.0))
        upper, lower = (np.asarray(self._columns(_fixed(u[:, None] + sign * np.diag(steps))), dtype=np.float64) for sign in (1, -1))
        return (upper - lower) / (2 * steps)

    def _complex_step(self, u: Array, x: Array) -> Array:
        h = 1e-30 * np.maximum(_sizes(u, self._rows), 1e-200) / _or_one(_sizes(x, self._rows))
        return np.asarray(np.imag(np.asarray(self._collision(_fixed(u + 1j * h * x)))) / h)

    def difference(self, u: Array, x: Array) -> Array:
        """Returns Q'(u) x by a central difference, to about ten digits."""
        h, upper, lower = self._two_sides(u, x)
        return (upper - lower) / (2 * h)

    def _two_sides(self, u: Array, x: Array, part: float = 6e-6) -> tuple[Array, Array, Array]:
        """Returns h, Q(u + hx) and Q(u − hx)."""
        h = _length(u, x, part, self._rows)
        return (h, np.asarray(self._collision(_fixed(u + h * x)), dtype=np.float64),
                np.asarray(self._collision(_fixed(u - h * x)), dtype=np.float64))

    def _has_kink(self, u: Array, x: Array, at: Array, upper: Array, lower: Array) -> bool:
        """Whether Q has a kink at u, such as abs at 0, where a central difference agrees with a derivative that does not exist. `at` is Q(u),
        `upper` and `lower` are values of _two_sides(). The second difference of a kink is proportional to h, otherwise to h²."""
        if not self.bends(at, upper, lower):
            return False
        before = np.max(np.abs(upper - 2 * at + lower))
        _, upper, lower = self._two_sides(u, x, 1.5e-6)
        return self.bends(at, upper, lower) and bool(np.max(np.abs(upper - 2 * at + lower)) > before / 8)

    def bends(self, at: Array, upper: Array, lower: Array) -> bool:
        """Whether the changes of Q from lower over at to upper differ by more than smooth functions and rounding allow."""
        rounding = 8 * np.finfo(np.float64).eps * _sizes(at, self._rows)
        change = _sizes(np.maximum(np.abs(upper - at), np.abs(at - lower)), self._rows)
        return bool(np.any(np.abs(upper - 2 * at + lower) > 1e-2 * change + rounding))

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
            h, upper, lower = self._two_sides(u, x)
            near = (upper - lower) / (2 * h)
            sizes = 1e-4 * _sizes(near, self._rows) + 1e-7 * _sizes(exact, self._rows) if exact.shape == u.shape else 0.0
            if exact.shape != u.shape or not np.all(np.abs(exact - near) <= sizes) or self._has_kink(
                    u, x, np.asarray(found, dtype=np.float64), upper, lower):
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

    @property
    def check(self) -> ComplexStepCheck:
        """The checks of complex steps."""
        return self._of_cells.check

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


def _first_check(u: Array) -> int:
    """The first product that is checked: after those of the first matrix, which are at the start."""
    return min(u.size, 8) + 1


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
