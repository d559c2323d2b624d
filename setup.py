"""Builds the compiled part of the package with CMake; everything else stands in pyproject.toml.

A build folder of these sources is reused, since the module needs most of what the program needs: that of the variable
APSIS_BUILD_DIR, or build/release after `make run`. APSIS_BUILD_DIR= (empty) compiles everything anew. Such a build takes the
compilers of CC and CXX, and options of CMake in CMAKE_ARGS.
"""
import os
import re
import shlex
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

HERE = Path(__file__).resolve().parent
SUFFIX = sysconfig.get_config_var("EXT_SUFFIX")  # names interpreter, version and platform


def cache_of(build):
    """Returns the variables of a configured build folder; empty if it is none."""
    file = build / "CMakeCache.txt"
    if not file.is_file():
        return {}
    return dict(re.findall(r"(?m)^([\w-]+):\w+=(.*)$", file.read_text(encoding="utf-8")))


def is_on(cache, option):
    return cache.get(option, "").upper() in ("ON", "TRUE", "YES", "Y", "1")


def obstacle(cache):
    """Returns why the module cannot be built in a folder with this cache; empty if it can."""
    sources = cache.get("CMAKE_HOME_DIRECTORY")
    if not sources:
        return "no build was configured there"
    if Path(sources).resolve() != HERE:
        return f"it belongs to the sources {sources}"
    if is_on(cache, "BUILD_SHARED_LIBS"):
        return "the module would need its shared libraries"
    if is_on(cache, "APSIS_PYTHON_PACKAGE") and cache.get("PYTHON_MODULE_EXTENSION", SUFFIX) != SUFFIX:
        return f"it is configured for another Python, {cache.get('Python3_EXECUTABLE')}"
    return ""


def folder_to_reuse(environment):
    """Returns the build folder to reuse, or None."""
    named = environment.get("APSIS_BUILD_DIR")
    if named is None:
        build = HERE / "build" / "release"
        cache = cache_of(build)
        return build if not obstacle(cache) and cache.get("CMAKE_BUILD_TYPE") == "Release" else None
    if not named:
        return None
    build = Path(named).resolve()
    reason = obstacle(cache_of(build))
    if reason:
        raise SystemExit(f"cannot build the Python module in APSIS_BUILD_DIR, '{build}' ({reason}); "
                         "name a build folder of these sources, or unset the variable")
    return build


def configure(build, *options):
    subprocess.run(["cmake", "-S", HERE, "-B", build, "-DAPSIS_PYTHON_PACKAGE=ON", *options], check=True)


class CMakeBuild(build_ext):
    def build_extension(self, ext):
        build = folder_to_reuse(os.environ)
        if build:
            print(f"building the module in {build}")
            if not is_on(cache_of(build), "APSIS_PYTHON_PACKAGE"):
                # The folder may outlive a virtual environment.
                configure(build, f"-DPython3_EXECUTABLE={os.path.realpath(sys.executable)}")
        else:
            build = Path(self.build_temp).resolve()
            configure(build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DAPSIS_PREFERRED_COMPILERS=gcc-12;g++-12",
                      "-DAPSIS_WERROR=OFF", "-DAPSIS_APP=OFF", "-DAPSIS_TESTS=OFF", "-DAPSIS_BENCH=OFF", "-DAPSIS_PCH=ON",
                      f"-DPython3_EXECUTABLE={sys.executable}", *shlex.split(os.environ.get("CMAKE_ARGS", "")))
        subprocess.run(["cmake", "--build", build, "--target", "apsis_python"], check=True)
        target = Path(self.get_ext_fullpath(ext.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(build / "python" / "apsis" / f"_core{SUFFIX}", target)


def version():
    return re.search(r"project\(apsis VERSION ([0-9.]+)", (HERE / "CMakeLists.txt").read_text(encoding="utf-8"))[1]


if __name__ == "__main__":
    setup(version=version(), ext_modules=[Extension("apsis._core", sources=[])], cmdclass={"build_ext": CMakeBuild})
