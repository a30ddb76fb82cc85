"""Runs the steps of the plan."""

import json
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

from evaluation import machine, results
from evaluation.plan import FULL, QUICK, Step


def _maps(program: Path, pattern: str) -> list[str]:
    """Patterns for the benchmarks of one map each."""
    listed = subprocess.run([str(program), "--benchmark_list_tests=true",
                             f"--benchmark_filter={pattern}"],
                            capture_output=True, text=True, check=True)
    names = listed.stdout.split()
    by_map: dict[str, list[str]] = {}
    for name in names:
        by_map.setdefault(name.split("/")[1], []).append(name.replace(".", "[.]"))
    return [f"^({'|'.join(of_map)})$" for of_map in by_map.values()]


def _measure(step: Step, program: Path, result: Path) -> None:
    """One round. Each map has a process of its own, so that none inherits memory of another."""
    benchmarks: list[Any] = []
    part = result.with_suffix(".json.part")
    with open(result.with_suffix(".log"), "w", encoding="utf-8") as log:
        for pattern in _maps(program, step.pattern):
            subprocess.run([str(program),
                            f"--benchmark_filter={pattern}",
                            f"--benchmark_repetitions={step.repetitions}",
                            f"--benchmark_min_time={step.seconds}",
                            f"--benchmark_out={part}",
                            "--benchmark_out_format=json"],
                           stdout=log, stderr=subprocess.STDOUT, check=True)
            measured = json.loads(part.read_text(encoding="utf-8"))
            benchmarks += measured["benchmarks"]
    part.write_text(json.dumps({"benchmarks": benchmarks}, indent=1), encoding="utf-8")
    # Google Benchmark succeeds even if a benchmark finds that its methods disagree.
    if wrong := results.failures(results.read_file(part)):
        sys.exit(f"\n{step.program} reports: {'; '.join(wrong)}.")
    part.replace(result)


def _run_step(step: Step, build: Path, out: Path) -> None:
    rounds = [step.name] if step.rounds == 1 else [f"{step.name}-{i + 1}"
                                                   for i in range(step.rounds)]
    for name in rounds:
        _measure(step, build / "bench" / step.program, out / f"{name}.json")
    # Rounds of an earlier evaluation, which had more or fewer.
    for old in [out / f"{step.name}.json", *out.glob(f"{step.name}-[0-9].json")]:
        if old.stem not in rounds:
            old.unlink(missing_ok=True)


def run(build: Path, out: Path, quick: bool, only: list[str]) -> None:
    """Measures, and leaves NAME.json and NAME.log for each step, or NAME-ROUND, and machine.json."""
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
