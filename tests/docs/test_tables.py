"""Tables of README.md, docs/methods.md and docs/claims.md agree with the program; a new table needs a test."""
import json
import os
import re
import subprocess
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("APSIS_BUILD", ROOT / "build" / "release"))
README = (ROOT / "README.md").read_text(encoding="utf-8")
METHODS = (ROOT / "docs/methods.md").read_text(encoding="utf-8")
CLAIMS = (ROOT / "docs/claims.md").read_text(encoding="utf-8")

# Claims on coefficients and orders alone. Their figures are the same on every machine and take seconds.
EXACT_CLAIMS = ["C1", "C2", "C3", "C4", "C5", "C6", "C7", "C8", "C9", "C11", "C16", "C25"]


def apsis(*arguments):
    done = subprocess.run([BUILD / "app/apsis", *arguments], text=True, capture_output=True)
    if done.returncode != 0:
        raise AssertionError(f"apsis {' '.join(map(str, arguments))}: {done.stderr}")
    return done.stdout


def tables(text):
    """Returns the head and the rows of stripped cells of every table."""
    found = []
    for block in re.findall(r"(?:^\|.*\n)+", text, re.MULTILINE):
        rows = [[cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]] for line in block.splitlines()]
        found.append((rows[0], rows[2:]))
    return found


def table(text, *head):
    return next(rows for first, rows in tables(text) if first[:len(head)] == list(head))


def joined_tables(text, *head):
    """Returns the rows of all tables with this head, in their order."""
    return [row for first, rows in tables(text) if first[:len(head)] == list(head) for row in rows]


def method_problems(rows, methods, members):
    """Returns the differences between rows of the table of methods and the certificates.

    `members` returns the members of a family, each with its S.
    """
    problems = []
    listed = []
    for names, orders, acts_on, coefficients, source in rows:
        of_row = re.findall(r"`([^`]+)`", names)
        listed += of_row
        orders, coefficients = orders.split(", "), coefficients.split(", ")
        for k, name in enumerate(of_row):
            order, said = orders[k if len(orders) > 1 else 0], coefficients[k if len(coefficients) > 1 else 0]
            if "S" in name:
                for number, certificate in members(name):
                    offset = re.fullmatch(r"S − (\d+)", said)
                    wanted = number - int(offset[1]) if offset else 0 if said == "not SSP here" else None
                    if certificate["ssp_coefficient"] != wanted or certificate["order"] != (number if order == "S" else int(order)):
                        problems.append(f"{name} with S = {number}: {order}, {said}")
                continue
            if name not in methods:
                problems.append(f"{name}: no such method")
                continue
            certificate = methods[name]
            if str(certificate["order"]) != order:
                problems.append(f"{name}: order {order}")
            if {"implicit": "Q", "imex": "T + Q", "explicit": "T + Q, explicit", "exponential": "T + Q, exponential"}[certificate["kind"]] != acts_on:
                problems.append(f"{name}: of {acts_on}")
            r = certificate["ssp_coefficient"]
            if said == "any step":
                right = r is None and certificate["unconditional"]
            elif said == "not SSP here":
                right = r == 0
            else:
                right = r is not None and f"{r:.{len(said.partition('.')[2])}f}" == said
            if not right:
                problems.append(f"{name}: SSP coefficient {said}")
    problems += [f"{name}: listed twice" for name in set(listed) if listed.count(name) > 1]
    return problems


