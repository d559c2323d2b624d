#!/usr/bin/env python3
"""Makes tables and pictures of the measurements of `make bench`.

    bench/report.py [--results results/bench/speed.json] [--docs docs] [--readme README.md]

Copies the results, if there are any, to DOCS/data/speed/PROCESSOR.json.gz. Writes the tables of the newest file there between the
marks <!-- NAME --> and <!-- end --> of the pages of PAGES, and tables longer than a screen to DOCS/data/speed/NAME.csv. Draws
DOCS/images/speed-*.png. Writes the table that compares processors into DOCS/speed.md, and its rows of the front page into the README.
"""
import argparse
import csv
import json
import re
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import pictures  # noqa: E402
import records  # noqa: E402
import scaling_model  # noqa: E402


# Pages of tables; all others belong to MEASURED.
PAGES = {"bodies": "cut-cells.md", "collisions": "speed.md", "device": "device.md", "dimensions": "speed.md", "flows": "speed.md",
         "overhead": "speed.md", "processes": "scaling.md", "steady": "steady-method.md", "transit": "speed.md"}
MEASURED = "speed-measured.md"
SCREEN = 30  # rows of a page; longer tables are files


class ReportError(Exception):
    """Results are missing or invalid, or a document has no place for them."""


# --- tables ----------------------------------------------------------------------------------------------------------------------


def number(cell):
    if cell is None:
        return "—"
    return f"{cell:.3g}" if isinstance(cell, float) else str(cell)


def markdown(columns, rows):
    lines = ["| " + " | ".join(columns) + " |", "|" + "---|" * len(columns)]
    return "\n".join(lines + ["| " + " | ".join(number(cell) for cell in row) + " |" for row in rows])


def processor(result):
    return " ".join(re.sub(r"\([^)]*\)|Processor|@.*", " ", result["machine"]["processor"]).split())


def extent(values):
    return " to ".join(str(value) for value in sorted({min(values), max(values)}))


def measured_on(*results):
    """States when and how some tables of one machine were measured."""
    machine = results[0]["machine"]
    return (f"{extent([date_of(result)[:10] for result in results])}, {processor(results[0])}, {machine['cores']} cores, "
            f"kernels {machine['kernels']}, {machine['compiler']}, median of {extent([result['repeats'] for result in results])}")


def section(name, result):
    """Returns note, table and date. Of a table longer than a screen the page has the rows of the best contestants, if these fit, and
    the place of the whole."""
    rows, place = result["rows"], ""
    if len(rows) > SCREEN:
        place = f"All {len(rows)} rows are in [data/speed/{name}.csv](data/speed/{name}.csv).\n\n"
        rows = [row for row in rows if str(row[0]).startswith("best ")]
    table = f"{markdown(result['columns'], rows)}\n\n" if rows else ""
    return f"{result['note']}\n\n{table}{place}*{measured_on(result)}*"


def write_long_tables(results, folder):
    """Writes tables that are longer than a screen as FOLDER/NAME.csv, and removes those that no longer are."""
    for path in folder.glob("*.csv"):
        path.unlink()
    for name, result in results.items():
        if len(result["rows"]) > SCREEN:
            with open(folder / f"{name}.csv", "w", encoding="utf-8", newline="") as file:
                csv.writer(file, lineterminator="\n").writerows([result["columns"], *([number(cell) for cell in row] for row in result["rows"])])


def replace(path, name, text):
    before = path.read_text(encoding="utf-8")
    pattern = re.compile(rf"(<!-- {re.escape(name)} -->\n).*?(<!-- end -->)", re.S)
    if not pattern.search(before):
        raise ReportError(f"{path} has no place <!-- {name} -->")
    path.write_text(pattern.sub(lambda found: found.group(1) + "\n" + text + "\n\n" + found.group(2), before), encoding="utf-8")


def date_of(result):
    return result["machine"]["date"]


def rows_where(result, **wanted):
    at = {name: k for k, name in enumerate(result["columns"])}
    return [dict(zip(result["columns"], row)) for row in result["rows"]
            if all(row[at[name]] == value for name, value in wanted.items())]


