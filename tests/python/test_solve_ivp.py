"""apsis.solve_ivp has the arguments and results of scipy.integrate.solve_ivp, for stiff problems and for separate T and Q."""
import math
import pickle

import apsis
import numpy as np
import pytest

scipy_integrate = pytest.importorskip("scipy.integrate", reason="solve_ivp returns objects of SciPy")
scipy_sparse = pytest.importorskip("scipy.sparse")


def robertson(t, y):
    first, third = -0.04 * y[0] + 1e4 * y[1] * y[2], 3e7 * y[1] ** 2
    return np.array([first, -first - third, third])


def robertson_jacobian(t, y):
    return np.array([[-0.04, 1e4 * y[2], 1e4 * y[1]], [0.04, -1e4 * y[2] - 6e7 * y[1], -1e4 * y[1]], [0.0, 6e7 * y[1], 0.0]])


def van_der_pol(t, y, mu):
    return np.array([y[1], mu * (1 - y[0] ** 2) * y[1] - y[0]])


@pytest.mark.parametrize("jac", [None, robertson_jacobian])
@pytest.mark.parametrize("rtol", [1e-4, 1e-6, 1e-8])
def test_one_line_replaces_radau(rtol, jac):
    atol = rtol * np.array([1e-4, 1e-8, 1e-4])
    radau = scipy_integrate.solve_ivp(robertson, (0, 1e5), [1.0, 0, 0], method="Radau", jac=robertson_jacobian, rtol=1e-12, atol=1e-20)
    found = apsis.solve_ivp(None, robertson, (0, 1e5), [1.0, 0, 0], jac=jac, rtol=rtol, atol=atol)
    assert found.success and found.status == 0 and found.t[-1] == 1e5
    assert found.derivatives == ("complex steps" if jac is None else "jacobian") and (found.njev > 0) == (jac is not None)
    # The error at the end is at most ten tolerances of a step, since errors of steps add up.
    np.testing.assert_allclose(found.y[:, -1], radau.y[:, -1], rtol=10 * rtol)
    np.testing.assert_allclose(found.y.sum(axis=0), 1.0, rtol=0, atol=1e-11)  # rounding errors of some thousand solves


def test_the_result_has_what_that_of_scipy_has():
    def crosses(t, y, mu):
        return y[0]

    arguments = dict(t_eval=np.linspace(0, 20, 7), events=crosses, dense_output=True, rtol=1e-7, atol=1e-9, args=(10.0,))
    theirs = scipy_integrate.solve_ivp(van_der_pol, (0, 20), [2.0, 0.0], method="Radau", **arguments)
    ours = apsis.solve_ivp(None, van_der_pol, (0, 20), [2.0, 0.0], **arguments)
    assert set(theirs) <= set(ours)
    for name in ("t", "y", "t_events", "y_events"):
        assert np.shape(getattr(theirs, name)) == np.shape(getattr(ours, name)), name
        np.testing.assert_allclose(np.asarray(getattr(ours, name)), np.asarray(getattr(theirs, name)), rtol=1e-4, atol=1e-4, err_msg=name)
    assert isinstance(ours.sol, scipy_integrate.OdeSolution)
    times = np.linspace(0, 20, 50).reshape(-1)
    np.testing.assert_allclose(ours.sol(times), theirs.sol(times), rtol=1e-3, atol=1e-3)
    np.testing.assert_array_equal(ours.sol(ours.t), ours.y)  # both are values of the same dense output
    assert type(ours).__mro__[0].__name__ == "OptimizeResult" and ours.nfev > 0 and ours.nlu > 0


def test_without_t_eval_the_times_are_the_ends_of_steps():
    found = apsis.solve_ivp(None, lambda t, y: -y, (0, 1), [1.0], rtol=1e-6, dense_output=True)
    assert found.t[0] == 0 and found.t[-1] == 1 and np.all(np.diff(found.t) > 0) and len(found.t) == found.steps + 1
    np.testing.assert_array_equal(found.sol.ts, found.t)
    np.testing.assert_array_equal(found.sol(found.t), found.y)
    np.testing.assert_allclose(found.y[0], np.exp(-found.t), rtol=1e-5)


