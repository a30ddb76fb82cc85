"""The tables of docs/performance.md and docs/ablation.md. Each function returns "" if there are no
figures for it."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from statistics import geometric_mean

from evaluation.markdown import MISSING, number, table
from evaluation.results import Run, select

ENGINES = ("atlas", "propeller")


def _merged(sequences: Iterable[Iterable[str]]) -> list[str]:
    """All names once, those that only some sequences have behind the one before them there."""
    names: list[str] = []
    for sequence in sequences:
        place = 0
        for name in sequence:
            if name not in names:
                names.insert(place, name)
            place = names.index(name) + 1
    return names


def _ns_per(count: str) -> Callable[[Run], float]:
    return lambda run: run["seconds"] * 1e9 / run[count]


def _bytes_per_hex(run: Run) -> float | None:
    peak = run.get("peak_bytes")
    return peak / run["hexes"] if peak else None


def extraction(runs: list[Run], engine: str) -> str:
    rows = []
    for run in select(runs, "extract", engine=engine):
        peak = run.get("peak_bytes")
        rows.append([run.map, str(run.threads), f"{run['tets']:,.0f}",
                     f"{run['hexes'] * 1e-6:.3g}",
                     number(run.density), number(run["ms"]), number(run["seconds_of_first"] * 1e3),
                     number(_ns_per("tets")(run)), number(_ns_per("hexes")(run)),
                     number(_bytes_per_hex(run)),
                     number(peak / run["bytes_of_result"] if peak else None),
                     number(run["ratio_to_yardstick"]), number(run.get("additions_per_ns"))])
    if not rows:
        return ""
    return table(["map", "threads", "tets", "million hexes", "hexes per tet", "ms", "first: ms",
                  "ns per tet", "ns per hex", "bytes per hex", "memory / result", "time / copy",
                  "additions / ns"], rows)


LONG = 100.0  # ms: what is worth a second thread


def threads(runs: list[Run]) -> str:
    """How many times as fast several threads are, beside what arithmetic alone gains by them."""
    found = {(run.map, run.engine, run.threads): run for run in select(runs, "extract")}
    rows = []
    for (name, engine, count), run in found.items():
        one = found.get((name, engine, 1))
        if count == 1 or engine != "atlas" or one is None or one["ms"] < LONG:
            continue
        together, alone = (run.get(f"additions_per_ns{which}") for which in ("", "_alone"))
        rows.append([name, str(count), number(one["ms"]), number(run["ms"]),
                     number(one["ms"] / run["ms"]),
                     number(count * together / alone) if together and alone else MISSING])
    if not rows:
        return ""
    return table(["map", "threads", "one thread: ms", "all: ms", "times as fast",
                  "of additions: times as many"], rows)


def stages(runs: list[Run], engine: str, unit: str) -> str:
    """@param unit  "tet" or "hex\""""
    single = select(runs, "extract", engine=engine, threads="1")
    if not single:
        return ""
    names = _merged(run.stages for run in single)
    rows = []
    for run in single:
        count = run["tets" if unit == "tet" else "hexes"]
        times = run.stages
        cells = [times[name] * 1e9 / count if name in times else None for name in names]
        rows.append([run.map, *map(number, cells)])
    return table([f"ns per {unit}", *names], rows)


def engines(runs: list[Run]) -> str:
    """Both engines side by side."""
    found = {(run.map, run.threads, run.engine): run for run in select(runs, "extract")}
    rows = []
    for (name, threads, engine), atlas in found.items():
        propeller = found.get((name, threads, "propeller"))
        if engine != "atlas" or propeller is None:
            continue
        memory = [propeller.get("peak_bytes"), atlas.get("peak_bytes")]
        rows.append([name, str(threads), number(propeller["ms"]), number(atlas["ms"]),
                     number(propeller["ms"] / atlas["ms"]),
                     number(memory[0] / memory[1]) if memory[0] and memory[1] else MISSING])
    if not rows:
        return ""
    return table(["map", "threads", "propeller: ms", "atlas: ms", "times as fast",
                  "times less memory"], rows)