def against(result, label, errors, epsilon=None):
    """Formats the time of the row `label` relative to the best method of Apsis."""
    row = next(row for row in result["rows"] if label in row and (epsilon is None or row[0] == epsilon))
    ratios = []
    for error in errors:
        cell = row[next(k for k, name in enumerate(result["columns"]) if name.startswith(f"error {error} "))]
        found = re.search(r"\(([^()]*)\)\s*$", cell or "") or re.fullmatch(r"\(?([0-9.e+]+)\)?", cell or "")
        ratios.append(f"{found.group(1)}" if found else "—")
    return f"{', '.join(ratios)} times the CPU time of the best method of Apsis"


# Tables of contests, in the order of the table of winners.
CONTESTS = {"peers-ode": "ODE model", "peers-prothero-robinson": "Prothero–Robinson", "peers-kaps": "Kaps",
            "peers-broadwell": "Broadwell",
            "peers-mixed-points": "mixed BGK, point values", "peers-mixed": "mixed BGK, cell averages",
            "peers-mixed-centres": "mixed BGK, cell averages, collisions at centres"}


def winner(result, error, epsilon):
    """Returns the cheapest run of Apsis for an error, and how many times its time the best of other programs and explicit SSP
    methods needs, and the best of the baselines."""
    column = next((k for k, name in enumerate(result["columns"]) if name.startswith(f"error {error} ")), None)
    if column is None:
        return ""
    unit = re.search(r"\((.*)\)", result["columns"][column]).group(1)
    rows = {row[1 if epsilon else 0]: row[column] for row in result["rows"] if not epsilon or row[0] == epsilon}
    best = rows.get("best of Apsis")
    if not best or best == "—":
        return "—"
    time, name = best.split(" ", 1)
    name, _, how = name.partition(", ")
    scale, shown = (1e3, "ms") if unit == "s" else (1.0, unit)

    def ratio(label):
        found = re.search(r"\(([^()]*)\)$", rows.get(label) or "")
        return found.group(1) if found else "—"
    return f"`{name}`{' ' + how if how else ''} {scale * float(time):.3g} {shown}; {ratio('best of the others')}, {ratio('best of the baselines')}"


def winners(results):
    """Tabulates problem × ε × error with the cheapest method of Apsis, its time and the ratio to the best of the others."""
    errors = ("0.001", "0.0001", "1e-05", "1e-06", "1e-07", "1e-08", "1e-09")
    rows = []
    for table, problem in CONTESTS.items():
        if table not in results or not rows_labelled(results[table], "best of Apsis"):
            continue
        result = results[table]
        for epsilon in dict.fromkeys(row[0] for row in result["rows"]) if result["columns"][0] == "ε" else (None,):
            rows.append([problem, epsilon or "10⁻⁵ … 1.5", *(winner(result, error, epsilon) for error in errors)])
    return markdown(("problem", "ε", *errors), rows)


def rows_labelled(result, label):
    return [row for row in result["rows"] if label in row[:2]]


