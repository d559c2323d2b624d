"""User-defined problems with functions on arrays."""
import gc
import pickle
import signal
from fractions import Fraction

import apsis
import numpy as np
import pytest


def ode(epsilon, **more):
    """The paper's model u1' = u2, u2' = (1 + u1²)(sin u1 − u2)/ε."""
    return apsis.RelaxationProblem(
        transport=lambda t, u: np.array([u[1], 0.0]), moments=lambda u: u[0], equilibrium=lambda w: [w, np.sin(w)],
        rate=lambda w: 1.0 + w * w, epsilon=epsilon, **more)


@pytest.mark.parametrize("name, order", [("md-imex-3-2", 2), ("md-imex-6-3", 3), ("md-imex-14-4-accurate", 4), ("exponential-2", 2)])
def test_the_observed_order_is_that_of_the_method(name, order):
    exact = apsis.integrate(ode(1.0), [2.0, 0.0], (0, 1), name, dt=1 / 2048).u[-1]
    errors = [np.abs(apsis.integrate(ode(1.0), [2.0, 0.0], (0, 1), name, dt=dt).u[-1] - exact).sum() for dt in (1 / 64, 1 / 128)]
    assert np.log2(errors[0] / errors[1]) > order - 0.25


def test_results_are_those_of_the_program():
    mine = apsis.integrate(ode(1e-4), [2.0, 0.0], (0, 1), "md-imex-6-3", dt=1 / 64)
    theirs = apsis.run("paper/ode", "model.epsilon=1e-4", "time.dt=1/64", "time.end=1.0", "time.method=md-imex-6-3")
    assert mine.steps == theirs.summary["steps"] == 64
    # Both compute the same stages in the same order, but NumPy may round sin differently.
    np.testing.assert_allclose(mine.u[-1], theirs.f[0], rtol=1e-13)


def test_a_smaller_tolerance_gives_smaller_errors_and_more_steps():
    name = "md-imex-8-3-accurate"
    exact = apsis.integrate(ode(1e-2), [2.0, 0.0], (0, 1), name, dt=1 / 4096).u[-1]
    found = [apsis.integrate(ode(1e-2), [2.0, 0.0], (0, 0.5, 1), name, dt=0.5, tolerance=tol) for tol in (1e-3, 1e-6)]
    errors = [np.abs(one.u[-1] - exact).max() for one in found]
    # Bounds have wide margins: errors add up over steps, while the estimate of a step is far above its error.
    assert errors[0] < 1e-2 and errors[1] < 1e-4 and errors[1] < errors[0] / 10
    assert found[1].steps > 2 * found[0].steps


def test_failed_steps_are_repeated_with_a_smaller_step_to_a_tolerance():
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
    # Steps of r Δt_FE conserve to rounding and keep the bounds of the data.
    np.testing.assert_allclose(seen.u[:, 0].sum(axis=1), u0[0].sum(), rtol=1e-13)
    assert seen.u[:, 0].min() >= 1.0 - 1e-12 and seen.u[:, 0].max() <= 3.0 + 1e-12


def test_arrays_passed_to_functions_are_read_only():
    def transport(t, u):
        u[0] = 1.0
    problem = ode(1.0)
    problem.transport = transport
    with pytest.raises(ValueError, match="read-only"):
        apsis.integrate(problem, [2.0, 0.0], (0, 1), dt=0.1)


def test_exceptions_of_the_functions_propagate():
    class Mine(Exception):
        pass
    def fail(u):
        raise Mine("no")
    problem = ode(1.0)
    problem.moments = fail
    with pytest.raises(Mine, match="no"):
        apsis.integrate(problem, [2.0, 0.0], (0, 1), dt=0.1)


