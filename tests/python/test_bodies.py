"""Bodies in Python: loads, outlines in pictures, and the files for ParaView, which a parser of this file reads."""
import base64
import re
import xml.etree.ElementTree as xml
from collections import Counter

import apsis
import numpy as np
import pytest
from apsis.plot import read_result
from apsis.plot.results import figures
from apsis.plot.surfaces import angle_profiles
from apsis.plot.walls import behind, cut_of, solid_cells, solid_parts
from apsis.report import make_report
from apsis.report.page import number

REFERENCE = {"density": 1, "velocity": [1.2, 0], "temperature": 1, "length": 1.6}
PLANE = {
    "model": {"name": "bgk", "epsilon": 0.3, "degrees_of_freedom": 3},
    "initial": {"rho": 1, "u": [1.2, 0], "T": 1},
    "space": {"cells": [16, 14], "domain": [[-2, 2], [-1.5, 2]], "boundary": "outflow",
              "body": [{"name": "disc", "shape": "circle", "centre": [-0.4, 0.1], "radius": 0.8, "T": 1.3}],
              "solid": [{"name": "box", "from": [1, 0.5], "to": [1.5, 1]}]},
    "velocity": {"max": 7, "points": 10},
    "time": {"method": "md-imex-3-2", "end": 0.1, "safety": 1},
    "output": {"surfaces": "all", "reference": REFERENCE},
}
SPACE = {**PLANE, "model": {"name": "bgk", "epsilon": 0.3}, "initial": {"rho": 1, "u": [1.2, 0, 0], "T": 1},
         "space": {"cells": [8, 8, 8], "domain": [[-2, 2], [-2, 2], [-2, 2]], "boundary": "outflow",
                   "body": [{"name": "ball", "shape": "sphere", "centre": [0.1, 0.2, 0], "radius": 1.1}]},
         "velocity": {"max": 5, "points": 10}, "time": {"method": "md-imex-3-2", "end": 0.02, "safety": 1},
         "output": {"surfaces": "all", "reference": {**REFERENCE, "velocity": [1.2, 0, 0], "area": 3, "up": [0, 1, 0]}}}


@pytest.fixture(scope="module", params=[PLANE, SPACE], ids=["plane", "space"])
def computed(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp("run")
    return request.param, folder, apsis.run(request.param, out=folder)


def numbers(element):
    """Returns the numbers of a DataArray. Its first 8 bytes are the number of bytes that follow."""
    raw = base64.b64decode(element.text, validate=True)
    size = int(np.frombuffer(raw[:8], "<u8")[0])
    assert element.get("format") == "binary" and size == len(raw) - 8
    values = np.frombuffer(raw[8:], {"Float64": "<f8", "Int64": "<i8"}[element.get("type")])
    components = int(element.get("NumberOfComponents"))
    return values.reshape(-1, components) if components > 1 else values


def read_vtp(path):
    """Returns the points, the indices of the points of each cell, and the arrays of the cells."""
    root = xml.parse(path).getroot()
    assert root.attrib == {"type": "PolyData", "version": "1.0", "byte_order": "LittleEndian", "header_type": "UInt64"}
    piece = root.find("PolyData/Piece")
    counts = {kind: int(piece.get(f"NumberOf{kind}")) for kind in ("Points", "Verts", "Lines", "Strips", "Polys")}
    points = numbers(piece.find("Points/DataArray"))
    assert points.shape == (counts["Points"], 3)
    kind = "Lines" if counts["Lines"] else "Polys"
    arrays = {one.get("Name"): numbers(one) for one in piece.find(kind)}
    cells = np.split(arrays["connectivity"], arrays["offsets"][:-1])
    assert counts[kind] == len(cells) == sum(counts[one] for one in ("Verts", "Lines", "Strips", "Polys"))
    assert set(np.unique(arrays["connectivity"])) == set(range(len(points)))
    data = {one.get("Name"): numbers(one) for one in piece.find("CellData")}
    assert all(len(values) == len(cells) for values in data.values())
    return points, cells, data


def test_the_report_has_every_body_its_loads_and_pictures(computed):
    case, folder, result = computed
    page = make_report(folder).read_text(encoding="utf-8")
    for name, loads in result.summary["bodies"].items():
        assert f"surface-{name}.png" in {file.name for file in (folder / "pictures").iterdir()}
        assert re.search(rf"<td>{name}</td>.*<td>{number(loads['drag'])}</td>.*<td>{number(loads['C_D'])}</td>", page)
    assert page.count("<b>Fluxes to a wall.</b>") == len(result.surfaces)


def vector_area(corners):
    if len(corners) == 2:
        along = corners[1] - corners[0]
        return np.array([along[1], -along[0], 0])
    return 0.5 * np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0)


