"""Problems on a mesh built from Python objects without a case."""
import math

import apsis
import numpy as np
import pytest


def bgk(**more):
    return apsis.KineticProblem("bgk", **{"cells": 20, "domain": (0, 2), "velocities": (15, 40), "epsilon": 1e-2, **more})


@pytest.mark.parametrize("method", ["md-imex-6-3", "exponential-2"])
@pytest.mark.parametrize("formulation", ["finite-volume", "finite-difference"])
def test_it_equals_the_problem_of_the_case(formulation, method):
    """The problem has, bit for bit, the numbers of a run of a case file for the same problem."""
    case = apsis.run("paper/bgk-mixed", "space.cells=20", "velocity.points=40", f"space.formulation={formulation}", "model.epsilon=1e-2",
                     "time.end=0.05", f"time.method={method}", "time.dt=0.0005", threads=1)
    problem = bgk(formulation=formulation, positivity=True)
    np.testing.assert_array_equal(problem.x, case.x)
    np.testing.assert_array_equal(problem.v, case.v)
    mine = apsis.integrate(problem, problem.sample("mixed-v"), (0, 0.05), method, dt=0.0005)
    assert mine.steps == case.summary["steps"]
    np.testing.assert_array_equal(mine.u[-1], case.f)
    np.testing.assert_array_equal(problem.fields(mine.u[-1])["rho"], case.fields["rho"][-1])


def test_functions_of_position_are_data_and_epsilon():
    problem = bgk(formulation="finite-difference", epsilon=lambda x: 1e-3 + x * x)
    np.testing.assert_array_equal(problem.epsilon, 1e-3 + problem.x * problem.x)

    def gas(x):  # a Maxwellian at rest with density 1 + 0.2 sin πx
        return (1.0 + 0.2 * np.sin(np.pi * x)) * np.exp(-0.5 * problem.v**2) / np.sqrt(2.0 * np.pi)

    u = problem.sample(gas)
    np.testing.assert_allclose(problem.fields(u)["rho"], 1.0 + 0.2 * np.sin(np.pi * problem.x), rtol=1e-12)
    np.testing.assert_allclose(problem.fields(u)["T"], 1.0, rtol=1e-12)
    # The state is an equilibrium up to the accuracy of the midpoint rule, so the collision vanishes.
    assert np.abs(problem.collision(u)).max() < 1e-9
    np.testing.assert_allclose(problem.solve_collision(u, 0.1, -0.01), u, rtol=0, atol=1e-12)


@pytest.mark.parametrize("more", [{}, dict(formulation="finite-difference"), dict(collisions="centres"), dict(epsilon=lambda x: 1e-3 + x)])
def test_a_state_is_projected_to_its_equilibrium(more):
    problem = bgk(**more)
    u = problem.sample("mixed-v")
    equilibrium = problem.project_to_equilibrium(u)
    for name in ("rho", "u", "T"):
        np.testing.assert_allclose(problem.fields(equilibrium)[name], problem.fields(u)[name], rtol=1e-12, atol=1e-13)
    if more.get("formulation") == "finite-difference":  # for cell averages, Q would be an average, too
        scale = np.abs(problem.collision(u)).max()
        assert np.abs(problem.collision(equilibrium)).max() < 1e-10 * scale
    with pytest.raises(apsis.InputError, match="t = nan is not finite"):
        problem.project_to_equilibrium(u, t=np.nan)


def test_an_ordinary_differential_equation_is_projected_whatever_epsilon_is():
    for epsilon in (0, 1e-8, 1, 1e6):
        problem = apsis.KineticProblem("ode", epsilon=epsilon)
        np.testing.assert_array_equal(problem.project_to_equilibrium([[2.0, 0.3]]), problem.project_to_equilibrium([[2.0, -5.0]]))
        assert problem.project_to_equilibrium([[2.0, 0.3]])[0, 1] == pytest.approx(np.sin(2.0), rel=1e-15)


def test_averages_of_data_with_jumps_are_exact():
    problem = apsis.KineticProblem("relaxation", cells=5, domain=(0, 1))
    u = problem.sample(lambda x: [x * x if x < 0.5 else 2.0, 1.0], jumps=[0.5])
    assert u[0, 0] == pytest.approx(0.04 / 3, abs=1e-16)
    assert u[2, 0] == pytest.approx((0.125 - 0.064) / 3 / 0.2 + 1.0, abs=1e-15)
    np.testing.assert_allclose(u[:, 1], 1.0, rtol=1e-15)  # the quadrature weights add up to 1 within rounding


def test_transport_is_minus_the_derivative_of_the_flux():
    problem = apsis.KineticProblem("broadwell", cells=160, domain=(-1, 1), formulation="finite-difference")
    u = problem.sample(lambda x: [2 + np.sin(np.pi * x), 1.0, 1.0])
    expected = -np.pi * np.cos(np.pi * problem.x)  # the first component has speed 1
    # The scheme of order 5 has errors of (πΔx)⁵ π/60 ≈ 5e-9 on 160 cells, but larger ones at smooth extrema.
    np.testing.assert_allclose(problem.transport(u)[:, 0], expected, atol=1e-5)
    assert problem.forward_euler_step(u) == pytest.approx(2 / 160, rel=1e-12)


