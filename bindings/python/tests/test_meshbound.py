# SPDX-License-Identifier: MIT
"""The Python package: arrays of every kind, results, objects of other packages, progress, Ctrl-C, threads."""

import ast
import dataclasses
import math
import os
import re
import signal
import subprocess
import sys
import threading
import types
import unittest
from pathlib import Path

import numpy as np

import meshbound
from meshbound import _core


def sheet(side, height=0.0, dtype=np.float64):
    """A square of side * side vertices, flat or wavy."""
    x, y = np.meshgrid(np.arange(side, dtype=float), np.arange(side, dtype=float), indexing="ij")
    z = height * np.sin(x / 5) * np.cos(y / 7)
    corner = (np.arange(side - 1)[:, None] * side + np.arange(side - 1)).reshape(-1, 1)
    triangles = np.concatenate([corner + [0, side, 1], corner + [1, side, side + 1]])
    return np.stack([x.ravel(), y.ravel(), z.ravel()], 1).astype(dtype), triangles


def lifted(mesh, height):
    return mesh[0] + [0, 0, height], mesh[1]


class Distances(unittest.TestCase):
    def test_two_parallel_sheets_are_as_far_apart_as_they_were_placed(self):
        flat = sheet(8)
        distance = meshbound.hausdorff_distance(flat, lifted(flat, 0.25))
        self.assertLessEqual(distance.lower, 0.25)
        self.assertGreaterEqual(distance.upper, 0.25)
        self.assertAlmostEqual(distance.upper, 0.25, delta=1e-4)
        self.assertAlmostEqual(distance.a_to_b.from_point[2], 0)
        self.assertAlmostEqual(distance.a_to_b.nearest_point[2], 0.25)
        self.assertEqual(distance.a_to_b.outcome, "converged")

    def test_one_side_only(self):
        small = sheet(4)
        distance = meshbound.hausdorff_distance(small, sheet(8), one_sided=True)
        self.assertLess(distance.upper, 1e-4)
        self.assertTrue(distance.a_to_b.searched)
        self.assertFalse(distance.b_to_a.searched)
        self.assertEqual((distance.a_to_b.outcome, distance.b_to_a.outcome), ("converged", "not_searched"))
        self.assertGreater(meshbound.hausdorff_distance(small, sheet(8)).lower, 1)

    def test_error_bound_as_a_percentage_of_the_diagonal(self):
        a, b = sheet(30, 2), sheet(29, 1.5)
        diagonal = meshbound.describe(a).bbox_diagonal
        distance = meshbound.hausdorff_distance(a, b, error_bound="1%")
        self.assertLessEqual(distance.upper - distance.lower, 0.01 * diagonal)

    def test_decision_is_a_truth_value(self):
        flat = sheet(8)
        within = meshbound.check_tolerance(flat, lifted(flat, 0.25), 0.3)
        self.assertTrue(within)
        self.assertEqual(within.verdict, "within")
        exceeds = meshbound.check_tolerance(flat, lifted(flat, 0.25), 0.2)
        self.assertFalse(exceeds)
        self.assertEqual(exceeds.verdict, "exceeds")
        self.assertGreater(exceeds.lower, 0.2)

    def test_decision_of_one_side_has_its_own_bounds(self):
        # A small triangle of b floats above the large one that both have, so that only b is far from a.
        triangles = np.array([[0, 1, 2], [3, 4, 5]])
        flat = np.array([[0, 0, 0], [10, 0, 0], [0, 10, 0], [1, 1, 0], [2, 1, 0], [1, 2, 0]], float)
        floating = flat + np.array([0, 0, 0, 1, 1, 1])[:, None] * [0, 0, 1]
        check = meshbound.check_tolerance((flat, triangles), (floating, triangles), 1.5, one_sided=True)
        self.assertTrue(check)
        self.assertEqual(check.lower, 0)
        self.assertFalse(check.b_to_a.searched)

    def test_checker_of_many_levels(self):
        original = sheet(12, 1)
        checker = meshbound.LevelChecker(original)
        self.assertTrue(checker.check(original, 0))
        self.assertFalse(checker.check(lifted(original, 3), "1%"))
        self.assertAlmostEqual(checker.measure(lifted(original, 0.5), error_bound=1e-6).upper,
                               meshbound.hausdorff_distance(original, lifted(original, 0.5), error_bound=1e-6).upper,
                               delta=2e-6)

    def test_facts(self):
        facts = meshbound.describe(sheet(5))
        self.assertEqual((facts.vertices, facts.triangles, facts.components, facts.closed), (25, 32, 1, False))
        self.assertAlmostEqual(facts.bbox_diagonal, math.sqrt(32))


