#!/usr/bin/env bash
# Property-based tests with many random inputs from a seed that differs from run to run; the quick suite uses the same
# inputs in every run. A failure prints the seed.
# Usage: fresh_seeds.sh DIRECTORY_OF_TEST_PROGRAMS
set -euo pipefail
tests=$(dirname "$(readlink -f "$0")")
names=$(grep -rhoE 'RC_GTEST_PROP\(\w+, *\w+' "$tests" --include='*.cpp' | sed -E 's/RC_GTEST_PROP\((\w+), */\1./' | paste -sd:)
[ -n "$names" ] || { echo "no property found below $tests" >&2; exit 1; }
seed=$(od -An -N4 -tu4 /dev/urandom | tr -d ' ')
status=0 run=0
for program in "$1"/test_*; do
  [ -f "$program" ] && [ -x "$program" ] || continue
  "$program" --gtest_list_tests --gtest_filter="$names" | grep -q '^  ' || continue
  echo "$(basename "$program"): RC_PARAMS=\"seed=$seed max_success=1000\""
  RC_PARAMS="seed=$seed max_success=1000" "$program" --gtest_brief=1 --gtest_filter="$names" || status=1
  run=$((run + 1))
done
[ "$run" -gt 0 ] || { echo "no test program with properties in $1" >&2; exit 1; }
exit $status
