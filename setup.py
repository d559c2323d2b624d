"""Builds the compiled part of the package with CMake; everything else stands in pyproject.toml.

APSIS_COMPILED names a build folder in which it is compiled already (cmake -DAPSIS_PYTHON_PACKAGE=ON).
"""
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

HERE = Path(__file__).resolve().parent


def compiled_in(build):
    return next((build / "python" / "apsis").glob("_core*.so"))


class CMakeBuild(build_ext):
    def build_extension(self, ext):
        if "APSIS_COMPILED" in os.environ:
            module = compiled_in(Path(os.environ["APSIS_COMPILED"]))
        else:
            build = Path(self.build_temp).resolve()
            subprocess.run(["cmake", "-S", HERE, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                            "-DCMAKE_CXX_COMPILER=g++-12", "-DAPSIS_PYTHON_PACKAGE=ON", "-DAPSIS_APP=OFF", "-DAPSIS_TESTS=OFF",
                            "-DAPSIS_BENCH=OFF", "-DAPSIS_PCH=ON", f"-DPython3_EXECUTABLE={sys.executable}"], check=True)
            subprocess.run(["cmake", "--build", build, "--target", "apsis_python"], check=True)
            module = compiled_in(build)
        target = Path(self.get_ext_fullpath(ext.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(module, target)


def version():
    return re.search(r"project\(apsis VERSION ([0-9.]+)", (HERE / "CMakeLists.txt").read_text(encoding="utf-8"))[1]


setup(version=version(), ext_modules=[Extension("apsis._core", sources=[])], cmdclass={"build_ext": CMakeBuild})
