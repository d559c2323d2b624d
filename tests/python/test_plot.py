"""Content of the pictures of runs and methods, from results with known numbers."""
import json
import math
import re
from dataclasses import replace

import apsis
import h5py
import numpy as np
import pytest
from apsis.plot import __main__ as command
from apsis.plot import comparison_figure, distribution_figure, draw, fields_figure, history_figure, read_result, stability_figure
from apsis.plot import tableau_figure
from apsis.plot.methods import stability_function
from apsis.plot.comparison import differences
from apsis.plot.style import PictureError, plt


def describe(name):
    m = apsis.method(name)
    return {"name": name, "A_hat": m.A_hat, "A": m.A, "A_dot": m.A_dot}


def run(folder, case, *overrides):
    return apsis.run(case, *overrides, out=folder)


SMALL_BGK = ("space.cells=12", "velocity.points=48", "time.end=0.01", "output.every=0.004")


# --- runs ------------------------------------------------------------------------------------------------------------------------


def test_fields_of_a_run_are_in_the_order_of_the_model(tmp_path):
    computed = run(tmp_path, "paper/bgk-mixed", *SMALL_BGK)
    figure = fields_figure(read_result(tmp_path))
    assert [a.get_ylabel() for a in figure.axes] == [f"{name} (dimensionless)" for name in ("density", "bulk velocity", "temperature", "heat flux")]
    for axes, name in zip(figure.axes, ("rho", "u", "T", "heat_flux")):
        # Earlier snapshots are grey, and the final one is drawn last.
        assert len(computed.t) == 4
        assert [line.get_label() for line in axes.lines] == [f"t = {t:.4g}" for t in computed.t]
        for line, values in zip(axes.lines, computed.fields[name]):
            np.testing.assert_array_equal(line.get_ydata(), values)


def test_axes_of_results_in_si_units_have_these_units(tmp_path):
    computed = run(tmp_path, "gas/micro-channel", "velocity.points=16", "time.end=0.2 ns")
    result = read_result(tmp_path)
    figure = fields_figure(result)
    assert {a.get_xlabel() for a in figure.axes} == {"x (m)"}
    assert "temperature (K)" in [a.get_ylabel() for a in figure.axes]
    assert history_figure(result).axes[-1].get_xlabel() == "t (s)"
    # A result without a folder gives the same numbers.
    np.testing.assert_array_equal(computed.fields["T"][-1], result.fields["T"])
    np.testing.assert_array_equal(computed.x, result.arrays["x"])
    assert math.isclose(computed.t[-1], 2e-10) and 300 < result.fields["T"].mean() < 350
    assert math.isclose(computed.history["t"][-1], 2e-10)


def test_the_next_run_removes_the_pictures_that_nobody_changed(tmp_path):
    case = ("paper/broadwell", "space.cells=10", "time.end=0.01")
    run(tmp_path, *case)
    for _ in range(2):  # a second drawing replaces the lines of the first
        assert command.main([str(tmp_path)]) == 0
    pictures = tmp_path / "pictures"
    names = [line.split(" ", 2)[2] for line in (pictures / ".written").read_text().splitlines()]
    assert sorted(names) == ["fields.png", "history.png"]
    (pictures / "fields.png").write_bytes(b"mine")
    run(tmp_path, *case)
    assert [path.name for path in pictures.iterdir()] == ["fields.png"]
    # A folder of one's own has no list.
    assert command.main([str(tmp_path), "--out", str(tmp_path / "elsewhere")]) == 0
    assert not (tmp_path / "elsewhere" / ".written").exists()


def test_a_missing_folder_cannot_be_compared(tmp_path, capsys):
    assert command.main([f"a={tmp_path}/nowhere", "--compare", "both"]) == 2
    assert f"error: cannot compare '{tmp_path}/nowhere' (no folder of this name)" in capsys.readouterr().err


def test_f_is_drawn_over_velocity_and_position(tmp_path):
    computed = run(tmp_path, "paper/bgk-mixed", *SMALL_BGK)
    figure = distribution_figure(read_result(tmp_path))
    mesh = figure.axes[0].collections[0].get_array().reshape(len(computed.v), len(computed.x))
    np.testing.assert_array_equal(mesh, computed.f.T)
    np.testing.assert_array_equal(figure.axes[1].lines[0].get_ydata(), computed.epsilon)


