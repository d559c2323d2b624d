"""Kinetic and relaxation problems on a mesh, built without a case file."""
from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from .arguments import finite, number, real_array, type_of, whole_number
from .errors import InputError
from .library_warnings import LibraryWarnings

Array = NDArray[np.float64]
Interval = Sequence[float]
Quantity = Union[float, Callable[..., float]]
Face = Union[str, Mapping[str, Union[str, Quantity, Sequence[Quantity]]]]
Velocities = Union[tuple[float, Union[int, Sequence[int]]], Mapping[str, Any], tuple[ArrayLike, ArrayLike], Sequence[tuple[ArrayLike, ArrayLike]]]

FACES = (("left", "right"), ("bottom", "top"), ("back", "front"))


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
    velocities   (v_max, points): points midpoints of equal intervals of [-v_max, v_max] per velocity dimension, for models with a
    velocity grid; or a mapping as the table [velocity] of a case, {"set": ["graded", "uniform"], "max": 6, "points": [32, 12]}; or
    arrays (v, weights) for all dimensions, or a list of such pairs, one for each
    epsilon      ε ≥ 0, a number or a function of the coordinates of a point; ε = 0 is the limit scheme
    parameters   numbers, options and lists of texts of the model by name
    boundary     of every face, or (lower, upper), or a sequence of such pairs, or {"left": …, "right": …} with "bottom", "top", "back"
    and "front" for further directions. A face is a kind, or a mapping of the kind and its variables, {"kind": "diffuse", "T": lambda t,
    x: 1 + 0.1 * t, "velocity": [0, 0.1]}: numbers, functions of the time and the coordinates, or lists of them for vectors. The
    functions f, g and h of the kind "given" have v_x, v_y, v_z, numbers, as further arguments; a function total_flow has the time alone
    acceleration of the molecules: a number or a function of the time and the coordinates, or a list of them for each dimension
    largest_acceleration   bound of the absolute values of functions, a number or one for each dimension
    formulation  "finite-volume" (cell averages) or "finite-difference" (point values)
    collisions   of cell averages: at three "gauss" points of each cell (default), or at the "centres" of the cells, with fourth order in
    space with a third of the solves
    reconstruction, equilibrium   as in a case file
    positivity   keeps nonnegative data nonnegative for Δt ≤ r Δt_FE; with collisions of cell averages at Gauss points Δt_FE is a twelfth

    The threads of a step call functions of the time one after the other. Exceptions of these functions end an integration.

    Raises InputError if these are inconsistent."""

    def __init__(self, model: str, *, cells: int | Sequence[int] = (), domain: Interval | Sequence[Interval] = (),
                 velocities: Velocities | None = None, epsilon: float | Callable[..., float] = 1.0,
                 parameters: Mapping[str, Union[float, str, Sequence[str]]] | None = None,
                 boundary: Face | Sequence[Face] | Sequence[Sequence[Face]] = "periodic",
                 acceleration: Quantity | Sequence[Quantity] = (), largest_acceleration: float | Sequence[float] = (),
                 reconstruction: str = "weno5-z", formulation: str = "finite-volume", collisions: str = "", equilibrium: str = "auto",
                 positivity: bool = False) -> None:
        numbers_of_cells = [whole_number("cells", n) for n in (cells if isinstance(cells, (Sequence, np.ndarray)) else [cells])]
        directions = len(numbers_of_cells)
        given = dict(parameters or {})
        v_max, points, sets, lines = _velocities(velocities)
        self._core = _core.KineticProblem(
            model, {name: number(name, x) for name, x in given.items() if not isinstance(x, (str, list, tuple))},
            {name: x for name, x in given.items() if isinstance(x, str)},
            {name: [str(item) for item in x] for name, x in given.items() if isinstance(x, (list, tuple))}, v_max, points, sets, lines, equilibrium, numbers_of_cells, _intervals(domain, directions),
            _faces(boundary, directions), _listed(acceleration),
            [number("largest_acceleration", x) for x in _listed(largest_acceleration)], reconstruction, formulation, collisions, bool(positivity),
            epsilon if callable(epsilon) else number("epsilon", epsilon))
        self.model = model
        self._positivity = bool(positivity)

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

        `initial` is a name of the model's data, or a function of the coordinates of a point that returns all components.
        Averages are exact to rounding if it is smooth between the `jumps` (in increasing order, on a line).
        Raises InputError if the discrete model does not support the data."""
        if not isinstance(initial, str) and not callable(initial):
            raise InputError(f"initial is {type_of(initial)} (a name or a function of the coordinates is needed); give one")
        with LibraryWarnings():
            return self._core.sample_named(initial) if isinstance(initial, str) else self._core.sample_function(
                initial, [number("jumps", x) for x in jumps])

    def state(self, *, jumps: Sequence[float] = (), **variables: ArrayLike | Callable[..., ArrayLike] | Sequence[Any]) -> Array:
        """Returns the state with these variables of the model: of a gas the Maxwellians of rho, u and T, or f (g and h of a
        reduced gas) as a function of the velocity.

            problem.state(rho=lambda x: 1 + 0.1 * np.sin(x), T=1)
            0.7 * problem.state(rho=rho, u=1, T=1) + 0.3 * problem.state(rho=rho, u=-1, T=1)
            problem.state(f=lambda x, v_x: (1 + 0.1 * np.sin(x)) * np.exp(-v_x**2 / 2))

        A variable is a number, a function of the coordinates, or an array with a value for each cell. A vector is a list of
        these, a function that returns all components, or an array [cells, components]. f, g and h are functions of the coordinates
        and of v_x, v_y, v_z, an array [velocities] for each velocity dimension. They return an array [velocities]. Functions give
        averages as in sample(), or point values. Arrays are the averages, or the point values, of cells. Raises InputError with the
        point or the cell."""
        with LibraryWarnings():
            return self._core.state(variables, sorted(number("jumps", x) for x in jumps))

    def fields(self, u: ArrayLike) -> dict[str, Array]:
        """Returns the macroscopic fields of a state by name, [cells] each."""
        return self._core.fields(real_array("u", u))

    def velocity_missed(self, u: ArrayLike) -> Array:
        """Returns the part of the Maxwellian of each cell that the velocities of a gas miss, [cells]: up to 0.001 is good, above 0.1 initial data are
        refused (docs/velocities.md). NaN where a cell, or the model, has no Maxwellian."""
        return self._core.velocity_missed(real_array("u", u))

    def transport(self, u: ArrayLike, t: float = 0.0) -> Array:
        """Returns T(t, u) in the shape of u. Raises InputError unless t is finite."""
        return self._core.transport(real_array("u", u), finite("t", t))

    def collision(self, u: ArrayLike, t: float = 0.0) -> Array:
        """Returns Q(u)/ε in the shape of u. Raises NumericalError if ε = 0 somewhere."""
        return self._core.collision(real_array("u", u), finite("t", t))

    def solve_collision(self, u: ArrayLike, a: float, b: float = 0.0, t: float = 0.0) -> Array:
        """Returns the solution v of the stage equation v = u + a Q(v)/ε + b Q'(v)Q(v)/ε², a ≥ 0, b ≤ 0.

        Raises InputError for other a and b, because a stage may then have no solution, and unless a, b and t are finite."""
        return self._core.solve_collision(real_array("u", u), finite("a", a, lowest=0.0), finite("b", b, highest=0.0), finite("t", t))

    def project_to_equilibrium(self, u: ArrayLike, t: float = 0.0) -> Array:
        """Returns E(ω), the equilibrium with the moments ω of u, in the shape of u: the limit of collisions after a long time.

        Raises NumericalError where there is no equilibrium, and InputError unless t is finite."""
        return self._core.project_to_equilibrium(real_array("u", u), finite("t", t))

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


