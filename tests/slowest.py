"""Prints the slowest 1 % of the tests of a run, and their part of the total time.

Usage: slowest.py JUNIT_FILE (ctest --output-junit)
"""
import math
import sys
import xml.etree.ElementTree as xml


def main():
    tests = [(float(test.get("time")), test.get("name").split("  # ")[0]) for test in xml.parse(sys.argv[1]).getroot().iter("testcase")
             if test.get("status") in ("run", "fail")]
    slowest = sorted(tests, reverse=True)[:math.ceil(0.01 * len(tests))]
    total, theirs = sum(time for time, _ in tests), sum(time for time, _ in slowest)
    print(f"The slowest 1 % of {len(tests)} tests took {theirs:.0f} s of {total:.0f} s:")
    for time, name in slowest:
        print(f"{time:8.1f} s  {name}")


if __name__ == "__main__":
    main()
