# SPDX-License-Identifier: MIT
from typing import Any, Callable, Optional

import numpy as np

__version__: str

class Error(RuntimeError): ...
class InvalidInput(Error, ValueError): ...
class Cancelled(Error): ...

class Request:
    def __init__(
        self,
        error_bound: Optional[float] = None,
        one_sided: bool = False,
        threads: int = 0,
        time_limit: Optional[float] = None,
        progress: Optional[Callable[[float], Optional[bool]]] = None,
    ) -> None: ...

class LevelChecker:
    def __init__(self, vertices: np.ndarray, triangles: np.ndarray, threads: int) -> None: ...
    def check(
        self, vertices: np.ndarray, triangles: np.ndarray, tolerance: float, request: Request
    ) -> dict[str, Any]: ...
    def measure(self, vertices: np.ndarray, triangles: np.ndarray, request: Request) -> dict[str, Any]: ...

def describe(vertices: np.ndarray, triangles: np.ndarray) -> dict[str, Any]: ...
def measure(
    vertices_a: np.ndarray,
    triangles_a: np.ndarray,
    vertices_b: np.ndarray,
    triangles_b: np.ndarray,
    request: Request,
) -> dict[str, Any]: ...
def check(
    vertices_a: np.ndarray,
    triangles_a: np.ndarray,
    vertices_b: np.ndarray,
    triangles_b: np.ndarray,
    tolerance: float,
    request: Request,
) -> dict[str, Any]: ...
def certificate(
    vertices_a: np.ndarray,
    triangles_a: np.ndarray,
    vertices_b: np.ndarray,
    triangles_b: np.ndarray,
    tolerance: float,
    request: Request,
) -> bytes: ...
def simplify(
    vertices: np.ndarray,
    triangles: np.ndarray,
    options: dict[str, Any],
    progress: Optional[Callable[[float], Optional[bool]]],
) -> list[dict[str, Any]]: ...
