"""Problems with any smooth collision, whose stages are solved by Newton's method."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

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
