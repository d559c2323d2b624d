"""Problems with a general collision. Newton's method for stages takes derivatives that are given, by complex steps or by differences."""
import pickle

import apsis
import numpy as np
import pytest


def robertson(u):
    first, third = -0.04 * u[0] + 1e4 * u[1] * u[2], 3e7 * u[1] ** 2
    return np.array([first, -first - third, third])


def robertson_jacobian(u):
    return np.array([[-0.04, 1e4 * u[2], 1e4 * u[1]], [0.04, -1e4 * u[2] - 6e7 * u[1], -1e4 * u[1]], [0.0, 6e7 * u[1], 0.0]])


# Units of the unknowns. They make the second one larger, since tolerances are absolute.
SCALES = np.array([1.0, 1e-4, 1.0])


def scaled(f):
    return lambda y: f(y * SCALES) / SCALES


@pytest.mark.parametrize("jacobian, derivatives", [(None, "complex steps"),
                                                   (lambda y: robertson_jacobian(y * SCALES) * SCALES / SCALES[:, None], "jacobian")])
@pytest.mark.parametrize("method, tolerance", [("imdrk-9-5", 1e-6), ("md-imex-8-3-mixed", 1e-6)])
def test_robertson_is_right_at_late_times(jacobian, derivatives, method, tolerance):
    problem = apsis.GeneralProblem(scaled(robertson), jacobian=jacobian)
    times = [0, 40, 4e5, 4e7, 4e10]
    found = apsis.integrate(problem, [1.0, 0.0, 0.0], times, method, tolerance=tolerance)
    assert found.derivatives == derivatives
    # The values are those of Hairer & Wanner II, IV.10, and of CVODE with a relative tolerance of 1e-11. The tolerance is that of one
    # step; errors of some hundred steps add up. A frozen stage, which Newton's method does not change, would leave 6.3e-5 at the end.
    for y, exact in zip(found.u[1:, 0], [0.7158270688, 4.938274e-3, 5.203072e-5, 5.208345e-8]):
        assert y == pytest.approx(exact, abs=20 * tolerance)
    np.testing.assert_allclose((found.u * SCALES).sum(axis=1), 1.0, rtol=0, atol=1e-12)


def test_three_kinds_of_derivatives_agree():
    def real_only(u):
        return np.array([float(x) for x in robertson(u)])

    def wrong_for_complex(u):
        return robertson(np.abs(u))

    start, times = [0.9, 2e-5, 0.1 - 2e-5], (0, 10)
    exact = apsis.integrate(apsis.GeneralProblem(robertson, jacobian=robertson_jacobian), start, times, "imdrk-9-5", dt=0.5)
    for collision, by in ((robertson, "complex steps"), (real_only, "finite differences"), (wrong_for_complex, "finite differences")):
        found = apsis.integrate(apsis.GeneralProblem(collision), start, times, "imdrk-9-5", dt=0.5)
        assert found.derivatives == by
        # Complex steps are exact up to rounding. Differences have errors of about 1e-10 in Q', and Δt λ = 500 multiplies them in Q'Q.
        np.testing.assert_allclose(found.u[-1], exact.u[-1], rtol=1e-11 if by == "complex steps" else 1e-6)


@pytest.mark.parametrize("method, order", [("md-imex-3-2", 2), ("md-imex-6-3", 3), ("md-imex-14-4-accurate", 4), ("ark-436", 4),
                                           ("kutta-4", 4), ("dirk-4-3", 3)])
def test_orders_with_transport(method, order):
    """A damped pendulum: T is the motion, Q is cubic damping and a restoring force. For implicit methods there is no transport."""
    implicit = apsis.method(method).kind == "implicit"

    def transport(t, u):
        return np.array([u[1], 0.0]) + np.array([0.0, np.cos(t)])

    def collision(u):
        return np.array([u[1], 0.0]) * implicit + np.array([0.0, -np.sin(u[0]) - u[1] ** 3])

    problem = apsis.GeneralProblem(collision, None if implicit else transport)
    exact = apsis.integrate(problem, [1.0, 0.5], (0, 1), "imdrk-9-5" if implicit else "dop853", dt=1 / 64).u[-1]
    errors = [np.abs(apsis.integrate(problem, [1.0, 0.5], (0, 1), method, dt=dt).u[-1] - exact).max() for dt in (1 / 32, 1 / 64)]
    assert np.log2(errors[0] / errors[1]) > order - 0.4


