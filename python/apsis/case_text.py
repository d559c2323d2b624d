"""Cases given as mappings: their text for the compiled part, and the keys in its messages."""
from __future__ import annotations

import json
import os
import re
from bisect import bisect_right
from collections.abc import Mapping
from decimal import Decimal
from numbers import Integral, Real
from typing import Any, Union

import numpy as np

from .arguments import type_of
from .errors import InputError

Key = Union[str, int]
_BARE = re.compile(r"[A-Za-z0-9_-]+(\.[A-Za-z0-9_-]+)*")


class CaseText:
    """The text of a case file with the keys and values of a mapping.

    text    TOML; its first line is empty, because messages about the whole case name its beginning

    Raises InputError for keys and values that a case cannot have."""

    def __init__(self, case: Mapping[str, Any]) -> None:
        self._line, self._column, self._pieces = 1, 1, list[str]()
        self._places: list[tuple[int, int]] = [(1, 1)]
        self._paths: list[tuple[Key, ...]] = [()]
        self._write("\n")
        for table in (False, True):  # keys without a table come first
            for key, value in case.items():
                if isinstance(value, Mapping) == table:
                    self._add_table(key, value) if table else self._add_entry((), key, value, "\n")
        self.text = "".join(self._pieces)

    def with_keys(self, message: str) -> str:
        """Returns a message of the compiled part with keys instead of lines and columns, and with words of Python."""
        def keys(place: re.Match[str]) -> str:
            at = bisect_right(self._places, (int(place[1]), int(place[2] or 1))) - 1
            return f"{_shown(self._paths[at])}: "
        message = re.sub(r"\bcase:(\d+)(?::(\d+))?: ", keys, message)
        return re.sub(r"write \[[\w.]+\]", "give a dict", re.sub(r"write \[\[[\w.]+\]\]", "give a list of dicts", message))

    def _add_table(self, key: Any, table: Mapping[Any, Any]) -> None:
        self._note((key,))
        self._write(f"[{_key((), key)}]\n")
        for name, value in table.items():
            self._add_entry((key,), name, value, "\n")

    def _add_entry(self, path: tuple[Key, ...], key: Any, value: Any, end: str) -> None:
        text = _key(path, key)
        self._note((*path, key))
        self._write(f"{text} = ")
        self._add_value((*path, key), value)
        self._write(end)

    def _add_value(self, path: tuple[Key, ...], value: Any) -> None:
        self._note(path)
        value = _plain(path, value)
        if isinstance(value, Mapping):
            self._write("{")
            for k, (name, one) in enumerate(value.items()):
                self._write(", " if k else "")
                self._add_entry(path, name, one, "")
            self._write("}")
        elif isinstance(value, list):
            self._write("[")
            for k, one in enumerate(value):
                self._write(", " if k else "")
                self._add_value((*path, k), one)
            self._write("]")
        else:
            self._write(_scalar(path, value))

    def _note(self, path: tuple[Key, ...]) -> None:
        self._places.append((self._line, self._column))
        self._paths.append(path)

    def _write(self, piece: str) -> None:
        self._pieces.append(piece)
        self._line, self._column = (self._line + 1, 1) if piece.endswith("\n") else (self._line, self._column + len(piece))


def to_toml(case: Mapping[str, Any]) -> str:
    """Returns the text of a case file. Raises InputError as CaseText does."""
    return CaseText(case).text


def _shown(path: tuple[Key, ...]) -> str:
    return "case" + "".join(f"[{json.dumps(key, ensure_ascii=False)}]" for key in path)


def _key(path: tuple[Key, ...], key: Any) -> str:
    if not isinstance(key, str):
        raise InputError(f"{_shown(path)} has the key {key!r}, {type_of(key)} (keys of a case are text); give a name")
    return key if _BARE.fullmatch(key) else _quoted((*path, key), key)


def _quoted(path: tuple[Key, ...], text: str) -> str:
    try:
        text.encode()
    except UnicodeEncodeError as problem:
        raise InputError(f"{_shown(path)} is text that UTF-8 cannot encode ({problem.reason}); change it") from None
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _plain(path: tuple[Key, ...], value: Any) -> Any:
    """Returns arrays, tuples and ranges as lists, arrays without axes as their number, other values as they are."""
    if hasattr(value, "__array__") and not isinstance(value, np.generic):
        array = np.asarray(value)
        if array.dtype.kind not in "biufUO":
            raise InputError(f"{_shown(path)} is an array of type {array.dtype} (a case has real numbers and text); give those")
        value = array.tolist()
    return list(value) if isinstance(value, (tuple, range)) else value


def _scalar(path: tuple[Key, ...], value: Any) -> str:
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, Integral) and abs(int(value)) < 2**63:
        return str(int(value))
    if isinstance(value, (Real, Decimal)):
        return repr(float(value))
    if isinstance(value, os.PathLike):
        value = os.fspath(value)
    if isinstance(value, str):
        return _quoted(path, value)
    raise InputError(f"{_shown(path)} is {_description(value)} (a case has numbers, text, lists and dicts); {_remedy(path, value)}")


def _description(value: Any) -> str:
    if callable(value):
        return f"a function, '{getattr(value, '__name__', type(value).__name__)}'"
    return type_of(value)


def _remedy(path: tuple[Key, ...], value: Any) -> str:
    if value is None:
        return "leave the key out for its default"
    if callable(value):
        return ("give functions in the argument initial of apsis.run" if path[0] == "initial" else
                "write a formula as text, such as \"1e-3*(1 + x^2)\"")
    return "give one of these"
