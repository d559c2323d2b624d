"""Initial data, walls, velocities and forces given as Python objects, compared with the same cases as formulas."""
import apsis
import numpy as np
import pytest

SPACE = {"cells": 20, "domain": [0.0, 1.0]}


def case(initial=None, model="bgk", **more):
    base = {"model": {"name": model, "epsilon": 0.01}, "space": dict(SPACE), "time": {"method": "md-imex-3-2", "end": 0.005, "safety": 0.5}}
    if model == "bgk":
        base["velocity"] = {"max": 10, "points": 40}
    if initial is not None:
        base["initial"] = initial
    for table, keys in more.items():
        base[table] = {**base.get(table, {}), **keys}
    return base


def gas(**more):
    return apsis.KineticProblem("bgk", **{"cells": 20, "domain": (0, 1), "velocities": (10, 40), "epsilon": 1e-2, **more})


def rho(x):
    return 1 + 0.1 * np.sin(2 * np.pi * x)


FORMULAS = {"rho": "1 + 0.1*sin(2*pi*x)", "u": 0.2, "T": "1 - 0.1*x"}
FUNCTIONS = {"rho": rho, "u": 0.2, "T": lambda x: 1 - 0.1 * x}


@pytest.mark.parametrize("formulation", ["finite-volume", "finite-difference"])
def test_functions_are_sampled_as_formulas_of_a_case(formulation):
    space = {"formulation": formulation}
    by_formulas = apsis.run(case(FORMULAS, space=space))
    by_functions = apsis.run(case(space=space), initial=FUNCTIONS)
    # sin of NumPy and of the C library may differ in the last bit. Such differences add up over the steps.
    np.testing.assert_allclose(by_functions.f, by_formulas.f, rtol=0, atol=1e-14)
    problem = gas(formulation=formulation)
    np.testing.assert_allclose(problem.state(**FUNCTIONS), apsis.run(case(FORMULAS, space=space, time={"end": 0})).f, rtol=1e-12, atol=1e-300)
    if formulation == "finite-difference":
        np.testing.assert_allclose(problem.fields(problem.state(**FUNCTIONS))["rho"], rho(problem.x), rtol=1e-14)


def test_arrays_are_the_averages_of_cells():
    values = np.random.default_rng(1).uniform(0.5, 2.0, (3, 20))
    problem = gas()
    u = problem.state(rho=values[0], u=values[1] - 1, T=values[2])
    for name, wanted in (("rho", values[0]), ("u", values[1] - 1), ("T", values[2])):
        np.testing.assert_allclose(problem.fields(u)[name], wanted, rtol=1e-13, atol=1e-13)
    start = apsis.run(case(time={"end": 0}), initial={"rho": values[0], "u": values[1] - 1, "T": values[2]})
    np.testing.assert_array_equal(start.f, u)


def test_sums_of_states_are_data_out_of_equilibrium():
    problem = gas()
    beams = 0.7 * problem.state(rho=rho, u=1, T=1) + 0.3 * problem.state(rho=rho, u=-1, T=1)
    by_case = apsis.run(case({"part": [{"weight": 0.7, "rho": FORMULAS["rho"], "u": 1, "T": 1}, {"weight": 0.3, "rho": FORMULAS["rho"], "u": -1, "T": 1}]},
                             time={"end": 0}))
    np.testing.assert_allclose(beams, by_case.f, rtol=1e-12, atol=1e-300)
    started = apsis.run(case(time={"end": 0}), initial=beams)
    np.testing.assert_array_equal(started.f, beams)


def test_a_function_of_x_and_v_is_the_distribution():
    start = apsis.run(case(time={"end": 0}), initial=lambda x, v: rho(x) * np.exp(-0.5 * v**2) / np.sqrt(2 * np.pi))
    np.testing.assert_allclose(start.f, gas().state(rho=rho, T=1), rtol=1e-9, atol=1e-15)  # the discrete Maxwellian, up to its midpoint rule
    relaxed = apsis.run(case(model="relaxation", time={"end": 0}), initial=lambda x: [0.5 * x, 0.25 * x])  # no velocity grid: components
    assert relaxed.f.shape == (20, 2) and relaxed.f.sum(axis=1)[0] == pytest.approx(0.75 * 0.025)


