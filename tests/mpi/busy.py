"""Busy loops, as other work on the machine."""
import contextlib
import subprocess
import sys


@contextlib.contextmanager
def busy_loops(count):
    # A loop ends when this process has ended in any way.
    text = "import os\nparent = os.getppid()\nwhile os.getppid() == parent: pass"
    loops = [subprocess.Popen([sys.executable, "-c", text]) for _ in range(count)]
    try:
        yield
    finally:
        for loop in loops:
            loop.kill()
            loop.wait()
