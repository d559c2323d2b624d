"""Initial value problems in the form of scipy.integrate.solve_ivp."""
from __future__ import annotations

import math
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from .arguments import number, real_array, text, type_of
from .dense import Steps
from .derivatives import as_square_matrix
from .errors import CostWarning, InputError
from .ivp_runs import Record, Run, endings_of, march_to_end, run_until_accurate, run_with_restarts
from .library_warnings import LibraryWarnings, warn
from .methods import Method, method as find_method
from .preconditioners import of_solver
from .system import System, entries_of

if TYPE_CHECKING:
    from scipy.optimize import OptimizeResult

Array = NDArray[np.float64]
Function = Callable[..., Any]
SCIPY_METHODS = ("RK45", "RK23", "Radau", "BDF", "LSODA")  # the library has dop853


def solve_ivp(transport: Function | None, collision: Function | None, t_span: Sequence[float], y0: ArrayLike | None = None, *, method: str | Method = "auto",
              t_eval: ArrayLike | None = None, dense_output: bool = False, events: Function | Sequence[Function] | None = None,
              args: Sequence[Any] | None = (), rtol: ArrayLike = 1e-3, atol: ArrayLike = 1e-6, jac: Any = None, jac_sparsity: Any = None,
              vectorized: bool = False, first_step: float | None = None, max_step: float = math.inf, dt: float | None = None,
              forward_euler_step: Function | None = None, admissible: Function | None = None, solver: str = "dense",
              controller: str = "predictive", mass: Any = None, preconditioner: Function | None = None,
              end_error: bool = False) -> OptimizeResult:
    """Solves y' = T(t, y) + Q(t, y), y(t0) = y0, T explicitly and Q implicitly. Returns the result object of SciPy's solve_ivp.

        scipy.integrate.solve_ivp(f, t_span, y0, method="Radau", jac=J)        becomes
        apsis.solve_ivp(None, f, t_span, y0, jac=J)                            or, with the part g of f that is not stiff,
        apsis.solve_ivp(g, lambda t, y: f(t, y) - g(t, y), t_span, y0)

    The functions get read-only arrays of the shape of y0, (n,), which they may store, and then args:

        transport(t, y)           T, of shape (n,); None: T = 0
        collision(t, y)           Q, of shape (n,), stiff; None: Q = 0. With vectorized=True T and Q get y of shape (n, k) and return
                                  that shape, so that one call gives all derivatives
        jac(t, y)                 ∂Q/∂y, an array or a sparse matrix of shape (n, n); or a constant matrix; or None: complex steps
                                  where Q accepts complex numbers, else differences (GeneralProblem). An ApsisWarning reports complex
                                  steps that are wrong at a later time, as with abs or .real; derivatives are then differences
        events                    functions g(t, y) with zeros that are reported; attributes `terminal` (True, or a number of zeros) and
                                  `direction` as in SciPy. A zero at the start of the integration is not an event
        forward_euler_step(t, y)  Δt_FE of T: steps are at most r Δt_FE, and preserve the properties that forward Euler steps preserve
        admissible(y)             whether y is in the set of valid states: no Newton iterate and no step leaves this set
        preconditioner(t, y, γ)   with solver="krylov": returns a solver of (M − γ ∂Q/∂y) x = r, at least an approximate one: a function
                                  of r, an object with such a `solve` (scipy.sparse.linalg.splu), or the inverse as a matrix

    Steps keep the estimated error of every y_i below ``rtol_i |y_i| + atol_i``; both may be arrays. With dt all steps have that length,
    without error control. first_step and max_step limit the steps. `controller` is the law that computes the next step from the
    errors of the last steps (`apsis list controllers`), such as "pi" or "pid". `method` is a name, a file or a one-step Method; "auto"
    chooses from the table of `apsis list choices`. jac_sparsity is a matrix of shape (n, n) that is nonzero where ∂Q/∂y may be
    nonzero. It or a sparse jac chooses sparse factorizations; differences then need one call for each group of columns. A constant
    matrix, or a sparse jac at (t0, y0), defines the pattern itself. solver="krylov" iterates by GMRES without matrices, for Q that is not stiff or
    with a preconditioner. This function is called once for each γ of a step. A stage with Q'Q applies it twice.

    `mass`, a constant array or sparse matrix M of shape (n, n), makes the system M y' = T(t, y) + Q(t, y), as finite elements have it.
    M must be invertible. forward_euler_step is then that of y' = M⁻¹ T. A sparse M and a sparse jac keep stage systems sparse.

    end_error=True repeats the integration with smaller tolerances until the estimated error of the result, at t_eval or at the end, is
    within rtol and atol. Without it they bound the error of each step, and errors of steps add up. This takes two integrations or more.
    The entries error (in units of the tolerances) and refined (their last factor) of the result then report the estimate. If results
    do not converge, status is −1.

    Returns scipy.optimize.OptimizeResult with t (m,), y (n, m), sol (scipy.integrate.OdeSolution or None), t_events, y_events, nfev
    (calls of transport and collision), njev (of jac), nlu (matrices factorized), status (0: end reached, 1: a terminal event, −1: a step
    failed), message and success. Further entries are method, steps, rejected and derivatives.

    A shorter step of the method computes the solution inside a step, for t_eval, sol and events. This solution has the order of the
    method, and is positive if steps are. Each of its values costs a step. The result can be pickled with sol if the functions can be,
    such as those of a module; unpickled, sol has the same values.

    Raises InputError for arguments that cannot be used, and exceptions of the functions."""
    scipy = _scipy()
    if y0 is None:
        raise InputError("y0 is missing (the arguments are transport, collision, t_span, y0); for solve_ivp(fun, t_span, y0) of SciPy write "
                         "solve_ivp(None, fun, t_span, y0)")
    listed = _event_functions(events)
    problem = System(transport, collision, forward_euler_step, admissible, listed, _extra(args), bool(vectorized),
                     of_solver(preconditioner, solver))
    span, start = _interval(t_span), _state(y0)
    wanted = None if t_eval is None else _times(t_eval, span)
    relative, absolute = _tolerance("rtol", rtol), _tolerance("atol", atol)
    bounded = forward_euler_step is not None or admissible is not None
    integrator, reason = _integrator(method, bounded, None if dt is not None else min(relative) or 1e-12)
    if dt is not None and controller != "predictive":
        raise InputError("dt and a controller are given (with dt all steps have that length); remove one of them")
    problem.prepare(span, start, jac, jac_sparsity)
    masses = None if mass is None else (start.size, entries_of(as_square_matrix("mass is", mass, start.size)))
    if np.any(integrator.ddot != 0):
        problem.require_exact(start, integrator.name)
    if end_error and dt is not None:
        raise InputError("dt and end_error are given (with dt steps have no tolerances); remove one of them")
    further = (*_step_lengths(dt, first_step, max_step, forward_euler_step is not None), text("controller", controller),
               _is_krylov(solver, problem, start.size, integrator), problem.places, masses)

    def march(factor: float = 1.0) -> Run:
        arguments = ([factor * x for x in relative], [factor * x for x in absolute], *further)
        evolution = _core.Evolution(problem, integrator._core, *arguments, [int(np.sign(getattr(e, "direction", 0))) for e in listed],
                                    [endings_of(e) > 0 for e in listed])
        inside = Steps(problem, integrator, arguments, evolution) if dense_output else None
        record = Record(evolution, wanted, inside, span[0], start)
        return Run(evolution, record, *march_to_end(evolution, record, span, start, listed))

    problem.restart_if_wrong(bool(np.any(integrator.ddot != 0)))
    with LibraryWarnings():
        runs, estimate = run_until_accurate(march, problem, relative, absolute) if end_error else ([run_with_restarts(march, problem)], {})
    problem.restart_if_wrong(False)
    evolution, record = runs[-1].evolution, runs[-1].record
    found = [[(t, y) for k, t, y in evolution.found if k == number_of] for number_of in range(len(listed))]
    return scipy.optimize.OptimizeResult(
        t=np.array(record.t), y=np.array(record.y).reshape(-1, start.size).T.copy(),
        sol=scipy.integrate.OdeSolution(record.ends, record.steps) if record.steps else None,
        t_events=[np.array([t for t, _ in of]) for of in found] if listed else None,
        y_events=[np.array([y for _, y in of]) for of in found] if listed else None, nfev=problem.nfev, njev=problem.njev,
        nlu=sum(run.evolution.systems for run in runs), status=runs[-1].status, message=runs[-1].message, success=runs[-1].status >= 0,
        method=integrator.name, reason=reason, steps=sum(run.evolution.steps for run in runs),
        rejected=sum(run.evolution.rejected for run in runs), derivatives=problem.by, **estimate)


