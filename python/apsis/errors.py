"""Exceptions. Messages have the form of the library: problem (reason); suggestion."""


class Error(Exception):
    """Base class of all exceptions of Apsis. exit_code is the exit code of the program for such an error."""

    exit_code: int = 1


class InputError(Error, ValueError):
    """A case, method, key or argument that cannot be used."""

    exit_code = 2


class NumericalError(Error, ArithmeticError):
    """The computation cannot continue, or a promise was broken. Unknown attributes are -1 or NaN."""

    exit_code = 3
    step: int = -1
    t: float = float("nan")
    cell: int = -1
    value: float = float("nan")


class FileError(Error, OSError):
    """A file or folder that cannot be read or written."""

    exit_code = 4


class ApsisWarning(UserWarning):
    """A likely mistake, such as a step that is unfit for a method; the computation continues. Base class of all warnings of Apsis."""


class CostWarning(ApsisWarning):
    """A computation takes far longer than another one with the same result."""


class ClaimError(Error):
    """A method lacks a property that its file claims."""

    exit_code = 5
