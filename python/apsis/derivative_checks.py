"""Checks of complex steps during an integration. A function may be analytic at the start and not later."""
from __future__ import annotations

from typing import Callable

from .library_warnings import warn


class NotAnalytic(BaseException):
    """Ends an integration whose solution contains wrong derivatives, to begin it again with differences.

    It is not an Exception: no handler of the functions of a user stops it on its way through the compiled part."""


class ComplexStepCheck:
    """Chooses the calls at which complex steps are compared with differences, and says what follows from a difference.

    restarts    whether derivatives are a part of the solution: then it raises NotAnalytic
    place       names the time or state
    remedy      the parameter that gives derivatives

    Checks are at the call `first` and after every half as many further calls, so that their number is the logarithm of that of the calls."""

    def __init__(self, first: int, place: Callable[[], str] = str, remedy: str = "jacobian") -> None:
        self.restarts, self.checks = False, 0
        self._place, self._remedy = place, remedy
        self._calls, self._next = 0, first

    def is_due(self) -> bool:
        """Counts a call and returns whether it is to be checked."""
        self._calls += 1
        if self._calls < self._next:
            return False
        self._next += 1 + self._next // 2
        self.checks += 1
        return True

    def fail(self, wrong: bool = True) -> None:
        """Warns that derivatives are differences from now on. If the solution has `wrong` ones, raises NotAnalytic instead if it must."""
        how, example = ("are wrong", "abs, .real or np.maximum") if wrong else ("fail", "functions of real numbers alone")
        message = (f"(complex steps {how}{self._place()}, as with {example}); "
                   f"give {self._remedy}, or a collision of analytic functions")
        if wrong and self.restarts:
            warn("derivatives of collision are differences, and the integration begins again " + message)
            raise NotAnalytic
        warn("derivatives of collision are differences from here on " + message)