def _scipy() -> Any:
    try:
        import scipy.integrate
        import scipy.optimize
    except ImportError as missing:
        raise InputError("solve_ivp needs SciPy (it returns its result object); install it, such as python3-scipy of Debian") from missing
    return scipy


def _extra(args: Sequence[Any] | None) -> tuple[Any, ...]:
    if args is None:
        return ()
    try:
        return tuple(args)
    except TypeError:
        raise InputError(f"args is {type_of(args)} (it lists the extra arguments of the functions); write args=({args!r},)") from None


def _integrator(method: str | Method, bounded: bool, tolerance: float | None) -> tuple[Method, str]:
    if isinstance(method, Method):
        return method, ""
    if not isinstance(method, str):
        raise InputError(f"method is {type_of(method)} (it must be a name, a file or an apsis.Method); see apsis.methods()")
    if method in SCIPY_METHODS:
        raise InputError(f"method '{method}' is one of SciPy's (methods here have other names); leave method out, or see apsis.methods()")
    if method != "auto":
        return find_method(method), ""
    name, reason = _core.choose_method(False, True, bounded, False, tolerance, None)
    return find_method(name), reason


def _interval(t_span: Sequence[float]) -> tuple[float, float]:
    times = real_array("t_span", t_span)
    if times.shape != (2,) or not np.all(np.isfinite(times)):
        raise InputError("t_span is not two finite times (the integration begins and ends there); give (t0, t1)")
    if times[0] == times[1]:
        raise InputError(f"t_span is empty (it begins and ends at {times[0]:g}); give t0 < t1")
    if times[0] > times[1]:
        raise InputError("t_span does not increase (steps go forward in time); for t1 < t0 integrate -f in the time -t")
    return float(times[0]), float(times[1])


