"""Report pages: their content, and their rendering in a browser."""
import base64
import json
import re
import shutil
import sys
from dataclasses import replace
from pathlib import Path

import apsis
import pytest
from apsis.report import __main__ as command
from apsis.report import make_report, page
from apsis.report.claims import markdown
from apsis.report.page import number
from apsis.plot.run_result import read_history, read_json, read_result
from apsis.plot.style import PictureError
from test_plot import curve, panel, picture

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))
from browser import Browser  # noqa: E402

SMALL = ("space.cells=12", "velocity.points=48", "time.end=0.01")


def claim(**changes):
    return {"id": "C1", "section": "one", "statement": "1 < 2", "how": "by hand", "holds": True, "error": "", "wall_s": 0.5,
            "findings": [{"what": "order", "value": 3.0, "condition": "3", "holds": True}],
            "tables": [{"title": "t", "columns": ["a & b"], "rows": [["x<y"]]}], "pictures": [], "remarks": []} | changes


def document(*claims):
    return {"version": "0", "paper": "p", "build": {"compiler": "c", "build_type": "b", "instruction_set": "i"},
            "machine": {"processor": "m", "threads": 2}, "wall_s": 1.0, "claims": list(claims)}


def page_of(folder):
    return make_report(folder).read_text(encoding="utf-8")


def page_of_claims(folder, *claims):
    (folder / "reproduce.json").write_text(json.dumps(document(*claims)), encoding="utf-8")
    return page_of(folder)


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """Makes a run whose title contains HTML markup, and returns its folder."""
    folder = tmp_path_factory.mktemp("run")
    apsis.run("paper/bgk-mixed", *SMALL, 'title="a <b> & \\"c\\""', out=folder)
    return folder


@pytest.fixture(scope="module")
def page_of_run(run):
    """Returns the page of this run, made once for all tests."""
    return page_of(run)


# --- a run -----------------------------------------------------------------------------------------------------------------------


def test_a_run_has_summary_promises_pictures_case_and_manifest(run, page_of_run):
    page = page_of_run
    manifest = json.loads((run / "manifest.json").read_text())
    assert f"after {manifest['result']['steps']} steps of <code>md-imex-6-3</code>" in page
    assert page.count("kept at every step") == 2 and page.count("not promised for this case") == 1
    assert f"largest relative defect {manifest['result']['conservation_defect']:.4g}" in page
    assert page.count("<img ") == 3
    assert "epsilon = &quot;1e-5 + tanh" in page  # the case file, as text
    assert f"<td>{manifest['build']['compiler']}</td>" in page
    for name in ("fields", "distribution", "history"):
        assert (run / "pictures" / f"{name}.png").read_bytes().startswith(b"\x89PNG")


def test_text_is_escaped(page_of_run):
    page = page_of_run
    assert "<h1>a &lt;b&gt; &amp; &quot;c&quot;</h1>" in page
    assert "<b>" not in page.replace("<figcaption><b>", "")


def test_a_broken_promise_is_reported(tmp_path):
    # No case breaks a promise, so the manifest is changed to that of a run that does.
    apsis.run("paper/bgk-mixed", *SMALL, out=tmp_path)
    manifest = json.loads((tmp_path / "manifest.json").read_text(encoding="utf-8"))
    manifest |= {"state": "failed", "message": "broken promise: 1 values are negative [step 3, t = 0.1]"}
    (tmp_path / "manifest.json").write_text(json.dumps(manifest), encoding="utf-8")
    page = page_of(tmp_path)
    assert "broken promise: " in page and ">failed<" in page
    assert "one was broken, see above" in page


def test_the_condition_of_a_law_is_a_promise(tmp_path):
    apsis.run("laws/dam-break", "space.cells=40", "time.end=0.1", out=tmp_path / "kept")
    kept = page_of(tmp_path / "kept")
    assert "subcharacteristic condition: every state satisfies this condition of the model" in kept
    assert kept.count("kept at every step") == 2  # conservation and the condition
    with pytest.raises(apsis.NumericalError):
        apsis.run("laws/dam-break", "space.cells=40", "model.speed=1.1", out=tmp_path / "broken")
    broken = page_of(tmp_path / "broken")
    assert "broken promise: model.speed = 1.1 is too small" in broken and "one was broken, see above" in broken


