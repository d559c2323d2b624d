"""Messages of errors read "problem (reason); suggestion.": a reason in parentheses is followed by a semicolon."""

import ast
import re
import unittest
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
CPP_FOLDERS = ["app", "src/apsis", "paper", "validation", "python/bindings"]
PYTHON_FOLDERS = ["python/apsis", "docs", "studies", "bench", "scripts"]

# Expressions that throw or warn, and helpers of a file that compose messages. Constructors may have braces.
CALL = re.compile(
    r"\b(?:\w+_error|fail\w*|refuse|cannot|unusable|missing|problem\w*|log::warning|log::info|warning)\s*(?=[({])"
    r"|\breturn\s+(?=fmt::format\(|\")")
CODE = re.compile(r'"(?P<text>(?:[^"\\\n]|\\.)*)"|//[^\n]*|\'(?:[^\'\\]|\\.)\''
                  r"|[()\[\]{},;?]|::|:|\s+|[^\s\"'()\[\]{},;?:/]+|.")


def messages(source, at):
    """Returns the texts in the brackets that open at `at`, otherwise up to the semicolon: one for each operand of commas and ?:, with
    {} for non-literals. A nested bracket is {} in the surrounding text, and has its own texts."""
    texts, around, current = [], [], ""
    bracketed = source[at] in "({"
    for token in CODE.finditer(source, at):
        part = token[0]
        if token["text"] is not None:
            current += token["text"]
        elif part in "([{":
            around.append(current)
            current = ""
        elif part in ")]}" and around:
            texts.append(current)
            current = around.pop() + "{}"
            if bracketed and not around:
                break
        elif part in ",;?:":
            texts.append(current)
            current = ""
            if part == ";" and not around:
                break
        elif not part.isspace() and not part.startswith("//") and part != "+":
            current += "{}"
    return [text for text in texts if " " in text]


def cpp_messages(file):
    source = file.read_text(encoding="utf-8")
    for match in CALL.finditer(source):
        line = source.count("\n", 0, match.start()) + 1
        yield from ((line, text) for text in messages(source, match.end()))


def python_text(node):
    if isinstance(node, ast.Constant):
        return str(node.value)
    if isinstance(node, ast.JoinedStr):
        return "".join(map(python_text, node.values))
    if isinstance(node, ast.BinOp):
        return python_text(node.left) + python_text(node.right)
    return "{}"


def python_messages(file):
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Call) and re.search(r"(Error|Problem|Exit)$", getattr(node.func, "id", "")):
            yield from ((node.lineno, text) for text in map(python_text, node.args) if " " in text)


def all_messages():
    for folders, endings, read in ((CPP_FOLDERS, (".cpp", ".hpp"), cpp_messages), (PYTHON_FOLDERS, (".py",), python_messages)):
        for folder in folders:
            for file in sorted((SOURCE / folder).rglob("*")):
                if file.suffix in endings:
                    yield from ((f"{file.relative_to(SOURCE)}:{line}", text) for line, text in read(file))


def unseparated(text):
    """Returns true if only a space separates a suggestion from the preceding reason in parentheses or name."""
    text = re.sub(r"(?<=\w)\(\)", "", text)  # the name of a function, as in "call on() first"
    return re.search(r"\) [^\s();][^();]*$|['})] (\{\})+$", text) is not None and re.search("[a-z]{3}", text) is not None


class Messages(unittest.TestCase):
    def test_reasons_are_separated_from_suggestions(self):
        found = list(all_messages())
        self.assertEqual([f"{place}: {text}" for place, text in found if unseparated(text)], [])
        # Hundreds of messages have a separator; far fewer would mean that the reader misses some.
        self.assertGreater(sum("); " in text for _, text in found), 180)

    def test_the_reader_of_c_plus_plus_finds_every_form_of_a_message(self):
        for source, wanted in (
            ('throw input_error("bad \'" + name(x, y) + "\' (why) "\n  "do")', "bad '{}{}' (why) do"),
            ('throw input_error(place, fmt::format("bad {} (why) {}", f("a", b), g))', "bad {} (why) {}"),
            ('file.fail(good ? "x" : "has no data (why) do")', "has no data (why) do"),
            ('refuse(raw, "key", "one reason", "a suggestion")', "a suggestion"),
            ('throw io_error{"cannot read (why) do"}', "cannot read (why) do"),
            ('return fmt::format("too long ({}) {}", n, rule);', "too long ({}) {}"),
        ):
            texts = [text for match in CALL.finditer(source) for text in messages(source, match.end())]
            self.assertIn(wanted, texts)

    def test_the_pattern_finds_missing_separators(self):
        self.assertTrue(unseparated("cannot read '{}' (it is a folder) give a file"))
        self.assertTrue(unseparated("no case '{}' (neither a file nor built in) {}"))
        self.assertTrue(unseparated("unknown method '{}' {}{}"))
        self.assertFalse(unseparated("cannot read '{}' (it is a folder); give a file"))
        self.assertFalse(unseparated("unknown method '{}'; {}{}"))
        self.assertFalse(unseparated("unknown key 'a' (line 3)"))
        self.assertFalse(unseparated("no face {} (there are {}); call on() first"))


if __name__ == "__main__":
    unittest.main()
