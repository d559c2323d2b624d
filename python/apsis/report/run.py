"""The page of a run: results, promises, pictures, case and manifest."""
from __future__ import annotations

import json
from pathlib import Path
from typing import Any

from ..plot.maps import dimensions
from ..plot.results import distribution_name, end_of, figures, title_of
from ..plot.run_result import RunResult, read_result
from ..plot.style import pictures_in
from . import page
from .page import Html, number, table, text, verdict

CAPTIONS = {
    "fields": ("Macroscopic fields", "At the end, and at earlier snapshots in grey."),
    "maps": ("Macroscopic fields", "At the end, with contours, and streamlines over the speed; solid boxes and bodies are grey."),
    "distribution": ("Distribution function", "{f} at the end, and the Knudsen number ε(x) where it is not 0."),
    "history": ("History", "Checks after every step. A conservation defect is relative to the size of the quantity."),
    "probe": ("Profiles along a line", "Over the distance s from the first point, at the end and at earlier snapshots in grey."),
    "surface": ("Fluxes to a wall", "Received by each piece of the wall at the end."),
}
PROMISES = {
    "positivity": ("every unknown stays nonnegative", "min_value", "smallest value"),
    "conservation": ("sums of the conserved quantities change by rounding only", "conservation_defect", "largest relative defect"),
    "entropy": ("the entropy never grows", "max_entropy_increase", "largest increase in a step"),
}


# Relative change of a rate of relaxation beyond which a run warns.
HARMLESS_CUT = 1e-3


def caption(name: str, result: RunResult) -> tuple[str, str]:
    """Heading and caption of a picture."""
    drawn = "f(x, v)" if result.velocity_dimensions < 2 else distribution_name(result)
    kind = "maps" if name == "fields" and dimensions(result) > 1 else name.partition("-")[0]
    heading, words = CAPTIONS[kind]
    return heading, words.format(f=drawn)


def summary(result: RunResult) -> str:
    manifest, numbers = result.manifest, result.manifest["result"]
    good = manifest["state"] == "complete"
    units = "Quantities with a unit in their label are in SI units." if "units" in manifest else "All quantities are dimensionless."
    state = verdict(good, (manifest["state"], manifest["state"]))
    if "iterations" in numbers.get("steady", {}):
        out = f'<p>{state} after {text(numbers["steps"])} iterations; '
    else:
        out = (f'<p>{state} at t = {end_of(result):.10g} after {text(numbers["steps"])} steps of '
               f'<code>{text(manifest["method"])}</code> of length {number(numbers["dt"])} or less; ')
    out += f'{numbers["wall_s"]:.2f} s of computing. {units}</p>\n'
    if "steady" in numbers:
        out += f"<p>{steady_state(numbers['steady'])}</p>\n"
    if manifest.get("message"):
        out += f'<p class="no">{text(manifest["message"])}</p>\n'
    if "state" in numbers:
        out += table(["unknown", "at the end"], [[result.label(name), repr(value)]
                                                 for name, value in zip(result.fields, numbers["state"])])
    return out


def velocities(manifest: dict[str, Any]) -> str:
    """Returns a table of how well the velocities represent the gas; nothing for other models, and for results of earlier versions."""
    numbers = manifest["result"]
    if numbers.get("velocity_room") is None:
        return ""
    rows = [["largest share of the mass of a Maxwellian beyond the ends", number(numbers["velocity_beyond"])],
            ["largest share of its mass, mean or energy that the velocities miss", number(numbers["velocity_missed"])],
            ["smallest distance from a bulk velocity to an end, in thermal speeds", number(numbers["velocity_room"])],
            ["smallest thermal speed over the spacing", number(numbers["velocity_resolution"])]]
    if numbers["velocity_needed"]:
        rows.append(["largest velocity that would do", number(numbers["velocity_needed"])])
    if manifest["case"].get("force"):
        rows.append(["share of the mass that the force moved into the last velocities", number(numbers["velocity_held"])])
        if "force_lost_momentum" in numbers:
            rows.append(["largest share of its momentum that the force did not give", number(numbers["force_lost_momentum"])])
            rows.append(["largest share of its energy that the force did not give", number(numbers["force_lost_energy"])])
    return "<h2>Velocities</h2>\n" + table([], rows)


def steady_state(found: dict[str, Any]) -> str:
    """Describes the residual of iterations, or the rate that time.steady bounds and the distance from the steady state if it decays."""
    if "iterations" in found:
        state = "The steady state is found" if found["reached"] else "The steady state is not found"
        return (f"{state} after {found['iterations']} iterations: residual {number(found['residual'])} of that of the start, "
                f"change of the moments {number(found['change'])}, tolerance {number(found['tolerance'])}.")
    reached = "time.steady is reached" if found["reached"] else "time.steady is not reached"
    change = "" if found["change"] is None else f": the state changes by {number(found['change'])} per unit of time, relative"
    if found["distance"] is None:
        return f"{reached}{change}. The distance from the steady state is unknown (the change does not decay)."
    if found["decay_time"] is None:
        return f"{reached}{change}."
    return (f"{reached}{change}. If this decays on, by a factor e in {number(found['decay_time'])}, the state is "
            f"{number(found['distance'])} from its limit, relative.")


