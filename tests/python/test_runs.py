"""Runs of cases from Python."""
import json
import os
import pickle
import re
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import apsis
import numpy as np
import pytest

SMALL = ["space.cells=20", "velocity.points=100", "time.end=0.005"]


def test_a_case_from_a_name_a_file_and_a_mapping_is_the_same(tmp_path):
    case = {"title": 'with "quotes"', "model": {"name": "bgk", "epsilon": 1e-3, "initial": "mixed-v"},
            "space": {"cells": 20, "domain": (0.0, 2.0), "limiter": "positivity"}, "velocity": {"max": 15.0, "points": np.int64(100)},
            "time": {"method": "md-imex-3-2", "end": 0.005, "cfl": 1 / 24}}
    one = apsis.run(case)
    (tmp_path / "case.toml").write_text(apsis.case_text.to_toml(case), encoding="utf-8")
    other = apsis.run(tmp_path / "case.toml")
    third = apsis.run("paper/bgk-mixed", *SMALL, "model.epsilon=1e-3", "time.method=md-imex-3-2")
    assert np.array_equal(one.f, other.f) and np.array_equal(one.f, third.f)
    assert one.summary["case"]["title"] == 'with "quotes"'


def test_initial_data_of_a_mapping_may_have_regions_and_sums(tmp_path):
    beam = {"rho": "1 + 0.2*sin(pi*x)", "T": "1/(1 + 0.2*sin(2*pi*x))"}
    initial = {"part": [{"weight": 0.5, "u": 1, **beam}, {"weight": "M", "u": -0.5, **beam}],
               "region": [{"where": "x < 0.25", "rho": 1, "u": [0.25], "T": 2}]}
    case = {"parameters": {"M": 0.3}, "model": {"name": "bgk"}, "initial": initial,
            "space": {"cells": 20, "domain": (0.0, 2.0)}, "velocity": {"max": 15.0, "points": 100},
            "time": {"method": "md-imex-3-2", "end": 0, "cfl": 0.04}}
    data, named = apsis.run(case), apsis.run("paper/bgk-mixed", *SMALL, "time.end=0")
    assert data.fields["T"][-1][0] == pytest.approx(2.0, rel=1e-14) and data.fields["u"][-1][1] == pytest.approx(0.25, rel=1e-14)
    # T is computed from moments; the tails of the Maxwellian amplify its rounding error.
    assert np.allclose(data.f[3:], named.f[3:], rtol=1e-11, atol=1e-300)
    assert data.summary["case"]["initial"]["region"][0]["where"] == "x < 0.25"


def test_arrays_agree_with_each_other_and_with_the_files(tmp_path):
    h5py = pytest.importorskip("h5py")
    r = apsis.run("paper/bgk-mixed", *SMALL, "output.every=0.002", out=tmp_path / "o")
    assert r.state == "complete" and r.f.shape == (20, 100) and r.f.min() >= 0.0
    assert r.fields["rho"].shape == (len(r.t), 20) and r.t[0] == 0.0 and r.t[-1] == 0.005
    # The tolerance is for rounding errors of midpoint sums of 100 numbers below 1.
    np.testing.assert_allclose(r.f.sum(axis=1) * (r.v[1] - r.v[0]), r.fields["rho"][-1], rtol=1e-13)
    with h5py.File(tmp_path / "o" / "solution.h5") as file:
        assert np.array_equal(file["f"][()], r.f) and np.array_equal(file["epsilon"][()], r.epsilon)
        assert json.loads(file.attrs["manifest"])["result"]["steps"] == r.summary["steps"]
    assert len(r.history["t"]) == r.summary["steps"] + 1
    assert not r.f.flags.owndata  # f is memory of the library


def test_progress_is_told_and_can_end_the_run(tmp_path):
    calls = []
    def watch(step, steps, t, smallest):
        calls.append((step, steps, t, smallest))
        return np.bool_(len(calls) < 3)
    r = apsis.run("paper/bgk-mixed", "time.end=50.0", out=tmp_path / "o", progress=watch)
    assert r.state == "interrupted" and len(calls) == 3 and calls[-1][0] > 0
    # Only the last 64 steps depend on the end: they divide the remaining time.
    end = float(r.t[-1]) + 80 * float(r.history["dt"][-1])
    again = apsis.run("paper/bgk-mixed", f"time.end={end!r}", restart=tmp_path / "o" / "checkpoint.h5")
    whole = apsis.run("paper/bgk-mixed", f"time.end={end!r}")
    assert np.array_equal(again.f, whole.f)


