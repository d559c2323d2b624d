"""Fluxes from the gas to its walls are columns in Python and in files, and have pictures."""
import apsis
import numpy as np
import pytest
from apsis.plot import read_result
from apsis.plot.results import figures
from apsis.plot.style import PictureError

PLANE = {
    "model": {"name": "bgk", "epsilon": 0.2, "degrees_of_freedom": 3},
    "initial": {"rho": 1, "T": 1},
    "space": {"cells": [8, 6], "domain": [[0, 2], [0, 1.5]], "boundary": "diffuse", "reconstruction": "upwind1",
              "solid": [{"name": "box", "from": [0.5, 0], "to": [1, 0.5], "T": 0.9}, {"name": "beam", "from": [1.5, 0.5], "to": [1.75, 1]}]},
    "boundary": {"top": {"velocity": [0.2, 0]}, "left": {"T": 1.2}},
    "velocity": {"max": 6.5, "points": 8},
    "time": {"method": "md-imex-3-2", "end": 0.1, "safety": 1},
    "output": {"surfaces": ["left", "top", "box", "beam"]},
}
SPACE = {**PLANE, "space": {"cells": [4, 5, 3], "domain": [[0, 1], [0, 1], [0, 1.5]], "boundary": "diffuse", "reconstruction": "upwind1",
                            "solid": [{"name": "box", "from": [0.25, 0.2, 0], "to": [0.75, 0.6, 0.5], "T": 0.9}]},
         "boundary": {"back": {"velocity": [0.2, 0, 0]}}, "output": {"surfaces": ["bottom", "box"]},
         "time": {"method": "md-imex-3-2", "end": 0.02, "safety": 1}}


@pytest.fixture(scope="module", params=[PLANE, SPACE], ids=["plane", "space"])
def computed(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp("run")
    return request.param, folder, apsis.run(request.param, out=folder)


def test_surfaces_are_those_of_the_case_and_add_up_to_the_history(computed):
    case, _, result = computed
    assert list(result.surfaces) == [name for name in ("left", "bottom", "top", "box", "beam") if name in case["output"]["surfaces"]]
    for name, columns in result.surfaces.items():
        for invariant in ("mass", "momentum_x", "momentum_y", "energy"):
            given = (columns["area"] * columns[invariant]).sum()
            # The bound is for rounding errors of a sum of about ten terms of the size of the pressure.
            assert abs(given + result.history[f"flux_{name}_{invariant}"][-1]) < 1e-14
        # Half of the molecules at a wall come from it, and walls have T from 0.9 to 1.2.
        assert np.all(np.abs(columns["T"] - 1) < 0.5) and np.all(np.abs(columns["rho"] - 1) < 0.5) and "u_y" in columns


def test_a_stored_result_has_the_same_surfaces(computed):
    _, folder, result = computed
    stored = apsis.open(folder)
    assert stored == result
    assert stored.surfaces["box"]["face"].dtype.kind == "U"
    changed = apsis.open(folder)
    changed.surfaces["box"]["face"][0] = "front"
    assert changed != result


def test_profiles_are_those_of_the_table_without_lines_across_corners_and_gaps(computed):
    case, folder, result = computed
    made = figures(read_result(folder))
    names = [f"surface-{name}" for name in result.surfaces]
    assert sorted(name for name in made if name.startswith("surface-")) == sorted(names)
    if case is SPACE:
        return
    figure = made["surface-box"]
    assert [axes.get_ylabel() for axes in figure.axes] == [f"{name} (dimensionless)" for name in ("pressure", "shear stress", "heat flux")]
    box = result.surfaces["box"]
    lines = [line for line in figure.axes[0].lines if line.get_color() == "#0072B2"]
    # The box stands on the floor, so only right, top and left are lines, each of two cells.
    assert list(box["face"]) == ["right"] * 2 + ["top"] * 2 + ["left"] * 2
    assert [len(line.get_xdata()) for line in lines] == [2, 2, 2]
    np.testing.assert_array_equal(np.concatenate([line.get_xdata() for line in lines]), box["s"])
    np.testing.assert_array_equal(np.concatenate([line.get_ydata() for line in lines]), box["pressure"])
    assert {text.get_text() for text in figure.axes[0].texts} == {"right", "top", "left"}
    assert result.plot("surface-top") is not None


def test_faces_in_space_are_maps_with_the_covered_part_blank(computed):
    case, folder, result = computed
    if case is PLANE:
        return
    made = figures(read_result(folder))
    bottom = result.surfaces["bottom"]
    assert list(bottom)[:8] == ["face", "x", "y", "z", "n_x", "n_y", "n_z", "area"]
    panel = made["surface-bottom"].axes[0]
    assert (panel.get_xlabel(), panel.get_ylabel()) == ("x (dimensionless)", "z (dimensionless)")
    shown = panel.collections[0].get_array().filled(np.nan).reshape(3, 4)
    # The bottom is not covered: every cell has its pressure, found here by coordinates.
    for x, z, p in zip(bottom["x"], bottom["z"], bottom["pressure"]):
        assert shown[round(z / 0.5 - 0.5), round(x / 0.25 - 0.5)] == p
    # The box stands on the back, so all its other faces are drawn. The front has 2 x 2 cells.
    titles = [axes.get_title() for axes in made["surface-box"].axes if axes.get_title()]
    assert titles[:5] == ["left", "right", "bottom", "top", "front"]
    front = result.surfaces["box"]["face"] == "front"
    assert front.sum() == 4 and np.all(result.surfaces["box"]["z"][front] == 0.5)


def test_a_run_without_steps_has_places_and_no_picture(tmp_path):
    result = apsis.run(PLANE, "time.end=0", out=tmp_path)
    assert np.isnan(result.surfaces["top"]["pressure"]).all() and np.isfinite(result.surfaces["top"]["x"]).all()
    assert apsis.open(tmp_path) == result
    assert not any(name.startswith("surface-") for name in figures(read_result(tmp_path)))


def test_a_damaged_table_is_refused(tmp_path):
    apsis.run(PLANE, "time.end=0.01", out=tmp_path)
    (tmp_path / "surfaces" / "top.csv").write_text("face,s\ntop,x\n")
    with pytest.raises(PictureError, match="is not the table of a surface"):
        read_result(tmp_path)
