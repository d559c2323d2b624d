"""A new part of the library needs no change of existing files. A boundary, shape of bodies, model with its fields, reconstruction,
discretization, command, claim, quantity, case and method are one file each, and a kind of integrator three.

The files of planted/ are copied into a copy of the sources. Only a kind of integrator also needs an entry in
integrate/any_stepper.hpp. The program built from these sources lists and uses all parts.
"""
import csv
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
SOURCE = HERE.parents[1]
PARTS = ("CMakeLists.txt", "CMakePresets.json", "LICENSE", "README.md", "app", "cases", "cmake", "methods", "paper", "python",
         "scripts", "src", "validation")

# The entry of a kind of integrator: lines of the header, each with its replacement.
ENTRY = ("src/apsis/integrate/any_stepper.hpp",
         (("#include <apsis/integrate/kinds/runge_kutta.hpp>\n",
           "#include <apsis/integrate/kinds/planted_halves.hpp>\n#include <apsis/integrate/kinds/runge_kutta.hpp>\n"),
          ("    std::tuple<runge_kutta_steps,", "    std::tuple<planted_halves_steps, runge_kutta_steps,")))
# A method file for each kind that has files. It is a copy from the catalogue, under another name.
COPIES = {"planted-explicit": "ssprk-3-3", "planted-implicit": "dirk-2-2", "planted-exponential": "exponential-2",
          "planted-two-step": "two-step-8-3-narrow"}


def output_of(*command: str, folder: str | None = None) -> str:
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(command)}: exit code {done.returncode}\n{done.stdout[-3000:]}\n{done.stderr[-3000:]}")
    return done.stdout


