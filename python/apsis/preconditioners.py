"""Preconditioners of a user for the Krylov solver of stages, for the compiled part."""
from __future__ import annotations

from functools import partial
from typing import Any, Callable

import numpy as np

from .arguments import type_of
from .errors import InputError

Function = Callable[..., Any]


def of_solver(preconditioner: Any, solver: str) -> Function | None:
    """Returns a function of the arguments of `preconditioner` that returns a function r ↦ x. Raises InputError if it cannot be used."""
    if preconditioner is None:
        return None
    if not callable(preconditioner):
        raise InputError(f"preconditioner is {type_of(preconditioner)} (it must be callable); give a function that returns a solver, or None")
    if solver != "krylov":
        raise InputError(f"preconditioner has no meaning with solver={solver!r} (matrices are factorized, without iterations); give "
                         "solver=\"krylov\"")
    return partial(_prepare, preconditioner)  # unlike a lambda it can be pickled


def _prepare(preconditioner: Function, *arguments: Any) -> Function:
    made = preconditioner(*arguments)
    solve = getattr(made, "solve", made)
    if callable(solve):
        function: Function = solve
        return function
    if np.ndim(made) == 2 or hasattr(made, "tocsr"):
        return lambda r: made @ r
    raise InputError(f"preconditioner returned {type_of(made)} (a solver is needed: a function of r, an object with `solve` such as "
                     "scipy.sparse.linalg.splu gives it, or a matrix); return one")
