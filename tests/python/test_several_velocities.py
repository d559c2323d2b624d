"""Results with two and three velocity dimensions: every component of a velocity reaches Python and the pictures."""
import dataclasses
import xml.etree.ElementTree as xml
from pathlib import Path

import apsis
import h5py
import numpy as np
import pytest
from apsis.plot import distribution_figure, fields_figure, read_result, results
from apsis.report import make_report

POINTS = {2: 48, 3: 24}
WIDTH = {2: 15.0, 3: 9.0}


def overrides(d):
    return ["space.cells=8", f"velocity.points={POINTS[d]}", f"velocity.max={WIDTH[d]}", "time.end=0.01", "output.every=0.004",
            f"model.velocity_dimensions={d}", "space.formulation=finite-difference"]


@pytest.fixture(scope="module", params=[2, 3])
def computed(request, tmp_path_factory):
    """Returns the dimensions, the folder and the result of a small run."""
    folder = tmp_path_factory.mktemp("run")
    return request.param, folder, apsis.run("paper/bgk-mixed", *overrides(request.param), out=folder)


def names_of_velocity(d):
    return ["u_x", "u_y", "u_z"][:d]


def test_moments_of_f_are_the_fields(computed):
    d, _, result = computed
    points = POINTS[d] ** d
    assert result.v.shape == (points, d) and result.v_weights.shape == (points,) and result.f.shape == (8, points)
    rho = result.f @ result.v_weights
    np.testing.assert_allclose(rho, result.fields["rho"][-1], rtol=1e-12)
    axes = "xyz"[:d]
    stress = [f"stress_{a}{b}" for k, a in enumerate(axes) for b in axes[k:]]
    assert list(result.fields) == ["rho", *names_of_velocity(d), "T", *stress, *(f"heat_flux_{a}" for a in axes)]
    for k, name in enumerate(names_of_velocity(d)):
        u = result.f @ (result.v_weights * result.v[:, k]) / rho
        np.testing.assert_allclose(u, result.fields[name][-1], atol=1e-13)
    # The initial velocity is along x, between 0.4 and 0.5. The data are even in the other components.
    assert result.fields["u_x"][-1].min() > 0.3 and np.abs(result.fields["u_y"]).max() < 1e-14


def test_axes_span_the_velocities_and_marginals_are_integrals(computed):
    d, _, result = computed
    names = ["v_x", "v_y", "v_z"][:d]
    assert sorted(result.axes) == sorted(result.marginals) == names
    grid = np.stack(np.meshgrid(*(result.axes[name] for name in names), indexing="ij"), axis=-1)
    np.testing.assert_array_equal(grid.reshape(-1, d), result.v)
    dv = 2 * WIDTH[d] / POINTS[d]
    f = result.f.reshape(8, *(POINTS[d],) * d)
    for k, name in enumerate(names):
        others = tuple(1 + l for l in range(d) if l != k)
        np.testing.assert_allclose(result.marginals[name], f.sum(axis=others) * dv ** (d - 1), rtol=1e-12)


def test_a_stored_run_is_the_computed_one(computed):
    d, folder, result = computed
    stored = apsis.open(folder)
    for name in ("f", "v", "v_weights"):
        np.testing.assert_array_equal(getattr(stored, name), getattr(result, name))
    for name in ("axes", "marginals", "fields"):
        here, there = getattr(result, name), getattr(stored, name)
        assert here.keys() == there.keys()
        for key, values in here.items():
            np.testing.assert_array_equal(values, there[key])
    assert result == apsis.run("paper/bgk-mixed", *overrides(d)) and result != dataclasses.replace(result, marginals={})


def test_the_picture_of_f_is_its_marginal_over_v_x(computed):
    d, folder, result = computed
    for figure in (distribution_figure(read_result(folder)), result.plot("distribution")):
        mesh = figure.axes[0].collections[0]
        np.testing.assert_array_equal(np.asarray(mesh.get_array()).reshape(POINTS[d], 8), result.marginals["v_x"].T)
        corners = mesh.get_coordinates()
        assert (np.diff(corners[:, 0, 1]) > 0).all()
        assert figure.axes[0].get_ylabel() == "v_x (dimensionless)"
        labels = [axes.get_ylabel() for axes in figure.axes]
        assert {2: "∫ f dv_y (dimensionless)", 3: "∫ f dv_y dv_z (dimensionless)"}[d] in labels