def test_a_run_in_the_plane_has_maps_probes_and_balances(tmp_path):
    apsis.run("gas/step", "space.cells=[18,12]", "velocity.points=14", "time.end=0.02", 'output.probe.1.name="rise"',
              "output.probe.1.from=[1,0]", "output.probe.1.to=[1,2]", "output.probe.1.points=5", out=tmp_path)
    page = page_of(tmp_path)
    assert "At the end, with contours" in page and "earlier snapshots in grey" in page
    assert page.count("<img ") == 3  # fields, history, probe
    history = read_history(tmp_path / "history.csv")
    drag = history["flux_step_momentum_x"][-1]
    assert re.search(rf"<td>step</td><td>[^<]*</td><td>{re.escape(number(drag))}</td>", page)
    assert "<th>momentum x</th>" in page
    assert "<h2>Velocities</h2>" in page and "smallest thermal speed over the spacing" in page


def test_a_run_without_space_shows_its_numbers(tmp_path):
    result = apsis.run("paper/ode", out=tmp_path)
    page = page_of(tmp_path)
    assert all(repr(float(x)) in page for x in result.f[0])


def test_equal_results_make_equal_pages(run, page_of_run):
    assert page_of(run) == page_of_run


# --- a reproduction ---------------------------------------------------------------------------------------------------------------


def test_captions_and_statements_are_escaped(tmp_path):
    page = page_of_claims(tmp_path, claim(pictures=[picture(panel(curves=[curve("a", [1, 2], [1, 4])]))]))
    assert "1 &lt; 2" in page and "See &amp; believe" in page and "A <title>" not in page


def test_a_failed_claim_shows_the_figure_that_fails(tmp_path):
    bad = {"what": "slope", "value": 1.25, "condition": "at least 2.85", "holds": False}
    page = page_of_claims(tmp_path, claim(), claim(id="C2", holds=False, findings=[claim()["findings"][0], bad]),
                          claim(id="C3", holds=False, findings=[], error="it broke (why)"))
    assert "1 of 3 claims hold" in page and "slope: 1.25 (at least 2.85)" in page and "it broke (why)" in page


def test_the_table_for_documentation_has_a_row_for_each_claim():
    table = markdown(document(claim(remarks=["misprint"]), claim(id="C2", statement="a | b", holds=False)))
    assert re.findall(r"^\| (C\d+) \|", table, re.M) == ["C1", "C2"]
    assert "1 of 2 claims hold" in table and "a \\| b" in table and "- **C1** misprint" in table


# --- a validation -----------------------------------------------------------------------------------------------------------------


def page_of_validation(folder, **changes):
    value = {"settings": ["delta=1"], "value": 0.6009, "reference": 0.6007, "origin": "published", "difference": 3.3e-4, "tolerance": 1e-3, "holds": True,
             "wall_s": 0.5} | changes
    quantity = {"name": "couette", "description": "stress < 1", "source": "Willis & others", "values": [value],
                "pictures": [picture(panel(curves=[curve("a", [1, 2], [1, 4])]))]}
    content = {**document(), "quantities": [quantity]}
    (folder / "validate.json").write_text(json.dumps(content), encoding="utf-8")
    return page_of(folder)


def test_a_validation_shows_every_value_with_its_verdict(tmp_path):
    good = page_of_validation(tmp_path)
    assert "1 of 1 reference values are met." in good and "stress &lt; 1" in good and "Willis &amp; others" in good
    assert "+3.3e-04" in good and 'class="yes"' in good and 'class="no"' not in good
    bad = page_of_validation(tmp_path, value=None, difference=None, holds=False)
    assert "0 of 1 reference values are met; those that are not are marked" in bad and "not a number" in bad and 'class="no"' in bad


# --- every page ------------------------------------------------------------------------------------------------------------------


def test_no_external_resource_is_loaded(page_of_run, tmp_path):
    claims = claim(pictures=[picture(panel(curves=[curve("a", [1, 2], [1, 4])]))])
    (tmp_path / "claims").mkdir()
    for page in (page_of_run, page_of_claims(tmp_path / "claims", claims), page_of_validation(tmp_path)):
        targets = re.findall(r'(?:src|href)="([^"]*)"', page)
        assert targets and all(re.match(r"data:|#", target) for target in targets)
        inside = [base64.b64decode(data).decode() for data in re.findall(r"data:image/svg\+xml;base64,([^\"]+)", page)]
        assert inside and all("<svg" in image for image in inside)
        assert not any("url(http" in part for part in (page, *inside))


def test_a_folder_without_results_is_refused_and_stays_empty(tmp_path, capsys):
    (tmp_path / "empty").mkdir()
    (tmp_path / "damaged").mkdir()
    (tmp_path / "damaged" / "reproduce.json").write_text(json.dumps({"claims": [{"id": "C1"}]}))
    for name in ("empty", "damaged", "nothing"):
        assert command.main([str(tmp_path / name)]) == 4
        assert name in capsys.readouterr().err
        assert not (tmp_path / name / "report.html").exists()
    with pytest.raises(PictureError):
        make_report(tmp_path / "empty")


