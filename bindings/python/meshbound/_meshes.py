# SPDX-License-Identifier: MIT
"""Arrays from whatever a caller has for a mesh. Nothing is imported but numpy: objects are known by their attributes."""

from __future__ import annotations

from typing import Any, Tuple

import numpy as np

from ._core import InvalidInput

Arrays = Tuple[np.ndarray, np.ndarray]
_INDEX_TYPES = (np.uint16, np.int32, np.uint32)
_SURFACES = ("triangle", "quad", "polygon")
_ADVICE = "cannot hold exactly: round them, or subtract an origin that is near the mesh"


def arrays_of(mesh: Any) -> Arrays:
    """Vertices and triangles as the compiled part takes them: copied only where type or layout need it.

    A polygon is split into a fan from its first corner, as the reader of mesh files does it.
    """
    vertices, triangles = _parts_of(mesh)
    return _coordinates(vertices), _indices(triangles)


def _parts_of(mesh: Any) -> Tuple[Any, Any]:
    if isinstance(mesh, (tuple, list)):
        if len(mesh) != 2:
            raise InvalidInput("a mesh must be a pair: vertices, triangles")
        return mesh[0], mesh[1]
    if hasattr(mesh, "vertices") and hasattr(mesh, "faces"):  # trimesh
        return mesh.vertices, mesh.faces
    if hasattr(mesh, "vertices") and hasattr(mesh, "triangles"):  # Open3D, meshbound
        return mesh.vertices, mesh.triangles
    if hasattr(mesh, "vertex") and hasattr(mesh, "triangle"):  # Open3D, tensors
        return mesh.vertex["positions"].cpu().numpy(), mesh.triangle["indices"].cpu().numpy()
    if hasattr(mesh, "points") and hasattr(mesh, "cells") and not hasattr(mesh, "faces"):  # meshio
        return mesh.points, _triangles_of_blocks(mesh.cells)
    if hasattr(mesh, "points") and hasattr(mesh, "faces"):  # pyvista
        if np.size(getattr(mesh, "strips", ())) > 0:
            raise InvalidInput("strips of triangles are not read: triangulate() of pyvista makes triangles of them")
        return mesh.points, _triangles_of_faces(_array(mesh.faces, "faces"))
    raise InvalidInput(
        f"a mesh cannot be made of {type(mesh).__name__}: pass a pair (vertices, triangles), or an object of "
        "trimesh, pyvista, Open3D or meshio"
    )


def _triangles_of_faces(faces: np.ndarray) -> np.ndarray:
    """Triangles of an array in which each face is a count followed by that many indices."""
    if faces.size == 0:
        return np.zeros((0, 3), np.uint32)
    if faces.ndim == 2:
        return faces
    if faces.size % 4 == 0 and np.all(faces[::4] == 3):
        return faces.reshape(-1, 4)[:, 1:]
    fans, at = [], 0
    while at < faces.size:
        count = int(faces[at])
        if count < 0 or at + 1 + count > faces.size:
            left = faces.size - at - 1
            raise InvalidInput(f"entry {at} of faces announces {count} corners, and {left} entries follow")
        fans.append(_fans(faces[at + 1 : at + 1 + count].reshape(1, -1)))
        at += 1 + count
    return np.concatenate(fans)


def _triangles_of_blocks(blocks: Any) -> np.ndarray:
    """Triangles of the blocks of a meshio mesh that are surfaces; points, lines and volumes are left out."""
    surfaces = []
    for block in blocks:
        if block.type in _SURFACES:
            surfaces.append(_array(block.data, f"cells of type {block.type}"))
        elif _is_surface(block):
            raise InvalidInput(f"cells of type {block.type} are not read: only triangles, quads and polygons are")
    if not surfaces:
        raise InvalidInput("the meshio mesh has no block of triangles, quads or polygons")
    return np.concatenate([_fans(block) for block in surfaces])


def _is_surface(block: Any) -> bool:
    """Whether its cells are two-dimensional: by the attribute that blocks of meshio have, or by the name of the type."""
    dimension = getattr(block, "dim", None)
    return any(name in block.type.lower() for name in _SURFACES) if dimension is None else dimension == 2


def _fans(polygons: np.ndarray) -> np.ndarray:
    """Triangles of polygons with the same number of corners, one in each row."""
    fans = [polygons[:, [0, i, i + 1]] for i in range(1, polygons.shape[1] - 1)]
    return np.stack(fans, axis=1).reshape(-1, 3) if fans else np.zeros((0, 3), polygons.dtype)


def _array(values: Any, name: str) -> np.ndarray:
    """An array of what can be one."""
    try:
        return np.asarray(values)
    except (TypeError, ValueError, OverflowError) as error:
        raise InvalidInput(f"{name} cannot be made an array of numpy: {error}") from error


def _coordinates(values: Any) -> np.ndarray:
    array = _array(values, "vertices")
    if isinstance(values, (list, tuple)):
        _require_unrounded(values, array)
    if array.dtype not in (np.float32, np.float64):
        if array.dtype.kind not in "iuf":
            raise InvalidInput(f"vertices must be numbers, not {array.dtype}")
        array = _doubles(array)
    has_rows = array.ndim == 2 and array.strides[1] == array.itemsize and array.strides[0] >= 3 * array.itemsize
    return array if has_rows and array.dtype.isnative else np.ascontiguousarray(array, array.dtype.newbyteorder("="))


def _require_unrounded(values: Any, array: np.ndarray) -> None:
    """Refuses sequences of large integers and floats together, of which numpy makes floats."""
    if array.dtype.kind != "f":
        return
    numbers = np.asarray(values, object)
    if not np.all((numbers == array.astype(object)) | (numbers != numbers)):
        raise InvalidInput(f"vertices have integers that {array.dtype} {_ADVICE}")


def _doubles(numbers: np.ndarray) -> np.ndarray:
    """The same numbers as float64. Bounds hold for the caller's coordinates, so none may be rounded."""
    with np.errstate(over="ignore"):
        doubles = numbers.astype(np.float64)
    if not _are_equal(doubles, numbers):
        raise InvalidInput(f"vertices of type {numbers.dtype} have coordinates that float64 {_ADVICE}")
    return doubles


def _are_equal(doubles: np.ndarray, numbers: np.ndarray) -> bool:
    """Whether all numbers, integers or floats, are the same in both arrays."""
    if numbers.dtype.kind == "f":
        back = doubles.astype(numbers.dtype)
        return bool(np.all((back == numbers) | np.isnan(numbers)))
    # 2^63 and 2^64 as doubles are beyond the integers of 64 bits, to which converting them back is undefined.
    limits = np.iinfo(numbers.dtype)
    back_fits = (doubles >= float(limits.min)) & (doubles < float(int(limits.max) + 1))
    return bool(np.all(back_fits)) and bool(np.all(doubles.astype(numbers.dtype) == numbers))


def _indices(values: Any) -> np.ndarray:
    array = _array(values, "triangles")
    if array.shape == (0,):  # an empty list, of which numpy makes floats
        return np.zeros((0, 3), np.uint32)
    if array.dtype.kind not in "iu":
        raise InvalidInput(f"triangles must be integers, not {array.dtype}")
    if array.dtype not in _INDEX_TYPES:
        if array.size > 0 and (int(array.min()) < 0 or int(array.max()) >= 2**32):
            raise InvalidInput("an index of a triangle is negative or beyond 2^32 - 1")
        array = array.astype(np.uint32)
    return np.ascontiguousarray(array)
