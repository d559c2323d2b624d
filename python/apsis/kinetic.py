"""Kinetic and relaxation problems on a mesh, built without a case file."""
from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from .arguments import number, real_array, whole_number
from .errors import InputError

Array = NDArray[np.float64]
Interval = Sequence[float]


class KineticProblem:
    """u_t + Σ_k ∂_k(v_k u) = S(u) + Q(u)/ε for a model of the catalogue (apsis.models()) on a mesh.

    It uses the same C++ builder as runs of cases. A state is an array [cells, components]. All quantities are
    dimensionless.

        problem = apsis.KineticProblem("bgk", cells=40, domain=(0, 2), velocities=(15, 150), epsilon=lambda x: 1e-3 + x * x)
        u0 = problem.sample("mixed-v")
        u = apsis.integrate(problem, u0, (0, 0.5), "md-imex-6-3").u[-1]
        problem.fields(u)["rho"]

    cells        number of cells; a sequence with one number for each space dimension
    domain       (lower, upper); a sequence of such pairs, one for each space dimension
    velocities   (v_max, points): points midpoints on [-v_max, v_max] per velocity dimension, for models with a velocity grid
    epsilon      ε ≥ 0, a number or a function of the coordinates of a point; ε = 0 is the limit scheme
    parameters   numbers, options and lists of texts of the model by name
    boundary     kind of every face, or (lower, upper), or a sequence of such pairs
    formulation  "finite-volume" (cell averages) or "finite-difference" (point values)
    reconstruction, equilibrium   as in a case file
    positivity   keeps nonnegative data nonnegative for Δt ≤ r Δt_FE

    Raises InputError if these are inconsistent."""

    def __init__(self, model: str, *, cells: int | Sequence[int] = (), domain: Interval | Sequence[Interval] = (),
                 velocities: tuple[float, int] | None = None, epsilon: float | Callable[..., float] = 1.0,
                 parameters: Mapping[str, Union[float, str, Sequence[str]]] | None = None,
                 boundary: str | Sequence[str] | Sequence[Sequence[str]] = "periodic",
                 reconstruction: str = "weno5-z", formulation: str = "finite-volume", equilibrium: str = "auto",
                 positivity: bool = False) -> None:
        numbers_of_cells = [whole_number("cells", n) for n in (cells if isinstance(cells, (Sequence, np.ndarray)) else [cells])]
        directions = len(numbers_of_cells)
        given = dict(parameters or {})
        v_max, points = velocities if velocities is not None else (0.0, 0)
        self._core = _core.KineticProblem(
            model, {name: number(name, x) for name, x in given.items() if not isinstance(x, (str, list, tuple))},
            {name: x for name, x in given.items() if isinstance(x, str)},
            {name: [str(item) for item in x] for name, x in given.items() if isinstance(x, (list, tuple))}, number("velocities[0]", v_max),
            whole_number("velocities[1]", points), equilibrium, numbers_of_cells, _intervals(domain, directions),
            _faces(boundary, directions), reconstruction, formulation, bool(positivity),
            epsilon if callable(epsilon) else number("epsilon", epsilon))
        self.model = model

    @property
    def shape(self) -> tuple[int, int]:
        """Shape of a state: (cells, components)."""
        cells, components = self._core.shape()
        return cells, components

    @property
    def x(self) -> Array:
        """Cell centres, [cells] or [cells, dimensions]; empty without space."""
        return self._core.centres()

    @property
    def v(self) -> Array:
        """Velocities of the components, [components] or [components, dimensions]; empty without space."""
        return self._core.velocities()

    @property
    def epsilon(self) -> Array:
        """ε at the cell centres."""
        return self._core.epsilon()

    def sample(self, initial: str | Callable[..., ArrayLike], jumps: Sequence[float] = ()) -> Array:
        """Returns cell averages or point values of initial data.

        `initial` is a name of the model's data, or a function of the coordinates of a point that returns all components;
        averages are exact to rounding where it is smooth between the `jumps` (in increasing order, on a line).
        Raises InputError if the discrete model does not support the data."""
        if isinstance(initial, str):
            return self._core.sample_named(initial)
        if not callable(initial):
            raise InputError(f"initial is a {type(initial).__name__} (a name or a function of the coordinates is needed); give one")
        return self._core.sample_function(initial, [number("jumps", x) for x in jumps])

    def fields(self, u: ArrayLike) -> dict[str, Array]:
        """Returns the macroscopic fields of a state by name, [cells] each."""
        return self._core.fields(real_array("u", u))

    def transport(self, u: ArrayLike, t: float = 0.0) -> Array:
        """Returns T(t, u) in the shape of u."""
        return self._core.transport(real_array("u", u), number("t", t))

    def collision(self, u: ArrayLike, t: float = 0.0) -> Array:
        """Returns Q(u)/ε in the shape of u. Raises NumericalError if ε = 0 somewhere."""
        return self._core.collision(real_array("u", u), number("t", t))

    def solve_collision(self, u: ArrayLike, a: float, b: float = 0.0, t: float = 0.0) -> Array:
        """Returns the solution v of the stage equation v = u + a Q(v)/ε + b Q'(v)Q(v)/ε², a ≥ 0, b ≤ 0."""
        return self._core.solve_collision(real_array("u", u), number("a", a), number("b", b), number("t", t))

    def forward_euler_step(self, u: ArrayLike) -> float:
        """Returns Δt_FE of the transport; infinite without space."""
        return self._core.forward_euler_step(real_array("u", u))

    def __repr__(self) -> str:
        return f"<apsis.KineticProblem {self.model!r}: {self.shape[0]} cells, {self.shape[1]} components>"


def _intervals(domain: Any, directions: int) -> list[list[float]]:
    if directions == 0:
        return []
    pairs = np.atleast_2d(real_array("domain", domain))
    if pairs.shape != (directions, 2):
        raise InputError(f"domain has the shape {pairs.shape} (a pair of numbers for each of {directions} directions is needed); "
                         "give (lower, upper)")
    return [[float(lower), float(upper)] for lower, upper in pairs]


def _faces(boundary: Any, directions: int) -> list[list[str]]:
    if isinstance(boundary, str):
        return [[boundary, boundary]] * directions
    pairs = [boundary] if all(isinstance(one, str) for one in boundary) else list(boundary)
    if len(pairs) != directions or any(len(pair) != 2 or not all(isinstance(kind, str) for kind in pair) for pair in pairs):
        raise InputError(f"boundary is {boundary!r} (a kind, or a pair of kinds for each direction, is needed); give for example "
                         "(\"outflow\", \"outflow\")")
    return [list(pair) for pair in pairs]