# --- in a browser ----------------------------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def chromium():
    browser = Browser()
    yield browser
    browser.quit()


@pytest.mark.parametrize("width", [400, 1600])
@pytest.mark.parametrize("kind", ["run", "study", "claims"])
def test_a_browser_shows_it_legibly_without_requests(chromium, run, page_of_run, tmp_path, kind, width):
    if kind == "run":
        page = run / "report.html"
    elif kind == "study":
        data = {"apsis": "0", "state": "complete", "study": {"case": "paper/ode", "measure": "l2 norm", "runs": 2}, **document()}
        (tmp_path / "manifest.json").write_text(json.dumps(data))
        (tmp_path / "converge.json").write_text(json.dumps([{"time.dt": 0.5, "error": 1e-3, "rate": None}, {"error": 1e-4}]))
        (tmp_path / "picture.json").write_text(json.dumps(picture(panel(curves=[curve("a", [1, 2], [1, 4])]))))
        page = make_report(tmp_path)
    else:
        long_words = claim(statement="w" * 300, tables=[{"title": "t", "columns": ["c"] * 20, "rows": [["number"] * 20]}],
                           pictures=[picture(*3 * [panel(curves=[curve("a", [1, 2], [1, 4])])])])
        page_of_claims(tmp_path, long_words)
        page = tmp_path / "report.html"
    seen = chromium.show(page, width)
    assert seen["window"] == width
    assert seen["content"] <= width  # no horizontal scrolling of the page; wide tables and pictures scroll on their own
    assert seen["broken"] == 0
    assert seen["drawn"] * 10 * 4 / 3 >= 7.5  # height in pixels of 10-point letters in pictures
    assert seen["letters"] >= 12 and seen["paragraph"] <= 62 * 16  # pixels: size of small print, width of lines of text
    assert chromium.console() == []
    assert [url for url in chromium.requests() if not url.startswith(("data:", page.as_uri()))] == []


def test_the_browser_test_detects_a_bad_page(chromium, tmp_path):
    page = tmp_path / "bad.html"
    page.write_text('<meta charset="utf-8"><p>x</p><img src="gone.png"><div style="width: 5000px">w</div><script>undefined.x</script>')
    seen = chromium.show(page, 400)
    assert seen["content"] > 400 and seen["broken"] == 1
    assert any("gone.png" in url for url in chromium.requests())
    assert chromium.console() != []


# --- results that come from others -----------------------------------------------------------------------------------------------

SCRIPT = "<script>alert(1)</script>"


def leaves(document, path=()):
    """Yields the paths of all values and keys of a JSON document."""
    inner = document.items() if isinstance(document, dict) else enumerate(document) if isinstance(document, list) else ()
    for key, value in inner:
        yield (*path, key)
        yield from leaves(value, (*path, key))


def replaced(document, path, value):
    changed = json.loads(json.dumps(document))
    at = changed
    for key in path[:-1]:
        at = at[key]
    at[path[-1]] = value
    return changed


def renamed(document, path):
    changed = json.loads(json.dumps(document))
    at = changed
    for key in path[:-1]:
        at = at[key]
    if isinstance(at, dict):
        at[SCRIPT] = at[path[-1]]
    return changed


def attacks(document):
    for path in leaves(document):
        yield path, replaced(document, path, SCRIPT)
        yield path, replaced(document, path, [SCRIPT])
        yield path, renamed(document, path)


def check_pages(folder, name, document, monkeypatch):
    """Checks that no value and no name of a document is markup in the page. Documents that cannot be shown raise PictureError."""
    # Pictures are left out: they are separate images and take seconds.
    monkeypatch.setattr("apsis.report.run.figures", lambda result: {})
    for module in ("claims", "study", "validation"):
        monkeypatch.setattr(f"apsis.report.{module}.page.embedded", lambda figure, *words: f"<p>{page.text(' '.join(map(str, words[:3])))}</p>")
        monkeypatch.setattr(f"apsis.report.{module}.draw", lambda picture: None)
    shown = 0
    for path, changed in attacks(document):
        (folder / name).write_text(json.dumps(changed), encoding="utf-8")
        try:
            html = page_of(folder)
        except PictureError:
            continue
        shown += 1
        assert "<script" not in html, path
        markdown_page = folder / "claims.md"
        assert not markdown_page.exists() or "<script" not in markdown_page.read_text(encoding="utf-8").replace("\\<script", ""), path
    assert shown > 10


def test_no_value_of_a_manifest_is_markup(run, tmp_path, monkeypatch):
    stored = read_result(run)  # read only once, since this takes most of the time
    monkeypatch.setattr("apsis.report.run.read_result", lambda folder: replace(stored, manifest=read_json(folder / "manifest.json")))
    check_pages(tmp_path, "manifest.json", stored.manifest, monkeypatch)