def test_boundaries_are_chosen_for_each_face():
    data = lambda x: [1.0, 1.0, 1.0] if x < 0 else [2.0, 1.0, 1.0]  # noqa: E731
    open_ends = apsis.KineticProblem("broadwell", cells=20, domain=(-1, 1), boundary=("outflow", "outflow"), reconstruction="upwind1")
    closed = apsis.KineticProblem("broadwell", cells=20, domain=(-1, 1), reconstruction="upwind1")
    u = open_ends.sample(data, jumps=[0])
    assert open_ends.transport(u)[0, 0] == 0.0  # the neighbour is a copy
    assert closed.transport(u)[0, 0] == pytest.approx((2.0 - 1.0) / 0.1)  # the neighbour is the other end


def test_nothing_enters_from_a_vacuum():
    problem = apsis.KineticProblem("broadwell", cells=20, domain=(-1, 1), boundary={"left": "vacuum", "right": "symmetry"}, reconstruction="upwind1")
    u = problem.sample(lambda x: [1.0, 1.0, 1.0])
    change = problem.transport(u)
    assert change[0, 0] == pytest.approx(-10.0) and change[0, 2] == pytest.approx(0.0)  # the neighbour is empty; Δx = .1
    assert np.abs(change[1:]).max() < 1e-12
    with pytest.raises(apsis.InputError, match="not densities of particles"):
        apsis.KineticProblem("relaxation", cells=20, domain=(-1, 1), boundary="vacuum")


def test_results_do_not_depend_on_the_number_of_threads():
    problem = bgk()
    u = problem.sample("mixed-v")
    one, two = (apsis.integrate(problem, u, (0, 0.01), dt=0.001, threads=n).u for n in (1, 2))
    np.testing.assert_array_equal(one, two)


def test_an_ordinary_differential_equation_needs_no_mesh():
    problem = apsis.KineticProblem("ode", epsilon=0)
    assert problem.shape == (1, 2) and problem.x.size == 0
    assert problem.solve_collision([[2.0, 0.0]], 1.0)[0, 1] == pytest.approx(np.sin(2.0))


@pytest.mark.parametrize("make, says", [
    (lambda: bgk(cells=(20, 20), domain=((0, 1), (0, 1))), "a mesh of 2 dimensions (the model has 1)"),
    (lambda: bgk(cells=4), "a mesh of 4 cells is smaller than the stencil"),
    (lambda: bgk(domain=(0, 1, 2)), "domain has the shape (1, 3)"),
    (lambda: bgk(boundary="wall"), "'wall'"),
    (lambda: bgk(boundary=("periodic", "outflow")), "only one face of direction 1 is periodic"),
    (lambda: bgk(boundary=("outflow",)), "a pair of kinds for each direction"),
    (lambda: bgk(reconstruction="weno"), "unknown reconstruction 'weno' (there is no such name)"),
    (lambda: bgk(formulation="volumes"), "unknown formulation 'volumes' (there is no such name)"),
    (lambda: bgk(epsilon=-1), "a finite number >= 0 is needed"),
    (lambda: bgk(epsilon=lambda x: "a"), "epsilon returned"),
    (lambda: bgk(parameters={"velocity_dimension": 2}), "unknown parameter 'velocity_dimension' (model 'bgk'"),
    (lambda: bgk(parameters={"velocity_dimensions": 1.5}), "an integer from 0 to 3"),
    (lambda: bgk(velocities=None), "velocity.points is missing"),
    (lambda: apsis.KineticProblem("bkg"), "did you mean 'bgk'?"),
    (lambda: bgk().sample("mixed"), "unknown initial data 'mixed'"),
    (lambda: bgk().sample(3), "a name or a function of the coordinates is needed"),
    (lambda: bgk().sample(lambda x: [1.0]), "initial returned"),
    (lambda: bgk().fields(np.ones((20, 3))), "a state has the shape (20, 3) (that of the problem is (20, 40))"),
    (lambda: bgk().sample(lambda x: -np.ones(40)), "no Maxwellian"),
])
def test_inconsistent_arguments_are_refused(make, says):
    with pytest.raises(apsis.InputError) as refused:
        make()
    assert says in str(refused.value)


def test_failures_report_their_cell():
    problem = bgk(epsilon=0)
    with pytest.raises(apsis.NumericalError) as failed:
        problem.collision(problem.sample("mixed-v"))
    assert failed.value.cell == 0 and "epsilon = 0" in str(failed.value)


def test_what_the_velocities_miss_is_measured_and_warned_of(recwarn):
    problem = bgk(velocities=(4.5, 40), formulation="finite-difference")
    good = problem.state(rho=1, T=1)
    assert not recwarn.list
    with pytest.warns(apsis.ApsisWarning, match="velocity.max = 4.5 is too small for the data"):
        poor = problem.state(rho=1, T=lambda x: 1.0 if x < 1 else 2.0)
    # The energy of a Maxwellian at speeds above 4.5, from the normal distribution. The tolerance is for the midpoint rule at the ends.
    kappa = 4.5 / np.sqrt(np.where(problem.x < 1, 1.0, 2.0))
    beyond = np.array([math.erfc(k / math.sqrt(2)) + 2 * k * math.exp(-k * k / 2) / math.sqrt(2 * math.pi) for k in kappa])
    np.testing.assert_allclose(problem.velocity_missed(poor), beyond, rtol=0.1)
    np.testing.assert_allclose(problem.velocity_missed(good), beyond[0], rtol=0.1)
    with pytest.raises(apsis.InputError, match="velocity.max = 4.5 is too small for the data"):
        problem.state(rho=1, T=4)
    assert np.isnan(apsis.KineticProblem("broadwell", cells=5, domain=(0, 1)).velocity_missed(np.ones((5, 3)))).all()
