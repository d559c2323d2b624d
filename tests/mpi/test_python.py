"""Runs of Python on several processes (docs/processes.md)."""
import subprocess
import sys

from processes import BUILD, ENVIRONMENT, Folder, main

SAME = """
import os
import numpy as np
from mpi4py import MPI
import apsis

comm = MPI.COMM_WORLD
case = ("gas/cavity", "space.cells=[12,11]", "velocity.points=12", "time.end=0.02", "time.steady=1e-12")
shared = apsis.run(*case, comm=comm)
assert (shared is None) == (comm.rank > 0)
if comm.rank == 0:
    assert shared == apsis.run(*case), "other bits"
# Processes of a part of the communicator, with data of their own.
half = comm.Split(comm.rank % 2)
wave = apsis.run("paper/bgk-mixed-fd", "space.cells=12", "velocity.points=20", "time.end=0.01", comm=half,
                 initial={"rho": lambda x: 1 + 0.1 * np.sin(np.pi * x), "u": 0, "T": 1})
assert (wave is None) == (half.rank > 0)
os.write(1, b"done\\n")  # In one piece: the launcher mixes the pieces of several processes.
"""

FAILING = """
import os
from mpi4py import MPI
import apsis

def report(text):
    # In one piece: the launcher mixes the pieces of several processes.
    os.write(1, f"{text}\\n".encode())

try:
    apsis.run("paper/bgk-mixed-fd", "space.cells=12", "velocity.points=20", "time.end=0.01", comm=MPI.COMM_WORLD,
              initial={"rho": lambda x: 1 - 2 * (x > 1.9), "u": 0, "T": 1})
except apsis.InputError as problem:
    report(f"refused {problem}")
try:
    apsis.run("paper/bgk-mixed", comm=3)
except apsis.InputError as problem:
    report(f"wrong {problem}")
"""


class Python(Folder):
    def run_python(self, text, count):
        self.write("run.py", text)
        return subprocess.run(["mpirun", "-n", str(count), sys.executable, "run.py"], cwd=self.folder, capture_output=True, text=True,
                              env={**ENVIRONMENT, "PYTHONPATH": str(BUILD / "python")}, timeout=600, check=False)

    def test_a_communicator_shares_a_run_with_the_same_bits(self):
        done = self.run_python(SAME, 3)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.count("done"), 3, done.stdout + done.stderr)

    def test_an_error_in_the_cells_of_one_process_is_raised_on_all(self):
        done = self.run_python(FAILING, 2)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.count("refused"), 2, done.stdout + done.stderr)
        self.assertEqual(done.stdout.count("wrong comm is a int (it must be a communicator of mpi4py)"), 2, done.stdout)


if __name__ == "__main__":
    main()
