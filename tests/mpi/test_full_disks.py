"""If one of several processes cannot write a file, all end with one message and exit code 4. Earlier results are kept."""
import shutil
import subprocess

from processes import ENVIRONMENT, PROGRAM, Folder, launched, main, one_of, run

GAS = ("paper/bgk-mixed-fd", "space.cells=60", "velocity.points=80", "time.end=0.004", "output.distribution=end")
OUTPUTS = {
    "solution.h5": (),
    "checkpoint.h5": ("output.checkpoint_every=2",),
    "f-000000000.h5": ("output.distribution=snapshots", "output.every=0.002"),
}
LIMIT = 16384  # bytes; every HDF5 file of the case is longer, and so is the part of each process
LIMITED = 'if [ "$OMPI_COMM_WORLD_RANK" = "$1" ]; then bytes=$2; shift 2; exec prlimit --fsize=$bytes "$@"; else shift 2; exec "$@"; fi'

# Fills a small file system, which only this process has, and lists the files before and after.
FILLED = """
set -e
mount -t tmpfs -o size=$1 none out
shift
"$PROGRAM_ALONE" run "$CASE" space.cells=12 velocity.points=20 time.end=0.004 --out out/results >/dev/null 2>&1
(cd out/results && sha256sum $(ls)) > before
set +e
"$@"
code=$?
(cd out/results && sha256sum $(ls)) > after
ls -A out/results > names
exit $code
"""


def name_space():
    """Returns the command that gives a process its own file systems, or None if this machine forbids it."""
    for words in (["unshare", "--mount", "--propagation", "private"], ["unshare", "--user", "--map-root-user", "--mount"]):
        tried = subprocess.run([*words, "mount", "-t", "tmpfs", "none", "/mnt"], capture_output=True, check=False)
        if tried.returncode == 0:
            return words
    return None


def errors(text):
    return [line for line in text.splitlines() if line.startswith("error:")]


class FullDisks(Folder):
    def contents(self, folder):
        return {path.name: path.read_bytes() for path in sorted((self.folder / folder).iterdir()) if path.is_file()}

    def run_limited(self, rank, count, *arguments):
        return run(launched(count, "sh", "-c", LIMITED, "sh", rank, LIMIT, PROGRAM, *arguments), cwd=self.folder)

    def test_of_each_process_in_turn(self):
        self.completed(1, "run", *GAS[:1], "space.cells=12", "velocity.points=20", "time.end=0.004", "--out", "out")
        before = self.contents("out")
        for number, (name, options) in enumerate(OUTPUTS.items()):
            for rank in one_of(range(3), number):
                with self.subTest(name, rank=rank):
                    done = self.run_limited(rank, 3, "run", *GAS, *options, "--out", "out")
                    self.assertEqual(done.returncode, 4, done.stderr)
                    self.assertEqual(len(errors(done.stderr)), 1, done.stderr)
                    self.assertIn(f"{name}.partial'", errors(done.stderr)[0])
                    who = rf"process {rank} on \S+: " if rank else ""
                    self.assertRegex(errors(done.stderr)[0], rf"\({who}File too large\); free some space or choose another folder$")
                    self.assertEqual(self.contents("out"), before)
                    self.assertEqual(sorted(path.name for path in (self.folder / "out").iterdir()), sorted(before))

    def test_of_a_checkpoint_leaves_the_one_before(self):
        self.completed(2, "run", *GAS, "--out", "out")
        before = self.contents("out")
        done = self.run_limited(1, 2, "run", *GAS[:3], "time.end=0.01", "output.checkpoint_every=1", "--restart", "out/checkpoint.h5", "--out", "out")
        self.assertEqual(done.returncode, 4, done.stderr)
        self.assertEqual(self.contents("out"), before)
        self.completed(3, "run", *GAS[:3], "time.end=0.01", "--restart", "out/checkpoint.h5", "--out", "rest")

    def test_of_a_file_system(self):
        (self.folder / "out").mkdir()
        words = name_space()
        # If no file system can be mounted, the size of files is limited on all processes instead.
        reason = "No space left on device" if words else "File too large"
        environment = {**ENVIRONMENT, "PROGRAM_ALONE": str(PROGRAM), "CASE": GAS[0]}
        filled = FILLED if words else FILLED.replace("mount -t tmpfs", ": mount")
        for name, options in OUTPUTS.items():
            with self.subTest(name):
                program = [str(PROGRAM), "run", *GAS, "space.cells=600", *options, "--out", "out/results"]
                limited = program if words else ["prlimit", f"--fsize={LIMIT}", *program]
                done = run([*(words or ["env"]), "sh", "-c", filled, "sh", "1M", *launched(2, *limited)], cwd=self.folder, env=environment)
                self.assertEqual(done.returncode, 4, done.stderr)
                self.assertEqual(len(errors(done.stderr)), 1, done.stderr)
                self.assertRegex(errors(done.stderr)[0], rf"\.h5\.partial'.*{reason}\); free some space or choose another folder$")
                # All files are unchanged. Only a checkpoint may be newer: one was completed before the file system was full.
                before, after = ([line for line in (self.folder / when).read_text().splitlines()
                                  if name != "checkpoint.h5" or not line.endswith(name)] for when in ("before", "after"))
                self.assertEqual(after, before)
                self.assertNotIn(".partial", (self.folder / "names").read_text())
                shutil.rmtree(self.folder / "out")
                (self.folder / "out").mkdir()


if __name__ == "__main__":
    main()
