"""A process that fails before any collective operation ends the others, which wait in it, promptly and with its exit code."""
import os
import subprocess
import time
import unittest
from pathlib import Path

from processes import ENVIRONMENT, main, run

COLLECTIVE = Path(os.environ["APSIS_COLLECTIVE"])


class Collectives(unittest.TestCase):
    def test_each_ends_when_a_process_fails(self):
        names = subprocess.run([COLLECTIVE], env=ENVIRONMENT, capture_output=True, text=True, check=True).stdout.split()
        self.assertGreaterEqual(len(names), 6)
        for k, name in enumerate(names):
            failing = k % 3
            with self.subTest(name, failing=failing):
                begun = time.monotonic()
                done = run(["mpirun", "-n", "3", str(COLLECTIVE), name, str(failing)], env=ENVIRONMENT, timeout=120)
                self.assertEqual(done.returncode, 3, done.stderr)
                self.assertEqual([line for line in done.stderr.splitlines() if line.startswith("error:")],
                                 [f"error: process {failing}: this process fails"], done.stderr)
                # Half a second of patience, and the start and end of the launcher on a busy machine.
                self.assertLess(time.monotonic() - begun, 60.0)

    def test_none_fails(self):
        done = run(["mpirun", "-n", "3", str(COLLECTIVE), "sum", "7"], env=ENVIRONMENT, timeout=120)
        self.assertEqual(done.returncode, 0, done.stderr)


if __name__ == "__main__":
    main()