# An oscillator whose transport and collision both depend on t and y.
def swing(t, y):
    return np.array([y[1] + 0.3 * np.sin(2 * t), np.cos(t) * y[0]])


def damping(t, y):
    return np.array([-y[0] ** 3, -(2 + np.sin(t)) * y[1]])


@pytest.mark.parametrize("method, order", [("md-imex-3-2", 2), ("md-imex-8-3-mixed", 3), ("md-imex-14-4-accurate", 4), ("ark-436", 4),
                                           ("extrapolated-euler-4", 4)])
def test_orders_of_steps_and_of_dense_output(method, order):
    exact = scipy_integrate.solve_ivp(lambda t, y: swing(t, y) + damping(t, y), (0, 1), [1.0, 0.5], method="DOP853", rtol=1e-13,
                                      atol=1e-14, dense_output=True)
    at = 0.37  # inside a step of each length
    errors = []
    for dt in (1 / 64, 1 / 128):
        found = apsis.solve_ivp(swing, damping, (0, 1), [1.0, 0.5], method=method, dt=dt, t_eval=[at, 1.0])
        errors.append(np.abs(found.y - exact.sol(np.array([at, 1.0]))).max(axis=0))
    assert np.all(np.log2(errors[0] / errors[1]) > order - 0.5), (errors, order)


@pytest.mark.parametrize("method", ["imdrk-9-5", "extrapolated-euler-6", "md-imex-8-3-mixed"])
@pytest.mark.parametrize("phase", [np.cos, math.cos], ids=["analytic in time", "for real times alone"])
def test_stiff_sources_that_depend_on_time(method, phase):
    """The solution of Prothero's and Robinson's equation y' = −λ(y − cos t) − sin t is cos t for every λ."""
    def collision(t, y):
        return -1e5 * (y - phase(t)) - np.sin(t)

    found = apsis.solve_ivp(None, collision, (0, 10), [1.0], method=method, rtol=1e-6, atol=1e-6)
    assert found.success and found.y[0, -1] == pytest.approx(math.cos(10), abs=1e-5)
    assert found.steps < 2000  # an explicit method would take 3e5


def test_a_ball_bounces_at_events():
    def hits(t, y):
        return y[0]

    hits.terminal, hits.direction = True, -1
    t, y, bounces = 0.0, np.array([10.0, 0.0]), []
    while len(bounces) < 4:
        found = apsis.solve_ivp(lambda t, y: np.array([y[1], -9.81]), None, (t, 100), y, method="dop853", events=hits, rtol=1e-10, atol=1e-12)
        assert found.status == 1 and found.t[-1] == found.t_events[0][0] and abs(found.y[0, -1]) < 1e-9
        t, y = float(found.t[-1]), np.array([0.0, -0.9 * found.y[1, -1]])
        bounces.append(t)
    fall = math.sqrt(2 * 10 / 9.81)
    expected = fall * (1 + 2 * np.cumsum([0.0, 0.9, 0.81, 0.729]))
    np.testing.assert_allclose(bounces, expected, rtol=1e-8)


def test_directions_and_numbers_of_events():
    def up(t, y):
        return y[0]

    def third(t, y):
        return y[0]

    up.direction, third.terminal = 1, 3
    found = apsis.solve_ivp(lambda t, y: np.array([y[1], -y[0]]), None, (0, 100), [0.0, 1.0], method="dop853", rtol=1e-10, atol=1e-12,
                            events=[up, third])
    # The start of sin t at 0 is not an event.
    np.testing.assert_allclose(found.t_events[0], [2 * np.pi], rtol=1e-8)
    np.testing.assert_allclose(found.t_events[1], np.pi * np.arange(1, 4), rtol=1e-8)
    assert found.status == 1 and found.t[-1] == found.t_events[1][-1] and np.shape(found.y_events[1]) == (3, 2)


