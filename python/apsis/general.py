"""Problems with any smooth collision, whose stages are solved by Newton's method."""
from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import Any, Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .errors import InputError

Array = NDArray[np.float64]


@dataclass
class GeneralProblem:
    """u' = T(t, u) + Q(u) for any smooth Q; stages v = u + a Q(v) + b Q'(v)Q(v) are solved by Newton's method.

    The functions get arrays of the shape of u0, which are read-only copies and may be kept:

        collision(u)              Q, of the shape of u
        transport(t, u)           T, of the shape of u; None: T = 0
        jacobian(u)               Q', of n × n numbers for u of n, entry (i, j) = ∂Q_i/∂u_j of u.ravel()
        forward_euler_step(t, u)  Δt_FE of the transport, for steps without dt
        admissible(u)             whether a stage may be so; Newton iterates stay inside
        local                     Q couples only the last axis of u, cell by cell: the functions collision, jacobian and
                                  admissible then get one cell, an array of the length of that axis

    Without a jacobian, derivatives are complex steps, Im Q(u + ihx)/h, exact to rounding, where Q accepts complex numbers and they
    agree with finite differences at u0; else central differences, of about ten digits. Solution.derivatives says which.
    Q' enters the solution through Q'Q: for Q much faster than a step, 1e4 times or more, give the jacobian or a Q of analytic
    functions. Stages stay within the sums that Q conserves, to rounding.

    solver    "dense": a Newton step of n unknowns takes n³ operations and n evaluations of Q or more, and CostWarning is given above
              200 unknowns; "krylov": iterations without n³ and without preconditioner, for Q that is not stiff

    Large systems are solved in less time with local=True, or as a RelaxationProblem if Q has that form: its stages are closed
    formulas."""

    collision: Callable[[Array], ArrayLike]
    transport: Callable[[float, Array], ArrayLike] | None = None
    jacobian: Callable[[Array], ArrayLike] | None = None
    forward_euler_step: Callable[[float, Array], float] | None = None
    admissible: Callable[[Array], bool] | None = None
    local: bool = False
    solver: str = "dense"


class Derivatives:
    """Q'(u) x and Q''(u)[k, x] of a function of arrays of one shape.

    by      "jacobian", "complex steps" or "finite differences"
    """

    def __init__(self, collision: Callable[[Array], ArrayLike], jacobian: Callable[[Array], ArrayLike] | None, u: Array) -> None:
        self._collision, self._jacobian = collision, jacobian
        self._known: tuple[bytes, Array] | None = None
        self.by = "jacobian" if jacobian is not None else "complex steps" if self._is_analytic(u) else "finite differences"

    def product(self, u: Array, x: Array) -> Array:
        """Returns Q'(u) x."""
        if not np.any(x):
            return np.zeros(u.shape)
        if self.by == "jacobian":
            return (self._matrix(u) @ x.ravel()).reshape(u.shape)
        return self._complex_step(u, x) if self.by == "complex steps" else self._difference(u, x)

    def curvature(self, u: Array, k: Array, x: Array) -> Array:
        """Returns Q''(u)[k, x] to a few digits."""
        if not np.any(k) or not np.any(x):
            return np.zeros(u.shape)
        h = _length(u, k, 1e-3 if self.by == "finite differences" else 1e-5)
        return (self.product(u + h * k, x) - self.product(u - h * k, x)) / (2 * h)

    def _matrix(self, u: Array) -> Array:
        key = u.tobytes()
        if self._known is None or self._known[0] != key:
            assert self._jacobian is not None
            found = np.asarray(self._jacobian(_fixed(u)))
            if found.dtype.kind not in "biuf" or found.size != u.size ** 2:
                raise InputError(f"jacobian returned an array of shape {found.shape} and type {found.dtype} (real numbers of shape "
                                 f"({u.size}, {u.size}) are needed); return that")
            self._known = key, found.astype(np.float64).reshape(u.size, u.size)
        return self._known[1]

    def _complex_step(self, u: Array, x: Array) -> Array:
        h = 1e-30 * max(_size(u), 1e-200) / _size(x)
        return np.imag(np.asarray(self._collision(_fixed(u + 1j * h * x)))) / h

    def _difference(self, u: Array, x: Array) -> Array:
        h = _length(u, x, 6e-6)
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
        scales = np.where(u != 0, np.abs(u), _size(u) or 1.0)
        angles = np.arange(1, u.size + 1).reshape(u.shape)
        for x in (scales * np.sin(angles), scales * np.cos(3 * angles)):
            try:
                with np.errstate(all="ignore"), warnings.catch_warnings():
                    warnings.simplefilter("error")  # an imaginary part that is cut off is a warning of NumPy
                    exact = self._complex_step(u, x)
            except Exception:  # noqa: BLE001 - whatever a function for real numbers does with complex ones
                return False
            near = self._difference(u, x)
            if exact.shape != u.shape or not np.all(np.abs(exact - near) <= 1e-4 * _size(near) + 1e-7 * _size(exact)):
                return False
        return True


def _fixed(u: Any) -> Any:
    u.setflags(write=False)
    return u


def _size(u: Array) -> float:
    return float(np.max(np.abs(u), initial=0.0))


def _length(u: Array, x: Array, part: float) -> float:
    """The step h with which u + hx changes every component by at most `part` of itself, or 1e-6 of the largest where it is smaller."""
    largest = _size(u) or 1.0
    moved = x != 0
    return float(part * np.min(np.maximum(np.abs(u[moved]), 1e-6 * largest) / np.abs(x[moved])))
