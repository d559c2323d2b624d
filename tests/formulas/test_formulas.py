"""Headers of formulas (src/apsis/*/formulas) compile for graphics processors with no library, alone and instantiated."""
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
CLANG = os.environ["APSIS_CLANG"]
TARGETS = {"nvptx64-nvidia-cuda": "sm_70", "amdgcn-amd-amdhsa": "gfx90a"}
# No standard header is found: formulas need no code from outside src.
FLAGS = ["-std=c++20", "-nostdinc", "-fno-exceptions", "-fno-rtti", "-nogpulib", "-ffp-contract=off", "-Wall", "-Wextra",
         "-Wshadow", "-Wconversion", "-Werror", f"-I{SOURCE / 'src'}", "-x", "c++"]


def compiled(target, text, *more):
    processor = "-march=" if "nvptx" in target else "-mcpu="
    return subprocess.run([CLANG, f"--target={target}", processor + TARGETS[target], *FLAGS, *more, "-o", "-", "-"],
                          input=text, capture_output=True, text=True)


class Formulas(unittest.TestCase):
    def headers(self):
        found = sorted(SOURCE.glob("src/apsis/*/formulas/*.hpp"))
        self.assertGreater(len(found), 10)
        return found

    def test_each_header_compiles_alone_and_twice(self):
        for target in TARGETS:
            for header in self.headers():
                with self.subTest(target=target, header=header.name):
                    done = compiled(target, f'#include "{header}"\n' * 2, "-fsyntax-only")
                    self.assertEqual(done.returncode, 0, done.stderr)

    def test_a_header_with_the_standard_library_does_not(self):
        with tempfile.TemporaryDirectory() as folder:
            planted = Path(folder) / "planted.hpp"
            planted.write_text("#include <vector>\n", encoding="utf-8")
            done = compiled("nvptx64-nvidia-cuda", f'#include "{planted}"\n', "-fsyntax-only")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("'vector' file not found", done.stderr)

    def test_every_header_is_instantiated_below(self):
        text = (Path(__file__).parent / "kernels.cpp").read_text(encoding="utf-8")
        reached, waiting = set(), [text]
        while waiting:
            for line in waiting.pop().splitlines():
                if line.startswith("#include <apsis/") and "/formulas/" in line and line not in reached:
                    reached.add(line)
                    waiting.append((SOURCE / "src" / line.split("<")[1].split(">")[0]).read_text(encoding="utf-8"))
        for header in self.headers():
            self.assertIn(f"#include <{header.relative_to(SOURCE / 'src')}>", reached)

    def test_instantiations_call_nothing_and_have_fused_products(self):
        text = (Path(__file__).parent / "kernels.cpp").read_text(encoding="utf-8")
        for target, product in (("nvptx64-nvidia-cuda", "fma.rn.f64"), ("amdgcn-amd-amdhsa", "v_fma_f64")):
            with self.subTest(target=target):
                done = compiled(target, text, "-O2", "-S")
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertIn(product, done.stdout)
                for call in ("call.uni", "s_swappc_b64", ".extern"):
                    self.assertNotIn(call, done.stdout)


if __name__ == "__main__":
    unittest.main()
