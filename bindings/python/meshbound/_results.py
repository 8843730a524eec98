# SPDX-License-Identifier: MIT
"""What the functions of this package return. Lengths are in the unit of the mesh."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Optional, Tuple

import numpy as np

Point = Tuple[float, float, float]


@dataclass(frozen=True)
class Direction:
    """How far one mesh is from another: lower <= max over the first of the distance to the second <= upper.

    ``from_point`` on the first mesh and ``nearest_point``, its closest point on the second, realise the lower bound up
    to rounding. Where ``searched`` is False the outcome is "not_searched", the bounds are 0 and infinity, and the
    points mean nothing.
    """

    lower: float
    upper: float
    searched: bool
    outcome: str
    """"converged", "exceeds" (the tolerance), "budget" (the time limit), "precision" (of doubles) or "not_searched"."""
    from_point: Point
    from_triangle: int
    nearest_point: Point
    nearest_triangle: int


@dataclass(frozen=True)
class Distance:
    """The symmetric Hausdorff distance of two meshes, or the one-sided one where only that was asked for."""

    lower: float
    upper: float
    a_to_b: Direction
    b_to_a: Direction


@dataclass(frozen=True)
class ToleranceCheck(Distance):
    """Whether a distance is at most a tolerance; the bounds are as narrow as that needed."""

    verdict: str
    """"within" (upper <= tolerance), "exceeds" (lower > tolerance) or "undecided"."""
    tolerance: float

    def __bool__(self) -> bool:
        """True only for "within"."""
        return self.verdict == "within"


@dataclass(frozen=True)
class MeshFacts:
    """Facts about a mesh."""

    vertices: int
    triangles: int
    components: int
    closed: bool
    bbox_diagonal: float
    """Of the bounding box of the vertices that triangles use."""


@dataclass(frozen=True, eq=False)
class Level:
    """A simplified mesh, and its distance from the original (a)."""

    tolerance: float
    verdict: str
    ended_by: str
    """Which bound came first: "tolerance", "target", "rounding" or "time_limit"."""
    distance: Distance
    vertices: np.ndarray
    """(n, 3) float64"""
    triangles: np.ndarray
    """(m, 3) uint32"""
    source_vertices: np.ndarray
    """By vertex: the vertex of the original that it comes from."""
    source_triangles: np.ndarray
    """By triangle: one of the triangles of the original that it stands for."""
    turned_faces: int
    """How many triangles face the other way than their source triangle."""
    lines: np.ndarray
    """(k, 2) uint32: edges that are feature lines."""
    line_distance: Optional[Distance]
    certificate: Optional[bytes]
    """What the tool verify_certificate checks, where it was asked for."""

    def __repr__(self) -> str:
        return (
            f"Level(tolerance={self.tolerance!r}, verdict={self.verdict!r}, ended_by={self.ended_by!r}, "
            f"distance=[{self.distance.lower!r}, {self.distance.upper!r}], "
            f"{len(self.vertices)} vertices, {len(self.triangles)} triangles)"
        )


@dataclass(frozen=True, eq=False)
class Simplification:
    """The levels of a simplification, ascending by tolerance."""

    levels: Tuple[Level, ...]

    @property
    def level(self) -> Level:
        """The last one: that of the tolerance itself."""
        return self.levels[-1]


def distance_from(values: dict[str, Any]) -> Distance:
    """From what the compiled part returns."""
    return Distance(values["lower"], values["upper"], Direction(**values["a_to_b"]), Direction(**values["b_to_a"]))


def check_from(values: dict[str, Any]) -> ToleranceCheck:
    """From what the compiled part returns."""
    directions = {key: Direction(**values[key]) for key in ("a_to_b", "b_to_a")}
    return ToleranceCheck(**{**values, **directions})


def level_from(values: dict[str, Any]) -> Level:
    """From what the compiled part returns."""
    lines = values["line_distance"]
    return Level(
        **{**values, "distance": distance_from(values["distance"]), "line_distance": lines and distance_from(lines)}
    )
