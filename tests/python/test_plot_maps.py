"""Content of the pictures of runs in two and three dimensions, from results with known numbers."""
from dataclasses import replace
from types import SimpleNamespace

import apsis
import numpy as np
import pytest
from apsis.plot import __main__ as command
from apsis.plot import comparison_figure, fields_figure, history_figure, read_result
from apsis.plot.comparison import differences
from apsis.plot.maps import Plane, colours_of, draw_streamlines, frames, planes_of
from apsis.plot.probes import probe_comparisons, probe_figures
from apsis.plot.style import PictureError, plt

PLANE = """
title = "Gas around a box"
[model]
name = "bgk"
epsilon = 0.05
[initial]
rho = "1 + 0.3*x + 0.1*y"
u = ["-0.3*(y - 0.5)", "0.3*(x - 1)"]
T = 1
[space]
cells = [16, 8]
domain = [[0, 2], [0, 1]]
boundary = "symmetry"
[[space.solid]]
from = [1.5, 0]
to = [2, 0.25]
[[output.probe]]
name = "middle"
from = [0.1, 0.5]
to = [1.9, 0.5]
points = 7
[velocity]
max = 7
points = 14
[time]
method = "md-imex-3-2"
dt = 0.001
end = 0.002
[output]
every = 0.001
"""


@pytest.fixture(scope="module")
def plane(tmp_path_factory):
    folder = tmp_path_factory.mktemp("plane")
    (folder / "plane.toml").write_text(PLANE)
    apsis.run(str(folder / "plane.toml"), out=folder / "run")
    return folder / "run"


@pytest.fixture(scope="module")
def space(tmp_path_factory):
    folder = tmp_path_factory.mktemp("space")
    text = PLANE.replace("[16, 8]", "[8, 7, 9]").replace("[[0, 2], [0, 1]]", "[[0, 2], [0, 1], [0, 3]]")
    text = text.replace('"0.3*(x - 1)"]', '"0.3*(x - 1)", 0]').replace("0.1*y", "0.1*y + 0.2*z")
    solid, probe = text.index("[[space.solid]]"), text.index("[velocity]")
    (folder / "space.toml").write_text(text[:solid] + text[probe:].replace("points = 14", "points = 12"))
    apsis.run(str(folder / "space.toml"), out=folder / "run")
    return folder / "run"


def maps(figure):
    """Returns the maps of a figure, each with its title in one line."""
    return [(axes.get_title().replace("\n", " "), axes) for axes in figure.axes if axes.get_label() != "<colorbar>"]


def test_maps_show_the_fields_with_x_across_and_y_up(plane):
    result = read_result(plane)
    drawn = maps(fields_figure(result))
    assert [title.partition(" (")[0] for title, _ in drawn] == ["density", "bulk velocity along x", "bulk velocity along y",
                                                                "temperature", "stress xx", "stress xy", "stress yy",
                                                                "heat flux along x", "heat flux along y", "speed"]
    for (_, axes), name in zip(drawn, ("rho", "u_x", "u_y", "T")):
        mesh = axes.collections[0]
        np.testing.assert_array_equal(mesh.get_array().filled(np.nan).reshape(8, 16), result.fields[name].T)
        np.testing.assert_allclose([axes.dataLim.x0, axes.dataLim.x1, axes.dataLim.y0, axes.dataLim.y1], [0, 2, 0, 1], atol=1e-15)
        assert axes.get_aspect() == 1.0
        # Both axes have equal scales and no empty margins, which Matplotlib would cut off.
        box = axes.get_position().transformed(axes.figure.transFigure)
        assert box.width == pytest.approx(2 * box.height)
        # The 4 x 2 cells of the box are blank.
        assert mesh.get_array().mask.sum() == 4 * 2
    # Colors of a field with both signs are symmetric about 0.
    low, high = drawn[1][1].collections[0].get_clim()
    assert low == -high < 0.0
    assert history_figure(result) is not None


def test_streamlines_turn_as_the_gas_does(plane):
    result = read_result(plane)
    speed = maps(fields_figure(result))[-1][1]
    arrows = [patch for patch in speed.patches]
    assert arrows
    # The velocity u = 0.3 (-(y - 1/2), x - 1) turns counter-clockwise about (1, 1/2), and so does every arrow.
    for arrow in arrows:
        (x0, y0), (x1, y1) = arrow._posA_posB
        middle = np.array([0.5 * (x0 + x1) - 1.0, 0.5 * (y0 + y1) - 0.5])
        if np.hypot(*middle) > 0.2 and x0 < 1.4:
            assert middle[0] * (y1 - y0) - middle[1] * (x1 - x0) > 0.0