def maxwellian(*v):
    return (2 * np.pi) ** (-len(v) / 2) * np.exp(-sum(one**2 for one in v) / 2)


@pytest.mark.parametrize("d", [1, 2, 3])
@pytest.mark.parametrize("reduced", [False, True])
def test_functions_get_an_array_of_each_component_of_the_velocity(d, reduced):
    degrees, points = (d + 1 if reduced else d), {1: 24, 2: 12, 3: 8}[d]
    shapes = []

    def state(x, *v):
        shapes.append([np.shape(one) for one in (x, *v)])
        n = points**d
        g = (1 + 0.1 * x + 0.05 * v[-1]) * maxwellian(*v)
        if reduced:
            g[n:] *= 1 + 0.01 * v[0][n:]  # h = (D - d) T g of another temperature
        return g

    of_model = {"velocity_dimensions": d, "degrees_of_freedom": degrees}

    def gas_with(initial=None):
        made = case(initial, velocity={"max": 7, "points": points}, space={"cells": 7, "reconstruction": "upwind1"}, time={"end": 0})
        made["model"].update(of_model)
        return made
    by_state = apsis.run(gas_with(), initial=state).f
    components = points**d * (2 if reduced else 1)
    assert shapes[0] == [()] + d * [(components,)]

    def of_velocity(x, *v):
        assert [one.shape for one in v] == d * [(points**d,)] and not v[0].flags.writeable
        return (1 + 0.1 * x + 0.05 * v[-1]) * maxwellian(*v)
    functions = {"f": of_velocity}
    if reduced:
        functions = {"g": of_velocity, "h": lambda x, *v: of_velocity(x, *v) * (1 + 0.01 * v[0])}
    np.testing.assert_array_equal(apsis.run(gas_with(), initial=functions).f, by_state)
    problem = apsis.KineticProblem("bgk", cells=7, domain=(0, 1), velocities=(7, points), parameters=of_model, reconstruction="upwind1")
    np.testing.assert_array_equal(problem.state(**functions), by_state)
    # The same as formulas of a case.
    names = ["v_x", "v_y", "v_z"][:d]
    f = f"(1 + 0.1*x + 0.05*{names[-1]})*(2*pi)^(-{d}/2)*exp(-({' + '.join(name + '^2' for name in names)})/2)"
    formulas = {"g": f, "h": f + "*(1 + 0.01*v_x)"} if reduced else {"f": f}
    np.testing.assert_allclose(apsis.run(gas_with(formulas)).f, by_state, rtol=1e-13, atol=1e-300)


def test_arrays_are_values_at_the_velocities_of_cells():
    problem = gas()
    values = maxwellian(problem.v) * np.linspace(1, 2, 20)[:, None]
    np.testing.assert_array_equal(problem.state(f=values), values)
    np.testing.assert_allclose(problem.state(f=values[3]), np.tile(values[3], (20, 1)), rtol=1e-15)  # the averages have rounding errors
    for wrong, says in ((values[:, :39], "state['f'] has the shape (20, 39)"), (lambda x, v: v[1:], "state['f'] returned an array of shape (39,)"),
                        (lambda x, v: -maxwellian(v), "state has no distribution at x = "), (lambda x, v: v * np.nan, "state has no distribution")):
        with pytest.raises(apsis.InputError) as refused:
            problem.state(f=wrong)
        assert says in str(refused.value)
    with pytest.raises(apsis.InputError, match="do not belong together"):
        problem.state(f=values, T=1)


def test_a_given_boundary_is_a_function_of_the_velocity():
    seen = []

    def entering(t, x, v_x):
        seen.append((t, x, v_x))
        return 0.5 * float(maxwellian(v_x))
    problem = gas(boundary=({"kind": "given", "f": entering}, "outflow"), formulation="finite-difference")
    same = gas(boundary=({"kind": "inflow", "rho": 0.5, "T": 1}, "outflow"), formulation="finite-difference")
    u = problem.state(rho=1, T=1)
    np.testing.assert_allclose(problem.transport(u), same.transport(u), rtol=0, atol=1e-8)  # the discrete Maxwellian of the inflow
    assert {v for _, _, v in seen} == set(problem.v[problem.v > 0]) and all(isinstance(v, float) for _, _, v in seen)


