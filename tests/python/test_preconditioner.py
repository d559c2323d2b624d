"""Krylov solves of stages with a preconditioner from Python, against sparse factorizations."""
import pickle

import numpy as np
import pytest

import apsis

scipy_sparse = pytest.importorskip("scipy.sparse")
scipy_linalg = pytest.importorskip("scipy.sparse.linalg")

POINTS = 120


def matrix_of(n=POINTS):
    """Heat on a line of unit length with fixed ends."""
    return scipy_sparse.diags([1.0, -2.0, 1.0], [-1, 0, 1], shape=(n, n), format="csc") * (n + 1.0)**2


def heat(t, y):
    return matrix_of(y.size) @ y - y**3


def elimination(t, y, gamma):
    return scipy_linalg.splu(scipy_sparse.identity(y.size, format="csc") - gamma * (matrix_of(y.size) - scipy_sparse.diags(3 * y**2)))


def start(n=POINTS):
    x = np.linspace(0, 1, n + 2)[1:-1]
    return np.sin(np.pi * x) + 0.3 * np.sin(40 * x)


FORMS = {
    "an object with solve": elimination,
    "a function": lambda t, y, gamma: elimination(t, y, gamma).solve,
    "an operator": lambda t, y, gamma: scipy_linalg.LinearOperator((y.size, y.size), elimination(t, y, gamma).solve),
    "a matrix": lambda t, y, gamma: np.linalg.inv(np.eye(y.size) - gamma * matrix_of(y.size).toarray()),
    "a sparse matrix": lambda t, y, gamma: scipy_sparse.csr_matrix(np.linalg.inv(np.eye(y.size) - gamma * matrix_of(y.size).toarray())),
}


@pytest.fixture(scope="module")
def factorized():
    return apsis.solve_ivp(None, heat, (0, 0.1), start(), jac=lambda t, y: matrix_of() - scipy_sparse.diags(3 * y**2), rtol=1e-6, atol=1e-9)


@pytest.mark.parametrize("form", FORMS)
def test_every_form_gives_the_solution_of_factorizations(form, factorized):
    found = apsis.solve_ivp(None, heat, (0, 0.1), start(), solver="krylov", preconditioner=FORMS[form], rtol=1e-6, atol=1e-9)
    assert found.success and found.method == factorized.method
    # Stages are solved to a thousandth of the tolerance.
    np.testing.assert_allclose(found.y[:, -1], factorized.y[:, -1], rtol=0, atol=1e-6)


def test_a_solver_is_prepared_once_for_a_step():
    prepared = []

    def counted(t, y, gamma):
        prepared.append((t, gamma))
        return elimination(t, y, gamma)

    found = apsis.solve_ivp(None, heat, (0, 0.1), start(), method="ark-548-2", solver="krylov", preconditioner=counted, rtol=1e-6, atol=1e-9)
    assert len(prepared) == found.steps + found.rejected  # all implicit stages have one γ
    assert found.nfev < 200 * found.steps  # without matrices of 120 columns, with their factors 100 times as many


def test_extra_arguments_and_masses_reach_it():
    mass = scipy_sparse.diags([1 / 6, 4 / 6, 1 / 6], [-1, 0, 1], shape=(POINTS, POINTS), format="csc")

    def collision(t, y, k):
        return k * (matrix_of() @ y)

    def with_mass(t, y, gamma, k):
        return scipy_linalg.splu((mass - gamma * k * matrix_of()).tocsc())

    options = dict(mass=mass, args=(2.0,), rtol=1e-6, atol=1e-9)
    found = apsis.solve_ivp(None, collision, (0, 0.05), start(), solver="krylov", preconditioner=with_mass, **options)
    expected = apsis.solve_ivp(None, collision, (0, 0.05), start(), jac=2.0 * matrix_of(), **options)
    np.testing.assert_allclose(found.y[:, -1], expected.y[:, -1], rtol=0, atol=1e-6)


@pytest.mark.parametrize("method", ["md-imex-3-2", "ark-548-2"])
def test_general_problems_have_it_too(method):
    u0 = start(60).reshape(6, 10)
    calls = []

    def shifted(u, gamma):
        calls.append(gamma)
        assert u.shape == u0.shape and not u.flags.writeable
        return elimination(0, u.ravel(), gamma)

    def collision(u):
        return heat(0, u.ravel()).reshape(u.shape)

    krylov = apsis.integrate(apsis.GeneralProblem(collision, solver="krylov", preconditioner=shifted), u0, [0, 0.05], method=method, dt=0.005)
    dense = apsis.integrate(apsis.GeneralProblem(collision), u0, [0, 0.05], method=method, dt=0.005)
    # Rounding errors of Q'Q, (Δt λ)² ≈ 5e3 times those of u, remain in both.
    np.testing.assert_allclose(krylov.u[-1], dense.u[-1], rtol=0, atol=1e-9)
    # Ten steps with one or two γ. The estimate of the loss in small terms solves with other ones before the first step.
    by_steps = [gamma for gamma in set(calls) if calls.count(gamma) == 10]
    assert len(by_steps) == {"md-imex-3-2": 2, "ark-548-2": 1}[method] and len(calls) - 10 * len(by_steps) <= 2


def test_dense_output_has_it_after_pickling():
    found = apsis.solve_ivp(None, heat, (0, 0.02), start(), solver="krylov", preconditioner=elimination, dense_output=True, rtol=1e-4, atol=1e-6)
    again = pickle.loads(pickle.dumps(found))
    np.testing.assert_array_equal(again.sol(0.0123), found.sol(0.0123))


@pytest.mark.parametrize("arguments, says", [
    (dict(preconditioner=elimination), "preconditioner has no meaning with solver='dense'"),
    (dict(preconditioner=3, solver="krylov"), "preconditioner is an int (it must be callable)"),
    (dict(preconditioner=lambda t, y, gamma: None, solver="krylov"), "preconditioner returned None (a solver is needed"),
    (dict(preconditioner=lambda t, y, gamma: lambda r: r[:3], solver="krylov"), "the solver of preconditioner returned"),
])
def test_what_cannot_be_used_is_refused(arguments, says):
    with pytest.raises(apsis.InputError) as refused:
        apsis.solve_ivp(None, heat, (0, 0.1), start(), **arguments)
    assert says in str(refused.value)


def test_cells_have_no_preconditioner():
    problem = apsis.GeneralProblem(lambda u: -u, local=True, solver="krylov", preconditioner=lambda u, gamma: lambda r: r)
    with pytest.raises(apsis.InputError, match="no meaning with local = True"):
        apsis.integrate(problem, np.ones((3, 2)), [0, 1], method="md-imex-3-2", dt=0.5)


def test_a_bad_solver_ends_the_integration_with_its_cause():
    found = apsis.solve_ivp(None, heat, (0, 0.1), start(), solver="krylov", preconditioner=lambda t, y, gamma: lambda r: np.full(r.shape, np.nan))
    assert found.status == -1 and "preconditioner returned a number that is not finite" in found.message