class Simplifying(unittest.TestCase):
    def test_result_keeps_the_tolerance(self):
        original = sheet(40, 3)
        result = meshbound.simplify(original, "0.5%", levels=["0.1%"], certificate=True)
        self.assertEqual(len(result.levels), 2)
        self.assertLess(len(result.level.triangles), len(result.levels[0].triangles))
        for level in result.levels:
            self.assertEqual(level.verdict, "within")
            self.assertLessEqual(level.distance.upper, level.tolerance)
            self.assertTrue(meshbound.check_tolerance(original, level, level.tolerance))
            self.assertEqual(level.vertices.dtype, np.float64)
            self.assertEqual(level.triangles.shape[1], 3)
            self.assertEqual(len(level.source_vertices), len(level.vertices))
            self.assertEqual(level.certificate, meshbound.build_certificate(original, level, level.tolerance))

    def test_results_belong_to_numpy(self):
        level = meshbound.simplify(sheet(10), 0.1).level
        vertices = level.vertices
        del level
        vertices += 1
        self.assertTrue(np.all(vertices >= 1))

    def test_options_reach_the_library(self):
        original = sheet(20, 2)
        self.assertEqual(meshbound.simplify(original, 10, target_faces=100).level.ended_by, "target")
        subset = meshbound.simplify(original, 0.2, placement="subset").level
        np.testing.assert_array_equal(subset.vertices, original[0][subset.source_vertices])
        single = meshbound.simplify(original, 0.2, precision="single").level
        np.testing.assert_array_equal(single.vertices, single.vertices.astype(np.float32))
        locked = meshbound.simplify(original, 0.2, locked_vertices=np.ones(len(original[0]), bool)).level
        self.assertEqual(len(locked.triangles), len(original[1]))
        lines = meshbound.simplify(original, 0.2, line_tolerance=0.01).level
        self.assertLessEqual(lines.line_distance.upper, 0.01)
        self.assertEqual(lines.lines.shape[1], 2)
        tight = meshbound.simplify(original, 0.2, face_tolerances=np.full(len(original[1]), 0.01)).level
        self.assertGreater(len(tight.triangles), len(meshbound.simplify(original, 0.2).level.triangles))
        edges = meshbound.simplify(original, 0.2, line_tolerance=0, feature_edges=original[1][:, :2]).level
        self.assertGreater(len(edges.lines), len(lines.lines))
        turned = original[1].copy()
        turned[::10] = turned[::10, ::-1]
        self.assertGreater(meshbound.simplify((original[0], turned), 0.01).level.turned_faces, 0)
        self.assertEqual(meshbound.simplify((original[0], turned), 0.01, keep_sides=True).level.turned_faces, 0)

    def test_results_are_dataclasses(self):
        level = meshbound.simplify(sheet(6), 0.1).level
        self.assertIn("upper", dataclasses.asdict(level.distance))
        with self.assertRaises(dataclasses.FrozenInstanceError):
            level.tolerance = 1

    def test_results_print_as_one_line(self):
        result = meshbound.simplify(sheet(60), 0.1)
        self.assertRegex(repr(result), r"verdict='within'.*distance=\[0.0, .*4 vertices, 2 triangles\)")
        self.assertLess(len(repr(result)), 400)


