"""The gallery of the site: every built-in case with a picture, a sentence, its command and its time.

A case is drawn from its small version: the case itself if it is cheap, otherwise with fewer cells, in the same domain to the same
time. A case that ends in a steady state is drawn from the iteration to it, and an expensive flow past bodies too if it settles.
Results are kept in WORK and made anew only if the program or a case has changed.
"""
import concurrent.futures
import dataclasses
import hashlib
import json
import os
import re
import shutil
import subprocess
from pathlib import Path

from reference import Program, plain

BUDGET = 8e9  # evaluations of unknowns in stages: a minute of one core, or two
STAGES = 10  # of a step, at most
LIMIT = 900  # seconds of a run, with a margin for loaded machines
FEWEST = 12  # cells of a direction that small versions have at least, where the case has as many
FIELDS = (["T", "u_x", "u_y"], ["rho", "u", "T"])  # of gases; other models draw their own
FOLDERS = {"gas": "Gas flows", "laws": "Conservation laws", "paper": "Problems of the paper", "benchmarks": "Benchmarks"}


class GalleryError(Exception):
    """A case has no picture."""


@dataclasses.dataclass
class Entry:
    """A case, the changes that make it small, and what its run needed."""

    name: str
    description: str
    changes: list[str]
    seconds: float
    picture: Path


def expected_cost(log: str) -> float:
    """Returns the evaluations of unknowns in stages that the first lines of a log promise, 0 without a number of steps."""
    steps = re.search(r"about (\d+) steps", log)
    size = re.search(r"\((\d+(?: x \d+)*) cells x (\d+) unknowns\)", log)
    if not steps or not size:
        return 0.0
    cost = float(steps[1]) * float(size[2]) * STAGES
    for cells in size[1].split(" x "):
        cost *= int(cells)
    return cost


def fewer_cells(cells: list[int], cost: float) -> list[int]:
    """Returns numbers of cells of the same shape for which a run costs BUDGET: a step of half the length for twice the cells."""
    factor = min(1.0, (BUDGET / cost) ** (1.0 / (len(cells) + 1)))
    factor = max(factor, min(1.0, FEWEST / min(cells)))
    return [2 * max(1, round(n * factor / 2)) if factor < 1.0 else n for n in cells]


