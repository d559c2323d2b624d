"""Identifiers of docs/vocabulary.md exist in the headers, and no comment, message or page has a phrase that obscures a sentence."""
import ast
import io
import re
import tokenize
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "vocabulary.md"

# Folders and files with comments, messages or pages. This file quotes the phrases.
PLACES = ["src", "app", "paper", "validation", "python", "bench", "studies", "methods", "cases", "cmake", "scripts", "tests", "examples", "docs",
          "README.md", "CHANGELOG.md", "CONTRIBUTING.md"]

# Phrases with a plainer alternative: a pattern and what to write instead.
AVOIDED = {
    r"\btells? (of|by|how|it|whether|what|why)\b|\b(is|are) told\b": "report, state, show",
    r"\bbesides\b": "optionally, in addition",
    r"(?<!there )\b(is|are) none\b|\b(is|are) no numbers?\b": "there is no …, does not count, NaN",
    r"\bof which\b": "a clause of its own, or whose",
    r"(^|[.:;] )What (?!if\b)|\bwhat (is|are|was) \w+ of\b": "the noun itself",
    r"\bgo(es)? on\b": "continue, proceed",
    r"\bsees? (\w+ ){0,4}through\b": "flush, carry out",
    r"\bthings?\b": "the noun itself",
    r"\bat once\b": "simultaneously, immediately",
    r"\bno way to\b": "cannot",
    r"\bat hand\b": "available",
    r"\bof no (use|meaning|value)\b": "ignored, undefined, useless",
    r"^(likewise|the same)[.]?$": "the meaning in words",
}

CPP = re.compile(r'(?P<comment>//[^\n]*)|"(?P<text>(?:[^"\\\n]|\\.)*)"|\'(?:[^\'\\\n]|\\.)\'')
RAW = re.compile(r'R"(\w*)\(.*?\)\1"', re.S)


def cpp_texts(source):
    """Comments, joined over lines, and string literals, joined over adjacent ones, with their lines."""
    source = RAW.sub(lambda match: "\n" * match[0].count("\n"), source)
    texts, end, kind = [], 0, None
    for match in CPP.finditer(source):
        found = "comment" if match["comment"] else "text" if match["text"] is not None else None
        if found is None:
            continue
        part = re.sub(r"^//[/!]?<? ?", "", match["comment"]) if found == "comment" else match["text"]
        joined = found == kind and not source[end:match.start()].strip() and source.count("\n", end, match.start()) <= 1
        if found == "comment" and "<" in match["comment"][:4]:
            joined = joined and not source[source.rfind("\n", 0, match.start()) + 1:match.start()].strip()
        if joined:
            texts[-1] = (texts[-1][0], texts[-1][1] + (" " if found == "comment" else "") + part)
        else:
            texts.append((source.count("\n", 0, match.start()) + 1, part))
        end, kind = match.end(), found
    return texts


def hash_texts(source):
    """Comments behind #, joined over lines that consist of a comment."""
    texts, previous = [], -1
    for number, line in enumerate(source.splitlines(), 1):
        match = re.match(r'^((?:[^"#]|"(?:[^"\\]|\\.)*")*)#\s?(.*)$', line)
        if match is None:
            continue
        if not match[1].strip() and previous == number - 1:
            texts[-1] = (texts[-1][0], texts[-1][1] + " " + match[2])
        else:
            texts.append((number, match[2]))
        previous = number if not match[1].strip() else -1
    return texts


def python_texts(source):
    comments = [(token.start[0], token.string.lstrip("# ")) for token in tokenize.generate_tokens(io.StringIO(source).readline)
                if token.type == tokenize.COMMENT]
    strings = [(node.lineno, " ".join(node.value.split())) for node in ast.walk(ast.parse(source))
               if isinstance(node, ast.Constant) and isinstance(node.value, str) and " " in node.value]
    return comments + strings


def page_texts(source):
    texts, line = [], 1
    for paragraph in re.split(r"(\n\s*\n)", source):
        texts.append((line, " ".join(paragraph.split())))
        line += paragraph.count("\n")
    return texts


READERS = {".cpp": cpp_texts, ".hpp": cpp_texts, ".h": cpp_texts, ".py": python_texts, ".toml": hash_texts, ".txt": hash_texts, ".md": page_texts}


def files_of(place):
    path = ROOT / place
    return [path] if path.is_file() else sorted(file for file in path.rglob("*") if file.suffix in READERS)


def avoided_in(file):
    for line, text in READERS[file.suffix](file.read_text(encoding="utf-8")):
        for pattern, instead in AVOIDED.items():
            match = re.search(pattern, text, re.M)
            if match:
                yield f"{file.relative_to(ROOT)}:{line}: '{match[0].strip()}' (write: {instead})"


def rows(page):
    """(word, definition, identifiers) of every table row below a header `| word | … | in code |`."""
    for line in page.splitlines():
        cells = [cell.strip() for cell in line.strip().strip("|").split("|")]
        if line.startswith("|") and len(cells) == 3 and not set(cells[0]) <= set("-: ") and cells[0] != "word":
            yield cells[0], cells[1], re.findall(r"`([^`]+)`", cells[2])


class Vocabulary(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.rows = list(rows(PAGE.read_text(encoding="utf-8")))
        headers = [file for folder in ("src/apsis", "paper") for file in (ROOT / folder).rglob("*.hpp")]
        cls.names = set(re.findall(r"\w+", "\n".join(file.read_text(encoding="utf-8") for file in headers)))

    def test_every_identifier_exists_in_the_headers(self):
        self.assertGreater(len(self.rows), 40)
        for word, _, identifiers in self.rows:
            for identifier in identifiers:
                missing = [part for part in re.findall(r"\w+", identifier) if part not in self.names]
                self.assertEqual(missing, [], f"{word}: {identifier}")

    def test_every_word_has_one_definition(self):
        words = [word for word, _, _ in self.rows]
        self.assertEqual(sorted(words), sorted(set(words)))
        for word, definition, identifiers in self.rows:
            self.assertTrue(definition, word)
            self.assertTrue(identifiers, word)

    def test_an_identifier_carries_one_idea(self):
        owners = {}
        for word, _, identifiers in self.rows:
            for identifier in identifiers:
                self.assertNotIn(identifier, owners, f"{word} and {owners.get(identifier)}")
                owners[identifier] = word


class Wording(unittest.TestCase):
    def test_no_text_has_an_obscure_phrase(self):
        files = [file for place in PLACES for file in files_of(place) if file != Path(__file__).resolve()]
        self.assertGreater(len(files), 500)
        self.assertEqual([found for file in files for found in avoided_in(file)], [])

    def test_readers_join_lines_and_find_planted_phrases(self):
        self.assertEqual(cpp_texts('/// one\n/// two\nint a;  ///< of\nthrow e("x y "\n  "z");'),
                         [(1, "one two"), (3, "of"), (4, "x y z")])
        self.assertEqual(hash_texts('# one\n# two\nkey = "a # b"  # three\n'), [(1, "one two"), (3, "three")])
        for text in ("the parts of a step of which a profile tells", "What is dropped", "and the result besides",
                     "where one of them is no number", "Throws. What goes on", "sees the file through to the disk"):
            self.assertTrue(any(re.search(pattern, text, re.M) for pattern in AVOIDED), text)
        for text in ("Returns the maximum.", "evaluated at most once", "the sum, whose terms are positive"):
            self.assertFalse(any(re.search(pattern, text, re.M) for pattern in AVOIDED), text)


if __name__ == "__main__":
    unittest.main()
