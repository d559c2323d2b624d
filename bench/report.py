#!/usr/bin/env python3
"""Tables and pictures of what `make bench` measured.

    bench/report.py [--results results/bench/speed.json] [--docs docs] [--readme README.md]

Copies the results to DOCS/data/speed.json, or reads that file where there are none; writes the tables between the marks
<!-- NAME --> and <!-- end --> of DOCS/speed.md and of the README, and draws DOCS/images/speed-*.png.
"""
import argparse
import json
import re
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent / "python"))
from apsis_picture import COLOURS, MARKERS, plt  # noqa: E402  (one style for all pictures)


class ReportError(Exception):
    """Results that are missing or damaged, or a document without a place for them."""


# --- tables ----------------------------------------------------------------------------------------------------------------------


def number(cell):
    if cell is None:
        return "—"
    return f"{cell:.3g}" if isinstance(cell, float) else str(cell)


def markdown(columns, rows):
    lines = ["| " + " | ".join(columns) + " |", "|" + "---|" * len(columns)]
    return "\n".join(lines + ["| " + " | ".join(number(cell) for cell in row) + " |" for row in rows])


def measured_on(result):
    machine = result["machine"]
    return (f"{machine['date'][:10]}, {machine['processor']}, {machine['cores']} cores, kernels {machine['kernels']}, "
            f"{machine['compiler']}, median of {result['repeats']}")


def section(result):
    return (f"{result['note']}\n\n{markdown(result['columns'], result['rows'])}\n\n"
            f"*{measured_on(result)}*")


def replace(path, name, text):
    before = path.read_text(encoding="utf-8")
    pattern = re.compile(rf"(<!-- {re.escape(name)} -->\n).*?(<!-- end -->)", re.S)
    if not pattern.search(before):
        raise ReportError(f"{path} has no place <!-- {name} -->")
    path.write_text(pattern.sub(lambda found: found.group(1) + "\n" + text + "\n\n" + found.group(2), before), encoding="utf-8")


def rows_where(result, **wanted):
    at = {name: k for k, name in enumerate(result["columns"])}
    return [dict(zip(result["columns"], row)) for row in result["rows"]
            if all(row[at[name]] == value for name, value in wanted.items())]


def summary(results):
    """The rows of the README, from the same file."""
    rows = []
    if "throughput" in results:
        for formulation in ("finite-difference", "finite-volume"):
            found = rows_where(results["throughput"], formulation=formulation, method="md-imex-3-2", threads=1)
            for row in found:
                rows.append((f"{formulation.replace('-', ' ')}s, second-order step with limiter, 1000 × 150, one core",
                             f"{row['point·stages/s']:.2g} point·stages/s, {row['of the binding ceiling']} of the binding ceiling"))
    if "threads" in results:
        found = rows_where(results["threads"], N=400)
        rows.append(("two threads against one, N = 400",
                     ", ".join(f"{row['ratio']} ({row['formulation'].replace('-', ' ')}s)" for row in found)))
    if "plain" in results and "summary" in results["plain"].get("data", {}):
        rows.append(("mixed-regime run, N = 40, against plain scalar loops", results["plain"]["data"]["summary"]))
    if "overhead" in results:
        rows.append(("a step of a system of two numbers against one written by hand", f"{results['overhead']['rows'][1][2]} times"))
    for name, what in (("peers-mixed", "mixed-regime run against SUNDIALS and SSP-RK3"), ("peers-ode", "ODE model against SUNDIALS")):
        if name in results and "summary" in results[name].get("data", {}):
            rows.append((what, results[name]["data"]["summary"]))
    return rows


# --- pictures --------------------------------------------------------------------------------------------------------------------


def fronts(points):
    """Of every contestant, the runs that no other of its runs beats in both error and time."""
    by_name = {}
    for point in points:
        if point.get("error") and point.get("seconds"):
            by_name.setdefault(point["contestant"], []).append(point)
    for name, runs in by_name.items():
        runs.sort(key=lambda run: (run["seconds"], run["error"]))
        best, front = float("inf"), []
        for run in runs:
            if run["error"] < best:
                front.append(run)
                best = run["error"]
        by_name[name] = front
    return by_name


def draw_work(axes, points):
    for k, (name, front) in enumerate(sorted(fronts(points).items())):
        line, = axes.loglog([run["error"] for run in front], [run["seconds"] for run in front], "-",
                            color=COLOURS[k % len(COLOURS)], label=name)
        for run in front:
            positive = run.get("smallest", 0.0) is not None and run.get("smallest", 0.0) >= 0.0
            axes.loglog(run["error"], run["seconds"], MARKERS[k % len(MARKERS)], color=line.get_color(),
                        markerfacecolor=line.get_color() if positive else "white")
    axes.invert_xaxis()
    axes.set_xlabel("temporal error")
    axes.set_ylabel("CPU time in s")


def draw_mixed(result, path):
    figure, axes = plt.subplots(figsize=(9.0, 6.0))
    draw_work(axes, result["data"]["points"])
    axes.legend(fontsize="small", ncols=2)
    axes.set_title("mixed-regime run; open: some value of f was negative")
    figure.savefig(path)
    plt.close(figure)


def draw_ode(result, path):
    points = result["data"]["points"]
    epsilons = sorted({point["epsilon"] for point in points}, reverse=True)
    figure, all_axes = plt.subplots(1, len(epsilons), figsize=(4.0 * len(epsilons), 4.5), sharey=True)
    for axes, epsilon in zip(all_axes, epsilons):
        draw_work(axes, [point for point in points if point["epsilon"] == epsilon])
        axes.set_title(f"ε = {epsilon:g}")
    for axes in all_axes[1:]:
        axes.set_ylabel("")
    handles, labels = all_axes[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=4, fontsize="small")
    figure.savefig(path)
    plt.close(figure)


# --- all of it -------------------------------------------------------------------------------------------------------------------


def read_results(path, kept):
    source = path if path.exists() else kept
    try:
        results = json.loads(source.read_text(encoding="utf-8"))
    except (OSError, ValueError) as problem:
        raise ReportError(f"cannot read {source} ({problem}) run make bench") from problem
    if source == path:
        kept.write_text(json.dumps(results, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    return results


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", 1)[0])
    parser.add_argument("--results", type=Path, default=Path("results/bench/speed.json"))
    parser.add_argument("--docs", type=Path, default=HERE.parent / "docs")
    parser.add_argument("--readme", type=Path, default=HERE.parent / "README.md")
    given = parser.parse_args()
    results = read_results(given.results, given.docs / "data" / "speed.json")
    for name, result in results.items():
        replace(given.docs / "speed.md", name, section(result))
    machine = next(iter(results.values()))
    replace(given.readme, "speed", markdown(("measure", "result"), summary(results)) + f"\n\n*{measured_on(machine)}*")
    if "peers-mixed" in results:
        draw_mixed(results["peers-mixed"], given.docs / "images" / "speed-mixed.png")
    if "peers-ode" in results:
        draw_ode(results["peers-ode"], given.docs / "images" / "speed-ode.png")


if __name__ == "__main__":
    try:
        main()
    except ReportError as problem:
        sys.exit(f"error: {problem}")
