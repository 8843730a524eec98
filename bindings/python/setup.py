# SPDX-License-Identifier: MIT
"""Builds the compiled part of the package with CMake, from the sources that this folder lies in.

With the variable MESHBOUND_BUILD in the environment, that build folder is used, and brought up to date, instead of one
of pip's own.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = Path(__file__).resolve().parents[2]
OFF = ("TOOLS", "TESTS", "CGAL", "C", "INSTALL")


class BuildWithCMake(build_ext):
    """Puts the module that CMake has made where setuptools expects it."""

    def build_extension(self, ext: Extension) -> None:
        tree = Path(os.environ.get("MESHBOUND_BUILD") or Path(self.build_temp).resolve())
        if "MESHBOUND_BUILD" not in os.environ:
            options = [f"-DMESHBOUND_{name}=OFF" for name in OFF]
            options += ["-DMESHBOUND_PYTHON=ON", "-DCMAKE_BUILD_TYPE=Release", f"-DPython3_EXECUTABLE={sys.executable}"]
            subprocess.run(["cmake", "-S", ROOT, "-B", tree, *options], check=True)
        subprocess.run(["cmake", "--build", tree, "--target", "meshbound_python", "--parallel"], check=True)
        destination = Path(self.get_ext_fullpath(ext.name))
        destination.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(tree / "python" / "meshbound" / destination.name, destination)


def version() -> str:
    """That of the project, which CMakeLists.txt names."""
    found = re.search(r"project\(meshbound VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())
    if not found:
        raise SystemExit(f"{ROOT}/CMakeLists.txt names no version: install from a complete checkout of meshbound")
    return found.group(1)


setup(version=version(), ext_modules=[Extension("meshbound._core", [])], cmdclass={"build_ext": BuildWithCMake})
