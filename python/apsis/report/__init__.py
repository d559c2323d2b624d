"""Report pages: a run, a study or a reproduction as one HTML file that opens offline.

    python -m apsis.report DIR       writes DIR/report.html and DIR/pictures

`apsis report DIR` is the same.
"""
from .make import make_report

__all__ = ["make_report"]
