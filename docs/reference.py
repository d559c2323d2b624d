"""Reference pages written from the program itself: methods, models, cases, keys, schemes, claims, commands."""
import json
import math
import re
import subprocess
import textwrap
from pathlib import Path

SHOWN = 4  # stages up to which the coefficients of a method fit on a page
GROUPS = {"With transport and collisions, bounds preserved": lambda m: m["kind"] == "imex" and m["ssp_coefficient"] != 0,
          "With transport and collisions, no bounds": lambda m: m["kind"] == "imex" and m["ssp_coefficient"] == 0,
          "Collisions alone": lambda m: m["kind"] == "implicit", "Explicit": lambda m: m["kind"] == "explicit",
          "Exponential": lambda m: m["kind"] == "exponential"}
TERMS = {"all": "exact in steps far longer than ε: viscosity, deviation from equilibrium, initial layer",
         "slow": "exact in steps far longer than ε: viscosity and deviation from equilibrium; an initial layer needs a graded start",
         "none": "not exact: errors may stall at a multiple of ε"}
DRAWN = ("imex", "implicit", "explicit")  # kinds with a Butcher form, which plot draws


class Program:
    def __init__(self, path: Path):
        self.path = path

    def __call__(self, *words: str) -> str:
        return subprocess.run([self.path, *words], text=True, capture_output=True, check=True).stdout

    def list(self, what: str) -> list[dict]:
        return json.loads(self("list", what, "--json"))


def plain(text: str) -> str:
    """Escapes text for Markdown; names of commands and keys become code."""
    text = re.sub(r"([\\`*_<>\[\]$|~])", r"\\\1", text)
    return re.sub(r"\((apsis [a-z-]+(?: [a-z]+)?)\)", r"(`\1`)", text)


def prose(text: str) -> str:
    """Returns paragraphs, with indented lines as code."""
    parts = re.split(r"((?:^  .*\n?)+)", text, flags=re.M)
    return "".join(f"\n```text\n{textwrap.dedent(part).rstrip()}\n```\n" if part.startswith("  ") else plain(part)
                   for part in parts)


def table(columns: list[str], rows: list[list[str]]) -> str:
    lines = [columns, ["---"] * len(columns), *rows]
    return "".join("| " + " | ".join(str(cell) for cell in line) + " |\n" for line in lines) + "\n"


def facts(pairs: dict[str, str]) -> str:
    """Returns a line for each nonempty fact."""
    return "".join(f"- {name}: {value}\n" for name, value in pairs.items() if value) + "\n"


def number(x: float | None) -> str:
    return "–" if x is None else f"{x:.4g}"


def rounded_down(degrees: float) -> str:
    """An angle with two decimals, no larger than what was proved."""
    return f"{math.floor(degrees * 100 + 1e-6) / 100:g}"


def coefficient(m: dict) -> str:
    return "any step" if m["unconditional"] and m["kind"] == "implicit" else number(m["ssp_coefficient"])


def limit(m: dict) -> str:
    return f"{m['ap_data']}" if m["ap"] or m["ap_data"] != "none" else "no"


def methods(program: Program) -> str:
    all_methods = program.list("methods")
    text = ("# Methods\n\nAll methods of the catalogue, as `apsis list methods` certifies them; each has a page. *r* is the SSP coefficient: a "
            "step preserves what forward Euler preserves for Δt ≤ r Δt_FE, for every ε. n_F counts evaluations of the transport "
            "per step. [Methods](../methods.md) and [the study](../study.md) define the columns.\n\n")
    for title, belongs in GROUPS.items():
        chosen = [m for m in all_methods if belongs(m)]
        text += f"**{title}**\n\n" + table(
            ["method", "order", "stages", "n_F", "r", "error constant", "recommended for"],
            [[f"[{m['name']}](methods/{m['name']}.md)", m["order"], m["stages"], m["explicit_evaluations"], coefficient(m),
              number(m["error_constant"]), plain(m["purpose"])] for m in chosen])
    text += "## Families\n\nAny number of stages S of the range gives a method, which is certified when it is asked for.\n\n"
    text += table(["family", "S", "what"], [[f"`{f['name']}`", f"{f['lowest']} … {f['highest']}", plain(f["description"])]
                                            for f in program.list("families")])
    return text + "```{toctree}\n:hidden:\n\n" + "\n".join(f"methods/{m['name']}" for m in all_methods) + "\n```\n"