def test_files_for_paraview_are_the_surfaces_of_the_tables(computed):
    _, folder, result = computed
    for name, table in result.surfaces.items():
        points, cells, data = read_vtp(folder / "surfaces" / f"{name}.vtp")
        assert len(cells) == len(table["area"])
        for column, values in table.items():
            if column != "face":
                np.testing.assert_allclose(data[column], values, rtol=1e-15, atol=0)  # the table has 16 or 17 digits
        normals = np.stack([table.get(f"n_{axis}", 0 * table["area"]) for axis in "xyz"], axis=1)
        np.testing.assert_array_equal(data["normal"], normals)
        areas = np.array([vector_area(points[cell]) for cell in cells])
        np.testing.assert_allclose(areas, table["area"][:, None] * normals, atol=1e-14)
        force = data["tau"] - table["pressure"][:, None] * normals
        np.testing.assert_allclose(force, data["momentum"], atol=1e-14)
        np.testing.assert_allclose(np.linalg.norm(data["tau"], axis=1), abs(table["shear_stress"]), atol=1e-14)


def test_bodies_in_files_for_paraview_have_no_holes(computed):
    case, folder, _ = computed
    for name in ("disc", "box") if case is PLANE else ("ball",):
        points, cells, data = read_vtp(folder / "surfaces" / f"{name}.vtp")
        np.testing.assert_allclose((data["area"][:, None] * data["normal"]).sum(axis=0), 0, atol=1e-14)
        sides = Counter((a, b) for cell in cells for a, b in zip(cell, np.roll(cell, -1)))
        if case is PLANE:
            # A piece begins where another one ends.
            assert sorted(cell[0] for cell in cells) == sorted(cell[1] for cell in cells) == list(range(len(points)))
        else:
            assert set(sides.values()) == {1} and all((b, a) in sides for a, b in sides)


def test_loads_are_in_history_summary_and_stored_results(computed):
    case, folder, result = computed
    name = "disc" if case is PLANE else "ball"
    wall, load = result.surfaces[name], result.summary["bodies"][name]
    drag = (wall["area"] * wall["momentum_x"]).sum()
    unit = 0.5 * 1.2**2 * (1.6 if case is PLANE else 3)
    assert load["drag"] == pytest.approx(drag, rel=1e-13) and load["C_D"] == pytest.approx(drag / unit, rel=1e-13)
    assert result.history[f"C_D_{name}"][-1] == load["C_D"] and load["force"][0] == pytest.approx(load["drag"], rel=1e-14)
    stored = apsis.open(folder)
    assert stored == result and stored.summary["bodies"] == result.summary["bodies"]


def test_outlines_are_the_pieces_of_the_wall(computed):
    case, folder, result = computed
    if case is SPACE:
        return
    assert list(result.walls) == ["disc"]
    pieces = result.walls["disc"]
    assert len(pieces) == len(result.surfaces["disc"]["area"])
    # The points are on the circle and run around it counter-clockwise.
    np.testing.assert_allclose(np.hypot(pieces[..., 0] + 0.4, pieces[..., 1] - 0.1), 0.8, atol=1e-6)
    along = pieces[:, 1] - pieces[:, 0]
    out = pieces.mean(axis=1) - [-0.4, 0.1]
    assert np.all(out[:, 0] * along[:, 1] - out[:, 1] * along[:, 0] > 0)
    np.testing.assert_array_equal(read_result(folder).walls["disc"], pieces)
    changed = apsis.open(folder)
    changed.walls["disc"][0, 0, 0] += 1
    assert changed != result


def test_polygons_are_the_pieces_of_the_wall_in_space(computed):
    case, folder, result = computed
    if case is PLANE:
        return
    polygons, table = result.walls["ball"], result.surfaces["ball"]
    assert len(polygons) == len(table["area"]) and polygons.shape[2] == 3
    np.testing.assert_allclose(np.linalg.norm(polygons - [0.1, 0.2, 0], axis=2), 1.1, atol=1e-6)
    normals = np.stack([table[f"n_{axis}"] for axis in "xyz"], axis=1)
    np.testing.assert_allclose([vector_area(one) for one in polygons], table["area"][:, None] * normals, atol=1e-14)
    np.testing.assert_array_equal(read_result(folder).walls["ball"], polygons)
    assert apsis.open(folder) == result


def enclosed_area(segments):
    return 0.5 * np.cross(segments[:, 0], segments[:, 1]).sum()


