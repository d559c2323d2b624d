"""scripts/check_headers.py accepts headers that compile alone, and reports a planted header that does not, with the reason."""
import contextlib
import io
import os
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ["APSIS_BUILD"]).resolve()
sys.path.insert(0, str(SOURCE / "scripts"))
import check_headers  # noqa: E402


class Headers(unittest.TestCase):
    def problems(self, **headers):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in headers.items():
                (Path(folder) / f"{name}.hpp").write_text(text, encoding="utf-8")
            return check_headers.problems(BUILD, [Path(folder)], 2)

    def test_a_missing_include_is_reported(self):
        number, found = self.problems(planted="#pragma once\nstd::string name_of(int);\n",
                                      good="#pragma once\n#include <string>\nstd::string name_of(int);\n")
        self.assertEqual(number, 2)
        self.assertEqual(len(found), 1)
        self.assertIn("planted.hpp: does not compile alone", found[0])
        self.assertIn("string", found[0])

    def test_a_header_without_a_guard_is_found(self):
        number, found = self.problems(planted="struct twice {};\n")
        self.assertEqual((number, len(found)), (1, 1))

    def test_a_warning_is_an_error_as_in_the_build(self):
        _, found = self.problems(planted="#pragma once\ninline int narrow(double x) { int y = x; return y; }\n")
        self.assertEqual(len(found), 1)

    def test_includes_of_a_precompiled_header_do_not_count(self):
        flags = check_headers.flags_of("/usr/bin/ccache g++ -Wall -Winvalid-pch -include a/cmake_pch.hxx -O2 -o x.o -c x.cpp")
        self.assertEqual(flags, ["g++", "-Wall"])
        flags = check_headers.flags_of("clang++ -Wall -Xclang -include-pch -Xclang a/cmake_pch.hxx.pch -Xclang -include "
                                       "-Xclang a/cmake_pch.hxx -I b -o x.o -c x.cpp")
        self.assertEqual(flags, ["clang++", "-Wall", "-I", "b"])

    def test_the_source_of_a_unity_build_is_left_out(self):
        flags = check_headers.flags_of("g++ -Wall -O2 -o unity_0_cxx.o -c room.dir/Unity/unity_0_cxx.cxx")
        self.assertEqual(flags, ["g++", "-Wall"])

    def test_headers_with_mpi_get_the_flags_of_sources_with_mpi(self):
        room = SOURCE / "src/apsis/exec"
        sources = [room / "parallel.cpp", room / "with_mpi/processes.cpp", room / "threads.cpp"]
        self.assertEqual(check_headers.nearest(room / "internal/with_mpi/failure_notice.hpp", sources), sources[1])
        self.assertEqual(check_headers.nearest(room / "internal/team.hpp", sources), sources[0])

    def test_headers_of_parts_that_are_not_built_are_left_out(self):
        library = SOURCE / "src/apsis"
        sources = [library / "core/version.cpp", library / "exec/parallel.cpp", library / "exec/without_mpi/processes.cpp"]
        for header, built in (("core/version.hpp", True), ("petsc/internal/vector.hpp", False), ("exec/parallel.hpp", True),
                              ("exec/internal/with_mpi/failure_notice.hpp", False)):
            self.assertTrue((library / header).is_file(), header)
            self.assertEqual(check_headers.is_built(library / header, sources), built, header)
        self.assertTrue(check_headers.is_built(library / "exec/internal/with_mpi/failure_notice.hpp",
                                               [library / "exec/with_mpi/processes.cpp"]))
        self.assertTrue(check_headers.is_built(SOURCE / "app/threads_option.hpp", sources))

    def test_a_folder_without_headers_is_an_error(self):
        arguments, sys.argv = sys.argv, ["check_headers.py", str(BUILD), str(SOURCE / "methods")]
        try:
            with contextlib.redirect_stdout(io.StringIO()):
                self.assertEqual(check_headers.main(), 1)
        finally:
            sys.argv = arguments


if __name__ == "__main__":
    unittest.main()
