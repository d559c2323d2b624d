"""method = "auto", the default of integrate, and warnings of methods that are unfit for their steps."""
import json

import apsis
import numpy as np
import pytest


def arctangent():
    """y' = −100 y + 100 atan t + 1/(1 + t²) with t as the first unknown, y = atan t."""
    return apsis.RelaxationProblem(
        transport=lambda t, u: [1.0, 100.0 * np.arctan(u[0]) + 1.0 / (1.0 + u[0] ** 2)], moments=lambda u: u[0],
        equilibrium=lambda w: [w, 0.0], rate=lambda w: 1.0, epsilon=0.01)


def test_the_default_method_integrates_a_stiff_equation_in_long_steps(recwarn):
    solution = apsis.integrate(arctangent(), [0.0, 0.0], (0, 10), dt=0.1)
    assert abs(solution.u[-1, 1] - np.arctan(10.0)) < 1e-6
    assert solution.method == "extrapolated-euler-8" and solution.reason.startswith("equal steps of a system")
    assert not recwarn.list


def test_an_unfit_method_is_named_with_one_that_fits():
    with pytest.warns(apsis.ApsisWarning) as found:
        solution = apsis.integrate(arctangent(), [0.0, 0.0], (0, 10), "md-imex-6-3", dt=0.1)
    assert abs(solution.u[-1, 1] - np.arctan(10.0)) > 0.5  # as the warning says
    (warning,) = found
    assert "method 'md-imex-6-3' is unfit for steps of 0.1" in str(warning.message) and 'choose method = "' in str(warning.message)
    assert warning.filename == __file__
    assert solution.method == "md-imex-6-3" and solution.reason == ""


def test_small_steps_are_fit_and_no_warning_is_given(recwarn):
    apsis.integrate(arctangent(), [0.0, 0.0], (0, 0.1), "md-imex-6-3", dt=1e-4)
    assert not recwarn.list


def test_the_choice_follows_bounds_and_tolerance():
    problem = arctangent()
    by_tolerance = apsis.integrate(problem, [0.0, 0.0], (0, 1), tolerance=1e-5)
    assert by_tolerance.method == "extrapolated-euler-5"
    assert abs(by_tolerance.u[-1, 1] - np.arctan(1.0)) < 3e-4
    problem.admissible = lambda u: True
    assert apsis.integrate(problem, [0.0, 0.0], (0, 1), dt=0.1).method == "md-imex-8-3-mixed"
    assert apsis.integrate(problem, [0.0, 0.0], (0, 1), tolerance=1e-3).method == "md-imex-10-3-mixed"


def test_systems_with_any_collision_have_a_choice_of_their_own():
    problem = apsis.GeneralProblem(lambda u: -1000.0 * (u - np.array([1.0, 2.0])))
    found = apsis.integrate(problem, [0.0, 0.0], (0, 1), tolerance=1e-5)
    assert found.method == "ark-548-2" and np.abs(found.u[-1] - [1.0, 2.0]).max() < 1e-4
    assert found.reason.startswith("tolerance 1e-05 of a system with a general collision: ")
    assert apsis.integrate(problem, [0.0, 0.0], (0, 1), dt=0.01).method == "extrapolated-euler-8"
    problem.admissible = lambda u: True
    assert apsis.integrate(problem, [0.0, 0.0], (0, 1), tolerance=1e-3).method == "md-imex-10-3-mixed"


def test_problems_on_meshes_choose_too():
    problem = apsis.KineticProblem("bgk", cells=12, domain=(0, 2), velocities=(9, 24), epsilon=1e-3, formulation="finite-difference")
    u0 = problem.state(rho=1, T=1)
    assert apsis.integrate(problem, u0, (0, 0.01)).method == "md-imex-8-3-mixed"
    assert apsis.integrate(problem, u0, (0, 0.01), tolerance=1e-3, dt=0.01).method == "extrapolated-euler-3"


def test_exceptions_for_states_of_the_estimate_alone_do_not_end_an_integration():
    """The estimate of unfit steps evaluates the transport at the equilibrium y = 0, but the solution is y = 1 at all times."""
    def transport(t, u):
        if u[1] == 0.0:
            raise ValueError("y = 0")
        return [0.0, 0.0]
    problem = apsis.RelaxationProblem(transport, lambda u: u[0], lambda w: [w, 0.0], lambda w: 1.0, 1e3)
    assert apsis.integrate(problem, [1.0, 1.0], (0, 0.1), "md-imex-6-3", dt=0.05).steps == 2


def test_interrupts_are_not_suppressed():
    def transport(t, u):
        raise KeyboardInterrupt
    problem = apsis.RelaxationProblem(transport, lambda u: u[0], lambda w: [w, 0.0], lambda w: 1.0, 1.0)
    with pytest.raises(KeyboardInterrupt):
        apsis.integrate(problem, [1.0, 1.0], (0, 0.1), "md-imex-6-3", dt=0.05)


def test_runs_of_cases_have_the_choice_in_their_manifest(tmp_path):
    apsis.run("paper/relaxation", "time.method=auto", "time.end=0.01", out=tmp_path / "r")
    manifest = json.loads((tmp_path / "r" / "manifest.json").read_text())
    assert manifest["method"] == "md-imex-8-3-mixed" and manifest["method_given"] == "auto"
    assert manifest["method_reason"].startswith("equal steps on a mesh")
    # A restart continues with the method of the checkpoint.
    apsis.run("paper/relaxation", "time.method=auto", "time.end=0.02", out=tmp_path / "r", restart=tmp_path / "r" / "checkpoint.h5")
    assert json.loads((tmp_path / "r" / "manifest.json").read_text())["method"] == "md-imex-8-3-mixed"
