"""Steady states of problems from Python, and of cases."""
import apsis
import numpy as np
import pytest

TOLERANCE = 1e-9


def plates(u=0.1, **more):
    """Returns the problem of a gas between plates that move with velocities -u and u."""
    walls = [{"kind": "diffuse", "T": 1, "velocity": [0, -u]}, {"kind": "diffuse", "T": 1, "velocity": [0, u]}]
    return apsis.KineticProblem("bgk", **{
        "parameters": {"velocity_dimensions": 2, "degrees_of_freedom": 3}, "cells": 16, "domain": (0, 1), "velocities": (6, (16, 10)),
        "epsilon": 0.1, "boundary": walls, "formulation": "finite-difference", "reconstruction": "upwind5", **more})


def test_the_steady_state_solves_the_equation():
    problem = plates()
    start = problem.state(rho=1, T=1)
    steady = apsis.solve_steady(problem, start, TOLERANCE)

    def residual(u):
        return np.linalg.norm(problem.transport(u) + problem.collision(u))

    assert residual(steady.u) <= 1.01 * TOLERANCE * residual(start)
    assert steady.iterations == len(steady.residuals) == len(steady.changes) <= 60
    assert steady.residuals[0] == 1 and steady.residuals[-1] <= TOLERANCE and steady.changes[-1] <= TOLERANCE
    fields = problem.fields(steady.u)
    assert np.sum(fields["rho"]) == pytest.approx(16, rel=1e-12)
    np.testing.assert_allclose(fields["u_y"], -fields["u_y"][::-1], atol=1e-9)
    assert 0.05 < fields["u_y"][-1] < 0.1  # the gas is slower than the plate
    assert "iterations" in repr(steady)


def test_it_is_the_limit_of_the_integrator():
    """The method of the integrator has the steady state of the equation."""
    problem = plates(cells=8)
    start = problem.state(rho=1, T=1)
    end = apsis.integrate(problem, start, (0, 22), "forward-backward-euler", safety=0.4).u[-1]  # 22 viscous times
    np.testing.assert_allclose(apsis.solve_steady(problem, start, 1e-10).u, end, atol=1e-8)


def test_a_case_gives_the_same_state():
    problem = plates(u=0.05, cells=10, velocities={"set": ["graded", "uniform"], "max": 6, "points": [32, 12]},
                     parameters={"velocity_dimensions": 2, "degrees_of_freedom": 3, "viscosity_exponent": 0.5, "collision_rate": "viscosity"},
                     epsilon=1 / (np.sqrt(2) * 4))
    mine = apsis.solve_steady(problem, problem.state(rho=1, u=lambda x: [0, 0.05 * (2 * x - 1) * 4 / 6], T=1), 1e-10)
    case = apsis.run("gas/couette", "parameters.delta=4", "space.cells=10", "steady.tolerance=1e-10")
    np.testing.assert_allclose(mine.u, case.f, atol=1e-12)
    assert case.summary["steady"]["reached"] and case.summary["steady"]["residual"] <= 1e-10
    assert case.summary["steps"] == mine.iterations
    np.testing.assert_allclose(case.history["residual_relative"][1:], mine.residuals, rtol=1e-6)


def test_it_says_what_it_cannot_do():
    problem = plates()
    start = problem.state(rho=1, T=1)
    with pytest.raises(apsis.NumericalError, match="no steady state in 2 iterations"):
        apsis.solve_steady(problem, start, iterations=2)
    with pytest.raises(apsis.InputError, match="iterations is 0"):
        apsis.solve_steady(problem, start, iterations=0)
    with pytest.raises(apsis.InputError, match="images is 21"):
        apsis.solve_steady(problem, start, images=21)
    with pytest.raises(apsis.InputError, match="tolerance"):
        apsis.solve_steady(problem, start, tolerance=-1)
    with pytest.raises(apsis.InputError, match="an equation on a mesh is needed"):
        apsis.solve_steady("gas/couette", start)
    with pytest.raises(apsis.InputError, match="epsilon is 0 in some cell"):
        apsis.solve_steady(plates(epsilon=0), start)
    plane = apsis.KineticProblem("discrete-velocity", cells=10, domain=(0, 1), epsilon=1)
    with pytest.raises(apsis.InputError, match="no steady solver"):
        apsis.solve_steady(plane, np.ones(plane.shape))


def test_with_positivity_the_state_is_not_negative():
    hot = [{"kind": "diffuse", "T": 9}, {"kind": "diffuse", "T": 1}]
    given = {"parameters": {"velocity_dimensions": 1, "degrees_of_freedom": 3}, "velocities": (18, 48), "boundary": hot, "cells": 30}
    states = {}
    for positivity in (False, True):
        problem = plates(positivity=positivity, **given)
        states[positivity] = apsis.solve_steady(problem, problem.state(rho=1, T=1)).u
    assert states[False].min() < 0 <= states[True].min()
    np.testing.assert_allclose(states[True], states[False], atol=1e-3 * states[False].max())
