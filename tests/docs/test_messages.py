"""Messages of errors read "problem (reason); suggestion.": a reason in parentheses is followed by a semicolon."""

import re
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
FOLDERS = ["app", "src/apsis/core", "src/apsis/model", "src/apsis/config"]

LITERAL = r'"(?:[^"\\\n]|\\.)*"'
# A call that makes a message, up to the literals of its text; a place may stand before them.
MESSAGE = re.compile(
    r"(?:(?:input|numerical|io|claim)_error|\bfail|\brefuse|log::warning)\(\s*(?:[\w.():+\s]+,\s*)?(?:fmt::format\(\s*)?"
    rf"((?:{LITERAL}\s*)+)")


def text_of(literals):
    return "".join(part[1:-1] for part in re.findall(LITERAL, literals))


def unseparated(text):
    """Whether a suggestion follows the last parenthesis with nothing but a space."""
    return re.search(r"\) (?:\w|\{|')[^()]*$", text) is not None


class Messages(unittest.TestCase):
    def test_reasons_are_separated_from_suggestions(self):
        found, wrong = 0, []
        for folder in FOLDERS:
            for file in sorted((SOURCE / folder).glob("*.cpp")):
                source = file.read_text(encoding="utf-8")
                for match in MESSAGE.finditer(source):
                    found += 1
                    if unseparated(text_of(match[1])):
                        line = source.count("\n", 0, match.start()) + 1
                        wrong.append(f"{file.relative_to(SOURCE)}:{line}: {text_of(match[1])}")
        # Of today's 59; far fewer would mean that the pattern no longer finds them.
        self.assertGreater(found, 40)
        self.assertEqual(wrong, [])

    def test_the_pattern_sees_what_it_forbids(self):
        self.assertTrue(unseparated("cannot read '{}' (it is a folder) give a file"))
        self.assertTrue(unseparated("no case '{}' (neither a file nor built in) {}"))
        self.assertFalse(unseparated("cannot read '{}' (it is a folder); give a file"))
        self.assertFalse(unseparated("unknown key 'a' (line 3)"))


if __name__ == "__main__":
    unittest.main()