def _state(y0: ArrayLike) -> Array:
    start = real_array("y0", y0)
    if start.ndim != 1 or start.size == 0:
        raise InputError(f"y0 has the shape {start.shape} (a vector is needed); give an array of shape (n,)")
    if not np.all(np.isfinite(start)):
        raise InputError("y0 has a number that is not finite (steps begin there); give finite numbers")
    start.setflags(write=False)
    return start


def _times(t_eval: ArrayLike, span: tuple[float, float]) -> list[float]:
    times = real_array("t_eval", t_eval)
    if times.ndim != 1:
        raise InputError(f"t_eval has the shape {times.shape} (it is a list of times); give an array of shape (m,)")
    if not np.all((times >= span[0]) & (times <= span[1])):  # also NaN
        raise InputError(f"t_eval has a time outside t_span (from {span[0]:g} to {span[1]:g}); remove it")
    if np.any(np.diff(times) <= 0):
        raise InputError("t_eval does not increase (the solution is found in this order); sort it, each time once")
    return [float(x) for x in times]


def _tolerance(name: str, value: ArrayLike) -> list[float]:
    found = real_array(name, value)
    if found.ndim > 1:
        raise InputError(f"{name} has the shape {found.shape} (one number belongs to an unknown); give a number or an array of shape (n,)")
    return [float(x) for x in np.atleast_1d(found)]


def _step_lengths(dt: float | None, first: float | None, longest: float,
                  limited: bool) -> tuple[float | None, float | None, float | None]:
    lengths = (None if dt is None else number("dt", dt, positive=True), None if first is None else number("first_step", first, positive=True),
               None if number("max_step", longest) == math.inf else number("max_step", longest, positive=True))
    if dt is not None and (first is not None or lengths[2] is not None):
        raise InputError("dt and first_step or max_step are given (with dt all steps have that length); remove one of them")
    if limited and (dt is not None or lengths[2] is not None):
        raise InputError("forward_euler_step and dt or max_step are given (each limits the length of steps); remove one of them")
    return lengths


def _is_krylov(solver: str, problem: System, n: int, integrator: Method) -> bool:
    if solver not in ("dense", "krylov"):
        raise InputError(f"unknown solver {solver!r} (there is no such name); give \"dense\" or \"krylov\"")
    if solver == "krylov" and problem.places is not None:
        raise InputError("solver=\"krylov\" has no meaning with jac_sparsity or a sparse jac (systems are factorized); remove one of them")
    if solver == "dense" and problem.places is None and n > 200 and problem.collision is not None and integrator.kind != "explicit":
        warn(f"a stage has {n} unknowns (each of its Newton steps takes about {n:.0e}^3 = {n**3:.0e} operations); give "
             "jac_sparsity, or solver=\"krylov\" with a preconditioner, or without one if Q is not stiff", CostWarning)
    return solver == "krylov"


def _event_functions(events: Function | Sequence[Function] | None) -> list[Function]:
    if events is not None and not callable(events) and not isinstance(events, Iterable):
        raise InputError(f"events is {type_of(events)} (it must be a function or a list of functions); give functions of t and y")
    listed = [] if events is None else [events] if callable(events) else list(events)
    for k, event in enumerate(listed):
        if not callable(event):
            raise InputError(f"event {k} is {type_of(event)} (it must be callable); give a function of t and y")
        for attribute, meaning in (("direction", "1, -1 or 0"), ("terminal", "True, False or a number of zeros")):
            value = getattr(event, attribute, 0)
            whole = isinstance(value, (bool, int, float, np.integer, np.floating, np.bool_)) and float(value).is_integer()
            if not whole or (attribute == "terminal" and value < 0):
                raise InputError(f"event {k} has {attribute} = {value!r} (it must be {meaning}); change it")
    return listed