def test_a_component_that_is_rounding_is_drawn_as_zero_and_has_no_streamlines():
    fields = {"u_x": np.array([[0.2, 0.3]]), "u_y": np.array([[1e-17, -2e-17]]), "T": np.array([[1.0, 2.0]]),
              "stress_xy": np.array([[3.0, 4.0]]), "stress_yz": np.array([[1e-16, -1e-17]])}
    colours = colours_of(fields)
    assert colours["stress_yz"] == (-4.0, 4.0, "RdBu_r") and colours["stress_xy"] == (3.0, 4.0, "viridis")
    length = np.hypot(0.3, 2e-17)
    assert colours["u_y"] == (-length, length, "RdBu_r")
    assert colours["u_x"] == (0.2, 0.3, "viridis") and colours["T"] == (1.0, 2.0, "viridis")


def test_four_maps_are_a_square(plane, tmp_path):
    apsis.run(str(plane.parent / "plane.toml"), 'output.fields=["rho", "u_x", "u_y"]', out=tmp_path / "run")
    boxes = [axes.get_position() for _, axes in maps(fields_figure(read_result(tmp_path / "run")))]
    assert len(boxes) == 4
    assert len({round(box.x0, 6) for box in boxes}) == len({round(box.y0, 6) for box in boxes}) == 2


def test_gas_that_hardly_moves_has_no_streamlines():
    x = np.arange(8.0)
    fields = {"u_x": np.where(x < 4.0, 1.0, 1e-5)[:, None] * np.ones(8), "u_y": np.zeros((8, 8))}
    _, panel = plt.subplots()
    draw_streamlines(panel, SimpleNamespace(arrays={"x": x, "y": x}), fields, Plane("x", "y"), (3.0, 3.0))
    lines = np.concatenate(panel.collections[0].get_segments())
    assert 2.5 < lines[:, 0].max() <= 4.0  # lines end at most one cell behind the last cell that moves


def test_the_speed_of_a_run_in_si_units_has_a_unit(tmp_path):
    text = PLANE.replace("epsilon = 0.05\n", "").replace("[initial]", '[gas]\nname = "argon"\npressure = "100 Pa"\n'
                         'temperature = "300 K"\nlength = "1 mm"\n[initial]') + 'units = "SI"\n'
    (tmp_path / "si.toml").write_text(text)
    apsis.run(str(tmp_path / "si.toml"), out=tmp_path / "run")
    assert maps(fields_figure(read_result(tmp_path / "run")))[-1][0] == "speed (m/s)"


def test_a_comparison_of_planes_has_a_row_for_each_field_with_one_range_of_colours(plane, tmp_path):
    apsis.run(str(plane.parent / "plane.toml"), "model.epsilon=5", "space.cells=[32,16]", out=tmp_path / "fine")
    runs = [("few", read_result(plane)), ("many", read_result(tmp_path / "fine"))]
    drawn = maps(comparison_figure(runs))
    assert [title for title, _ in drawn[:2]] == ["density (dimensionless) few", "density (dimensionless) many"]
    assert len(drawn) == 2 * 10  # rho, u_x, u_y, T, three of the stress, two of the heat flux, speed
    for (_, left), (_, right), name in zip(drawn[::2], drawn[1::2], ("rho", "u_x", "u_y", "T")):
        assert left.collections[0].get_clim() == right.collections[0].get_clim()
        np.testing.assert_array_equal(right.collections[0].get_array().filled(np.nan).reshape(16, 32), runs[1][1].fields[name].T)
    # The finer run is averaged over 2 x 2 cells. Cells of the box have no value in either run.
    coarse, fine = (run.fields["rho"] for _, run in runs)
    blocks = 0.25 * (fine[::2, ::2] + fine[1::2, ::2] + fine[::2, 1::2] + fine[1::2, 1::2])
    (line,) = differences(runs)
    assert line.startswith(f"few against many: rho {np.nanmax(np.abs(coarse - blocks)):.2e}, ")
    (name, figure), = probe_comparisons(runs)
    assert name == "probe-middle"
    last = np.genfromtxt(plane / "probes" / "middle.csv", delimiter=",", names=True)[-7:]
    np.testing.assert_array_equal(figure.axes[0].lines[0].get_ydata(), last["rho"])
    assert [text.get_text() for text in figure.axes[0].get_legend().get_texts()] == ["few", "many"]


def test_a_comparison_of_a_plane_with_a_line_is_refused(plane, tmp_path):
    apsis.run("paper/bgk-mixed", "space.cells=12", "velocity.points=48", "time.end=0.01", out=tmp_path / "line")
    with pytest.raises(PictureError, match="the runs have different space dimensions"):
        comparison_figure([("a", read_result(plane)), ("b", read_result(tmp_path / "line"))])


