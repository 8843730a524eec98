# SPDX-License-Identifier: MIT
"""Certified Hausdorff distances between triangle meshes, and simplification with a proven bound.

For an original A, a simplified mesh M and their symmetric Hausdorff distance H,

    lower <= H(A, M) <= upper <= tolerance

holds in real arithmetic: the rounding errors of the computation are included.

A mesh is a pair of arrays, ``(vertices, triangles)``, or an object of trimesh, pyvista, Open3D or meshio, or anything
of this package that has vertices and triangles. Lengths are in the unit of the mesh; where a tolerance or an error
bound is asked for, a text such as ``"0.1%"`` is a percentage of the original's bounding-box diagonal.

    >>> import meshbound
    >>> level = meshbound.simplify((vertices, triangles), "0.1%").level
    >>> level.distance.upper <= level.tolerance
    True
"""

from ._api import (
    LevelChecker,
    build_certificate,
    check_tolerance,
    describe,
    hausdorff_distance,
    simplify,
)
from ._core import Cancelled, Error, InvalidInput, __version__
from ._results import Direction, Distance, Level, MeshFacts, Simplification, ToleranceCheck

__all__ = [
    "Cancelled",
    "Direction",
    "Distance",
    "Error",
    "InvalidInput",
    "Level",
    "LevelChecker",
    "MeshFacts",
    "Simplification",
    "ToleranceCheck",
    "__version__",
    "build_certificate",
    "check_tolerance",
    "describe",
    "hausdorff_distance",
    "simplify",
]
