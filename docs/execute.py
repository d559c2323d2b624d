#!/usr/bin/python3
"""Compiles or runs every code block of the documentation.

    docs/execute.py [PAGE…] [--without PAGE…] [--build build/release] [--work build/docs] [--jobs N] [--update]

The blocks of a page are executed in order in a fresh folder WORK/run/PAGE: sh by bash, with `apsis` and `python3`
as installed; python in one interpreter; cpp compiled against the installed library. blocks.py explains the comments before
blocks. Blocks that need a component that BUILD lacks are left out, and listed. --update writes the outputs into the pages, and the
pictures into docs/images.
"""
import argparse
import concurrent.futures
import difflib
import json
import os
import re
import shlex
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

from blocks import OPTIONAL, Block, Problem, check_rules, is_excerpt, is_same_output, read_blocks

ROOT = Path(__file__).resolve().parents[1]
PAGES = ("README.md", "CONTRIBUTING.md", "src/apsis/*/README.md", "docs/**/*.md")
LIMIT = 900  # seconds per block, with a margin for loaded machines
REPORTS = ("studies/report.py", "bench/pictures.py")  # draw pictures from results that take too long for a page

# Executes blocks from standard input in one namespace, with the output of each in a file, and answers "ok" or the traceback.
SESSION = """
import json, os, sys, traceback
requests, answers, names = os.fdopen(os.dup(0)), os.fdopen(os.dup(1), "w"), {"__name__": "__main__"}
sys.path.insert(0, "")
for line in requests:
    code, place, out = json.loads(line)
    with open(out, "wb") as file:
        os.dup2(file.fileno(), 1)
    try:
        exec(compile(code, place, "exec"), names)
        answer = "ok"
    except BaseException:
        answer = traceback.format_exc()
    sys.stdout.flush()
    print(json.dumps(answer), file=answers, flush=True)
"""

CONSUMER = """cmake_minimum_required(VERSION 3.25)
project(block LANGUAGES C CXX)
find_package(apsis REQUIRED)
add_executable(block block.cpp)
target_link_libraries(block PRIVATE apsis::apsis)
"""


class Tools:
    """An installed copy of BUILD, and the environment that finds it."""

    def __init__(self, build: Path, work: Path):
        self.work, installed, bin = work, work / "apsis", work / "bin"
        quietly("cmake", "--install", build, "--prefix", installed)
        bin.mkdir(parents=True, exist_ok=True)
        (bin / "python3").write_text('#!/bin/sh\nexec /usr/bin/python3 "$@"\n', encoding="utf-8")
        (bin / "python3").chmod(0o755)
        cache = dict(re.findall(r"^(CMAKE_C(?:XX)?_COMPILER):\w+=(.+)$", (build / "CMakeCache.txt").read_text(), re.M))
        self.environment = os.environ | {
            "PATH": f"{installed / 'bin'}:{bin}:{os.environ['PATH']}", "PYTHONPATH": str(build / "python"),
            "CMAKE_PREFIX_PATH": str(installed), "CC": cache["CMAKE_C_COMPILER"], "CXX": cache["CMAKE_CXX_COMPILER"],
            "PYTHONDONTWRITEBYTECODE": "1", "MPLBACKEND": "Agg", "LC_ALL": "C.UTF-8"}
        self.commands = ""
        self.lacking = lacking_components(build)

    def prepare_compiler(self):
        """Obtains, once, the build commands of a CMake project that uses the installed library."""
        project = self.work / "consumer"
        project.mkdir(exist_ok=True)
        (project / "CMakeLists.txt").write_text(CONSUMER, encoding="utf-8")
        (project / "block.cpp").write_text("", encoding="utf-8")
        quietly("cmake", "-G", "Ninja", "-S", project, "-B", project / "build", env=self.environment)
        self.commands = quietly("ninja", "-C", project / "build", "-t", "commands", "block")

    def compile(self, source: Path, program: Path) -> list[str]:
        """Returns a shell command that builds the program."""
        lines = self.commands.replace(str(self.work / "consumer" / "block.cpp"), shlex.quote(str(source)))
        lines = re.sub(r"CMakeFiles/block.dir/block.cpp.o(\.d)?", lambda m: shlex.quote(f"{program}.o{m[1] or ''}"), lines)
        return ["bash", "-ec", re.sub(r"-o block ", f"-o {shlex.quote(str(program))} ", lines)]


