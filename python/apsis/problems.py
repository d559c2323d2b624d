"""Problems of your own, with functions on arrays."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core

Array = NDArray[np.float64]


@dataclass
class RelaxationProblem:
    """u' = T(t, u) + C(ω)(E(ω) − u)/ε with conserved moments ω = ℛu, ℛE(ω) = ω.

    Stages are convex combinations of u and E in closed form, nonnegative where both are; ε = 0 is the limit scheme. The
    functions get arrays of the shape of u0 that are valid during the call and must not be changed:

        transport(t, u)           T, of the shape of u
        moments(u)                ω, anything
        equilibrium(omega)        E, of the shape of u
        rate(omega)               C ≥ 0, a number
        forward_euler_step(t, u)  Δt_FE of the transport, for steps without dt
        admissible(u)             whether a stage may be so
    """

    transport: Callable[[float, Array], ArrayLike]
    moments: Callable[[Array], Any]
    equilibrium: Callable[[Any], ArrayLike]
    rate: Callable[[Any], float]
    epsilon: float
    forward_euler_step: Callable[[float, Array], float] | None = None
    admissible: Callable[[Array], bool] | None = None


@dataclass(frozen=True)
class Solution:
    """States u[k] at the times t[k], how many steps they took, and how many were rejected for their error."""

    t: Array
    u: Array
    steps: int
    rejected: int


def integrate(problem: RelaxationProblem, u0: ArrayLike, t: Sequence[float] | Array, method: str = "md-imex-6-3", *,
              dt: float | None = None, safety: float = 1.0, startup: str = "none", tolerance: float | None = None) -> Solution:
    """Integrates from t[0], where u is u0, and returns the states at all times of t.

    Steps have the length dt, shortened until it divides each interval, or safety · r · Δt_FE. startup = "graded" resolves the
    initial layer of data out of equilibrium. With a tolerance steps are shorter where the estimated error of one, the largest
    difference to the embedded solution of the method, would be above it. Raises InputError, NumericalError with step and t, and what the functions raise."""
    if startup not in ("none", "graded"):
        from .errors import InputError
        raise InputError(f"there is no start-up '{startup}' valid: none, graded")
    times, states, steps, rejected = _core.integrate(
        problem.transport, problem.moments, problem.equilibrium, problem.rate, problem.forward_euler_step,
        problem.admissible, problem.epsilon, u0, [float(x) for x in t], method, dt, safety, startup == "graded", tolerance)
    return Solution(times, states, steps, rejected)
