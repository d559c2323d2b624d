#!/usr/bin/env python3
"""Makes tables and pictures of the study of methods.

    studies/report.py [--results results/study] [--docs docs] [--apsis PROGRAM]

Collects the results of studies/run.py from RESULTS in DOCS/data/study.json.gz, which keeps its entries of studies without new results;
draws DOCS/images/study-*.png; and writes the tables between the marks <!-- NAME --> and <!-- end --> of DOCS/study.md.
"""
import argparse
import json
import math
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent / "python" / "apsis"), str(HERE.parent / "bench")]
import records  # noqa: E402
from plot.methods import stability_function  # noqa: E402
from plot.style import BLACK, COLOURS, MARKERS, plt  # noqa: E402  (one style for all pictures)

LEVELS = {"ode": (1e-4, 1e-6, 1e-8), "broadwell": (1e-4, 1e-5, 1e-6), "bgk": (1e-4, 1e-5, 1e-6),
          "bgk-mixed": (2e-4, 1e-4, 4e-5, 2e-5)}


class ReportError(Exception):
    """A result file is missing or invalid; the message names it."""


# --- data ------------------------------------------------------------------------------------------------------------------------


def read_json(path):
    try:
        return json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as problem:
        raise ReportError(f"cannot read {path} ({problem}); remove it and run studies/run.py again") from problem


def summary_of(run, result):
    """Extracts the quantities in the tables from the result of a design."""
    method = result.get("method") or {}
    kept = {"name": run["name"], "args": run["args"], "found": result["found"], "seconds": round(result["wall_s"], 1)
            if "wall_s" in result else None, "starts": result.get("starts"), "feasible": result.get("feasible"),
            "nearest_residual": result.get("nearest_residual"), "reason": result.get("reason"), "seed": result.get("seed")}
    if method:
        regime = method.get("intermediate_regime") or {}
        kept |= {"band": regime["band"]["error"] if regime.get("keeps") in ("all", "slow") else None}
        kept |= {"r": method["ssp_coefficient"], "evaluations": method["explicit_evaluations"], "stages": method["stages"],
                 "error": method["error_constant"], "angle": method["stability"]["angle_degrees"] if "stability" in method else None,
                 "buffers": method["buffers"], "start": result.get("start")}
    return kept


def compact(row):
    """Rounds a row to six digits, more than tables and pictures show."""
    return {key: float(f"{value:.6g}") if isinstance(value, float) else value for key, value in row.items()
            if key not in ("rate", "wall_s", "dt")}


def gather(plan, results, stored):
    """Collects all existing results in the order of the plan, and the stored ones of designs and studies without a result file."""
    data = {"design": [], "work": {}}
    earlier = {(run["name"], run["args"]): run for group in stored["design"] for run in group["runs"]}
    for group in plan["design"]:
        runs = []
        for run in group["runs"]:
            file = results / "design" / f"{run['name']}.json"
            runs.append(summary_of(run, read_json(file)) if file.exists() else earlier.get((run["name"], run["args"])))
        data["design"].append({"group": group["group"], "runs": [run for run in runs if run is not None]})
    for study in plan["work"]["study"]:
        file = results / "work" / f"{study['name']}.json"
        if file.exists():
            data["work"][study["name"]] = [compact(row) for row in read_json(file)]
        elif study["name"] in stored["work"]:
            data["work"][study["name"]] = stored["work"][study["name"]]
    return data


def curves(rows, cost_of, positive):
    """Returns {(epsilon, method, startup): (error, cost)}, from coarse to fine, without failed runs and, with `positive`, without
    runs in which f was negative."""
    found = {}
    for row in rows:
        if row.get("error") is None or (positive and row["min_value"] < 0.0):
            continue
        key = (row.get("model.epsilon"), row["time.method"], row["time.startup"])
        found.setdefault(key, []).append((row["error"], cost_of(row)))
    return {key: np.array(values, dtype=float) for key, values in found.items()}


def seconds_of_steps(rows):
    """Returns the median CPU time per step of each method over all its runs of a study: the speed of a machine varies, the number
    of steps does not."""
    seconds = {}
    for row in rows:
        if row["steps"] > 0:
            seconds.setdefault(row["time.method"], []).append(row["cpu_s"] / row["steps"])
    return {method: float(np.median(values)) for method, values in seconds.items()}