def scales(runs: list[Run]) -> str:
    """The paper's Table 5."""
    by_place: dict[tuple[str, int], dict[str, Run]] = {}
    skipped = []
    for run in (run for run in runs if run.family == "scale"):
        if run.error:
            skipped.append(f"`{run.map}` at scale {run.scale} ({run.engine}): {run.error}")
        else:
            by_place.setdefault((run.map, run.scale), {})[run.engine] = run
    if not by_place:
        return ""
    text = table(["map", "scale", "hexes", "hexes per tet", "propeller: ms", "atlas: ms",
                  "atlas / propeller", "copy: ms", "propeller: ns per hex", "atlas: ns per hex",
                  "propeller: bytes per hex", "atlas: bytes per hex"],
                 [_scale_row(*place, pair) for place, pair in sorted(by_place.items())])
    return text + "".join(f"\nLeft out: {line}.\n" for line in skipped)


def _scale_row(name: str, scale: int, pair: dict[str, Run]) -> list[str]:
    one = next(iter(pair.values()))

    def of(engine: str, value: Callable[[Run], float | None]) -> str:
        return number(value(pair[engine])) if engine in pair else MISSING

    ratio = MISSING
    if len(pair) == 2:
        ratio = f"{pair['atlas']['seconds'] / pair['propeller']['seconds']:.1%}"
    return [name, str(scale), f"{one['hexes']:,.0f}", number(one.density),
            *(of(engine, lambda run: run["ms"]) for engine in reversed(ENGINES)), ratio,
            number(one["seconds_of_copy"] * 1e3),
            *(of(engine, _ns_per("hexes")) for engine in reversed(ENGINES)),
            *(of(engine, _bytes_per_hex) for engine in reversed(ENGINES))]


def epsilon(runs: list[Run]) -> str:
    """The paper's Figure 19."""
    found = select(runs, "epsilon")
    if not found:
        return ""
    rows = [["infinity" if run.keys["epsilon"] == "inf" else run.keys["epsilon"],
             number(run["vertex_seconds"] * 1e3),
             number(run["vertex_seconds"] * 1e9 / run["hexes"]), number(run["seconds"] * 1e3),
             f"{run['fallbacks']:.0f} of {run['extractions']:.0f}"] for run in found]
    return table(["epsilon", "vertices: ms", "vertices: ns per hex", "extraction: ms",
                  "started over"], rows)


def _by_method(runs: list[Run], family: str) -> dict[tuple[str, int], dict[str, Run]]:
    places: dict[tuple[str, int], dict[str, Run]] = {}
    for run in select(runs, family):
        places.setdefault((run.map, run.scale), {})[run.keys["method"]] = run
    return dict(sorted(places.items()))


def _ratio(over: float | None, under: float | None) -> str:
    return number(over / under) if over is not None and under else MISSING


def rasterization(runs: list[Run]) -> str:
    """The paper's Figure 22."""
    rows = []
    for (name, scale), methods in _by_method(runs, "rasterization").items():
        one = next(iter(methods.values()))
        box, enlarged, lines = (methods[m]["ms"] if m in methods else None
                                for m in ("box", "epsilon", "lines"))
        rows.append([name, str(scale), f"{one['points']:,.0f}",
                     number(one["points"] / one["tets"]), number(box), number(enlarged),
                     number(lines), _ratio(box, enlarged), _ratio(box, lines)])
    if not rows:
        return ""
    return table(["map", "scale", "points", "points per tet", "bounding box: ms", "epsilon: ms",
                  "lines: ms", "box / epsilon", "box / lines"], rows)


def lookup(runs: list[Run]) -> str:
    """The paper's Table 6."""
    rows = []
    for (name, scale), methods in _by_method(runs, "lookup").items():
        one = next(iter(methods.values()))
        by_table, by_hash, by_list = (
            methods[m]["ms"] * 1e6 / methods[m]["queries"] if m in methods else None
            for m in ("table", "hash", "list"))
        rows.append([name, str(scale), number(one["points"] / one["tets"]), number(by_table),
                     number(by_hash), number(by_list), _ratio(by_hash, by_table),
                     _ratio(by_list, by_table)])
    if not rows:
        return ""
    return table(["map", "scale", "points per tet", "table: ns", "hash: ns", "list: ns",
                  "hash / table", "list / table"], rows)


