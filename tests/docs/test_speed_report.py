"""bench/report.py keeps earlier measurements: a new file replaces only the tables that it has."""
import copy
import importlib.util
import re
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def report():
    sys.path.insert(0, str(ROOT / "bench"))
    spec = importlib.util.spec_from_file_location("speed_report", ROOT / "bench/report.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def result(rows, points=()):
    return {"title": "", "note": "", "columns": ["method"], "rows": rows, "repeats": 1,
            "machine": {"date": "2026-11-26T00:00:00Z", "processor": "Test 1", "cores": 1, "kernels": "AVX2", "compiler": "GNU"},
            "data": {"points": list(points)}}


RUN = {"contestant": "a", "epsilon": 1.0, "error": 1e-3, "seconds": 0.5, "smallest": 0.25, "league": "ssp", "ours": True,
       "setting": "dt = 1", "steps": 4}


class SpeedReport(unittest.TestCase):
    def test_a_new_table_replaces_itself_and_no_other(self):
        module = report()
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            module.keep(module.compact({"peers-kaps": result([["a"]], [copy.deepcopy(RUN)]), "plain": result([["old"]])}), folder)
            before = module.newest_first(folder)[0]
            module.keep(module.compact({"plain": result([["new"]])}), folder)
            after = module.newest_first(folder)[0]
            self.assertEqual(len(list(folder.glob("*.json.gz"))), 1)
            self.assertEqual(after["plain"]["rows"], [["new"]])
            self.assertEqual(after["peers-kaps"], before["peers-kaps"])
            self.assertEqual({point["error"] for point in after["peers-kaps"]["data"]["points"]}, {1e-3})
            self.assertIn("runs", module.records.read(next(folder.glob("*.json.gz")))["peers-kaps"]["data"]["points"][0])

    def test_lanes_on_the_host_have_no_figures_of_a_device(self):
        module, lanes, card = report(), result([["a"]]), result([["b"]])
        lanes["data"]["is_device"], card["data"]["is_device"] = False, True
        self.assertEqual(module.compact({"device": lanes, "plain": result([])}).keys(), {"plain"})
        self.assertEqual(module.compact({"device": card}).keys(), {"device"})

    def test_a_table_is_that_of_the_machine_that_measured_it_last(self):
        module = report()
        first, second = result([["old"]], [copy.deepcopy(RUN)]), result([["new"]], [copy.deepcopy(RUN)])
        second["machine"] = second["machine"] | {"date": "2026-11-27T00:00:00Z", "processor": "Test 2"}
        later = result([["later"]], [copy.deepcopy(RUN)])
        later["machine"] = later["machine"] | {"date": "2026-11-28T00:00:00Z"}
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            module.keep(module.compact({"plain": first, "peers-kaps": later}), folder)
            module.keep(module.compact({"plain": second, "peers-kaps": copy.deepcopy(second)}), folder)
            module.forget_superseded(module.newest_first(folder), folder)
            machines = module.newest_first(folder)
            newest = module.newest_tables(machines)
            self.assertEqual([newest["plain"]["rows"], newest["peers-kaps"]["rows"]], [[["new"]], [["later"]]])
            self.assertEqual([bool(machine["plain"]["data"]["points"]) for machine in machines], [False, True])  # newest machine first
            self.assertEqual([bool(machine["peers-kaps"]["data"]["points"]) for machine in machines], [True, False])
            self.assertIn("2026-11-26 to 2026-11-28, Test 1", module.measured_on(*machines[0].values()))

    def test_a_table_longer_than_a_screen_is_a_file_and_its_page_has_the_best_rows(self):
        module = report()
        rows = [["best of Apsis"], ["best of the others"], *([f"method {k}"] for k in range(module.SCREEN))]
        with tempfile.TemporaryDirectory() as folder:
            folder = Path(folder)
            (folder / "gone.csv").write_text("", encoding="utf-8")
            module.write_long_tables({"long": result(rows), "short": result(rows[:module.SCREEN])}, folder)
            self.assertEqual([path.name for path in folder.iterdir()], ["long.csv"])
            self.assertEqual((folder / "long.csv").read_text(encoding="utf-8").splitlines(), ["method", *(row[0] for row in rows)])
        text = module.section("long", result(rows))
        self.assertEqual([line for line in text.splitlines() if line.startswith("| ")], ["| method |", "| best of Apsis |", "| best of the others |"])
        self.assertIn("(data/speed/long.csv)", text)
        text = module.section("short", result(rows[:module.SCREEN]))
        self.assertEqual(sum(line.startswith("| method ") for line in text.splitlines()), module.SCREEN - 2 + 1)  # the head is counted, too

    def test_a_table_has_the_name_of_its_file(self):
        # bench/CMakeLists.txt takes the names of tables that are not built from their files.
        files = sorted(ROOT.glob("bench/measure/tables/**/*.cpp"))
        self.assertGreater(len(files), 20)
        for file in files:
            text = file.read_text(encoding="utf-8")
            self.assertEqual(re.findall(r'registered here\(\s*\{(?:\.name = )?"([^"]+)"', text), [file.stem.replace("_", "-")], file)

    def test_only_tables_in_a_folder_of_their_own_need_sundials(self):
        def includes(file):
            """Returns the headers of bench that a file includes, directly or not, and the names of all others."""
            own, other, waiting = set(), set(), [file]
            while waiting:
                current = waiting.pop()
                for sign, name in re.findall(r'^#include ([<"])([^>"]+)', current.read_text(encoding="utf-8"), re.M):
                    found = next((path for path in (current.parent / name, ROOT / "bench" / name) if path.is_file()), None)
                    if found is None:
                        self.assertEqual(sign, "<", f"{current} includes {name}")
                        other.add(name)
                    elif found.resolve() not in own:
                        own.add(found.resolve())
                        waiting.append(found.resolve())
            return own, other

        for file in sorted(ROOT.glob("bench/**/*.cpp")):
            if "with_sundials" not in file.parts:
                own, other = includes(file)
                self.assertEqual([name for name in other if re.match(r"(sundials|arkode|cvode|nvector|sun\w+)/", name)], [], file)
                self.assertEqual([header for header in own if "with_sundials" in header.parts], [], file)

    def test_pages_have_the_tables_of_the_newest_measurements(self):
        module = report()
        results = module.newest_tables(module.newest_first(ROOT / "docs" / "data" / "speed"))
        self.assertGreater(len(results), 15)
        for name, table in results.items():
            page = ROOT / "docs" / module.PAGES.get(name, module.MEASURED)
            self.assertIn(f"<!-- {name} -->\n\n{module.section(name, table)}\n\n<!-- end -->", page.read_text(encoding="utf-8"), page)


if __name__ == "__main__":
    unittest.main()
