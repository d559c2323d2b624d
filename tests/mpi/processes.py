"""Runs of the program on several processes, and comparison of their results."""
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import h5py
import numpy as np

BUILD = Path(os.environ.get("APSIS_BUILD", Path(__file__).resolve().parents[2] / "build" / "release"))
PROGRAM = BUILD / "app" / "apsis"
# Seconds after which a run counts as a deadlock. Runs take seconds, but much longer on a busy machine.
LIMIT = float(os.environ.get("APSIS_MPI_LIMIT", "600"))

# Seconds that the launcher has to end after its processes. Beside four busy loops it ends within one second.
PATIENCE_WITH_LAUNCHER = 20.0

# A folder of sessions for these tests alone: launchers that start and end simultaneously remove each other's folder.
SESSIONS = tempfile.TemporaryDirectory(prefix="ompi-", ignore_cleanup_errors=True)

ENVIRONMENT = {**os.environ, "OMPI_MCA_orte_tmpdir_base": SESSIONS.name, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1",
               "OMPI_MCA_hwloc_base_binding_policy": "none", "OMPI_MCA_btl_base_warn_component_unused": "0",
               # Containers often forbid to read the memory of other processes.
               "OMPI_MCA_btl_vader_single_copy_mechanism": "none", "OMP_NUM_THREADS": "1"}
for name in [key for key in ENVIRONMENT if key.startswith(("PMI", "SLURM"))]:
    del ENVIRONMENT[name]


def one_of(choices, number):
    """Returns all choices in a run of the slow tests, otherwise the choice with this number (modulo their count)."""
    choices = list(choices)
    return choices if os.environ.get("APSIS_SLOW") else [choices[number % len(choices)]]


def slow(test):
    """Marks a test that only `make test-all` runs."""
    return unittest.skipUnless(os.environ.get("APSIS_SLOW"), "part of make test-all")(test)


# Every process writes its exit code to a file, since the launcher may hang after the processes have ended.
WITH_CODE = '"$@"; code=$?; echo $code > "$APSIS_CODES/$OMPI_COMM_WORLD_RANK"; exit $code'


def launched(count, *program, shell=WITH_CODE):
    return ["mpirun", "-n", str(count), "sh", "-c", shell, "sh", *map(str, program)]


def command(count, arguments):
    return [str(PROGRAM), *map(str, arguments)] if count == 1 else ["mpirun", "-n", str(count), str(PROGRAM), *map(str, arguments)]


def descendants(pid):
    """Returns the names of the living descendants of a process, by their ids."""
    parents, names = {}, {}
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                name, rest = (entry / "stat").read_text().split("(", 1)[1].rsplit(")", 1)
            except OSError:
                continue
            state, parent = rest.split()[:2]
            if state != "Z":
                parents[int(entry.name)], names[int(entry.name)] = int(parent), name

    def is_below(one):
        while one in parents and parents[one] != pid:
            one = parents[one]
        return one in parents

    return {one: names[one] for one in parents if is_below(one)}


def launcher_is_idle(pid):
    """Returns true if no process of the launcher runs. The launcher is the process `pid` or one of its descendants."""
    below = descendants(pid)
    launchers = [one for one, name in {**below, pid: "mpirun"}.items() if name in ("mpirun", "orterun")]
    return not descendants(launchers[0])


