"""What is run, how often, and what the quick evaluation leaves out."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Step:
    """Calls of a program, one for each map; their results go to NAME.json, or NAME-ROUND.json."""

    name: str
    program: str
    pattern: str  # of names of benchmarks
    repetitions: int
    # As often as a benchmark fits into this is it repeated within one repetition.
    seconds: float = 0.1
    # All of it this often. Of each benchmark the round counts in which the machine was the fastest
    # by another measure, see results.py.
    rounds: int = 1


BENCH = "hexhex_bench"
ABLATION = "hexhex_ablation"

FULL = [
    Step("extract", BENCH, "^extract/", 5, rounds=3),
    Step("scale", BENCH, "^scale/.*/scale:[1-8]/", 5),
    Step("scale-large", BENCH, "^scale/.*/scale:1[0-9]/", 3),
    Step("density", BENCH, "^density/", 5),
    Step("epsilon", ABLATION, "^epsilon/", 5),
    Step("rasterization", ABLATION, "^rasterization/", 5),
    Step("lookup", ABLATION, "^lookup/", 5),
    Step("ablation", ABLATION, "^ablation/", 7),
    Step("mesh", BENCH, "^(check|command)/", 5),
    Step("curved", BENCH, "^arcs_and_patches/.*engine:atlas/threads:1", 3),
    Step("files", BENCH, "^(read|write|copy|summarize)_", 3),
    Step("ways", BENCH, "^ways/", 3),
]
FULL_TEXT = ("full: medians of five repetitions, of seven for ablations, of three at scales above "
             "8, of arcs, of files and of ways to write; extraction in three rounds")

QUICK = [
    Step("extract", BENCH, "^extract/(sphere_blocks|s17c|rockerarm)", 3, 0.01),
    Step("scale", BENCH, "^scale/.*/scale:[1-8]/", 1, 0.01),
    Step("scale-large", BENCH, "^scale/(sphere|s17c).*/scale:12/", 1, 0.01),
    Step("density", BENCH, "^density/", 1, 0.01),
    Step("epsilon", ABLATION, "^epsilon/", 1, 0.01),
    Step("rasterization", ABLATION, "^rasterization/.*/scale:[1-8]/", 1, 0.01),
    Step("lookup", ABLATION, "^lookup/.*/scale:[1-8]/", 1, 0.01),
    Step("ablation", ABLATION, "^ablation/(sphere_blocks_(low|middle)|s17c)", 3, 0.01),
    Step("mesh", BENCH, "^(check|command)/", 1, 0.01),
    Step("curved", BENCH, "^arcs_and_patches/(sphere_blocks_low|s17c).*engine:atlas/threads:1", 1, 0.01),
    Step("files", BENCH, "^(read|write|copy|summarize)_", 1, 0.01),
    Step("ways", BENCH, "^ways/", 1, 0.01),
]
QUICK_TEXT = "quick (`--quick`): extraction is the median of three runs, all else ran once"
