"""The tables of docs/results/performance.md and docs/results/ablation.md. Each function returns "" if there are no
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


def _ratio(over: float | None, under: float | None) -> str:
    return number(over / under) if over is not None and under else MISSING


def extraction(runs: list[Run]) -> str:
    """Both engines with one thread; what a second thread gives, and memory, of the atlas engine."""
    found = {(run.map, run.engine, run.threads): run for run in select(runs, "extract")}
    rows = []
    for (name, engine, threads), atlas in found.items():
        if engine != "atlas" or threads != 1:
            continue
        propeller = found.get((name, "propeller", 1))
        two = found.get((name, "atlas", 2))
        peak = atlas.get("peak_bytes")
        rows.append([name, f"{atlas['tets']:,.0f}", number(atlas.density),
                     number(propeller["ms"] if propeller else None), number(atlas["ms"]),
                     _ratio(propeller["ms"] if propeller else None, atlas["ms"]),
                     number(_ns_per("tets")(atlas)), number(_ns_per("hexes")(atlas)),
                     _ratio(atlas["ms"], two["ms"] if two else None),
                     number(_bytes_per_hex(atlas)), _ratio(peak, atlas["bytes_of_result"]),
                     number(atlas["ratio_to_yardstick"])])
    if not rows:
        return ""
    return table(["map", "tets", "hexes per tet", "propeller: ms", "atlas: ms", "times as fast",
                  "ns per tet", "ns per hex", "two threads: times as fast", "bytes per hex",
                  "memory / result", "time / copy"], rows)


def stages(runs: list[Run]) -> str:
    """Of the atlas engine with one thread, ns per tet."""
    single = select(runs, "extract", engine="atlas", threads="1")
    if not single:
        return ""
    names = _merged(run.stages for run in single)
    rows = []
    for run in single:
        times = run.stages
        cells = [times[name] * 1e9 / run["tets"] if name in times else None for name in names]
        rows.append([run.map, *map(number, cells)])
    return table(["ns per tet", *names], rows)


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
             number(run["vertex_seconds"] * 1e9 / run["hexes"]), number(run["seconds"] * 1e3)]
            for run in found]
    return table(["epsilon", "vertices: ms", "vertices: ns per hex", "extraction: ms"],
                 rows)


def _by_method(runs: list[Run], family: str) -> dict[tuple[str, int], dict[str, Run]]:
    places: dict[tuple[str, int], dict[str, Run]] = {}
    for run in select(runs, family):
        places.setdefault((run.map, run.scale), {})[run.keys["method"]] = run
    return dict(sorted(places.items()))


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


def curved(runs: list[Run]) -> str:
    """Arcs and patches beside an extraction without them, with one thread."""
    rows = [[run.map, f"{run['hexes']:,.0f}", number(run["arcs_to_extraction"]),
             number(run["ns_per_arc_point"]), number(run["patches_to_extraction"]),
             number(run["ns_per_polygon"])]
            for run in select(runs, "arcs_and_patches", engine="atlas", threads="1")]
    if not rows:
        return ""
    return table(["map", "hexes", "arcs / extraction", "ns per arc point", "patches / extraction",
                  "ns per polygon"], rows)


# What io_bench calls its benchmarks, and the columns that they fill.
DIRECTIONS = {"write_map_": "map out", "read_map_": "map in", "write_": "mesh out",
              "copy_in_pieces_to_": "mesh in pieces", "read_": "mesh in"}


def files(runs: list[Run]) -> str:
    """MB per second of each format and direction, with one thread; and beside a plain write."""
    rates: dict[str, dict[str, Run]] = {}
    for run in runs:
        if run.error or run.threads != 1:
            continue
        prefix = next((one for one in DIRECTIONS if run.family.startswith(one)), None)
        if prefix:
            name = run.family[len(prefix):]
            rates.setdefault(name, {})[DIRECTIONS[prefix]] = run
    columns = ("map out", "map in", "mesh out", "mesh in pieces", "mesh in")
    rows = []
    for name, found in rates.items():
        written = found.get("mesh out") or found.get("map out")
        rows.append([name, *(number(found[column]["bytes_per_second"] * 1e-6)
                             if column in found else MISSING for column in columns),
                     number(written.get("ratio_to_plain_write") if written else None)])
    if not rows:
        return ""
    return table(["MB per second", *columns, "time of writing / plain write"], rows)


def ways(runs: list[Run]) -> str:
    """Whole runs into files: of the mesh in memory, in pieces, in parts; and beside a plain write."""
    rows = []
    for memory in select(runs, "ways", way="memory"):
        stream, parts = (next(iter(select(runs, "ways", way=way, threads=str(memory.threads))), None)
                         for way in ("stream", "parts64"))
        row = [str(memory.threads), number(memory["plain_write_seconds"]),
               number(memory["writing_seconds"]),
               _ratio(memory["writing_seconds"], memory["plain_write_seconds"]),
               number(memory["ms"] * 1e-3), number(memory["peak_bytes"] * 1e-6)]
        for run in (stream, parts):
            row += [number(run["ms"] * 1e-3 if run else None), _ratio(run["ms"] if run else None, memory["ms"]),
                    number(run["peak_bytes"] * 1e-6 if run else None)]
        rows.append(row)
    return table(["threads", "plain write: s", "writing: s", "writing / plain", "whole run: s", "MB",
                  "stream: s", "stream / whole", "MB", "64 parts: s", "parts / whole", "MB"],
                 rows) if rows else ""


def _by_threads(runs: list[Run], family: str) -> list[tuple[Run, Run | None]]:
    """With one thread, and with two."""
    found = select(runs, family)
    two = {run.map: run for run in found if run.threads == 2}
    return [(run, two.get(run.map)) for run in found if run.threads == 1]


def _times_as_fast(one: Run, two: Run | None, name: str) -> str:
    return _ratio(one[name], two[name] if two else None)


def checks(runs: list[Run]) -> str:
    """Verification, and quality with certificates, beside the extraction of the same run."""
    rows = [[one.map, number(one.density), number(one["extraction_seconds"] * 1e3),
             number(one["verification_seconds"] * 1e9 / one["hexes"]),
             number(one["quality_seconds"] * 1e9 / one["hexes"]),
             _ratio(one["verification_seconds"], one["extraction_seconds"]),
             _ratio(one["quality_seconds"], one["extraction_seconds"]),
             _times_as_fast(one, two, "verification_seconds"),
             _times_as_fast(one, two, "quality_seconds")]
            for one, two in _by_threads(runs, "check")]
    return table(["map", "hexes per tet", "extraction: ms", "verification: ns per hex",
                  "quality: ns per hex", "verification / extraction", "quality / extraction",
                  "verification, two threads: times as fast",
                  "quality, two threads: times as fast"], rows) if rows else ""


def commands(runs: list[Run]) -> str:
    """Whole runs of the command beside what they cannot do without."""
    rows = [[one.map, number(one["extraction_seconds"] * 1e3),
             number(one["plain_write_seconds"] * 1e3), number(one["ms"]),
             number(one["ratio_to_both"]), number(one["peak_bytes"] * 1e-6),
             _ratio(one["peak_bytes"], one["bytes_of_mesh_and_map"]),
             _times_as_fast(one, two, "ms")]
            for one, two in _by_threads(runs, "command")]
    return table(["map", "extraction: ms", "plain write: ms", "whole run: ms",
                  "whole run / both", "peak: MB", "peak / (mesh + map)",
                  "two threads: times as fast"], rows) if rows else ""


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


def beside_reference(runs: list[Run]) -> str:
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