class OneFile(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        root = Path(cls.folder.name)
        for part in PARTS:
            copy = shutil.copytree if (SOURCE / part).is_dir() else shutil.copy
            copy(SOURCE / part, root / part)
        planted = [file for file in (HERE / "planted").rglob("*") if file.is_file()]
        for file in planted:
            target = root / file.relative_to(HERE / "planted")
            assert not target.exists(), f"{target} exists: a planted file must be new"
            target.parent.mkdir(exist_ok=True)
            shutil.copy(file, target)
        for name, source in COPIES.items():
            text = (SOURCE / "methods" / f"{source}.toml").read_text(encoding="utf-8")
            (root / "methods" / f"{name}.toml").write_text(text.replace(f'name = "{source}"', f'name = "{name}"'), encoding="utf-8")
        cls.files_of_kind = [file for file in planted if "planted_halves" in file.name] + [root / ENTRY[0]]
        text = (root / ENTRY[0]).read_text(encoding="utf-8")
        for old, new in ENTRY[1]:
            assert text.count(old) == 1, f"{ENTRY[0]}: {old}"
            text = text.replace(old, new)
        (root / ENTRY[0]).write_text(text, encoding="utf-8")
        build = root / "build"
        output_of("cmake", "-S", str(root), "-B", str(build), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DAPSIS_TESTS=OFF",
                  "-DAPSIS_BENCH=OFF", "-DAPSIS_PYTHON_PACKAGE=OFF", f"-DCMAKE_CXX_COMPILER={os.environ['APSIS_CXX']}")
        output_of("cmake", "--build", str(build), "--target", "apsis_program")
        cls.program = str(build / "app/apsis")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def names(self, what):
        return [item["name"] for item in json.loads(output_of(self.program, "list", what, "--json"))]

    def test_every_kind_is_listed(self):
        self.assertIn("planted-exchange", self.names("models"))
        self.assertIn("planted-3-2", self.names("methods"))
        self.assertIn("planted/exchange", self.names("cases"))
        self.assertIn("C99", self.names("claims"))
        keys = {item["name"]: item for item in json.loads(output_of(self.program, "list", "keys", "--json"))}
        self.assertIn("planted-wall", keys["space.boundary"]["choices"])
        self.assertIn("planted-upwind", keys["space.reconstruction"]["choices"])
        self.assertEqual(keys["space.formulation"]["choices"], ["finite-volume", "finite-difference", "planted-averages"])

    def test_a_method_of_each_kind_is_a_file_of_one_folder(self):
        one_step, several = self.names("methods"), self.names("multistep")
        for name, source in COPIES.items():
            self.assertIn(name, several if source.startswith("two-step") else one_step)
            checked = json.loads(output_of(self.program, "check", name, "--json"))
            self.assertEqual(checked | {"name": source}, json.loads(output_of(self.program, "check", source, "--json")))
        for name in ("planted-exponential", "planted-two-step"):
            run = [json.loads(output_of(self.program, "run", "paper/ode", f"time.method={one}", "time.dt=0.01", "--json"))
                   for one in (name, COPIES[name])]
            self.assertEqual(run[0]["fields"], run[1]["fields"])

    def test_a_kind_of_integrator_is_listed_checked_and_run_with_three_files(self):
        self.assertLessEqual(len(self.files_of_kind), 3)
        self.assertIn("planted-halves", self.names("multistep"))
        self.assertIn("planted-halves", output_of(self.program, "list", "methods"))
        self.assertEqual(json.loads(output_of(self.program, "check", "planted-halves", "--json"))["order"], 1)
        self.assertIn("all claims hold", output_of(self.program, "check", "planted-halves"))
        found, steps = [json.loads(output_of(self.program, "run", "paper/ode", f"time.method={method}", f"time.dt={dt}", "--json"))
                        for method, dt in (("planted-halves", "0.0625"), ("forward-backward-euler", "0.03125"))]
        self.assertEqual(found["fields"], steps["fields"])
        self.assertEqual(2 * found["steps"], steps["steps"])

    def test_the_tables_of_methods_in_the_docs_need_no_row(self):
        done = subprocess.run([sys.executable, "-m", "unittest", "test_tables.Methods"], cwd=SOURCE / "tests/docs", text=True,
                              env=os.environ | {"APSIS_BUILD": str(Path(self.program).parents[1])}, capture_output=True)
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_a_command_is_found_and_in_the_help(self):
        self.assertEqual(output_of(self.program, "planted"), "planted and found\n")
        self.assertIn("Show that a command is one file", output_of(self.program, "--help"))

    def test_a_case_uses_all_of_them(self):
        result = json.loads(output_of(self.program, "run", "planted/exchange", "--json"))
        # In the steady state, the values at both velocities are the inflow of the walls, 0.25. The slowest mode has decayed like
        # exp(-pi^2 epsilon t) ~ 7e-6, but more slowly because of the layers at the walls, hence the tolerance.
        for rho in result["fields"]["rho"]:
            self.assertAlmostEqual(rho, 0.5, delta=2e-3)
        self.assertEqual(result["negative_values"], 0)

    def test_a_field_of_the_results_is_part_of_its_model(self):
        usual = json.loads(output_of(self.program, "run", "planted/exchange", "--json"))["fields"]
        self.assertNotIn("flux", usual)
        fields = json.loads(output_of(self.program, "run", "planted/exchange", "output.fields=flux", "--json"))["fields"]
        # In the steady state, equal numbers of particles move in both directions. The tolerance is that of the density.
        for flux in fields["flux"]:
            self.assertAlmostEqual(flux, 0.0, delta=2e-3)

    def test_a_discretization_is_one_file(self):
        def density(formulation, cells):
            result = json.loads(output_of(self.program, "run", "paper/bgk-mixed", f"space.formulation={formulation}",
                                          f"space.cells={cells}", "model.epsilon=0.05", "time.end=0.2", "velocity.points=60",
                                          "--json"))
            self.assertLess(result["conservation_defect"], 1e-13)  # rounding errors of some thousand steps
            self.assertEqual(result["negative_values"], 0)
            return result["fields"]["rho"]
        # Collisions of cell averages differ from collisions at Gauss points by a term of second order.
        differences = [max(abs(a - b) for a, b in zip(density("planted-averages", cells), density("finite-volume", cells), strict=True))
                       for cells in (40, 80)]
        self.assertGreater(differences[0], 1e-7)
        self.assertGreater(differences[0] / differences[1], 3)
        self.assertIn("planted-averages", self.names("formulations"))
        refused = subprocess.run([self.program, "run", "gas/cavity", "space.formulation=planted-averages"], capture_output=True,
                                 text=True, check=False)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("planted averages are those of intervals: one space dimension only", refused.stderr)

    def test_a_shape_of_bodies_is_one_file(self):
        self.assertIn("planted-diamond", self.names("shapes"))
        out = Path(self.folder.name) / "past_a_diamond"
        output_of(self.program, "run", "gas/cylinder", "space.body.1.shape=planted-diamond", "space.cells=[16,8]",
                  "space.domain=[[-2,2],[0,2]]", "velocity.points=16", "time.end=0", "output.surfaces=[\"cylinder\"]",
                  "--out", str(out))
        with open(out / "surfaces/cylinder.csv", newline="", encoding="utf-8") as file:
            areas = [float(row["area"]) for row in csv.DictReader(file)]
        # The surface is two straight lines of length √2 with ends on edges of cells, so the only errors are those of rounding.
        self.assertAlmostEqual(sum(areas), 2 * math.sqrt(2), delta=1e-12)
        refused = subprocess.run([self.program, "run", "gas/sphere", "space.body.1.shape=planted-diamond"], capture_output=True,
                                 text=True, check=False)
        self.assertEqual(refused.returncode, 2)
        self.assertIn("polygon", refused.stderr)

    def test_a_claim_is_reproduced(self):
        self.assertIn("C99", output_of(self.program, "reproduce", "C99", folder=self.folder.name))

    def test_a_quantity_is_computed(self):
        value = json.loads(output_of(self.program, "validate", "planted-density", "epsilon=0.2", "--json"))["value"]
        self.assertAlmostEqual(value, 0.5, delta=2e-3)


if __name__ == "__main__":
    sys.exit(unittest.main())
