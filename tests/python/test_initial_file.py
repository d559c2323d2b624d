"""Initial data can be tables of other programs. All forms of HDF5 data are read, and columns that are not needed are ignored."""
import json

import apsis
import h5py
import numpy as np
import pytest

CELLS = 40
CASE = {"model": {"name": "bgk", "epsilon": 0.1}, "velocity": {"max": 8.0, "points": 24}, "space": {"cells": CELLS, "domain": [0, 1]},
        "time": {"end": 0.001, "dt": 0.001, "method": "md-imex-6-3"}}
X = (np.arange(CELLS) + 0.5) / CELLS
COLUMNS = {"x": X, "rho": 1 + 0.1 * np.sin(2 * np.pi * X), "u": 0.1 * np.cos(2 * np.pi * X), "T": np.ones(CELLS)}


def run(path, **initial):
    return apsis.run({**CASE, "initial": {"file": str(path), **initial}}).f


def write(path, how=lambda name: {}, columns=COLUMNS):
    with h5py.File(path, "w") as file:
        for name, values in columns.items():
            file.create_dataset(name, data=values, **how(name))
    return path


@pytest.fixture(scope="module")
def expected(tmp_path_factory):
    return run(write(tmp_path_factory.mktemp("plain") / "plain.h5"))


FILTERS = {"gzip": {"compression": "gzip"}, "lzf": {"compression": "lzf"}, "shuffle": {"shuffle": True, "chunks": (7,)},
           "all": {"compression": "gzip", "compression_opts": 9, "shuffle": True, "fletcher32": True, "chunks": (11,)},
           "lzf of large chunks": {"compression": "lzf", "shuffle": True, "chunks": (4096,), "maxshape": (None,)}}


@pytest.mark.parametrize("name", FILTERS)
def test_compressed_tables_are_read(name, tmp_path, expected):
    np.testing.assert_array_equal(run(write(tmp_path / "a.h5", lambda _: FILTERS[name])), expected)


def test_other_types_of_numbers_are_read(tmp_path):
    columns = {"x": X, "rho": np.full(CELLS, 2), "u": np.zeros(CELLS, ">f4"), "T": np.ones(CELLS, "u1")}
    same = {"x": X, "rho": np.full(CELLS, 2.0), "u": np.zeros(CELLS), "T": np.ones(CELLS)}
    np.testing.assert_array_equal(run(write(tmp_path / "a.h5", columns=columns)), run(write(tmp_path / "b.h5", columns=same)))


def add_text(file):
    file["comment"] = "written by hand"
    file["names"] = np.array([b"a"] * CELLS)
    file["words"] = ["é"] * CELLS


def add_dangling_links(file):
    file["lost"] = h5py.SoftLink("/nowhere")
    file["fields/lost"] = h5py.SoftLink("/nowhere")
    file["elsewhere"] = h5py.ExternalLink("missing.h5", "/rho")
    file["f"] = h5py.SoftLink("/nowhere")


def add_circles(file):
    file["a/b"] = np.zeros(3)
    file["a/again"] = file["/a"]
    file["fields"] = file["/"]
    file["a/up"] = h5py.SoftLink("/")


def add_other_objects(file):
    file["type"] = np.dtype("f8")
    file["flags"] = np.ones(CELLS, bool)
    file["pairs"] = np.zeros(CELLS, [("a", "f8"), ("b", "i4")])
    file["none"] = h5py.Empty("f8")
    file["complex"] = np.zeros(CELLS, complex)
    file["nan"] = np.full(CELLS, np.nan)
    file["short"] = np.zeros(3)
    file["n" * 3000] = np.zeros(CELLS)
    file.create_dataset("never", (CELLS,), "f8", chunks=(7,))
    file.create_dataset("huge", (2**40,), "f8", chunks=(1024,), compression="gzip")
    file["rho"].attrs["units"] = "dimensionless"
    file["nan"].attrs["units"] = 3.0


@pytest.mark.parametrize("add", [add_text, add_dangling_links, add_circles, add_other_objects])
def test_what_nobody_asks_for_is_ignored(add, tmp_path, expected):
    with h5py.File(write(tmp_path / "a.h5"), "a") as file:
        add(file)
    np.testing.assert_array_equal(run(tmp_path / "a.h5"), expected)


def test_links_to_columns_are_followed(tmp_path, expected):
    write(tmp_path / "other.h5")
    with h5py.File(tmp_path / "a.h5", "w") as file:
        for name, values in COLUMNS.items():
            file["data/" + name] = values
        file["x"] = h5py.SoftLink("/data/x")
        file["rho"] = file["data/rho"]
        file["u"] = h5py.ExternalLink("other.h5", "/u")
        file["fields"] = h5py.SoftLink("/data")
    np.testing.assert_array_equal(run(tmp_path / "a.h5"), expected)


def unwritten(path):
    with h5py.File(path, "w") as file:
        for name, values in COLUMNS.items():
            whole = file.create_dataset(name, (CELLS,), "f8", chunks=(10,))
            whole[:30 if name == "T" else CELLS] = values[:30 if name == "T" else CELLS]


