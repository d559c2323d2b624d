"""Problems defined by functions on arrays."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Callable, Sequence, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from .arguments import number, real_array, text, type_of, whole_number
from .derivative_checks import NotAnalytic
from .errors import CostWarning, InputError
from .general import GeneralProblem, collision_functions
from .kinetic import KineticProblem
from .library_warnings import LibraryWarnings, warn
from .methods import Method, html_table, method as find_method

Array = NDArray[np.float64]
StepsBy = tuple[Union[float, None], float, Union[int, None], Union[float, None], str]  # dt, safety, startup_growth, tolerance, controller


@dataclass
class RelaxationProblem:
    """u' = T(t, u) + C(ω)(E(ω) − u)/ε with conserved moments ω = ℛu, ℛE(ω) = ω.

    Stages are convex combinations of u and E in closed form, nonnegative where both are; ε = 0 is the limit scheme. The
    functions get read-only copies of arrays with the shape of u0, and may store them:

        transport(t, u)           T, of the shape of u
        moments(u)                ω, of any type
        equilibrium(omega)        E, of the shape of u
        rate(omega)               C ≥ 0: a number, or an array that NumPy broadcasts to the shape of u. Systems side by side,
                                  such as cells, may have different C/ε; numbers that moments couple have the same
        forward_euler_step(t, u)  Δt_FE of the transport, for steps without dt
        admissible(u)             whether u is admissible as a stage
    """

    transport: Callable[[float, Array], ArrayLike]
    moments: Callable[[Array], Any]
    equilibrium: Callable[[Any], ArrayLike]
    rate: Callable[[Any], ArrayLike]
    epsilon: float
    forward_euler_step: Callable[[float, Array], float] | None = None
    admissible: Callable[[Array], bool] | None = None


@dataclass(frozen=True, eq=False)
class Solution:
    """States u[k] at the times t[k], with the numbers of accepted and rejected steps, the name of the method, and the reason for
    its choice. The reason is "" if the caller named the method.

    derivatives of a GeneralProblem: "jacobian", "complex steps" or "finite differences"; "" for other problems."""

    t: Array
    u: Array
    steps: int
    rejected: int
    method: str = ""
    reason: str = ""
    derivatives: str = ""

    def __repr__(self) -> str:
        return (f"<apsis.Solution: {len(self.t)} states of shape {self.u.shape[1:]} from t = {self.t[0]:g} to {self.t[-1]:g}, "
                f"{self.steps} steps{f' of {self.method}' if self.method else ''}, {self.rejected} rejected>")

    def _repr_html_(self) -> str:
        return html_table({"times": f"{len(self.t)}, from {self.t[0]:g} to {self.t[-1]:g}", "shape of a state": str(self.u.shape[1:]),
                           "method": self.method, "steps": str(self.steps), "rejected steps": str(self.rejected)})

    def __eq__(self, other: object) -> bool:
        """Bitwise equality, including NaN."""
        return (isinstance(other, Solution) and (self.steps, self.rejected) == (other.steps, other.rejected)
                and np.array_equal(self.t, other.t, equal_nan=True) and np.array_equal(self.u, other.u, equal_nan=True))


def integrate(problem: RelaxationProblem | GeneralProblem | KineticProblem, u0: ArrayLike, t: Sequence[float] | Array, method: str | Method = "auto", *,
              dt: float | None = None, safety: float = 1.0, startup: str = "none", startup_growth: int = 2, tolerance: float | None = None,
              controller: str = "predictive", threads: int | None = None) -> Solution:
    """Integrates from u0 at t[0] and returns the states at all times of t.

        method          a name, a file or a Method; "auto" chooses from the table of `apsis list choices`
        dt              length of steps, shortened until it divides each interval
        safety          without dt: steps of safety · r · Δt_FE, 0 < safety
        startup         "graded" resolves the initial layer of data out of equilibrium by short first steps
        startup_growth  ratio of the successive times of these steps, from 2 to 64; with 4 they are half as many as with 2 and less
                        accurate
        tolerance       bound of the estimated error of a step
        controller      law that computes the next step from the errors of the last steps (`apsis list controllers`)
        threads         of a problem on a mesh; all processors for large problems by default, and results do not depend on it

    The result has the chosen method and the reason. Without dt, and with forward_euler_step, admissible or positivity, "auto" preserves
    bounds. An ApsisWarning names a better method if dt is unfit for ε (docs/plateaus.md). On a mesh r Δt_FE is at most the
    linear stability limit (Certificate.cfl_limits).

    The estimated error of a step is the largest difference to the embedded solution of the method. With a tolerance, steps are shortened
    until this error is below it. Neither dt nor forward_euler_step is then needed. Methods without an embedded solution take each step
    twice, in one piece and in two halves, and compare the results.

    Raises InputError, NumericalError with step and t, and exceptions of the functions."""
    if not isinstance(problem, (RelaxationProblem, GeneralProblem, KineticProblem)):
        raise InputError(f"problem is {type_of(problem)} (an equation is needed); give an apsis.RelaxationProblem, an "
                         "apsis.GeneralProblem or an apsis.KineticProblem")
    if startup not in ("none", "graded"):
        raise InputError(f"unknown start-up {startup!r} (there is no such name); give \"none\" or \"graded\"")
    if startup == "none" and startup_growth != 2:
        raise InputError("startup_growth has no meaning without a graded start (it is the ratio of its times); "
                         "give startup = \"graded\" too, or remove it")
    if tolerance is None and controller != "predictive":
        raise InputError("controller has no meaning without a tolerance (it follows the estimated errors); give a tolerance too, or remove it")
    chosen, reason = _chosen(problem, dt, startup, tolerance) if _is_auto(method) else (method, "")
    integrator = chosen if isinstance(chosen, Method) else find_method(_name(chosen))
    steps_by = (None if dt is None else number("dt", dt), number("safety", safety, positive=True),
                whole_number("startup_growth", startup_growth) if startup == "graded" else None,
                None if tolerance is None else number("tolerance", tolerance), text("controller", controller))
    times_wanted = real_array("t", t).ravel().tolist()
    with LibraryWarnings():
        return _integrate(problem, real_array("u0", u0), times_wanted, integrator, steps_by, reason, threads)


def _integrate(problem: RelaxationProblem | GeneralProblem | KineticProblem, u0: Array, times_wanted: list[float], integrator: Method,
               steps_by: StepsBy, reason: str, threads: int | None) -> Solution:
    if isinstance(problem, KineticProblem):
        return Solution(*problem._core.integrate(u0, times_wanted, integrator._core, *steps_by,
                                                 None if threads is None else whole_number("threads", threads)), integrator.name, reason)
    if isinstance(problem, GeneralProblem):
        return _integrate_general(problem, u0, times_wanted, integrator, steps_by, reason)
    _require_functions(problem, ("transport", "moments", "equilibrium", "rate"), ("forward_euler_step", "admissible"))
    times, states, steps, rejected = _core.integrate(
        problem.transport, problem.moments, problem.equilibrium, problem.rate, problem.forward_euler_step, problem.admissible,
        number("epsilon", problem.epsilon), u0, times_wanted, integrator._core, *steps_by)
    return Solution(times, states, steps, rejected, integrator.name, reason)


def _is_auto(method: object) -> bool:
    return isinstance(method, str) and method == "auto"


def _chosen(problem: RelaxationProblem | GeneralProblem | KineticProblem, dt: float | None, startup: str, tolerance: float | None) -> tuple[str, str]:
    """The method for a problem, and why."""
    kinetic = isinstance(problem, KineticProblem)
    # Without dt the SSP coefficient sets the step.
    bounded = problem._positivity or (dt is None and tolerance is None) if isinstance(problem, KineticProblem) else not (
        problem.forward_euler_step is None and problem.admissible is None)
    tolerated = None if tolerance is None else number("tolerance", tolerance)
    return _core.choose_method(kinetic, isinstance(problem, GeneralProblem), bounded, startup == "graded", tolerated, None)


def _require_functions(problem: object, needed: Sequence[str], optional: Sequence[str]) -> None:
    for name in (*needed, *optional):
        function = getattr(problem, name)
        if not callable(function) and not (function is None and name in optional):
            raise InputError(f"{name} of the problem is {type_of(function)} (it must be callable); give a function")


def _warn_of_cost(unknowns: int, integrator: Method) -> None:
    """A warning before an expensive run."""
    if unknowns <= 200 or integrator.kind == "explicit":
        return
    warn(f"a stage has {unknowns} unknowns (each of its Newton steps takes about {unknowns:.0e}^3 = {unknowns**3:.0e} operations "
         f"and {3 * unknowns} calls of collision); if Q acts cell by cell, give u0 as [cells, unknowns] and local=True, if it "
         "is not stiff solver=\"krylov\", if it is a preconditioner too, or a RelaxationProblem if Q has that form", CostWarning)


def _integrate_general(problem: GeneralProblem, u0: Array, times: list[float], integrator: Method, steps_by: StepsBy,
                       reason: str) -> Solution:
    _require_functions(problem, ("collision",), ("transport", "jacobian", "forward_euler_step", "admissible"))
    if u0.size == 0:
        raise InputError("u0 has no numbers; give an initial state")
    if problem.local and u0.ndim == 0:
        raise InputError("local = True needs an axis of the unknowns of a cell (u0 is a number); give u0 as [cells, unknowns]")
    if problem.solver not in ("dense", "krylov"):
        raise InputError(f"unknown solver {problem.solver!r} (there is no such name); give \"dense\" or \"krylov\"")
    if problem.solver == "dense":
        _warn_of_cost(u0.shape[-1] if problem.local else u0.size, integrator)
    q = collision_functions(problem, u0)
    q.derivatives.check.restarts = bool(np.any(integrator.ddot != 0))
    while True:
        try:
            found = _core.integrate_general(q.collision, q.derivatives.product, q.derivatives.curvature, problem.transport,
                                            problem.forward_euler_step, q.admissible, q.preconditioner, q.coupling, problem.solver == "krylov",
                                            u0, times,
                                            integrator._core, *steps_by)
            break
        except NotAnalytic:  # once: derivatives are differences now
            continue
    return Solution(*found, integrator.name, reason, q.derivatives.by)


def _name(method: object) -> str:
    if not isinstance(method, str):
        raise InputError(f"method is {type_of(method)} (it must be a name, a file or an apsis.Method); see apsis.methods()")
    return method
