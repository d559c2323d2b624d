"""Time integrators: coefficients and certificates."""
from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from html import escape
from pathlib import Path
from typing import Callable, Sequence, Union

import numpy as np
from numpy.typing import NDArray

from . import _core
from .errors import FileError, InputError

Array = NDArray[np.float64]
Coefficient = Union[int, float, str, Fraction]
Tableau = Sequence[Sequence[Coefficient]]


@dataclass(frozen=True)
class Certificate:
    """Properties of a method, derived from its coefficients in 60 digits.

    All numbers are dimensionless. The members are:

        name                  name of the method
        kind                  "imex", "implicit", "explicit" or "exponential"
        order                 order of accuracy
        conditions            number of order conditions up to this order
        order_residual        largest of their residuals
        error_constant        2-norm of the residuals of the next order
        unconditional         SSP without a bound from Q
        ssp_coefficient       r: steps up to r Δt_FE preserve the properties of forward Euler at any ε; None if any step does
        explicit_radius       the coefficient of the explicit part alone
        limiting_entry        the coefficient of the method that limits r
        cfl_limits            CFL number up to which each reconstruction is linearly stable for any Δt/ε; None if it always is; empty for
                              implicit methods
        type                  "A", "ARS", "CK", "explicit" or "none"
        gsa                   globally stiffly accurate: the last stage is the result
        ap, ap_data           asymptotic preserving from any data; the data that it needs
        explicit_evaluations, implicit_solves    evaluations of T and solves in a step
        angle, l_stable       angle in degrees of A(α)-stability of the implicit part; whether this part is L-stable
        keeps                 the terms of size ε that are correct for ε ≪ Δt: "none", "slow" or "all"
        estimate              estimate of the error of a step, such as "embedded solution of order 2" or "step doubling"
        claims_hold           whether the claims of the file hold
        failures              the claims that do not hold"""

    name: str
    kind: str
    order: int
    conditions: int
    order_residual: float
    error_constant: float
    unconditional: bool
    ssp_coefficient: float | None
    explicit_radius: float
    cfl_limits: dict[str, float | None]
    limiting_entry: str
    type: str
    gsa: bool
    ap: bool
    ap_data: str
    explicit_evaluations: int
    implicit_solves: int
    angle: float
    l_stable: bool
    keeps: str
    estimate: str
    claims_hold: bool
    failures: list[str]

    def _summary(self) -> dict[str, str]:
        ssp = "any step" if self.ssp_coefficient is None else f"{self.ssp_coefficient:.6g}"
        limits = ", ".join(f"{'any' if limit is None else f'{limit:.4g}'} with {name}" for name, limit in self.cfl_limits.items())
        return {"method": self.name, "kind": self.kind, "order": str(self.order), "SSP coefficient": ssp, "CFL limit": limits or "none",
                "type": self.type, "limit ε → 0": f"from {self.ap_data}",
                "work per step": f"{self.explicit_evaluations} evaluations of T, {self.implicit_solves} "
                                f"{'exact collisions' if self.kind == 'exponential' else 'implicit solves'}",
                "claims": "hold" if self.claims_hold else "; ".join(self.failures)}

    def __repr__(self) -> str:
        ssp = "any step" if self.ssp_coefficient is None else f"{self.ssp_coefficient:.6g}"
        return f"<apsis.Certificate of {self.name}: order {self.order}, SSP coefficient {ssp}, type {self.type}>"

    def _repr_html_(self) -> str:
        return html_table(self._summary())


def html_table(rows: dict[str, str]) -> str:
    """Returns an escaped HTML table of two columns for notebooks."""
    return "<table>" + "".join(f"<tr><th>{escape(name)}</th><td>{escape(text)}</td></tr>" for name, text in rows.items()) + "</table>"