def summary(results):
    """Returns the rows of the table that compares processors."""
    rows = []
    if "throughput" in results:
        for formulation in ("finite-difference", "finite-volume"):
            found = rows_where(results["throughput"], formulation=formulation, method="md-imex-3-2", threads=1)
            for row in found:
                rows.append((f"{formulation.replace('-', ' ')}s, second-order step with limiter, 1000 × 150, one core",
                             f"{row['point·stages/s']:.2g} point·stages/s, {row['of the binding ceiling']} of the binding ceiling"))
    if "flows" in results:
        rows += [(f"flow `{row['case']}` as shipped, one core",
                  f"{row['point·stages/s']:.2g} point·stages/s, {row['ratio']} times those of the gas between periodic ends")
                 for case in FLOWS for row in rows_where(results["flows"], case=case)[:1]]
    if "threads" in results:
        found = rows_where(results["threads"], N=400)
        rows.append(("speedup by two threads, N = 400 (multiply–adds in registers with as many barriers)",
                     ", ".join(f"{row['formulation'].replace('-', ' ')}s {row['ratio']} ({row['in steps']})" for row in found)))
    if "plain" in results:
        rows.append(("mixed-regime run, N = 40, relative to plain loops, orders 2 and 3",
                     ", ".join(f"{row['plain/library']:.1f}" for row in rows_where(results["plain"])) + " times as fast"))
        if "native/library" in results["plain"]["columns"]:
            rows.append(("mixed-regime run, N = 40, relative to plain loops with -march=native -ffast-math, orders 2 and 3",
                         ", ".join(f"{row['native/library']:.1f}" for row in rows_where(results["plain"])) + " times as fast"))
    if "overhead" in results:
        rows.append(("step of a system of two unknowns, relative to hand-written code",
                     f"{results['overhead']['rows'][1][2]} times as long"))
    if "peers-mixed" in results:
        rows += [(f"mixed-regime run, {who}, at temporal errors 3e-4 and 1e-4", against(results["peers-mixed"], label, ("0.0003", "0.0001")))
                 for who, label in (("best of SUNDIALS and SSP-RK3 with f ≥ 0", "best of the others with least ≥ 0"),
                                    ("best of SUNDIALS and SSP-RK3 with f of any sign", "best of the others"))]
    if "peers-ode" in results:
        result = results["peers-ode"]
        rows += [(f"ODE model, ε = {epsilon}, best of other integrators at errors 1e-4 and 1e-6",
                  against(result, "best of the others", ("0.0001", "1e-06"), epsilon)) for epsilon in ("1", "0.01", "1e-06", "1e-10")]
    return rows


# Measures in the README; docs/speed.md has all of them.
FRONT_PAGE = ("mixed-regime run, N = 40, relative to plain loops, orders", "mixed-regime run, best of SUNDIALS and SSP-RK3 with f of any sign")
# Flows of the table that compares processors.
FLOWS = ("gas/sod", "gas/couette", "gas/poiseuille", "gas/cavity", "gas/step", "gas/duct")


def any_of(results):
    return next(iter(results.values()))


def comparison(machines, selection=("",)):
    """Tabulates the summaries of several machines side by side, restricted to measures that start with a selected text."""
    columns = [dict(summary(results)) for results in machines]
    measures = [measure for measure in dict.fromkeys(measure for column in columns for measure in column)
                if measure.startswith(selection)]
    table = markdown(("measure", *(processor(any_of(results)) for results in machines)),
                     [(measure, *(column.get(measure) for column in columns)) for measure in measures])
    return table + "\n\n" + "<br>\n".join(f"*{measured_on(*results.values())}.*" for results in machines)


# --- main ------------------------------------------------------------------------------------------------------------------------


# Leagues of methods of Apsis that the pictures show as one contestant.
GROUPS = {"Apsis": ("ssp", "any sign", "adaptive"), "Apsis, with SSP coefficient": ("ssp",), "Apsis, steps by tolerance": ("adaptive",)}


def grouped(points):
    """Replaces the methods of Apsis by three groups."""
    others = [point for point in points if point.get("league", "other") in ("other", "baseline")]
    return others + [point | {"contestant": group}
                     for group, leagues in GROUPS.items() for point in points if point.get("league") in leagues]


def tolerance_runs(points):
    """Returns ε, method, steps, error and whether a tolerance chose the steps, for equal steps only the fewest for an error."""
    runs = {}
    for point in points:
        name, _, how = point["contestant"].partition(", ")
        if name in pictures.ADAPTIVE and point["error"] and not point.get("failure"):
            runs.setdefault((point["epsilon"], name, how == "adaptive"), []).append((point["steps"], float(f"{point['error']:.3g}")))
    kept = []
    for (epsilon, name, adaptive), found in runs.items():
        best = float("inf")
        for steps, error in sorted(found):
            if adaptive or error < best:
                kept.append({"epsilon": epsilon, "method": name, "steps": steps, "error": error, "adaptive": adaptive})
                best = min(best, error)
    return kept


# Properties of a run that the pictures show.
DRAWN = ("contestant", "ours", "epsilon", "error", "seconds", "smallest")


