#!/usr/bin/env python3
"""Runs the study of methods: designs, then errors against work. It can be interrupted and continued at any time.

    studies/run.py [--apsis PROGRAM] [--out results/study] [--only PART ...]

Each design and each work study has a result file in OUT/design or OUT/work with the output of `apsis design --json` or
`apsis converge --json`. studies/report.py makes tables and pictures from these files.
"""
import argparse
import json
import subprocess
import sys
import time
import tomllib
from pathlib import Path

HERE = Path(__file__).resolve().parent


class StudyError(Exception):
    """A command failed unexpectedly; the message names it."""


def publish(path, text):
    """Writes a result file atomically."""
    temporary = path.with_suffix(".part")
    temporary.write_text(text, encoding="utf-8")
    temporary.replace(path)


def call(command):
    """Runs a command and returns the completed process. Ctrl-C also reaches the program and ends the study."""
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode == 130:
        raise KeyboardInterrupt
    if done.returncode not in (0, 3):
        raise StudyError(f"'{' '.join(map(str, command))}' ended with {done.returncode}: {done.stderr.strip()}")
    return done


def design(apsis, run, folder):
    """Runs a design, unless its result exists. Exit code 3 means that no method was found, which is a result."""
    result_file = folder / f"{run['name']}.json"
    if result_file.exists():
        return False
    args = [str(folder / f"{a[1:]}.toml") if a.startswith("@") else a for a in run["args"].split()]
    starts_from = [a for a in args if a.endswith(".toml")]
    if not all(Path(a).exists() for a in starts_from):
        publish(result_file, json.dumps({"args": run["args"], "found": False, "reason": "nothing to start from"}, indent=2))
        return True
    begin = time.monotonic()
    done = call([apsis, "design", *args, "--time", "100000", "--out", str(folder / f"{run['name']}.toml"), "--json"])
    result = json.loads(done.stdout) if done.stdout.strip() else {"found": False}
    result |= {"args": run["args"], "wall_s": time.monotonic() - begin}
    if not result["found"]:
        result["reason"] = done.stderr.strip().splitlines()[-1]
    publish(result_file, json.dumps(result, indent=2) + "\n")
    return True


def work(apsis, study, methods, folder):
    """Measures errors and costs of a work study, unless its result exists. Runs are sequential, so that they do not share caches."""
    result_file = folder / f"{study['name']}.json"
    if result_file.exists():
        return False
    vary = ["--vary", "time.method=" + ",".join(methods), "--vary", "time.startup=none,graded"]
    if "epsilon" in study:
        vary += ["--vary", "model.epsilon=" + ",".join(study["epsilon"])]
    done = call([apsis, "converge", study["case"], *study.get("keys", []), *vary, "--vary", study["vary"],
                 "--reference", study["reference"], "--norm", study["norm"], "--threads", "1", "--json"])
    publish(result_file, done.stdout)
    return True


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--apsis", default="build/release/app/apsis", help="path of the program")
    parser.add_argument("--out", type=Path, default=Path("results/study"), help="folder of the results")
    parser.add_argument("--only", nargs="*", help="names of designs and work studies; all if not given")
    given = parser.parse_args()
    with open(HERE / "methods.toml", "rb") as file:
        plan = tomllib.load(file)
    jobs = [("design", r["name"], lambda r=r: design(given.apsis, r, given.out / "design"))
            for group in plan["design"] for r in group["runs"]]
    jobs += [("work", s["name"], lambda s=s: work(given.apsis, s, plan["work"]["methods"], given.out / "work"))
             for s in plan["work"]["study"]]
    names = [name for _, name, _ in jobs]
    unknown = [name for name in given.only or [] if name not in names]
    if unknown:
        sys.exit(f"error: no design or work study '{unknown[0]}' (there are: {', '.join(names)})")
    for kind in ("design", "work"):
        (given.out / kind).mkdir(parents=True, exist_ok=True)
    wanted = [job for job in jobs if not given.only or job[1] in given.only]
    for k, (kind, name, run) in enumerate(wanted, 1):
        begin = time.monotonic()
        print(f"[{k}/{len(wanted)}] {kind} {name} ", end="", flush=True)
        print(f"{time.monotonic() - begin:.0f} s" if run() else "exists", flush=True)


if __name__ == "__main__":
    try:
        main()
    except KeyboardInterrupt:
        sys.exit(130)
    except StudyError as problem:
        sys.exit(f"error: {problem}")
