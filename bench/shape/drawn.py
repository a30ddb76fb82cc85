#!/usr/bin/env python3
"""What `hexhex mesh` makes of random parts (bench/shape/solids.py): the tables of docs/results/any-part.md.

    PYTHONPATH=bench:bench/improve bench/shape/drawn.py HEXHEX --seeds 0:50 [--sizes coarse] [--folder build/drawn] [--seconds 60] [--docs docs/results]

Draws the part of each seed, fills it with tets of two sizes, and asks for about as many cells as tets of that size
usually want. A mesh that the command writes is judged by bench/shape/judge.py, which shares nothing with it. FOLDER/results.jsonl
has a line per run, and what is there is not run again; parts that failed stay in FOLDER/CAUSE/. With --docs, the tables of all
lines replace those of the page. Needs gmsh, numpy, scipy and matplotlib from PyPI."""
import argparse
import json
import re
import resource
import signal
import subprocess
from pathlib import Path

import judge
import solids
from evaluation import document

SIZES = {"coarse": (1 / 12, 1000), "fine": (1 / 20, 4000)}  # edges of tets in diagonals, cells
PAGE = "any-part.md"
# By words of the sentence. All are about polycubes: where both ways fail, the sentence is that of the second one.
CAUSES = {"labels that are not those of a polycube": "the best labels that were found",
          "labels: a border turns too often": "quarter turns", "labels: an edge without length": "has no length",
          "labels: faces overlap around a vertex": "faces overlap", "tets stay flipped": "stay flipped"}


def write_tets(file, points, tets):
    """Medit's text, with all digits."""
    with open(file, "w", encoding="ascii") as out:
        out.write(f"MeshVersionFormatted 2\nDimension 3\nVertices\n{len(points)}\n")
        out.writelines(f"{x!r} {y!r} {z!r} 0\n" for x, y, z in points.tolist())
        out.write(f"Tetrahedra\n{len(tets)}\n")
        out.writelines(" ".join(map(str, tet)) + " 0\n" for tet in (tets + 1).tolist())
        out.write("End\n")


def processor_time():
    """Seconds that commands have taken: whatever else runs, they are nearly the same each time."""
    return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime


def cause_of(made):
    """What a refusal is about, else the code of the error, or a signal."""
    if made.returncode < 0:
        return f"signal {-made.returncode}"
    code = re.search(r"\[(\w+)(, [^]]*)?\]\s*$", made.stderr)
    return next((cause for cause, words in CAUSES.items() if words in made.stderr),
                code.group(1) if code else f"exit code {made.returncode}")


def mesh(command, part, target, cells, seconds):
    """Why there is no mesh (or ""), and what the command said."""
    arguments = [command, "mesh", part, "-o", target, "--cells", cells, "--threads", 1, "--quiet"]
    made = subprocess.run([*map(str, arguments)], capture_output=True, text=True,
                          preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5)))
    if made.returncode == -signal.SIGXCPU:
        return "time", f"not within {seconds} s"
    if made.returncode == 0:
        return "", ""
    return cause_of(made), made.stderr.strip()[:600]


def one_run(options, part, size, points, tets):
    """A line of the results; files stay only if something is wrong."""
    name = f"{part.seed}-{size}"
    tet_file, hex_file = options.folder / f"{name}.mesh", options.folder / f"{name}-hexes.mesh"
    write_tets(tet_file, points, tets)
    begin = processor_time()
    cause, said = mesh(options.command, tet_file, hex_file, SIZES[size][1], options.seconds)
    line = {"seed": part.seed, "size": size, "kinds": part.kinds, "oblique": part.oblique, "tets": len(tets),
            "seconds": round(processor_time() - begin, 1)}
    if not cause:
        verdict = judge.judge(hex_file, points, tets)
        line |= vars(verdict) | {"good": verdict.good()}
        cause = "refuted" if verdict.bad else ""
    line |= {"cause": cause, "said": said}
    if cause:
        kept = options.folder / re.sub(r"\W+", "-", cause)
        kept.mkdir(exist_ok=True)
        for file in filter(Path.exists, (tet_file, hex_file)):
            file.rename(kept / file.name)
        (kept / f"{name}.txt").write_text(f"{' '.join(part.kinds)}\n{said}\n", encoding="utf-8")
    for file in (tet_file, hex_file):
        file.unlink(missing_ok=True)
    return line


