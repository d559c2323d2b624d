"""Problems with any smooth collision, whose stages are solved by Newton's method."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

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

    Without a jacobian, derivatives are complex steps Im Q(u + ihx)/h, exact to rounding. They require that Q accepts complex
    numbers, and that they agree with finite differences at u0. Otherwise derivatives are central differences with about ten
    digits. Solution.derivatives names the kind. Q' enters the solution through Q'Q: if Q is 1e4 times as fast as a step, or more,
    give the jacobian or a Q of analytic functions. Stages preserve the sums that Q conserves, to rounding.

    solver    "dense": a Newton step of n unknowns takes n³ operations and at least n evaluations of Q, with a CostWarning above 200
              unknowns; "krylov": iterations without n³ operations and without preconditioner, for Q that is not stiff

    Large systems take less time with local=True. If Q has the form of a RelaxationProblem, use that class: its stages have a
    closed form."""

    collision: Callable[[Array], ArrayLike]
    transport: Callable[[float, Array], ArrayLike] | None = None
    jacobian: Callable[[Array], ArrayLike] | None = None
    forward_euler_step: Callable[[float, Array], float] | None = None
    admissible: Callable[[Array], bool] | None = None
    local: bool = False
    solver: str = "dense"
