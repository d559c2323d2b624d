"""The messages of every table of bad input (tests/*/bad_input, and those in C++) read "problem (reason); suggestion."

A test program runs its tables and records the messages, which are checked here. Usage: test_bad_input.py PROGRAM
"""
import json
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from test_messages import unseparated
from test_vocabulary import AVOIDED

PLACE = re.compile(r"(?P<place>c\.toml:\d+:\d+: |override '.*?': |[\w./-]+:\d+:\d+: |)(?P<text>.*)", re.S)


def tests_with_rows(program):
    """Yields the names of the tests of a program test_ROOM whose sources have rows of bad input, without slow tests."""
    room = Path(program).name.removeprefix("test_")
    for file in sorted(Path(__file__).resolve().parents[1].joinpath(room).glob("*.cpp")):
        for test in re.split(r"^(?=TEST|RC_GTEST)", file.read_text(encoding="utf-8"), flags=re.M):
            name = re.match(r"(TEST(?:_F|_P)?)\((\w+), (\w+)\)", test)
            if name and "bad_input::expect_" in test and not name[2].startswith("SLOW_"):
                yield f"*/{name[2]}.{name[3]}/*" if name[1] == "TEST_P" else f"{name[2]}.{name[3]}"


def messages_of(program):
    """Returns (row, message) of every row of bad input that a program refuses."""
    names = ":".join(tests_with_rows(program))
    with tempfile.TemporaryDirectory() as folder:
        record = Path(folder, "record.json")
        subprocess.run([program, f"--gtest_filter={names}", f"--gtest_output=json:{record}"], check=True, stdout=subprocess.DEVNULL)
        suites = json.loads(record.read_text(encoding="utf-8"))["testsuites"]
    # GoogleTest writes every byte of UTF-8 as a character.
    return [(label, message.encode("latin-1").decode("utf-8")) for suite in suites for test in suite["testsuite"]
            for label, message in test.items() if re.search(r"\.(toml|cpp):", label)]


def without_quotes(text):
    """Returns the text without quoted parts of the input, which are not words of the program."""
    return re.sub(r"'[^']*'", "'…'", text)


def problems_of(message):
    text = PLACE.fullmatch(message)["text"]
    if not re.search(r"\); \S", text):
        yield "lacks a reason in parentheses before its suggestion"
    if unseparated(text):
        yield "has no '; ' between the reason and the suggestion"
    if re.search(r"[\x00-\x1f\x7f-\x9f]", message):
        yield "has a control character"
    if "  " in without_quotes(text) or text != text.strip():
        yield "has a doubled space, or one at its ends"
    if re.search(r"(?<!\.\.)[.;,:]$", text):
        yield "ends with a punctuation mark"
    for pattern, instead in AVOIDED.items():
        found = re.search(pattern, without_quotes(text), re.M)
        if found:
            yield f"has '{found[0].strip()}' (write: {instead})"


class BadInput(unittest.TestCase):
    program = None

    def test_every_message_has_a_problem_a_reason_and_a_suggestion(self):
        found = messages_of(self.program)
        tests = list(tests_with_rows(self.program))
        self.assertTrue(tests)
        self.assertGreaterEqual(len(found), len(tests))  # fewer would mean that a test has lost its rows
        self.assertEqual([f"{label}: {problem}: {message}" for label, message in found for problem in problems_of(message)], [])

    def test_the_grammar_finds_what_is_wrong(self):
        good = "c.toml:6:1: 'space.cells' is the number 4.5 (an integer is needed); write for example 5"
        self.assertEqual(list(problems_of(good)), [])
        for bad in (good.replace("; ", " "), good.replace(" (an integer is needed)", ""), good + ".", good.replace("write ", "write  "),
                    good.replace("is needed", "is\x1bneeded"), good.replace("an integer is needed", "it is " + "none"), good[:-len("write for example 5")]):
            self.assertNotEqual(list(problems_of(bad)), [], bad)


if __name__ == "__main__":
    BadInput.program = sys.argv.pop()
    unittest.main()
