"""Prints which tests of a run were skipped and why, then the slowest 1 % and their part of the total time.

Usage: summary.py JUNIT_FILE (ctest --output-junit)
"""
import collections
import math
import re
import sys
import xml.etree.ElementTree as xml

# Lines of GoogleTest, of unittest with -v, and of pytest with -rs.
SKIPPED = re.compile(r": Skipped\n(?P<google>[^\n]+)|\.\.\. skipped '(?P<unittest>[^']+)'|^SKIPPED \[\d+\] (?P<pytest>.+)$", re.M)


def skipped(tests):
    """Returns the names of tests by reason, once for each skipped part."""
    found = collections.defaultdict(list)
    for test in tests:
        for match in SKIPPED.finditer(test.findtext("system-out") or ""):
            found[match[match.lastgroup]].append(name_of(test))
    return found


def name_of(test):
    return test.get("name").split("  # ")[0]


def main():
    tests = list(xml.parse(sys.argv[1]).getroot().iter("testcase"))
    for reason, names in sorted(skipped(tests).items()):
        print(f"Skipped ({reason}): {', '.join(f'{name} {count}' for name, count in collections.Counter(names).items())}")
    times = sorted(((float(test.get("time")), name_of(test)) for test in tests if test.get("status") in ("run", "fail")), reverse=True)
    slowest = times[:math.ceil(0.01 * len(times))]
    total, theirs = sum(time for time, _ in times), sum(time for time, _ in slowest)
    print(f"The slowest 1 % of {len(times)} tests took {theirs:.0f} s of {total:.0f} s:")
    for time, name in slowest:
        print(f"{time:8.1f} s  {name}")


if __name__ == "__main__":
    main()
