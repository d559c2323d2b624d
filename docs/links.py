#!/usr/bin/python3
"""Asks for every address outside that the built site links to: docs/links.py [HTML folder]. Needs a network."""
import concurrent.futures
import re
import sys
import urllib.error
import urllib.request
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def problem_of(address: str) -> str:
    """Why the address cannot be had; "" if it can. A server that wants people only (403, 429) is there."""
    request = urllib.request.Request(address, headers={"User-Agent": "Mozilla/5.0 (link check)"})
    try:
        with urllib.request.urlopen(request, timeout=20):
            return ""
    except urllib.error.HTTPError as answer:
        return "" if answer.code in (403, 429) else str(answer)
    except (OSError, ValueError) as problem:
        return str(problem)


def main(folder: Path) -> int:
    pages: dict[str, str] = {}
    for page in sorted(folder.rglob("*.html")):
        for address in re.findall(r'href="(https?://[^"#]+)', page.read_text(encoding="utf-8")):
            pages.setdefault(address.replace("&amp;", "&"), page.name)
    with concurrent.futures.ThreadPoolExecutor(8) as pool:
        problems = {address: why for address, why in zip(pages, pool.map(problem_of, pages)) if why}
    for address, why in problems.items():
        print(f"{pages[address]}: {address} ({why}); correct the link", file=sys.stderr)
    print(f"{len(pages)} addresses, {len(problems)} with problems")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "build" / "docs" / "html"))
