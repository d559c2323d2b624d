"""Blocks of the documentation that take minutes: `make run` of README.md in a copy of the sources, and every block that names
this test (docs/design.md, docs/models.md, docs/space.md)."""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
BUILD = Path(os.environ.get("APSIS_BUILD", ROOT / "build" / "release"))
NAME = str(Path(__file__).resolve().relative_to(ROOT))
sys.path.insert(0, str(ROOT / "docs"))
import execute  # noqa: E402


class Long(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.work = Path(holder.name)

    def test_blocks_of_minutes(self):
        execute.LIMIT = 1200
        tools, ran = execute.Tools(BUILD, self.work), 0
        for page in (execute.Page(p, ROOT, tools) for pattern in execute.PAGES for p in ROOT.glob(pattern)):
            page.folder.mkdir(parents=True)
            for block in execute.read_blocks(page.text):
                if block.marks.get("elsewhere") == NAME and block.marks.get("needs") not in tools.lacking:
                    page.run_shell(block, page.folder / "out")
                    ran += 1
        self.assertGreater(ran, 0)

    def test_make_run_from_the_sources_alone(self):
        source = self.work / "apsis"
        shutil.copytree(ROOT, source, ignore=shutil.ignore_patterns("build", "results", ".git", "__pycache__"))
        subprocess.run(["make", "-C", source, "run"], check=True, stdout=subprocess.DEVNULL)
        self.assertTrue((source / "results" / "bgk-mixed.png").exists())
        # The next step of README.md is the installation of the library from this build.
        prefix = self.work / "prefix"
        subprocess.run(["cmake", "--install", source / "build" / "release", "--prefix", prefix], check=True, stdout=subprocess.DEVNULL)
        self.assertTrue((prefix / "bin" / "apsis").exists())
        self.assertEqual(len(list(prefix.rglob("apsisConfig.cmake"))), 1)


if __name__ == "__main__":
    unittest.main()
