"""Methods, certificates and tableaux as Python objects."""
import pickle
import re
from fractions import Fraction

import apsis
import numpy as np
import pytest


@pytest.mark.parametrize("name", apsis.methods())
def test_arrays_fractions_and_certificate_agree(name):
    m = apsis.method(name)
    s = m.stages
    assert m.P.shape == m.W.shape == m.D.shape == m.A_hat.shape == (s, s)
    # Â = R⁻¹W/r, A = R⁻¹D with R = I − P − W. Coefficients are of size 1 to 10; s terms.
    R = np.eye(s) - m.P - m.W
    np.testing.assert_allclose(R @ m.A_hat, m.W / m.r, atol=1e-12)
    if m.kind != "exponential":
        assert m.A.shape == m.A_dot.shape == (s, s)
        np.testing.assert_allclose(R @ m.A, m.D, atol=1e-12)
    exact = m.exact
    # Convex weights in double precision are rounded to multiples of about 2^-53.
    np.testing.assert_allclose([[float(x) for x in row] for row in exact["W"]], m.W, atol=1e-15)
    c = m.certificate
    assert c.claims_hold and c.failures == []
    assert c.order >= 1 and c.order_residual < 1e-9


def test_the_certificate_is_that_of_the_paper():
    c = apsis.method("md-imex-6-3").certificate
    assert (c.order, c.type, c.gsa, c.ap) == (3, "A", True, True)
    assert c.ssp_coefficient == pytest.approx(0.904402174130635, rel=1e-14)
    assert apsis.method("imdrk-5-4").certificate.ssp_coefficient is None
    assert apsis.method("md-imex-chain-7-2").certificate.ssp_coefficient == 5.0


def test_conditions_of_a_tableau_are_exact():
    # The trapezoidal rule has two stages and order 2, not 3.
    trapezoidal = [[0, 0], [Fraction(1, 2), Fraction(1, 2)]]
    conditions = apsis.order_conditions(trapezoidal, order=3)
    assert [one.residual for one in conditions if one.order <= 2] == [0.0, 0.0]
    # Both conditions of order 3 are violated: Σ b c² is 1/2 instead of 1/3, and Σ b A c is 1/4 instead of 1/6.
    assert sorted(one.residual for one in conditions if one.order == 3) == [float(Fraction(1, 12)), float(Fraction(1, 6))]
    third = apsis.order_conditions([["1/3"]], order=1)
    assert third[0].residual == float(Fraction(1, 3) - 1)
    assert {one.tree for one in conditions} == {"G", "G[G]", "G[G,G]", "G[G[G]]"}


@pytest.mark.parametrize("name", ["imdrk-5-4", "md-imex-3-2", "md-imex-6-3", "md-imex-14-4-accurate", "ssprk-5-4"])
def test_methods_of_the_catalogue_satisfy_the_conditions_from_their_arrays(name):
    m = apsis.method(name)
    order = m.certificate.order
    tableau = dict(A=m.A.tolist(), A_dot=m.A_dot.tolist(), A_hat=None if m.kind.startswith("implicit") else m.A_hat.tolist())
    conditions = apsis.order_conditions(**tableau, order=order + 1)
    # Conditions have products of up to five coefficients of size up to 10, in double precision.
    assert max(abs(one.residual) for one in conditions if one.order <= order) < 1e-10
    assert max(abs(one.residual) for one in conditions if one.order == order + 1) > 1e-6


@pytest.mark.parametrize("bad, message", [
    (dict(A=[[1, 2]], order=1), "not square"), (dict(A=[["x"]], order=1), "'x' in A is not a coefficient"),
    (dict(A=[], order=1), "no stages"), (dict(A=[[1]], order=0), "from 1 to 8"),
    (dict(A=[[1]], A_hat=[[1], [2]], order=1), "another number of rows"), (dict(A=[[float("nan")]], order=1), "not a coefficient")])
def test_bad_tableaux_have_a_message(bad, message):
    with pytest.raises(apsis.InputError, match=message):
        apsis.order_conditions(**bad)


def test_wrong_names_get_a_suggestion():
    with pytest.raises(apsis.InputError, match="md-imex-6-3"):
        apsis.method("md-imex-6-4")
    with pytest.raises(ValueError):
        apsis.method("nothing of the kind")


