"""The plot script on a small synthetic result folder whose numbers are known."""
import contextlib
import io
import json
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python"))
import apsis_plot  # noqa: E402


def write_result(folder, cells, shift=0.0):
    """rho = 1 + x + shift as averages over equal cells of [0, 2]; two snapshots, the first one garbage."""
    folder.mkdir(parents=True)
    x = (np.arange(cells) + 0.5) * 2 / cells
    lines = ["t,x,rho,u,T"] + [f"0,{a!r},-7,-7,-7" for a in x.tolist()]
    lines += [f"0.5,{a!r},{1 + a + shift!r},0.25,{2 - a / 2!r}" for a in x.tolist()]
    (folder / "fields.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    (folder / "history.csv").write_text(
        "step,t,dt,min_value,negative_values,conservation_mass,entropy,entropy_change\n"
        "0,0,0,0.5,0,0,,\n1,0.25,0.25,0.4,0,1e-16,,\n2,0.5,0.25,0.3,0,0,,\n", encoding="utf-8")
    (folder / "manifest.json").write_text(json.dumps({"title": "synthetic"}), encoding="utf-8")
    v = np.linspace(-3, 3, 9)
    with h5py.File(folder / "solution.h5", "w") as file:
        file["x"], file["v"] = x, v
        file["fields/rho"] = np.zeros(cells)  # a group beside the arrays
        file["epsilon"] = np.full(cells, 1e-3)
        file["f"] = np.exp(-(v**2))[None, :] * (1 + x)[:, None]
    return x


def quietly(*arguments):
    """Exit code and everything printed."""
    text = io.StringIO()
    with contextlib.redirect_stdout(text), contextlib.redirect_stderr(text):
        code = apsis_plot.main([str(a) for a in arguments])
    return code, text.getvalue()


class Plot(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.root = Path(holder.name)

    def assert_pictures(self, *names):
        for name in names:
            picture = self.root / "out" / name
            self.assertEqual(picture.read_bytes()[:8], b"\x89PNG\r\n\x1a\n", name)
            image = apsis_plot.plt.imread(picture)[..., :3]
            self.assertGreater(float(image.std()), 0.01, f"{name} is blank")

    def test_reads_the_last_snapshot_only(self):
        x = write_result(self.root / "a", 8)
        fields = apsis_plot.read_result(self.root / "a").fields()
        np.testing.assert_array_equal(fields["rho"], 1 + x)
        self.assertNotIn("t", fields)

    def test_draws_fields_phase_space_and_history_of_a_case(self):
        write_result(self.root / "a", 8)
        code, _ = quietly("case", self.root / "a", "--out", self.root / "out")
        self.assertEqual(code, 0)
        self.assert_pictures("a-fields.png", "a-f.png", "a-history.png")

    def test_three_speeds_make_no_phase_space_and_six_fields_two_rows(self):
        folder = self.root / "a"
        write_result(folder, 8)
        with h5py.File(folder / "solution.h5", "a") as file:
            del file["v"], file["f"]
            file["v"], file["f"] = np.array([1.0, 0.0, -1.0]), np.ones((8, 3))
        names = ["rho", "m", "z", "f_plus", "f_0", "f_minus"]
        lines = [",".join(["t", "x", *names])] + [f"0,{i / 8},{i},1,2,3,4,5" for i in range(8)]
        (folder / "fields.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
        code, text = quietly("case", folder, "--out", self.root / "out")
        self.assertEqual(code, 0)
        self.assertFalse((self.root / "out" / "a-f.png").exists())
        for name in names:
            self.assertIn(apsis_plot.label_of(name), text)
        height, width = apsis_plot.plt.imread(self.root / "out" / "a-fields.png").shape[:2]
        self.assertLess(width / height, 2.0)

    def test_mixed_figure_states_the_differences_on_common_cells(self):
        # rho is linear, so the mean of two fine cells is exactly the coarse value: only the shifts remain.
        write_result(self.root / "two", 8, shift=0.125)
        write_result(self.root / "three", 8, shift=-0.125)
        write_result(self.root / "ref", 16)
        code, text = quietly("mixed", "--second", self.root / "two", "--third", self.root / "three", "--reference",
                             self.root / "ref", "--out", self.root / "out")
        self.assertEqual(code, 0)
        self.assertIn("rho: second against third order 2.50e-01, to the reference 1.25e-01 and 1.25e-01", text)
        self.assertIn("density ρ (dimensionless)", text)  # axis ranges are printed under their labels
        self.assert_pictures("bgk-mixed.png", "three-fields.png")

    def test_a_folder_that_is_missing_or_broken_is_named(self):
        code, text = quietly("case", self.root / "nowhere")
        self.assertEqual(code, 4)
        self.assertIn("nowhere", text)
        write_result(self.root / "a", 4)
        for content in ("", "x,rho\n", "x,rho\n1,abc\n", "x,rho\n1\n2,3\n"):
            (self.root / "a" / "fields.csv").write_text(content, encoding="utf-8")
            code, text = quietly("case", self.root / "a")
            self.assertEqual(code, 4, repr(content))
            self.assertIn("fields.csv", text)


if __name__ == "__main__":
    unittest.main()
