"""Local problems whose functions get many cells in one call."""
import apsis
import numpy as np
import pytest

CELLS = 300  # more than are solved side by side


def advected_pairs(**settings):
    """Two advected species react as u₁ ⇌ u₂². The functions work for one cell and for many."""
    def pairs(u):
        return 1e3 * (u[..., 0] ** 2 - u[..., 1])

    def collision(u):
        return np.stack([-2 * pairs(u), pairs(u)], axis=-1)

    def jacobian(u):
        zero = 0 * u[..., 0]
        rows = [[-4e3 * u[..., 0], 2e3 + zero], [2e3 * u[..., 0], zero - 1e3]]
        return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)

    def transport(t, u):
        return (np.roll(u, 1, axis=0) - u) * CELLS

    given = {name: dict(collision=collision, jacobian=jacobian)[name] for name in settings.pop("functions", ("collision",))}
    return apsis.GeneralProblem(transport=transport, forward_euler_step=lambda t, u: 1 / CELLS, local=True, **{**given, **settings})


def start():
    x = (np.arange(CELLS) + 0.5) / CELLS
    return np.stack([1 + 0.5 * np.sin(2 * np.pi * x), np.ones(CELLS)], axis=-1)


@pytest.mark.parametrize("method, admissible", [("md-imex-8-3-mixed", lambda u: (u >= 0).all(axis=-1)), ("ark-436", None)])
def test_cells_side_by_side_have_the_bits_of_cells_alone(method, admissible):
    of_one = admissible and (lambda u: bool(admissible(u)))
    alone = apsis.integrate(advected_pairs(admissible=of_one), start(), (0, 1 / CELLS), method, dt=1 / CELLS)
    together = apsis.integrate(advected_pairs(admissible=admissible, vectorized=True), start(), (0, 1 / CELLS), method, dt=1 / CELLS)
    assert together.derivatives == "complex steps"
    np.testing.assert_array_equal(together.u, alone.u)


def test_a_given_jacobian_serves_all_cells():
    times = (0, 3 / CELLS)
    exact = apsis.integrate(advected_pairs(vectorized=True), start(), times, "md-imex-8-3-mixed")
    found = apsis.integrate(advected_pairs(vectorized=True, functions=("collision", "jacobian")), start(), times, "md-imex-8-3-mixed")
    assert found.derivatives == "jacobian"
    np.testing.assert_allclose(found.u, exact.u, rtol=1e-13)  # both derivatives are exact up to rounding


def test_differences_are_those_of_every_cell():
    """Cells of sizes from 1e-8 to 1e8: a step of a difference that suits one of them does not suit the others."""
    def real_only(u):
        return -np.abs(u) * u - u

    size = 10.0 ** np.linspace(-8, 8, 17)
    u0 = np.stack([size, 0.3 * size], axis=-1)
    together = apsis.integrate(apsis.GeneralProblem(real_only, local=True, vectorized=True), u0, (0, 1e-2), "imdrk-9-5", dt=1e-2)
    alone = apsis.integrate(apsis.GeneralProblem(real_only, local=True), u0, (0, 1e-2), "imdrk-9-5", dt=1e-2)
    assert together.derivatives == "finite differences"
    np.testing.assert_array_equal(together.u, alone.u)
    # The exact solution of u' = −u|u| − u
    decay = np.exp(-1e-2)
    np.testing.assert_allclose(together.u[-1][:9], (u0 * decay / (1 + u0 * (1 - decay)))[:9], rtol=1e-9)


def test_parameters_are_those_of_each_cell():
    """Relaxation with ε between 1e-9 and 1 on a plane of cells; each cell is also integrated alone."""
    epsilon = 10.0 ** np.linspace(-9, 0, 12).reshape(3, 4)
    u0 = np.stack([1 + epsilon, 0 * epsilon], axis=-1)

    def together(u, eps):
        assert u.shape == (len(eps), 2) and eps.ndim == 1
        return np.stack([u[:, 1] ** 2 - u[:, 0], u[:, 0] - u[:, 1] ** 2], axis=-1) / eps[:, None]

    def inside(u, eps):
        return (u[:, 0] + u[:, 1] < 1 + 2 * eps) | (eps < 2)

    problem = apsis.GeneralProblem(together, admissible=inside, local=True, vectorized=True, parameters=epsilon)
    found = apsis.integrate(problem, u0, (0, 0.5), "imdrk-9-5", dt=0.125)
    for i, j in np.ndindex(epsilon.shape):
        one = apsis.GeneralProblem(lambda u: np.array([u[1] ** 2 - u[0], u[0] - u[1] ** 2]) / epsilon[i, j])
        alone = apsis.integrate(one, u0[i, j], (0, 0.5), "imdrk-9-5", dt=0.125)
        # The functions of one cell and of several round differently, and stages solve to a few roundings.
        np.testing.assert_allclose(found.u[:, i, j], alone.u, rtol=1e-12, atol=1e-15)


def test_the_number_of_calls_does_not_depend_on_the_number_of_cells():
    def count(cells):
        calls = 0

        def collision(u):
            nonlocal calls
            calls += 1
            return np.stack([-u[:, 0] ** 2, u[:, 0] ** 2], axis=-1)

        u0 = np.stack([np.linspace(1, 2, cells), np.zeros(cells)], axis=-1)
        apsis.integrate(apsis.GeneralProblem(collision, local=True, vectorized=True), u0, (0, 1), "imdrk-9-5", dt=0.5)
        return calls

    # All cells need at most one iteration more than any of them.
    assert count(200) <= 1.5 * count(4)