def test_a_few_speeds_have_no_map_and_six_fields_two_rows(tmp_path):
    run(tmp_path, "paper/broadwell")
    result = read_result(tmp_path)
    assert distribution_figure(result) is None
    figure = fields_figure(result)
    assert len(figure.axes) == 6
    assert len({round(a.get_position().y0, 3) for a in figure.axes}) == 2


def test_without_space_unknowns_are_drawn_over_time(tmp_path):
    computed = run(tmp_path, "paper/ode", "output.every=0.25")
    figure = fields_figure(read_result(tmp_path))
    np.testing.assert_array_equal(figure.axes[0].lines[0].get_ydata(), computed.fields["u1"][:, 0])
    np.testing.assert_array_equal(figure.axes[0].lines[0].get_xdata(), computed.t)


def test_history_of_a_steady_state_shows_its_iterations(tmp_path):
    computed = apsis.run("gas/couette", "space.cells=8", "steady.tolerance=1e-8", out=tmp_path / "a")
    residual, rates, smallest = history_figure(read_result(tmp_path / "a")).axes
    assert residual.get_xlabel() == "iteration" and residual.get_yscale() == "log"
    np.testing.assert_array_equal(residual.lines[0].get_ydata(), computed.history["residual_relative"])
    assert rates.get_ylabel() == "relative net rate of the gas"
    profile = fields_figure(read_result(tmp_path / "a")).axes[0].lines[-1]
    assert profile.get_label() == f"iteration {computed.history['step'][-1]:.0f}"


def test_history_shows_the_checks_and_varying_steps(tmp_path):
    # Snapshots are only at the start and the end, so steps are constant and have no panel.
    computed = run(tmp_path / "a", "paper/bgk-mixed", *SMALL_BGK[:-1], "output.every=0.01")
    smallest, defects, entropy = history_figure(read_result(tmp_path / "a")).axes
    np.testing.assert_array_equal(smallest.lines[0].get_ydata(), computed.history["min_value"])
    assert [t.get_text() for t in defects.get_legend().get_texts()] == ["mass", "momentum", "energy"]
    assert all(line.get_ydata().min() >= 1e-18 for line in defects.lines)  # exact zeros are visible
    np.testing.assert_array_equal(entropy.lines[0].get_ydata(), computed.history["entropy"])
    run(tmp_path / "b", "paper/ode", "time.tolerance=1e-6")
    assert history_figure(read_result(tmp_path / "b")).axes[-1].get_ylabel() == "Δt (dimensionless)"


def test_a_comparison_draws_the_finest_as_a_line_and_averages_it_onto_the_others(tmp_path):
    coarse = run(tmp_path / "coarse", "paper/broadwell", "space.cells=10")
    fine = run(tmp_path / "fine", "paper/broadwell", "space.cells=40")
    runs = [("few", read_result(tmp_path / "coarse")), ("many", read_result(tmp_path / "fine"))]
    first = comparison_figure(runs).axes[0]
    assert [line.get_linestyle() for line in first.lines] == ["None", "-"]
    averages = fine.fields["rho"][-1].reshape(10, 4).mean(axis=1)
    distance = np.abs(coarse.fields["rho"][-1] - averages).max()
    assert distance > 0
    (line,) = differences(runs)
    assert line.startswith(f"few against many: rho {distance:.2e}, ")


def test_runs_with_equally_many_cells_are_lines_and_are_compared_with_the_last(tmp_path):
    one, two = (run(tmp_path / name, "paper/broadwell", f"model.epsilon={name}") for name in ("1e-2", "1"))
    runs = [(name, read_result(tmp_path / name)) for name in ("1e-2", "1")]
    assert [line.get_linestyle() for line in comparison_figure(runs).axes[0].lines] == ["-", "--"]
    distance = np.abs(one.fields["rho"][-1] - two.fields["rho"][-1]).max()
    assert differences(runs)[0].startswith(f"1e-2 against 1: rho {distance:.2e}, ")