def test_a_total_flow_is_a_function_of_the_time():
    """In one space dimension the total flow equals the flux."""
    def channel(left, right):
        return gas(boundary=({"kind": "mass-flow", **left}, {"kind": "mass-flow", **right}))
    problem = channel({"total_flow": lambda t: 0.2 + t}, {"total_flow": -0.3})
    same = channel({"flux": lambda t, x: 0.2 + t}, {"flux": -0.3})
    u = problem.state(rho=1, T=1)
    for t in (0.0, 0.4):
        np.testing.assert_array_equal(problem.transport(u, t), same.transport(u, t))
    with pytest.raises(apsis.InputError, match="has values of 'flux' and 'total_flow'"):
        channel({"flux": 1, "total_flow": 1}, {"flux": 0})


def test_averages_of_functions_with_jumps_are_exact():
    problem = gas()
    u = problem.state(rho=lambda x: 1.0 if x < 0.43 else 3.0, T=1, jumps=[0.43])
    assert problem.fields(u)["rho"][8] == pytest.approx(0.6 * 1 + 0.4 * 3, rel=1e-14)
    start = apsis.run(case(time={"end": 0}), initial={"rho": lambda x: 1.0 if x < 0.43 else 3.0, "T": 1}, jumps=[0.43])
    np.testing.assert_array_equal(start.f, u)


def test_data_of_python_replace_those_of_a_case_and_are_named_in_its_record(tmp_path):
    problem = gas()
    result = apsis.run(case({"rho": 7, "T": 7, "region": [{"where": "x > 0.5", "T": 1}]}), initial=problem.state(rho=1, T=1), out=tmp_path / "a")
    assert result.summary["case"]["initial"] == {"from": "python"}
    assert result.fields["rho"][0, 0] == pytest.approx(1)
    apsis.run("paper/bgk-mixed", "space.cells=10", "velocity.points=60", "time.end=0", initial={"rho": 1, "T": 1})
    with pytest.raises(apsis.InputError, match="they were given in Python"):
        apsis.run(case({"from": "python"}))


def test_a_restart_takes_the_state_of_the_checkpoint(tmp_path):
    calls = []

    def density(x):
        calls.append(x)
        return rho(x)
    initial = {"rho": density, "T": 1}
    apsis.run(case(), initial=initial, out=tmp_path / "half")
    whole = apsis.run(case(), "time.end=0.01", initial=initial)
    calls.clear()
    for again in ({"initial": initial}, {}):
        rest = apsis.run(case(None if again else {"from": "python"}), "time.end=0.01", restart=tmp_path / "half" / "checkpoint.h5", **again)
        np.testing.assert_array_equal(rest.f, whole.f)
    assert not calls


def test_a_result_continues_on_a_finer_mesh(tmp_path):
    coarse = apsis.run(case(FORMULAS, space={"boundary": "periodic"}), out=tmp_path / "coarse")
    file = str(tmp_path / "coarse" / "solution.h5")
    fine = apsis.run(case({"file": file}, space={"cells": 50}, time={"end": 0}))
    assert fine.f.sum() / 50 == pytest.approx(coarse.f.sum() / 20, rel=1e-14)
    again = apsis.run(case({"file": file}, time={"end": 0}))
    np.testing.assert_array_equal(again.f, coarse.f)


def nothing(x):
    return None


@pytest.mark.parametrize("initial, says", [
    ({"rho": 1}, "'T' is missing in initial (it is the temperature"),
    ({"rho": 1, "T": 1, "v": 1}, "unknown variable 'v' in initial (the model has no such variable); valid: rho, u, T"),
    ({"rho": -1, "T": 1}, "initial has no Maxwellian at x = "),
    ({"rho": np.ones(19), "T": 1}, "initial['rho'] has the shape (19,) (that of the cells is (20,))"),
    ({"rho": np.where(np.arange(20) == 7, -1.0, 1.0), "T": 1}, "initial has no Maxwellian in cell 7 (density -1 is not positive)"),
    ({"rho": lambda x: float("nan"), "T": 1}, "initial has no Maxwellian at x = "),
    ({"rho": nothing, "T": 1}, "initial['rho'] returned None"),
    ({"rho": "one", "T": 1}, "initial['rho'] is an array of type"),
    ({"rho": np.ones(20), "T": lambda x: 1}, "initial['rho'] has a value for each cell and initial['T'] is a function"),
    (np.ones((20, 39)), "initial has the shape (20, 39) (that of a state is (20, 40))"),
    (np.full((20, 40), np.nan), "initial is not finite in cell 0"),
    (lambda x, v: v * np.nan, "initial is not finite at x = "),
    (lambda x, v: v[1:], "initial returned an array of shape (39,)"),
    (3 + 4j, "initial is an array of type complex128"),
    ({}, "'rho' is missing in initial"),
])
def test_data_that_cannot_be_used_are_refused_with_their_place(initial, says):
    with pytest.raises(apsis.InputError) as refused:
        apsis.run(case(), initial=initial)
    assert says in str(refused.value)


