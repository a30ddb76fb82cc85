"""Runs the steps of the plan."""

import json
import subprocess
import sys
import time
from pathlib import Path

from evaluation import machine, results
from evaluation.plan import FULL, QUICK, Step


def _run_step(step: Step, build: Path, out: Path) -> None:
    result = out / f"{step.name}.json"
    command = [
        str(build / "bench" / step.program),
        f"--benchmark_filter={step.pattern}",
        f"--benchmark_repetitions={step.repetitions}",
        f"--benchmark_min_time={step.seconds}",
        f"--benchmark_out={result}.part",
        "--benchmark_out_format=json",
    ]
    with open(out / f"{step.name}.log", "w", encoding="utf-8") as log:
        subprocess.run(command, stdout=log, stderr=subprocess.STDOUT, check=True)
    part = Path(f"{result}.part")
    # Google Benchmark succeeds even if a benchmark finds that its methods disagree.
    if wrong := results.failures(results.read_file(part)):
        sys.exit(f"\n{step.program} reports: {'; '.join(wrong)}.")
    part.replace(result)


def run(build: Path, out: Path, quick: bool, only: list[str]) -> None:
    """Measures, and leaves NAME.json and NAME.log for each step, and machine.json."""
    out.mkdir(parents=True, exist_ok=True)
    steps = QUICK if quick else FULL
    known = {step.name for step in steps}
    if unknown := set(only) - known:
        sys.exit(f"There is no {', '.join(sorted(unknown))}. "
                 f"Choose from {', '.join(sorted(known))}.")
    if not only:
        # Nothing of an earlier evaluation may stand beside the new figures.
        for old in out.glob("*.json"):
            old.unlink()
    about = machine.describe(build, quick)
    for step in steps:
        if only and step.name not in only:
            continue
        begin = time.monotonic()
        print(f"  {step.name} ...", end=" ", flush=True)
        try:
            _run_step(step, build, out)
        except subprocess.CalledProcessError:
            print()
            sys.exit(f"{step.program} failed; its output is in {out / step.name}.log.")
        print(f"{time.monotonic() - begin:.0f} s", flush=True)
    (out / "machine.json").write_text(json.dumps(about, indent=2) + "\n", encoding="utf-8")