def cost_at(curve, level):
    """Returns the minimum cost for an error of at most `level`, interpolated between runs linearly in logarithms; None if no run
    reaches it."""
    errors, costs = curve[:, 0], curve[:, 1]
    if errors.min() > level:
        return None
    best = np.inf
    for k in range(len(errors)):
        if errors[k] <= level:
            best = min(best, costs[k])
        if k + 1 < len(errors) and (errors[k] - level) * (errors[k + 1] - level) < 0:
            part = np.log(level / errors[k]) / np.log(errors[k + 1] / errors[k])
            best = min(best, float(np.exp(np.log(costs[k]) + part * np.log(costs[k + 1] / costs[k]))))
    return best


# --- tables ----------------------------------------------------------------------------------------------------------------------


def angle_text(angle):
    return "—" if angle is None else f"{math.floor(angle * 10 + 1e-6) / 10:.1f}°"


def design_tables(data):
    lines = []
    for group in data["design"]:
        lines += [f"**{group['group'][0].upper()}{group['group'][1:]}**", "",
                  "| command | s | n_F | r | r/n_F | error | band | angle | found at start | starts, feasible | seconds |",
                  "|---|---|---|---|---|---|---|---|---|---|---|"]
        for run in group["runs"]:
            starts = f"{run['starts']}, {run['feasible']}" if run["starts"] else "—"
            if run["found"]:
                has_r = run["evaluations"] > 0
                lines.append(f"| `{run['args']}` | {run['stages']} | {run['evaluations'] or '—'} | "
                             f"{format(run['r'], '.4f') if has_r else 'any'} | "
                             f"{format(run['r'] / run['evaluations'], '.4f') if has_r else '—'} | {run['error']:.3g} | "
                             f"{format(run['band'], '.2g') if run.get('band') else '—'} | {angle_text(run['angle'])} | "
                             f"{run['start']} | {starts} | {run['seconds']:.0f} |")
            else:
                residual = f"nearest residual {run['nearest_residual']:.1e}" if run["nearest_residual"] else run["reason"]
                lines.append(f"| `{run['args']}` | | | | | | | | **not found**, {residual.removeprefix('error: ')} | {starts} | "
                             f"{run['seconds'] or 0:.0f} |")
        lines.append("")
    return "\n".join(lines)


def cost_text(study, cost):
    if study["cost"] == "evaluations":
        return f"{cost:.0f}"
    return f"{cost:.2f} s" if cost >= 0.1 else f"{1e3 * cost:.2g} ms"


def work_table(study, found, paper, methods):
    """Tabulates the cost of each method at several errors, with or without start-up, whichever is less; in brackets relative to
    the better of the paper's methods without start-up."""
    blocks = []
    for epsilon in dict.fromkeys(key[0] for key in found):
        title = f"ε = {epsilon:g}" if isinstance(epsilon, float) else study["title"]
        levels = LEVELS[study["name"]]
        lines = [f"*{title}*", "", "| method | " + " | ".join(f"error {level:.0e}" for level in levels) + " |",
                 "|---|" + "---|" * len(levels)]
        at = {(method, startup, level): cost_at(found[epsilon, method, startup], level)
              for method in methods for startup in ("none", "graded") for level in levels
              if (epsilon, method, startup) in found}
        best = {level: min((at[m, "none", level] for m in paper if at.get((m, "none", level)) is not None), default=None)
                for level in levels}
        for method in methods:
            cells = []
            for level in levels:
                costs = {startup: cost for startup in ("none", "graded")
                         if (cost := at.get((method, startup, level))) is not None}
                if not costs:
                    cells.append("—")
                    continue
                startup = min(costs, key=costs.get)
                ratio = f" ({costs[startup] / best[level]:.2f})" if best[level] is not None else ""
                cells.append(cost_text(study, costs[startup]) + (" g" if startup == "graded" else "") + ratio)
            lines.append(f"| `{method}` | " + " | ".join(cells) + " |")
        blocks.append("\n".join(lines))
    return "\n\n".join(blocks) + "\n"


