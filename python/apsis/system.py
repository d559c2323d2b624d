"""Systems y' = T(t, y) + Q(t, y) of functions in the form of SciPy, for the compiled part."""
from __future__ import annotations

from functools import partial
from typing import Any, Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from .arguments import type_of
from .derivatives import as_square_matrix
from .errors import InputError
from .timed_derivatives import TimedDerivatives

Array = NDArray[np.float64]
Function = Callable[..., Any]


class System:
    """The functions of a problem, None where one is missing, with the numbers of their calls.

    nfev     calls of transport and collision
    njev     calls of a Jacobian function
    places   (n, [(row, column), …]): where Q' may differ from 0; None: anywhere
    by       "jacobian", "complex steps", "finite differences"; "" without Q
    """

    def __init__(self, transport: Function | None, collision: Function | None, forward_euler_step: Function | None,
                 admissible: Function | None, events: Sequence[Function], args: tuple[Any, ...], vectorized: bool,
                 preconditioner: Function | None = None) -> None:
        self._functions = (transport, collision, forward_euler_step, admissible)
        self._prepared: tuple[Any, ...] = ()
        for name, function in (("transport", transport), ("collision", collision), ("forward_euler_step", forward_euler_step),
                               ("admissible", admissible)):
            if function is not None and not callable(function):
                raise InputError(f"{name} is {type_of(function)} (it must be callable); give a function or None")
        self.preconditioner = None if preconditioner is None else partial(self._call_with_shift, preconditioner)
        self._preconditioner = preconditioner
        self.nfev = self.njev = 0
        self.places: tuple[int, list[tuple[int, int]]] | None = None
        self._args, self._vectorized, self._of_columns = args, vectorized, collision
        self._pattern: Any = None
        self._derivatives: TimedDerivatives | None = None
        self.transport, self.collision = self._counted(transport), self._counted(collision)
        self.forward_euler_step, self.admissible = None if forward_euler_step is None else partial(self._call, forward_euler_step), admissible
        self.events = None if not events else lambda t, y: np.array([_one_number(k, e(t, y, *args)) for k, e in enumerate(events)])

    def prepare(self, interval: tuple[float, float], y0: Array, jac: Any, sparsity: Any) -> None:
        """Sets up the derivatives of Q. Raises InputError if jac or sparsity cannot be used."""
        self._prepared = (interval, y0, jac, sparsity)
        if self.collision is None:
            if jac is not None or sparsity is not None:
                raise InputError("jac or jac_sparsity is given without collision (they are those of Q); remove it, or give collision")
            return
        if sparsity is not None:
            self._restrict_to(as_square_matrix("jac_sparsity is", sparsity, y0.size))
        jacobian = self._jacobian(jac, interval[0], y0)
        columns = self._all_columns if self._vectorized and self._pattern is None else None
        self._derivatives = TimedDerivatives(self.collision, jacobian, y0, interval, columns)

    @property
    def by(self) -> str:
        """How derivatives of Q are evaluated."""
        return "" if self._derivatives is None else self._derivatives.by

    def restart_if_wrong(self, restarts: bool) -> None:
        """Sets whether wrong derivatives raise NotAnalytic, because they are a part of the solution."""
        if self._derivatives is not None:
            self._derivatives.restart_if_wrong(restarts)

    def compare_again(self) -> bool:
        """Compares complex steps with differences at the last state. Returns whether derivatives are differences since then."""
        before = self.by
        if self._derivatives is not None:
            self._derivatives.compare_again()
        return self.by != before

    def __reduce__(self) -> tuple[Callable[..., System], tuple[Any, ...]]:
        """Copies the functions without events. The copy prepares its derivatives again."""
        return _copy, (self._functions, self._args, self._vectorized, self._preconditioner, self._prepared,
                       None if self._derivatives is None else self._derivatives.kinds)

    def require_exact(self, y0: Array, method: str) -> None:
        """Raises InputError unless jac agrees with differences of collision, for methods whose solutions depend on Q'."""
        if self.by != "jacobian" or self._derivatives is None:
            return
        worst = self._derivatives.error_of_jacobian(y0)
        if worst > 1e-2:  # a wrong entry, not an error of differences
            raise InputError(f"jac is not the derivative of collision at the start (a product with it differs by {worst:.1e} of its "
                             f"size, and Q'Q is a part of the solution of '{method}'); mend or remove jac, or choose a method without "
                             "second derivatives, such as extrapolated-euler-5")

    def product(self, t: float, y: Array, x: Array) -> Array:
        """Returns ∂Q/∂y x."""
        return np.zeros(y.shape) if self._derivatives is None else self._derivatives.product(t, y, x)

    def curvature(self, t: float, y: Array, k: Array, x: Array) -> Array:
        """Returns ∂²Q/∂y² [k, x] to a few digits."""
        return np.zeros(y.shape) if self._derivatives is None else self._derivatives.curvature(t, y, k, x)

    def time_derivative(self, t: float, y: Array) -> Array:
        """Returns ∂Q/∂t."""
        return np.zeros(y.shape) if self._derivatives is None else self._derivatives.time_derivative(t, y)

    def _counted(self, function: Function | None) -> Function | None:
        return None if function is None else partial(self._call_counted, function)

    def _call_counted(self, function: Function, t: Any, y: Array) -> Any:
        self.nfev += 1
        if not self._vectorized:
            return function(t, y, *self._args)
        found = function(t, y[:, None], *self._args)
        return np.asarray(found)[:, 0] if np.shape(found) == (y.size, 1) else found

    def _call(self, function: Function, t: float, y: Array) -> Any:
        return function(t, y, *self._args)

    def _call_with_shift(self, function: Function, t: float, y: Array, gamma: float) -> Any:
        return function(t, y, gamma, *self._args)

    def _all_columns(self, t: float, y: Array) -> Any:
        assert self._of_columns is not None
        self.nfev += 1
        return self._of_columns(t, y, *self._args)

    def _jacobian(self, jac: Any, t0: float, y0: Array) -> Function | None:
        if jac is None:
            return None
        first = as_square_matrix("jac returned" if callable(jac) else "jac is", jac(t0, y0, *self._args) if callable(jac) else jac, y0.size)
        if self._pattern is None and hasattr(first, "tocsr"):
            self._restrict_to(first)
        if not callable(jac):
            self._require_places(first)
            return lambda t, y: first

        def call(t: float, y: Array) -> Any:
            self.njev += 1
            found = as_square_matrix("jac returned", jac(t, y, *self._args), y.size)
            self._require_places(found)
            return found

        return call

    def _restrict_to(self, matrix: Any) -> None:
        """Lets Q' differ from 0 on the diagonal and where a matrix does; a sparse matrix where it has an entry, which may be 0."""
        rows, columns, _ = _entries(matrix, zeros=True)
        n = matrix.shape[0]
        self._pattern = np.union1d(rows * n + columns, np.arange(n) * (n + 1))
        self.places = n, list(zip(rows.tolist(), columns.tolist()))

    def _require_places(self, matrix: Any) -> None:
        if self._pattern is None:
            return
        rows, columns, _ = _entries(matrix, zeros=False)
        outside = ~np.isin(rows * matrix.shape[0] + columns, self._pattern)
        if np.any(outside):
            k = int(np.argmax(outside))
            raise InputError(f"jac has an entry in row {rows[k]} and column {columns[k]} (jac_sparsity, or a sparse jac at the start, has "
                             "none there); give jac_sparsity with all places")


