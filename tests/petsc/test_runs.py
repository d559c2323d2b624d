"""Runs of PETSc with the type "apsis" on 1, 2 and 4 processes, and of a program that loads the library as a plug-in.

CMakeLists.txt passes the paths of the programs in environment variables.
"""
import os
import re
import subprocess
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "mpi"))
from processes import ENVIRONMENT, LIMIT, slow  # noqa: E402

RUNS, ALONE = os.environ["APSIS_PETSC_RUNS"], os.environ["APSIS_PETSC_ALONE"]
LIBRARY, LIBRARY_FILE = os.environ["APSIS_PETSC_LIBRARY"], os.environ["APSIS_PETSC_LIBRARY_FILE"]

OF_SEVERAL_PROCESSES = "ranks.*:ranks/*:refusals.*:errors_of_the_program.*:other_types.*"

LEFT = r"objects were never freed|\[ *\d+\] *\d+ bytes"


def output_of(count, *command, code=0):
    """Returns the output of a program on `count` processes. Fails unless it ends with this exit code."""
    launcher = [] if count == 1 else ["mpirun", "-n", str(count)]
    done = subprocess.run([*launcher, *command], env=ENVIRONMENT, capture_output=True, text=True, timeout=LIMIT)
    if done.returncode != code:
        raise AssertionError(f"{command} on {count} processes ends with {done.returncode}:\n{done.stdout[-6000:]}\n{done.stderr[-6000:]}")
    return done.stdout + (done.stderr if code else "")


class Runs(unittest.TestCase):
    def passes_without_objects_left(self, count, tests):
        text = output_of(count, RUNS, "-malloc_dump", "-objects_dump", "-options_left", "no", "--gtest_color=no", "--gtest_filter=" + tests)
        self.assertRegex(text, r"\[  PASSED  \] \d+ tests")
        # With -objects_dump and -malloc_dump, PetscFinalize() lists objects and memory that were not freed.
        self.assertNotRegex(text, LEFT)

    def test_all_tests_pass_on_one_process_and_leave_no_object(self):
        self.passes_without_objects_left(1, "*")

    def test_tests_of_several_processes_pass_on_two(self):
        self.passes_without_objects_left(2, OF_SEVERAL_PROCESSES)

    @slow
    def test_tests_of_several_processes_pass_on_four(self):
        # These tests take minutes on two busy processors.
        self.passes_without_objects_left(4, OF_SEVERAL_PROCESSES)

    def test_the_check_for_objects_finds_one_that_is_left(self):
        text = output_of(1, RUNS, "-malloc_dump", "-objects_dump", "--gtest_filter=none", "-leave_an_object")
        self.assertRegex(text, LEFT)


class PlugIn(unittest.TestCase):
    # The points and steps are few, since each sum over the processes takes milliseconds on a busy machine.
    def norm(self, count, *options):
        text = output_of(count, ALONE, "-da_grid_x", "18", "-ts_adapt_type", "none", *options)
        return text.split(":")[0], float(re.search(r"t = 0.5, norm ([\d.]+)", text)[1])

    def apsis(self, count, method, library=LIBRARY):
        name, norm = self.norm(count, "-dll_append", library, "-ts_type", "apsis", "-ts_apsis_method", method, "-ts_dt", "0.03125")
        self.assertEqual(name, "apsis")
        return norm

    def test_a_program_that_knows_nothing_of_apsis_uses_its_methods(self):
        name, expected = self.norm(1, "-ts_dt", "0.0078125", "-ts_arkimex_type", "4")
        self.assertEqual(name, "arkimex")
        # These methods of order 3 and 4 take longer steps, of about half a cell; their errors are below the tolerance.
        for count, method in (1, "md-imex-8-3-mixed"), (2, "ark-436"), (4, "md-imex-8-3-mixed"):
            self.assertAlmostEqual(self.apsis(count, method), expected, delta=1e-5)

    def test_its_methods_differ(self):
        self.assertEqual(len({self.apsis(1, method) for method in ("md-imex-4-2", "ssp2-222", "md-imex-8-3-mixed")}), 3)

    def test_every_name_of_the_library_is_found(self):
        # The library is given as libapsis_petsc.so, as the file with its version, and by its name without a suffix.
        for library in LIBRARY, LIBRARY_FILE, str(Path(LIBRARY).with_suffix("")):
            with self.subTest(library=library):
                self.apsis(1, "md-imex-4-2", library)

    def test_without_the_library_the_type_is_unknown(self):
        self.assertIn("apsis", output_of(1, ALONE, "-ts_type", "apsis", code=86))

    def test_an_unknown_method_ends_the_program_with_the_nearest_name(self):
        text = output_of(1, ALONE, "-dll_append", LIBRARY, "-ts_type", "apsis", "-ts_apsis_method", "md-imex-8-3-mixd", code=62)
        self.assertIn("'md-imex-8-3-mixed'", text)

    def test_a_view_names_the_method(self):
        text = output_of(1, ALONE, "-dll_append", LIBRARY, "-ts_type", "apsis", "-ts_view", "-ts_apsis_method", "md-imex-6-3")
        for line in ("method md-imex-6-3: ", "order 3, 6 stages, kind imex, RHSFunction explicit", "SSP coefficient",
                     "preconditioners of stages set up: "):
            self.assertIn(line, text)

    def test_help_lists_the_options(self):
        text = output_of(1, ALONE, "-dll_append", LIBRARY, "-ts_type", "apsis", "-help")
        for option in "method", "fully_implicit", "pc", "curvature", "constant_jacobian", "ssp_step":
            self.assertIn(f"-ts_apsis_{option}", text)


if __name__ == "__main__":
    unittest.main()
