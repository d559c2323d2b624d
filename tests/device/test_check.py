"""tests/device/check.sh returns different exit codes for equal bits, for other bits, and without a device. A fake driver
(fake/driver.cpp) replaces a real one."""
import os
import subprocess
import tempfile
import unittest
from pathlib import Path

HERE = Path(__file__).resolve().parent
BUILD = Path(os.environ.get("APSIS_BUILD", HERE.parents[1] / "build" / "release"))
# Tests that together use all kinds of kernels.
SOME = "device_transport.*scheme*:device_collision.rates*:device_runs.*continued*"


def check(tests=SOME, **variables):
    """Returns the exit code and the output of the check. A variable that is None is removed from the environment."""
    # The variables hide real devices of this machine.
    environment = {**os.environ, "CUDA_VISIBLE_DEVICES": "", "HIP_VISIBLE_DEVICES": "-1", "GTEST_FILTER": tests, **variables}
    environment = {name: value for name, value in environment.items() if value is not None}
    done = subprocess.run([HERE / "check.sh", BUILD], env=environment, capture_output=True, text=True, check=False)
    return done.returncode, done.stdout + done.stderr


def with_driver(**variables):
    return check(**{"LD_LIBRARY_PATH": str(BUILD / "tests" / "fake_driver"), **variables})


class Check(unittest.TestCase):
    def test_without_a_device_nothing_is_claimed(self):
        code, text = check()
        self.assertEqual(code, 77, text)
        self.assertIn("no device\n", text)
        self.assertNotIn("PASSED", text)
        self.assertNotIn("all bits", text)

    def test_equal_bits_of_a_driver_are_a_success(self):
        expect_success(self)

    def test_a_wrong_bit_fails_with_its_case_and_place(self):
        code, text = with_driver(FAKE_DEVICE="wrong")
        self.assertEqual(code, 1, text)
        self.assertRegex(text, r"the first one in cell 0, component 0: 0x\S+ on the host, 0x\S+ on the device")
        self.assertRegex(text, r"\nweno5-z with limited fluxes\n")
        self.assertNotIn("all bits", text)

    def test_a_device_that_cannot_run_the_kernels_is_a_failure(self):
        code, text = with_driver(FAKE_DEVICE="old")
        self.assertEqual(code, 1, text)
        self.assertIn("compute capability is 6.1", text)

    def test_no_test_is_no_success(self):
        code, text = with_driver(tests="no.such_test")
        self.assertEqual(code, 1, text)
        self.assertIn("no test was selected", text)

    def test_lanes_on_the_host_count_when_they_are_asked_for(self):
        code, text = check(APSIS_DEVICE="teams")
        self.assertEqual(code, 0, text)
        self.assertIn("device: lanes on the host", text)

    def test_the_sanitizer_runs_where_there_is_one(self):
        with tempfile.TemporaryDirectory() as folder:
            tool = Path(folder) / "compute-sanitizer"
            for fails in (False, True):
                tool.write_text(f'#!/bin/bash\necho "sanitizer $2" >&2\n[ {int(fails)} = 1 ] && exit 1\nexec "${{@:5}}"\n', encoding="utf-8")
                tool.chmod(0o755)
                code, text = with_driver(PATH=folder + os.pathsep + os.environ["PATH"])
                self.assertEqual(code, int(fails), text)
                self.assertIn("sanitizer memcheck", text)
                self.assertEqual("sanitizer racecheck" in text, not fails)
                self.assertEqual("all bits are those of the host" in text, not fails)


class WholeCheck(unittest.TestCase):
    """A test of its own, since it takes minutes. `make test` has the same kernels as lanes on the host."""

    def test_the_whole_comparison_runs_every_kernel_by_a_driver(self):
        expect_success(self, tests=None)


def expect_success(case, **variables):
    code, text = with_driver(**variables)
    case.assertEqual(code, 0, text)
    case.assertIn("device: fake processor", text)
    case.assertIn("all bits are those of the host", text)


if __name__ == "__main__":
    unittest.main()
