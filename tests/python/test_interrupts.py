"""Ctrl-C before the first step raises KeyboardInterrupt while initial data are sampled, which can take minutes. No files are written."""
import signal
import subprocess
import sys
import textwrap

import pytest

CALLS = {
    "run": """
        print("needs nothing", file=sys.stderr, flush=True)
        apsis.run({"model": {"name": "bgk", "epsilon": 0.1}, "velocity": {"max": 8.0, "points": 16}, "space": {"cells": 1500000, "domain": [0, 1]},
                   "time": {"end": 1.0, "dt": 1e-9, "method": "md-imex-6-3"},
                   "initial": {"rho": "1 + 0.1*sin(x)", "u": "sin(x)/10", "T": "1 + exp(-x)/10"}}, out="o", threads=1)""",
    "sample": """
        problem = apsis.KineticProblem("bgk", cells=1500000, domain=(0, 2), velocities=(8, 16))
        print("needs nothing", file=sys.stderr, flush=True)
        problem.sample("mixed-v")""",
    "state": """
        problem = apsis.KineticProblem("bgk", cells=1500000, domain=(0, 2), velocities=(8, 16))
        print("needs nothing", file=sys.stderr, flush=True)
        problem.state(rho=1, u=0.5, T=1)""",
}


@pytest.mark.parametrize("name", CALLS)
def test_sampling_ends_with_keyboard_interrupt(name, tmp_path):
    # In the background of a shell without job control, programs ignore the signal, and Python sets no handler. So the test sets it.
    code = f"""
    import signal
    import sys
    import apsis
    signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        {textwrap.indent(textwrap.dedent(CALLS[name]), "        ").strip()}
        print("complete")
    except KeyboardInterrupt:
        print("interrupted")
    """
    with subprocess.Popen([sys.executable, "-c", textwrap.dedent(code)], cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          text=True) as child:
        for line in child.stderr:
            if "needs" in line:
                break
        child.send_signal(signal.SIGINT)
        try:
            out, err = child.communicate(timeout=300)
        finally:
            child.kill()
    assert out == "interrupted\n", err
    assert not (tmp_path / "o").exists()
