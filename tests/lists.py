"""Every GoogleTest test is in exactly one of two lists: that of `make test`, or that of `make test-all` if its suite is SLOW_NAME.

Usage: lists.py CTEST BUILD_FOLDER
"""
import collections
import json
import re
import subprocess
import sys
from pathlib import Path


def output_of(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def tests_of(program):
    """Yields the names suite.test of a program."""
    suite = ""
    for line in output_of(program, "--gtest_list_tests").splitlines():
        if re.match(r"\S+\.(\s|$)", line):
            suite = line.split()[0]
        elif line.startswith("  "):
            yield suite + line.split()[0]


def entry_of(name):
    """Returns the filter that runs a test. All instances of a parameterised test have one, which ends in /* (discover.cmake)."""
    suite, _, test = name.partition(".")
    name, slash, _ = test.partition("/")
    return f"{suite}.{name}{slash and '/*'}"


def is_slow(name):
    """Returns true if the suite or its instantiation is named SLOW_NAME."""
    return re.match(r"(\w+/)?SLOW_", name) is not None


def registered(ctest, build):
    """Returns the labels of each entry of every registered test, by (program, filter)."""
    found = collections.defaultdict(list)
    for test in json.loads(output_of(ctest, "--test-dir", build, "--show-only=json-v1"))["tests"]:
        program, *arguments = test.get("command") or [""]
        labels = next((one["value"] for one in test.get("properties", []) if one["name"] == "LABELS"), [])
        for argument in arguments:
            name = argument.removeprefix("--gtest_filter=")
            if name != argument and "*" not in name.removesuffix("/*"):
                found[Path(program).resolve(), name].append(labels)
    return found


def problems_of(program, lists):
    for name in tests_of(program):
        entries = lists.get((program, entry_of(name)), [])
        expected = ["slow"] if is_slow(name) else []
        if entries != [expected]:
            yield f"{program.name}: {name} is in the lists {entries} (expected: [{expected}])"
        if re.match(r"slow_.*|.*_slow$", name.split(".")[1].split("/")[0], re.I):
            yield f"{program.name}: {name} has 'slow' in the name of the test; name the suite SLOW_NAME"


def main():
    ctest, build = sys.argv[1:]
    lists = registered(ctest, build)
    programs = sorted({program for program, _ in lists})
    problems = [problem for program in programs for problem in problems_of(program, lists)]
    if len(programs) < 10 or not any(labels == [["slow"]] for labels in lists.values()):
        problems.append(f"{len(programs)} test programs and their slow tests were not found in {build}")
    found = {path.resolve() for pattern in ("test_*", "*/test_*") for path in Path(build, "tests").glob(pattern)
             if path.is_file() and path.suffix == "" and path.stat().st_mode & 0o100}
    # The tests of test_races belong to another program, too.
    unregistered = found - set(programs) - {Path(build, "tests/test_races").resolve()}
    problems += [f"no test of {path} is in a list" for path in sorted(unregistered)]
    print("\n".join(problems) or f"{len(lists)} tests of {len(programs)} programs")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