@pytest.mark.parametrize("change, arguments, message", [
    (dict(transport=lambda t, u: [1.0]), {}, r"transport returned an array of shape \(1,\).*shape of u, \(2,\)"),
    (dict(transport=lambda t, u: np.zeros((2, 1))), {}, r"transport returned an array of shape \(2, 1\)"),
    (dict(transport=lambda t, u: "abc"), {}, "transport returned a value of type str"),
    (dict(transport=lambda t, u: None), {}, "transport returned None"),
    (dict(transport=lambda t, u: [None, 1.0]), {}, "transport returned a value of type list"),
    (dict(transport=lambda t, u: [[1.0], 2.0]), {}, "transport returned a value of type list"),
    (dict(equilibrium=lambda w: np.array([1.0, 2.0j])), {}, "equilibrium returned an array of shape .* type complex128"),
    (dict(moments=lambda u: None), {}, "moments returned None"),
    (dict(rate=lambda w: np.ones(3)), {}, r"rate returned an array of shape \(3,\).*broadcasts to the shape of u, \(2,\)"),
    (dict(moments=lambda u: u[0] + u[1], equilibrium=lambda w: [0.5 * w, 0.5 * w], rate=lambda w: np.array([1.0, 2.0])), {},
     "the rates do not conserve the moments"),
    (dict(rate=lambda w: None), {}, "rate returned None"), (dict(rate=lambda w: "x"), {}, "rate returned a value of type str"),
    (dict(admissible=lambda u: u > 0), {}, "admissible returned an array .*True or False"),
    (dict(admissible=lambda u: None), {}, "admissible returned None"),
    (dict(forward_euler_step=lambda t, u: [1]), dict(dt=None), "forward_euler_step returned a value of type list"),
    (dict(rate=3.0), {}, "rate of the problem is a float"), (dict(epsilon="small"), {}, "epsilon is 'small'"),
    ({}, dict(u0=[1.0, None]), "u0 is not an array of real numbers"), ({}, dict(u0=[1.0, 1.0j]), "u0 is an array of type complex128"),
    ({}, dict(t=("a", "b")), "t is an array of type"), ({}, dict(t=(0.0, np.nan)), "not finite|t1|interval"),
    ({}, dict(dt="0.1"), "dt is '0.1'"), ({}, dict(dt=np.nan), "dt is not a positive number"), ({}, dict(method=3), "method is an int"),
    ({}, dict(dt=None, safety=-1), "safety = -1 is not a positive number"), ({}, dict(safety=np.nan), "safety = nan is not a positive number"),
    ({}, dict(tolerance=True), "tolerance is True"),
    (dict(epsilon=-1.0), {}, "epsilon is negative"), ({}, dict(dt=None), "the step size is unknown"),
    ({}, dict(dt=-1.0), "dt is not a positive number"), ({}, dict(method="none"), "none"),
    ({}, dict(startup="soft"), "unknown start-up"), ({}, dict(tolerance=0.0), "tolerance is not a positive number")])
def test_bad_arguments_have_a_message(change, arguments, message):
    problem = ode(1.0)
    for name, value in change.items():
        setattr(problem, name, value)
    with pytest.raises(apsis.InputError, match=message):
        apsis.integrate(problem, **({"u0": [2.0, 0.0], "t": (0, 1), "dt": 0.1} | arguments))


def test_other_number_types_and_layouts_give_the_same_result():
    plain = apsis.integrate(ode(0.5), [2.0, 0.0], (0, 1), dt=0.25)
    odd = ode(Fraction(1, 2))
    odd.transport = lambda t, u: np.array([[u[1]], [0.0]], order="F")[:, 0]  # a view with a stride
    odd.equilibrium = lambda w: (w, np.float64(np.sin(w)))
    odd.rate = lambda w: np.array([1.0 + w * w])[0]
    assert apsis.integrate(odd, np.array([2, 0], dtype=object), np.array([0, 1]), dt=np.float64(0.25)) == plain
    exact = ode(0.5)
    exact.equilibrium = lambda w: [Fraction(float(w)), 1]
    assert apsis.integrate(exact, [2.0, 0.0], (0, 1), dt=0.25).u.shape == (2, 2)
    one = apsis.RelaxationProblem(lambda t, u: -u[0], lambda u: u, lambda w: w, lambda w: 0.0, 1.0)
    assert apsis.integrate(one, [1.0], (0, 1), "ssprk-3-3", dt=0.5).u.shape == (2, 1)


def test_arrays_given_to_functions_may_be_kept():
    kept = {"transport": [], "moments": [], "admissible": []}
    seen = {name: [] for name in kept}
    def note(name, u):
        kept[name].append(u)
        seen[name].append(u.tolist())
    problem = ode(1e-2)
    inner = problem.transport
    problem.transport = lambda t, u: (note("transport", u), inner(t, u))[1]
    problem.moments = lambda u: (note("moments", u), u[0])[1]
    problem.admissible = lambda u: (note("admissible", u), True)[1]
    apsis.integrate(problem, [2.0, 0.0], (0, 1), dt=1 / 64)
    gc.collect()
    junk = [np.full(2, -7.0) for _ in range(1000)]  # reuses freed memory
    assert len(junk) == 1000
    for name, arrays in kept.items():
        assert len(arrays) > 100
        assert [a.tolist() for a in arrays] == seen[name], name


