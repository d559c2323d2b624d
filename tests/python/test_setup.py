"""setup.py: which build folder it reuses, and how it calls CMake. install.py tests the result with a real build."""
import importlib.util
import os
import subprocess
import sys
import sysconfig
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
SUFFIX = sysconfig.get_config_var("EXT_SUFFIX")
spec = importlib.util.spec_from_file_location("setup_of_apsis", ROOT / "setup.py")
setup = importlib.util.module_from_spec(spec)
spec.loader.exec_module(setup)


def configured(build, **changes):
    """Writes the cache of a build with the preset release and the Python package. A variable that is None is removed."""
    cache = {"CMAKE_HOME_DIRECTORY": str(ROOT), "CMAKE_BUILD_TYPE": "Release", "APSIS_PYTHON_PACKAGE": "ON",
             "PYTHON_MODULE_EXTENSION": SUFFIX} | changes
    build.mkdir(parents=True, exist_ok=True)
    (build / "CMakeCache.txt").write_text("".join(f"{name}:STRING={value}\n" for name, value in cache.items() if value is not None),
                                          encoding="utf-8")
    return build


def test_a_named_build_folder_is_reused_whatever_its_build_type(tmp_path):
    for build_type in ("Release", "RelWithDebInfo"):
        configured(tmp_path, CMAKE_BUILD_TYPE=build_type)
        assert setup.folder_to_reuse({"APSIS_BUILD_DIR": str(tmp_path)}) == tmp_path


@pytest.mark.parametrize("changes, reason", [
    ({"CMAKE_HOME_DIRECTORY": "/another/apsis"}, "it belongs to the sources /another/apsis"),
    ({"CMAKE_HOME_DIRECTORY": None}, "no build was configured there"),
    ({"BUILD_SHARED_LIBS": "on"}, "the module would need its shared libraries"),
    ({"PYTHON_MODULE_EXTENSION": ".cpython-399-m68k.so", "Python3_EXECUTABLE": "/opt/python"}, "another Python, /opt/python"),
])
def test_an_unfit_named_folder_is_refused_with_the_reason(tmp_path, changes, reason):
    with pytest.raises(SystemExit) as caught:
        setup.folder_to_reuse({"APSIS_BUILD_DIR": str(configured(tmp_path, **changes))})
    assert reason in str(caught.value) and "); name a build folder" in str(caught.value)


def test_a_folder_without_a_build_is_refused(tmp_path):
    with pytest.raises(SystemExit, match="no build was configured there"):
        setup.folder_to_reuse({"APSIS_BUILD_DIR": str(tmp_path)})


def test_build_release_is_reused_if_it_fits_and_silently_ignored_otherwise(tmp_path, monkeypatch):
    monkeypatch.setattr(setup, "HERE", tmp_path)
    build = tmp_path / "build" / "release"
    assert setup.folder_to_reuse({}) is None
    configured(build, CMAKE_HOME_DIRECTORY=str(tmp_path))
    assert setup.folder_to_reuse({}) == build
    assert setup.folder_to_reuse({"APSIS_BUILD_DIR": ""}) is None
    for changes in ({"CMAKE_BUILD_TYPE": "Debug"}, {"BUILD_SHARED_LIBS": "ON"}, {"CMAKE_HOME_DIRECTORY": str(ROOT)}):
        configured(build, **{"CMAKE_HOME_DIRECTORY": str(tmp_path)} | changes)
        assert setup.folder_to_reuse({}) is None


def calls_of(tmp_path, build, **environment):
    """Runs setup.py and returns its calls of cmake. This cmake writes an empty module into `build` instead of compiling."""
    bin_folder, calls = tmp_path / "bin", tmp_path / "calls"
    bin_folder.mkdir()
    (bin_folder / "cmake").write_text(f"#!/bin/bash\nprintf '%s\\n' \"$*\" >>'{calls}'\nmkdir -p '{build}/python/apsis'\n"
                                      f"touch '{build}/python/apsis/_core{SUFFIX}'\n", encoding="utf-8")
    (bin_folder / "cmake").chmod(0o755)
    clean = {name: value for name, value in os.environ.items() if name not in ("APSIS_BUILD_DIR", "CMAKE_ARGS", "PYTHONPATH")}
    done = subprocess.run([sys.executable, ROOT / "setup.py", "-q", "build_ext", "--build-temp", tmp_path / "temp", "--build-lib",
                           tmp_path / "lib"], cwd=ROOT, text=True, capture_output=True,
                          env=clean | {"PATH": f"{bin_folder}:{os.environ['PATH']}"} | environment)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "lib" / "apsis" / f"_core{SUFFIX}").exists()
    return calls.read_text(encoding="utf-8").splitlines()


def test_a_folder_of_the_program_alone_is_configured_for_the_module_too(tmp_path):
    build = configured(tmp_path / "build", APSIS_PYTHON_PACKAGE="OFF", PYTHON_MODULE_EXTENSION=None)
    assert calls_of(tmp_path, build, APSIS_BUILD_DIR=str(build)) == [
        f"-S {ROOT} -B {build} -DAPSIS_PYTHON_PACKAGE=ON -DPython3_EXECUTABLE={os.path.realpath(sys.executable)}",
        f"--build {build} --target apsis_python"]


def test_a_new_build_leaves_the_choice_of_compilers_to_the_packager(tmp_path):
    first, second = calls_of(tmp_path, tmp_path / "temp", APSIS_BUILD_DIR="", CMAKE_ARGS="-DCMAKE_CXX_COMPILER='my c++' -DA=B")
    assert first.startswith(f"-S {ROOT} -B {tmp_path / 'temp'} ") and first.endswith("-DCMAKE_CXX_COMPILER=my c++ -DA=B")
    assert "-DAPSIS_PREFERRED_COMPILERS=gcc-12;g++-12" in first and "-DAPSIS_WERROR=OFF" in first
    assert second == f"--build {tmp_path / 'temp'} --target apsis_python"
