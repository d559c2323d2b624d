"""install.py BUILD: pip install . into a new virtual environment with the compiled module of BUILD, and a check of the result.
This is the installation of docs/linking.md."""
import os
import shutil
import subprocess
import sys
import tempfile
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


def main(build):
    with tempfile.TemporaryDirectory() as folder:
        source, environment = Path(folder, "source"), Path(folder, "venv")
        # A copy without build folders, since pip writes build files into its source folder.
        shutil.copytree(ROOT, source, ignore=shutil.ignore_patterns("build", "results", ".git", "__pycache__", "*.egg-info"))
        subprocess.run([sys.executable, "-m", "venv", "--system-site-packages", environment], check=True)
        python = environment / "bin" / "python"
        clean = {key: value for key, value in os.environ.items() if key != "PYTHONPATH"} | {"APSIS_COMPILED": str(build)}
        subprocess.run([python, "-m", "pip", "install", "-q", "--no-build-isolation", "--no-index", source], check=True, env=clean)
        subprocess.run([python, "-c", USE], check=True, env=clean, cwd=folder)


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve())