def _copy(functions: tuple[Any, Any, Any, Any], args: tuple[Any, ...], vectorized: bool, preconditioner: Function | None,
          prepared: tuple[Any, Any, Any, Any], kinds: tuple[bool, bool] | None) -> System:
    system = System(*functions, (), args, vectorized, preconditioner)
    system.prepare(*prepared)
    if system._derivatives is not None and kinds is not None:
        system._derivatives.use_at_most(kinds)
    return system


def entries_of(matrix: Any) -> list[tuple[int, int, float]]:
    """Returns row, column and value of the entries of an array or sparse matrix that are not 0."""
    return list(zip(*(part.tolist() for part in _entries(matrix, zeros=False))))


def _entries(matrix: Any, zeros: bool) -> tuple[NDArray[np.int64], NDArray[np.int64], Array]:
    """Rows, columns and values of the entries that are not 0; with `zeros`, of all stored ones of a sparse matrix."""
    if not hasattr(matrix, "tocoo"):
        rows, columns = np.nonzero(matrix)
        values = np.asarray(matrix)[rows, columns]
    else:
        entries = matrix.tocoo()
        kept = np.full(entries.data.shape, True) if zeros else entries.data != 0
        rows, columns, values = entries.row[kept], entries.col[kept], entries.data[kept]
    return rows.astype(np.int64), columns.astype(np.int64), values


def _one_number(k: int, value: Any) -> float:
    try:
        if np.size(value) == 1:
            return float(np.asarray(value).item())
    except (TypeError, ValueError):
        pass
    raise InputError(f"event {k} returned {value!r} (a real number is needed); return one")