def compact(results):
    """Keeps only what tables and pictures show, which is the Pareto front of each contestant or group.

    Figures of lanes on the host that took the part of a device are left out."""
    kept = {}
    for name, result in results.items():
        if not result["data"].get("is_device", True):
            continue
        points = grouped(result["data"].get("points", []))
        groups = {}
        for point in points:
            groups.setdefault(point.get("epsilon"), []).append(point)
        best = [{key: float(f"{value:.4g}") if isinstance(value, float) else value for key, value in run.items() if key in DRAWN}
                for group in groups.values() for front in pictures.fronts(group).values() for run in front]
        kept[name] = result | {"data": result["data"] | {"points": best}}
        if name == "peers-ode" and any("league" in point for point in result["data"]["points"]):
            kept[name]["data"]["tolerance"] = tolerance_runs(result["data"]["points"])
    return kept


RUN = ("error", "seconds", "smallest")


def packed(points):
    """Returns one entry for the runs of a contestant, with the numbers of RUN for each."""
    entries = {}
    for point in points:
        entry = {key: value for key, value in point.items() if key not in RUN}
        entries.setdefault(json.dumps(entry), entry | {"runs": []})["runs"].append([point[key] for key in RUN])
    return list(entries.values())


def unpacked(entries):
    """Returns the points of packed()."""
    return [{key: value for key, value in entry.items() if key != "runs"} | dict(zip(RUN, run)) for entry in entries for run in entry["runs"]]


def read(path):
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as problem:
        raise ReportError(f"cannot read {path} ({problem}); run make bench") from problem


def keep(results, folder):
    """Writes the file of a machine, with its older tables that are not measured again; `results` are compact."""
    name = re.sub(r"[^a-z0-9]+", "-", processor(any_of(results)).lower()).strip("-")
    folder.mkdir(parents=True, exist_ok=True)
    stored = {name: result | {"data": result["data"] | {"points": packed(result["data"]["points"])}} for name, result in results.items()}
    path = folder / f"{name}.json.gz"
    older = records.read(path) if path.exists() else {}
    records.write(path, older | stored)


def newest_first(folder):
    machines = [records.read(path) for path in sorted(folder.glob("*.json.gz"))]
    if not machines:
        raise ReportError(f"no results in {folder}; run make bench")
    for result in (result for machine in machines for result in machine.values()):
        result["data"]["points"] = unpacked(result["data"]["points"])
    return sorted(machines, key=lambda results: max(date_of(result) for result in results.values()), reverse=True)


def newest_tables(machines):
    """Returns each table as it was measured last, on any machine."""
    newest = {}
    for machine in machines:
        for name, result in machine.items():
            if name not in newest or date_of(newest[name]) < date_of(result):
                newest[name] = result
    return newest


def forget_superseded(machines, folder):
    """Removes the runs of contests that were measured again on another machine: pages of older ones have only rows."""
    newest = newest_tables(machines)
    for machine in machines:
        superseded = [result for name, result in machine.items() if result is not newest[name] and result["data"]["points"]]
        for result in superseded:
            result["data"] = {"points": []}
        if superseded:
            keep(machine, folder)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--results", type=Path, default=Path("results/bench/speed.json"))
    parser.add_argument("--docs", type=Path, default=HERE.parent / "docs")
    parser.add_argument("--readme", type=Path, default=HERE.parent / "README.md")
    given = parser.parse_args()
    folder = given.docs / "data" / "speed"
    if given.results.exists():
        if kept := compact(read(given.results)):
            keep(kept, folder)
    machines = newest_first(folder)
    forget_superseded(machines, folder)
    results = newest_tables(machines)
    for name, result in results.items():
        replace(given.docs / PAGES.get(name, MEASURED), name, section(name, result))
    write_long_tables(results, folder)
    if "processes" in results:
        replace(given.docs / PAGES["processes"], "scaling-model", scaling_model.tables(results["processes"]))
    replace(given.docs / "speed.md", "processors", comparison(machines))
    replace(given.docs / "speed.md", "winners", winners(results))
    replace(given.readme, "speed", comparison(machines, FRONT_PAGE))
    pictures.draw_all(results, given.docs / "images")


if __name__ == "__main__":
    try:
        main()
    except ReportError as problem:
        sys.exit(f"error: {problem}")
