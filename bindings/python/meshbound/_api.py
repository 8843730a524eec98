# SPDX-License-Identifier: MIT
"""The functions of this package."""

from __future__ import annotations

import threading
from contextlib import contextmanager
from typing import Any, Callable, Iterable, Iterator, Optional, Union

from . import _core
from ._meshes import Arrays, arrays_of
from ._results import (
    Distance,
    MeshFacts,
    Simplification,
    ToleranceCheck,
    check_from,
    distance_from,
    level_from,
)

Length = Union[float, str]
Progress = Callable[[float], Optional[bool]]


def describe(mesh: Any) -> MeshFacts:
    """Facts about a mesh. Raises InvalidInput where it is none."""
    return MeshFacts(**_core.describe(*arrays_of(mesh)))


def hausdorff_distance(
    a: Any,
    b: Any,
    *,
    error_bound: Optional[Length] = None,
    one_sided: bool = False,
    threads: int = 0,
    time_limit: Optional[float] = None,
    progress: Optional[Progress] = None,
) -> Distance:
    """Measure the symmetric Hausdorff distance of two meshes.

    error_bound: wanted width of the interval; 1e-6 of the diagonal of ``a`` where it is None.
    one_sided: only from ``a`` to ``b``.
    threads: 0 is as many as OpenMP has. Results are the same for every number.
    time_limit: seconds of the whole call; the bounds that it had by then hold.
    progress: called with the share that is done, at most 20 times a second; an answer that is false, except None, ends
        the call with Cancelled.

    The arrays must not change during the call. Ctrl-C ends it. Raises InvalidInput for what is no mesh, and for
    options out of range. About O(n log n) where the surfaces are close or far apart for their size.
    """
    arrays = arrays_of(a)
    options = {
        "error_bound": _length(error_bound, arrays),
        "one_sided": one_sided,
        "threads": threads,
        "time_limit": time_limit,
        "progress": progress,
    }
    return distance_from(_core.measure(*arrays, *arrays_of(b), options))


def check_tolerance(
    a: Any,
    b: Any,
    tolerance: Length,
    *,
    one_sided: bool = False,
    threads: int = 0,
    time_limit: Optional[float] = None,
    progress: Optional[Progress] = None,
) -> ToleranceCheck:
    """Decide whether the distance of two meshes is at most ``tolerance``: faster than measuring it.

    A percentage is one of the diagonal of ``a``. Other arguments and errors as for `hausdorff_distance`.
    """
    arrays = arrays_of(a)
    options = {"one_sided": one_sided, "threads": threads, "time_limit": time_limit, "progress": progress}
    return check_from(_core.check(*arrays, *arrays_of(b), _required(_length(tolerance, arrays)), options))


def simplify(
    mesh: Any,
    tolerance: Length,
    *,
    levels: Iterable[Length] = (),
    target_faces: Optional[int] = None,
    target_ratio: Optional[float] = None,
    effort: str = "normal",
    placement: str = "optimal",
    precision: str = "double",
    on_exceed: str = "skip",
    prune: bool = False,
    preserve_boundary: bool = False,
    keep_sides: bool = False,
    locked_vertices: Any = None,
    feature_angle: Optional[float] = None,
    line_tolerance: Optional[Length] = None,
    feature_edges: Any = None,
    face_tolerances: Any = None,
    certificate: bool = False,
    threads: int = 0,
    time_limit: Optional[float] = None,
    progress: Optional[Progress] = None,
) -> Simplification:
    """Simplify a mesh while its symmetric Hausdorff distance to the original stays within ``tolerance``.

    levels: smaller tolerances at which the mesh is handed out as well, in any order.
    target_faces, target_ratio: where to end if the tolerance allows it, as a number or a share of the triangles.
    effort: "normal", or "high", which also moves vertices and flips edges for fewer triangles.
    placement: "optimal", or "subset": every vertex of the result is one of the original.
    precision: "double", or "single": coordinates of the result are floats, and the bound is that of these.
    on_exceed: "skip" a collapse that would exceed the tolerance, or "stop" there.
    prune: drop components whose every point is within the tolerance of the rest.
    preserve_boundary: edges with one triangle stay as they are.
    keep_sides: every triangle shows the side that its original shows, and edges between triangles of opposite winding
        are lines; otherwise neighbours are turned over until they agree (`Level.turned_faces`).
    locked_vertices: by vertex, True keeps it where it is.
    feature_angle: radians between normals from which on an edge is a crease, which stays as it is.
    line_tolerance: borders, creases and feature_edges stay within this length of where they were, both ways.
    feature_edges: pairs of vertices whose edges are lines as well.
    face_tolerances: by triangle, a tolerance of its own.
    certificate: also make the certificate that verify_certificate checks.

    ``threads``, ``time_limit``, ``progress`` and errors are those of `hausdorff_distance`. Each level is measured
    afresh. Expected O(n log n) time.
    """
    options = dict(locals())
    arrays = arrays_of(options.pop("mesh"))
    options["tolerance"] = _length(tolerance, arrays)
    options["levels"] = [_length(level, arrays) for level in levels]
    options["line_tolerance"] = _length(line_tolerance, arrays)
    return Simplification(tuple(level_from(level) for level in _core.simplify(*arrays, options)))


