"""An error on one process ends all processes, with one message and the exit code of a run on one process. Nothing is lost."""
import os
import random
import re
import resource
import signal
import subprocess
import time
from pathlib import Path

from processes import ENVIRONMENT, LIMIT, PROGRAM, WITH_CODE, Folder, Started, command, descendants, launched, main, run, slow

GAS = ("paper/bgk-mixed-fd", "space.cells=24", "velocity.points=40")

# The step is longer than the method allows and the gradients are large, so a stage has no equilibrium in some cell.
UNSTABLE = """
title = "An unstable run"
[model]
name = "bgk"
epsilon = 1e-3
[initial]
rho = "x < 0.3 ? 1 : 1e-6"
T = 1
u = 0
[space]
cells = 40
domain = [0, 1]
boundary = "outflow"
formulation = "finite-difference"
limiter = "none"
[velocity]
max = 8
points = 24
[time]
method = "md-imex-3-2"
end = 10
cfl = 3.5
"""


def errors(text):
    return [line for line in text.splitlines() if line.startswith("error:")]


class Failures(Folder):
    def expect_the_error_of_one_process(self, code, *arguments, counts=(3,), **how):
        alone = self.run_on(1, *arguments, **how)
        self.assertEqual(alone.returncode, code, alone.stderr)
        for count in counts:
            together = self.run_on(count, *arguments, **how)
            self.assertEqual(together.returncode, code, together.stderr)
            self.assertEqual(errors(together.stderr), errors(alone.stderr))
        return errors(alone.stderr)[0]

    def test_of_input(self):
        self.write("bad.toml", UNSTABLE.replace("cells = 40", "cells = 40\ncels = 3"))
        self.assertRegex(self.expect_the_error_of_one_process(2, "run", "bad.toml"), r"bad.toml:12:\d+: unknown key 'space.cels'")

    def test_of_input_in_the_cells_of_one_process(self):
        self.write("negative.toml", UNSTABLE.replace("x < 0.3 ? 1 : 1e-6", "x > 0.9 ? -1 : 1"))
        self.expect_the_error_of_one_process(2, "run", "negative.toml", counts=(2,))

    def test_of_numbers(self):
        self.write("unstable.toml", UNSTABLE)
        self.expect_the_state_of_one_process()

    def test_of_numbers_in_a_multistep_method(self):
        self.write("unstable.toml", UNSTABLE.replace("md-imex-3-2", "imex-bdf-3").replace("cfl = 3.5", "dt = 0.01"))
        self.expect_the_state_of_one_process()

    def expect_the_state_of_one_process(self):
        alone = self.run_on(1, "run", "unstable.toml", "--out", "one")
        self.assertEqual(alone.returncode, 3, alone.stderr)
        for count in (3,):
            together = self.run_on(count, "run", "unstable.toml", "--out", f"on-{count}")
            self.assertEqual(together.returncode, 3, together.stderr)
            self.assertEqual(len(errors(together.stderr)), 1, together.stderr)
            step = re.search(r"step \d+", errors(alone.stderr)[0])
            self.assertIsNotNone(step, alone.stderr)
            self.assertIn(step[0] + ",", errors(together.stderr)[0])
            # The files have the history and the state before the failed step.
            for name in ("history.csv", "fields.csv"):
                self.assertEqual((self.folder / f"on-{count}" / name).read_text(), (self.folder / "one" / name).read_text(), name)

    @slow
    def test_of_a_folder_that_cannot_be_written(self):
        (self.folder / "file").write_text("")
        self.expect_the_error_of_one_process(4, "run", *GAS, "time.end=0.01", "--out", "file/out", counts=(2,))

    def test_of_different_cases(self):
        for options, difference in ((("velocity.points=42",), "('points = 42' instead of 'points = 40')"),
                                    (("--restart", "none.h5"), "('restart = \"none.h5\"' instead of 'restart = \"\"')")):
            refused = run([*launched(1, PROGRAM, "run", *GAS), ":", *launched(1, PROGRAM, "run", *GAS, *options)[1:]], cwd=self.folder)
            self.assertEqual(refused.returncode, 2, refused.stderr)
            self.assertEqual(errors(refused.stderr), [f"error: process 1 was given another case than process 0 {difference}; "
                                                      "give all processes the same"])

    def test_of_a_command_line_of_one_process(self):
        refused = run([*launched(1, PROGRAM, "run", *GAS), ":", *launched(1, PROGRAM, "run", *GAS, "--wal", "3")[1:]], cwd=self.folder)
        self.assertEqual(refused.returncode, 2, refused.stderr)
        self.assertEqual(len(errors(refused.stderr)), 1, refused.stderr)
        self.assertTrue(errors(refused.stderr)[0].startswith("error: process 1: command line: "), refused.stderr)

    def test_of_too_many_processes(self):
        refused = self.run_on(5, "run", *GAS, "space.cells=3", "space.reconstruction=upwind1")
        self.assertEqual(refused.returncode, 2, refused.stderr)
        self.assertEqual(len(errors(refused.stderr)), 1, refused.stderr)
        self.assertIn("5 processes cannot share the mesh", refused.stderr)
        self.assertIn("start 3", refused.stderr)

    def test_of_commands_that_do_not_share_their_work(self):
        refused = self.run_on(2, "list", "methods")
        self.assertEqual(refused.returncode, 2, refused.stderr)
        self.assertEqual(len(errors(refused.stderr)), 1, refused.stderr)
        self.assertIn("2 processes were started", refused.stderr)

    def exit_codes(self, count, *arguments):
        """Returns the exit codes of the processes in the order of ranks. To the launcher, every process returns 0."""
        shell = WITH_CODE.replace("exit $code", "exit 0")
        return list(run(launched(count, PROGRAM, *arguments, shell=shell), cwd=self.folder).codes.values())

    def test_only_the_process_that_reports_an_error_returns_its_code(self):
        # mpirun kills all processes as soon as one returns a code other than 0, perhaps before the error is reported.
        self.write("bad.toml", UNSTABLE.replace("cells = 40", "cells = -1"))
        self.assertEqual(self.exit_codes(3, "run", "bad.toml"), [2, 0, 0])
        self.assertEqual(self.exit_codes(3, "run", "bad.toml", "--no-such-option"), [2, 0, 0])
        self.assertEqual(self.exit_codes(3, "list", "methods"), [2, 0, 0])
        self.assertEqual(self.exit_codes(3, "run", *GAS, "--wall", "1e-9"), [130, 0, 0])

    @slow
    def test_of_a_restart_with_a_damaged_checkpoint(self):
        self.completed(2, "run", *GAS, "time.end=0.01", "--out", "out")
        path = self.folder / "out" / "checkpoint.h5"
        content = bytearray(path.read_bytes())
        content[len(content) // 2] ^= 1
        path.write_bytes(content)
        self.expect_the_error_of_one_process(4, "run", *GAS, "time.end=0.02", "--restart", "out/checkpoint.h5", counts=(3,))


class Signals(Folder):
    def start(self, count, *arguments):
        return Started(command(count, arguments), cwd=self.folder)

    def processes_of(self, run):
        """Returns the ids of the program's processes, without the launcher."""
        return sorted(pid for pid, name in descendants(run.pid).items() if name == "apsis")

    def await_checkpoint(self, run, before):
        path = self.folder / "out" / "checkpoint.h5"
        while run.poll() is None and (not path.exists() or path.stat().st_mtime_ns == before):
            time.sleep(0.005)

    def kill_and_restart(self, kills, seed):
        long = (*GAS, "output.every=0.002", "time.end=0.02")
        self.completed(1, "run", *long, "--out", "whole")
        chance = random.Random(seed)
        saved = self.folder / "out" / "checkpoint.h5"
        for _ in range(kills):
            restart = ("--restart", "out/checkpoint.h5") if saved.exists() else ()
            before = saved.stat().st_mtime_ns if saved.exists() else 0
            run = self.start(chance.choice((2, 3)), "run", *long, "output.checkpoint_every=1", *restart, "--out", "out")
            self.await_checkpoint(run, before)
            time.sleep(chance.uniform(0.0, 0.05))
            victims = self.processes_of(run)
            if run.poll() is None and victims:
                os.kill(chance.choice(victims), signal.SIGKILL)
                begun = time.monotonic()
                done = run.end()
                self.assertNotEqual(done.returncode, 0, done.stderr)
                # mpirun reports the signal.
                self.assertRegex(done.stderr, "(?i)signal 9|killed")
                self.assertLess(time.monotonic() - begun, 60.0)
            else:
                run.end()
            if (self.folder / "out" / "manifest.json").exists():
                break
        restart = ("--restart", "out/checkpoint.h5")
        if not (self.folder / "out" / "manifest.json").exists():
            self.completed(2, "run", *long, *restart, "--out", "out")
        self.assert_same_results("whole", "out")

    def test_a_process_that_is_killed_ends_the_run_and_loses_nothing(self):
        self.kill_and_restart(1, seed=1)

    @slow
    def test_fifty_kills(self):
        for seed in range(10):
            self.kill_and_restart(5, seed)
            for name in ("out", "whole"):
                subprocess.run(["rm", "-rf", str(self.folder / name)], check=True)

    @slow
    def test_a_wall_time_ends_all_with_a_checkpoint(self):
        stopped = self.run_on(3, "run", *GAS, "time.end=1000.0", "--wall", "0.3", "--out", "out")
        self.assertEqual(stopped.returncode, 130, stopped.stderr)
        self.assertTrue((self.folder / "out" / "checkpoint.h5").exists())

    def test_the_batch_script_of_the_page_runs_and_continues(self):
        # The script of docs/processes.md calls srun; the srun of this test starts two processes by mpirun.
        page = (Path(__file__).resolve().parents[2] / "docs" / "processes.md").read_text(encoding="utf-8")
        self.write("job.sh", re.search(r"```sh\n(#!/bin/bash.*?)```", page, re.S)[1])
        self.write("case.toml", UNSTABLE.replace("cfl = 3.5", "cfl = 0.4").replace("end = 10", "end = 0.01"))
        (self.folder / "srun").write_text(f'#!/bin/sh\nshift\nexec mpirun -n 2 "{PROGRAM}" "$@"\n')
        (self.folder / "srun").chmod(0o755)
        environment = {**ENVIRONMENT, "PATH": f"{self.folder}:{ENVIRONMENT['PATH']}", "SLURM_CPUS_PER_TASK": "1"}
        done = subprocess.run(["bash", "job.sh"], cwd=self.folder, env=environment, capture_output=True, text=True, timeout=LIMIT, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue((self.folder / "results" / "run" / "checkpoint.h5").exists())

    def test_one_process_speaks(self):
        done = self.completed(3, "run", *GAS, "time.end=0.01")
        self.assertEqual(done.stderr.count("promised at every step"), 1, done.stderr)
        self.assertEqual(done.stdout.count("wall time"), 1, done.stdout)
        self.assertIn("3 processes", done.stderr)

    def test_a_full_disk_ends_all_and_loses_nothing(self):
        run = self.start(2, "run", *GAS, "time.end=1000.0", "output.checkpoint_every=1", "--out", "out")
        self.await_checkpoint(run, 0)
        # The process with the lowest id writes the checkpoint for all; its files are now limited to 4 KiB.
        resource.prlimit(min(self.processes_of(run)), resource.RLIMIT_FSIZE, (4096, 4096))
        done = run.end()
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertEqual(len(errors(done.stderr)), 1, done.stderr)
        self.assertIn("checkpoint.h5", errors(done.stderr)[0])
        self.completed(1, "run", *GAS, "time.end=0.1", "--restart", "out/checkpoint.h5")

    def test_a_signal_to_one_process_stops_all_at_the_same_step(self):
        run = self.start(3, "run", *GAS, "time.end=1000.0", "output.checkpoint_every=1", "--out", "out")
        self.await_checkpoint(run, 0)
        victims = self.processes_of(run)
        self.assertEqual(len(victims), 3)
        os.kill(victims[1], signal.SIGTERM)
        done = run.end()
        self.assertEqual(done.returncode, 130, done.stderr)
        self.assertIn('"interrupted"', (self.folder / "out" / "manifest.json").read_text())


if __name__ == "__main__":
    main()
