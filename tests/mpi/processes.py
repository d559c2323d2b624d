"""Runs of the program on several processes, and comparison of their results."""
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy as np

BUILD = Path(os.environ.get("APSIS_BUILD", Path(__file__).resolve().parents[2] / "build" / "release"))
PROGRAM = BUILD / "app" / "apsis"
# Every run ends in seconds; a deadlock must not hold up the tests. Generous, since the machine may be busy.
LIMIT = float(os.environ.get("APSIS_MPI_LIMIT", "600"))

ENVIRONMENT = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1",
               "OMPI_MCA_hwloc_base_binding_policy": "none", "OMPI_MCA_btl_base_warn_component_unused": "0",
               # Without a right to read the memory of other processes, as in containers.
               "OMPI_MCA_btl_vader_single_copy_mechanism": "none", "OMP_NUM_THREADS": "1"}
for name in [key for key in ENVIRONMENT if key.startswith(("PMI", "SLURM"))]:
    del ENVIRONMENT[name]


def slow(test):
    """A test of `make test-all` alone."""
    return unittest.skipUnless(os.environ.get("APSIS_SLOW"), "part of make test-all")(test)


def command(count, arguments):
    program = [str(PROGRAM), *map(str, arguments)]
    return program if count == 1 else ["mpirun", "-n", str(count), *program]


def run(program, **how):
    """Runs a program to its end; the exit code is that of the processes.

    After MPI_Abort the launcher of Open MPI 4.1 rarely crashes at its own end, in PMIx_server_finalize, when all processes have ended
    and it has reported their exit code.
    """
    done = subprocess.run(program, capture_output=True, text=True, check=False, **how)
    aborted = re.search(r"MPI_ABORT was invoked .*?with errorcode (\d+)", done.stderr, re.S)
    if done.returncode in (-signal.SIGSEGV, 128 + signal.SIGSEGV) and aborted and "PMIx_server_finalize" in done.stderr:
        done.returncode = int(aborted[1])
    return done


class Folder(unittest.TestCase):
    """Tests with a folder of their own."""

    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="apsis-mpi-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")
        return name

    def run_on(self, count, *arguments, threads=1, wrap=(), limit=LIMIT):
        environment = {**ENVIRONMENT, "OMP_NUM_THREADS": str(threads)}
        return run([*wrap, *command(count, arguments)], cwd=self.folder, env=environment, timeout=limit)

    def completed(self, count, *arguments, **how):
        done = self.run_on(count, *arguments, **how)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def assert_same_results(self, a, b):
        """Bit for bit, except for times and what describes a run."""
        a, b = self.folder / a, self.folder / b
        names = sorted(path.relative_to(a) for path in a.rglob("*") if path.is_file() and path.name != ".lock")
        self.assertEqual(names, sorted(path.relative_to(b) for path in b.rglob("*") if path.is_file() and path.name != ".lock"))
        for name in names:
            if name.suffix in (".csv", ".xdmf"):
                self.assertEqual((a / name).read_text(), (b / name).read_text(), name)
            elif name.suffix == ".h5":
                self.assert_same_datasets(a / name, b / name)

    def assert_same_datasets(self, a, b):
        def contents(path):
            found = {}
            with h5py.File(path) as file:
                def visit(name, item):
                    if isinstance(item, h5py.Dataset):
                        found[name] = (item.shape, item.dtype, np.asarray(item[()]).tobytes() if item.shape != () else bytes(item[()]))
                file.visititems(visit)
                for key, value in file.attrs.items():
                    if key not in ("manifest", "case") and not key.startswith("totals.") or key in ("totals.t", "totals.steps"):
                        found["@" + key] = value
            return found
        mine, others = contents(a), contents(b)
        self.assertEqual(mine.keys(), others.keys(), a.name)
        for name, value in mine.items():
            if name != "case":
                self.assertTrue(np.all(np.asarray(value, dtype=object) == np.asarray(others[name], dtype=object)), f"{a.name}: {name}")


def main():
    if shutil.which("mpirun") is None:
        sys.exit("mpirun was not found; install openmpi-bin")
    unittest.main(verbosity=2)