def ablation(runs: list[Run]) -> str:
    """What whole extractions take without a special path, as a share of what they take with it."""
    found = select(runs, "ablation")
    by_map: dict[str, dict[str, Run]] = {}
    for run in found:
        by_map.setdefault(run.map, {})[run.keys["switch"]] = run
    switches = list(dict.fromkeys(run.keys["switch"] for run in found))
    if not by_map:
        return ""

    def cell(run: Run | None) -> str:
        return f"{run['cpu_ratio']:.3f}" if run else MISSING

    rows = [[name, number(next(iter(of_map.values())).density),
             *(cell(of_map.get(switch)) for switch in switches)]
            for name, of_map in by_map.items()]
    mean = [f"{geometric_mean([run['cpu_ratio'] for run in found if run.keys['switch'] == switch]):.3f}"
            for switch in switches]
    return table(["map", "hexes per tet", *switches],
                 [*rows, ["geometric mean", MISSING, *mean]])


EXTRACTIONS = ("extract", "scale", "density", "epsilon", "rasterization", "lookup", "ablation")


def others(runs: list[Run]) -> str:
    """Quality, verification, files."""
    rows = []
    for run in (run for run in runs if run.family not in EXTRACTIONS and not run.error):
        rows.append([run.family, run.map, str(run.threads), number(run["ms"]),
                     number(run["bytes_per_second"] * 1e-6),
                     number(run.get("ratio_to_plain_write")),
                     number(run.get("ratio_to_extraction"))])
    if not rows:
        return ""
    return table(["what", "map", "threads", "ms", "MB/s", "time / plain write",
                  "time / extraction"], rows, texts=2)


@dataclass(frozen=True)
class Reference:
    """A figure of the reference implementation, one core, as this project was given it."""

    map: str
    figure: str
    value: float
    measured: Callable[[Run], float | None]  # ours, of the same kind


REFERENCES = (
    Reference("s17c_sphere_r100_x2", "ns per hex", 2400, _ns_per("hexes")),
    Reference("s17c_sphere_r100_x2", "bytes per hex", 620, _bytes_per_hex),
    Reference("rockerarm_x8", "ns per hex", 6000, _ns_per("hexes")),
    Reference("s17c_sphere_r10_x1", "ns per hex", 6000, _ns_per("hexes")),
    Reference("s17c_sphere_r0.1_x1", "ns per tet", 10600, _ns_per("tets")),
)


def orientation(runs: list[Run]) -> str:
    """Both engines beside the reference implementation."""
    found = {(run.map, run.engine): run for run in select(runs, "extract", threads="1")}
    rows = []
    for reference in REFERENCES:
        atlas, propeller = (reference.measured(found[reference.map, engine])
                            if (reference.map, engine) in found else None for engine in ENGINES)
        if atlas is None and propeller is None:
            continue
        rows.append([reference.map, reference.figure, number(reference.value), number(propeller),
                     number(atlas), _ratio(reference.value, atlas)])
    if not rows:
        return ""
    return table(["map", "figure", "reference", "propeller", "atlas", "reference / atlas"], rows,
                 texts=2)


def machine(about: dict[str, str]) -> str:
    return table(["", ""], [[key, value] for key, value in about.items()], texts=2)


def spread(runs: list[Run]) -> str:
    """How far repetitions of one benchmark lie apart: a sign of other work on the machine."""
    spreads = sorted(run.spread for run in runs if not run.error and run.spread > 0)
    if not spreads:
        return "Every benchmark ran once, so nothing is known about its spread.\n"
    middle = spreads[len(spreads) // 2]
    return (f"The slowest and the fastest repetition of one benchmark lie {middle:.0%} of the "
            f"median apart (median over all benchmarks), {spreads[-1]:.0%} at worst.\n")