def test_cells_of_a_local_problem_are_solved_alone():
    """Two advected species react as u₁ ⇌ u₂². Stages solved cell by cell equal those solved as one system."""
    cells = 12
    x = (np.arange(cells) + 0.5) / cells
    start = np.stack([1 + 0.5 * np.sin(2 * np.pi * x), np.ones(cells)], axis=-1)

    def pairs(u):
        return 1e3 * (u[..., 0] ** 2 - u[..., 1])

    def collision(u):
        return np.stack([-2 * pairs(u), pairs(u)], axis=-1)

    def transport(t, u):
        return (np.roll(u, 1, axis=0) - u) * cells

    shapes = set()

    def seen(u):
        shapes.add(u.shape)
        return collision(u)

    limits = dict(transport=transport, forward_euler_step=lambda t, u: 1 / cells)
    alone = apsis.integrate(apsis.GeneralProblem(seen, local=True, **limits), start, (0, 0.5), "md-imex-8-3-mixed")
    whole = apsis.integrate(apsis.GeneralProblem(collision, **limits), start, (0, 0.5), "md-imex-8-3-mixed")
    assert shapes == {(2,)} and alone.u.shape == (2, cells, 2)
    np.testing.assert_allclose(alone.u, whole.u, rtol=0, atol=1e-13)
    # Transport and collision conserve u₁ + 2u₂.
    assert (alone.u[-1] @ [1, 2]).sum() == pytest.approx((start @ [1, 2]).sum(), rel=1e-14)
    with pytest.raises(apsis.NumericalError, match="not admissible|no admissible root") as failed:
        bad = apsis.GeneralProblem(collision, local=True, admissible=lambda u: bool((u >= 0).all()), **limits)
        apsis.integrate(bad, start - np.where(x > 0.5, 9.0, 0.0)[:, None], (0, 0.5), "md-imex-8-3-mixed")
    assert failed.value.cell == 6


@pytest.mark.parametrize("name", ["collision", "transport", "jacobian", "admissible", "forward_euler_step"])
def test_exceptions_of_functions_leave_as_they_are(name):
    class Mine(Exception):
        pass

    def fail(*arguments):
        raise Mine("mine")

    functions = dict(collision=lambda u: -u, transport=lambda t, u: 0 * u, jacobian=lambda u: -np.eye(2), admissible=lambda u: True,
                     forward_euler_step=lambda t, u: 0.1)
    with pytest.raises(Mine):
        apsis.integrate(apsis.GeneralProblem(**{**functions, name: fail}), [1.0, 2.0], (0, 1), "md-imex-6-3")


@pytest.mark.parametrize("change, arguments, message", [
    (dict(collision=lambda u: u[:1]), {}, r"collision returned an array of shape \(1,\)"), (dict(collision=lambda u: None), {}, "collision returned None"),
    (dict(collision=3.0), {}, "collision of the problem is a float"), (dict(collision=None), {}, "collision of the problem is None "),
    (dict(jacobian=lambda u: np.eye(3)), {}, r"jacobian returned an array of shape \(3, 3\)"),
    (dict(jacobian=lambda u: 1j * np.eye(2)), {}, "jacobian returned an array .* type complex128"),
    (dict(transport=lambda t, u: u), dict(method="imdrk-9-5"), "implicit only and the problem has transport"),
    ({}, dict(method="exponential-2"), "not solved exactly"), ({}, dict(u0=[]), "u0 has no numbers"),
    (dict(local=True), dict(u0=1.0), "local = True needs an axis"), ({}, dict(dt=None), "the step size is unknown")])