def decays(t, y):
    """A fast and a slow decay. The first unknown is soon far below the tolerance."""
    return np.array([-1e4 * y[0], 1e4 * y[0] - y[1]])


def test_a_method_that_promises_nothing_stays_in_the_admissible_set():
    arguments = dict(rtol=1e-2, atol=1e-2, method="extrapolated-euler-4")
    free = apsis.solve_ivp(None, decays, (0, 1), [1.0, 0.0], **arguments)
    kept = apsis.solve_ivp(None, decays, (0, 1), [1.0, 0.0], admissible=lambda y: np.all(y >= 0), **arguments)
    assert free.y.min() < 0 <= kept.y.min()
    assert kept.success and kept.rejected > free.rejected


def test_dense_output_is_positive_where_steps_are():
    # Newton's method ends with errors of a fraction of the tolerance. So the signs of values near 1e-40 need the admissible set.
    found = apsis.solve_ivp(None, decays, (0, 1), [1.0, 0.0], method="imdrk-9-5", rtol=1e-2, atol=1e-4, dense_output=True,
                            admissible=lambda y: np.all(y >= 0))
    inside = found.sol(np.geomspace(1e-7, 1, 400))
    radau = scipy_integrate.solve_ivp(decays, (0, 1), [1.0, 0.0], method="Radau", rtol=1e-2, atol=1e-4, dense_output=True)
    assert found.y.min() >= 0 and inside.min() >= 0
    assert radau.sol(np.geomspace(1e-7, 1, 400)).min() < 0  # dense output is not positive by itself


def positive(y):
    return np.all(y >= 0)


@pytest.mark.parametrize("arguments", [
    dict(method="imdrk-9-5", admissible=positive), dict(jac=[[-1e4, 0.0], [1e4, -1.0]]), dict(method="extrapolated-euler-5", mass=[[2.0, 1.0], [0.5, 3.0]]),
    dict(method="md-imex-8-3-mixed", dt=0.01)], ids=["admissible", "jac", "mass", "dt"])
def test_a_pickled_result_has_the_same_values_inside_steps(arguments):
    found = apsis.solve_ivp(None, decays, (0, 1), [1.0, 0.0], rtol=1e-2, atol=1e-4, dense_output=True, **arguments)
    copy = pickle.loads(pickle.dumps(found))
    times = np.geomspace(1e-7, 1, 50)
    assert isinstance(copy.sol, scipy_integrate.OdeSolution) and copy.steps == found.steps
    np.testing.assert_array_equal(copy.sol(times), found.sol(times))
    np.testing.assert_array_equal(copy.y, found.y)
    assert "admissible" not in arguments or copy.sol(times).min() >= 0


def test_functions_without_a_name_in_a_module_cannot_be_pickled():
    found = apsis.solve_ivp(None, lambda t, y: -y, (0, 1), [1.0], dense_output=True)
    with pytest.raises((pickle.PicklingError, AttributeError), match="lambda"):
        pickle.dumps(found)
    found.sol = None
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(found)).y, found.y)


def test_dense_output_at_many_times_has_the_values_of_single_times():
    found = apsis.solve_ivp(None, decays, (0, 1), [1.0, 0.0], rtol=1e-3, dense_output=True)
    times = np.array([0.7, 1e-5, 0.3, 0.7, 1.0, 0.0, 1e-5, *found.t])
    together = found.sol(times)
    assert together.shape == (2, len(times))
    np.testing.assert_array_equal(together, np.stack([found.sol(t) for t in times], axis=-1))
    calls = []

    def counted(t, y):
        calls.append(t)
        return decays(t, y)

    found = apsis.solve_ivp(None, counted, (0, 1), [1.0, 0.0], rtol=1e-3, dense_output=True)
    costs = []
    for many in ([0.7], [0.7] * 50):
        calls.clear()
        found.sol(np.array(many))
        costs.append(len(calls))
    assert costs[0] == costs[1] > 0