class Method:
    """A time integrator. Shu–Osher form

        u_i = r_i u^n + Σ p_ij u_j + Σ w_ij (u_j + (Δt/r) T(u_j)) + Δt Σ d_ij Q(u_j) + Δt² ḋ_i Q̇(u_i)

    as arrays P, W, D (s × s) and ddot (s) and the number r; Butcher form as A_hat, A, A_dot (s × s). `exact` has the
    coefficients of the file as fractions. In exponential methods d_ii are times of exact solutions of the collision, in units
    of Δt, and A and A_dot do not exist: they raise InputError.
    """

    def __init__(self, core: _core.Method) -> None:
        self._core = core
        self.name, self.title, self.citation = core.name, core.title, core.citation
        self.origin, self.purpose, self.kind = core.origin, core.purpose, core.kind
        self.stages = core.stages

    def __repr__(self) -> str:
        return f"<apsis.Method {self.name}: {self.title}>"

    def _repr_html_(self) -> str:
        return html_table({"name": self.name, "title": self.title, "kind": self.kind, "stages": str(self.stages),
                           "purpose": self.purpose, "citation": self.citation})

    def __eq__(self, other: object) -> bool:
        """Equality of names, coefficients and claims."""
        return isinstance(other, Method) and self._core._toml == other._core._toml

    def __hash__(self) -> int:
        return hash(self._core._toml)

    def __reduce__(self) -> tuple[Callable[[str, str], Method], tuple[str, str]]:
        return _from_text, (self._core._toml, self.name)

    @cached_property
    def P(self) -> Array:
        """Weights p_ij of the stages."""
        return self._core.P

    @cached_property
    def W(self) -> Array:
        """Weights w_ij of forward Euler steps from the stages."""
        return self._core.W

    @cached_property
    def D(self) -> Array:
        """Coefficients d_ij of Q."""
        return self._core.D

    @cached_property
    def ddot(self) -> Array:
        """Coefficients ḋ_i of Q̇."""
        return self._core.ddot

    @property
    def r(self) -> float:
        """r: the forward Euler steps in W have the length Δt/r."""
        return self._core.r

    @cached_property
    def A_hat(self) -> Array:
        """Butcher matrix of T."""
        return self._core.A_hat

    @cached_property
    def A(self) -> Array:
        """Butcher matrix of Q."""
        self._require_stage_solves("A")
        return self._core.A

    @cached_property
    def A_dot(self) -> Array:
        """Butcher matrix of Q̇."""
        self._require_stage_solves("A_dot")
        return self._core.A_dot

    def _require_stage_solves(self, name: str) -> None:
        if self.kind == "exponential":
            raise InputError(f"method '{self.name}' has no {name} (its collisions are solved exactly); use D")

    @cached_property
    def exact(self) -> dict[str, list[list[Fraction]] | list[Fraction] | Fraction]:
        """P, W, D, ddot and r of the file as exact fractions."""
        file = self._core._exact
        matrices = {name: [[Fraction(x) for x in row] for row in file[name]] for name in ("P", "W", "D")}
        return {**matrices, "ddot": [Fraction(x) for x in file["ddot"]], "r": Fraction(file["r"])}

    @cached_property
    def certificate(self) -> Certificate:
        """Order, SSP coefficient, stability and limits, derived from the coefficients in 60 digits."""
        return Certificate(**self._core._certify())


def _from_text(text: str, file: str) -> Method:
    return Method(_core.parse_method(text, file))


@dataclass(frozen=True)
class OrderCondition:
    """The condition of a rooted tree: F stands for T, G for Q. It is satisfied if the residual, the left-hand side minus 1/γ(τ), is 0."""

    tree: str
    order: int
    value: float
    residual: float


def method(name: str) -> Method:
    """Returns the certified method of a name, a member of a family ("md-imex-chain-7-2"), or a file FILE.toml.

    Raises InputError if there is no such method, ClaimError if a claim is false."""
    return Method(_core.find_method(name))


def methods() -> list[str]:
    """Returns the names of the catalogue."""
    return _core.method_names()


def read_method(file: str | Path) -> Method:
    """Returns the method of a file without enforcing its claims; certificate.failures lists false ones. Raises InputError, FileError."""
    try:
        text = Path(file).read_text(encoding="utf-8")
    except OSError as problem:
        raise FileError(f"cannot read '{file}' ({problem.strerror}); give a readable method file") from problem
    return Method(_core.parse_method(text, str(file)))


def order_conditions(A: Tableau, A_hat: Tableau | None = None, A_dot: Tableau | None = None, *, order: int) -> list[OrderCondition]:
    """Returns all order conditions of a tableau up to `order`: A of Q, A_hat of T, A_dot of Q̇ (s × s each), u^{n+1} the last stage.

    Without A_hat the method is for Q alone. Coefficients may be numbers, fractions or text ("1/3"), and are used with every
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