class Methods(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.rows = joined_tables(METHODS, "name", "order", "of")
        cls.methods = {m["name"]: m for m in json.loads(apsis("list", "methods", "--json"))}
        cls.families = {f["name"]: f for f in json.loads(apsis("list", "families", "--json"))}

    def members(self, name):
        lowest = self.families[name]["lowest"]
        return [(s, json.loads(apsis("check", name.replace("S", str(s)), "--json"))) for s in (lowest, lowest + 4)]

    def test_recommended_methods_have_these_properties(self):
        rows = [[*row[1:], ""] for row in table(METHODS, "use it for", "method", "order", "of")]
        self.assertGreater(len(rows), 3)
        self.assertEqual(method_problems(rows, self.methods, self.members), [])

    def test_every_row_agrees_with_the_certificate(self):
        self.assertEqual(method_problems(self.rows, self.methods, self.members), [])

    def test_every_family_has_a_row_with_its_range(self):
        rows = {re.match(r"`(\S+)`, any S ≥ (\d+)$", row[0]).groups() for row in self.rows if "any S" in row[0]}
        self.assertEqual(rows, {(name, str(family["lowest"])) for name, family in self.families.items()})

    def test_error_constants_agree_with_the_certificates(self):
        said = next(re.search(r"error constants ([\d.]+) and ([\d.]+) \(`md-imex-6-3`: ([\d.]+)\)", row[4]) for row in self.rows
                    if "md-imex-8-3-accurate" in row[0])
        for text, name in zip(said.groups(), ("md-imex-8-3-accurate", "md-imex-8-3-balanced", "md-imex-6-3")):
            decimals = len(text.partition(".")[2])
            self.assertEqual(f"{self.methods[name]['error_constant']:.{decimals}f}", text, name)

    def test_a_wrong_entry_of_each_kind_is_reported(self):
        def problems(name, column, text):
            rows = [list(row) for row in self.rows]
            next(row for row in rows if f"`{name}`" in row[0])[column] = text
            return method_problems(rows, self.methods, self.members)

        self.assertEqual(problems("md-imex-6-3", 1, "4"), ["md-imex-6-3: order 4"])
        self.assertEqual(problems("md-imex-6-3", 2, "Q"), ["md-imex-6-3: of Q"])
        self.assertEqual(problems("md-imex-6-3", 3, "0.9045"), ["md-imex-6-3: SSP coefficient 0.9045"])
        self.assertEqual(problems("md-imex-6-3", 3, "any step"), ["md-imex-6-3: SSP coefficient any step"])
        self.assertEqual(problems("imdrk-2-3", 3, "not SSP here"), ["imdrk-2-3: SSP coefficient not SSP here"])
        self.assertEqual(problems("ars-222", 0, "`ars-223`"), ["ars-223: no such method"])
        self.assertEqual(problems("md-imex-chain-S-2", 3, "S − 1"),
                         [f"md-imex-chain-S-2 with S = {s}: 2, S − 1" for s in (3, 7)])


class Speed(unittest.TestCase):
    def test_rows_of_the_front_page_are_rows_of_the_page_on_speed(self):
        speed = (ROOT / "docs/speed.md").read_text(encoding="utf-8")
        rows = table(README, "measure")
        self.assertEqual(len(rows), 2)
        self.assertEqual([row for row in rows if row not in table(speed, "measure")], [], "write both again: bench/report.py")


class Claims(unittest.TestCase):
    def test_every_row_agrees_with_a_claim_of_the_program_and_holds(self):
        claims = json.loads(apsis("list", "claims", "--json"))
        rows = table(CLAIMS, "claim", "statement")
        said = [[row[0], row[1].replace("\\|", "|"), row[2].replace("\\|", "|")] for row in rows]
        self.assertEqual(said, [[c["name"], c["description"], c["how"]] for c in claims], "write it again: make reproduce")
        self.assertEqual({row[4] for row in rows}, {"holds"})
        self.assertIn(f"{len(claims)} of {len(claims)} claims hold", CLAIMS)

    def test_figures_that_do_not_depend_on_the_machine_are_reproduced(self):
        with tempfile.TemporaryDirectory() as folder:
            apsis("reproduce", *EXACT_CLAIMS, "--out", folder)
            again = (Path(folder) / "claims.md").read_text(encoding="utf-8")
        rows = {row[0]: row for row in table(CLAIMS, "claim", "statement")}
        self.assertEqual(table(again, "claim", "statement"), [rows[name] for name in EXACT_CLAIMS])
        for remark in re.findall(r"^- \*\*C.*$", again, re.MULTILINE):
            self.assertIn(f"\n{remark}\n", CLAIMS)


class Tables(unittest.TestCase):
    def test_every_table_has_a_test(self):
        self.assertEqual([head[0] for head, _ in tables(README)], ["measure"])
        self.assertEqual([head[0] for head, _ in tables(CLAIMS)], ["claim"])


if __name__ == "__main__":
    unittest.main()
