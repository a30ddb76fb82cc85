#!/usr/bin/env python3
"""How far meshes are from the surface before and after improvement.

    bench/improve/distances.py HEXHEX SECONDS MAP.hexex...

Extracts each map at scales 1, 2, 3, 4 and 6 with --improve, until an improvement takes longer than SECONDS, and prints
Hausdorff distances in diagonals; then how many are above the bound of 1e-3 before and after, and how many came farther
than the larger of that and their distance before."""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

BOUND = 1e-3


def improvement_of(hexhex, map_file, scale, folder):
    subprocess.run([hexhex, "extract", map_file, "--scale", str(scale), "--improve", "--threads", "1", "--quiet", "-o",
                    folder / "mesh.vtu", "--report", folder / "report.json"], check=True)
    return json.loads((folder / "report.json").read_text())["improvement"]


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    hexhex, most, maps = sys.argv[1], float(sys.argv[2]), sys.argv[3:]
    pairs = []
    with tempfile.TemporaryDirectory() as folder:
        for map_file in maps:
            for scale in (1, 2, 3, 4, 6):
                found = improvement_of(hexhex, map_file, scale, Path(folder))
                before, after = (found[key]["hausdorff"] for key in ("distance_before", "distance_after"))
                pairs.append((before, after))
                print(f"{Path(map_file).stem:24} x{scale}  {before:.1e} -> {after:.1e}", flush=True)
                if found["seconds"] > most:
                    break
    above = sum(before > BOUND for before, _ in pairs)
    both = sum(before > BOUND and after > BOUND for before, after in pairs)
    crossed = sum(before <= BOUND < after for before, after in pairs)
    # Rounding is no distance.
    farther = [after / max(before, BOUND) for before, after in pairs if after > 1.00001 * max(before, BOUND)]
    nearer = sum(after < 0.98 * before for before, after in pairs if before > 1e-9)
    print(f"{len(pairs)} meshes; above {BOUND}: {above} before, {both + crossed} after, {crossed} of which were not above "
          f"before; {nearer} nearer by more than 2 %; {len(farther)} farther, at most {max(farther, default=1):.2f} times")


if __name__ == "__main__":
    main()
