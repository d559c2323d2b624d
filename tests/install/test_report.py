"""Pictures as data, and the page that embeds them, from a small synthetic document."""
import base64
import contextlib
import io
import json
import math
import re
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "python"))
import apsis_picture  # noqa: E402
import apsis_report  # noqa: E402


def curve(label, x, y, style="line_and_markers", colour=-1):
    return {"label": label, "x": x, "y": y, "style": style, "colour": colour}


def panel(**changes):
    return {"title": "", "x_label": "Δt (dimensionless)", "y_label": "error", "log_x": True, "log_y": True,
            "slopes": [2], "curves": [], "maps": []} | changes


def picture(*panels):
    return {"name": "one", "title": "A <title>", "caption": "See & believe", "panels": list(panels)}


def claim(**changes):
    return {"id": "C1", "section": "one", "statement": "1 < 2", "how": "by hand", "holds": True, "error": "", "wall_s": 0.5,
            "findings": [{"what": "order", "value": 3.0, "condition": "3", "holds": True}],
            "tables": [{"title": "t", "columns": ["a & b"], "rows": [["x<y"]]}], "pictures": [], "remarks": []} | changes


def document(*claims):
    return {"version": "0", "paper": "p", "build": {"compiler": "c", "build_type": "b", "instruction_set": "i"},
            "machine": {"processor": "m", "threads": 2}, "wall_s": 1.0, "claims": list(claims)}


class Pictures(unittest.TestCase):
    def test_curves_leave_out_what_no_logarithm_can_show(self):
        data = panel(curves=[curve("a", [1, 0.5, 0.25, 0.125], [1, 0, None, -1])])
        figure = apsis_picture.draw(picture(data))
        (line,) = figure.axes[0].lines
        self.assertEqual(list(line.get_xdata()), [1.0])
        self.assertEqual(figure.axes[0].get_xlabel(), "Δt (dimensionless)")

    def test_a_slope_triangle_has_the_slope(self):
        for slope in (2, -5):
            data = panel(curves=[curve("a", [1, 0.1], [1, 0.1**slope])], slopes=[slope])
            figure = apsis_picture.draw(picture(data))
            (triangle,) = figure.axes[0].patches
            (x0, y0), (x1, _), (upright, y2) = triangle.get_xy()[:3]
            foot = x0 if upright == x1 else x1
            self.assertAlmostEqual(math.log(y2 / y0) / math.log(upright / foot), slope, places=12)
            low, high = figure.axes[0].get_ylim()
            self.assertTrue(low < y0 and y2 < high)

    def test_curves_of_one_colour_share_it_and_references_are_black(self):
        data = panel(curves=[curve("a", [1, 2], [1, 2], "line", 0), curve("", [1, 2], [2, 1], "dashed", 0),
                             curve("exact", [1, 2], [1, 1], "dash_dot", -2)])
        lines = apsis_picture.draw(picture(data)).axes[0].lines
        self.assertEqual(lines[0].get_color(), lines[1].get_color())
        self.assertEqual(lines[2].get_color(), "#000000")

    def test_maps_are_drawn_with_holes(self):
        data = panel(maps=[{"label": "slope", "x": [1, 10], "y": [1, 10, 100], "value": [[1, 2], [None, 3], [2, 2]],
                            "lowest": 0, "highest": 3}])
        figure = apsis_picture.draw(picture(data))
        self.assertEqual([t.get_text() for t in figure.axes[0].texts], ["1.0", "2.0", "3.0", "2.0", "2.0"])

    def test_the_script_writes_every_picture_of_a_file_and_names_a_bad_one(self):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "p.json").write_text(json.dumps(picture(panel(curves=[curve("a", [1, 2], [1, 4])]))))
            (folder / "bad.json").write_text("{}")
            text = io.StringIO()
            with contextlib.redirect_stdout(text), contextlib.redirect_stderr(text):
                self.assertEqual(apsis_picture.main([str(folder / "p.json")]), 0)
                self.assertEqual(apsis_picture.main([str(folder / "bad.json")]), 4)
                self.assertEqual(apsis_picture.main([str(folder / "none.json")]), 4)
            self.assertTrue((folder / "one.png").read_bytes().startswith(b"\x89PNG"))
            self.assertIn("bad.json", text.getvalue())


class Report(unittest.TestCase):
    def page(self, *claims):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            (folder / "reproduce.json").write_text(json.dumps(document(*claims)))
            with contextlib.redirect_stdout(io.StringIO()):
                self.assertEqual(apsis_report.main([name]), 0)
            return (folder / "report.html").read_text(encoding="utf-8")

    def test_nothing_is_loaded_from_outside(self):
        page = self.page(claim(pictures=[picture(panel(curves=[curve("a", [1, 2], [1, 4])]))]))
        for target in re.findall(r'(?:src|href)="([^"]*)"', page):
            self.assertRegex(target, r"^(data:|#)")
        inside = base64.b64decode(re.search(r"data:image/svg\+xml;base64,([^\"]+)", page).group(1)).decode()
        self.assertIn("<svg", inside)
        self.assertNotIn("url(http", page + inside)

    def test_text_is_escaped_and_captions_are_there(self):
        page = self.page(claim(pictures=[picture(panel(curves=[curve("a", [1, 2], [1, 4])]))]))
        self.assertIn("1 &lt; 2", page)
        self.assertIn("See &amp; believe", page)
        self.assertNotIn("A <title>", page)

    def test_a_failed_claim_shows_the_figure_that_fails(self):
        bad = {"what": "slope", "value": 1.25, "condition": "at least 2.85", "holds": False}
        page = self.page(claim(), claim(id="C2", holds=False, findings=[claim()["findings"][0], bad]),
                         claim(id="C3", holds=False, findings=[], error="it broke (why)"))
        self.assertIn("1 of 3 claims hold", page)
        self.assertIn("slope: 1.25 (at least 2.85)", page)
        self.assertIn("it broke (why)", page)

    def test_the_table_for_documentation_has_a_row_for_each_claim(self):
        table = apsis_report.markdown(document(claim(remarks=["misprint"]), claim(id="C2", statement="a | b", holds=False)))
        rows = re.findall(r"^\| (C\d+) \|", table, re.M)
        self.assertEqual(rows, ["C1", "C2"])
        self.assertIn("1 of 2 claims hold", table)
        self.assertIn("a \\| b", table)
        self.assertIn("- **C1** misprint", table)


if __name__ == "__main__":
    unittest.main()