def run_all(options):
    results = options.folder / "results.jsonl"
    lines = [json.loads(line) for line in results.read_text(encoding="utf-8").splitlines()] if results.exists() else []
    done = {(line["seed"], line["size"]) for line in lines}
    for seed in options.seeds:
        if all((seed, size) in done for size in options.sizes):
            continue
        part, meshes = solids.draw_part(seed, [edge for edge, _ in SIZES.values()])
        for size, (points, tets) in zip(SIZES, meshes):
            if size in options.sizes and (seed, size) not in done:
                lines.append(one_run(options, part, size, points, tets))
                with results.open("a", encoding="utf-8") as out:
                    out.write(json.dumps(lines[-1]) + "\n")
                print(seed, size, "+".join(part.kinds), lines[-1]["cause"] or f"{lines[-1]['minimum']:.2f}",
                      lines[-1]["seconds"], flush=True)
    return lines


def share(lines, key):
    return f"{sum(map(key, lines))} of {len(lines)}"


def certified(line):
    return not line["cause"]


def group_row(name, lines):
    cells = [f"| {name}"]
    for size in SIZES:
        of_size = [line for line in lines if line["size"] == size]
        cells += [share(of_size, certified), str(sum(line.get("good", False) for line in of_size))]
    sharp = [line["followed"] for line in lines if certified(line)]
    cells.append(f"{100 * sum(sharp) / len(sharp):.0f} %" if sharp else "")
    return " | ".join(cells) + " |\n"


def groups_table(lines):
    head = "".join(f" {size}: certified | and good |" for size in SIZES)
    text = f"| part |{head} sharp edges followed |\n|---|" + "---:|" * (2 * len(SIZES) + 1) + "\n"
    text += group_row("all", lines)
    for kind in solids.KINDS:
        text += group_row("anything oblique" if kind == "oblique" else f"with a {kind}",
                          [line for line in lines if (line["oblique"] if kind == "oblique" else kind in line["kinds"])])
    for count in range(solids.MOST_FEATURES + 1):
        name = "1 feature" if count == 1 else f"{count} features"
        text += group_row(name, [line for line in lines if len(line["kinds"]) == count + 1])
    return text


def causes_table(lines):
    causes = {}
    for line in lines:
        causes.setdefault(line["cause"], []).append(line)
    causes.pop("", None)
    text = "| cause | runs | seeds, for example |\n|---|---:|---|\n"
    for cause, failed in sorted(causes.items(), key=lambda item: -len(item[1])):
        seeds = ", ".join(f"{line['seed']} {line['size']}" for line in failed[:4])
        text += f"| {cause} | {len(failed)} | {seeds} |\n"
    return text


def summary(lines, seconds):
    seeds = sorted({line["seed"] for line in lines})
    named = f"{seeds[0]} to {seeds[-1]}" if seeds == list(range(seeds[0], seeds[-1] + 1)) else ", ".join(map(str, seeds))
    tets = {size: sorted(line["tets"] for line in lines if line["size"] == size) for size in SIZES}
    times = sorted(line["seconds"] for line in lines if certified(line))
    middle = "; ".join(f"{size}: {len(each)} of {each[0]:,} to {each[-1]:,} tets, half of them below {each[len(each) // 2]:,}, "
                       f"{SIZES[size][1]:,} cells asked for" for size, each in tets.items() if each)
    spent = (f" Where there is a mesh, it took {times[0]:.0f} to {times[-1]:.0f} s, half of them below "
             f"{times[len(times) // 2]:.0f} s.") if times else ""
    return (f"{len(seeds)} parts, seeds {named}, {len(lines)} runs of one thread, each with {seconds} s of processor time. "
            f"{middle[0].upper()}{middle[1:]}.{spent}\n")


def seed_range(text):
    first, _, end = text.partition(":")
    return range(int(first), int(end))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command", type=lambda name: Path(name).resolve())
    parser.add_argument("--seeds", type=seed_range, default=range(0, 50), metavar="FIRST:END")
    parser.add_argument("--sizes", nargs="+", choices=SIZES, default=list(SIZES), help="default: all; fine ones take twice as long")
    parser.add_argument("--folder", type=Path, default=Path("build/drawn"))
    parser.add_argument("--seconds", type=int, default=60)
    parser.add_argument("--docs", type=Path)
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    lines = run_all(options)
    parts = {"drawn-summary": lambda: summary(lines, options.seconds), "drawn-groups": lambda: groups_table(lines),
             "drawn-causes": lambda: causes_table(lines)}
    if options.docs:
        document.rewrite_page(options.docs / PAGE, dict(parts))
    print(*(make() for make in parts.values()), sep="\n")


if __name__ == "__main__":
    main()
