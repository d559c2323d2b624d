#!/bin/bash
# check.sh BUILD: compares a device with the host, bit for bit, by the tests of `make test` (tests/device). The device is the
# first real one, or that of APSIS_DEVICE; "teams" are lanes on the host. With compute-sanitizer on the PATH, the
# tests run under its checks of memory and of races once more.
# Exit code: 0 if all bits are equal, 1 if a test fails, 77 without a device.
build=$1
export APSIS_DEVICE=${APSIS_DEVICE:-first}

# Runs the tests by a command, as arguments of it.
check() {
  local program code
  for program in test_device test_device_runs; do
    "$@" "$build/tests/$program" --gtest_brief=1
    code=$?
    [ $code = 77 ] && exit 77
    [ $code = 0 ] || exit 1
  done
}

check env
if command -v compute-sanitizer >/dev/null; then
  for tool in memcheck racecheck; do check compute-sanitizer --tool "$tool" --error-exitcode 1; done
else
  echo "compute-sanitizer is not on the PATH: memory and races were not checked"
fi
echo "all bits are those of the host"