def text(path):
    write(path, columns={**COLUMNS, "T": np.array([b"hot"] * CELLS)})


def huge(path):
    write(path, columns={name: values for name, values in COLUMNS.items() if name != "T"})
    with h5py.File(path, "a") as file:
        file.create_dataset("T", (2**40,), "f8", chunks=(1024,), compression="gzip", fillvalue=1.0)


def virtual(path):
    write(path.with_name("source.h5"))
    layout = h5py.VirtualLayout((CELLS,), "f8")
    layout[:] = h5py.VirtualSource("source.h5", "T", (CELLS,))
    write(path, columns={name: values for name, values in COLUMNS.items() if name != "T"})
    with h5py.File(path, "a") as file:
        file.create_virtual_dataset("T", layout)


def damaged(path):
    write(path, lambda _: {"compression": "gzip", "fletcher32": True})
    with h5py.File(path, "r") as file:
        place = file["T"].id.get_chunk_info(0).byte_offset
    content = bytearray(path.read_bytes())
    content[place + 5] ^= 0xFF
    path.write_bytes(content)


@pytest.mark.parametrize("make, message", [
    (unwritten, "'T' is incomplete (some of its numbers were never written); give another file"),
    (text, "it has no column 'T'"),
    (huge, "'T' claims more than 1000000000 numbers (damaged file); give another file"),
    (virtual, "'T' refers to numbers in other files (a virtual or external dataset); store its numbers in this file"),
    (damaged, "'T' cannot be read (damaged file); give another file")])
def test_columns_that_cannot_be_read_are_refused_by_name(make, message, tmp_path):
    make(tmp_path / "a.h5")
    with pytest.raises(apsis.InputError) as refused:
        run(tmp_path / "a.h5")
    assert message in str(refused.value)


def test_a_small_file_that_claims_to_be_large_is_refused_before_it_is_expanded(tmp_path):
    """A column may have only as many numbers as x. This file of some hundred bytes has a column of a gibibyte."""
    write(tmp_path / "a.h5", columns={name: values for name, values in COLUMNS.items() if name != "T"})
    with h5py.File(tmp_path / "a.h5", "a") as file:
        file.create_dataset("T", (2**27,), "f8", chunks=(2**20,), compression="gzip", fillvalue=1.0)
    with pytest.raises(apsis.InputError, match="'T' has 134217728 numbers and 'x' has 40 .each cell has one.; give as many"):
        run(tmp_path / "a.h5")


def test_values_that_the_file_gives_for_what_was_not_written_are_read(tmp_path, expected):
    write(tmp_path / "a.h5", columns={name: values for name, values in COLUMNS.items() if name != "T"})
    with h5py.File(tmp_path / "a.h5", "a") as file:
        file.create_dataset("T", (CELLS,), "f8", chunks=(7,), fillvalue=1.0)
    np.testing.assert_array_equal(run(tmp_path / "a.h5"), expected)


def test_a_compressed_copy_of_a_result_starts_as_the_result(tmp_path):
    apsis.run({**CASE, "initial": {"file": str(write(tmp_path / "a.h5"))}}, "output.every=0.0005", "time.dt=0.0005", out=tmp_path / "o")
    with h5py.File(tmp_path / "o/solution.h5") as old, h5py.File(tmp_path / "copy.h5", "w") as new:
        new.attrs["manifest"] = old.attrs["manifest"].decode() if isinstance(old.attrs["manifest"], bytes) else old.attrs["manifest"]
        new.attrs["t"] = old.attrs["t"]
        def copy(name, item):
            if isinstance(item, h5py.Dataset) and item.shape:
                new.create_dataset(name, data=item[...], compression="lzf", shuffle=True)
        old.visititems(copy)
    for more in ({}, {"time": 0.0005}):
        np.testing.assert_array_equal(run(tmp_path / "copy.h5", **more), run(tmp_path / "o/solution.h5", **more))


def test_columns_of_a_table_that_nobody_asks_for_may_have_anything(tmp_path, expected):
    rows = ["x,rho,u,T,label,error"]
    rows += [",".join([*(repr(float(COLUMNS[name][k])) for name in COLUMNS), "wall", "nan" if k else ""]) for k in range(CELLS)]
    (tmp_path / "a.csv").write_text("\n".join(rows))
    np.testing.assert_array_equal(run(tmp_path / "a.csv"), expected)
    rows[4] = rows[4].replace(",1.0,wall", ",warm,wall")
    (tmp_path / "b.csv").write_text("\n".join(rows))
    with pytest.raises(apsis.InputError, match="b.csv:5: 'warm' in column 'T' is not a finite number; change it"):
        run(tmp_path / "b.csv")


def test_messages_do_not_obey_a_file(tmp_path):
    """Messages escape control characters in names of columns, since a terminal would execute them."""
    (tmp_path / "a.csv").write_text("x,\x1b]0;owned\x07rho\n0.5,1\n")
    with pytest.raises(apsis.InputError) as refused:
        run(tmp_path / "a.csv")
    assert "\\u001b]0;owned\\u0007rho" in str(refused.value) and "\x1b" not in str(refused.value)
    assert json.dumps(str(refused.value))
