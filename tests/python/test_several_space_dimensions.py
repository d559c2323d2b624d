"""Results in two and three space dimensions: arrays have the shape of the mesh, and solution.xdmf describes them."""
import xml.etree.ElementTree as xml
from pathlib import Path

import apsis
import h5py
import numpy as np
import pytest

VORTEX = {
    "parameters": {"U": 0.1},
    "model": {"name": "bgk", "epsilon": 0.01},
    "initial": {"rho": 1, "u": ["U*sin(2*pi*x)*cos(2*pi*y)", "-U*cos(2*pi*x)*sin(2*pi*y)"], "T": 1},
    "space": {"cells": [16, 12]},
    "velocity": {"max": 6.0, "points": 12},
    "time": {"method": "md-imex-8-3-mixed", "end": 0.02, "safety": 1},
    "output": {"every": 0.01, "fields": ["rho", "u_x", "u_y", "T", "stress_xx", "stress_xy", "stress_yy"],
               "probe": [{"name": "middle", "from": [0.5, 0.0], "to": [0.5, 1.0], "points": 25}]},
}
BOX = {**VORTEX, "space": {"cells": [8, 7, 9], "domain": [[0, 1], [0, 1], [0, 2]]},
       "velocity": {"max": 7.0, "points": 8, "equilibrium": "discrete"}, "time": {"method": "md-imex-3-2", "end": 0.002, "dt": 0.001},
       "initial": {"rho": "1 + 0.1*cos(2*pi*x)", "u": [0, 0.1, 0.05], "T": 1},
       "output": {"every": 0.001, "slice": [{"normal": "z", "at": 0.5}],
                  "fields": ["rho", "u_x", "u_y", "u_z", "T", "stress_xx", "stress_xy", "stress_xz", "stress_yy", "stress_yz", "stress_zz"]}}


