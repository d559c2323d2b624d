"""python -m apsis.report: report pages. `apsis report` is the same command."""
from __future__ import annotations

import argparse
import sys

from ..plot.style import PictureError
from .make import make_report


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(prog="apsis report", description="Makes DIR/report.html: one page with the summary, the "
                                     "promises, pictures, case and manifest of a run, a study or a reproduction.")
    parser.add_argument("folders", nargs="+", metavar="DIR", help="a folder of results")
    try:
        for folder in parser.parse_args(arguments).folders:
            print(make_report(folder))
    except PictureError as problem:
        print(f"error: {problem}", file=sys.stderr)
        return problem.exit_code
    return 0


if __name__ == "__main__":
    sys.exit(main())
