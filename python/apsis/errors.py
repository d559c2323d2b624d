"""What can go wrong. Messages are those of the library: problem (why) suggestion."""


class Error(Exception):
    """Base of all errors that Apsis raises on purpose. exit_code is that of the program."""

    exit_code: int = 1


class InputError(Error, ValueError):
    """A case, method, key or argument that cannot be used."""

    exit_code = 2


class NumericalError(Error, ArithmeticError):
    """The computation cannot go on, or a promise was broken. What is not known is -1 or NaN."""

    exit_code = 3
    step: int = -1
    t: float = float("nan")
    cell: int = -1
    value: float = float("nan")


class FileError(Error, OSError):
    """A file or folder that cannot be read or written."""

    exit_code = 4


class ClaimError(Error):
    """A method does not have the properties that its file claims."""

    exit_code = 5