def test_pictures_of_fields_have_every_component_and_do_not_magnify_rounding(computed):
    d, folder, result = computed
    axes = fields_figure(read_result(folder)).axes
    assert [a.get_ylabel().replace("\n", " ") for a in axes[1:1 + d]] == [
        f"bulk velocity along {k} (dimensionless)" for k in "xyz"[:d]]
    largest = np.abs(result.fields["u_x"]).max()
    assert axes[2].get_ylim() == (-largest, largest) and axes[1].get_ylim() != (-largest, largest)


def test_the_report_says_what_its_picture_shows(computed):
    d, folder, _ = computed
    page = make_report(folder).read_text(encoding="utf-8")
    assert {2: "∫ f dv_y at the end", 3: "∫ f dv_y dv_z at the end"}[d] in page and "f(x, v) at the end" not in page


def numbers_of(item, folder):
    """Returns the numbers of a DataItem, from its text or from the file that it names."""
    if item.get("Format") == "XML":
        return np.array([float(x) for x in item.text.split()])
    file, name = item.text.split(":")
    with h5py.File(folder / file) as h5:
        return h5[name][:]


def test_every_axis_of_the_description_is_monotone(computed):
    d, folder, result = computed
    grids = [g for g in xml.parse(folder / "solution.xdmf").iter("Grid") if g.get("GridType") == "Uniform"]
    shapes = {}
    for grid in grids:
        axes = [numbers_of(item, folder) for item in grid.find("Geometry")]
        assert all((np.diff(axis) > 0).all() for axis in axes)
        shape = tuple(int(n) for n in grid.find("Topology").get("Dimensions").split())
        assert shape == tuple(len(axis) for axis in reversed(axes))
        shapes[grid.get("Name")] = shape
        if grid.get("Name") == "distribution":
            (item,) = grid.find("Attribute")
            assert tuple(int(n) for n in item.get("Dimensions").split()) == shape
            np.testing.assert_array_equal(numbers_of(item, folder), result.f)
    n = POINTS[d]
    marginals = {f"marginal_{name}": (1, 8, n) for name in result.axes}
    assert shapes == {"fields": (1, 1, 8), **({"distribution": (8, n, n)} if d == 2 else {}), **marginals}


def test_results_of_one_velocity_dimension_are_as_they_were(tmp_path):
    result = apsis.run("paper/bgk-mixed", "space.cells=8", "velocity.points=48", "time.end=0.01", out=tmp_path)
    assert result.v.shape == (48,) and result.v_weights.size == 0 and result.axes == result.marginals == {}
    assert list(result.fields) == ["rho", "u", "T", "heat_flux"]
    with h5py.File(Path(tmp_path) / "solution.h5") as h5:
        assert sorted(h5) == ["epsilon", "f", "fields", "v", "x"]
    figure = result.plot("distribution")
    assert figure.axes[0].get_ylabel() == "v (dimensionless)"


def test_a_reduced_gas_is_drawn_by_its_first_function(tmp_path):
    out = tmp_path / "o"
    r = apsis.run("paper/bgk-mixed", "model.degrees_of_freedom=3", "space.cells=20", "velocity.points=100", "time.end=0.005", out=out)
    assert r.f.shape == (20, 200) and r.v.shape == (100,)
    result = read_result(out)
    v, g = results.distribution_over_velocity(result)
    assert np.array_equal(g, r.f[:, :100]) and results.distribution_name(result) == "∫ f dη"
    # The density is the sum of g without h, times dv = 0.3.
    assert np.allclose(g.sum(axis=1) * 0.3, r.fields["rho"][-1], rtol=1e-13)
    assert results.distribution_figure(result) is not None
