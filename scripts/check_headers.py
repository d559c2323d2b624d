#!/usr/bin/env python3
"""check_headers.py BUILD [FOLDER ...] [--jobs N]: headers that do not compile alone.

Each header of the folders (src/apsis, app, paper and validation if none is given) is compiled as the only include of a file, twice, by the
compiler and flags that BUILD/compile_commands.json has for the nearest source: of the same room, or for all else of the
program. Precompiled headers are left out, since they would hide what is missing. So are headers of rooms and of folders with_mpi/ that
BUILD does not have, because their libraries may not be installed. Prints what the compiler says of each; exit code 1 if there are any.
"""
import argparse
import concurrent.futures
import json
import os
import re
import shlex
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def flags_of(command: str) -> list[str]:
    """Returns compiler and flags without the launcher, the source and the output."""
    words = shlex.split(command)
    if Path(words[0]).name == "ccache":  # useless for a compilation without output
        words = words[1:]
    flags, skip = words[:1], 0
    for k, word in enumerate(words[1:], 1):
        if skip:
            skip -= 1
        elif word in ("-o", "-MF", "-MT", "-MQ", "-include"):
            skip = 1
        elif word == "-Xclang" and any("pch" in w for w in words[k + 1:k + 4]):
            skip = 1
        elif word not in ("-c", "-MD", "-MMD", "-Winvalid-pch") and not word.endswith((".cpp", ".cxx")) and not word.startswith("-O"):
            flags.append(word)
    return flags


def commands_of(build: Path) -> dict[Path, str]:
    """Returns the command of every source, which a unity build gives for the file that includes it."""
    commands = {}
    for entry in json.loads((build / "compile_commands.json").read_text(encoding="utf-8")):
        file = Path(entry["file"])
        unity = file.parent.name == "Unity" and file.is_file()
        included = re.findall(r'^#include "(.+)"', file.read_text(encoding="utf-8"), re.M) if unity else []
        commands |= {Path(source): entry["command"] for source in included or [file]}
    return commands


def nearest(header: Path, sources: list[Path]) -> Path:
    """Returns a source of the same folder or room, with MPI for a header with MPI: other sources may lack its include path."""
    return max(sources, key=lambda source: (len(os.path.commonpath([header, source])),
                                            ("with_mpi" in source.parts) == ("with_mpi" in header.parts)))


def is_built(header: Path, sources: list[Path]) -> bool:
    """Returns false for headers of a room, or of a folder with_mpi/ of a room, that has no source in the build."""
    library = ROOT / "src/apsis"
    if not header.is_relative_to(library) or header.parent == library:
        return True
    room = library / header.relative_to(library).parts[0]
    of_room = [source for source in sources if source.is_relative_to(room)]
    return bool(of_room) and ("with_mpi" not in header.parts or any("with_mpi" in source.parts for source in of_room))


def own_sources(commands: dict[Path, str], build: Path) -> list[Path]:
    """Returns the sources that the build did not generate."""
    return [file for file in commands if file.is_relative_to(ROOT) and not file.is_relative_to(build)]


def compilation(header: Path, flags: list[str]) -> tuple[list[str], str]:
    """Returns the command that compiles a header alone, twice, and its standard input."""
    return [*flags, "-fsyntax-only", "-x", "c++", "-"], f'#include "{header}"\n' * 2


def problem_of(header: Path, flags: list[str]) -> str:
    command, text = compilation(header, flags)
    done = subprocess.run(command, input=text, capture_output=True, text=True)
    return "" if done.returncode == 0 else f"{header}: does not compile alone (see below); include what it uses\n{done.stderr}"


def problems(build: Path, folders: list[Path], jobs: int) -> tuple[int, list[str]]:
    """Returns the number of headers and their problems."""
    commands = commands_of(build)
    sources = own_sources(commands, build)
    headers = sorted(header for folder in folders for header in folder.rglob("*.hpp") if is_built(header, sources))
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        found = pool.map(lambda header: problem_of(header, flags_of(commands[nearest(header, sources)])), headers)
        return len(headers), [text for text in found if text]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=Path)
    parser.add_argument("folders", type=Path, nargs="*", default=[ROOT / "src/apsis", ROOT / "app", ROOT / "paper", ROOT / "validation"])
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)))
    given = parser.parse_args()
    number, found = problems(given.build.resolve(), [folder.resolve() for folder in given.folders], given.jobs)
    print(*found, f"{number} headers, {len(found)} of them do not compile alone", sep="\n")
    return 1 if found or number == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
