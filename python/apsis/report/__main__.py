"""python -m apsis.report: report pages. `apsis report` is the same command."""
from __future__ import annotations

import argparse
import sys

from ..plot.style import exit_code_of, printable
from .make import make_report


def make_all(folders: list[str]) -> None:
    for folder in folders:
        print(printable(str(make_report(folder))))


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="apsis report", description="Makes DIR/report.html: one page with the summary, the "
                                     "promises, pictures, case and manifest of a run, a study or a reproduction.")
    parser.add_argument("folders", nargs="+", metavar="DIR", help="a folder of results")
    folders = parser.parse_args(arguments).folders
    return exit_code_of(lambda: make_all(folders))


if __name__ == "__main__":
    sys.exit(main())