def test_a_view_of_u_may_be_the_moments():
    # The integrator needs the moments after the call, when u, whose memory they share, has changed.
    u0 = np.ones((2, 50)) + np.arange(50)
    problem = apsis.RelaxationProblem(lambda t, u: np.zeros((2, 50)), lambda u: u[0], lambda w: np.stack([w, 2 * w]), lambda w: 1.0, 0.0)
    end = apsis.integrate(problem, u0, (0, 1), "md-imex-6-3", dt=0.5).u[-1]
    # Each stage is a convex combination of equal numbers, with one rounding error.
    np.testing.assert_allclose(end, [u0[0], 2 * u0[0]], rtol=4e-16)


class Mine(Exception):
    """An exception raised by the user."""


class Fails:
    """A value whose conversion raises an exception."""

    def __init__(self, what):
        self.what = what

    def __array__(self, *_, **__):
        raise self.what

    def __float__(self):
        raise self.what

    def __bool__(self):
        raise self.what


@pytest.mark.parametrize("what", [Mine("no"), KeyboardInterrupt(), SystemExit(3), MemoryError()])
@pytest.mark.parametrize("function", ["transport", "equilibrium", "rate", "admissible", "forward_euler_step"])
@pytest.mark.parametrize("inside", ["function", "conversion"])
def test_exceptions_propagate_unchanged(function, inside, what):
    def fail(*_):
        if inside == "function":
            raise what
        return Fails(what)
    problem = ode(1.0, forward_euler_step=lambda t, u: 0.1)
    setattr(problem, function, fail)
    with pytest.raises(type(what)) as caught:
        apsis.integrate(problem, [2.0, 0.0], (0, 1))
    assert caught.value is what


def test_an_exception_of_a_conversion_is_the_cause_of_the_message():
    problem = ode(1.0)
    problem.transport = lambda t, u: Fails(ValueError("mine"))
    with pytest.raises(apsis.InputError, match="transport returned a value of type Fails") as caught:
        apsis.integrate(problem, [2.0, 0.0], (0, 1), dt=0.1)
    assert repr(caught.value.__cause__) == "ValueError('mine')"


@pytest.mark.parametrize("where", ["transport", "conversion", "moments", "rate", "admissible"])
def test_control_c_raises_keyboard_interrupt_wherever_it_arrives(where):
    # The signal arrives while a function in Python runs. Python handles it there or at the next step.
    class Interrupting:
        def __array__(self, *_, **__):
            signal.raise_signal(signal.SIGINT)
            return np.zeros(2)
    def interrupted(value):
        signal.raise_signal(signal.SIGINT)
        return value
    problem = ode(1.0, admissible=lambda u: True)
    if where == "conversion":
        problem.transport = lambda t, u: Interrupting()
    else:
        before = getattr(problem, where)
        setattr(problem, where, lambda *arguments: interrupted(before(*arguments)))
    with pytest.raises(KeyboardInterrupt):
        apsis.integrate(problem, [2.0, 0.0], (0, 1), dt=0.01)


def test_a_tolerance_needs_no_step():
    # The final error is proportional to tol^(p/(q + 1)) = tol. In the tables of docs/methods.md, errors are at most
    # 32 tolerances.
    exact = apsis.integrate(ode(1e-3), [2.0, np.sin(2.0)], (0, 1), "md-imex-14-4-accurate", dt=1 / 4096).u[-1]
    for tolerance in (1e-3, 1e-5):
        found = apsis.integrate(ode(1e-3), [2.0, np.sin(2.0)], (0, 1), "md-imex-8-3-mixed", tolerance=tolerance)
        assert 2 < found.steps < 2000 and np.abs(found.u[-1] - exact).max() < 32 * tolerance
    assert apsis.integrate(ode(1e-3), [2.0, 0.0], (0, 1), "md-imex-8-3-mixed", tolerance=1e-3, startup="graded").steps > 10


def test_every_law_of_step_control_keeps_the_tolerance():
    exact = apsis.integrate(ode(1e-2), [2.0, np.sin(2.0)], (0, 1), "md-imex-14-4-accurate", dt=1 / 2048).u[-1]
    found = {law: apsis.integrate(ode(1e-2), [2.0, np.sin(2.0)], (0, 1), "md-imex-8-3-mixed", tolerance=1e-5, controller=law)
             for law in ("predictive", "integral", "pi", "pid", "h211b", "h312pid")}
    # In the tables of docs/methods.md, errors are at most 32 tolerances.
    assert all(np.abs(one.u[-1] - exact).max() < 32e-5 for one in found.values())
    # Some laws may take the same steps: those in which every step is twice as long as the last one.
    assert len({one.u[-1].tobytes() for one in found.values()}) >= 4
    assert found["predictive"] == apsis.integrate(ode(1e-2), [2.0, np.sin(2.0)], (0, 1), "md-imex-8-3-mixed", tolerance=1e-5)
    with pytest.raises(apsis.InputError, match="unknown controller 'pdi' .*valid: predictive, integral, pi, pid"):
        apsis.integrate(ode(1e-2), [2.0, 0.0], (0, 1), tolerance=1e-5, controller="pdi")
    with pytest.raises(apsis.InputError, match="controller has no meaning without a tolerance"):
        apsis.integrate(ode(1e-2), [2.0, 0.0], (0, 1), dt=0.1, controller="pi")