def test_other_threads_run_meanwhile_and_control_c_ends_a_run_with_a_checkpoint(tmp_path):
    ticks, started = [], threading.Event()
    def interrupt():
        started.wait()
        for _ in range(20):
            time.sleep(0.01)
            ticks.append(1)
        os.kill(os.getpid(), signal.SIGINT)
    thread = threading.Thread(target=interrupt)
    thread.start()
    with pytest.raises(KeyboardInterrupt):
        apsis.run("paper/bgk-mixed", "time.end=5000.0", out=tmp_path / "o", progress=lambda *_: started.set())
    thread.join()
    assert len(ticks) == 20
    so_far = apsis.open(tmp_path / "o")
    assert so_far.summary["t"] > 0
    end = 1.01 * so_far.summary["t"]
    assert apsis.run("paper/bgk-mixed", f"time.end={end!r}", restart=tmp_path / "o" / "checkpoint.h5").state == "complete"


def test_an_exception_of_progress_keeps_the_results_so_far(tmp_path):
    def fail(*_):
        raise RuntimeError("mine")
    with pytest.raises(RuntimeError, match="mine"):
        apsis.run("paper/bgk-mixed", "time.end=50.0", out=tmp_path / "o", progress=fail)
    assert (tmp_path / "o" / "checkpoint.h5").is_file()


def test_errors_are_those_of_the_program(tmp_path):
    with pytest.raises(apsis.InputError, match="did you mean|cells"):
        apsis.run("paper/bgk-mixed", "space.cell=3")
    with pytest.raises(apsis.InputError, match=re.escape("case[\"model\"][\"name\"]: 'model.name' is the text 'none'")):
        apsis.run({"model": {"name": "none"}})
    with pytest.raises(apsis.InputError, match="no checkpoint '.*none.h5' "):
        apsis.run("paper/bgk-mixed", *SMALL, restart=tmp_path / "none.h5")
    (tmp_path / "empty.h5").touch()
    with pytest.raises(apsis.FileError):
        apsis.run("paper/bgk-mixed", *SMALL, restart=tmp_path / "empty.h5")
    class Mine(Exception):
        pass
    def fail(*_):
        raise Mine
    with pytest.raises(Mine):
        apsis.run("paper/bgk-mixed", *SMALL, progress=fail)


@pytest.mark.parametrize("name", apsis.cases())
def test_every_built_in_case_is_found(name):
    assert apsis._core.read_case(name).startswith(("title", "#", "["))


