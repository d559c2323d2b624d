"""Threads of Python may share objects of Apsis, and functions of the user may call Apsis again. Results are equal, bit for bit, and
there is no deadlock.

Each test runs in a separate process. Before objects could be shared, most of them ended with a segmentation fault.
"""
import subprocess
import sys
import textwrap

import pytest

BEGINNING = """
    import threading
    import apsis
    import numpy as np

    def bgk(**more):
        return apsis.KineticProblem("bgk", **{"cells": 60, "domain": (0, 2), "velocities": (8, 24), "epsilon": 1e-2, **more})

    def states(problem, count):
        u0 = problem.sample("mixed-v")
        return [u0 * (1 + 0.01 * k) for k in range(count)]

    def at_once(calls, rounds=40):
        # Every thread makes its call again and again and compares it with the first result of one thread.
        expected = [call() for call in calls]
        wrong = []
        start = threading.Barrier(len(calls))
        def repeat(k):
            try:
                start.wait()
                for _ in range(rounds):
                    if not np.array_equal(calls[k](), expected[k], equal_nan=True):
                        wrong.append(f"call {k} differs")
            except BaseException as problem:
                wrong.append(repr(problem))
        threads = [threading.Thread(target=repeat, args=(k,)) for k in range(len(calls))]
        for one in threads: one.start()
        for one in threads: one.join()
        assert not wrong, wrong[:3]
"""


def run(code, tmp_path):
    # A deadlock fails by the time limit. The tests take seconds on an idle machine.
    done = subprocess.run([sys.executable, "-X", "faulthandler", "-c", textwrap.dedent(BEGINNING) + textwrap.dedent(code)], cwd=tmp_path,
                          capture_output=True, text=True, timeout=900, check=False)
    assert done.returncode == 0, done.stderr[-2000:]
    return done.stdout


CALLS = {
    "transport": "problem.transport(u)",
    "collision": "problem.collision(u)",
    "solve_collision": "problem.solve_collision(u, 0.1, -0.01)",
    "project_to_equilibrium": "problem.project_to_equilibrium(u)",
    "forward_euler_step": "problem.forward_euler_step(u)",
    "fields": "problem.fields(u)['T']",
    "sample": "problem.sample('mixed-v')",
    "implicit": "apsis.integrate(problem, u, (0, 0.004), dt=0.001, threads=1).u",
    "explicit": "apsis.integrate(problem, u, (0, 0.002), 'ssprk-3-3', dt=0.001, threads=2).u",
    "exponential": "apsis.integrate(problem, u, (0, 0.002), 'exponential-2', dt=0.001).u",
}


@pytest.mark.parametrize("name", CALLS)
def test_threads_share_a_problem(name, tmp_path):
    run(f"""
        problem = bgk()
        at_once([lambda u=u: {CALLS[name]} for u in states(problem, 4)])
    """, tmp_path)


@pytest.mark.parametrize("more", ["formulation='finite-difference', boundary=({'kind': 'diffuse', 'T': lambda t, x: 1.1}, 'outflow')",
                                  "collisions='centres', positivity=True, epsilon=lambda x: 1e-3 + x",
                                  "acceleration=lambda t, x: 0.1 * x, largest_acceleration=0.2"])
def test_threads_share_a_problem_with_functions_of_the_user(more, tmp_path):
    run(f"""
        problem = bgk({more})
        at_once([call for u in states(problem, 2) for call in (
            lambda u=u: problem.transport(u), lambda u=u: problem.solve_collision(u, 0.1, -0.01),
            lambda u=u: apsis.integrate(problem, u, (0, 0.002), dt=0.001).u)], rounds=10)
    """, tmp_path)


def test_threads_choose_their_numbers_of_threads(tmp_path):
    """A loop allocates scratch memory for its number of threads. Another thread of Python must not change this number."""
    run("""
        problem = bgk(cells=400, velocities=(8, 48))
        at_once([lambda u=u, n=n: apsis.integrate(problem, u, (0, 0.002), dt=0.001, threads=n).u
                 for n, u in zip((1, 3, 2, 4), states(problem, 4))], rounds=10)
    """, tmp_path)


def test_a_function_of_the_user_calls_its_own_problem(tmp_path):
    """The temperature of a wall calls the problem to which the wall belongs, on the threads of a step and in a new thread."""
    assert run("""
        depth = threading.local()
        def wall(t, x):
            if getattr(depth, "inside", False):
                return 1.1
            depth.inside = True
            try:
                again = problem.transport(u)
                other = []
                thread = threading.Thread(target=lambda: other.append(deep()))
                thread.start()
                thread.join()
                assert np.array_equal(other[0], again)
            finally:
                depth.inside = False
            return 1.1
        def deep():
            depth.inside = True
            return problem.transport(u)
        problem = bgk(cells=200, velocities=(8, 100), boundary={"kind": "diffuse", "T": wall}, positivity=True)
        u = problem.state(rho=1, T=1)
        plain = bgk(cells=200, velocities=(8, 100), boundary={"kind": "diffuse", "T": 1.1}, positivity=True)
        for n in (1, 3):
            found = apsis.integrate(problem, u, (0, 0.002), dt=0.001, threads=n)
            assert np.array_equal(found.u, apsis.integrate(plain, u, (0, 0.002), dt=0.001, threads=1).u)
        print("recursive")
    """, tmp_path) == "recursive\n"


def test_runs_in_threads_with_results(tmp_path):
    """Runs in threads can write results, although some builds of HDF5 are not safe for threads."""
    run("""
        def one(k, n):
            r = apsis.run("paper/bgk-mixed", "space.cells=24", "velocity.points=20", "time.end=0.02", "output.every=0.005",
                          out=f"o{k}", threads=n)
            return r.f
        at_once([lambda k=k, n=n: one(k, n) for k, n in enumerate((1, 3, 2, 1))], rounds=6)
    """, tmp_path)


def test_a_progress_function_runs_another_case(tmp_path):
    run("""
        seen = []
        def progress(*_):
            seen.append(apsis.run("paper/ode", threads=3).f)
        def outer(**more):
            return apsis.run("paper/bgk-mixed", "space.cells=300", "velocity.points=60", "time.end=0.02", threads=2, **more).f
        assert np.array_equal(outer(progress=progress), outer())
        assert seen and all(np.array_equal(one, seen[0]) for one in seen)
    """, tmp_path)


def test_threads_share_methods_and_functions(tmp_path):
    run("""
        method = apsis.method("md-imex-6-3")
        relaxation = apsis.RelaxationProblem(lambda t, u: -u, lambda u: u[:1], lambda w: np.array([w[0], w[0]]), lambda w: 1.0, 1e-2)
        at_once([lambda: apsis.integrate(relaxation, [1.0, 2.0], (0, 1), method, dt=0.05).u,
                 lambda: np.array(apsis.method("md-imex-chain-7-2").certificate.order_residual),
                 lambda: method.A_hat, lambda: np.array([method.certificate.ssp_coefficient])], rounds=10)
    """, tmp_path)