def brusselator(t, y):
    """The Brusselator with diffusion on a line. The unknowns are u and v of each cell in turn."""
    u, v = y[0::2], y[1::2]
    n, out = len(u), np.empty_like(y)
    diffusion = 0.02 * (n + 1) ** 2
    wide_u, wide_v = np.concatenate([[1.0], u, [1.0]]), np.concatenate([[3.0], v, [3.0]])
    out[0::2] = 1 + u * u * v - 4 * u + diffusion * (wide_u[2:] - 2 * u + wide_u[:-2])
    out[1::2] = 3 * u - u * u * v + diffusion * (wide_v[2:] - 2 * v + wide_v[:-2])
    return out


def test_sparse_derivatives_give_the_same_solution_with_fewer_calls():
    cells = 40
    x = np.arange(1, cells + 1) / (cells + 1)
    y0 = np.stack([1 + np.sin(2 * np.pi * x), np.full(cells, 3.0)], axis=-1).ravel()
    sparsity = scipy_sparse.diags([1, 1, 1, 1, 1], [-2, -1, 0, 1, 2], shape=(80, 80))
    arguments = dict(method="extrapolated-euler-5", rtol=1e-6, atol=1e-6)
    dense = apsis.solve_ivp(None, brusselator, (0, 1), y0, **arguments)
    sparse = apsis.solve_ivp(None, brusselator, (0, 1), y0, jac_sparsity=sparsity, **arguments)
    np.testing.assert_allclose(sparse.y[:, -1], dense.y[:, -1], rtol=1e-5)
    # Each step computes one derivative, from differences of five groups of columns instead of 80 columns.
    assert dense.nfev - sparse.nfev >= (80 - 5) * dense.steps and sparse.steps == dense.steps
    columns = apsis.solve_ivp(None, lambda t, y: np.array([brusselator(t, one) for one in y.T]).T, (0, 1), y0, vectorized=True, **arguments)
    np.testing.assert_allclose(columns.y[:, -1], dense.y[:, -1], rtol=1e-5)
    assert dense.nfev - columns.nfev >= (80 - 1) * dense.steps and columns.steps == dense.steps  # one call for all columns


@pytest.mark.parametrize("kind", ["array", "sparse", "function", "sparse function"])
def test_jacobians_of_every_form(kind):
    matrix = np.array([[-1e3, 1.0, 0.0], [0.0, -1.0, 0.5], [0.0, 0.0, -1e5]])
    jac = {"array": matrix, "sparse": scipy_sparse.csr_matrix(matrix), "function": lambda t, y: matrix,
           "sparse function": lambda t, y: scipy_sparse.csc_matrix(matrix)}[kind]
    found = apsis.solve_ivp(None, lambda t, y: matrix @ y, (0, 2), [1.0, 1.0, 1.0], method="imdrk-9-5", jac=jac, rtol=1e-8, atol=1e-10)
    values, vectors = np.linalg.eig(matrix)
    exact = (vectors @ (np.exp(2 * values) * np.linalg.solve(vectors, np.ones(3)))).real
    np.testing.assert_allclose(found.y[:, -1], exact, rtol=1e-6, atol=1e-9)
    assert (found.njev > 0) == ("function" in kind)


def test_a_wrong_jacobian_matters_where_it_enters_the_solution():
    wrong = [[-900.0]]
    with pytest.raises(apsis.InputError, match="jac is not the derivative of collision at the start"):
        apsis.solve_ivp(None, lambda t, y: -1000 * y, (0, 1), [1.0], jac=wrong, method="imdrk-9-5")
    found = apsis.solve_ivp(None, lambda t, y: -1000 * y, (0, 1), [1.0], jac=wrong, method="extrapolated-euler-4")
    assert found.success and abs(found.y[0, -1]) < 1e-5


def test_a_step_that_fails_ends_with_what_was_reached():
    found = apsis.solve_ivp(lambda t, y: y ** 2, None, (0, 2), [1.0], method="dop853", rtol=1e-8, atol=1e-8)
    assert not found.success and found.status == -1 and "step" in found.message
    assert 0.9 < found.t[-1] < 1.0 + 1e-8 and np.all(np.isfinite(found.y))
    before = found.t < 0.999
    np.testing.assert_allclose(found.y[0, before], 1 / (1 - found.t[before]), rtol=1e-3)


