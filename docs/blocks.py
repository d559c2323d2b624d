"""The code blocks of a page of documentation, the comments before them, and comparison of outputs.

A comment directly before a block determines its treatment; GitHub does not show comments:

    <!-- file: NAME -->         the block is written to NAME in the folder of the page
    <!-- from: PATH -->         an excerpt, to the letter, of a file of the repository or of the folder of the page; a line
                                that is a comment with only … stands for omitted lines
    <!-- output: 1e-3 -->       what the block before prints: numbers to this relative tolerance (1e-6 if none is given),
                                … for any text up to the following one
    <!-- exit: 2 -->            the block ends with this exit code; its output is what it prints and its messages
    <!-- elsewhere: FILE -->    this test of the repository runs the block; it names the page
    <!-- needs: design -->      the block is left out, with its output, where this component is not built

The engine is the project's own: extensions of Sphinx neither compare numbers by a tolerance nor run C++ and case files
(docs/measured.md).
"""
import re
import textwrap
from dataclasses import dataclass, field
from pathlib import Path

MARKS = {"file", "from", "output", "exit", "elsewhere", "needs"}
# Components whose libraries may be absent, with words of the blocks that need them.
OPTIONAL = {"design": re.compile(r"\bapsis design\b|COMPONENTS [^)]*\bdesign\b"),
            "sundials": re.compile(r"COMPONENTS [^)]*\bsundials\b"),
            "petsc": re.compile(r"\blibapsis_petsc\b|COMPONENTS [^)]*\bpetsc\b")}
COMMENT = re.compile(r"\s*<!--\s*([a-z-]+)(?::\s*(.*?))?\s*-->\s*$")
FENCE = re.compile(r"(\s*(?:(?:[-*+]|[0-9]+[.)])\s+)?)(`{3,}|~{3,})\s*([^\s`]*)[^`]*$")
COMMAND = re.compile(r"\s*(\$ |>>> |#include\b|(sudo|apsis|make|cmake|ctest|cpack|python3?|pip3?|git|apt|apt-get|g\+\+|bash|"
                     r"(build|scripts|docs|studies|bench|env)/\S+)( |$)|import \w+|from \w\S* import )")
TOKEN = re.compile(r"(?<![\w.])[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?|[^\W\d]\w*|\s+|.", re.DOTALL)


class Problem(Exception):
    """A problem of a page: problem (reason); suggestion."""

    def __init__(self, line: int, text: str):
        super().__init__(text)
        self.line = line


@dataclass
class Block:
    """Lines of a page, first to last, counted from 1, without the fences. `line` is that of the fence."""

    language: str
    line: int
    last: int
    text: str
    indent: str = ""
    marks: dict[str, str] = field(default_factory=dict)

    @property
    def runs(self) -> bool:
        """Whether the block is a program that is executed unchanged."""
        return self.language in ("sh", "python", "cpp") and not self.marks.keys() & {"file", "from", "output", "elsewhere"}


def read_blocks(text: str) -> list[Block]:
    """Returns the fenced blocks in order. Raises Problem."""
    lines, blocks, marks, at = text.splitlines(), [], {}, 0
    while at < len(lines):
        comment, fence = COMMENT.match(lines[at]), FENCE.match(lines[at])
        at += 1
        if comment:
            marks[comment[1]] = (comment[2] or "", at)
            continue
        if re.match(r"\s*>.*(```|~~~)", lines[at - 1]):
            raise Problem(at, "a block stands in a quotation (it cannot be read there); take it out")
        if not fence:
            stray(marks, MARKS, "is not before a block")
            marks = {}
            continue
        stray(marks, marks.keys() - MARKS, "is no instruction for a block")
        first, indent = at, " " * len(fence[1])
        while at < len(lines) and not (lines[at].strip().startswith(fence[2]) and not lines[at].strip(" `~")):
            at += 1
        if at == len(lines):
            raise Problem(first, f"the block does not end (no closing {fence[2]}); add it")
        body = "".join(line.removeprefix(indent) + "\n" for line in lines[first:at])
        blocks.append(Block(fence[3], first, at, body, indent, {name: value for name, (value, _) in marks.items()}))
        marks, at = {}, at + 1
    stray(marks, MARKS, "is not before a block")
    return blocks


def stray(marks, names, why):
    for name in marks.keys() & names:
        raise Problem(marks[name][1], f"<!-- {name} --> {why} (instructions: {', '.join(sorted(MARKS))}); mend or remove it")