def test_no_value_of_a_reproduction_is_markup(tmp_path, monkeypatch):
    check_pages(tmp_path, "reproduce.json", document(claim(), claim(id="C2", holds=False, error="e", remarks=["r"])), monkeypatch)


def test_no_value_of_a_validation_is_markup(tmp_path, monkeypatch):
    value = {"settings": ["a=1"], "value": 1.0, "reference": 1.1, "origin": "theory", "difference": 0.1, "tolerance": 0.2, "holds": True, "wall_s": 1.0}
    given = {**document(), "quantities": [{"name": "q", "description": "d", "source": "s", "values": [value], "pictures": []}]}
    check_pages(tmp_path, "validate.json", given, monkeypatch)


def test_no_value_of_a_study_is_markup(tmp_path, monkeypatch):
    manifest = {"apsis": "0", "build": document()["build"], "machine": document()["machine"], "state": "complete",
                "study": {"case": "c", "runs": 2, "measure": "m"}}
    (tmp_path / "converge.json").write_text(json.dumps([{"dt": 0.1, SCRIPT: SCRIPT}]), encoding="utf-8")
    check_pages(tmp_path, "manifest.json", manifest, monkeypatch)


def test_columns_of_a_history_are_text(run, tmp_path):
    shutil.copytree(run, tmp_path / "run")
    path = tmp_path / "run/history.csv"
    header, *rows = path.read_text(encoding="utf-8").splitlines()
    path.write_text("\n".join([f"{header},total_{SCRIPT},flux_{SCRIPT}_{SCRIPT}", *(f"{row},1,1" for row in rows)]), encoding="utf-8")
    assert "<script" not in page_of(tmp_path / "run")


def test_titles_of_results_are_not_formulas(run, tmp_path):
    """Matplotlib would take $…$ as a formula and fail if it is not valid."""
    shutil.copytree(run, tmp_path / "run")
    manifest = json.loads((run / "manifest.json").read_text(encoding="utf-8"))
    manifest["case"]["title"] = r"costs $\frac{ and $1 \x1b[31m"
    (tmp_path / "run/manifest.json").write_text(json.dumps(manifest), encoding="utf-8")
    assert page_of(tmp_path / "run").count("<img ") == 3


def test_files_are_not_written_through_links(run, tmp_path):
    shutil.copytree(run, tmp_path / "run")
    mine = tmp_path / "mine"
    mine.write_text("precious")
    shutil.rmtree(tmp_path / "run/pictures", ignore_errors=True)
    (tmp_path / "run/pictures").mkdir()
    for name in (".report.html.partial", "report.html", "pictures/.fields.png.partial", "pictures/fields.png"):
        (tmp_path / "run" / name).unlink(missing_ok=True)
        (tmp_path / "run" / name).symlink_to(mine)
    page_of(tmp_path / "run")
    assert mine.read_text() == "precious"
    assert not any(path.is_symlink() for path in (tmp_path / "run").rglob("*"))
    shutil.rmtree(tmp_path / "run/pictures")
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "run/pictures").symlink_to(tmp_path / "elsewhere")
    with pytest.raises(PictureError, match="is a symbolic link .*; remove it"):
        make_report(tmp_path / "run")
    assert not list((tmp_path / "elsewhere").iterdir())


def test_names_of_pictures_stay_in_their_folder(tmp_path):
    damaged = picture(panel(curves=[curve("a", [1, 0.5], [1, 0.5])])) | {"name": "../../escape"}
    with pytest.raises(PictureError, match="names a picture '../../escape'"):
        page_of_claims(tmp_path, claim(pictures=[damaged]))


def test_messages_do_not_obey_a_file(tmp_path, capsys):
    folder = tmp_path / "\x1b[31mred"
    folder.mkdir()
    assert command.main([str(folder)]) == 4
    told = capsys.readouterr().err
    assert "\x1b" not in told and "\\u001b[31mred" in told


def test_a_steady_run_reports_its_rate_and_its_distance(tmp_path):
    apsis.run("gas/fourier", "space.cells=8", "velocity.points=32", "parameters.delta=5", "time.steady=1e-3", "time.end=50", out=tmp_path / "r")
    steady = json.loads((tmp_path / "r/manifest.json").read_text())["result"]["steady"]
    assert steady["reached"] and steady["change"] <= 1e-3
    assert steady["distance"] == pytest.approx(steady["change"] * steady["decay_time"])
    page = page_of(tmp_path / "r")
    assert f"time.steady is reached: the state changes by {steady['change']:.4g} per unit of time" in page
    assert f"the state is {steady['distance']:.4g} from its limit" in page