def test_a_comparison_of_different_units_is_refused(tmp_path):
    run(tmp_path / "a", "paper/broadwell", "space.cells=10")
    plain = read_result(tmp_path / "a")
    si = replace(plain, manifest={**plain.manifest, "units": {"rho": "kg/m^3"}})
    message = re.escape("'a' and 'b' cannot be compared (the unit of rho is dimensionless in one, kg/m^3 in the other); "
                        "run both with the same output.units")
    for refused in (comparison_figure, differences):
        with pytest.raises(PictureError, match=f"^{message}$") as problem:
            refused([("a", plain), ("b", si)])
        assert problem.value.exit_code == 2
    comparison_figure([("a", si), ("b", si)])


def test_a_comparison_of_different_models_is_refused(tmp_path):
    run(tmp_path / "a", "paper/ode")
    run(tmp_path / "b", "paper/broadwell")
    with pytest.raises(PictureError, match="nothing to compare"):
        comparison_figure([("a", read_result(tmp_path / "a")), ("b", read_result(tmp_path / "b"))])


# --- methods ---------------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["md-imex-6-3", "ars-222", "imdrk-5-4", "ssprk-3-3", "hsz-a-3-2"])
def test_the_stability_function_is_one_step_of_the_integrator(name):
    # The test equation u′ = λ_T u + λ_Q u is a RelaxationProblem with E = 0, Q = −u/ε and T = λ_T u.
    z_T, z_Q, method = -0.3, -1.7, apsis.method(name)
    if method.kind == "implicit":
        z_T = 0.0
    problem = apsis.RelaxationProblem(transport=lambda t, u: [z_T * u[0]], moments=lambda u: 0.0, equilibrium=lambda w: [0.0],
                                      rate=lambda w: 1.0, epsilon=-1 / z_Q)
    stepped = apsis.integrate(problem, [1.0], (0, 1), dt=1.0, method=name).u[-1][0]
    # The tolerance is for rounding errors of some tens of operations.
    assert complex(stability_function(describe(name), z_T, z_Q)) == pytest.approx(stepped, rel=1e-12)


def test_regions_are_drawn_for_the_parts_of_a_method():
    assert [a.get_xlabel() for a in stability_figure(describe("imdrk-5-4")).axes] == ["Re z_Q (dimensionless)"]
    assert [a.get_xlabel() for a in stability_figure(describe("ssprk-10-4")).axes] == ["Re z_T (dimensionless)"]
    both = stability_figure(describe("md-imex-6-3")).axes
    assert [a.get_xlabel() for a in both] == ["Re z_Q (dimensionless)", "Re z_T (dimensionless)"]


def test_a_tableau_shows_every_coefficient_and_leaves_zeros_blank():
    method = describe("md-imex-3-2")
    axes = [a for a in tableau_figure(method).axes if a.get_images()]
    for a, name in zip(axes, ("A_hat", "A", "A_dot")):
        shown = np.asarray(a.get_images()[0].get_array(), dtype=float)
        np.testing.assert_array_equal(np.where(np.isnan(shown), 0, shown), method[name])
        assert len(a.texts) == np.count_nonzero(method[name])


# --- pictures described by the program
# --------------------------------------------------------------------------------------------


def curve(label, x, y, style="line_and_markers", colour=-1):
    return {"label": label, "x": x, "y": y, "style": style, "colour": colour}


def panel(**changes):
    return {"title": "", "x_label": "Δt (dimensionless)", "y_label": "error", "log_x": True, "log_y": True,
            "slopes": [2], "curves": [], "maps": []} | changes


def picture(*panels):
    return {"name": "one", "title": "A <title>", "caption": "See & believe", "panels": list(panels)}


def test_curves_omit_values_without_a_logarithm():
    axes = draw(picture(panel(curves=[curve("a", [1, 0.5, 0.25, 0.125], [1, 0, None, -1])]))).axes[0]
    assert list(axes.lines[0].get_xdata()) == [1.0]
    assert axes.get_xlabel() == "Δt (dimensionless)"


@pytest.mark.parametrize("slope", [2, -5])
def test_a_slope_triangle_has_the_slope(slope):
    axes = draw(picture(panel(curves=[curve("a", [1, 0.1], [1, 0.1**slope])], slopes=[slope]))).axes[0]
    (triangle,) = axes.patches
    (x0, y0), (x1, _), (upright, y2) = triangle.get_xy()[:3]
    foot = x0 if upright == x1 else x1
    assert math.log(y2 / y0) / math.log(upright / foot) == pytest.approx(slope, rel=1e-12)
    low, high = axes.get_ylim()
    assert low < y0 and y2 < high