def promises(manifest: dict[str, Any]) -> str:
    """Describes the promises: a run ends when one is broken, so a completed run kept them at every step."""
    broken = str(manifest.get("message", "")).startswith("broken promise")
    rows = []
    for name, promised in manifest["promises"].items():
        what, key, measured = PROMISES.get(name, ("every state satisfies this condition of the model", "", "only whether it holds"))
        value = manifest["result"][key] if key else ""
        if not promised:
            kept = "not promised for this case"
        elif not broken:
            kept = verdict(True, ("kept at every step", ""))
        elif name == "positivity":
            kept = verdict(manifest["result"]["negative_values"] == 0, ("kept", "broken"))
        else:
            kept = "one was broken, see above"
        rows.append([f"{name}: {what}", kept, "none offered" if value is None else f"{measured} {number(value) if key else ''}".strip()])
    cut = manifest["result"].get("largest_cut")
    if cut is not None:
        rows.append(["target: the moments of the model relax at the published rate", verdict(cut <= HARMLESS_CUT, ("kept", "changed")),
                     f"largest relative change of the rate {number(cut)}"])
    return table(["promise", "verdict", "measured"], rows)


def balances(result: RunResult) -> str:
    """Returns a table of the rates at which the gas receives quantities from faces, solid boxes and bodies at the end: flux_FACE_QUANTITY
    of the history."""
    quantities = [name.removeprefix("total_") for name in result.history if name.startswith("total_")]
    faces = dict.fromkeys(name.removeprefix("flux_").removesuffix(f"_{quantities[0]}") for name in result.history
                          if quantities and name.startswith("flux_") and name.endswith(f"_{quantities[0]}"))
    if not faces:
        return ""
    units = [result.unit(f"flux_{next(iter(faces))}_{name}") for name in quantities]
    columns = ["from", *(f"{name.replace('_', ' ')}{'' if unit == 'dimensionless' else f' ({unit})'}"
                         for name, unit in zip(quantities, units))]
    rows = [[face, *(number(float(result.history[f"flux_{face}_{name}"][-1])) for name in quantities)] for face in faces]
    return "<h2>Balances</h2>\n" + table(columns, rows, "Received by the gas per unit of time at the end")


def loads(result: RunResult) -> str:
    """Returns a table of the loads on each body at the end, and of their coefficients if the case has reference values."""
    bodies = result.manifest["result"].get("bodies", {})
    if not bodies:
        return ""
    names = [name for name, value in next(iter(bodies.values())).items() if not isinstance(value, list)]
    units = [result.unit(f"{name}_{next(iter(bodies))}") for name in names]
    columns = ["body", *(name if unit == "dimensionless" else f"{name} ({unit})" for name, unit in zip(names, units))]
    rows = [[body, *(number(values[name]) for name in names)] for body, values in bodies.items()]
    return "<h2>Bodies</h2>\n" + table(columns, rows, "Loads on the bodies at the end")


def warnings(manifest: dict[str, Any]) -> str:
    found = manifest.get("warnings", [])
    return "<h2>Warnings</h2>\n<ul>" + "".join(f"<li>{text(one)}</li>\n" for one in found) + "</ul>\n" if found else ""


def case_text(result: RunResult) -> str:
    return f"<pre>{text(result.case.strip() or json.dumps(result.manifest['case'], indent=2))}</pre>\n"


def flattened(value: Any, name: str = "") -> list[tuple[str, Any]]:
    """Yields the leaves of nested objects as ("build.compiler", value)."""
    if isinstance(value, dict):
        return [leaf for key, inner in value.items() for leaf in flattened(inner, f"{name}.{key}" if name else key)]
    return [(name, value)]


def report(folder: Path) -> str:
    """Returns the page; pictures are also written to <folder>/pictures. Raises PictureError."""
    result = read_result(folder)
    manifest = result.manifest
    pictures = "".join(page.embedded(figure, name, *caption(name, result), pictures_in(folder))
                       for name, figure in figures(result).items())
    rest = {key: value for key, value in manifest.items() if key not in ("case", "message")}
    body = (summary(result) + warnings(manifest) + "<h2>Promises</h2>\n" + promises(manifest) + loads(result) + balances(result)
            + velocities(manifest)
            + ("<h2>Pictures</h2>\n" + pictures if pictures else "")
            + "<h2>Case</h2>\n" + case_text(result)
            + "<h2>Manifest</h2>\n" + table([], [[Html(f"<code>{text(name)}</code>"), value] for name, value in flattened(rest)])
            + f'<p class="small">{page.provenance(manifest, manifest["apsis"])}. Source of the case: '
              f'{text(manifest["case"]["source"])}.</p>\n')
    return page.page(title_of(result), body)