def _listed(given: Any) -> list[Any]:
    return list(given) if isinstance(given, (Sequence, np.ndarray)) and not isinstance(given, str) else [given]


def _velocities(given: Any) -> tuple[float, list[int], list[str], list[tuple[list[float], list[float]]]]:
    """Largest velocity, points and sets as in a case, and lines of velocities and weights."""
    if given is None:
        return 0.0, [0], [], []
    if isinstance(given, Mapping):
        for name in given:
            if name not in ("set", "max", "points"):
                raise InputError(f"unknown key {name!r} in velocities (set, max and points are valid); remove it")
        sets = [str(name) for name in _listed(given.get("set", ()))]
        points = [whole_number("velocities['points']", n) for n in _listed(given.get("points", 0))]
        return number("velocities['max']", given.get("max", 0.0)), points, sets, []
    if not isinstance(given, (Sequence, np.ndarray)) or isinstance(given, str) or len(given) == 0:
        raise InputError(f"velocities is {given!r} ((v_max, points), a mapping or arrays are needed); give for example (8, 32)")
    if len(given) == 2 and np.ndim(given[0]) == 0:
        points = [whole_number("velocities[1]", n) for n in _listed(given[1])]
        return number("velocities[0]", given[0]), points, [], []
    pairs = [given] if len(given) == 2 and np.ndim(given[0][0]) == 0 else list(given)
    lines = []
    for pair in pairs:
        if len(pair) != 2:
            raise InputError(f"velocities has {len(pair)} arrays for a direction (velocities and weights are needed); give two")
        v, weights = (real_array("velocities", one) for one in pair)
        if v.ndim != 1 or v.shape != weights.shape:
            raise InputError(f"velocities has the shape {v.shape} and weights {weights.shape} (as many weights as velocities are "
                             "needed); give (v, weights)")
        lines.append((v.tolist(), weights.tolist()))
    return 0.0, [0], [], lines


def _face(given: Any, name: str) -> tuple[str, dict[str, list[Any]]]:
    """Kind and values of a face; a value is the list of its components."""
    if isinstance(given, str):
        return given, {}
    if not isinstance(given, Mapping) or not isinstance(given.get("kind"), str):
        raise InputError(f"{name} is {given!r} (a kind, or a mapping with a kind, is needed); give for example \"outflow\", or "
                         "{\"kind\": \"diffuse\", \"T\": 1.1}")
    return given["kind"], {str(key): _listed(value) for key, value in given.items() if key != "kind"}


def _faces(boundary: Any, directions: int) -> list[list[tuple[str, dict[str, list[Any]]]]]:
    if isinstance(boundary, str):
        return [[(boundary, {})] * 2] * directions
    names = [name for pair in FACES[:directions] for name in pair]
    if isinstance(boundary, Mapping):
        if "kind" in boundary:
            return [[_face(boundary, "boundary")] * 2] * directions
        if set(boundary) != set(names):
            raise InputError(f"boundary has the faces {sorted(map(str, boundary))} ({', '.join(names)} are needed); give each of them")
        return [[_face(boundary[name], f"boundary[{name!r}]") for name in pair] for pair in FACES[:directions]]
    pairs = [boundary] if all(isinstance(one, (str, Mapping)) for one in boundary) else list(boundary)
    if len(pairs) != directions or any(isinstance(pair, (str, Mapping)) or len(pair) != 2 for pair in pairs):
        raise InputError(f"boundary is {boundary!r} (a kind, or a pair of kinds for each direction, is needed); give for example "
                         "(\"outflow\", \"outflow\")")
    return [[_face(one, "boundary") for one in pair] for pair in pairs]