def test_frames_share_the_range_of_colours(plane):
    result = read_result(plane)
    made = list(frames(result, "title"))
    assert [name for name, _ in made] == ["frame-0001", "frame-0002", "frame-0003"]
    ranges = [[axes.collections[0].get_clim() for _, axes in maps(figure)] for _, figure in made]
    assert ranges[0] == ranges[1] == ranges[2]
    density = result.snapshots["rho"]
    np.testing.assert_allclose(ranges[0][0], (np.nanmin(density), np.nanmax(density)))


def test_profiles_along_probes_are_those_of_the_table(plane):
    (name, figure), = probe_figures(read_result(plane), "Gas around a box")
    assert name == "probe-middle"
    assert figure._suptitle.get_text() == "Gas around a box: probe middle from (0.1, 0.5) to (1.9, 0.5)"
    assert [text.get_text() for text in figure.axes[0].get_legend().get_texts()] == ["t = 0", "t = 0.001", "t = 0.002"]
    table = np.genfromtxt(plane / "probes" / "middle.csv", delimiter=",", names=True)
    last = table["t"] == table["t"].max()
    line = figure.axes[0].lines[-1]
    np.testing.assert_array_equal(line.get_xdata(), table["s"][last])
    np.testing.assert_array_equal(line.get_ydata(), table["rho"][last])


def test_space_is_drawn_on_planes_through_the_middle_or_the_chosen_one(space):
    result = read_result(space)
    rho = result.fields["rho"]
    drawn = maps(fields_figure(result))
    assert [title for title, _ in drawn[:3]] == [f"density (dimensionless) {place}" for place in ("z = 1.5", "y = 0.5", "x = 1.125")]
    for (_, axes), cut in zip(drawn[:3], (rho[:, :, 4], rho[:, 3, :], rho[4])):
        np.testing.assert_array_equal(axes.collections[0].get_array().filled(np.nan).reshape(cut.T.shape), cut.T)
    chosen = maps(fields_figure(result, "z=0.2"))[0][1]
    np.testing.assert_array_equal(chosen.collections[0].get_array().filled(np.nan).reshape(7, 8), rho[:, :, 0].T)


def test_a_plane_of_symmetry_at_one_end_is_drawn_in_place_of_the_middle(space):
    whole = read_result(space)
    def places(**kinds):
        case = whole.manifest["case"] | {"boundary": {face: {"kind": kind} for face, kind in kinds.items()}}
        result = replace(whole, manifest=whole.manifest | {"case": case})
        return [plane.place for plane in planes_of(result, None)]
    # If all ends are symmetric, the planes in the middle are drawn. The places are centres of cells along z, y and x.
    assert places() == pytest.approx([1.5, 0.5, 1.125])
    assert places(front="outflow", bottom="outflow") == pytest.approx([1 / 6, 1 - 1 / 14, 1.125])
    assert places(front="outflow", back="outflow", right="inflow") == pytest.approx([1.5, 0.5, 0.125])
    result = replace(whole, manifest=whole.manifest | {"case": {}})
    assert [plane.place for plane in planes_of(result, None)] == pytest.approx([1.5, 0.5, 1.125])


@pytest.mark.parametrize("options, message", [
    (["--slice", "q=1"], "'q=1' is no slice (an axis and a number are needed); write for example z=0.5"),
    (["--slice", "z=x"], "'z=x' is no slice"),
    (["--slice", "z=9"], "the slice 'z=9' is outside of the domain (z from 0 to 3); give a place inside")])
def test_wrong_slices_are_refused(space, tmp_path, capsys, options, message):
    assert command.main([str(space), "--out", str(tmp_path), *options]) == 2
    assert message in capsys.readouterr().err


def test_a_plane_has_no_slices_and_one_snapshot_no_frames(plane, tmp_path):
    with pytest.raises(PictureError, match="the result has two dimensions"):
        fields_figure(read_result(plane), "z=0.5")
    apsis.run("paper/bgk-mixed", "space.cells=12", "velocity.points=48", "time.end=0.01", out=tmp_path / "line")
    with pytest.raises(PictureError, match="there is nothing to animate"):
        list(frames(read_result(tmp_path / "line"), "title"))
    with pytest.raises(PictureError, match="the result is not in space"):
        fields_figure(read_result(tmp_path / "line"), "z=0.5")


def test_the_command_writes_maps_profiles_and_frames(plane, tmp_path):
    assert command.main([str(plane), "--out", str(tmp_path), "--frames"]) == 0
    names = sorted(path.name for path in tmp_path.iterdir())
    assert names == ["fields.png", "frame-0001.png", "frame-0002.png", "frame-0003.png", "history.png", "probe-middle.png"]


def test_the_command_compares_planes_and_their_probes(plane, tmp_path, capsys):
    assert command.main([f"a={plane}", f"b={plane}", "--compare", "both", "--out", str(tmp_path)]) == 0
    assert sorted(path.name for path in tmp_path.iterdir()) == ["both-probe-middle.png", "both.png"]
    assert "a against b: rho 0.00e+00" in capsys.readouterr().out