def lacking_components(build: Path) -> set[str]:
    """Returns the optional components that a build does not have."""
    package = (build / "apsisConfig.cmake").read_text(encoding="utf-8")
    return set(OPTIONAL) - set(re.search(r"^set\(apsis_built (.*)\)$", package, re.M)[1].split(";"))


def quietly(*command, **options) -> str:
    done = subprocess.run([str(word) for word in command], text=True, capture_output=True, **options)
    if done.returncode != 0:
        raise SystemExit(f"{shlex.join(map(str, command))} failed\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


class Page:
    """One page and the results of its blocks."""

    def __init__(self, path: Path, root: Path, tools: Tools):
        self.path, self.root, self.tools = path, root, tools
        self.name = str(path.relative_to(root))
        self.folder = tools.work / "run" / self.name.removesuffix(".md").replace("/", "-")
        self.text = path.read_text(encoding="utf-8")
        self.problems, self.outputs, self.session, self.printed = [], {}, None, None
        self.left_out, self.follows_one_left_out = [], False

    def run(self):
        start = time.monotonic()
        try:
            self.blocks = read_blocks(self.text)
            self.problems += check_rules(self.text, self.blocks)
            if not self.problems:
                shutil.rmtree(self.folder, ignore_errors=True)
                self.folder.mkdir(parents=True)
                for block in self.blocks:
                    self.treat(block)
        except Problem as problem:  # what comes after depends on it
            self.problems.append(problem)
        finally:
            if self.session:
                self.session.communicate()
        self.seconds = time.monotonic() - start

    def treat(self, block: Block):
        if "from" in block.marks:
            self.compare_excerpt(block)
        if block.marks.get("needs") in self.tools.lacking:
            self.left_out.append(block)
            self.follows_one_left_out = True
        elif "elsewhere" in block.marks:
            test = self.root / block.marks["elsewhere"]
            if not test.is_file() or self.name not in test.read_text(encoding="utf-8"):
                raise Problem(block.line, f"{block.marks['elsewhere']} does not run this block (no such file, or it does not "
                              f"name {self.name}); name a test that does")
        elif "file" in block.marks:
            self.write(block)
        elif "output" in block.marks:
            if not self.follows_one_left_out:
                self.compare_output(block)
        elif block.runs:
            self.follows_one_left_out = False
            out = self.folder / f".block-{block.line}.out"
            {"sh": self.run_shell, "python": self.run_python, "cpp": self.run_cpp}[block.language](block, out)
            self.printed = out.read_text(encoding="utf-8", errors="replace")

    def write(self, block: Block):
        file = (self.folder / block.marks["file"]).resolve()
        if not file.is_relative_to(self.folder.resolve()):
            raise Problem(block.line, f"{block.marks['file']} is outside (of the folder of the page); give a relative path")
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(block.text, encoding="utf-8")
        if file.suffix == ".toml":
            is_method = re.search(r"^\[(shu_osher|butcher)\]", block.text, re.M)
            # A case is loaded, set up, and stopped after its first steps.
            words = ["check", file] if is_method else ["run", file, "--wall", "0.01"]
            self.execute(block, ["apsis", *map(str, words)], self.folder / f".block-{block.line}.out", codes=(0, 130))

    def compare_excerpt(self, block: Block):
        name = block.marks["from"]
        file = next((f / name for f in (self.folder, self.root) if (f / name).is_file()), None)
        if file is None:
            raise Problem(block.line, f"there is no {name} (in the repository or in the folder of the page); correct the path")
        if not is_excerpt(block.text, file.read_text(encoding="utf-8")):
            self.problems.append(Problem(block.line, f"the block is not in {name} (it may have changed); copy it again"))

    def compare_output(self, block: Block):
        if self.printed is None:
            raise Problem(block.line, "no block before this one prints anything (outputs belong to the block before); move it")
        tolerance = float(block.marks["output"] or 1e-6)
        if not is_same_output(block.text, self.printed, tolerance):
            lines = difflib.unified_diff(block.text.splitlines(), self.printed.splitlines(), "page", "printed", lineterm="", n=1)
            self.outputs[block.line] = self.printed
            self.problems.append(Problem(block.line, "the output is another one (the program or the page has changed); look at "
                                         "it, then docs/execute.py --update\n" + indented("\n".join(list(lines)[:40]))))

    def run_shell(self, block: Block, out: Path):
        self.execute(block, ["bash", "-euo", "pipefail", "-c", block.text], out)

    def run_cpp(self, block: Block, out: Path):
        program = self.folder / f".block-{block.line}"
        source = program.with_suffix(".cpp")
        source.write_text(block.text, encoding="utf-8")
        self.execute(block, self.tools.compile(source, program), out, codes=(0,))
        self.execute(block, [str(program)], out)

    def run_python(self, block: Block, out: Path):
        if self.session is None:
            self.session = subprocess.Popen(["python3", "-c", SESSION], cwd=self.folder, env=self.tools.environment, text=True,
                                            stdin=subprocess.PIPE, stdout=subprocess.PIPE, start_new_session=True)
        print(json.dumps([block.text, f"{self.name}:{block.line}", str(out)]), file=self.session.stdin, flush=True)
        with concurrent.futures.ThreadPoolExecutor(1) as reader:
            line = reader.submit(self.session.stdout.readline)
            try:
                answer = json.loads(line.result(LIMIT) or '"the interpreter ended"')
            except concurrent.futures.TimeoutError:
                os.killpg(self.session.pid, signal.SIGKILL)
                raise Problem(block.line, f"the block takes too long (more than {LIMIT} s); take a smaller example") from None
        if answer != "ok":
            raise Problem(block.line, f"the block fails (python)\n{indented(answer)}")

    def execute(self, block: Block, command: list[str], out: Path, codes=None):
        """Runs a command in the folder of the page, its standard output in a file."""
        wanted = codes or (int(block.marks.get("exit", 0)),)
        messages = subprocess.STDOUT if "exit" in block.marks else subprocess.PIPE
        with open(out, "wb") as file:
            process = subprocess.Popen(command, cwd=self.folder, env=self.tools.environment, stdin=subprocess.DEVNULL,
                                       stdout=file, stderr=messages, start_new_session=True)
            try:
                error = (process.communicate(timeout=LIMIT)[1] or b"").decode(errors="replace")
            except subprocess.TimeoutExpired:
                os.killpg(process.pid, signal.SIGKILL)
                process.communicate()
                raise Problem(block.line, f"the block takes too long (more than {LIMIT} s); take a smaller example") from None
        if process.returncode not in wanted:
            told = out.read_text(encoding="utf-8", errors="replace")[-1500:] + error[-4000:]
            raise Problem(block.line, f"the block fails (exit code {process.returncode}, not {wanted[0]})\n{indented(told)}")

    def check_pictures(self, reports: list[str], complete: bool):
        """Checks that a picture is in docs/images, for GitHub, and, if no block was left out, drawn by a block of some page or by a
        report."""
        for name, line in self.pictures().items():
            if not (self.root / "docs" / "images" / name).is_file():
                self.problems.append(Problem(line, f"docs/images has no {name} (nothing is shown); docs/execute.py --update"))
            elif complete and not any(self.folder.parent.glob(f"*/images/{name}")) and not any(re.fullmatch(one, name) for one in reports):
                self.problems.append(Problem(line, f"nothing draws {name} (no block into images/, no report); draw it here"))

    def pictures(self) -> dict[str, int]:
        return {name: number for number, line in enumerate(self.text.splitlines(), 1)
                for name in re.findall(r"!\[[^\]]*\]\((?:\.\./|docs/)*images/([^)]+)\)", line)}

    def update(self):
        """Writes the outputs that differ into the page, and the pictures into docs/images."""
        lines = self.text.splitlines()
        for block in sorted((b for b in self.blocks if b.line in self.outputs), key=lambda b: -b.line):
            lines[block.line:block.last] = [block.indent + line for line in self.outputs[block.line].rstrip().splitlines()]
        if self.outputs:
            self.path.write_text("\n".join(lines) + "\n", encoding="utf-8")
        for name in self.pictures():
            if (self.folder / "images" / name).is_file():
                (self.root / "docs" / "images").mkdir(exist_ok=True)
                shutil.copy(self.folder / "images" / name, self.root / "docs" / "images" / name)
        mended = {*self.outputs, *self.pictures().values()}
        self.problems = [p for p in self.problems if p.line not in mended]


def indented(text: str) -> str:
    return "".join(f"    {line}\n" for line in text.strip().splitlines())


def reported_pictures(root: Path) -> list[str]:
    """Patterns of the pictures that `make figures` and the reports draw, {…} of formatted names for anything."""
    texts = [(root / report).read_text(encoding="utf-8") for report in REPORTS if (root / report).exists()]
    names = [name for text in texts for name in re.findall(r"[\w-]+(?:\{[^}]*\}[\w-]*)?\.png", text)]
    if (root / "Makefile").exists():
        recipe = re.search(r"^figures:.*\n((?:\t.*\n)+)", (root / "Makefile").read_text(encoding="utf-8"), re.M)
        names += [f"{name}.png" for name in re.findall(r"--compare ([\w-]+)", recipe[1] if recipe else "")]
    return [re.sub(r"\{[^}]*\}", r"[\\w-]+", name) for name in names]


def run_pages(paths: list[Path], root: Path, tools: Tools, jobs: int) -> list[Page]:
    pages = [Page(path, root, tools) for path in paths]
    if any(re.search(r"^\s*```cpp", page.text, re.M) for page in pages) and not tools.commands:
        tools.prepare_compiler()
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        list(pool.map(Page.run, pages))
    reports, complete = reported_pictures(root), not any(page.left_out for page in pages)
    for page in pages:
        page.check_pictures(reports, complete)
    return pages


def main(arguments=None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pages", nargs="*", type=Path, metavar="PAGE", help="all pages if none is named")
    parser.add_argument("--without", nargs="+", type=Path, default=[], metavar="PAGE", help="do not run these pages")
    parser.add_argument("--root", type=Path, default=ROOT, help="of the pages")
    parser.add_argument("--build", type=Path, default=ROOT / "build" / "release")
    parser.add_argument("--work", type=Path, default=ROOT / "build" / "docs")
    parser.add_argument("--jobs", "-j", type=int, default=os.cpu_count())
    parser.add_argument("--update", action="store_true", help="write outputs and pictures into docs")
    given = parser.parse_args(arguments)
    root = given.root.resolve()
    paths = [p.resolve() for p in given.pages] or [p for pattern in PAGES for p in sorted(root.glob(pattern))]
    omitted = [p.resolve() for p in given.without]
    unknown = [str(p) for p in omitted if p not in paths]
    if unknown:
        parser.error(f"--without names no page that would run ({', '.join(unknown)}); correct the name")
    paths = [p for p in paths if p not in omitted]
    pages = run_pages(paths, root, Tools(given.build.resolve(), given.work.resolve()), given.jobs)
    for page in pages:
        if given.update:
            page.update()
        if page.problems or page.seconds > 1:
            print(f"{page.name}: {page.seconds:.1f} s")
        for block in page.left_out:
            print(f"{page.name}:{block.line}: left out (needs the component {block.marks['needs']})")
        for problem in sorted(page.problems, key=lambda p: p.line):
            print(f"{page.name}:{problem.line}: {problem}", file=sys.stderr)
    failed = sum(bool(page.problems) for page in pages)
    print(f"{len(pages)} pages, {failed} with problems")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
