"""What Google Benchmark measured, as medians over the repetitions of each benchmark."""

import json
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median
from typing import Any

MILLISECONDS = {"ns": 1e-6, "us": 1e-3, "ms": 1.0, "s": 1e3}
STAGE_PREFIX = "stage "
TOO_LARGE = "not enough memory for this scale"  # as bench/extract_bench.cpp says


@dataclass
class Run:
    """One benchmark: FAMILY/MAP/KEY:VALUE/... and the medians of its figures."""

    family: str
    map: str
    keys: dict[str, str]
    values: dict[str, float] = field(default_factory=dict)
    spread: float = 0.0  # (largest - smallest time) / median
    error: str = ""

    def __getitem__(self, name: str) -> float:
        return self.values[name]

    def get(self, name: str) -> float | None:
        return self.values.get(name)

    @property
    def name(self) -> tuple[str, ...]:
        return (self.family, self.map, *(f"{key}:{value}" for key, value in self.keys.items()))

    @property
    def engine(self) -> str:
        return self.keys.get("engine", "")

    @property
    def threads(self) -> int:
        return int(self.keys.get("threads", "1"))

    @property
    def scale(self) -> int:
        return int(self.keys.get("scale", "1"))

    @property
    def density(self) -> float:
        """Hexahedra per tet."""
        return self["hexes"] / self["tets"]

    @property
    def stages(self) -> dict[str, float]:
        """Seconds by stage, in the order in which the stages ran."""
        names = sorted(name for name in self.values if name.startswith(STAGE_PREFIX))
        return {name.split(": ", 1)[1]: self.values[name] for name in names}


def _parse_name(name: str) -> Run:
    """extract/sphere_blocks_low/engine:atlas/threads:1/manual_time and the like."""
    parts = name.split("/")
    keys = dict(part.split(":", 1) for part in parts[2:] if ":" in part)
    return Run(parts[0], parts[1], keys)


def _numbers(entry: dict[str, Any]) -> dict[str, float]:
    numbers = {key: float(value) for key, value in entry.items()
               if isinstance(value, (int, float)) and not isinstance(value, bool)}
    unit = MILLISECONDS[entry["time_unit"]]
    numbers["ms"] = numbers.pop("real_time") * unit
    return numbers


def _combine(name: str, entries: list[dict[str, Any]]) -> Run:
    run = _parse_name(name)
    run.error = next((entry["error_message"] for entry in entries
                      if entry.get("error_occurred")), "")
    if run.error:
        return run
    figures = [_numbers(entry) for entry in entries]
    run.values = {key: median(one[key] for one in figures) for key in figures[0]}
    times = [one["ms"] for one in figures]
    run.spread = (max(times) - min(times)) / run["ms"] if run["ms"] > 0 else 0.0
    return run


def read_file(path: Path) -> list[Run]:
    with open(path, encoding="utf-8") as file:
        entries = json.load(file)["benchmarks"]
    by_name: dict[str, list[dict[str, Any]]] = {}
    for entry in entries:
        if entry.get("run_type", "iteration") == "iteration":
            by_name.setdefault(entry["run_name"], []).append(entry)
    return [_combine(name, repetitions) for name, repetitions in by_name.items()]


def _quietest(runs: Iterable[Run]) -> list[Run]:
    """Of the rounds of each benchmark the one in which cores made the most additions.

    They are counted right behind each repetition, by a loop that has nothing to do with what is
    measured: so the choice is by what else there was to do for the machine, not by the result.
    """
    best: dict[tuple[str, ...], Run] = {}
    for run in runs:
        known = best.setdefault(run.name, run)
        if run.values.get("additions_per_ns", 0) > known.values.get("additions_per_ns", 0):
            best[run.name] = run
    return list(best.values())


def read_folder(folder: Path) -> list[Run]:
    """All results but the description of the machine; of rounds the quietest."""
    runs: list[Run] = []
    for path in sorted(folder.glob("*.json")):
        if path.stem != "machine":
            runs += read_file(path)
    return _quietest(runs)


def select(runs: Iterable[Run], family: str, **keys: str) -> list[Run]:
    """The successful runs of a family whose keys have the given values."""
    return [run for run in runs if run.family == family and not run.error
            and all(run.keys.get(key) == value for key, value in keys.items())]


def failures(runs: Iterable[Run]) -> list[str]:
    """What went wrong, beyond scales that are too large for this machine."""
    return [f"{run.family}/{run.map}: {run.error}" for run in runs
            if run.error and run.error != TOO_LARGE]