def test_exceptions_of_functions_leave_a_run_as_they_are():
    def broken(*point):
        raise ZeroDivisionError("mine")
    for initial in (broken, {"rho": broken, "T": 1}):
        with pytest.raises(ZeroDivisionError, match="mine"):
            apsis.run(case(), initial=initial)


WALLS = {"left": {"kind": "diffuse", "T": "1 + 0.2*sin(40*t)", "accommodation": 0.7}, "right": {"kind": "inflow", "rho": 1, "u": -0.1, "T": 1.1}}


@pytest.mark.parametrize("formulation", ["finite-volume", "finite-difference"])
def test_walls_with_functions_equal_those_of_a_case(formulation):
    """Functions give the same solution if several threads call them."""
    by_case = apsis.run(case({"rho": 1, "T": 1}, space={"formulation": formulation, "cells": 40}, boundary=WALLS, force={"acceleration": "0.3*cos(9*t)*x"}))
    problem = gas(cells=40, formulation=formulation, acceleration=lambda t, x: 0.3 * np.cos(9 * t) * x, largest_acceleration=0.3,
                  boundary={"left": {"kind": "diffuse", "T": lambda t, x: 1 + 0.2 * np.sin(40 * t), "accommodation": 0.7},
                            "right": {"kind": "inflow", "rho": 1, "u": -0.1, "T": lambda t, x: 1.1}})
    steps = by_case.summary["steps"]
    solutions = [apsis.integrate(problem, problem.state(rho=1, T=1), (0, 0.005), "md-imex-3-2", dt=0.005 / steps, threads=n) for n in (1, 2)]
    np.testing.assert_array_equal(solutions[0].u, solutions[1].u)
    # The tolerance is the error of steps: those of the case follow its rule and are not exactly end/steps.
    np.testing.assert_allclose(solutions[0].u[-1], by_case.f, rtol=0, atol=2e-5)


def test_velocities_are_sets_or_arrays():
    plane = {"parameters": {"velocity_dimensions": 2}, "formulation": "finite-difference"}
    sets = gas(velocities={"set": ["graded", "uniform"], "max": 6, "points": [16, 12]}, **plane)
    assert sets.v.shape == (192, 2)
    by_case = apsis.run(case({"rho": 1, "T": 1}, model="bgk", velocity={"set": ["graded", "uniform"], "max": 6, "points": [16, 12]},
                             space={"formulation": "finite-difference"}, time={"end": 0}), "model.velocity_dimensions=2")
    np.testing.assert_array_equal(sets.v, by_case.v)
    x, w = np.polynomial.hermite_e.hermegauss(20)
    given = (x, w * np.exp(0.5 * x**2))
    line = gas(velocities=given)
    np.testing.assert_array_equal(line.v, x)
    np.testing.assert_allclose(line.v, gas(velocities={"set": "gauss-hermite", "points": 20}).v, rtol=1e-13)
    np.testing.assert_allclose(line.fields(line.state(rho=2, u=0.1, T=0.9))["T"], 0.9, rtol=1e-13)
    both = gas(velocities=[given, (np.linspace(-5, 5, 21), np.full(21, 0.5))], **plane)
    assert both.v.shape == (420, 2)
    assert gas(velocities=given, **plane).v.shape == (400, 2)


def test_a_force_accelerates_the_gas():
    problem = gas(acceleration=0.5)
    u = problem.state(rho=2, T=1)
    change = problem.transport(u)
    np.testing.assert_allclose(change @ problem.v * 0.5, 2 * 0.5, rtol=1e-9)  # momentum rho a; weights are 0.5


