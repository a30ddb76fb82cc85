"""What is run, how often, and what the quick evaluation leaves out."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Step:
    """One call of a program; its results go to NAME.json."""

    name: str
    program: str
    pattern: str  # of names of benchmarks
    repetitions: int
    # As often as a benchmark fits into this is it repeated within one repetition.
    seconds: float = 0.1


BENCH = "hexhex_bench"
ABLATION = "hexhex_ablation"

# The propeller engine runs on the maps of a million tets only where somebody asks for them.
FULL = [
    Step("extract", BENCH, "^extract/.*/engine:atlas/", 5),
    Step("extract-propeller", BENCH, "^extract/.*(low|middle|high|_x[0-9])/engine:propeller/", 5),
    Step("scale", BENCH, "^scale/.*/scale:[1-8]/", 5),
    Step("scale-large", BENCH, "^scale/.*/scale:1[0-9]/", 3),
    Step("density", BENCH, "^density/", 5),
    Step("epsilon", BENCH, "^epsilon/", 5),
    Step("rasterization", ABLATION, "^rasterization/", 5),
    Step("lookup", ABLATION, "^lookup/", 5),
    Step("mesh", BENCH, "^(quality|verify)/", 5),
    Step("files", BENCH, "^(read|write|copy|survey)_", 5),
]

QUICK_MAPS = "(sphere_blocks_.*|s17c_.*)"
QUICK = [
    Step("extract", BENCH, f"^extract/{QUICK_MAPS}/engine:atlas/", 3, 0.01),
    Step("extract-propeller", BENCH, f"^extract/{QUICK_MAPS}(high|_x[0-9])/engine:propeller/", 1),
    Step("scale", BENCH, "^scale/(sphere|s17c).*/scale:[1-8]/", 1, 0.01),
    Step("density", BENCH, "^density/", 1, 0.01),
    Step("epsilon", BENCH, "^epsilon/", 1, 0.01),
    Step("rasterization", ABLATION, "^rasterization/.*/scale:[1-8]/", 1, 0.01),
    Step("lookup", ABLATION, "^lookup/.*/scale:[1-8]/", 1, 0.01),
    Step("mesh", BENCH, "^(quality|verify)/", 1, 0.01),
    Step("files", BENCH, "^(read|write|copy|survey)_", 1, 0.01),
]
