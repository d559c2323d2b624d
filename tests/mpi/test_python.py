"""Runs from Python on several processes (docs/processes.md)."""
import sys

from processes import BUILD, ENVIRONMENT, Folder, launched, main, run

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


# Arguments in which one process differs: an override, options, and a part of the error on the first process.
DIFFERENT = {
    "time.end": ('"time.end=0.01" if first else "time.end=0.02"', "{}",
                 "process 1 was given another case than process 0 ('end = 0.02' instead of 'end = 0.01'); give all processes the same"),
    "restart": ('"time.end=0.01"', '{} if first else {"restart": "none.h5"}', "process 1 was given another case than process 0"),
    "no folder": ('"time.end=0.01"', '{"out": "out"} if first else {}', "process 1 was given another case than process 0"),
    "argument": ('"time.end=0.01" if first else 3', "{}", "process 1: override 3 is an int"),
    "case": ('"time.end=0.01" if first else "time.ent=1"', "{}", "unknown key 'time.ent'"),
}

ONE_DIFFERS = """
import os
from mpi4py import MPI
import apsis

comm = MPI.COMM_WORLD
first = comm.rank == 0
try:
    apsis.run("paper/bgk-mixed-fd", "space.cells=12", "velocity.points=20", OVERRIDE, comm=comm, **OPTIONS)
except apsis.InputError as problem:
    os.write(1, f"{comm.rank} refused {problem}\\n".encode())
"""

LIMITED = """
import os
import resource
from mpi4py import MPI
import apsis

comm = MPI.COMM_WORLD
if comm.rank == 1:
    resource.setrlimit(resource.RLIMIT_FSIZE, (16384, 16384))
try:
    apsis.run("paper/bgk-mixed-fd", "space.cells=60", "velocity.points=80", "time.end=0.001", "output.distribution=end", out="out", comm=comm)
except apsis.FileError as problem:
    os.write(1, f"refused {problem}\\n".encode())
"""


class Python(Folder):
    def run_python(self, text, count):
        self.write("run.py", text)
        return run(launched(count, sys.executable, "run.py"), cwd=self.folder, env={**ENVIRONMENT, "PYTHONPATH": str(BUILD / "python")})

    def test_a_communicator_shares_a_run_with_the_same_bits(self):
        done = self.run_python(SAME, 3)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.count("done"), 3, done.stdout + done.stderr)

    def test_an_error_in_the_cells_of_one_process_is_raised_on_all(self):
        done = self.run_python(FAILING, 2)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.count("refused"), 2, done.stdout + done.stderr)
        self.assertEqual(done.stdout.count("wrong comm is an int (it must be a communicator of mpi4py)"), 2, done.stdout)

    def test_different_cases_and_arguments_are_refused_on_all(self):
        for name, (override, options, message) in DIFFERENT.items():
            with self.subTest(name):
                done = self.run_python(ONE_DIFFERS.replace("OVERRIDE", override).replace("OPTIONS", f"({options})"), 2)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertEqual(done.stdout.count("refused"), 2, done.stdout + done.stderr)
                self.assertIn(message, next(line for line in done.stdout.splitlines() if line.startswith("0 refused")))

    def test_a_file_that_one_process_cannot_write_is_reported_on_all(self):
        done = self.run_python(LIMITED, 2)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(done.stdout.count("refused"), 2, done.stdout + done.stderr)
        self.assertRegex(done.stdout, r"solution.h5.partial'.*\(process 1 on \S+: File too large\)")
        self.assertEqual([path.name for path in self.folder.iterdir() if path.name != "run.py"], [])


if __name__ == "__main__":
    main()