def test_the_readme_runs(capsys):
    text = (Path(__file__).resolve().parents[2] / "README.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    exec(block, {})
    said = capsys.readouterr().out
    # u2 relaxes to 0 in a time of ε, and u1 is then 2 + ε/2. Eight digits are printed.
    assert "0.904402" in said and "\n[2. 0.]" in said, said


def test_results_do_not_depend_on_threads():
    assert np.array_equal(apsis.run("paper/bgk-mixed", *SMALL).f, apsis.run("paper/bgk-mixed", *SMALL, threads=2).f)


def test_results_are_values_with_short_representations():
    one, again = apsis.run("paper/bgk-mixed", *SMALL), apsis.run("paper/bgk-mixed", *SMALL)
    assert one == again and one != apsis.run("paper/bgk-mixed", *SMALL, "model.epsilon=1") and one != 1
    assert pickle.loads(pickle.dumps(one)) == one
    assert one.labels["rho"] == "density (dimensionless)"
    text = repr(one)
    assert text.startswith("<apsis.Result 'BGK, mixed regime") and "complete at t = 0.005" in text and len(text) < 200
    assert "<th>steps</th>" in one._repr_html_()
    ode = apsis.run("paper/ode", "time.end=0.5")  # its entropy is NaN in every row, and NaN equals NaN here
    assert ode == apsis.run("paper/ode", "time.end=0.5") and "2 components" in repr(ode)


@pytest.mark.parametrize("arguments, message", [
    (dict(case=3), "case is an int"), (dict(threads=1.5), "threads is 1.5"), (dict(threads=True), "threads is True"),
    (dict(threads=10**12), "out of range"), (dict(wall=-1), "wall = -1 is not a positive number"),
    (dict(wall=float("nan")), "wall = nan"), (dict(wall="1"), "wall is '1'"), (dict(progress=1), "progress is an int")])
def test_bad_arguments_of_a_run_have_a_message(arguments, message):
    with pytest.raises(apsis.InputError, match=message):
        apsis.run(**({"case": "paper/ode"} | arguments))
    with pytest.raises(apsis.InputError, match="override 3 is an int"):
        apsis.run("paper/ode", 3)


def test_threads_outside_of_their_range_are_refused():
    for n in (-1, 257, 1000000):
        with pytest.raises(apsis.InputError, match=f"{n} threads cannot be used"):
            apsis.run("paper/bgk-mixed", *SMALL, threads=n)


def test_a_forked_child_has_threads_of_its_own():
    f = apsis.run("paper/bgk-mixed", *SMALL, threads=2).f
    child = os.fork()
    if child == 0:
        status = 1
        try:
            status = 0 if np.array_equal(apsis.run("paper/bgk-mixed", *SMALL, threads=2).f, f) else 2
        finally:
            os._exit(status)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0


def test_a_full_disk_is_an_error_and_no_crash(tmp_path):
    """The run is in a separate process, since HDF5 used to crash at the exit of the interpreter."""
    script = (
        "import resource, apsis\n"
        "resource.setrlimit(resource.RLIMIT_FSIZE, (20000, 20000))\n"
        "try:\n"
        f"    apsis.run('paper/bgk-mixed', *{SMALL!r}, out={str(tmp_path / 'o')!r})\n"
        "except apsis.FileError as error:\n"
        "    print(error)\n"
    )
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "File too large" in done.stdout
    assert not (tmp_path / "o").exists()


@pytest.mark.parametrize("case, more", [
    ("paper/bgk-mixed", SMALL), ("paper/bgk-mixed", [*SMALL, "output.every=0.002"]), ("paper/ode", ["time.dt=1/128", "time.end=1/8"])])
def test_a_stored_run_is_the_computed_one(tmp_path, case, more):
    computed = apsis.run(case, *more, out=tmp_path / "o")
    stored = apsis.open(tmp_path / "o")
    for name in ("f", "x", "epsilon", "state", "labels"):
        assert np.array_equal(getattr(stored, name), getattr(computed, name)), name
    assert list(stored.fields) == list(computed.fields) and stored.summary["steps"] == computed.summary["steps"]
    for name, values in stored.fields.items():
        assert np.array_equal(values, computed.fields[name][-len(stored.t):])
    for name, values in stored.history.items():
        assert np.array_equal(values, computed.history[name], equal_nan=True)


def test_warnings_are_listed_in_the_summary(tmp_path):
    case = ["paper/decay", "time.method=imdrk-1-2", "time.dt=0.3"]
    with pytest.warns(apsis.ApsisWarning):
        run = apsis.run(*case, out=tmp_path)
    assert len(run.summary["warnings"]) == 1 and "does not divide time.end" in run.summary["warnings"][0]
    assert apsis.open(tmp_path).summary["warnings"] == run.summary["warnings"]
    assert apsis.run(*case[:2], "time.dt=0.5").summary["warnings"] == []


def test_a_folder_that_is_no_run_is_a_file_error(tmp_path):
    with pytest.raises(apsis.FileError, match="manifest.json"):
        apsis.open(tmp_path)


def test_results_are_drawn():
    from apsis.plot.style import plt
    result = apsis.run("paper/bgk-mixed", *SMALL, "output.every=0.002")
    axes = result.plot().axes
    assert len(axes) == len(result.fields)
    assert np.array_equal(axes[0].lines[-1].get_ydata(), next(iter(result.fields.values()))[-1])
    assert result.plot("history") is not None and result.plot("distribution") is not None
    with pytest.raises(apsis.InputError, match="unknown picture 'none'.*fields, distribution, history"):
        result.plot("none")
    plt.close("all")
