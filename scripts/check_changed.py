#!/usr/bin/env python3
"""check_changed.py BUILD [--since COMMIT] [--until TIME] [--jobs N]: the checks of clang for the files that changed.

Four jobs look at the files that differ from COMMIT:

  format   clang-format-19 would change no file
  headers  each header compiles alone, twice, with the warnings of the build
  clang    each source compiles with clang without warnings
  tidy     clang-tidy-19 finds nothing in a source

BUILD is a folder that clang-19 configured and whose generated files exist (`make changed` makes one). It is needed by the last three
jobs. Without COMMIT it is the newest commit that HEAD shares with origin/main, or the one before HEAD if that is HEAD itself. After
TIME, in seconds of `date +%s`, no further file is checked, and the jobs state how many are left. Exit code 1 if there is a problem, 2 if a tool or a folder
is missing.
"""
import argparse
import concurrent.futures
import os
import shutil
import subprocess
import sys
import time
from pathlib import Path

import check_headers

ROOT = check_headers.ROOT
SOURCES = ("src", "app", "paper", "validation", "python")  # in which `make tidy` looks
FORMATTED = (*SOURCES, "tests", "bench", "examples")  # in which `make format` looks
TOOLS = ("clang-format-19", "clang-tidy-19", "clang++-19")


def missing_tools() -> list[str]:
    return [tool for tool in TOOLS if not shutil.which(tool)]


def git(*words: str) -> str:
    """Returns the output of git, empty if it fails."""
    return subprocess.run(["git", "-C", ROOT, *words], text=True, capture_output=True).stdout.strip()


def default_base() -> str:
    """Returns the commit whose files are known to be good."""
    head, shared = git("rev-parse", "HEAD"), git("merge-base", "HEAD", "origin/main")
    return shared if shared and shared != head else git("rev-parse", "--verify", "--quiet", "HEAD~1")


def changed(base: str) -> list[Path]:
    """Returns the files that exist and differ from a commit, those of no commit too."""
    names = git("diff", "--name-only", "--diff-filter=d", base) + "\n" + git("ls-files", "--others", "--exclude-standard")
    return sorted({ROOT / name for name in names.splitlines() if name})


def within(files: list[Path], folders: tuple[str, ...], *suffixes: str) -> list[Path]:
    return [file for file in files if file.relative_to(ROOT).parts[0] in folders and file.suffix in suffixes]


class Jobs:
    """Runs jobs until a time. `problems` has the output of those that failed."""

    def __init__(self, build: Path, end: float, jobs: int):
        self.build, self.end, self.jobs, self.problems = build, end, jobs, []
        self.commands = check_headers.commands_of(build)
        self.sources = check_headers.own_sources(self.commands, build)

    def output_of(self, command: list, text: str = "") -> str | None:
        """Returns what a command prints, empty if it finds nothing, or None if the time is over."""
        try:
            done = subprocess.run(command, input=text, text=True, capture_output=True, timeout=max(1.0, self.end - time.time()))
        except subprocess.TimeoutExpired:
            return None
        return "" if done.returncode == 0 else done.stdout + done.stderr

    def run(self, name: str, files: list[Path], check) -> None:
        """Applies a check, which returns as output_of does, to every file until the end."""
        with concurrent.futures.ThreadPoolExecutor(self.jobs) as pool:
            found = list(pool.map(lambda file: check(file) if time.time() < self.end else None, files))
        checked = [text for text in found if text is not None]
        self.problems += [text for text in checked if text]
        late = f"; the time was over for {len(files) - len(checked)}" if len(checked) < len(files) else ""
        print(f"{name}: {len(checked)} of {len(files)} files, {sum(map(bool, checked))} with problems{late}", flush=True)

    def format(self, file: Path) -> str | None:
        return self.output_of(["clang-format-19", "--dry-run", "--Werror", file])

    def header(self, file: Path) -> str | None:
        source = check_headers.nearest(file, self.sources)
        return self.output_of(*check_headers.compilation(file, check_headers.flags_of(self.commands[source])))

    def clang(self, file: Path) -> str | None:
        return self.output_of([*check_headers.flags_of(self.commands[file]), "-fsyntax-only", file])

    def tidy(self, file: Path) -> str | None:
        flags = check_headers.flags_of(self.commands[file])
        return self.output_of(["clang-tidy-19", "-quiet", "--warnings-as-errors=*", file, "--", *flags[1:]])


def check(jobs: Jobs, files: list[Path]) -> None:
    sources = [file for file in within(files, SOURCES, ".cpp") if file in jobs.commands]
    headers = [file for file in within(files, SOURCES, ".hpp") if check_headers.is_built(file, jobs.sources)]
    jobs.run("format", within(files, FORMATTED, ".cpp", ".hpp", ".c", ".h"), jobs.format)
    jobs.run("headers", headers, jobs.header)
    jobs.run("clang", sources, jobs.clang)
    jobs.run("tidy", sources, jobs.tidy)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=Path)
    parser.add_argument("--since", default="", metavar="COMMIT")
    parser.add_argument("--until", type=float, default=time.time() + 86400.0, metavar="TIME")
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)))
    given = parser.parse_args()
    if missing := missing_tools():
        print(f"check_changed.py: {', '.join(missing)} missing (not installed); run scripts/install-packages.sh ci", file=sys.stderr)
        return 2
    if not (given.build / "compile_commands.json").is_file():
        print(f"check_changed.py: no {given.build}/compile_commands.json (not configured); run make changed", file=sys.stderr)
        return 2
    base = git("rev-parse", "--verify", "--quiet", f"{given.since}^{{commit}}") if given.since else default_base()
    if given.since and not base:
        print(f"check_changed.py: no commit '{given.since}' (unknown to git); give another by --since", file=sys.stderr)
        return 2
    if not base:
        print("no earlier commit: no file has changed")
        return 0
    jobs = Jobs(given.build.resolve(), given.until, given.jobs)
    print(f"files that differ from {base[:12]}:")
    check(jobs, changed(base))
    print(*jobs.problems, sep="\n")
    return 1 if jobs.problems else 0


if __name__ == "__main__":
    sys.exit(main())