def test_curves_of_one_colour_share_it_and_references_are_black():
    data = panel(curves=[curve("a", [1, 2], [1, 2], "line", 0), curve("", [1, 2], [2, 1], "dashed", 0),
                         curve("exact", [1, 2], [1, 1], "dash_dot", -2)])
    lines = draw(picture(data)).axes[0].lines
    assert lines[0].get_color() == lines[1].get_color()
    assert lines[2].get_color() == "#000000"


def study(*panels, caption="The l2 norm of the difference in rho to the next finer run. Triangles: orders of the methods."):
    return picture(*panels) | {"name": "converge", "caption": caption}


def test_a_study_names_its_quantity_and_has_one_range():
    one, other = panel(curves=[curve("a", [1, 0.1], [1, 1e-2])]), panel(curves=[curve("a", [1, 0.1], [1e-5, 1e-7])])
    left, right = draw(study(one, other)).axes
    assert left.get_ylim() == right.get_ylim() and left.get_ylim()[0] < 1e-7 and left.get_ylim()[1] > 1
    for axes in (left, right):
        assert axes.get_ylabel().replace("\n", " ") == "l2 norm of the difference in rho to the next finer run (dimensionless)"
    # In other pictures, panels keep their own labels and ranges.
    left, right = draw(picture(one, other)).axes
    assert left.get_ylim() != right.get_ylim() and left.get_ylabel() == "error"


@pytest.mark.parametrize("slopes", [[2], [2, 3], [-2]])
def test_a_legend_lies_on_no_slope_triangle_label_or_curve(slopes):
    many = [curve(f"time.method = method-{k}", [1, 0.1, 0.01], [10.0**-k, 10.0**(-k - 2), 10.0**(-k - 4)]) for k in range(8)]
    figure = draw(study(panel(curves=many, slopes=slopes)))
    figure.canvas.draw()
    (axes,) = figure.axes
    legend = axes.get_legend().get_window_extent()
    # The legend overlaps neither the curves, which are inside the axes, nor the labels below them.
    assert not legend.overlaps(axes.get_window_extent()) and not legend.overlaps(axes.xaxis.label.get_window_extent())
    assert legend.y0 >= 0 and legend.x0 >= 0 and legend.x1 <= figure.bbox.width


def test_omitted_velocities_are_noted_in_the_picture(tmp_path):
    run(tmp_path, "paper/bgk-mixed", *SMALL_BGK)
    result = read_result(tmp_path)
    axes = distribution_figure(result).axes[0]
    low, high = axes.get_ylim()
    v = result.arrays["v"]
    assert low > v.min() and high < v.max()
    assert axes.get_title().startswith(f"v from {low:.4g} to {high:.4g} of a grid from {v.min():.4g} to {v.max():.4g}")


def test_maps_are_drawn_with_holes():
    data = panel(maps=[{"label": "slope", "x": [1, 10], "y": [1, 10, 100], "value": [[1, 2], [None, 3], [2, 2]],
                        "lowest": 0, "highest": 3}])
    assert [t.get_text() for t in draw(picture(data)).axes[0].texts] == ["1.0", "2.0", "3.0", "2.0", "2.0"]


# --- the command -----------------------------------------------------------------------------------------------------------------


def test_the_command_draws_folders_files_and_methods(tmp_path, monkeypatch, capsys):
    run(tmp_path / "run", "paper/bgk-mixed", *SMALL_BGK)
    (tmp_path / "p.json").write_text(json.dumps(picture(panel(curves=[curve("a", [1, 2], [1, 4])]))))
    monkeypatch.chdir(tmp_path)
    assert command.main(["run", "p.json", "md-imex-3-2"]) == 0
    made = capsys.readouterr().out.split()
    assert made == ["run/pictures/fields.png", "run/pictures/distribution.png", "run/pictures/history.png", "pictures/one.png",
                    "md-imex-3-2-tableau.png", "md-imex-3-2-stability.png"]
    for name in made:
        image = plt.imread(tmp_path / name)[..., :3]
        assert image.std() > 0.01, f"{name} is blank"