class Arrays(unittest.TestCase):
    def test_no_copy_where_the_layout_allows(self):
        from meshbound._meshes import arrays_of

        records = np.zeros(16, [("normal", np.float32, 3), ("position", np.float32, 3)])
        for positions in (np.zeros((16, 3)), np.zeros((16, 3), np.float32), records["position"], np.zeros((16, 8))[:, 2:5]):
            for kind in (np.uint16, np.int32, np.uint32):
                indices = np.zeros((4, 3), kind)
                vertices, triangles = arrays_of((positions, indices))
                self.assertTrue(np.shares_memory(vertices, positions))
                self.assertTrue(np.shares_memory(triangles, indices))

    def test_every_layout_gives_the_same_answer(self):
        mesh = sheet(9, 1)
        expected = meshbound.hausdorff_distance(mesh, lifted(mesh, 1))
        vertices, triangles = mesh
        records = np.zeros(len(vertices), [("id", np.int32), ("position", np.float64, 3)])
        records["position"] = vertices
        for positions in (vertices[::-1][::-1], np.asfortranarray(vertices), records["position"], vertices.astype(">f8")):
            for indices in (triangles.astype(np.int32), np.asfortranarray(triangles), triangles.astype(np.uint16),
                            triangles.tolist()):
                self.assertEqual(meshbound.hausdorff_distance((positions, indices), lifted(mesh, 1)), expected)
        backwards = vertices[::-1], len(vertices) - 1 - triangles
        self.assertEqual(meshbound.hausdorff_distance(backwards, mesh).upper, 0)

    def test_what_is_no_mesh_is_refused(self):
        vertices, triangles = sheet(4)
        nothing = np.zeros((0, 3), int)
        infinite = np.where(np.arange(len(vertices))[:, None] == 5, np.inf, vertices)
        for bad, reason in (
            ((vertices[:, :2], triangles), "shape"),
            ((vertices, triangles[:, :2]), "shape"),
            ((vertices, triangles.astype(float)), "integers"),
            ((vertices.astype(str), triangles), "numbers"),
            ((vertices, triangles - 1), "negative"),
            ((vertices, triangles + 2**40), "beyond"),
            ((vertices, triangles + 10), "there are only 16"),
            ((vertices, nothing), "no triangles"),
            ((infinite, triangles), "vertex 5"),
            ((vertices, []), "no triangles"),
            (([[0, 0, 0], [1, 2]], triangles), "^vertices cannot be made an array"),
            ((vertices, [[0, 1, 2], [1]]), "^triangles cannot be made an array"),
            ((vertices,), "pair"),
            (object(), "object"),
        ):
            with self.subTest(reason), self.assertRaisesRegex(meshbound.InvalidInput, reason):
                meshbound.describe(bad)

    def test_coordinates_that_would_be_rounded_are_refused(self):
        triangle = [[0, 1, 2]]
        corner = np.array([[0, 0, 0], [0, 1, 0], [0, 0, 1]])
        for large in (2**53 + 1, -(2**53) - 1, 2**63 - 1):
            with self.subTest(large), self.assertRaisesRegex(meshbound.InvalidInput, "int64 have .* float64 cannot hold"):
                meshbound.describe((corner + [large, 0, 0], triangle))
        wide = corner.astype(np.uint64)
        wide[0, 0] = 2**64 - 1
        fine = corner.astype(np.longdouble)
        fine[0, 0] = 1 + np.longdouble(2) ** -60
        huge = corner.astype(np.longdouble)
        huge[0, 0] = np.longdouble(2) ** 2000
        mixed = [[2**53 + 1, 0.5, 0], [0, 1, 0], [0, 0, 1]]
        for rounded in (wide, fine, huge, mixed):
            with self.subTest(rounded), self.assertRaisesRegex(meshbound.InvalidInput, "float64 cannot hold exactly"):
                meshbound.describe((rounded, triangle))
        for kept in (corner + [2**53, 0, 0], corner + [-(2**63), 0, 0], corner.astype(np.longdouble) / 3 * 3,
                     corner.astype(np.uint8), corner.astype(np.float16), [[2**53, 0.5, 0], [0, 1, 0], [0, 0, 1]]):
            self.assertEqual(meshbound.describe((kept, triangle)).triangles, 1)

    def test_errors_are_those_that_python_expects(self):
        self.assertTrue(issubclass(meshbound.InvalidInput, ValueError))
        self.assertTrue(issubclass(meshbound.InvalidInput, meshbound.Error))
        for call in (
            lambda: meshbound.simplify(sheet(4), -1),
            lambda: meshbound.simplify(sheet(4), "wide"),
            lambda: meshbound.simplify(sheet(4), 1, effort="fast"),
            lambda: meshbound.simplify(sheet(4), 1, levels=[2]),
            lambda: meshbound.check_tolerance(sheet(4), sheet(4), math.nan),
            lambda: meshbound.check_tolerance(sheet(4), sheet(4), None),
            lambda: meshbound.LevelChecker(sheet(4)).check(sheet(4), None),
            lambda: meshbound.build_certificate(sheet(4), sheet(4), None),
            lambda: meshbound.hausdorff_distance(sheet(4), sheet(4), error_bound=-1),
            lambda: meshbound.hausdorff_distance(sheet(4), sheet(4), time_limit=-1),
        ):
            with self.assertRaises(ValueError):
                call()
        with self.assertRaisesRegex(meshbound.Error, "triangle"):
            meshbound.build_certificate(sheet(4), lifted(sheet(4), 1), 0.5)

    def test_options_of_the_wrong_type_are_named(self):
        mesh = sheet(4)
        for name, values in {
            "target_faces": (-1, 10.0, 2**70, "many"),
            "target_ratio": ("half",),
            "feature_edges": ([[-1, 2]], [[0, 1, 2]], [0, 1], mesh[1], 5),
            "locked_vertices": (7, [object()]),
            "face_tolerances": (["1%"] * len(mesh[1]), 1),
            "feature_angle": ("right",),
            "time_limit": ("long",),
            "threads": (2**40, 1.5),
            "effort": (1,),
            "levels": ([None],),
        }.items():
            for value in values:
                with self.subTest(name, value=value), self.assertRaisesRegex(meshbound.InvalidInput, f"{name} must be"):
                    meshbound.simplify(mesh, 1, **{name: value})
        checker = meshbound.LevelChecker(mesh)
        meshes_of = {
            meshbound.simplify: (mesh, 1),
            meshbound.hausdorff_distance: (mesh, mesh),
            meshbound.check_tolerance: (mesh, mesh, 1),
            meshbound.build_certificate: (mesh, mesh, 1),
            meshbound.LevelChecker: (mesh,),
            checker.check: (mesh, 1),
            checker.measure: (mesh,),
        }
        for function, meshes in meshes_of.items():
            options = {"threads": (1.5, 2**31, "two")}
            if function is not meshbound.LevelChecker:
                options.update(time_limit=("x", [1]), progress=(5, "f"))
            if function in (meshbound.hausdorff_distance, meshbound.check_tolerance):
                options.update(one_sided=("yes", []))
            for name, value in ((name, value) for name, values in options.items() for value in values):
                with self.subTest(function, **{name: value}):
                    with self.assertRaisesRegex(meshbound.InvalidInput, f"^{name} must be [^\n]*$"):
                        function(*meshes, **{name: value})
        for length in ([1], object(), 10**400):
            with self.subTest(length), self.assertRaisesRegex(meshbound.InvalidInput, "is no length"):
                meshbound.simplify(mesh, length)