def test_a_file_with_a_false_claim_is_refused_and_can_be_inspected(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text('name = "mine-1"\ntitle = "backward Euler"\nkind = "implicit"\ncitation = "none"\n'
                    '[claims]\norder = 2\n[shu_osher]\nP = [[]]\nd = ["1"]\nddot = ["0"]\n', encoding="utf-8")
    with pytest.raises(apsis.ClaimError, match="order"):
        apsis.method(str(file))
    c = apsis.read_method(file).certificate
    assert c.order == 1 and not c.claims_hold and c.failures
    with pytest.raises(apsis.FileError):
        apsis.read_method(tmp_path / "none.toml")


def test_a_file_that_changed_is_read_and_certified_again(tmp_path):
    file = tmp_path / "mine.toml"
    text = ('name = "mine-1"\ntitle = "backward Euler"\nkind = "implicit"\ncitation = "none"\n'
            '[claims]\norder = 1\n[shu_osher]\nP = [[]]\nd = ["1"]\nddot = ["0"]\n')
    file.write_text(text, encoding="utf-8")
    first = apsis.method(str(file))
    assert first.certificate.order == 1
    # With this coefficient, the method is the implicit Taylor method of order 2.
    file.write_text(text.replace("order = 1", "order = 2").replace('ddot = ["0"]', 'ddot = ["-1/2"]'), encoding="utf-8")
    second = apsis.method(str(file))
    assert second.certificate.order == 2 and second != first
    assert first.ddot[0] == 0 and second.ddot[0] == -0.5
    file.write_text(text.replace('d = ["1"]', 'd = ["2"]'), encoding="utf-8")
    with pytest.raises(apsis.ClaimError, match="tree G is 2 instead of 1"):
        apsis.method(str(file))


def test_methods_and_certificates_are_values(tmp_path):
    one, again = apsis.method("md-imex-6-3"), apsis.method("md-imex-6-3")
    assert one == again and hash(one) == hash(again) and one != apsis.method("md-imex-3-2") and one != "md-imex-6-3"
    for value in (one, apsis.method("ars-222"), apsis.method("md-imex-chain-7-2"), one.certificate):
        copy = pickle.loads(pickle.dumps(value))
        assert copy == value and repr(copy) == repr(value)
    assert np.array_equal(pickle.loads(pickle.dumps(one)).W, one.W)
    # A method, even one with false claims, can be used after its file was removed.
    file = tmp_path / "mine.toml"
    file.write_text('name = "mine-1"\ntitle = "backward Euler"\nkind = "implicit"\ncitation = "none"\n'
                    '[claims]\norder = 2\n[shu_osher]\nP = [[]]\nd = ["1"]\nddot = ["0"]\n', encoding="utf-8")
    mine = apsis.read_method(file)
    file.unlink()
    assert pickle.loads(pickle.dumps(mine)) == mine


def test_representations_are_short_and_escaped():
    m = apsis.method("md-imex-6-3")
    assert repr(m).startswith("<apsis.Method md-imex-6-3: ") and "\n" not in repr(m)
    assert repr(m.certificate) == "<apsis.Certificate of md-imex-6-3: order 3, SSP coefficient 0.904402, type A>"
    assert "any step" in repr(apsis.method("imdrk-5-4").certificate)
    assert "<td>0.904402</td>" in m.certificate._repr_html_()
    # Text from the file is escaped: the only tags are those of the representation.
    assert set(re.findall(r"<(/?\w+)", m._repr_html_())) <= {f"{end}{tag}" for end in ("", "/") for tag in ("table", "tr", "th", "td")}


def test_exponential_methods_have_no_butcher_matrix_of_the_collision():
    m = apsis.method("exponential-2")
    assert m.kind == "exponential" and m.D.diagonal().tolist() == [1 / 3] * 4
    assert m.A_hat.shape == (4, 4)
    assert "4 exact collisions" in m.certificate._repr_html_()
    for name in ("A", "A_dot"):
        with pytest.raises(apsis.InputError, match=rf"method 'exponential-2' has no {name} \(its collisions are solved exactly\); use D"):
            getattr(m, name)


def test_the_certificate_has_linear_stability_limits():
    limits = apsis.method("md-imex-5-2").certificate.cfl_limits
    assert set(limits) == {"teno5", "upwind1", "upwind5", "weno5-js", "weno5-z", "weno5-z-smooth"}
    assert limits["upwind1"] == pytest.approx(2, rel=2e-3)  # the limit is r; the allowed growth adds 1e-3
    assert 0.5 < limits["weno5-z"] < 0.8
    assert apsis.method("ssprk-3-3").certificate.cfl_limits["weno5-js"] == pytest.approx(1.43, abs=0.01)
    assert apsis.method("imdrk-5-4").certificate.cfl_limits == {}


@pytest.mark.parametrize("method", ["md-imex-5-2", "md-imex-3-2", "md-imex-8-3-mixed"])
def test_steps_of_a_problem_without_limiter_are_linearly_stable(method):
    problem = apsis.KineticProblem("bgk", cells=40, domain=(0, 1), velocities=(8, 24), epsilon=1e6, reconstruction="upwind5",
                                   formulation="finite-difference")
    x = (np.arange(40) + 0.5) / 40
    v = problem.v.ravel()
    maxwellian = np.exp(-v**2 / 2) / np.sqrt(2 * np.pi)
    u0 = (1 + 0.1 * np.sin(2 * np.pi * x))[:, None] * maxwellian
    u = apsis.integrate(problem, u0, (0.0, 5.0), method).u[-1]
    # In a periodic domain, free flight keeps the 2-norm of the exact solution.
    assert np.linalg.norm(u) <= np.linalg.norm(u0) * 1.001
