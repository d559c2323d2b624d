"""Pictures of the measurements of `make bench` (report.py)."""
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "python" / "apsis"))
from plot.style import COLOURS, MARKERS, plt  # noqa: E402  (one style for all pictures)

# Methods whose steps by tolerance are compared with equal steps.
ADAPTIVE = ("md-imex-3-2", "md-imex-8-3-mixed", "md-imex-8-3-accurate", "extrapolated-euler-6")


def fronts(points):
    """Returns the Pareto front of every contestant, errors from 1 to 1e-11: runs that no other of its runs beats in both error and time."""
    by_name = {}
    for point in points:
        if 1e-11 <= (point.get("error") or 0) <= 1 and point.get("seconds") and not point.get("failure"):
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


def draw_work(axes, points, names):
    """Draws time against error; marks are filled if no value was negative in the run."""
    for k, name in enumerate(names):
        front = fronts(points).get(name, [])
        colour, mark = COLOURS[k % len(COLOURS)], MARKERS[k // len(COLOURS) % len(MARKERS)]
        dashes = "-" if any(point["ours"] for point in points if point["contestant"] == name) else "--"
        axes.loglog([run["error"] for run in front], [run["seconds"] for run in front], dashes, color=colour, marker=mark,
                    label=name, markerfacecolor="white")
        full = [run for run in front if run["smallest"] >= 0.0]
        axes.loglog([run["error"] for run in full], [run["seconds"] for run in full], mark, color=colour)
    axes.invert_xaxis()
    axes.set_xlabel("temporal error")
    axes.set_ylabel("CPU time in s")


def draw_mixed(result, path):
    figure, axes = plt.subplots(figsize=(11.0, 6.0))
    draw_work(axes, result["data"]["points"], sorted({point["contestant"] for point in result["data"]["points"]}))
    axes.legend(fontsize="small", loc="center left", bbox_to_anchor=(1.02, 0.5))
    axes.set_title("mixed-regime run; open: some value of f was negative")
    figure.savefig(path)
    plt.close(figure)


def draw_ode(result, path):
    points = result["data"]["points"]
    epsilons = sorted({point["epsilon"] for point in points}, reverse=True)
    figure, grid = plt.subplots(2, 3, figsize=(13.0, 8.5))
    places = list(grid.flat)
    for axes, epsilon in zip(places, epsilons):
        draw_work(axes, [point for point in points if point["epsilon"] == epsilon], sorted({point["contestant"] for point in points}))
        axes.set_title(f"ε = {epsilon:g}")
    for axes in places[len(epsilons):]:
        axes.axis("off")
    handles, labels = places[0].get_legend_handles_labels()
    places[-1].legend(handles, labels, loc="center", fontsize="small")
    figure.savefig(path)
    plt.close(figure)


def draw_flows(result, path):
    """Draws the rates of flows, as shipped and beyond the caches, and the shares of the time of those that are shipped."""
    at = {name: k for k, name in enumerate(result["columns"])}
    cases = list(dict.fromkeys(row[0] for row in result["rows"]))[::-1]
    of_case = {case: [row for row in result["rows"] if row[0] == case] for case in cases}
    figure, (rates, shares) = plt.subplots(1, 2, figsize=(13.0, 0.28 * len(cases) + 1.5), sharey=True)
    for k, label in enumerate(("as shipped", "with 4 million numbers")):
        rates.plot([of_case[case][k][at["point·stages/s"]] for case in cases], range(len(cases)), MARKERS[k], color=COLOURS[k], label=label)
    rates.set_xscale("log")
    rates.set_xlabel("point·stages per second")
    rates.set_yticks(range(len(cases)), cases)
    rates.set_ylim(-0.7, len(cases) - 0.3)
    rates.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=2, fontsize="small")
    left = [0.0] * len(cases)
    for k, part in enumerate(result["columns"][at["ratio"] + 1:]):
        widths = [float(of_case[case][0][at[part]].split()[0]) for case in cases]
        shares.barh(range(len(cases)), widths, left=left, color=COLOURS[k % len(COLOURS)], label=part)
        left = [a + b for a, b in zip(left, widths)]
    shares.set_xlabel("share of the time in %")
    shares.set_xlim(0.0, 100.0)
    shares.legend(loc="lower center", bbox_to_anchor=(0.5, 1.0), ncols=6, fontsize="small", columnspacing=1.0)
    figure.savefig(path)
    plt.close(figure)