class ObjectsOfOthers(unittest.TestCase):
    """With stand-ins that have the attributes of the packages; with the packages themselves where they are."""

    def assert_is_sheet(self, mesh, triangles=18):
        self.assertEqual(meshbound.describe(mesh).triangles, triangles)
        self.assertEqual(meshbound.hausdorff_distance(mesh, sheet(4)).upper, 0)

    def test_attributes(self):
        v, t = sheet(4)
        flat = np.hstack([np.full((len(t), 1), 3), t]).ravel()
        quads = np.array([[0, 4, 5, 1], [1, 5, 6, 2]])
        block = types.SimpleNamespace
        tensor = types.SimpleNamespace(cpu=lambda: types.SimpleNamespace(numpy=lambda: v))
        tensor_of_triangles = types.SimpleNamespace(cpu=lambda: types.SimpleNamespace(numpy=lambda: t))
        self.assert_is_sheet(types.SimpleNamespace(vertices=v, faces=t))
        self.assert_is_sheet(types.SimpleNamespace(vertices=v, triangles=t))
        self.assert_is_sheet(types.SimpleNamespace(vertex={"positions": tensor}, triangle={"indices": tensor_of_triangles}))
        self.assert_is_sheet(types.SimpleNamespace(points=v, faces=flat))
        self.assert_is_sheet(types.SimpleNamespace(points=v, cells=[block(type="line", data=t[:, :2]), block(type="triangle", data=t)]))
        self.assertEqual(meshbound.describe(types.SimpleNamespace(points=v, cells=[block(type="quad", data=quads)])).triangles, 4)
        mixed = np.array([4, 0, 4, 5, 1, 3, 1, 5, 2])
        self.assertEqual(meshbound.describe(types.SimpleNamespace(points=v, faces=mixed)).triangles, 3)
        for broken, reason in (([3, 0, 1, 5, 4, 0, 1], "entry 4 .* 4 corners, and 2 "), ([3, 0, 1, 5, -1, 0], "-1 corners")):
            with self.assertRaisesRegex(meshbound.InvalidInput, reason):
                meshbound.describe(types.SimpleNamespace(points=v, faces=np.array(broken)))
        with self.assertRaisesRegex(meshbound.InvalidInput, "no block"):
            meshbound.describe(types.SimpleNamespace(points=v, cells=[block(type="line", data=t[:, :2])]))

    def test_surfaces_that_are_not_read_are_named(self):
        v, t = sheet(4)
        block = types.SimpleNamespace
        flat = block(type="triangle", data=t)
        for other in ("triangle6", "quad8", "polygon5", "VTK_LAGRANGE_QUADRILATERAL"):
            for dimension in ({}, {"dim": 2}):
                mesh = types.SimpleNamespace(points=v, cells=[flat, block(type=other, data=t, **dimension)])
                with self.subTest(other), self.assertRaisesRegex(meshbound.InvalidInput, f"type {other} are not read"):
                    meshbound.describe(mesh)
        strips = np.array([4, 0, 1, 4, 5])
        faces = np.hstack([np.full((len(t), 1), 3), t]).ravel()
        with self.assertRaisesRegex(meshbound.InvalidInput, "strips"):
            meshbound.describe(types.SimpleNamespace(points=v, faces=faces, strips=strips))
        self.assert_is_sheet(types.SimpleNamespace(points=v, faces=faces, strips=strips[:0]))
        self.assert_is_sheet(types.SimpleNamespace(points=v, cells=[flat, block(type="tetra", data=t), block(type="pixel", dim=1)]))

    def test_packages(self):
        makers = {
            "trimesh": lambda m, v, t: m.Trimesh(v, t, process=False),
            "pyvista": lambda m, v, t: m.PolyData(v, np.hstack([np.full((len(t), 1), 3), t]).ravel()),
            "meshio": lambda m, v, t: m.Mesh(v, [("triangle", t)]),
            "open3d": lambda m, v, t: m.geometry.TriangleMesh(m.utility.Vector3dVector(v), m.utility.Vector3iVector(t)),
        }
        for name, make in makers.items():
            with self.subTest(name):
                try:
                    package = __import__(name)
                except ImportError:
                    self.skipTest(f"{name} is not installed")
                self.assert_is_sheet(make(package, *sheet(4)))


