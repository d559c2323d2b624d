"""Integrations with threaded and parallel vectors give the same bits as with serial vectors."""
import os
import shutil
import subprocess
import sys
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "mpi"))
from processes import ENVIRONMENT, LIMIT  # noqa: E402

PROGRAM = os.environ["APSIS_EQUAL_BITS"]


def output(*command):
    done = subprocess.run(command, env={**ENVIRONMENT, "OMP_WAIT_POLICY": "passive"}, capture_output=True, text=True, timeout=LIMIT)
    if done.returncode == 2 and "not built" in done.stderr:
        raise unittest.SkipTest(done.stderr.strip())
    if done.returncode != 0:
        raise AssertionError(f"{command}: {done.returncode}\n{done.stderr}")
    return done.stdout


class EqualBits(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.serial = output(PROGRAM, "serial")

    def test_the_result_is_complete(self):
        lines = self.serial.split()
        self.assertEqual(len(lines), 3 * (1 + 2 * 97 + 11))
        self.assertGreater(int(lines[2 * 97 + 1 + 6]), 20)  # the number of linear iterations

    def test_threads(self):
        for kind in ("pthreads", "openmp"):
            for threads in (1, 3):
                with self.subTest(kind, threads=threads):
                    self.assertEqual(output(PROGRAM, kind, str(threads)), self.serial)

    def test_processes(self):
        if shutil.which("mpirun") is None:
            self.skipTest("mpirun is not installed")
        for processes in (1, 2, 4):
            with self.subTest(processes=processes):
                self.assertEqual(output("mpirun", "-n", str(processes), PROGRAM, "parallel"), self.serial)


if __name__ == "__main__":
    unittest.main()
