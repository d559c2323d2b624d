#!/usr/bin/env python3
"""join_sources.py BUILD: writes the sources of every unity file of a build into one file, and a list of compile commands for all.

The Clang analyzer follows only functions of the main file. With joined sources it reads the headers of a room once. #line directives
keep file and line in messages. The files and the list are in BUILD/joined.
"""
import json
import re
import sys
from pathlib import Path


def joined(sources: list[str]) -> str:
    return "".join(f'#line 1 "{source}"\n{Path(source).read_text(encoding="utf-8")}\n' for source in sources)


def main() -> int:
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    build = Path(sys.argv[1]).resolve()
    folder = build / "joined"
    folder.mkdir(exist_ok=True)
    entries = json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
    for entry in entries:
        unity = Path(entry["file"])
        if unity.parent.name != "Unity":
            continue
        room = unity.parent.parent.name.removesuffix(".dir")
        file = folder / unity.parents[3].relative_to(build) / f"{room}_{unity.stem}.cpp"
        file.parent.mkdir(parents=True, exist_ok=True)
        sources = re.findall(r'^#include "(.+)"', unity.read_text(encoding="utf-8"), re.M)
        file.write_text(joined(sources), encoding="utf-8")
        # Sources include headers of their own folder by name.
        folders = " ".join(f"-I{where}" for where in sorted({str(Path(source).parent) for source in sources}))
        entry["command"] = entry["command"].replace(str(unity), f"{folders} {file}")
        entry["file"] = str(file)
    (folder / "compile_commands.json").write_text(json.dumps(entries, indent=1), encoding="utf-8")
    return 0


if __name__ == "__main__":
    sys.exit(main())