def draw_steady(result, path):
    """Draws the CPU time to a steady state against the rarefaction, by iterations and in time, which may be an estimate."""
    at = {name: k for k, name in enumerate(result["columns"])}
    rows = [row for row in result["rows"] if row[at["δ"]] != "as shipped"]
    flows = list(dict.fromkeys(row[0] for row in rows))
    figure, grid = plt.subplots(-(-len(flows) // 3), 3, figsize=(13.0, 2.4 * -(-len(flows) // 3)), sharex=True)
    for panel, flow in zip(grid.flat, flows):
        for k, (column, label) in enumerate((("CPU time (s)", "iterations"), ("in time (s)", "steps in time"))):
            points = [(float(row[at["δ"]]), float(row[at[column]].lstrip("≈ "))) for row in rows if row[0] == flow]
            panel.loglog(*zip(*points), MARKERS[k] + "-", color=COLOURS[k], label=label)
        panel.set_title(flow, fontsize="medium")
        panel.set_ylabel("CPU time in s")
    for panel in grid[-1]:
        panel.set_xlabel("δ")
    grid.flat[0].legend(fontsize="small")
    figure.savefig(path)
    plt.close(figure)


def draw_tolerance(runs, path):
    """Draws steps against error for each ε: equal steps as lines, steps chosen by a tolerance as marks."""
    epsilons = sorted({run["epsilon"] for run in runs}, reverse=True)
    figure, grid = plt.subplots(2, 3, figsize=(13.0, 8.5))
    places = list(grid.flat)
    for axes, epsilon in zip(places, epsilons):
        for k, name in enumerate(ADAPTIVE):
            def points(adaptive):
                chosen = [run for run in runs if (run["epsilon"], run["method"], run["adaptive"]) == (epsilon, name, adaptive)]
                return [run["error"] for run in chosen], [run["steps"] for run in chosen]
            axes.loglog(*points(False), "-", color=COLOURS[k], label=f"{name}, equal steps")
            axes.loglog(*points(True), MARKERS[k], color=COLOURS[k], label=f"{name}, tolerance")
        axes.invert_xaxis()
        axes.set_xlabel("error")
        axes.set_ylabel("steps")
        axes.set_title(f"ε = {epsilon:g}")
    places[-1].axis("off")
    places[-1].legend(*places[0].get_legend_handles_labels(), loc="center", fontsize="small")
    figure.savefig(path)
    plt.close(figure)


def draw_all(results, images):
    """Draws the pictures of all tables that there are into a folder."""
    for table, picture in (("peers-mixed", "speed-mixed.png"), ("peers-mixed-points", "speed-mixed-points.png"),
                           ("peers-mixed-centres", "speed-mixed-centres.png")):
        if table in results:
            draw_mixed(results[table], images / picture)
    for table, picture in (("peers-ode", "speed-ode.png"), ("peers-kaps", "speed-kaps.png"),
                           ("peers-prothero-robinson", "speed-prothero-robinson.png"), ("peers-broadwell", "speed-broadwell.png")):
        if table in results:
            draw_ode(results[table], images / picture)
    for table, draw in (("flows", draw_flows), ("steady", draw_steady)):
        if table in results:
            draw(results[table], images / f"speed-{table}.png")
    if "tolerance" in results.get("peers-ode", {"data": {}})["data"]:
        draw_tolerance(results["peers-ode"]["data"]["tolerance"], images / "speed-tolerance.png")
