"""The rooms of src/apsis include only the rooms below them, and clients do not include each other. scripts/check_layers.py finds a
planted violation of each kind."""
import shutil
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "scripts"))
import check_layers  # noqa: E402


class Layers(unittest.TestCase):
    def test_no_room_includes_one_above_it(self):
        self.assertEqual(check_layers.violations(SOURCE), [])

    def test_the_order_of_the_rooms_is_that_of_the_data(self):
        rooms = check_layers.read_rooms((SOURCE / "src/apsis/CMakeLists.txt").read_text(encoding="utf-8"))
        self.assertEqual(rooms["core"], set())
        self.assertEqual(rooms["integrate"], {"core", "method"})
        self.assertEqual(rooms["verify"], {"core", "method", "integrate"})  # verify takes any problem
        for room in ("method", "integrate", "velocity", "mesh", "model", "scheme"):
            self.assertFalse(rooms[room] & {"semidiscrete", "config", "output", "run", "study"}, room)
        self.assertIn("semidiscrete", rooms["run"])
        self.assertFalse(rooms["output"] & {"config", "run"})  # files do not depend on cases

    def test_the_page_for_contributors_lists_the_rooms_in_their_order(self):
        rooms = list(check_layers.read_rooms((SOURCE / "src/apsis/CMakeLists.txt").read_text(encoding="utf-8")))
        page = " ".join((SOURCE / "CONTRIBUTING.md").read_text(encoding="utf-8").split())
        self.assertIn(f"each a library with a README: {', '.join(rooms)}. ", page)

    def planted(self, file, text):
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            shutil.copytree(SOURCE / "src", root / "src")
            (root / "paper").mkdir()
            (root / "paper/claim.hpp").touch()
            path = root / file
            path.parent.mkdir(exist_ok=True)
            path.write_text(text, encoding="utf-8")
            return check_layers.violations(root)

    def test_a_planted_violation_is_found_with_its_place(self):
        self.assertEqual(self.planted("src/apsis/method/planted.hpp", "#pragma once\n#include <apsis/run/setup.hpp>\n"),
                         ["src/apsis/method/planted.hpp:2: method includes run (apsis/run/setup.hpp)"])
        self.assertEqual(self.planted("src/apsis/mesh/planted.cpp", '#include "apsis/model/model.hpp"\n'),
                         ["src/apsis/mesh/planted.cpp:1: mesh includes model (apsis/model/model.hpp)"])
        self.assertEqual(self.planted("src/apsis/verify/planted.cpp", "#include <paper/claim.hpp>\n"),
                         ["src/apsis/verify/planted.cpp:1: verify includes paper/claim.hpp (above the library)"])
        self.assertEqual(self.planted("paper/planted.cpp", "#include <bench/plain/bgk.hpp>\n"),
                         ["paper/planted.cpp:1: paper includes bench (bench/plain/bgk.hpp)"])

    def planted_in_client(self, file, text):
        with tempfile.TemporaryDirectory() as folder:
            root = Path(folder)
            for client in check_layers.CLIENTS:
                shutil.copytree(SOURCE / client, root / client)
            (root / file).write_text(text, encoding="utf-8")
            return [problem for client in check_layers.CLIENTS for problem in check_layers.violations_of_client(root, client)]

    def test_clients_include_and_link_nothing_of_each_other(self):
        self.assertEqual(self.planted_in_client("bench/micro/planted.cpp", "// why\n#include <paper/claim.hpp>\n"),
                         ["bench/micro/planted.cpp:2: bench includes paper (paper/claim.hpp)"])
        self.assertEqual(self.planted_in_client("validation/planted.hpp", '#include "../bench/plain/bgk.hpp"\n'),
                         ["validation/planted.hpp:1: validation includes bench (../bench/plain/bgk.hpp)"])
        self.assertEqual(self.planted_in_client("paper/claims/planted.cpp", '#include "validation/absent.hpp"\n'),
                         ["paper/claims/planted.cpp:1: paper includes validation (validation/absent.hpp)"])
        self.assertEqual(self.planted_in_client("bench/measure/planted.cpp", '#include "table.hpp"\n#include <apsis/core/errors.hpp>\n'), [])
        cmake = (SOURCE / "bench/CMakeLists.txt").read_text(encoding="utf-8")
        self.assertEqual(self.planted_in_client("bench/CMakeLists.txt", cmake + "target_link_libraries(apsis_measure PRIVATE apsis_paper)\n"),
                         ["bench/CMakeLists.txt: bench links paper"])

    def test_a_room_may_not_include_what_the_rooms_that_it_includes_may(self):
        rooms = check_layers.read_rooms("apsis_room(a)\napsis_room(b DEPENDS a PUBLIC x)\napsis_room(c DEPENDS b)\n")
        self.assertEqual(rooms, {"a": set(), "b": {"a"}, "c": {"b"}})
        self.assertEqual(self.planted("src/apsis/model/planted.hpp", "#include <apsis/method/method.hpp>\n"),
                         ["src/apsis/model/planted.hpp:1: model includes method (apsis/method/method.hpp)"])

    def test_a_grant_of_a_room_that_comes_later_is_found(self):
        cmake = (SOURCE / "src/apsis/CMakeLists.txt").read_text(encoding="utf-8")
        found = self.planted("src/apsis/CMakeLists.txt", cmake.replace("apsis_room(scheme KERNELS DEPENDS core exec", "apsis_room(scheme KERNELS DEPENDS core exec run"))
        self.assertIn("src/apsis/CMakeLists.txt: scheme may include ['run'] (not declared before it)", found)

    def test_a_grant_that_no_file_uses_is_found(self):
        cmake = (SOURCE / "src/apsis/CMakeLists.txt").read_text(encoding="utf-8")
        found = self.planted("src/apsis/CMakeLists.txt", cmake.replace("apsis_room(scheme KERNELS DEPENDS core exec", "apsis_room(scheme KERNELS DEPENDS core exec velocity"))
        self.assertEqual(found, ["src/apsis/CMakeLists.txt: scheme may include ['velocity'] (its files do not)"])

    def test_a_room_that_cmake_does_not_know_is_found(self):
        self.assertEqual(self.planted("src/apsis/attic/planted.hpp", "#pragma once\n"),
                         ["src/apsis/attic: is no room of src/apsis/CMakeLists.txt"])

    def test_a_readme_that_promises_something_else_is_found(self):
        found = self.planted("src/apsis/method/README.md", "# method\nIncludes `core` and `run`.\n")
        self.assertEqual(found, ["src/apsis/method/README.md: states that it includes ['core', 'run'] (its files include ['core'])"])


if __name__ == "__main__":
    unittest.main()
