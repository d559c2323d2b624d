"""Problems with any smooth collision, whose stages are solved by Newton's method."""
from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Any, Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from .arguments import real_array
from .derivatives import CellDerivatives, Derivatives, some_cells
from .errors import InputError
from .preconditioners import of_solver

Array = NDArray[np.float64]


@dataclass
class GeneralProblem:
    """u' = T(t, u) + Q(u) for any smooth Q. Newton's method solves the stages v = u + a Q(v) + b Q'(v)Q(v).

    The functions get read-only copies of arrays with the shape of u0, and may store them:

        collision(u)              Q, of the shape of u
        transport(t, u)           T, of the shape of u; None: T = 0
        jacobian(u)               Q', an n × n matrix for n unknowns: entry (i, j) is ∂Q_i/∂u_j of u.ravel()
        forward_euler_step(t, u)  Δt_FE of the transport, for steps without dt
        admissible(u)             whether u is admissible as a stage; Newton iterates stay inside
        local                     Q couples only the last axis of u, cell by cell: the functions collision, jacobian and
                                  admissible then get one cell, an array of the length of that axis
        vectorized                with local: these functions get m cells, an array of shape (m, n), and return arrays of shape
                                  (m, n), (m, n, n) and (m,). A step then calls each function a few times, not a few times per cell
        parameters                with vectorized: an array whose first axes are those of the cells. The functions get its rows
                                  for the m cells as the last argument: collision(u, p), such as ε(x) or rates of each cell

    Without a jacobian, derivatives are complex steps Im Q(u + ihx)/h, exact to rounding. They require that Q accepts complex
    numbers, and that they agree with finite differences at u0 and at some later states. Otherwise derivatives are central differences
    with about ten digits; later, after an ApsisWarning. Solution.derivatives names the kind. Q' enters the solution through Q'Q: if Q is 1e4 times as fast as a step, or more,
    give the jacobian or a Q of analytic functions. Stages preserve the sums that Q conserves, to rounding.

    solver    "dense": a Newton step of n unknowns takes n³ operations and at least n evaluations of Q, with a CostWarning above 200
              unknowns; "krylov": GMRES without matrices and n³ operations, for Q that is not stiff or with a preconditioner
    preconditioner(u, gamma)  with "krylov": returns a solver of (1 − γQ'(u)) x = r, at least an approximate one: a function of r, an
              object with such a `solve` (scipy.sparse.linalg.splu), or the inverse as a matrix. r has the shape (n,). Called once for
              each γ of a step; a stage with b < 0 has γ = √−b and applies it twice. Not with local=True

    Large systems take less time with local=True. If Q has the form of a RelaxationProblem, use that class: its stages have a
    closed form."""

    collision: Callable[[Array], ArrayLike]
    transport: Callable[[float, Array], ArrayLike] | None = None
    jacobian: Callable[[Array], ArrayLike] | None = None
    forward_euler_step: Callable[[float, Array], float] | None = None
    admissible: Callable[[Array], bool] | None = None
    local: bool = False
    vectorized: bool = False
    parameters: ArrayLike | None = None
    solver: str = "dense"
    preconditioner: Callable[[Array, float], Any] | None = None


@dataclass(frozen=True)
class CollisionFunctions:
    """The functions of a collision as the compiled part calls them.

    coupling    what they get: the whole state, one cell, or several cells and their indices"""

    coupling: _core.Coupling
    collision: Callable[..., ArrayLike]
    derivatives: Derivatives | CellDerivatives
    admissible: Callable[..., Any] | None
    preconditioner: Callable[..., Any] | None = None


def collision_functions(problem: GeneralProblem, u0: Array) -> CollisionFunctions:
    """Returns the functions of `problem` for states like u0. Raises InputError if the settings of its cells do not fit together."""
    if problem.vectorized and not problem.local:
        raise InputError("vectorized = True has no meaning without local = True (it is about functions of cells); give local=True too, "
                         "or remove it")
    if problem.parameters is not None and not problem.vectorized:
        raise InputError("parameters have no meaning without vectorized = True (they are those of several cells); give vectorized=True "
                         "too, or remove them")
    preconditioner = of_solver(problem.preconditioner, problem.solver)
    if preconditioner is not None and problem.local:
        raise InputError("preconditioner has no meaning with local = True (each cell is a small system of its own); remove it")
    if problem.vectorized:
        return _functions_of_cells(problem, u0)
    if not problem.local:
        derivatives = Derivatives(problem.collision, problem.jacobian, u0.copy())
        return CollisionFunctions(_core.Coupling.all, problem.collision, derivatives, problem.admissible, preconditioner)
    cells = u0.reshape(-1, u0.shape[-1])
    first, *others = (cells[k].copy() for k in some_cells(len(cells)))
    derivatives = Derivatives(problem.collision, problem.jacobian, first, others=others)
    return CollisionFunctions(_core.Coupling.cell, problem.collision, derivatives, problem.admissible)


def _functions_of_cells(problem: GeneralProblem, u0: Array) -> CollisionFunctions:
    cells = u0.reshape(-1, u0.shape[-1])
    rows = None if problem.parameters is None else _rows_of(real_array("parameters", problem.parameters), u0.shape[:-1])

    def call(function: Callable[..., Any], u: Array, which: Any) -> Any:
        return function(u) if rows is None else function(u, rows[which])

    def truths(function: Callable[..., Any], u: Array, which: Any) -> Any:
        found = np.asarray(call(function, u, which))
        if found.dtype.kind != "b" or found.shape != (len(u),):
            raise InputError(f"admissible returned an array of shape {found.shape} and type {found.dtype} (True or False is needed for "
                             f"each cell, an array of shape ({len(u)},)); return that")
        return found

    collision = partial(call, problem.collision)
    jacobian = partial(call, problem.jacobian) if problem.jacobian else None
    admissible = partial(truths, problem.admissible) if problem.admissible else None
    return CollisionFunctions(_core.Coupling.cells, collision, CellDerivatives(collision, jacobian, cells), admissible)


def _rows_of(parameters: Array, cells: tuple[int, ...]) -> Array:
    """Returns the parameters as an array whose first axis is that of all cells. It cannot be changed by the functions."""
    if parameters.shape[:len(cells)] != cells:
        raise InputError(f"parameters have the shape {parameters.shape} (its first axes must be those of the cells, {cells}); give a row "
                         "for each cell")
    rows = parameters.reshape(-1, *parameters.shape[len(cells):]).copy()
    rows.setflags(write=False)
    return rows