def test_the_first_cell_that_fails_is_named():
    u0 = start() - np.where(np.arange(CELLS) >= 281, 9.0, 0.0)[:, None]
    problem = advected_pairs(admissible=lambda u: (u >= 0).all(axis=-1), vectorized=True)
    with pytest.raises(apsis.NumericalError, match="not admissible|no admissible root") as failed:
        apsis.integrate(problem, u0, (0, 0.1), "md-imex-8-3-mixed")
    assert failed.value.cell == 281


@pytest.mark.parametrize("name", ["collision", "jacobian", "admissible"])
def test_exceptions_end_all_solves(name):
    """An exception leaves from the middle of suspended solves, and the next integration is not affected."""
    class Mine(Exception):
        pass

    calls = 0
    functions = {"collision": lambda u: -u ** 3, "jacobian": lambda u: -3 * u[:, :, None] ** 2, "admissible": lambda u: u[:, 0] >= 0}

    def failing(u):
        nonlocal calls
        calls += 1
        if calls > 5:
            raise Mine("mine")
        return functions[name](u)

    u0 = np.linspace(1, 2, 40)[:, None]
    with pytest.raises(Mine):
        apsis.integrate(apsis.GeneralProblem(**{**functions, name: failing}, local=True, vectorized=True), u0, (0, 9), "md-imex-6-3", dt=1)
    found = apsis.integrate(apsis.GeneralProblem(**functions, local=True, vectorized=True), u0, (0, 1), "imdrk-9-5", dt=0.01)
    np.testing.assert_allclose(found.u[-1], u0 / np.sqrt(1 + 2 * u0 ** 2), rtol=1e-9)  # exact; the error of order 5 is below 1e-10


def test_large_cells_are_solved_one_by_one():
    n = 201
    seen = set()

    def collision(u):
        seen.add(len(u))
        return -u ** 2

    u0 = np.ones((3, n)) * np.array([[1.0], [2.0], [3.0]])
    with pytest.warns(apsis.CostWarning):
        found = apsis.integrate(apsis.GeneralProblem(collision, jacobian=lambda u: -2 * u[:, :, None] * np.eye(n), local=True, vectorized=True),
                                u0, (0, 1), "imdrk-1-2", dt=1)
    assert seen <= {1, 3}  # all cells only where Q is evaluated without a solve
    # One step of order 2 and length 1: the root of v = u − v² + v³, given by the stage's own equation.
    v = found.u[-1]
    np.testing.assert_allclose(v + v ** 2 + v ** 3, u0, rtol=1e-13)


def test_robertson_with_other_rates_in_every_cell():
    """Errors of a step control are those of the cell with the largest; conserved sums stay."""
    rates = np.linspace(0.02, 0.08, 20)
    scales = np.array([1.0, 1e-4, 1.0])

    def collision(y, k):
        y = y * scales
        first, third = -k * y[:, 0] + 1e4 * y[:, 1] * y[:, 2], 3e7 * y[:, 1] ** 2
        return np.stack([first, -first - third, third], axis=-1) / scales

    u0 = np.tile([1.0, 0.0, 0.0], (20, 1))
    problem = apsis.GeneralProblem(collision, local=True, vectorized=True, parameters=rates)
    found = apsis.integrate(problem, u0, (0, 40), "imdrk-9-5", tolerance=1e-5)
    np.testing.assert_allclose((found.u[-1] * scales).sum(axis=1), 1.0, rtol=0, atol=1e-12)
    for cell in (0, 19):
        alone = apsis.integrate(apsis.GeneralProblem(lambda y: collision(y[None], rates[cell:cell + 1])[0]), u0[cell], (0, 40), "imdrk-9-5",
                                tolerance=1e-5)
        np.testing.assert_allclose(found.u[-1, cell], alone.u[-1], rtol=0, atol=1e-3)  # tolerances of a step add up


@pytest.mark.parametrize("settings, message", [
    (dict(vectorized=True), "vectorized = True has no meaning without local = True"),
    (dict(local=True, parameters=[1.0]), "parameters have no meaning without vectorized = True"),
    (dict(local=True, vectorized=True, parameters=[1.0]), r"first axes must be those of the cells, \(3,\)"),
    (dict(local=True, vectorized=True, parameters=["x"] * 3), "parameters is an array of type"),
    (dict(local=True, vectorized=True, collision=lambda u: u[0]), r"collision returned an array of shape \(2,\)"),
    (dict(local=True, vectorized=True, collision=lambda u: None), "collision returned None"),
    (dict(local=True, vectorized=True, jacobian=lambda u: np.eye(2)), r"shape \(3, 2, 2\) are needed, a matrix for each cell"),
    (dict(local=True, vectorized=True, admissible=lambda u: True), "True or False is needed for each cell"),
    (dict(local=True, vectorized=True, admissible=lambda u: u[:, 0]), "True or False is needed for each cell"),
])
def test_unfit_settings_and_results_are_named(settings, message):
    problem = apsis.GeneralProblem(**{"collision": lambda u: -u, **settings})
    with pytest.raises(apsis.InputError, match=message):
        apsis.integrate(problem, np.ones((3, 2)), (0, 1), "imdrk-9-5", dt=0.5)
