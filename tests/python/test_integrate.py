"""Problems of one's own with functions on arrays."""
import apsis
import numpy as np
import pytest


def ode(epsilon, **more):
    """The paper's model u1' = u2, u2' = (1 + u1²)(sin u1 − u2)/ε."""
    return apsis.RelaxationProblem(
        transport=lambda t, u: np.array([u[1], 0.0]), moments=lambda u: u[0], equilibrium=lambda w: [w, np.sin(w)],
        rate=lambda w: 1.0 + w * w, epsilon=epsilon, **more)


@pytest.mark.parametrize("name, order", [("md-imex-3-2", 2), ("md-imex-6-3", 3), ("md-imex-14-4-accurate", 4)])
def test_the_order_is_seen_from_python(name, order):
    exact = apsis.integrate(ode(1.0), [2.0, 0.0], (0, 1), name, dt=1 / 2048).u[-1]
    errors = [np.abs(apsis.integrate(ode(1.0), [2.0, 0.0], (0, 1), name, dt=dt).u[-1] - exact).sum() for dt in (1 / 64, 1 / 128)]
    assert np.log2(errors[0] / errors[1]) > order - 0.25


def test_it_is_the_integration_of_the_program():
    mine = apsis.integrate(ode(1e-4), [2.0, 0.0], (0, 1), "md-imex-6-3", dt=1 / 64)
    theirs = apsis.run("paper/ode", "model.epsilon=1e-4", "time.dt=1/64", "time.end=1.0", "time.method=md-imex-6-3")
    assert mine.steps == theirs.summary["steps"] == 64
    # The same stages in the same order; sin may be rounded differently in NumPy.
    np.testing.assert_allclose(mine.u[-1], theirs.f[0], rtol=1e-13)


def test_a_smaller_tolerance_makes_smaller_errors_by_more_steps():
    name = "md-imex-8-3-accurate"
    exact = apsis.integrate(ode(1e-2), [2.0, 0.0], (0, 1), name, dt=1 / 4096).u[-1]
    found = [apsis.integrate(ode(1e-2), [2.0, 0.0], (0, 0.5, 1), name, dt=0.5, tolerance=tol) for tol in (1e-3, 1e-6)]
    errors = [np.abs(one.u[-1] - exact).max() for one in found]
    # Errors of steps add up, and what a step of the wanted size leaves is far below what its estimate says.
    assert errors[0] < 1e-2 and errors[1] < 1e-4 and errors[1] < errors[0] / 10
    assert found[1].steps > 2 * found[0].steps


def test_steps_that_fail_are_tried_shorter_where_there_is_a_tolerance():
    problem = apsis.RelaxationProblem(lambda t, u: -u, lambda u: u[0], lambda w: [w], lambda w: 1.0, 1.0, admissible=lambda u: u[0] >= 0)
    with pytest.raises(apsis.NumericalError, match="admissible"):
        apsis.integrate(problem, [1.0], (0, 8), "md-imex-8-3-mixed", dt=8)
    assert apsis.integrate(problem, [1.0], (0, 8), "md-imex-8-3-mixed", dt=8, tolerance=1.0).rejected > 0


def test_states_at_times_and_shapes_of_arrays():
    x = np.linspace(0.0, 1.0, 20, endpoint=False)
    u0 = np.stack([np.sin(2 * np.pi * x) + 2.0, np.zeros_like(x)])
    # Jin–Xin relaxation of advection at speed 1/2, characteristic speed 1, first-order upwind.
    def transport(t, u):
        plus, minus = 0.5 * (u[0] + u[1]), 0.5 * (u[0] - u[1])
        d_plus, d_minus = -(plus - np.roll(plus, 1)) * 20, (np.roll(minus, -1) - minus) * 20
        return np.stack([d_plus + d_minus, d_plus - d_minus])
    problem = apsis.RelaxationProblem(transport, lambda u: u[0].copy(), lambda w: np.stack([w, 0.5 * w]), lambda w: 1.0, 1e-6,
                                      forward_euler_step=lambda t, u: 1 / 20)
    seen = apsis.integrate(problem, u0, np.linspace(0, 1, 5), "md-imex-3-2")
    assert seen.u.shape == (5, 2, 20) and np.array_equal(seen.u[0], u0) and np.array_equal(seen.t, np.linspace(0, 1, 5))
    # Conserved to rounding, and within the bounds of the data: r Δt_FE keeps both.
    np.testing.assert_allclose(seen.u[:, 0].sum(axis=1), u0[0].sum(), rtol=1e-13)
    assert seen.u[:, 0].min() >= 1.0 - 1e-12 and seen.u[:, 0].max() <= 3.0 + 1e-12


def test_arrays_of_the_functions_cannot_be_changed():
    def transport(t, u):
        u[0] = 1.0
    problem = ode(1.0)
    problem.transport = transport
    with pytest.raises(ValueError, match="read-only"):
        apsis.integrate(problem, [2.0, 0.0], (0, 1), dt=0.1)


def test_exceptions_of_the_functions_come_out():
    class Mine(Exception):
        pass
    def fail(u):
        raise Mine("no")
    problem = ode(1.0)
    problem.moments = fail
    with pytest.raises(Mine, match="no"):
        apsis.integrate(problem, [2.0, 0.0], (0, 1), dt=0.1)


@pytest.mark.parametrize("change, arguments, message", [
    (dict(transport=lambda t, u: [1.0]), {}, "transport returned 1 numbers"),
    (dict(transport=lambda t, u: "abc"), {}, "no numbers"),
    (dict(epsilon=-1.0), {}, "epsilon is negative"), ({}, dict(dt=None), "nothing says how long a step is"),
    ({}, dict(dt=-1.0), "dt is not a positive number"), ({}, dict(method="none"), "none"),
    ({}, dict(startup="soft"), "there is no start-up"), ({}, dict(tolerance=0.0), "tolerance is not a positive number"),
    ({}, dict(tolerance=1e-3, method="ars-222"), "no embedded solution")])
def test_bad_arguments_have_a_message(change, arguments, message):
    problem = ode(1.0)
    for name, value in change.items():
        setattr(problem, name, value)
    with pytest.raises(apsis.InputError, match=message):
        apsis.integrate(problem, [2.0, 0.0], (0, 1), **({"dt": 0.1} | arguments))


def test_a_failure_says_where():
    problem = ode(1.0, admissible=lambda u: u[0] < 2.5)
    with pytest.raises(apsis.NumericalError, match="not admissible") as failure:
        apsis.integrate(problem, [2.0, 1.0], (0, 5), dt=0.1)
    assert failure.value.step > 1 and 0.0 < failure.value.t < 5.0
    assert isinstance(failure.value, ArithmeticError)