@pytest.fixture(scope="module", params=[VORTEX, BOX], ids=["plane", "space"])
def computed(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp("run")
    return request.param, folder, apsis.run(request.param, out=folder)


def test_arrays_have_the_shape_of_the_mesh(computed):
    case, _, result = computed
    shape = tuple(case["space"]["cells"])
    assert result.f.shape[:-1] == shape and result.epsilon.shape == shape
    assert all(values.shape == (3, *shape) for values in result.fields.values())
    assert tuple(len(axis) for axis in (result.x, result.y, result.z) if len(axis)) == shape
    np.testing.assert_allclose(result.f @ result.v_weights, result.fields["rho"][-1], rtol=1e-12)
    assert result.marginals["v_y"].shape == (*shape, len(result.axes["v_y"]))
    assert " x ".join(str(n) for n in shape) + " cells" in repr(result)


def test_x_is_the_first_index():
    """The first snapshot of the vortex has the values of its initial velocity, up to the quadrature error of 12 velocities."""
    result = apsis.run(VORTEX)
    x, y = np.meshgrid(result.x, result.y, indexing="ij")
    np.testing.assert_allclose(result.fields["u_x"][0], 0.1 * np.sin(2 * np.pi * x) * np.cos(2 * np.pi * y), atol=1e-6)
    np.testing.assert_allclose(result.fields["u_y"][0], -0.1 * np.cos(2 * np.pi * x) * np.sin(2 * np.pi * y), atol=1e-6)


def test_a_stored_result_is_the_same(computed):
    _, folder, result = computed
    assert apsis.open(folder) == result
    assert apsis.open(folder).y.size > 0


def test_a_probe_is_a_column_of_cells_in_their_middle(computed):
    case, _, result = computed
    if "probe" not in case["output"]:
        assert result.probes == {}
        return
    probe = result.probes["middle"]
    assert list(probe) == ["t", "s", "x", "y", *result.fields]
    u = probe["u_y"].reshape(3, 25)
    # The probe at x = 0.5 is between cells 7 and 8. Every second one of its 25 points is the centre of one of 12 cells along y.
    np.testing.assert_allclose(u[:, 1::2], 0.5 * (result.fields["u_y"][:, 7] + result.fields["u_y"][:, 8]), atol=1e-15)
    np.testing.assert_allclose(u[:, 0], u[:, -1], atol=1e-15)  # periodic


def numbers(text):
    return tuple(int(word) for word in text.split())


def value_of(item, folder):
    """Returns the array of a DataItem by the rules of XDMF 2 for references, hyperslabs and JOIN."""
    shape = numbers(item.get("Dimensions"))
    kind = item.get("ItemType", "Uniform")
    if kind == "Uniform" and item.get("Format") == "XML":
        return np.array(item.text.split(), dtype=float).reshape(shape)
    if kind == "Uniform":
        file, path = item.text.strip().split(":")
        with h5py.File(folder / file) as h5:
            data = h5[path]
            assert data.dtype.itemsize == int(item.get("Precision")) and data.dtype.kind == "f"
            return data[()].reshape(shape)  # the shape may have additional extents of 1
    children = [value_of(child, folder) for child in item]
    if kind == "HyperSlab":
        slab, data = children
        start, stride, count = slab.astype(int)
        assert len(start) == data.ndim and all(start + stride * (count - 1) < data.shape)
        return data[tuple(slice(a, a + s * n, s) for a, s, n in zip(start, stride, count))].reshape(shape)
    assert kind == "Function" and item.get("Function").startswith("JOIN(")
    chosen = [children[int(name.strip().lstrip("$"))] for name in item.get("Function")[5:-1].split(",")]
    joined = np.stack(chosen, axis=-1)
    assert joined.shape == shape
    return joined


def grids_of(path):
    """Yields the time, the points and the attributes of every grid of a description."""
    for grid in xml.parse(path).getroot().iter("Grid"):
        if grid.get("GridType") != "Uniform":
            continue
        topology, geometry = grid.find("Topology"), grid.find("Geometry")
        points = tuple(numbers(topology.get("Dimensions")))
        items = [value_of(item, path.parent) for item in geometry]
        attributes = {one.get("Name"): (one.get("AttributeType", "Scalar"), value_of(one.find("DataItem"), path.parent))
                      for one in grid.findall("Attribute")}
        components = {"Scalar": (), "Vector": (3,), "Tensor": (9,)}
        for name, (kind, values) in attributes.items():
            assert values.shape == (*points, *components[kind]), name
        if topology.get("TopologyType") == "3DRectMesh":
            assert tuple(len(axis) for axis in reversed(items)) == points
        else:
            assert topology.get("TopologyType") == "3DSMesh" and items[0].shape == (*points, 3)
        yield grid.get("Name"), float(grid.find("Time").get("Value")), items, attributes


def test_every_reference_of_the_description_resolves_to_the_fields_at_their_points(computed):
    case, folder, result = computed
    shape = tuple(case["space"]["cells"])
    found = [grid for grid in grids_of(folder / "solution.xdmf") if grid[0] == "fields"]
    assert [t for _, t, _, _ in found] == list(result.t)
    centres = np.meshgrid(*[axis for axis in (result.x, result.y, result.z) if len(axis)], indexing="ij")
    for k, (_, _, (points,), attributes) in enumerate(found):
        points = points.reshape(*shape, 3)
        for direction in range(3):
            np.testing.assert_array_equal(points[..., direction], centres[direction] if direction < len(shape) else 0)
        for name, values in result.fields.items():
            np.testing.assert_array_equal(attributes[name][1].reshape(shape), values[k])
        zero = np.zeros(shape)
        of = lambda name: result.fields.get(name, [zero] * 3)[k]  # noqa: E731
        u, stress = attributes["u"][1].reshape(*shape, 3), attributes["stress"][1].reshape(*shape, 3, 3)
        for i, a in enumerate("xyz"):
            np.testing.assert_array_equal(u[..., i], of(f"u_{a}"))
            for j, b in enumerate("xyz"):
                np.testing.assert_array_equal(stress[..., i, j], of("stress_" + "".join(sorted(a + b))))


def test_marginals_in_the_plane_are_grids_over_velocity_y_and_x(computed):
    case, folder, result = computed
    names = [name for name, *_ in grids_of(folder / "solution.xdmf")]
    if len(case["space"]["cells"]) == 3:
        assert set(names) == {"fields"}
        assert "too many for a grid" in (folder / "solution.xdmf").read_text()
        return
    (_, _, axes, attributes), = [grid for grid in grids_of(folder / "solution.xdmf") if grid[0] == "marginal_v_y"]
    for axis, expected in zip(axes, (result.axes["v_y"], result.y, result.x)):
        np.testing.assert_array_equal(axis, expected)
    np.testing.assert_array_equal(attributes["marginal_v_y"][1], result.marginals["v_y"])


def test_a_slice_has_a_description_of_its_own(computed):
    case, folder, result = computed
    if "slice" not in case["output"]:
        return
    found = list(grids_of(folder / "slices" / "slice-1.xdmf"))
    assert len(found) == 3
    points, attributes = found[-1][2][0], found[-1][3]
    assert points.shape == (8, 7, 1, 3) and np.all(points[..., 2] == 0.5)
    # The centres along z are 1/9 + 2 k/9, so 0.5 is between k = 1 and 2, at 3/4 of the distance.
    expected = 0.25 * result.fields["rho"][-1][..., 1] + 0.75 * result.fields["rho"][-1][..., 2]
    np.testing.assert_allclose(attributes["rho"][1][..., 0], expected, rtol=1e-13)


def test_f_at_chosen_points_is_in_place_of_all(tmp_path):
    overrides = ["output.distribution_at=[[0.1, 0.2]]", "output.every=0"]
    result = apsis.run(VORTEX, *overrides, out=tmp_path)
    with h5py.File(tmp_path / "solution.h5") as h5:
        assert "f" not in h5 and "marginals" not in h5
        # The point (0.1, 0.2) is in cell 1 of width 1/16 and in cell 2 of width 1/12.
        np.testing.assert_array_equal(h5["points/f"][:], result.f[1, 2][None, :])
        assert h5["points/x"][0] == result.x[1] and h5["points/y"][0] == result.y[2]
    assert apsis.open(tmp_path).f.size == 0


def test_a_run_reports_its_memory(tmp_path):
    import subprocess
    program = Path(apsis.__file__).parents[2] / "app" / "apsis"
    if not program.exists():
        pytest.skip("the program was not built beside the package")
    (tmp_path / "case.toml").write_text(apsis.case_text.to_toml(VORTEX))
    done = subprocess.run([program, "run", "case.toml"], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert "case.toml: needs 2 MB of memory (16 x 12 cells x 144 unknowns)" in done.stderr
    assert "no probes, slices and surfaces are written" in done.stderr