def check_rules(text: str, blocks: list[Block]) -> list[Problem]:
    """Returns blocks that no rule covers: no test would detect their errors."""
    found = []
    for block in blocks:
        if block.language in ("", "text") and not block.marks:
            command = next((line for line in block.text.splitlines() if COMMAND.match(line)), None)
            if command:
                found.append(Problem(block.line, f"'{command.strip()}' stands in a block that is not run (its language is "
                                     f"'{block.language}'); write ```sh, ```python or ```cpp"))
        elif block.language == "cpp" and block.runs and not re.search(r"\bint main\b", block.text):
            found.append(Problem(block.line, "the program has no main (nothing can run it); say <!-- from: PATH --> or "
                                 "<!-- file: NAME -->"))
        elif not block.runs and not block.marks.keys() - {"exit", "needs"}:
            found.append(Problem(block.line, f"nothing checks this block (language '{block.language}'); put one of "
                                 f"{', '.join(f'<!-- {mark} -->' for mark in sorted(MARKS - {'exit', 'needs'}))} before it"))
        for mark, kind in (("output", float), ("exit", int)):
            if block.marks.get(mark) and not is_number(block.marks[mark], kind):
                found.append(Problem(block.line, f"<!-- {mark}: {block.marks[mark]} --> (not a number); give a number or omit it"))
        if "exit" in block.marks and not (block.runs and block.language in ("sh", "cpp")):
            found.append(Problem(block.line, "an exit code belongs to a program (```sh or ```cpp that is run here); take it away"))
        if "needs" in block.marks and (block.marks["needs"] not in OPTIONAL or not (block.runs or "elsewhere" in block.marks)):
            found.append(Problem(block.line, f"<!-- needs: {block.marks['needs']} --> leaves nothing out (a program needs an optional "
                                 f"component); name one of {', '.join(OPTIONAL)} before a block that is run"))
        for component in missing_needs(block, blocks):
            found.append(Problem(block.line, f"the block needs the component {component} (which may be absent); say <!-- needs: {component} --> "
                                 "before the blocks that are run"))
        if "file" in block.marks and not is_used(block, blocks):
            found.append(Problem(block.line, f"{block.marks['file']} is written and not used (no other block names it); run or "
                                 "compile it in an ```sh block"))
    inside = {n for block in blocks for n in range(block.line, block.last + 2)}
    for number, line in enumerate(text.splitlines(), 1):
        if number not in inside and line.startswith("    ") and COMMAND.match(line):
            found.append(Problem(number, f"'{line.strip()}' is indented text (nothing runs it); write an ```sh block"))
    return found


def missing_needs(block: Block, blocks: list[Block]) -> list[str]:
    """Returns the optional components that a program needs and that no instruction names: one before it, or before any block that may
    compile it if it is a file. Methods and cases may mention a component, but need none."""
    if block.language == "toml":
        return []
    if "file" in block.marks:
        named = {other.marks.get("needs") for other in blocks}
    elif block.runs or "elsewhere" in block.marks:
        named = {block.marks.get("needs")}
    else:
        return []
    return [component for component, words in OPTIONAL.items() if words.search(block.text) and component not in named]


def is_number(text: str, kind: type) -> bool:
    try:
        return kind(text) >= 0
    except ValueError:
        return False


def is_used(block: Block, blocks: list[Block]) -> bool:
    """A case is checked alone; any other file must be named by another block, CMakeLists.txt by a call of cmake."""
    if block.language == "toml":
        return True
    name = Path(block.marks["file"])
    word = "cmake" if name.name == "CMakeLists.txt" else name.stem
    return any(word in other.text for other in blocks if other is not block)


def is_excerpt(excerpt: str, text: str) -> bool:
    """Whether all lines occur in the text, in order, without gaps except those marked by …, at any common indentation."""
    parts, lines, at = [[]], text.splitlines(), 0
    for line in textwrap.dedent(excerpt).strip("\n").splitlines():
        if re.fullmatch(r"\s*(//|#|--)?\s*…\s*", line):
            parts.append([])
        else:
            parts[-1].append(line.rstrip())
    parts = [part for part in parts if part]
    for part in parts:
        wanted = textwrap.dedent("\n".join(part))
        while at + len(part) <= len(lines):
            if textwrap.dedent("\n".join(line.rstrip() for line in lines[at:at + len(part)])) == wanted:
                break
            at += 1
        else:
            return False
        at += len(part)
    return bool(parts)


def is_same_output(shown: str, printed: str, tolerance: float) -> bool:
    """Whether an output agrees with that of the page, where … stands for any text. Column widths are ignored."""
    pieces, rest = [[]], tokens(printed)
    for token in tokens(shown):
        if token == "…":
            pieces.append([])
        else:
            pieces[-1].append(token)
    for piece in pieces[:-1]:  # blanks beside … belong to it
        while piece and piece[-1].isspace():
            piece.pop()
    for piece in pieces[1:]:
        while piece and piece[0].isspace():
            piece.pop(0)
    if len(pieces) == 1:
        return len(rest) == len(pieces[0]) and starts_with(rest, pieces[0], tolerance)
    head, *middle, tail = pieces
    if len(head) + len(tail) > len(rest) or not starts_with(rest, head, tolerance):
        return False
    end = len(rest) - len(tail)
    if not starts_with(rest[end:], tail, tolerance):
        return False
    at = len(head)
    for piece in middle:
        at = next((i + len(piece) for i in range(at, end - len(piece) + 1) if starts_with(rest[i:], piece, tolerance)), None)
        if at is None:
            return False
    return True


def tokens(text: str) -> list[str]:
    """Numbers, words and other characters; blanks as one blank, ends of lines as they are."""
    found = TOKEN.findall("\n".join(line.rstrip() for line in text.strip().splitlines()))
    return ["\n" * token.count("\n") or " " if token.isspace() else token for token in found]


def starts_with(found: list[str], wanted: list[str], tolerance: float) -> bool:
    return len(found) >= len(wanted) and all(is_same(a, b, tolerance) for a, b in zip(found, wanted))


def is_same(a: str, b: str, tolerance: float) -> bool:
    try:
        x, y = float(a), float(b)
    except ValueError:
        return a == b
    return a == b or abs(x - y) <= tolerance * max(abs(x), abs(y))
