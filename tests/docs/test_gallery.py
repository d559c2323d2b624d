"""The gallery makes cases small and quotes commands so that a shell can repeat them. Every case has a picture, every method a page."""
import json
import os
import re
import shlex
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("APSIS_BUILD", ROOT / "build" / "release"))
sys.path.insert(0, str(ROOT / "docs"))
import gallery  # noqa: E402
import reference  # noqa: E402

PROGRAM = reference.Program(BUILD / "app" / "apsis")


class SmallVersions(unittest.TestCase):
    def test_cost_is_steps_times_unknowns_times_stages(self):
        log = "info: gas/x: needs 3 MB of memory (20 x 10 cells x 64 unknowns)\ninfo: gas/x: about 100 steps of a on 1 thread\n"
        self.assertEqual(gallery.expected_cost(log), 100 * 200 * 64 * gallery.STAGES)
        self.assertEqual(gallery.expected_cost("info: paper/ode: about 128 steps of md-imex-6-3"), 0.0)

    def test_fewer_cells_keep_the_shape_and_cost_what_is_wanted(self):
        for cells, cost in (([200], 1e12), ([72, 36], 1.7e10), ([64, 64, 64], 1e13)):
            small = gallery.fewer_cells(cells, cost)
            ratio = small[0] / cells[0]
            # Numbers of cells are rounded to even numbers, by at most one cell. Of 36 cells and more, ratios differ by less than this.
            for a, b in zip(small, cells):
                self.assertAlmostEqual(a / b, ratio, delta=0.125)
                self.assertGreaterEqual(a, min(b, gallery.FEWEST))
            if min(small) > gallery.FEWEST:
                self.assertAlmostEqual(cost * ratio ** (len(cells) + 1) / gallery.BUDGET, 1.0, delta=0.3)
        self.assertEqual(gallery.fewer_cells([37], gallery.BUDGET / 2), [37])

    def test_a_case_is_made_small_and_drawn_and_kept(self):
        with tempfile.TemporaryDirectory() as folder:
            one = gallery.Gallery(PROGRAM.path, Path(folder))
            entry = one.make("gas/couette", "Couette flow")
            self.assertEqual(entry.changes[0], "steady.tolerance=1e-6")  # the case ends in a steady state
            self.assertTrue(entry.picture.read_bytes().startswith(b"\x89PNG"))
            self.assertGreater(entry.seconds, 0.0)
            made = entry.picture.stat().st_mtime_ns
            self.assertEqual((one.make("gas/couette", "Couette flow"), entry.picture.stat().st_mtime_ns), (entry, made))
            words = shlex.split(gallery.command(entry))
            self.assertEqual(words, ["apsis", "run", "gas/couette", *entry.changes])
            self.assertEqual(json.loads(entry.changes[1].partition("=")[2]), gallery.FIELDS[0])

    def test_a_case_that_fails_is_named(self):
        with tempfile.TemporaryDirectory() as folder, self.assertRaisesRegex(gallery.GalleryError, "^apsis run gas/sod space.cells=0 fails: error: "):
            gallery.Gallery(PROGRAM.path, Path(folder)).run("gas/sod", ["space.cells=0"], Path(folder) / "run")


class Methods(unittest.TestCase):
    def test_every_page_has_properties_use_steps_and_coefficients(self):
        choices = PROGRAM.list("choices")
        for m in PROGRAM.list("methods"):
            page = reference.method(PROGRAM, m, choices)
            self.assertEqual(re.findall("^##? (.*)$", page, re.M), [m["name"], "When to use it", "Steps", "Coefficients"])
            self.assertIn(f"SSP coefficient: {reference.coefficient(m)}", page)
            self.assertEqual(m["name"] in {choice["name"] for choice in choices}, "chooses it for" in page, m["name"])
            # Coefficients are a picture of the tableau, or formulas.
            self.assertTrue("-tableau.png" in page or "$$" in page, m["name"])

    def test_the_list_links_every_page(self):
        page = reference.methods(PROGRAM)
        for m in PROGRAM.list("methods"):
            self.assertIn(f"[{m['name']}](methods/{m['name']}.md)", page)


if __name__ == "__main__":
    unittest.main()