def method(program: Program, m: dict, choices: list[dict], with_pictures: bool = True) -> str:
    """Returns the page of a method: facts, when to use it, steps, coefficients and pictures."""
    document = json.loads(program("show", m["name"], "--format", "json"))
    stability = m.get("stability") or {}
    text = f"# {m['name']}\n\n{plain(m['title'])}.\n\n" + facts({
        "order": f"{m['order']}, error constant {number(m['error_constant'])}",
        "type": f"{m['type']}, {'globally stiffly accurate' if m['gsa'] else 'not globally stiffly accurate'}"
                if m["kind"] != "explicit" else "",
        "cost of a step": f"{m['explicit_evaluations']} evaluations of T, {m['implicit_solves']} implicit solves, "
                          f"{m['buffers']} states in memory",
        "embedded solution": m["embedded"] and f"of order {m['embedded']['order']}",
        "source": plain(document["citation"]), "origin": plain(document["origin"]),
        "coefficients": f"[methods/{m['name']}.toml](../../../methods/{m['name']}.toml)"})
    text += "## When to use it\n\n" + when_to_use(m, choices)
    text += "## Steps\n\n" + facts({
        "SSP coefficient": coefficient(m) + (f" (that of the explicit part is {number(m['explicit_radius'])})" if m["kind"] == "imex" else "")
                           + (f"; {plain(m['limiting_entry'])}" if m["limiting_entry"] else ""),
        "stability of the implicit part": stability and f"A({rounded_down(stability['angle_degrees'])}°)"
                                          + (", L-stable" if stability["l_stable"] else "")})
    if limits := m.get("cfl_limits"):
        text += "The largest CFL numbers with linear stability, by the reconstruction:\n\n"
        text += table([f"`{name}`" for name in limits], [[number(limit) for limit in limits.values()]])
    if with_pictures and m["kind"] in DRAWN:
        text += f"![regions of linear stability of {m['name']}](../../images/{m['name']}-stability.png)\n\n"
    text += "## Coefficients\n\n"
    if m["stages"] <= SHOWN:
        text += "$$\n" + re.sub(r"^%.*\n", "", program("show", m["name"], "--format", "latex")) + "$$\n\n"
    else:
        text += f"`apsis show {m['name']}` prints all digits.\n\n"
    if with_pictures and m["kind"] in DRAWN:
        text += f"![Butcher form of {m['name']}](../../images/{m['name']}-tableau.png)\n\n"
    return text


def when_to_use(m: dict, choices: list[dict]) -> str:
    """Returns the purpose of a method, where `time.method = "auto"` chooses it, and its limits as certificate data state them."""
    chosen = [plain(choice["description"]) for choice in choices if choice["name"] == m["name"]]
    regime = m.get("intermediate_regime") or {}
    found = facts({"recommended for": plain(m["purpose"]),
                   "`time.method = \"auto\"` chooses it for": "; ".join(chosen),
                   "signs": "kept for every step" if coefficient(m) == "any step" else "kept up to the SSP coefficient" if m["ssp_coefficient"] else "not kept",
                   "asymptotic preserving": limit(m) if m["kind"] in ("imex", "exponential") else "",
                   "terms of size ε": TERMS.get(regime.get("keeps"), "")})
    return found + "[The choice of a method](../../methods.md#the-choice-of-a-method) compares it with others.\n\n"


def write_methods(program: Program, folder: Path, images: Path, drawn: list[str] | None):
    """Writes a page for each method, with pictures of the methods in `drawn`; None: of all."""
    all_methods, choices = program.list("methods"), program.list("choices")
    folder.mkdir(parents=True, exist_ok=True)
    wanted = [m["name"] for m in all_methods if m["kind"] in DRAWN and (drawn is None or m["name"] in drawn)]
    for m in all_methods:
        (folder / f"{m['name']}.md").write_text(method(program, m, choices, m["name"] in wanted), encoding="utf-8")
    program("plot", *wanted, "--out", str(images))


def models(program: Program) -> str:
    text = ("# Models\n\nThe equations of `apsis list models`; [models](../models.md) explains "
            "them. Parameters belong to the table `[model]` of a case.\n\n")
    for m in program.list("models"):
        text += f"## {m['name']}\n\n`{m['description']}`\n\n" + facts({
            "source": plain(m["source"]),
            "tables of a case": ", ".join(f"`[{t}]`" for t in ("model", "space", "velocity", "time", "output") if m.get(t, True)),
            "initial data": ", ".join(f"`{name}`" for name in m["initial"])})
        rows = [[f"`{one['name']}`", f"list of formulas in `{one['formulas_in']}`" if one["formulas_in"] else "list of names",
                 ", ".join(f"`{item}`" for item in one["default"]), plain(one["doc"])] for one in m["lists"]]
        rows += [[f"`{p['name']}`", f"number, {p['lowest']:g} to {p['highest']:g}" + (" or `auto`" if p["automatic"] else ""),
                  "`auto`" if p["automatic"] else f"`{p['default']:g}`", plain(p["doc"])] for p in m["parameters"]]
        rows += [[f"`{t['name']}`", ", ".join(f"`{c}`" for c in t["choices"])
                  + (f" or a formula in `{t['formula_in']}`" if t["formula_in"] else ""), f"`{t['default']}`", plain(t["doc"])]
                 for t in m["texts"]]
        text += table(["parameter", "values", "default", "meaning"], rows) if rows else ""
    return text


def method_link(name: str, known: set[str]) -> str:
    """Returns a link to the page of a method of the catalogue; members of families have no page."""
    return f"[{name}](methods/{name}.md)" if name in known else f"`{name}`"


