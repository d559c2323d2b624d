"""Warnings of the compiled part, and of the package, as warnings of Python at the line of the caller."""
from __future__ import annotations

import os
import sys
import warnings
from types import TracebackType
from typing import Callable

from . import _core
from .errors import ApsisWarning

_PACKAGE = os.path.dirname(os.path.abspath(__file__)) + os.sep


def warn(message: str, category: type[ApsisWarning] = ApsisWarning) -> None:
    """Warns at the line outside of the package that called it. Raises the warning if a filter of Python says so."""
    level, frame = 1, sys._getframe()
    while frame.f_back is not None and os.path.abspath(frame.f_code.co_filename).startswith(_PACKAGE):
        level, frame = level + 1, frame.f_back
    warnings.warn(message, category, stacklevel=level)


class LibraryWarnings:
    """Passes warnings of the compiled part on to Python at the end of a `with` block, and by pass_on() inside it.

    An exception that leaves the block is not replaced by a warning that a filter turns into an exception. `worded` changes messages."""

    def __init__(self, worded: Callable[[str], str] = str) -> None:
        self._worded = worded

    def pass_on(self) -> None:
        """Issues the warnings since the last call."""
        for message in _core.take_warnings():
            warn(self._worded(message))

    def __enter__(self) -> LibraryWarnings:
        return self

    def __exit__(self, kind: type[BaseException] | None, problem: BaseException | None, trace: TracebackType | None) -> None:
        try:
            self.pass_on()
        except Warning:
            if kind is None:
                raise
