"""Warnings of the library are warnings of Python: filters see them, and nothing is printed twice."""
import subprocess
import sys
import warnings

import apsis
import numpy as np
import pytest

UNEVEN = ["paper/decay", "time.method=imdrk-1-2", "time.dt=0.3"]


def test_a_warning_of_a_run_is_one_of_python_at_the_line_of_the_caller(capfd):
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        result = apsis.run(*UNEVEN)
    (warning,) = found
    assert warning.category is apsis.ApsisWarning and issubclass(apsis.ApsisWarning, UserWarning)
    assert "does not divide time.end" in str(warning.message) and result.summary["warnings"] == [str(warning.message)]
    assert warning.filename == __file__
    assert capfd.readouterr().err == ""  # the warning was recorded


def test_a_warning_is_printed_once():
    code = f"import apsis\napsis.run(*{UNEVEN!r})"
    for options in ([], ["-W", "always"]):
        done = subprocess.run([sys.executable, *options, "-c", code], capture_output=True, text=True, check=True)
        assert done.stderr.count("does not divide time.end") == 1 and "ApsisWarning" in done.stderr
    ignored = subprocess.run([sys.executable, "-W", "ignore", "-c", code], capture_output=True, text=True, check=True)
    assert ignored.stderr == ""


def test_warnings_as_errors_end_a_run_with_its_results(tmp_path):
    with warnings.catch_warnings():
        warnings.simplefilter("error", apsis.ApsisWarning)
        with pytest.raises(apsis.ApsisWarning, match="does not divide time.end"):
            apsis.run(*UNEVEN, out=tmp_path)
    assert (tmp_path / "checkpoint.h5").is_file() and apsis.open(tmp_path).state == "interrupted"


def test_warnings_as_errors_do_not_replace_an_exception():
    def fail(*_):
        raise RuntimeError("mine")
    with warnings.catch_warnings():
        warnings.simplefilter("error", apsis.ApsisWarning)
        with pytest.raises(RuntimeError, match="mine"):  # the run warns afterwards that nothing was saved
            apsis.run("paper/decay", "time.method=imdrk-1-2", "time.dt=0.5", progress=fail)


def test_warnings_come_during_a_run():
    events = []
    with warnings.catch_warnings():
        warnings.showwarning = lambda message, *_: events.append(str(message))
        warnings.simplefilter("always")
        apsis.run(*UNEVEN, progress=lambda *_: events.append("progress"))
    assert "does not divide time.end" in events[0] and events[1:] and set(events[1:]) == {"progress"}


@pytest.mark.parametrize("solve", [
    lambda n: apsis.integrate(apsis.GeneralProblem(lambda u: -u), np.ones(n), (0, 1), "md-imex-6-3", dt=0.5),
    lambda n: apsis.solve_ivp(None, lambda t, y: -y, (0, 1), np.ones(n), method="md-imex-6-3", dt=0.5)], ids=["integrate", "solve_ivp"])
def test_a_large_dense_system_gives_one_warning(solve, capfd):
    pytest.importorskip("scipy")
    with pytest.warns(apsis.ApsisWarning) as found:
        solve(240)
    (warning,) = found
    assert warning.category is apsis.CostWarning and "a stage has 240 unknowns" in str(warning.message)
    assert warning.filename == __file__ and capfd.readouterr().err == ""


def test_callbacks_that_solve_problems_of_their_own_pass_their_warnings_on():
    """The inner integration begins while the outer one is in the compiled part."""
    inner = apsis.RelaxationProblem(lambda t, u: [1.0, 100.0 * np.arctan(u[0]) + 1.0 / (1.0 + u[0] ** 2)], lambda u: u[0],
                                    lambda w: [w, 0.0], lambda w: 1.0, 0.01)

    def transport(t, u):
        apsis.integrate(inner, [0.0, 0.0], (0, 10), "md-imex-6-3", dt=0.1)
        return 0 * u

    outer = apsis.GeneralProblem(lambda u: -u, transport)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(apsis.ApsisWarning, match="method 'md-imex-6-3' is unfit for steps of 0.1"):
            apsis.integrate(outer, [1.0], (0, 1), "md-imex-3-2", dt=0.5)