def build_certificate(
    original: Any,
    simplified: Any,
    tolerance: Length,
    *,
    threads: int = 0,
    time_limit: Optional[float] = None,
    progress: Optional[Progress] = None,
) -> bytes:
    """Prove that two meshes are within ``tolerance`` of each other: the bytes that verify_certificate checks.

    Raises Error where no proof was found. Other arguments and errors as for `hausdorff_distance`.
    """
    arrays = arrays_of(original)
    options = {"threads": threads, "time_limit": time_limit, "progress": progress}
    return _core.certificate(*arrays, *arrays_of(simplified), _required(_length(tolerance, arrays)), options)


class LevelChecker:
    """One original against many levels: what did not change from level to level is not checked again.

    The geometry of the original is copied. Calls from several threads wait for each other. While a call runs, its
    ``progress`` and the signal handlers of its thread cannot use the checker: they get an Error.
    """

    def __init__(self, original: Any, *, threads: int = 0) -> None:
        """Build the tree of the original."""
        arrays = arrays_of(original)
        self._diagonal = _core.describe(*arrays)["bbox_diagonal"]
        self._checker = _core.LevelChecker(*arrays, {"threads": threads})
        self._lock = threading.Lock()
        self._user: Optional[int] = None

    def check(
        self,
        level: Any,
        tolerance: Length,
        *,
        threads: int = 0,
        time_limit: Optional[float] = None,
        progress: Optional[Progress] = None,
    ) -> ToleranceCheck:
        """Decide whether a level is within ``tolerance`` of the original, as `check_tolerance` does."""
        options = {"threads": threads, "time_limit": time_limit, "progress": progress}
        wanted = _required(_length_of(tolerance, self._diagonal))
        with self._use():
            return check_from(self._checker.check(*arrays_of(level), wanted, options))

    def measure(
        self,
        level: Any,
        *,
        error_bound: Optional[Length] = None,
        threads: int = 0,
        time_limit: Optional[float] = None,
        progress: Optional[Progress] = None,
    ) -> Distance:
        """Measure the distance of a level from the original, as `hausdorff_distance` does."""
        options = {
            "error_bound": _length_of(error_bound, self._diagonal),
            "threads": threads,
            "time_limit": time_limit,
            "progress": progress,
        }
        with self._use():
            return distance_from(self._checker.measure(*arrays_of(level), options))

    @contextmanager
    def _use(self) -> Iterator[None]:
        """Waits for the calls of other threads. One of this thread, which runs this code meanwhile, would never end."""
        if self._user == threading.get_ident():
            raise _core.Error("this LevelChecker is in use: a call of this thread has not returned")
        with self._lock:
            self._user = threading.get_ident()
            try:
                yield
            finally:
                self._user = None


def _length(value: Optional[Length], original: Arrays) -> Optional[float]:
    """A length in model units; a text such as "0.1%" is relative to the diagonal of the original."""
    is_percentage = isinstance(value, str) and value.strip().endswith("%")
    return _length_of(value, _core.describe(*original)["bbox_diagonal"] if is_percentage else 0)


def _required(tolerance: Optional[float]) -> float:
    if tolerance is None:
        raise _core.InvalidInput("the tolerance must be given: a length, or a percentage such as '0.1%'")
    return tolerance


def _length_of(value: Optional[Length], diagonal: float) -> Optional[float]:
    if value is None:
        return None
    try:
        if isinstance(value, str) and value.strip().endswith("%"):
            return float(value.strip()[:-1]) / 100 * diagonal
        return float(value)
    except (TypeError, ValueError, OverflowError):
        raise _core.InvalidInput(f"{value!r} is no length: give a number, or a percentage such as '0.1%'") from None
