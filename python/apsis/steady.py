"""Steady states of kinetic problems, without steps in time."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .arguments import number, real_array, type_of, whole_number
from .errors import InputError
from .kinetic import KineticProblem
from .library_warnings import LibraryWarnings

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class SteadyState:
    """The state u, [cells, components], with the residuals relative to that of the start and the relative changes of the moments
    in the correction of each iteration."""

    u: Array
    residuals: Array
    changes: Array

    @property
    def iterations(self) -> int:
        """Number of iterations, each with one evaluation of the transport."""
        return len(self.residuals)

    def __repr__(self) -> str:
        return f"<apsis.SteadyState after {self.iterations} iterations, residual {self.residuals[-1]:.1e}>"


def solve_steady(problem: KineticProblem, u0: ArrayLike, tolerance: float = 1e-8, *, iterations: int = 500, images: int = 3,
                 threads: int | None = None) -> SteadyState:
    """Solves T(u) + Q(u)/ε = 0 for the discretization of the problem, with boundary conditions and forces at t = 0.

        problem = apsis.KineticProblem("bgk", ..., reconstruction="upwind5")
        steady = apsis.solve_steady(problem, problem.state(rho=1, T=1))

    u0 is the start, and determines the mass between walls. The state satisfies the tolerance under two conditions. The 2-norm of the
    residual is at most the tolerance times that of u0, or at rounding level. The relative change of the moments is at most the
    tolerance. `images` is the number of earlier iterates that are mixed into each iterate (Anderson). reconstruction = "upwind5" is
    best: nonlinear weights may never settle where f jumps, except those of "weno5-z-smooth". With positivity = True the state is
    nonnegative for models with nonnegative targets. Its limiter is not that of steps (docs/steady-method.md).
    Raises InputError for models that do not relax to an equilibrium, without space, and where ε = 0; NumericalError if the
    iteration diverges, stalls, or is not complete after `iterations`. docs/steady.md describes the method."""
    if not isinstance(problem, KineticProblem):
        raise InputError(f"problem is {type_of(problem)} (an equation on a mesh is needed); give an apsis.KineticProblem")
    number("tolerance", tolerance, positive=True)
    if whole_number("iterations", iterations) < 1:
        raise InputError(f"iterations is {iterations} (at least one is needed); give more")
    if not 0 <= whole_number("images", images) <= 20:
        raise InputError(f"images is {images} (0 to 20 are possible); change it")
    with LibraryWarnings():
        found = problem._core.solve_steady(real_array("u0", u0), float(tolerance), int(iterations), int(images),
                                           None if threads is None else whole_number("threads", threads))
    return SteadyState(*found)