class LongCalls(unittest.TestCase):
    large = sheet(260, 5)

    def test_progress_is_called_in_the_calling_thread(self):
        seen = []
        meshbound.simplify(self.large, "0.05%", progress=lambda fraction: seen.append((fraction, threading.get_ident())))
        self.assertGreater(len(seen), 0)
        self.assertTrue(all(0 <= fraction <= 1 and thread == threading.get_ident() for fraction, thread in seen))

    def test_progress_ends_the_call(self):
        for answer in (False, np.False_, 0):
            with self.subTest(answer), self.assertRaises(meshbound.Cancelled):
                meshbound.simplify(self.large, "0.05%", progress=lambda fraction: answer)
        meshbound.simplify(self.large, "0.05%", progress=lambda fraction: np.True_)

    def test_progress_ends_the_call_while_trees_are_built(self):
        a, b = sheet(700, 5), sheet(699, 5)
        for measure in (meshbound.hausdorff_distance, lambda *meshes, **how: meshbound.check_tolerance(*meshes, 1, **how)):
            with self.assertRaises(meshbound.Cancelled):
                measure(a, b, threads=1, progress=lambda fraction: False)

    def test_what_progress_raises_comes_out(self):
        def fail(fraction):
            raise KeyError("from progress")

        with self.assertRaisesRegex(KeyError, "from progress"):
            meshbound.simplify(self.large, "0.05%", progress=fail)

    def test_a_checker_that_is_in_use_says_so(self):
        checker = meshbound.LevelChecker(self.large)
        level = lifted(self.large, 0.5)
        for call in (lambda: checker.check(level, 1), lambda: checker.measure(level)):
            calls = []

            def use_again(fraction):
                calls.append(fraction)
                call()

            with self.assertRaisesRegex(meshbound.Error, "in use"):
                while not calls:  # a call on a machine that is very fast may end before it reports anything
                    checker.measure(level, error_bound=0, progress=use_again)
        self.assertTrue(checker.check(self.large, 0), "it goes on after that")

    def assert_other_threads_go_on(self, call):
        steps, is_done = [], threading.Event()

        def count():
            while not is_done.wait(0.001):
                steps.append(None)

        thread = threading.Thread(target=count)
        thread.start()
        try:
            before = len(steps)
            call()
            self.assertGreater(len(steps) - before, 5)
        finally:
            is_done.set()
            thread.join()

    def test_other_threads_of_python_go_on(self):
        self.assert_other_threads_go_on(lambda: meshbound.simplify(self.large, "0.05%"))

    def test_other_threads_of_python_go_on_while_a_tree_is_built(self):
        vertices, triangles = sheet(700, 5)
        mesh = vertices, triangles.astype(np.uint32)  # read where it is: Python has nothing to do
        with self.subTest("describe"):
            self.assert_other_threads_go_on(lambda: meshbound.describe(mesh))
        checker_of = _core.LevelChecker  # without the description of the mesh that meshbound.LevelChecker makes first
        with self.subTest("LevelChecker"):
            self.assert_other_threads_go_on(lambda: checker_of(*mesh, {"threads": 1}))

    def test_interrupt_from_the_keyboard(self):
        # The handler runs while threads of the call are still there, and its exception ends the call.
        program = (
            "import os, signal, sys, test_meshbound, meshbound\n"
            "def threads(): return len(os.listdir('/proc/self/task'))\n"
            "mesh, before, told = test_meshbound.sheet(500, 5), threads(), []\n"
            "def progress(fraction):\n"
            "    if not told: told.append(print('started', flush=True))\n"
            "def interrupt(*_):\n"
            "    print('during the call' if threads() > before else 'after it', flush=True)\n"
            "    raise KeyboardInterrupt\n"
            "signal.signal(signal.SIGINT, interrupt)\n"
            "try:\n"
            "    meshbound.simplify(mesh, '0.02%', effort='high', progress=progress)\n"
            "except KeyboardInterrupt:\n"
            "    sys.exit(42)\n"
        )
        environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
        with subprocess.Popen([sys.executable, "-c", program], env=environment, stdout=subprocess.PIPE) as child:
            self.assertEqual(child.stdout.readline(), b"started\n")
            child.send_signal(signal.SIGINT)
            self.assertEqual(child.stdout.readline(), b"during the call\n")
            self.assertEqual(child.wait(60), 42)


class CompiledPart(unittest.TestCase):
    def test_stub_has_the_parameters_of_the_functions(self):
        # pybind11 begins a docstring with the signature, in which parameters without a name are arg0, arg1, ...
        stub = ast.parse(Path(_core.__file__).with_name("_core.pyi").read_text())
        owners = [(_core, stub), *((getattr(_core, c.name), c) for c in stub.body if isinstance(c, ast.ClassDef))]
        seen = 0
        for owner, node in owners:
            for function in (one for one in node.body if isinstance(one, ast.FunctionDef)):
                signature = getattr(owner, function.name).__doc__.splitlines()[0]
                names = re.findall(r"(\w+): ", signature)
                unnamed = [name for name in names if re.fullmatch(r"self|arg\d+", name)]
                with self.subTest(signature):
                    self.assertEqual([one.arg for one in function.args.args], names[len(unnamed):])
                    self.assertEqual(len(function.args.posonlyargs), len(unnamed))
                seen += 1
        self.assertEqual(seen, 8)


if __name__ == "__main__":
    unittest.main()