def test_exceptions_of_functions_leave_as_they_are():
    class Stop(Exception):
        pass

    def fails(t, y):
        if t > 0.5:
            raise Stop
        return -y

    with pytest.raises(Stop):
        apsis.solve_ivp(fails, None, (0, 1), [1.0], method="dop853")


def test_first_and_longest_steps():
    found = apsis.solve_ivp(lambda t, y: -y, None, (0, 10), [1.0], method="dop853", first_step=1e-3, max_step=0.25)
    lengths = np.diff(found.t)
    assert lengths[0] <= 1e-3 * (1 + 1e-12) and lengths.max() <= 0.25 * (1 + 1e-12)


def test_laws_of_step_control_avoid_rejections_at_the_limit_of_stability():
    def solved(law):
        return apsis.solve_ivp(lambda t, y: -300 * (y - np.cos(t)) - np.sin(t), None, (0, 10), [1.0], method="dop853", rtol=1e-6, atol=1e-5,
                               controller=law)

    by_last_error, pid = solved("integral"), solved("pid")
    assert 2 * pid.rejected < by_last_error.rejected and abs(pid.y[0, -1] - np.cos(10)) < 1e-4


def test_strong_stability_limits_steps():
    """A solute enters a column and is adsorbed at a high rate, so its front is half as fast as the liquid. The unknowns of each cell
    are the dissolved and the adsorbed concentration."""
    cells = 50

    def transport(t, y):
        out = np.zeros_like(y)
        out[0::2] = cells * (np.concatenate([[1.0], y[:-2:2]]) - y[0::2])
        return out

    def adsorption(t, y):
        out = 1e6 * (y[1::2] - y[0::2])
        return np.stack([out, -out], axis=-1).ravel()

    r = apsis.method("md-imex-10-3-mixed").certificate.ssp_coefficient
    arguments = dict(method="md-imex-10-3-mixed", jac_sparsity=np.kron(np.eye(cells), np.ones((2, 2))))
    found = apsis.solve_ivp(transport, adsorption, (0, 1), np.zeros(2 * cells), atol=1e-3, forward_euler_step=lambda t, y: 1 / cells,
                            **arguments)
    assert found.success and np.diff(found.t).max() <= r / cells * (1 + 1e-12) and found.steps < 2 * cells / r
    assert found.y[0::2, -1].sum() / cells == pytest.approx(0.5, abs=1e-3)
    # Without error control, stages are solved up to rounding errors. So only the length of steps decides if the bounds are kept.
    for factor, kept in ((1, True), (4, False)):
        y = apsis.solve_ivp(transport, adsorption, (0, 1), np.zeros(2 * cells), dt=factor * r / cells, **arguments).y
        assert (y.min() >= -1e-13 and y.max() <= 1 + 1e-13) == kept


class Elements:
    """Linear finite elements of u_t = u_xx with u = 0 at the ends of [0, 1]: M u' = K u."""

    def __init__(self, n):
        self.h, self.x = 1 / (n + 1), np.arange(1, n + 1) / (n + 1)
        self.mass = self.h / 6 * scipy_sparse.diags([1.0, 4.0, 1.0], [-1, 0, 1], shape=(n, n), format="csr")
        self.stiffness = scipy_sparse.diags([1.0, -2.0, 1.0], [-1, 0, 1], shape=(n, n), format="csr") / self.h

    def exact(self, k, t):
        """Returns the mode sin(kπx), which decays at the rate 6/h² (1 − cos kπh)/(2 + cos kπh): insert it into the equations."""
        c = math.cos(k * math.pi * self.h)
        return np.sin(k * math.pi * self.x) * math.exp(-6 / self.h ** 2 * (1 - c) / (2 + c) * t)