@pytest.mark.parametrize("normal", range(3))
def test_a_plane_cuts_polygons_along_closed_lines_around_the_body(computed, normal):
    case, _, result = computed
    if case is PLANE:
        return
    for place in (-0.25, 0.0, 0.7):
        segments = cut_of(result.walls["ball"], normal, place)
        ends = np.round(segments, 9)
        assert sorted(map(tuple, ends[:, 0])) == sorted(map(tuple, ends[:, 1]))
        # The lines run counter-clockwise around a circle. The corners of a polygon are on the sphere of radius 1.1, in a cell of width
        # 0.5 with half a diagonal of 0.25 sqrt(3). So all points of the polygon have a radius of at least sqrt(1.1² − 3·0.25²).
        beside = (place - [0.1, 0.2, 0][normal])**2
        inner = np.sqrt(1.1**2 - 3 * 0.25**2)
        radii = np.sqrt(((segments - np.delete([0.1, 0.2, 0], normal))**2).sum(axis=2) + beside)
        assert inner < radii.min() and radii.max() < 1.1 + 1e-6
        assert np.pi * (inner**2 - beside) < enclosed_area(segments) < np.pi * (1.1**2 - beside)
    assert cut_of(result.walls["ball"], normal, 1.9).shape == (0, 2, 2)


@pytest.mark.parametrize("normal", range(3))
def test_slices_cover_what_the_wall_encloses(computed, normal):
    case, _, result = computed
    if case is PLANE:
        return
    edges = [np.linspace(-2, 2, 9)] * 3
    covered = 0
    for layer in range(1, 7):
        place = -1.75 + 0.5 * layer
        segments, hidden = cut_of(result.walls["ball"], normal, place), list(solid_cells(result.walls["ball"], edges, normal, place))
        parts = list(solid_parts(segments, edges[0], edges[1])) + hidden
        area = sum(0.5 * abs(np.cross(part, np.roll(part, -1, axis=0)).sum()) for part in parts)
        area += np.isnan(np.take(result.fields["rho"][-1], layer, axis=normal)).sum() * 0.25
        assert area == pytest.approx(enclosed_area(segments), rel=1e-12, abs=1e-12)
        covered += len(hidden)
    assert covered > 0  # some cells of gas have their middle in the body


def test_slices_show_the_outline_of_a_body(computed):
    case, folder, result = computed
    if case is PLANE:
        return
    made = figures(read_result(folder), "z=0.25")
    lines = [one for one in made["fields"].axes[0].collections if type(one).__name__ == "LineCollection"]
    np.testing.assert_allclose(np.array(lines[-1].get_segments()), cut_of(result.walls["ball"], 2, 0.25), atol=1e-14)


def test_pictures_show_outlines_and_coefficients(computed):
    case, folder, result = computed
    if case is SPACE:
        return
    made = figures(read_result(folder))
    lines = [one for one in made["fields"].axes[0].collections if type(one).__name__ == "LineCollection"]
    drawn = np.array(lines[-1].get_segments())
    np.testing.assert_array_equal(drawn, result.walls["disc"])
    labels = [axes.get_ylabel() for axes in made["surface-disc"].axes]
    assert labels == ["C_p (dimensionless)", "C_f (dimensionless)", "C_h (dimensionless)"]
    np.testing.assert_array_equal(np.concatenate([line.get_ydata() for line in made["surface-disc"].axes[0].lines]),
                                  result.surfaces["disc"]["C_p"])


def test_bodies_in_space_have_profiles_over_the_angle_to_the_stream(computed):
    case, folder, result = computed
    if case is PLANE:
        return
    wall = result.surfaces["ball"]
    figure = angle_profiles(read_result(folder), "ball", wall)
    assert [axes.get_ylabel() for axes in figure.axes] == ["C_p (dimensionless)", "C_f (dimensionless)", "C_h (dimensionless)"]
    line = figure.axes[0].lines[0]
    np.testing.assert_allclose(np.cos(np.radians(line.get_xdata())), -wall["n_x"], atol=1e-12)
    np.testing.assert_array_equal(line.get_ydata(), wall["C_p"])


def test_solid_parts_of_cut_cells_fill_what_the_wall_encloses(computed):
    case, _, result = computed
    if case is SPACE:
        return
    x, y = np.linspace(-2, 2, 17), np.linspace(-1.5, 2, 15)
    parts = list(solid_parts(result.walls["disc"], x, y))
    area = sum(0.5 * abs(np.cross(part, np.roll(part, -1, axis=0)).sum()) for part in parts)
    inside = np.isnan(result.fields["rho"][-1])[: , :]
    box = (x[:-1, None] >= 1) & (x[:-1, None] < 1.5) & (y[None, :-1] >= 0.5 - 1e-9) & (y[None, :-1] < 1 - 1e-9)
    area += (inside & ~box).sum() * 0.25**2
    pieces = result.walls["disc"]
    enclosed = 0.5 * (pieces[:, 0, 0] * pieces[:, 1, 1] - pieces[:, 0, 1] * pieces[:, 1, 0]).sum()
    assert area == pytest.approx(enclosed, rel=1e-12) and enclosed == pytest.approx(np.pi * 0.64, rel=0.02)


def test_the_part_behind_a_piece_is_on_its_left():
    square = np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]])
    half = behind(square, np.array([[0.25, 0], [0.25, 1]]))
    assert half[:, 0].max() == 0.25 and len(half) == 4
    assert len(behind(square, np.array([[2.0, 1], [2, 0]]))) == 0
