"""Complex steps are compared with differences during an integration: functions may be analytic at the start and not later."""
import math
import pickle
import warnings

import apsis
import numpy as np
import pytest
from apsis.derivative_checks import ComplexStepCheck
from apsis.derivatives import Derivatives

scipy_integrate = pytest.importorskip("scipy.integrate", reason="solve_ivp returns objects of SciPy")


def absolute(t, y):
    return -50 * np.abs(y) * y + 10 * np.cos(t)  # derivative 0 at y = 0, with both signs afterwards


def real_part(t, y):
    return -50 * y.real ** 2 + 10 + 0 * y


def late_absolute(t, y):
    return -500 * (np.abs(y) if t.real > 0.5 else y) + 100


def late_time(t, y):
    return -500 * (y - abs(t - 0.3)) if t.real > 0.5 else -500 * (y - t)


def late_real_numbers(t, y):
    return -500 * (np.array([math.atan(y[0])]) if t.real > 0.5 else y) + 100


def limited(t, y):
    return -500 * np.maximum(y - 0.5, 0) + 1  # the solution comes to rest near the kink


def smooth(t, y):
    return -500 * y ** 2 + np.cos(t)


def solve(collision, method, **more):
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        solution = apsis.solve_ivp(None, collision, (0, 1), [0.0], method=method, rtol=1e-6, atol=1e-8, **more)
    return solution, [str(one.message) for one in found if issubclass(one.category, apsis.ApsisWarning)]


def exact(collision):
    return scipy_integrate.solve_ivp(collision, (0, 1), [0.0], method="Radau", rtol=1e-10, atol=1e-12).y[0, -1]


METHODS = [("auto", "derivatives of collision are differences from here on"), ("extrapolated-euler-5", "derivatives of collision are differences from here on"),
           ("imdrk-9-5", "derivatives of collision are differences, and the integration begins again")]


@pytest.mark.parametrize("collision", [absolute, real_part, late_absolute])
@pytest.mark.parametrize("method, start", METHODS)
def test_functions_that_are_not_analytic_later_are_noticed_and_warned_of_once(collision, method, start):
    found, messages = solve(collision, method)
    assert found.success and found.derivatives == "finite differences"
    assert len(messages) == 1 and messages[0].startswith(start + " (complex steps are wrong at t = "), messages
    assert messages[0].endswith("as with abs, .real or np.maximum); give jac, or a collision of analytic functions")
    assert found.y[0, -1] == pytest.approx(exact(collision), abs=1e-6)


def test_the_solution_of_a_method_with_second_derivatives_begins_again():
    """Its Q'Q was wrong before. The result is that of differences from the start."""
    again, messages = solve(late_absolute, "imdrk-9-5")
    from_start, none = solve(lambda t, y: late_absolute(t, np.array([float(x) for x in y])), "imdrk-9-5")  # refuses complex numbers
    assert len(messages) == 1 and none == [] and from_start.derivatives == "finite differences"
    np.testing.assert_array_equal(again.t, from_start.t)
    np.testing.assert_array_equal(again.y, from_start.y)


def test_time_derivatives_are_compared_too():
    found, messages = solve(late_time, "imdrk-9-5")
    assert len(messages) == 1 and "the integration begins again" in messages[0]
    assert found.derivatives == "complex steps"  # by y they are right
    assert found.y[0, -1] == pytest.approx(exact(late_time), abs=1e-6)


@pytest.mark.parametrize("method", [method for method, _ in METHODS])
def test_functions_that_refuse_complex_numbers_later_do_not_end_the_integration(method):
    found, messages = solve(late_real_numbers, method)
    assert found.success and found.derivatives == "finite differences" and len(messages) == 1
    assert found.y[0, -1] == pytest.approx(exact(late_real_numbers), abs=1e-6)


@pytest.mark.parametrize("collision", [smooth, limited])
@pytest.mark.parametrize("method", [method for method, _ in METHODS])
def test_analytic_functions_and_kinks_between_them_cause_no_warning(collision, method):
    found, messages = solve(collision, method)
    assert messages == [] and found.derivatives == "complex steps"


def test_a_kink_at_the_start_has_no_complex_derivative():
    found, messages = solve(lambda t, y: -500 * np.abs(y) + np.cos(t), "extrapolated-euler-5")
    assert messages == [] and found.derivatives == "finite differences"
    for collision, kind in ((np.abs, "finite differences"), (np.square, "complex steps"), (lambda u: 3 * u + 1, "complex steps"),
                            (lambda u: u ** 3 + np.exp(u), "complex steps")):
        assert Derivatives(collision, None, np.zeros(2)).by == kind


@pytest.mark.parametrize("method", ["imdrk-9-5", "extrapolated-euler-5"])
@pytest.mark.parametrize("form", [dict(), dict(local=True), dict(local=True, vectorized=True)], ids=["whole", "cells", "vectorized"])
def test_general_problems_are_compared_too(method, form):
    u0 = np.zeros((2, 1)) if form else np.zeros(2)
    with pytest.warns(apsis.ApsisWarning, match="give jacobian, or a collision of analytic functions") as messages:
        found = apsis.integrate(apsis.GeneralProblem(lambda u: -50 * np.abs(u) * u + 10, **form), u0, (0, 1), method, dt=0.01)
    assert len(messages) == 1 and found.derivatives == "finite differences"
    np.testing.assert_allclose(found.u[-1], np.sqrt(0.2), rtol=1e-6)


def test_dense_output_is_that_of_the_derivatives_of_the_end():
    found, _ = solve(real_part, "auto", dense_output=True)
    copy = pickle.loads(pickle.dumps(found))
    times = np.linspace(0, 1, 20)
    np.testing.assert_array_equal(copy.sol(times), found.sol(times))


def test_a_warning_that_is_an_exception_leaves_as_one():
    with warnings.catch_warnings():
        warnings.simplefilter("error", apsis.ApsisWarning)
        for method in ("auto", "imdrk-9-5"):
            with pytest.raises(apsis.ApsisWarning, match="complex steps are wrong"):
                apsis.solve_ivp(None, absolute, (0, 1), [0.0], method=method)


def test_the_number_of_checks_is_the_logarithm_of_that_of_the_calls():
    check = ComplexStepCheck(3)
    due = [call for call in range(1, 10**5) if check.is_due()]
    assert due[:5] == [3, 5, 8, 13, 20] and len(due) < 30
