#!/usr/bin/env python3
"""check_layers.py [ROOT]: includes of a room above the including one, and of a client by another.

The rooms, and what each may include, are those of the apsis_room() calls in src/apsis/CMakeLists.txt: an explicit list, which
grants nothing that a listed room may include. Above the library
lie paper/, app/, python/bindings/, tests/, bench/ and examples/, which it may not include. The README of a room names the
rooms that its files include. The clients paper/, validation/ and bench/ neither include nor link each other. Prints one line for each violation; exit code 1 if there are any.
"""
import re
import sys
from pathlib import Path

CLIENTS = ("paper", "validation", "bench")
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^">]+)[">]', re.MULTILINE)


def read_rooms(cmake: str) -> dict[str, set[str]]:
    """For each room the rooms that it may include: those of its DEPENDS, and none that these may include."""
    rooms: dict[str, set[str]] = {}
    for name, arguments in re.findall(r"apsis_room\((\w+)([^)]*)\)", cmake):
        words = arguments.split()
        rooms[name] = set()
        if "DEPENDS" in words:
            for word in words[words.index("DEPENDS") + 1:]:
                if word.isupper():
                    break
                rooms[name].add(word)
    return rooms


def room_of(include: str) -> str | None:
    parts = include.split("/")
    return parts[1] if parts[0] == "apsis" and len(parts) > 2 else None


def violations(root: Path) -> list[str]:
    library = root / "src/apsis"
    rooms = read_rooms((library / "CMakeLists.txt").read_text(encoding="utf-8"))
    found = [f"src/apsis/{folder.name}: is no room of src/apsis/CMakeLists.txt"
             for folder in sorted(library.iterdir()) if folder.is_dir() and folder.name not in rooms]
    order = list(rooms)
    for room, allowed in rooms.items():
        if late := sorted(allowed - set(order[:order.index(room)])):
            found.append(f"src/apsis/CMakeLists.txt: {room} may include {late} (not declared before it)")
        readme = library / room / "README.md"
        named = set(re.findall(r"`(\w+)`", " ".join(readme.read_text(encoding="utf-8").split()).rpartition("Includes")[2].partition(".")[0]))
        included = set()
        for file in sorted((library / room).rglob("*.[ch]pp")):
            text = file.read_text(encoding="utf-8")
            for match in INCLUDE.finditer(text):
                line = text.count("\n", 0, match.start()) + 1
                other = room_of(match[1])
                included |= {other} & allowed
                if other is not None and other != room and other not in allowed:
                    found.append(f"{file.relative_to(root)}:{line}: {room} includes {other} ({match[1]})")
                elif (root / match[1]).exists() and not (file.parent / match[1]).exists():
                    found.append(f"{file.relative_to(root)}:{line}: {room} includes {match[1]} (above the library)")
        if not allowed <= included | {room}:
            found.append(f"src/apsis/CMakeLists.txt: {room} may include {sorted(allowed - included)} (its files do not)")
        if named != included:
            found.append(f"src/apsis/{room}/README.md: states that it includes {sorted(named)} (its files include {sorted(included)})")
    return found + [problem for client in CLIENTS for problem in violations_of_client(root, client)]


def violations_of_client(root: Path, client: str) -> list[str]:
    """Includes of another client, written from the root or relative to the file, and links to its library."""
    found = []
    for file in sorted((root / client).rglob("*.[ch]pp")):
        text = file.read_text(encoding="utf-8")
        for match in INCLUDE.finditer(text):
            places = [place for place in (file.parent / match[1], root / match[1]) if place.exists()]
            other = places[0].resolve().relative_to(root.resolve()).parts[0] if places else match[1].split("/")[0]
            if other in CLIENTS and other != client:
                line = text.count("\n", 0, match.start()) + 1
                found.append(f"{file.relative_to(root)}:{line}: {client} includes {other} ({match[1]})")
    cmake = root / client / "CMakeLists.txt"
    text = cmake.read_text(encoding="utf-8") if cmake.exists() else ""
    return found + [f"{client}/CMakeLists.txt: {client} links {other}"
                    for other in CLIENTS if other != client and re.search(rf"\bapsis_{other}\b", text)]


if __name__ == "__main__":
    problems = violations(Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).resolve().parents[1]))
    print("\n".join(problems), end="\n" if problems else "")
    sys.exit(1 if problems else 0)
