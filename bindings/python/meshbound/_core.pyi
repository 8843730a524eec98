# SPDX-License-Identifier: MIT
# Options are the keyword arguments of the functions in _api.py by name; one that is left out has its default.
from typing import Any

import numpy as np

__version__: str

class Error(RuntimeError): ...
class InvalidInput(Error, ValueError): ...
class Cancelled(Error): ...

class LevelChecker:
    def __init__(self, vertices: np.ndarray, triangles: np.ndarray, options: dict[str, Any], /) -> None: ...
    def check(
        self, vertices: np.ndarray, triangles: np.ndarray, tolerance: float, options: dict[str, Any], /
    ) -> dict[str, Any]: ...
    def measure(self, vertices: np.ndarray, triangles: np.ndarray, options: dict[str, Any], /) -> dict[str, Any]: ...

def describe(vertices: np.ndarray, triangles: np.ndarray, /) -> dict[str, Any]: ...
def measure(
    vertices_a: np.ndarray,
    triangles_a: np.ndarray,
    vertices_b: np.ndarray,
    triangles_b: np.ndarray,
    options: dict[str, Any],
    /,
) -> dict[str, Any]: ...
def check(
    vertices_a: np.ndarray,
    triangles_a: np.ndarray,
    vertices_b: np.ndarray,
    triangles_b: np.ndarray,
    tolerance: float,
    options: dict[str, Any],
    /,
) -> dict[str, Any]: ...
def certificate(
    vertices_a: np.ndarray,
    triangles_a: np.ndarray,
    vertices_b: np.ndarray,
    triangles_b: np.ndarray,
    tolerance: float,
    options: dict[str, Any],
    /,
) -> bytes: ...
def simplify(
    vertices: np.ndarray, triangles: np.ndarray, options: dict[str, Any], /
) -> list[dict[str, Any]]: ...