@pytest.mark.parametrize("method", ["auto", "md-imex-8-3-mixed", "extrapolated-euler-5"])
@pytest.mark.parametrize("form", ["sparse", "dense", "columns"])
def test_finite_elements_decay_as_their_modes_do(form, method):
    of = Elements(100)  # stiffness 12/h² = 1.2e5
    jac = {"sparse": of.stiffness, "dense": of.stiffness.toarray(), "columns": None}[form]
    mass = of.mass if form == "sparse" else of.mass.toarray()
    found = apsis.solve_ivp(None, lambda t, y: of.stiffness @ y, (0, 0.05), of.exact(1, 0) + of.exact(3, 0), method=method, jac=jac,
                            mass=mass, rtol=1e-6, atol=1e-9)
    assert found.success and found.steps < 400
    # A digit less than the tolerance of one step: errors of steps add up.
    np.testing.assert_allclose(found.y[:, -1], of.exact(1, 0.05) + of.exact(3, 0.05), rtol=0, atol=2e-5)


def test_a_mass_matrix_divides_both_parts():
    mass = np.array([[2.0, 1.0], [0.5, 3.0]])

    def transport(t, y):
        return np.array([math.cos(t) * y[1], -y[0]])

    def collision(t, y):
        return np.array([-50 * (y[0] - np.sin(t)) ** 3 - 50 * y[0], y[0] - y[1]])

    radau = scipy_integrate.solve_ivp(lambda t, y: np.linalg.solve(mass, transport(t, y) + collision(t, y)), (0, 2), [1.0, 0.5],
                                      method="Radau", rtol=1e-10, atol=1e-12)
    for form in (mass, mass.tolist(), scipy_sparse.csc_matrix(mass)):
        found = apsis.solve_ivp(transport, collision, (0, 2), [1.0, 0.5], method="ark-548-2", mass=form, rtol=1e-8, atol=1e-10)
        np.testing.assert_allclose(found.y[:, -1], radau.y[:, -1], rtol=1e-6)  # two digits less than the tolerance of a step
    krylov = apsis.solve_ivp(transport, collision, (0, 2), [1.0, 0.5], method="ark-548-2", mass=mass, solver="krylov", rtol=1e-8, atol=1e-10)
    np.testing.assert_allclose(krylov.y[:, -1], radau.y[:, -1], rtol=1e-6)
    # Explicit methods use M, too.
    driven = apsis.solve_ivp(lambda t, y: transport(t, y) + collision(t, y), None, (0, 2), [1.0, 0.5], method="dop853", mass=mass, rtol=1e-8,
                             atol=1e-10)
    np.testing.assert_allclose(driven.y[:, -1], radau.y[:, -1], rtol=1e-6)


def test_units_of_equations_do_not_matter_to_a_mass_matrix():
    of, units = Elements(20), np.exp2(np.arange(20) * 4 - 40)
    ends = [apsis.solve_ivp(None, lambda t, y: scale * (of.stiffness @ y), (0, 0.05), of.exact(1, 0), jac=scipy_sparse.diags(scale) @ of.stiffness,
                            mass=scipy_sparse.diags(scale) @ of.mass, rtol=1e-6).y[:, -1] for scale in (np.ones(20), units)]
    np.testing.assert_allclose(ends[0], ends[1], rtol=1e-9)  # roundings of another order of elimination


def with_attributes(**attributes):
    def event(t, y):
        return y[0]
    vars(event).update(attributes)
    return event


def test_a_jacobian_has_the_shape_of_a_matrix():
    with pytest.raises(apsis.InputError, match=r"jac returned an array of shape \(4,\)"):
        apsis.solve_ivp(None, lambda t, y: -y, (0, 1), [1.0, 2.0], jac=lambda t, y: np.array([-1.0, 0.0, 0.0, -1.0]))


