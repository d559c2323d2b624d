"""install.py BUILD: makes a wheel, installs the package into a new virtual environment, and checks the results. Both are made from the
build folder BUILD, by the commands of docs/linking.md."""
import os
import shutil
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
USE = """
import apsis, pathlib
assert pathlib.Path(apsis.__file__).is_relative_to(pathlib.Path(__import__('sys').prefix)), apsis.__file__
assert (pathlib.Path(apsis.__file__).parent / 'py.typed').exists()
rho = apsis.run('paper/bgk-mixed', 'time.end=0.001').fields['rho']
assert rho.shape[1] == 40 and rho.min() > 0
apsis.run('paper/bgk-mixed', 'time.end=0.001', out='result')
import apsis.report
assert apsis.report.make_report('result').exists()
print(apsis.__version__)
"""
# A cmake that records its calls. A build only lists what would be compiled (-n), since other tests use the folder.
CMAKE = """#!/bin/bash
printf '%s\\n' "$*" >>'{calls}'
case $1 in --build) exec '{cmake}' "$@" -- -n ;; *) exec '{cmake}' "$@" ;; esac
"""


def main(build):
    with tempfile.TemporaryDirectory() as folder:
        source, environment, wheels = Path(folder, "source"), Path(folder, "venv"), Path(folder, "wheels")
        # The sources are copied without build folders, since pip writes build files into its source folder. Only setup.py is a link,
        # since it takes the folder of the file as the sources of BUILD.
        shutil.copytree(ROOT, source, ignore=shutil.ignore_patterns("build", "results", ".git", "__pycache__", "*.egg-info"))
        (source / "setup.py").unlink()
        (source / "setup.py").symlink_to(ROOT / "setup.py")
        calls, cmake = Path(folder, "calls"), Path(folder, "bin", "cmake")
        cmake.parent.mkdir()
        cmake.write_text(CMAKE.format(calls=calls, cmake=shutil.which("cmake")), encoding="utf-8")
        cmake.chmod(0o755)
        subprocess.run([sys.executable, "-m", "venv", "--system-site-packages", environment], check=True)
        python = environment / "bin" / "python"
        clean = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}
        clean |= {"APSIS_BUILD_DIR": str(build), "PATH": f"{cmake.parent}:{os.environ['PATH']}"}
        pip = [python, "-m", "pip", "-q", "--disable-pip-version-check"]
        subprocess.run([*pip, "wheel", "--no-build-isolation", "--no-deps", "-w", wheels, source], check=True, env=clean)
        (wheel,) = wheels.iterdir()
        subprocess.run([*pip, "install", "--no-build-isolation", "--no-index", source], check=True, env=clean)
        # Neither command configures or compiles, since the folder has the module already.
        called = calls.read_text(encoding="utf-8").splitlines()
        assert called == [f"--build {build} --target apsis_python"] * 2, called
        subprocess.run([python, "-c", USE], check=True, env=clean, cwd=folder)
        # The wheel is for this version of Python and contains the files that were installed.
        tag = f"cp{sys.version_info.major}{sys.version_info.minor}"
        assert f"-{tag}-{tag}-linux_" in wheel.name, wheel.name
        files = {name for name in zipfile.ZipFile(wheel).namelist() if name.startswith("apsis/")}
        (installed,) = environment.glob("lib/python*/site-packages/apsis")
        assert files == {f"apsis/{path.relative_to(installed)}" for path in installed.rglob("*")
                         if path.is_file() and "__pycache__" not in path.parts}, files


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve())