class Gallery:
    """Runs and draws cases with one program."""

    def __init__(self, program: Path, work: Path):
        self.program, self.work = program, work
        self.version = hashlib.sha256(program.read_bytes() + Path(__file__).read_bytes()).hexdigest()

    def call(self, *words: str) -> subprocess.CompletedProcess:
        return subprocess.run([self.program, *map(str, words)], text=True, capture_output=True)

    def versions(self, name: str) -> list[list[str]]:
        """Returns changes of a case, to be tried in this order: the last one gives a result, if only that of the whole case."""
        probe = self.call("run", name, "--wall", "0.01", "--threads", "1", "--json")  # stops after its first steps
        if not probe.stdout:
            raise GalleryError(f"apsis run {name} fails: {probe.stderr.strip()[-400:]}")
        result = json.loads(probe.stdout)
        case, fields = result["case"], next((fields for fields in FIELDS if set(fields) <= result["fields"].keys()), [])
        given = case.get("output", {}).get("fields")  # the case selects its own
        chosen = [f"output.fields={json.dumps(fields, separators=(',', ':'))}"] if fields and not given else []
        if case.get("time", {}).get("steady"):
            return [["steady.tolerance=1e-6", *chosen]]
        if (cost := expected_cost(probe.stderr)) <= BUDGET:
            return [chosen]
        cells = case["space"]["cells"]
        cells = fewer_cells(cells if isinstance(cells, list) else [cells], cost)
        smaller = "space.cells=" + (str(cells[0]) if len(cells) == 1 else f"[{','.join(map(str, cells))}]")
        # The wake of a body on an axis is nearly empty, and settles with the limiter.
        on_axis = ["space.limiter=positivity"] if case["space"].get("geometry") == "axisymmetric" else []
        settled = [["steady.tolerance=1e-3", *on_axis]] if case["space"].get("body") else []
        # The whole case is the last resort: on coarser meshes the steps of an explicit method may no longer resolve ε.
        return [*([*change, *chosen] for change in (*settled, [smaller])), chosen]

    def run(self, name: str, changes: list[str], folder: Path) -> float:
        """Runs a case and returns its CPU time in seconds, which hardly depends on other programs. Raises GalleryError."""
        words = [self.program, "run", name, *changes, "--threads", "1", "--wall", str(LIMIT), "--out", folder]
        process = subprocess.Popen(words, text=True, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        with process.stderr:
            log = process.stderr.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if status != 0:
            raise GalleryError(f"apsis run {name} {' '.join(changes)} fails: {log.strip()[-400:]}")
        return usage.ru_utime + usage.ru_stime

    def run_first(self, name: str, versions: list[list[str]], folder: Path) -> tuple[list[str], float]:
        """Runs the first version that leads to a result; returns it with its time. Raises GalleryError."""
        for version in versions[:-1]:
            try:
                return version, self.run(name, version, folder)
            except GalleryError:
                shutil.rmtree(folder, ignore_errors=True)
        return versions[-1], self.run(name, versions[-1], folder)

    def make(self, name: str, description: str) -> Entry:
        """Runs and draws a case, or returns the entry of an earlier build. Raises GalleryError."""
        folder = self.work / name.replace("/", "-")
        key = hashlib.sha256((self.version + self.call("show", name).stdout).encode()).hexdigest()
        kept = folder / "gallery.json"
        if kept.is_file() and (known := json.loads(kept.read_text(encoding="utf-8")))["key"] == key:
            return Entry(name, description, known["changes"], known["seconds"], folder / known["picture"])
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        changes, seconds = self.run_first(name, self.versions(name), folder / "run")
        drawn = self.call("plot", folder / "run", "--out", folder)
        pictures = sorted(folder.glob("*.png"), key=lambda path: (path.stem != "fields", path.name))
        if drawn.returncode != 0 or not pictures:
            raise GalleryError(f"{name} {' '.join(changes)}: {drawn.stderr.strip()[-400:] or 'no picture'}")
        kept.write_text(json.dumps({"key": key, "changes": changes, "seconds": seconds, "picture": pictures[0].name}), encoding="utf-8")
        shutil.rmtree(folder / "run")
        return Entry(name, description, changes, seconds, folder / pictures[0].name)


def command(entry: Entry) -> str:
    """Returns the command that repeats the run, quoted for a shell."""
    words = [f"'{change}'" if re.search(r"[\[\"]", change) else change for change in entry.changes]
    return " ".join(["apsis run", entry.name, *words])


def page(entries: list[Entry]) -> str:
    text = ("# Gallery\n\nEvery built-in case, drawn by `apsis plot` from the command beside it. Expensive cases have fewer cells here than "
            "`apsis run NAME` gives them, or are steady states found by iteration. Times are CPU times of one thread, measured while "
            "this page was made.\n\n")
    for folder, title in FOLDERS.items():
        text += f"## {title}\n\n"
        for entry in (entry for entry in entries if entry.name.startswith(folder + "/")):
            text += (f"### {entry.name}\n\n{plain(entry.description)} ([case](reference/cases.md#{entry.name.replace('/', '')})).\n\n"
                     f"```sh\n{command(entry)}\n```\n\n![{plain(entry.description)}](images/{picture_name(entry)})\n\n"
                     f"*{entry.seconds:.2g} s.*\n\n")
    return text


def picture_name(entry: Entry) -> str:
    return f"gallery-{entry.name.replace('/', '-')}.png"


def write_gallery(program: Path, work: Path, images: Path, only: list[str] | None = None) -> str:
    """Makes all pictures, or those of some cases, copies them to a folder, and returns the page. Raises GalleryError."""
    gallery = Gallery(program, work)
    cases = Program(program).list("cases")
    missing = {case["name"].partition("/")[0] for case in cases} - FOLDERS.keys()
    if missing:
        raise GalleryError(f"no title for {', '.join(sorted(missing))}: add it to FOLDERS of docs/gallery.py")
    if only is not None:
        cases = [case for case in cases if case["name"] in only]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        entries = list(pool.map(lambda case: gallery.make(case["name"], case["description"]), cases))
    for entry in entries:
        shutil.copy(entry.picture, images / picture_name(entry))
    return page(entries)
