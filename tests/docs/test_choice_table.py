"""The table of the methods that time.method = "auto" chooses follows from the measured contests in docs/data/speed."""
import json
import math
import os
import subprocess
import sys
import unittest
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "bench"))
import records  # noqa: E402

BUILD = Path(os.environ.get("APSIS_BUILD", ROOT / "build/release"))
MIXED = ("peers-mixed-points", "peers-mixed", "peers-mixed-centres")
SYSTEMS = ("peers-ode", "peers-prothero-robinson", "peers-kaps")


def newest(table):
    """Returns the most recently measured table of this name."""
    files = [records.read(path) for path in (ROOT / "docs/data/speed").glob("*.json.gz")]
    return max((one[table] for one in files if table in one), key=lambda one: one["machine"]["date"])


def column(result, error):
    return next(k for k, name in enumerate(result["columns"]) if name.startswith(f"error {error} "))


def is_ssp(name):
    return name.startswith(("md-imex", "hsz", "forward-backward-euler"))


def costs(table, error):
    """Returns the CPU times to this error by contestant, for implicit-explicit one-step methods of the library."""
    result = newest(table)
    k = column(result, error)
    found = {}
    for row in result["rows"]:
        name = row[0]
        if not row[k] or row[k] == "—" or name.startswith(("best", "CVODE", "ARKODE", "Radau", "ssprk", "imex-bdf", "two-step", "exponential")):
            continue
        found[name] = float(row[k].split()[0])
    return found


def best_on_meshes(errors, wanted):
    """Returns the method that has the smallest geometric mean of times relative to the best one, over contests and errors. Only
    contestants that reach all errors of all contests can be chosen."""
    ratios, cells = {}, 0
    for table in MIXED:
        for error in errors:
            found = {name: time for name, time in costs(table, error).items() if wanted(name)}
            if not found:
                continue
            cells += 1
            for name, time in found.items():
                ratios.setdefault(name, []).append(time / min(found.values()))
    mean = {name: math.exp(sum(map(math.log, own)) / cells) for name, own in ratios.items() if len(own) == cells}
    return min(mean, key=mean.get).removesuffix(", adaptive")


def wins_on_systems(label, epsilons, errors, allowed=lambda name: True):
    """Returns the allowed method that wins most often in the contests on systems of two unknowns."""
    wins = Counter()
    for table in SYSTEMS:
        result = newest(table)
        for row in result["rows"]:
            if row[1] != label or row[0] not in epsilons:
                continue
            for error in errors:
                if row[column(result, error)]:
                    wins[row[column(result, error)].split(" ", 1)[1].removesuffix(", adaptive")] += 1
    return next(name for name, _ in wins.most_common() if allowed(name))


ALL = ("0.001", "0.0001", "1e-05", "1e-06", "1e-07", "1e-08", "1e-09")
STIFF = ("0.01", "0.0001", "1e-06", "1e-10")


class ChoiceTable(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        text = subprocess.run([BUILD / "app/apsis", "list", "choices", "--json"], capture_output=True, text=True, check=True).stdout
        cls.rows = json.loads(text)

    def chosen(self, problem, signs, tolerance_from=None, explicit=False, longest=False):
        found = [row["name"] for row in self.rows if row["problem"] in (problem, "any") and row["signs"] in (signs, None)
                 and row["tolerance_from"] == tolerance_from and row["explicit"] == explicit and row["longest_steps"] == longest]
        self.assertEqual(len(found), 1, (problem, signs, tolerance_from))
        return found[0]

    def test_equal_steps_on_meshes_are_those_of_the_best_method_with_an_ssp_coefficient(self):
        best = best_on_meshes(("0.001", "0.0003", "0.0001", "1e-05"), lambda name: is_ssp(name) and "adaptive" not in name)
        self.assertEqual(self.chosen("space", True), best)
        self.assertEqual(self.chosen("space", False), best)

    def test_longest_steps_on_meshes_are_those_of_the_method_with_the_least_time(self):
        table = newest("transit")
        method, mean = table["columns"].index("method"), table["columns"].index("mean")
        self.assertEqual(self.chosen("space", None, longest=True), min(table["rows"], key=lambda row: float(row[mean]))[method])

    def test_steps_by_tolerance_on_meshes(self):
        def adaptive(name):
            return name.endswith(", adaptive")
        self.assertEqual(self.chosen("space", False, 1e-4), best_on_meshes(("0.001", "0.0003", "0.0001"), adaptive))
        self.assertEqual(self.chosen("space", False, 0.0), best_on_meshes(("0.0001", "1e-05"), adaptive))
        self.assertEqual(self.chosen("space", True, 0.0), best_on_meshes(("0.001", "0.0003", "0.0001", "1e-05"),
                                                                         lambda name: adaptive(name) and is_ssp(name)))

    def test_systems_with_a_general_collision(self):
        table = newest("stiff-methods")
        mean = table["columns"].index("mean")
        self.assertEqual(self.chosen("general", False, 0.0), min(table["rows"], key=lambda row: float(row[mean]))[0])

    def test_systems_of_two_unknowns(self):
        self.assertEqual(self.chosen("system", False, explicit=True), wins_on_systems("best of Apsis", ("1",), ALL))
        self.assertEqual(self.chosen("system", False), wins_on_systems("best of Apsis", STIFF, ALL))
        for tolerance, errors in ((1e-4, ALL[:2]), (1e-6, ALL[2:4]), (0.0, ALL[4:])):
            self.assertEqual(self.chosen("system", False, tolerance),
                             wins_on_systems("best with steps by tolerance", ("1", *STIFF), errors), tolerance)


if __name__ == "__main__":
    unittest.main()