def test_an_explicit_method_that_overflows_fails():
    for t_end in (1, 10):
        found = apsis.solve_ivp(None, lambda t, y: -1e8 * (y - 1), (0, t_end), [0.0], method="kutta-4", dt=0.01)
        assert found.status == -1 and "is not finite" in found.message, found.message
    with pytest.raises(apsis.NumericalError, match="is not finite"):
        apsis.integrate(apsis.GeneralProblem(lambda u: -1e8 * (u - 1)), [0.0], (0, 10), "kutta-4", dt=0.1)
    with pytest.raises(apsis.NumericalError, match="is not finite"):
        apsis.integrate(apsis.GeneralProblem(lambda u: 0 * u, transport=lambda t, u: -1e8 * (u - 1)), [0.0], (0, 10), "kutta-4", dt=0.1)


REFUSED = [
    (dict(mass=[[0.0]]), "the mass matrix is singular to working precision"),
    (dict(mass=[[math.nan]]), "the mass matrix has an entry nan in row 0 and column 0"),
    (dict(mass=[1.0, 2.0]), r"mass is an array of shape \(2,\)"),
    (dict(mass=np.eye(2)), r"mass is an array of shape \(2, 2\)"),
    (dict(t_span=(1, 0)), "t_span does not increase"),
    (dict(t_span=(0, math.inf)), "t_span is not two finite times"),
    (dict(y0=[[1.0]]), r"y0 has the shape \(1, 1\)"),
    (dict(y0=[math.nan]), "y0 has a number that is not finite"),
    (dict(y0=[1j]), "y0 is an array of type complex128"),
    (dict(t_span=(1, 1)), "t_span is empty"),
    (dict(t_eval=[0.5, 0.2]), "t_eval does not increase"),
    (dict(t_eval=[0.5, 0.5]), "t_eval does not increase"),
    (dict(t_eval=[2.0]), "t_eval has a time outside t_span"),
    (dict(t_eval=[float("nan")]), "t_eval has a time outside t_span"),
    (dict(t_eval=0.5), r"t_eval has the shape \(\)"),
    (dict(y0=None), r"write solve_ivp\(None, fun, t_span, y0\)"),
    (dict(args=10.0), r"write args=\(10.0,\)"),
    (dict(method="Radau"), "leave method out"),
    (dict(rtol=-1), "a tolerance of unknown 0 is negative"),
    (dict(rtol=0, atol=0), "unknown 0 has no tolerance"),
    (dict(atol=[1, 2]), "2 tolerances and 1 unknowns"),
    (dict(dt=0.1, max_step=0.1), "dt and first_step or max_step are given"),
    (dict(controller="pdi"), "unknown controller 'pdi'"),
    (dict(controller=3), "controller is an int"),
    (dict(controller="pi", dt=0.1), "dt and a controller are given"),
    (dict(dt=0.0), "dt = 0 is not a positive number"),
    (dict(max_step=0.1, forward_euler_step=lambda t, y: 1), "forward_euler_step and dt or max_step are given"),
    (dict(method="Rada"), "unknown method 'Rada'"),
    (dict(method=3), "method is an int"),
    (dict(events=[1]), "event 0 is an int"),
    (dict(events=3), "events is an int"),
    (dict(events=with_attributes(direction="up")), "event 0 has direction = 'up'"),
    (dict(events=with_attributes(terminal=-1)), "event 0 has terminal = -1"),
    (dict(events=with_attributes(terminal=1.5)), "event 0 has terminal = 1.5"),
    (dict(events=lambda t, y: None), "event 0 returned None"),
    (dict(jac=[[1.0, 2.0]]), r"jac is an array of shape \(1, 2\)"),
    (dict(jac_sparsity=[[1.0], [1.0]]), "jac_sparsity is an array of shape"),
    (dict(jac="exact"), "jac is an array of shape"),
    (dict(solver="sparse"), "unknown solver 'sparse'"),
    (dict(solver="krylov", jac_sparsity=[[1.0]]), "solver=\"krylov\" has no meaning"),
    (dict(transport=3), "transport is an int"),
    (dict(collision=lambda t, y: None), "collision returned None"),
    (dict(collision=lambda t, y: [1.0, 2.0]), r"collision returned an array of shape \(2,\)"),
    (dict(collision=None, jac=[[1.0]]), "jac or jac_sparsity is given without collision"),
]


