# SPDX-License-Identifier: MIT
"""Simplifies a wavy sheet and checks the result against the original."""

import meshbound
import numpy as np

side = 100
x, y = np.meshgrid(np.arange(side, dtype=float), np.arange(side, dtype=float))
vertices = np.column_stack([x.ravel(), y.ravel(), (4 * np.sin(x / 10) * np.cos(y / 10)).ravel()])
corners = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).ravel()
halves = ([0, 1, side + 1], [0, side + 1, side])
triangles = np.concatenate([corners[:, None] + half for half in halves]).astype(np.uint32)

level = meshbound.simplify((vertices, triangles), "0.1%").level
print(f"{len(triangles)} -> {len(level.triangles)} triangles, H <= {level.distance.upper}")
assert meshbound.check_tolerance((vertices, triangles), level, level.tolerance)