class Started:
    """A running program. Its exit code is that of its processes, even if the launcher hangs or crashes after their end.

    The launcher of Open MPI 4.1 does so rarely, but more often after MPI_Abort and on a busy machine.
    """

    def __init__(self, program, env=None, **how):
        self.program = program
        self.files = tempfile.TemporaryDirectory(prefix="apsis-run-")
        self.codes = Path(self.files.name) / "codes"
        self.codes.mkdir()
        self.out, self.err = (open(Path(self.files.name) / name, "w+", encoding="utf-8") for name in ("out", "err"))
        self.process = subprocess.Popen(program, stdout=self.out, stderr=self.err, start_new_session=True,
                                        env={**(env or ENVIRONMENT), "APSIS_CODES": str(self.codes)}, **how)
        self.pid = self.process.pid

    def poll(self):
        return self.process.poll()

    def end(self, timeout=LIMIT):
        """Waits for the end and returns the completed process.

        `launcher_hung` of the result is true if the launcher had to be killed; `codes` are the exit codes of all processes.
        """
        begun = time.monotonic()
        idle_since, last_look, has_run, hung = begun, begun, False, False
        while self.poll() is None and not hung:
            time.sleep(0.01)
            now = time.monotonic()
            if now - begun > timeout:
                self.kill()
                raise subprocess.TimeoutExpired(self.program, timeout, stderr=self.text(self.err))
            if "mpirun" in " ".join(self.program) and now - last_look > 0.5:
                last_look = now
                if not launcher_is_idle(self.pid):
                    idle_since, has_run = now, True
                hung = (has_run or any(self.codes.iterdir())) and now - idle_since > PATIENCE_WITH_LAUNCHER
        if hung:
            self.kill()
        return self.result(hung)

    def result(self, hung):
        done = subprocess.CompletedProcess(self.program, self.process.returncode, self.text(self.out), self.text(self.err))
        done.launcher_hung = hung
        # The file is empty if the launcher has killed a process before it wrote its code.
        written = {int(path.name): path.read_text() for path in self.codes.iterdir()}
        done.codes = {rank: int(text) for rank, text in sorted(written.items()) if text}
        aborted = re.search(r"MPI_ABORT was invoked .*?with errorcode (\d+)", done.stderr, re.S)
        crashed = done.returncode in (-signal.SIGSEGV, 128 + signal.SIGSEGV) and "PMIx_server_finalize" in done.stderr
        if (hung or crashed) and (aborted or done.codes):
            done.returncode = int(aborted[1]) if aborted else next((code for code in done.codes.values() if code != 0), 0)
        self.files.cleanup()
        return done

    def text(self, file):
        file.seek(0)
        found = file.read()
        file.close()
        return found

    def kill(self):
        for one in [self.pid, *descendants(self.pid)]:
            try:
                os.kill(one, signal.SIGKILL)
            except ProcessLookupError:
                pass
        self.process.wait()


def run(program, timeout=LIMIT, **how):
    return Started(program, **how).end(timeout)


class Folder(unittest.TestCase):
    """A test case with a temporary folder, in which all programs run."""

    def setUp(self):
        self.folder = Path(tempfile.mkdtemp(prefix="apsis-mpi-"))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def write(self, name, text):
        (self.folder / name).write_text(text, encoding="utf-8")
        return name

    def run_on(self, count, *arguments, threads=1, wrap=(), limit=LIMIT):
        environment = {**ENVIRONMENT, "OMP_NUM_THREADS": str(threads)}
        program = command(1, arguments)
        return run([*wrap, *(program if count == 1 else launched(count, *program))], cwd=self.folder, env=environment, timeout=limit)

    def completed(self, count, *arguments, **how):
        done = self.run_on(count, *arguments, **how)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def assert_same_results(self, a, b):
        """Checks that two folders have equal results, bit for bit, except for wall times and the description of the run."""
        a, b = self.folder / a, self.folder / b
        names = sorted(path.relative_to(a) for path in a.rglob("*") if path.is_file() and path.name != ".lock")
        self.assertEqual(names, sorted(path.relative_to(b) for path in b.rglob("*") if path.is_file() and path.name != ".lock"))
        for name in names:
            if name.suffix in (".csv", ".xdmf"):
                self.assertEqual((a / name).read_text(), (b / name).read_text(), name)
            elif name.parts[0] == "snapshots":  # these files have no manifest, so their bytes are equal
                self.assertEqual((a / name).read_bytes(), (b / name).read_bytes(), name)
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