def cases(program: Program) -> str:
    all_cases, known = program.list("cases"), {m["name"] for m in program.list("methods")}
    text = ("# Cases\n\nThe built-in cases, from `apsis list cases`. `apsis run NAME` runs one, and `key=value` after "
            "the name changes a [key](keys.md).\n\n")
    for folder in dict.fromkeys(c["name"].partition("/")[0] for c in all_cases):
        text += f"**{folder}**\n\n" + table(["case", "description", "model", "method"],
            [[f"[{c['name']}](#{c['name'].replace('/', '')})", plain(c["description"]), f"[{c['model']}](models.md#{c['model']})",
              method_link(c["method"], known)] for c in all_cases if c["name"].startswith(f"{folder}/")])
    for c in all_cases:
        file = program("show", c["name"])
        comment = re.match(r"(?:#.*\n)*", file)[0]
        text += (f"## {c['name']}\n\n{prose(re.sub(r'^# ?', '', comment, flags=re.M))}\n"
                 f"```toml\n{file.removeprefix(comment).strip()}\n```\n\n")
    return text


def keys(program: Program) -> str:
    all_keys, models_of = program.list("keys"), {m["name"] for m in program.list("models")}
    text = ("# Keys of a case\n\nA case is a TOML file with these keys, `apsis list keys`. A key that is not listed, or that the "
            "model of the case does not use, is an error. On the command line `space.cells=80` sets one; there a number may be a "
            "fraction.\n\n")
    section = None
    for k in all_keys:
        if k["name"].rpartition(".")[0] != section:
            section = k["name"].rpartition(".")[0]
            text += f"## [{section}]\n\n" if section else "## The case\n\n"
        choices = [] if k["name"] in ("time.method", "model.initial") else k["choices"]
        default = "" if k["default"] in (None, '""') else f"default `{k['default']}`"
        about = [k["type"], k["range"], "" if k["unit"] == "dimensionless" else k["unit"],
                 "required" if k["required"] else default]
        text += f"### `{k['name']}`\n\n*{', '.join(a for a in about if a)}*\n\n{plain(k['description'])}\n\n" + facts({
            "one of": ", ".join(f"`{c}`" for c in choices),
            "for the models": "" if set(k["models"]) == models_of else ", ".join(f"[{m}](models.md#{m})" for m in k["models"])})
    return text + ("The table `[model]` also takes the parameters of its [model](models.md). `[parameters]` holds constants of formulas, and "
                   "`[initial]` [initial data](../initial-data.md) by formulas.\n")


def schemes(program: Program) -> str:
    return ("# Schemes in space\n\nReconstructions of values at cell edges, for `space.reconstruction`; [space](../space.md) explains "
            "their use.\n\n" + table(
                ["name", "order", "ghost cells", "what", "source"],
                [[f"`{s['name']}`", s["order"], s["ghost_width"], plain(s["description"]), plain(s["source"])]
                 for s in program.list("schemes")])
            + "\nFormulations, for `space.formulation`: what the unknown of a cell is, and where cells collide.\n\n" + table(
                ["name", "unknowns", "dimensions", "`space.collisions`", "what", "source"],
                [[f"`{f['name']}`", f["unknown"], "1" if f["only_on_a_line"] else "1 to 3",
                  ", ".join(f"`{c}`" for c in f["collisions"]) or "-", plain(f["description"]), plain(f["source"])]
                 for f in program.list("formulations")]))


def claims(program: Program) -> str:
    return ("# Claims\n\nClaims of the paper, and how `apsis reproduce` checks them; "
            "[verdicts](../claims.md).\n\n"
            + table(["", "statement", "section of the paper", "how it is checked"],
                    [[c["name"], plain(c["description"]), plain(c["section"]), plain(c["how"])] for c in program.list("claims")]))


def commands(program: Program) -> str:
    manual = json.loads(program("manual", "--format", "json"))
    text = f"# Commands\n\n{plain(manual['description'])}\n\n{plain(manual['exit_codes'])}\n\n"
    for c in manual["commands"]:
        text += f"## apsis {c['name']}\n\n{plain(c['description'])}.\n\n" + table(
            ["argument", "meaning", "default"],
            [[f"`{o['usage']}`", plain(o["description"]) + (" (required)" if o["required"] else ""),
              f"`{o['default']}`" if o["default"] else ""] for o in c["options"] if o["usage"] != "--help"])
        text += prose(c["more"]) + "\n\n"
    return text


PAGES = {"commands": commands, "keys": keys, "cases": cases, "methods": methods, "models": models, "schemes": schemes,
         "claims": claims}


def write_reference(program: Path, folder: Path, images: Path, drawn: list[str] | None) -> list[str]:
    """Writes one page for each list and each method, with pictures of the methods in `drawn` (None: of all). Returns the names of the
    lists in the order of PAGES."""
    folder.mkdir(parents=True, exist_ok=True)
    write_methods(Program(program), folder / "methods", images, drawn)
    for name, page in PAGES.items():
        (folder / f"{name}.md").write_text(page(Program(program)), encoding="utf-8")
    return list(PAGES)