def positivity_table(rows, of_step):
    lines = ["| method | start-up | steps | CPU time | error | least f |", "|---|---|---|---|---|---|"]
    for row in rows:
        if row.get("error") is None:
            lines.append(f"| `{row['time.method']}` | {row['time.startup']} | | | {row.get('problem', 'failed')} | |")
            continue
        lines.append(f"| `{row['time.method']}` | {row['time.startup']} | {row['steps']} | {row['steps'] * of_step[row['time.method']]:.2f} s | "
                     f"{row['error']:.2e} | {row['min_value']:.1e} |")
    return "\n".join(lines) + "\n"


# --- pictures --------------------------------------------------------------------------------------------------------------------


def draw_fronts(data, images):
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4))
    chosen = [g for g in data["design"] if "largest r" in g["group"]]
    for k, group in enumerate(chosen):
        runs = sorted((r for r in group["runs"] if r["found"]), key=lambda r: r["stages"])
        # One curve for each order in a group.
        for order in sorted({r["args"].split()[1] for r in runs}):
            of_order = [r for r in runs if r["args"].split()[1] == order]
            of_work = ", for r/n_F" if group["group"].endswith("r/n_F") else ""
            label = group["group"].split(",")[0] + of_work if group["group"].startswith("order") else \
                ("N1, N2" if "equilibrium" in group["group"] else "N1–N3") + f", order {order}"
            style = dict(color=COLOURS[k % len(COLOURS)], marker=MARKERS[(k + 3 * (order == "3")) % len(MARKERS)], label=label,
                         linestyle="-" if group["group"].startswith("order") else "--")
            left.plot([r["stages"] for r in of_order], [r["r"] for r in of_order], **style)
            right.plot([r["stages"] for r in of_order], [r["r"] / r["evaluations"] for r in of_order], **style)
    for axes, values, name in ((left, (1.0, 0.9044), "r"), (right, (0.5, 0.9044 / 3), "r / n_F")):
        axes.plot([3, 6], values, "*", color=BLACK, markersize=11, label="the paper's methods")
        axes.set_xlabel("stages s")
        axes.set_ylabel(name)
    left.legend(fontsize=8)
    figure.savefig(images / "study-fronts.png")


def draw_errors(data, images):
    figure, axes = plt.subplots(figsize=(5.5, 4))
    for k, group in enumerate(g for g in data["design"] if "smallest error" in g["group"] and "n_F" in g["group"] or
                              g["group"].startswith("order 2, s = 4")):
        runs = sorted((r for r in group["runs"] if r["found"]), key=lambda r: r["r"])
        axes.semilogy([r["r"] for r in runs], [r["error"] for r in runs], marker=MARKERS[k], color=COLOURS[k],
                      label=group["group"].removesuffix(", smallest error"))
    axes.semilogy([1.0, 0.9044], [0.4658, 4.272], "*", color=BLACK, markersize=11, linestyle="none", label="the paper's methods")
    axes.set_xlabel("SSP coefficient r")
    axes.set_ylabel("error constant")
    axes.legend(fontsize=8)
    figure.savefig(images / "study-errors.png")


