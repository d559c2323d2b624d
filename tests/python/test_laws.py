"""Conservation laws of the user, in cases that are mappings and in problems without a case."""
import apsis
import numpy as np
import pytest

WATER = {"parameters": {"g": 1.0},
         "model": {"name": "conservation-law", "variables": ["h", "q"], "flux": ["q", "q^2/h + g*h^2/2"], "odd": ["q"], "epsilon": 0},
         "initial": {"h": "1 + 0.1*exp(-10*x^2)", "q": 0},
         "space": {"cells": 60, "domain": [-2.0, 2.0], "formulation": "finite-difference", "boundary": "symmetry"},
         "time": {"method": "md-imex-6-3", "end": 1.0, "cfl": 0.5}}


def test_a_law_is_run_from_a_mapping_with_overrides():
    result = apsis.run(WATER)
    h, q = result.fields["h"][-1], result.fields["q"][-1]
    np.testing.assert_allclose(h.mean(), result.fields["h"][0].mean(), rtol=1e-13)  # no water flows through walls
    # The hump splits into two with speeds of about √(gh). They are mirror images up to rounding errors, which nonlinear weights amplify.
    np.testing.assert_allclose(h, h[::-1], atol=1e-10)
    np.testing.assert_allclose(q, -q[::-1], atol=1e-10)
    assert abs(abs(result.x[np.argmax(h)]) - 1.0) < 0.1
    lists = apsis.run(WATER, 'model.flux=["q", "q^2/h + h^2/2"]', "model.speed=auto")
    np.testing.assert_array_equal(lists.f, result.f)  # g = 1
    assert result.v[0] == -result.v[1] == pytest.approx(2.0 * np.sqrt(1.1), rel=1e-3)


def test_errors_of_a_law_have_their_key_and_state():
    for change, error, says in [
            ('model.flux=["q", "q^2/H"]', apsis.InputError, "unknown name 'H'"),
            ('model.flux=["q"]', apsis.InputError, "model.flux has 1 formula"),
            ('model.variables=["h", "g"]', apsis.InputError, "a parameter of the case has this name"),
            ("model.speed=1", apsis.InputError, "model.speed = 1 is too small"),
            ("model.speed=0", apsis.InputError, "it must be from")]:
        with pytest.raises(error, match=change.split("=")[0]) as caught:
            apsis.run(WATER, change)
        assert says in str(caught.value)
    # The two halves of a high hump reach the walls, where the water is too fast for this speed.
    with pytest.raises(apsis.NumericalError, match="broken promise: model.speed = 1.8 is too small"):
        apsis.run(WATER, "initial.h=1 + 2*exp(-10*x^2)", "model.speed=1.8")


def test_a_problem_without_a_case_has_laws_and_walls():
    problem = apsis.KineticProblem("conservation-law", cells=60, domain=(-2, 2), epsilon=0.0, formulation="finite-difference",
                                   boundary="symmetry", parameters={"variables": ["h", "q"], "flux": ("q", "q^2/h + h^2/2"),
                                                                    "odd": ["q"], "speed": 2.1})
    u = problem.sample(lambda x: np.ravel(np.outer([1 + 0.1 * np.exp(-10 * x * x), 0.0], [0.5, 0.5])))
    same = apsis.run(WATER, "model.speed=2.1", "time.dt=0.01")
    end = apsis.integrate(problem, problem.solve_collision(u, 1.0), (0, 1), "md-imex-6-3", dt=0.01).u[-1]
    np.testing.assert_allclose(problem.fields(end)["h"], same.fields["h"][-1], atol=1e-10)
    for wrong, says in [({"flux": ["q"]}, "model.flux has 1 formula"), ({"variables": ["x", "q"]}, "it is a coordinate or time"),
                        ({"fluxes": ["q", "q"]}, "unknown list 'fluxes'"), ({"odd": []}, "boundary 'symmetry' cannot be used")]:
        parameters = {"variables": ["h", "q"], "flux": ["q", "q^2/h + h^2/2"], "odd": ["q"], **wrong}
        with pytest.raises(apsis.InputError, match=says):
            apsis.KineticProblem("conservation-law", cells=60, domain=(-2, 2), boundary="symmetry", parameters=parameters)