def failing(t, x):
    raise KeyError("mine")


@pytest.mark.parametrize("threads", [1, 2])
def test_exceptions_of_walls_end_an_integration(threads):
    for more in ({"boundary": ({"kind": "diffuse", "T": failing}, "outflow")}, {"acceleration": failing, "largest_acceleration": 1}):
        problem = gas(**more)
        with pytest.raises(KeyError, match="mine"):
            apsis.integrate(problem, problem.state(rho=1, T=1), (0, 0.01), "md-imex-3-2", threads=threads)
        with pytest.raises(KeyError, match="mine"):
            problem.transport(problem.state(rho=1, T=1))


def wall(**values):
    return {"boundary": {"left": {"kind": "diffuse", **values}, "right": "outflow"}}


@pytest.mark.parametrize("more, says", [
    (wall(T="warm"), "boundary['left']['T'] is 'warm' (a finite number or a function of t and x is needed)"),
    (wall(T=float("inf")), "boundary['left']['T'] is inf"),
    (wall(T=-1), "the boundary has no Maxwellian"),
    (wall(temperature=1), "boundary 'diffuse' has no variable 'temperature'"),
    (wall(velocity=[0, 1]), "'velocity' of boundary 'diffuse' has 2 components (the model has 1)"),
    ({"boundary": {"left": "outflow"}}, "boundary has the faces ['left'] (left, right are needed)"),
    ({"boundary": {"left": "outflow", "right": 3}}, "boundary['right'] is 3 (a kind, or a mapping with a kind, is needed)"),
    ({"boundary": {"left": {"T": 1}, "right": "outflow"}}, "a mapping with a kind, is needed"),
    ({"boundary": ("inflow", "outflow")}, "boundary 'inflow' has no value of 'rho'"),
    ({"acceleration": lambda t, x: 1.0}, "largest_acceleration is missing"),
    ({"acceleration": [1, 2]}, "acceleration has 2 components (the model has 1 velocity dimensions)"),
    ({"acceleration": "g"}, "acceleration is 'g'"),
    ({"velocities": {"max": 8, "point": 3}}, "unknown key 'point' in velocities"),
    ({"velocities": {"set": "gradde", "max": 8, "points": 8}}, "did you mean 'graded'?"),
    ({"velocities": ([0.0, 1, 2], [1.0, 1, 1])}, "at least 4"),
    ({"velocities": ([0.0, 1, 2, 3], [1.0, 1, 1])}, "velocities has the shape (4,) and weights (3,)"),
    ({"velocities": 8}, "velocities is 8"),
])
def test_arguments_that_cannot_be_used_are_refused(more, says):
    with pytest.raises(apsis.InputError) as refused:
        gas(**more)
    assert says in str(refused.value)


@pytest.mark.parametrize("value, says", [(lambda t, x: None, "boundary['left']['T'] returned None"), (lambda t, x: float("nan"), "returned nan at t = "),
                                         (lambda t, x: -1.0, "the boundary has no Maxwellian at t = ")])
def test_values_of_functions_are_checked_when_they_are_used(value, says):
    problem = gas(**wall(T=value))
    with pytest.raises(apsis.InputError) as refused:
        apsis.integrate(problem, problem.state(rho=1, T=1), (0, 0.01), "md-imex-3-2")
    assert says in str(refused.value)


def test_collisions_at_centres_are_those_of_a_case():
    by_case = apsis.run(case(FORMULAS, space={"collisions": "centres"}))
    by_functions = apsis.run(case(space={"collisions": "centres"}), initial=FUNCTIONS)
    np.testing.assert_allclose(by_functions.f, by_case.f, rtol=0, atol=1e-14)
    assert np.abs(by_case.f - apsis.run(case(FORMULAS)).f).max() > 1e-12  # the default collides at Gauss points
    problem = gas(collisions="centres")
    u = problem.state(**FUNCTIONS)
    assert np.abs(apsis.integrate(problem, u, (0, 1e-3), "md-imex-3-2", dt=1e-4).u - apsis.integrate(gas(), u, (0, 1e-3), "md-imex-3-2", dt=1e-4).u).max() > 1e-12
    with pytest.raises(apsis.InputError, match="unknown collisions 'edges'"):
        gas(collisions="edges")
