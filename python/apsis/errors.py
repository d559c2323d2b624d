"""What can go wrong. Messages are those of the library: problem (why) suggestion."""


class Error(Exception):
    """Base of all errors that Apsis raises on purpose."""


class InputError(Error, ValueError):
    """A case, method, key or argument that cannot be used."""


class NumericalError(Error, ArithmeticError):
    """The computation cannot go on, or a promise was broken. What is not known is -1 or NaN."""

    step: int = -1
    t: float = float("nan")
    cell: int = -1
    value: float = float("nan")


class FileError(Error, OSError):
    """A file or folder that cannot be read or written."""


class ClaimError(Error):
    """A method does not have the properties that its file claims."""