def test_a_graded_start_takes_fewer_steps_with_a_larger_growth():
    def steps(growth):
        return apsis.integrate(ode(1e-4), [2.0, 0.0], (0, 1), "extrapolated-euler-7", dt=0.25, startup="graded",
                               startup_growth=growth).steps

    # The first of four steps is divided into 1 + ceil(log(8 dt C/(g epsilon))/log(g)) steps, with C = 5.
    assert [steps(g) for g in (2, 4, 8, 64)] == [3 + 1 + 16, 3 + 1 + 8, 3 + 1 + 5, 3 + 1 + 2]
    with pytest.raises(apsis.InputError, match="growth of a graded start is 1 .*from 2 to 64"):
        steps(1)
    with pytest.raises(apsis.InputError, match="startup_growth has no meaning without a graded start"):
        apsis.integrate(ode(1e-4), [2.0, 0.0], (0, 1), dt=0.25, startup_growth=4)


def test_a_method_that_cannot_integrate_the_problem_is_refused():
    with pytest.raises(apsis.InputError, match="imdrk-2-3.*transport"):
        apsis.integrate(ode(1e-2), [2.0, 0.0], (0, 1), "imdrk-2-3", dt=0.1)
    with pytest.raises(apsis.InputError, match="SSP coefficient"):
        apsis.integrate(ode(1e-2, forward_euler_step=lambda t, u: 0.1), [2.0, 0.0], (0, 1), "ars-443")
    wrong = ode(1e-2)
    wrong.equilibrium = lambda w: [w + 1e-3, np.sin(w)]  # the moment of this equilibrium is not w
    with pytest.raises(apsis.InputError, match="moments"):
        apsis.integrate(wrong, [2.0, 0.0], (0, 1), dt=0.1)


def test_a_method_may_be_an_object_or_a_file(tmp_path):
    by_name = apsis.integrate(ode(1e-2), [2.0, 0.0], (0, 1), "md-imex-3-2", dt=0.25)
    assert apsis.integrate(ode(1e-2), [2.0, 0.0], (0, 1), apsis.method("md-imex-3-2"), dt=0.25) == by_name
    assert apsis.integrate(ode(1e-2), [2.0, 0.0], (0, 1), "md-imex-6-3", dt=0.25) != by_name


def test_a_solution_equals_its_copy_and_has_a_short_representation():
    one = apsis.integrate(ode(1e-2), [2.0, 0.0], (0, 0.5, 1), dt=0.25)
    again = pickle.loads(pickle.dumps(one))
    assert again == one and again is not one
    assert repr(one) == "<apsis.Solution: 3 states of shape (2,) from t = 0 to 1, 4 steps of extrapolated-euler-8, 0 rejected>"
    assert "<td>4</td>" in one._repr_html_()


def test_a_failure_reports_its_stage_and_place():
    problem = ode(1.0, admissible=lambda u: u[0] < 2.5)
    with pytest.raises(apsis.NumericalError, match="not admissible") as failure:
        apsis.integrate(problem, [2.0, 1.0], (0, 5), dt=0.1)
    assert failure.value.step > 1 and 0.0 < failure.value.t < 5.0
    assert isinstance(failure.value, ArithmeticError)


@pytest.mark.parametrize("method", ["md-imex-8-3-mixed", "ark-436", "exponential-2"])
def test_cells_may_have_rates_of_their_own(method):
    """Cells side by side are solved as alone: a layer with ε/C from 1e-12 to 1, and cells that do not relax."""
    rates = np.concatenate([[0.0], 10.0 ** np.linspace(0, 12, 5)])
    u0 = np.stack([2.0 + np.arange(6), np.zeros(6)], axis=-1)

    def problem(rate):
        return apsis.RelaxationProblem(lambda t, u: -0.1 * u, lambda u: u.sum(axis=-1),
                                       lambda w: np.stack([w ** 2 / 16, w - w ** 2 / 16], axis=-1), rate, 1.0)

    together = apsis.integrate(problem(lambda w: rates[:, None]), u0, (0, 0.5, 1), method, dt=0.25)
    for cell, rate in enumerate(rates):
        alone = apsis.integrate(problem(lambda w: rate), u0[cell], (0, 0.5, 1), method, dt=0.25)
        np.testing.assert_array_equal(together.u[:, cell], alone.u)
