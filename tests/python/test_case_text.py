"""Cases given as mappings: values of Python and NumPy, and messages that name the keys of the mapping."""
import copy
import pathlib
import re
import tomllib
from decimal import Decimal
from fractions import Fraction

import apsis
import numpy as np
import pytest
from apsis.case_text import CaseText, to_toml

CASE = {"title": "ε and \"quotes\"", "model": {"name": "bgk", "epsilon": 0.1}, "space": {"cells": 20, "domain": [0, 2]},
        "velocity": {"max": 8, "points": 16}, "time": {"end": 0.001, "method": "md-imex-3-2", "dt": 0.00025}}


def changed(*keys, value):
    case = copy.deepcopy(CASE)
    table = case
    for key in keys[:-1]:
        table = table.setdefault(key, {})
    table[keys[-1]] = value
    return case


@pytest.mark.parametrize("keys, value", [
    (("space", "cells"), np.array(20)), (("space", "cells"), np.uint8(20)), (("space", "domain"), np.array([0.0, 2.0])),
    (("space", "domain"), (np.float32(0), np.int64(2))), (("space", "domain"), range(0, 3, 2)), (("time", "end"), Fraction(1, 1000)),
    (("model", "epsilon"), Decimal("0.1")), (("model", "name"), np.str_("bgk")), (("model",), {"name": "bgk", "epsilon": np.float64(0.1)})])
def test_values_of_numpy_and_python_are_those_of_a_case(keys, value):
    assert np.array_equal(apsis.run(changed(*keys, value=value)).f, apsis.run(CASE).f)


def test_a_path_in_a_case_is_its_text(tmp_path):
    (tmp_path / "data.csv").write_text("x,rho,u,T\n" + "".join(f"{0.05 + 0.1 * k},{1 + k},0,1\n" for k in range(20)), encoding="utf-8")
    found = apsis.run(changed("initial", "file", value=tmp_path / "data.csv") | {"output": {"every": 0.001}})
    np.testing.assert_allclose(found.fields["rho"][0], 1 + np.arange(20), rtol=1e-6)  # up to the tails outside of the velocity grid


def heated(x):
    return x


@pytest.mark.parametrize("keys, value, message", [
    (("model", "epsilon"), heated, 'case["model"]["epsilon"] is a function, \'heated\' (a case has numbers, text, lists and dicts); write a formula'),
    (("initial",), heated, 'case["initial"] is a function, \'heated\''),
    (("initial", "rho"), heated, "give functions in the argument initial of apsis.run"),
    (("space",), None, 'case["space"] is None (a case has numbers, text, lists and dicts); leave the key out for its default'),
    (("space", "cells"), {20}, 'case["space"]["cells"] is a set'),
    (("space", "domain"), [0, 2j], 'case["space"]["domain"][1] is a complex'),
    (("space", "domain"), np.array([0, 2j]), 'case["space"]["domain"] is an array of type complex128'),
    (("model", "name"), b"bgk", 'case["model"]["name"] is a bytes'),
    (("title",), "\udc80", 'case["title"] is text that UTF-8 cannot encode'),
    (("space", 5), 3, 'case["space"] has the key 5, an int (keys of a case are text); give a name'),
    # The compiled part refuses the following.
    (("space", "cells"), 4.5, 'case["space"]["cells"]: \'space.cells\' is the number 4.5 (an integer is needed)'),
    (("space", "cels"), 4, 'case["space"]["cels"]: unknown key \'space.cels\''),
    (("space", "a b"), 4, 'case["space"]["a b"]: unknown key'),
    (("space",), 3, 'case["space"]: \'space\' is the integer 3 (it is a table); give a dict'),
    (("walls",), {}, 'case["walls"]: unknown table [walls]'),
    (("output", "probe"), 3, "(it is a list of tables); give a list of dicts"),
    (("output", "probe"), [{"name": "äöü", "from": 0, "to": 2, "ponts": 3}], 'case["output"]["probe"][0]["ponts"]: unknown key'),
    (("boundary", "left"), {"kind": "diffuse", "T": -1}, 'case["boundary"]["left"]["T"]: '),
    (("initial",), {"rho": 1, "T": 1, "region": [{"where": "x < 1", "rho": 2}, {"where": "x << 1", "rho": 2}]},
     'case["initial"]["region"][1]["where"]: expression \'x << 1\''),
    (("model",), {}, 'case["model"]: key \'model.name\' is missing')])
def test_messages_name_the_keys_of_a_mapping(keys, value, message):
    with pytest.raises(apsis.InputError, match=re.escape(message)) as raised:
        apsis.run(changed(*keys, value=value))
    assert not re.search(r"case:\d", str(raised.value))


def test_an_empty_case_lacks_a_model():
    for case in ({}, {"title": "nothing", "space": {"cells": 20}}):
        with pytest.raises(apsis.InputError, match="^case: key 'model.name' is missing"):
            apsis.run(case)


def test_messages_about_files_and_overrides_have_their_places(tmp_path):
    (tmp_path / "one.toml").write_text(to_toml(changed("space", "cells", value=4.5)), encoding="utf-8")
    with pytest.raises(apsis.InputError, match=r"one\.toml:\d+:1: 'space.cells' is the number 4.5"):
        apsis.run(tmp_path / "one.toml")
    with pytest.raises(apsis.InputError, match="^override 'space.cels=4': unknown key"):
        apsis.run(CASE, "space.cels=4")


def test_the_text_has_the_values_of_the_mapping():
    case = {"title": "a\x7f\n\"ü\"\\", "a": {"b c": [1, [2.5, {"d": True}]], "e": {"f.g": pathlib.PurePosixPath("x/y")}, "h": np.array([[1, 2], [3, 4]]),
                                            "large": 10**30}, "last": float("inf")}
    assert tomllib.loads(to_toml(case)) == {
        "title": "a\x7f\n\"ü\"\\", "a": {"b c": [1, [2.5, {"d": True}]], "e": {"f": {"g": "x/y"}}, "h": [[1, 2], [3, 4]], "large": 1e30},
        "last": float("inf")}


def test_every_place_of_the_text_has_the_key_that_is_written_there():
    text = CaseText(CASE)
    lines = text.text.splitlines()
    for number, line in enumerate(lines, 1):
        for key in ("title", "name", "cells", "points", "method"):
            if line.startswith(key):
                assert text.with_keys(f"case:{number}:{len(line)}: wrong").endswith(f'["{key}"]: wrong')
    assert text.with_keys("process 1: case:1:1: wrong") == "process 1: case: wrong"
    assert text.with_keys("time.dt = 1e-3 does not divide time.end") == "time.dt = 1e-3 does not divide time.end"
