"""Apsis: stiff relaxation and kinetic equations u_t = T(u) + Q(u)/ε by SSP multi-derivative IMEX Runge–Kutta methods.

    apsis.run("paper/bgk-mixed").fields["rho"]           a kinetic problem from a case
    apsis.open("results/layer").plot()                   a stored run
    apsis.method("md-imex-6-3").certificate.order        methods and their certificates
    apsis.integrate(problem, u0, t, method=…, dt=…)      a problem of your own, or a KineticProblem on a mesh
    apsis.solve_ivp(transport, collision, t_span, y0)    the form and the result object of scipy.integrate.solve_ivp
    apsis.solve_steady(problem, u0).u                    the steady state of a KineticProblem, without steps in time

All quantities are dimensionless.
"""
from ._core import model_names as models
from ._core import version as _version
from .errors import ApsisWarning, ClaimError, CostWarning, Error, FileError, InputError, NumericalError
from .general import GeneralProblem
from .ivp import solve_ivp
from .kinetic import KineticProblem
from .methods import Certificate, Method, OrderCondition, method, methods, order_conditions, read_method
from .problems import RelaxationProblem, Solution, integrate
from .runs import Case, Result, cases, run
from .steady import SteadyState, solve_steady
from .stored import open

__version__: str = _version()

__all__ = ["ApsisWarning", "Case", "Certificate", "ClaimError", "CostWarning", "Error", "FileError", "GeneralProblem", "InputError", "KineticProblem", "Method", "NumericalError",
           "OrderCondition", "RelaxationProblem", "Result", "Solution", "SteadyState", "cases", "integrate", "method", "methods", "models",
           "open", "order_conditions", "read_method", "run", "solve_ivp", "solve_steady"]
