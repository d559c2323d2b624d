"""Time integrators: coefficients, and what can be said of them."""
from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from pathlib import Path
from typing import Sequence, Union

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._core import Certificate
from .errors import FileError

Array = NDArray[np.float64]
Coefficient = Union[int, float, str, Fraction]
Tableau = Sequence[Sequence[Coefficient]]


class Method:
    """A time integrator. Shu–Osher form

        u_i = r_i u^n + Σ p_ij u_j + Σ w_ij (u_j + (Δt/r) T(u_j)) + Δt Σ d_ij Q(u_j) + Δt² ḋ_i Q̇(u_i)

    as arrays P, W, D (s × s) and ddot (s) and the number r; Butcher form as A_hat, A, A_dot (s × s). `exact` has the
    coefficients of the file as fractions.
    """

    def __init__(self, core: _core.Method) -> None:
        self._core = core
        self.name, self.title, self.citation = core.name, core.title, core.citation
        self.origin, self.purpose, self.kind = core.origin, core.purpose, core.kind
        self.stages = core.stages

    def __repr__(self) -> str:
        return f"apsis.method({self.name!r})"

    @cached_property
    def P(self) -> Array:
        """Weights of the stages."""
        return self._core.P

    @cached_property
    def W(self) -> Array:
        """Weights of the forward Euler steps from the stages."""
        return self._core.W

    @cached_property
    def D(self) -> Array:
        """Factors of Q."""
        return self._core.D

    @cached_property
    def ddot(self) -> Array:
        """Factors of Q̇."""
        return self._core.ddot

    @property
    def r(self) -> float:
        """Steps of forward Euler in W have the length Δt/r."""
        return self._core.r

    @cached_property
    def A_hat(self) -> Array:
        """Butcher matrix of T."""
        return self._core.A_hat

    @cached_property
    def A(self) -> Array:
        """Butcher matrix of Q."""
        return self._core.A

    @cached_property
    def A_dot(self) -> Array:
        """Butcher matrix of Q̇."""
        return self._core.A_dot

    @cached_property
    def exact(self) -> dict[str, list[list[Fraction]] | list[Fraction] | Fraction]:
        """P, W, D, ddot and r as they stand in the file, without rounding."""
        file = self._core._exact
        matrices = {name: [[Fraction(x) for x in row] for row in file[name]] for name in ("P", "W", "D")}
        return {**matrices, "ddot": [Fraction(x) for x in file["ddot"]], "r": Fraction(file["r"])}

    @cached_property
    def certificate(self) -> Certificate:
        """Order, SSP coefficient, stability and limits, derived from the coefficients in 60 digits."""
        return self._core._certify()


@dataclass(frozen=True)
class OrderCondition:
    """The condition of a rooted tree: F stands for T, G for Q. It holds where the residual, the left-hand side minus 1/γ(τ), is 0."""

    tree: str
    order: int
    value: float
    residual: float


def method(name: str) -> Method:
    """A method by its name, a member of a family ("md-imex-chain-7-2"), or a file FILE.toml, certified.

    Raises InputError if there is none, ClaimError if its claims do not hold."""
    return Method(_core.find_method(name))


def methods() -> list[str]:
    """Names of the catalogue."""
    return _core.method_names()


def read_method(file: str | Path) -> Method:
    """A method file that need not be what it claims: its certificate tells. Raises InputError, FileError."""
    try:
        text = Path(file).read_text(encoding="utf-8")
    except OSError as problem:
        raise FileError(f"cannot read '{file}' ({problem.strerror}) give a readable method file") from problem
    return Method(_core.parse_method(text, str(file)))


def order_conditions(A: Tableau, A_hat: Tableau | None = None, A_dot: Tableau | None = None, *, order: int) -> list[OrderCondition]:
    """All conditions up to `order` of a tableau of your own: A of Q, A_hat of T, A_dot of Q̇ (s × s each), u^{n+1} the last stage.

    Without A_hat of a method for Q alone. Coefficients may be numbers, fractions or text ("1/3"), and count with every
    digit. Raises InputError."""
    def texts(tableau: Tableau | None) -> list[list[str]]:
        return [] if tableau is None else [[_text(x) for x in row] for row in tableau]
    return [OrderCondition(*one) for one in _core.conditions(texts(A_hat), texts(A), texts(A_dot), order)]


def _text(x: Coefficient) -> str:
    if isinstance(x, str):
        return x
    if isinstance(x, (int, np.integer)):
        return str(int(x))
    if isinstance(x, Fraction):
        return f"{x.numerator}/{x.denominator}"
    return repr(float(x))
