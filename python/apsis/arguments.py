"""Argument checks; messages name the argument."""
from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .errors import InputError


def type_of(value: Any) -> str:
    """Returns the type of a value with its article for messages: "an int", "a str", "an ndarray"; "None" for None."""
    if value is None:
        return "None"
    name = type(value).__name__
    return f"{'an' if name[:1].lower() in 'aeio' or name.startswith('ndarray') else 'a'} {name}"


def number(name: str, value: Any, positive: bool = False) -> float:
    """Returns `value` as a float. Raises InputError unless it is a real number and, if `positive`, finite and above 0."""
    if isinstance(value, (str, bytes, bool, np.bool_)) or value is None:
        raise InputError(f"{name} is {value!r} (a real number is needed); give one")
    try:
        found = float(value)
    except (TypeError, ValueError) as problem:
        raise InputError(f"{name} is a value of type {type(value).__name__} (a real number is needed); give one") from problem
    if positive and not (found > 0.0 and math.isfinite(found)):
        raise InputError(f"{name} = {found:g} is not a positive number; give {name} > 0")
    return found


def finite(name: str, value: Any, lowest: float = -math.inf, highest: float = math.inf) -> float:
    """Returns `value` as a finite float in an interval. Raises InputError if it is not."""
    found = number(name, value)
    if not math.isfinite(found):
        raise InputError(f"{name} = {found:g} is not finite; give a finite number")
    if found < lowest:
        raise InputError(f"{name} = {found:g} is below {lowest:g}; give {name} ≥ {lowest:g}")
    if found > highest:
        raise InputError(f"{name} = {found:g} is above {highest:g}; give {name} ≤ {highest:g}")
    return found


def text(name: str, value: Any) -> str:
    """Returns `value` as a str. Raises InputError unless it is one."""
    if not isinstance(value, str):
        raise InputError(f"{name} is {type_of(value)} (a name is needed); give one")
    return value


def whole_number(name: str, value: Any) -> int:
    """Returns `value` as an int. Raises InputError unless it is an integer."""
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, (int, np.integer)):
        raise InputError(f"{name} is {value!r} (an integer is needed); give one")
    if abs(int(value)) > 2**31 - 1:
        raise InputError(f"{name} = {value} is out of range; give a smaller number")
    return int(value)


def real_array(name: str, value: Any) -> NDArray[np.float64]:
    """Returns `value` as an array of floats. Raises InputError if it has text, None, complex numbers or rows of different length."""
    try:
        found = np.asarray(value)
        if found.dtype.kind == "O":
            found = np.array([float(x) for x in found.ravel()]).reshape(found.shape)
    except (TypeError, ValueError) as problem:
        raise InputError(f"{name} is not an array of real numbers ({problem}); give real numbers") from problem
    if found.dtype.kind not in "biuf":
        raise InputError(f"{name} is an array of type {found.dtype} (real numbers are needed); give real numbers")
    return np.ascontiguousarray(found, dtype=np.float64).reshape(found.shape)