@pytest.mark.parametrize("form", ["png", "svg", "pdf"])
def test_equal_results_make_equal_files(tmp_path, form):
    run(tmp_path / "run", "paper/broadwell")
    for out in ("a", "b"):
        assert command.main([str(tmp_path / "run"), "--out", str(tmp_path / out), "--format", form]) == 0
    for name in ("fields", "history"):
        assert (tmp_path / "a" / f"{name}.{form}").read_bytes() == (tmp_path / "b" / f"{name}.{form}").read_bytes()


def test_a_picture_whose_name_is_a_path_is_refused(tmp_path, capsys):
    for name in ("../escape", "/tmp/escape", ".hidden"):
        file = tmp_path / "picture.json"
        file.write_text(json.dumps({"name": name, "A_hat": [[0]], "A": [[1]], "A_dot": [[0]]}), encoding="utf-8")
        folder = tmp_path / "pictures"
        assert command.main([str(file), "--out", str(folder)]) == 4
        assert f"names a picture '{name}" in capsys.readouterr().err
        assert sorted(p.name for p in tmp_path.iterdir()) == ["picture.json"]


def test_a_method_without_a_butcher_form_is_refused(tmp_path, capsys):
    file = tmp_path / "exponential-2.json"
    file.write_text(json.dumps({"name": "exponential-2", "A_hat": [[0]]}), encoding="utf-8")  # the program describes it so
    assert command.main([str(file), "--out", str(tmp_path)]) == 4
    assert "'exponential-2' cannot be drawn (an exponential method has no Butcher form); give" in capsys.readouterr().err
    assert sorted(path.name for path in tmp_path.iterdir()) == [file.name]


def test_results_without_a_picture_are_refused(tmp_path, monkeypatch, capsys):
    run(tmp_path / "run", "paper/ode")
    (tmp_path / "empty").mkdir()
    (tmp_path / "none.json").write_text("{}")
    (tmp_path / "list.json").write_text("[]")
    (tmp_path / "damaged.json").write_text(json.dumps(picture({"title": "no axes"})))
    (tmp_path / "binary.json").write_bytes(b"\x89HDF\xff")
    monkeypatch.chdir(tmp_path)
    for name, code in (("empty", 4), ("none.json", 4), ("list.json", 4), ("damaged.json", 4), ("binary.json", 4), ("nothing", 2)):
        assert command.main([name]) == code, name
        assert name in capsys.readouterr().err
    for file in ("solution.h5", "history.csv", "manifest.json"):
        kept = (tmp_path / "run" / file).read_bytes()
        (tmp_path / "run" / file).write_bytes(kept[: len(kept) // 2])
        assert command.main([str(tmp_path / "run")]) == 4, file
        assert file in capsys.readouterr().err
        (tmp_path / "run" / file).write_bytes(kept)
    for text, found in (("[]", "a list"), ("3", "a number"), ("null", "null")):
        (tmp_path / "run" / "manifest.json").write_text(text)
        assert command.main([str(tmp_path / "run")]) == 4
        assert f"manifest.json' is not a JSON object (it is {found}); give what apsis wrote" in capsys.readouterr().err
    assert command.main([str(tmp_path / "run"), "--out", str(tmp_path / "none.json")]) == 4


def test_what_others_add_to_a_result_is_ignored(tmp_path):
    run(tmp_path / "run", "paper/broadwell")
    before = read_result(tmp_path / "run")
    with h5py.File(tmp_path / "run/solution.h5", "a") as file:
        for group in ("", "fields/"):
            file[group + "comment"] = "by hand"
            file[group + "lost"] = h5py.SoftLink("/nowhere")
            file[group + "none"] = h5py.Empty("f8")
            file[group + "pairs"] = np.zeros(3, [("a", "f8")])
        file["again"] = h5py.SoftLink("/")
        file.create_dataset("huge", (2**40,), "f8", chunks=(1024,), compression="gzip")
    after = read_result(tmp_path / "run")
    assert list(after.fields) == list(before.fields) and list(after.arrays) == list(before.arrays)
