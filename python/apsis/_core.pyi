from typing import Any, Callable, Optional, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

class Method:
    name: str
    title: str
    citation: str
    origin: str
    purpose: str
    kind: str
    stages: int
    P: Array
    W: Array
    D: Array
    ddot: Array
    r: float
    A_hat: Array
    A: Array
    A_dot: Array
    _exact: dict[str, Any]
    _toml: str
    def _certify(self) -> dict[str, Any]: ...

def find_method(name: str) -> Method: ...
def parse_method(text: str, file: str) -> Method: ...
def method_names() -> list[str]: ...
def conditions(A_hat: list[list[str]], A: list[list[str]], A_dot: list[list[str]],
               order: int) -> list[tuple[str, int, float, float]]: ...
def integrate(transport: Callable[..., Any], moments: Callable[..., Any], equilibrium: Callable[..., Any],
              rate: Callable[..., float], forward_euler_step: Optional[Callable[..., float]],
              admissible: Optional[Callable[..., bool]], epsilon: float, u0: ArrayLike, t: Sequence[float], method: Method,
              dt: Optional[float], safety: float, graded: bool, tolerance: Optional[float]) -> tuple[Array, Array, int, int]: ...
def run(text: Optional[str], name: str, overrides: list[str], out: Optional[str], restart: Optional[str],
        wall: Optional[float], threads: Optional[int], progress: Optional[Callable[..., Any]]) -> dict[str, Any]: ...
def case_names() -> list[str]: ...
def read_case(name: str) -> str: ...
def model_names() -> list[str]: ...
def version() -> str: ...
