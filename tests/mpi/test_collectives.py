"""If a process fails before a collective operation, the others, which wait in it, end too, with its error and without MPI_Abort."""
import os
import subprocess
import unittest
from pathlib import Path

from busy import busy_loops
from processes import ENVIRONMENT, launched, main, one_of, run, slow

COLLECTIVE = Path(os.environ["APSIS_COLLECTIVE"])
# Number of failing runs in the slow test.
RUNS = int(os.environ.get("APSIS_FAILING_RUNS", "500"))


def names():
    return subprocess.run([COLLECTIVE], env=ENVIRONMENT, capture_output=True, text=True, check=True).stdout.split()


def errors(text):
    return [line for line in text.splitlines() if line.startswith("error:")]


class Collectives(unittest.TestCase):
    def expect_one_error(self, name, failing):
        done = run(launched(3, COLLECTIVE, name, failing, "fails"))
        self.assertEqual(done.returncode, 3, done.stderr)
        who = f"process {failing}: " if failing else ""
        self.assertEqual(errors(done.stderr), [f"error: {who}this process fails"], done.stderr)
        self.assertNotIn("MPI_ABORT", done.stderr)
        # The launcher may kill a process after the first one has ended; then the process has no code.
        self.assertLessEqual(done.codes.items(), {0: 3, 1: 0, 2: 0}.items(), done.stderr)
        return done

    def test_each_ends_when_a_process_fails(self):
        self.assertGreaterEqual(len(names()), 8)
        for k, name in enumerate(names()):
            with self.subTest(name, failing=k % 3):
                self.expect_one_error(name, k % 3)

    @slow
    def test_five_hundred_failing_runs_of_all_beside_four_busy_loops(self):
        cases = [(name, failing) for name in names() for failing in range(3)]
        hung = 0
        with busy_loops(4):
            for k in range(RUNS):
                if k % 100 == 99:
                    print(f"{k + 1} runs", flush=True)
                hung += self.expect_one_error(*cases[k % len(cases)]).launcher_hung
        print(f"{RUNS} failing runs of {len(cases)} kinds; the launcher hung {hung} times after the end of its processes")

    def test_a_process_that_does_not_respond_is_aborted(self):
        done = run(launched(3, COLLECTIVE, "sum", 1, "hangs"))
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertTrue(errors(done.stderr)[0].endswith("process 2: this process fails"), done.stderr)

    def test_a_signal_ends_processes_that_wait_for_one_that_does_not_respond(self):
        for name, absent in (("lowest", 2), ("exchange", 0)):
            done = run(launched(3, COLLECTIVE, name, absent, "is-missed"))
            self.assertEqual(done.returncode, 130, done.stderr)
            self.assertRegex(errors(done.stderr)[0], "interrupted: process . waited 0 s for another one", done.stderr)

    def test_results_on_any_number_of_processes(self):
        for number, name in enumerate(names()):
            for count in one_of((3, 4, 7), number):
                with self.subTest(name, count=count):
                    done = run(launched(count, COLLECTIVE, name, count, "fails"))
                    self.assertEqual(done.returncode, 0, done.stderr)


if __name__ == "__main__":
    main()