def test_bad_arguments_have_a_message(change, arguments, message):
    problem = apsis.GeneralProblem(**{**dict(collision=lambda u: -u), **change})
    with pytest.raises(apsis.InputError, match=message):
        apsis.integrate(problem, **{**dict(u0=[1.0, 2.0], t=(0, 1), method="md-imex-6-3", dt=0.1), **arguments})


def test_lost_directions_are_refused():
    angle = 0.7
    mix = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    jacobian = mix @ np.diag([-1e18, -1.0]) @ mix.T
    problem = apsis.GeneralProblem(lambda u: jacobian @ u, jacobian=lambda u: jacobian)
    with pytest.raises(apsis.NumericalError, match="singular to working precision"):
        apsis.integrate(problem, [1.0, 2.0], (0, 1), "imdrk-9-5", dt=1.0)


@pytest.mark.parametrize("unknowns, local, method, count", [(240, False, "md-imex-6-3", 1), (200, False, "md-imex-6-3", 0),
                                                            (240, False, "kutta-4", 0), (240, True, "md-imex-6-3", 0)])
def test_large_systems_are_warned_of_once_before_the_run(unknowns, local, method, count):
    problem = apsis.GeneralProblem(lambda u: -u, local=local)
    u0 = np.ones((unknowns // 2, 2)) if local else np.ones(unknowns)
    with np.testing.suppress_warnings() as found:
        seen = found.record(apsis.CostWarning)
        apsis.integrate(problem, u0, (0, 1), method, dt=0.5)
    assert len(seen) == count
    assert all("240 unknowns" in str(one.message) and "local=True" in str(one.message) for one in seen)


def test_explicit_and_additive_methods_keep_tolerances():
    """Methods without an embedded solution estimate errors from one step and two half steps."""
    problem = apsis.RelaxationProblem(lambda t, u: np.array([u[1], 0.0]), lambda u: u[0], lambda w: [w, np.sin(w)], lambda w: 1 + w * w, 1.0)
    exact = apsis.integrate(problem, [2.0, 0.0], (0, 1), "md-imex-16-4-accurate", dt=1 / 512).u[-1]
    for method, p in (("kutta-4", 4), ("dop853", 8), ("ark-548", 5), ("ars-443", 3), ("exponential-2", 2)):
        errors = [np.abs(apsis.integrate(problem, [2.0, 0.0], (0, 1), method, tolerance=tol).u[-1] - exact).max() for tol in (1e-5, 1e-8)]
        assert errors[0] < 1e-3 and errors[1] < 30 * 1e-8 ** (p / (p + 1)) + 1e-11, method
        assert errors[1] < errors[0] / 20, method


def test_solutions_can_be_pickled():
    found = apsis.integrate(apsis.GeneralProblem(lambda u: -u), [1.0], (0, 1), "imdrk-9-5", dt=0.5)
    assert pickle.loads(pickle.dumps(found)) == found and found.derivatives == "complex steps"


@pytest.mark.parametrize("arguments, message", [(dict(a=-1), "a = -1 is below 0"), (dict(a=1, b=5), "b = 5 is above 0"),
                                                (dict(a=np.nan), "a = nan is not finite"), (dict(a=1, b=np.nan), "b = nan is not finite"),
                                                (dict(a=np.inf), "a = inf is not finite"), (dict(a=1, b=-np.inf), "b = -inf is not finite"),
                                                (dict(a=1, t=np.nan), "t = nan is not finite"), (dict(a="1"), "a is '1'")])
def test_a_stage_with_other_coefficients_is_refused(arguments, message):
    problem = apsis.KineticProblem("ode", epsilon=0.1)
    with pytest.raises(apsis.InputError, match=message):
        problem.solve_collision([[2.0, 0.0]], **arguments)
    with pytest.raises(apsis.InputError, match="t = nan is not finite"):
        problem.transport([[2.0, 0.0]], t=np.nan)