@pytest.mark.parametrize("arguments, message", REFUSED, ids=[message[:40] for _, message in REFUSED])
def test_what_cannot_be_used_is_refused(arguments, message):
    given = dict(transport=None, collision=lambda t, y: -y, t_span=(0, 1), y0=[1.0]) | arguments
    with pytest.raises(apsis.InputError, match=message):
        apsis.solve_ivp(**given)


def test_a_place_outside_the_pattern_is_noticed():
    with pytest.raises(apsis.InputError, match="jac has an entry in row 0 and column 1"):
        apsis.solve_ivp(None, lambda t, y: np.array([-y[0] + t * y[1], -y[1]]), (0, 1), [1.0, 1.0],
                        jac=lambda t, y: scipy_sparse.csr_matrix([[-1.0, t], [0.0, -1.0]]), method="extrapolated-euler-4")


def oscillations(t, y):
    """1000 periods of an oscillation without damping, and a fast decay to it."""
    return np.array([2 * math.pi * y[1], -2 * math.pi * y[0], 1e4 * (y[0] - y[2])])


def test_errors_of_steps_add_up_unless_the_error_at_the_end_is_controlled():
    options = dict(rtol=1e-4, atol=1e-4, method="ark-548-2")
    by_steps = apsis.solve_ivp(None, oscillations, (0, 100), [1.0, 0.0, 1.0], **options)
    at_the_end = apsis.solve_ivp(None, oscillations, (0, 100), [1.0, 0.0, 1.0], end_error=True, **options)
    tolerance = 2e-4  # rtol |y| + atol of y = 1
    assert abs(by_steps.y[0, -1] - 1) > 10 * tolerance  # otherwise this test shows nothing
    assert abs(at_the_end.y[0, -1] - 1) < tolerance and abs(at_the_end.y[1, -1]) < 1e-4
    assert at_the_end.success and at_the_end.error <= 1 and at_the_end.refined <= 0.1
    assert at_the_end.steps > by_steps.steps and at_the_end.nfev > by_steps.nfev


def test_the_error_is_controlled_at_all_times_of_t_eval_and_at_events():
    times = np.linspace(10, 50, 9)
    found = apsis.solve_ivp(None, oscillations, (0, 50), [1.0, 0.0, 1.0], end_error=True, t_eval=times, rtol=1e-5, atol=1e-5)
    np.testing.assert_allclose(found.y[0], 1, rtol=0, atol=2e-5)

    def last(t, y):
        return t - 30.25
    last.terminal = True
    found = apsis.solve_ivp(None, oscillations, (0, 50), [1.0, 0.0, 1.0], end_error=True, events=last, rtol=1e-5, atol=1e-5)
    assert found.status == 1 and found.t[-1] == pytest.approx(30.25, abs=1e-12)
    np.testing.assert_allclose(found.y[:2, -1], [0, -1], rtol=0, atol=2e-5)


def test_results_that_do_not_converge_are_a_failure():
    def chaotic(t, y):  # the system of Lorenz: errors grow by a factor 1e24 in this time
        return np.array([10 * (y[1] - y[0]), y[0] * (28 - y[2]) - y[1], y[0] * y[1] - 8 / 3 * y[2]])

    found = apsis.solve_ivp(None, chaotic, (0, 60), [1.0, 1.0, 1.0], end_error=True, rtol=1e-3, atol=1e-3)
    assert found.status == -1 and "the error at the end is not within the tolerances" in found.message
    assert not hasattr(found, "error")


def test_a_failed_run_is_not_refined():
    found = apsis.solve_ivp(None, lambda t, y: y**2, (0, 2), [1.0], end_error=True)
    assert found.status == -1 and found.t[-1] == pytest.approx(1, abs=1e-2)


def test_steps_of_given_length_have_no_error_at_the_end():
    with pytest.raises(apsis.InputError, match="dt and end_error are given"):
        apsis.solve_ivp(None, oscillations, (0, 1), [1.0, 0.0, 1.0], dt=0.1, end_error=True)