def draw_stability(apsis, methods, images):
    x, y = np.meshgrid(np.linspace(-12, 12, 481), np.linspace(-12, 12, 481))
    figure, all_axes = plt.subplots(2, -(-len(methods) // 2), figsize=(2.6 * -(-len(methods) // 2), 6.2), sharex=True, sharey=True)
    for axes, name in zip(all_axes.flat, methods):
        text = subprocess.run([apsis, "show", name, "--format", "json"], capture_output=True, text=True, check=True).stdout
        with np.errstate(all="ignore"):
            size = np.abs(stability_function(json.loads(text), 0.0, x + 1j * y))
        axes.contourf(x, y, np.nan_to_num(size, nan=1e9), levels=[0.0, 1.0], colors=[COLOURS[5]], alpha=0.6)
        axes.contour(x, y, np.nan_to_num(size, nan=1e9), levels=[1.0], colors=[BLACK], linewidths=0.8)
        axes.axvline(0.0, color=BLACK, linewidth=0.5)
        axes.set_title(name, fontsize=8)
        axes.set_aspect("equal")
    for axes in list(all_axes.flat)[len(methods):]:
        axes.set_visible(False)
    figure.supxlabel("Re z")
    figure.supylabel("Im z")
    figure.savefig(images / "study-stability.png")


def draw_work(study, found, paper, methods, images):
    """Draws errors against work: the paper's methods in black, curves with start-up dotted."""
    colours = dict.fromkeys(paper, BLACK) | {m: plt.cm.tab10(k % 10) for k, m in enumerate(m for m in methods if m not in paper)}
    values = list(dict.fromkeys(key[0] for key in found))
    columns = 2 if len(values) > 1 else 1
    rows = -(-len(values) // columns)
    figure, all_axes = plt.subplots(rows, columns, figsize=(5.2 * columns + 2.2, 3.8 * rows), squeeze=False)
    for axes, epsilon in zip(all_axes.flat, values):
        for k, method in enumerate(methods):
            for startup, line in (("none", "-"), ("graded", ":")):
                curve = found.get((epsilon, method, startup))
                if curve is not None:
                    axes.loglog(curve[:, 1], curve[:, 0], line, color=colours[method], marker=MARKERS[k % len(MARKERS)],
                                markersize=3.5, linewidth=1.1, label=method if startup == "none" else None)
        axes.set_title(f"ε = {epsilon:g}" if isinstance(epsilon, float) else study["title"], fontsize=10)
        axes.set_xlabel("T and Q evaluations and solves" if study["cost"] == "evaluations" else "CPU time, s")
        axes.set_ylabel("temporal error")
    all_axes[0, -1].legend(loc="upper left", bbox_to_anchor=(1.02, 1.0), fontsize=7)
    figure.savefig(images / f"study-work-{study['name']}.png")


# --- main ------------------------------------------------------------------------------------------------------------------------


def costs_of_steps(apsis, methods):
    """Returns the number of evaluations of T and stage solves per step of each method."""
    costs = {}
    for name in methods:
        checked = json.loads(subprocess.run([apsis, "check", name, "--json"], capture_output=True, text=True, check=True).stdout)
        costs[name] = checked["explicit_evaluations"] + checked["implicit_solves"]
    return costs


def insert(text, name, content):
    pattern = re.compile(rf"(<!-- {name} -->\n).*?(<!-- end -->)", re.S)
    if not pattern.search(text):
        raise ReportError(f"docs/study.md has no place <!-- {name} -->")
    return pattern.sub(lambda m: m[1] + "\n" + content + "\n" + m[2], text)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--results", type=Path, default=Path("results/study"))
    parser.add_argument("--docs", type=Path, default=Path("docs"))
    parser.add_argument("--apsis", default="build/release/app/apsis")
    given = parser.parse_args()
    with open(HERE / "methods.toml", "rb") as file:
        plan = tomllib.load(file)
    stored = given.docs / "data" / "study.json.gz"
    data = gather(plan, given.results, records.read(stored) if stored.exists() else {"design": [], "work": {}})
    images = given.docs / "images"
    for folder in (images, stored.parent):
        folder.mkdir(parents=True, exist_ok=True)
    records.write(stored, data)
    page = (given.docs / "study.md").read_text(encoding="utf-8")
    page = insert(page, "designs", design_tables(data))
    methods = plan["work"]["methods"]
    steps = costs_of_steps(given.apsis, methods)
    for study in plan["work"]["study"]:
        rows = data["work"].get(study["name"])
        if rows is None:
            continue
        if study["name"] == "positivity":
            # One run per method; the time of a step is that of the previous study.
            page = insert(page, "positivity", positivity_table(rows, seconds_of_steps(data["work"].get("bgk-mixed", rows))))
            continue
        of_step = steps if study["cost"] == "evaluations" else seconds_of_steps(rows)
        found = curves(rows, lambda row: row["steps"] * of_step[row["time.method"]], study.get("positive", False))
        page = insert(page, f"work {study['name']}", work_table(study, found, plan["work"]["paper"], methods))
        draw_work(study, found, plan["work"]["paper"], methods, images)
    draw_fronts(data, images)
    draw_errors(data, images)
    draw_stability(given.apsis, plan["work"]["methods"] + ["imdrk-5-4", "imdrk-9-5"], images)
    (given.docs / "study.md").write_text(page, encoding="utf-8")


if __name__ == "__main__":
    try:
        main()
    except ReportError as problem:
        sys.exit(f"error: {problem}")
