"""python3 -m evaluation: see bench/evaluate."""

import argparse
import json
from pathlib import Path

from evaluation import document, measure, plots, results


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="bench/evaluate")
    parser.add_argument("--build", type=Path, required=True, help="build directory")
    parser.add_argument("--out", type=Path, required=True, help="folder for measured figures")
    parser.add_argument("--docs", type=Path, required=True, help="folder of performance.md and ablation.md")
    parser.add_argument("--quick", action="store_true", help="few repetitions of less")
    parser.add_argument("--only", default="", metavar="STEP,...", help="measure these anew")
    parser.add_argument("--no-run", action="store_true", help="only draw and write")
    return parser.parse_args()


def main() -> None:
    arguments = _arguments()
    if not arguments.no_run:
        only = [name for name in arguments.only.split(",") if name]
        measure.run(arguments.build, arguments.out, arguments.quick, only)
    runs = results.read_folder(arguments.out)
    about = json.loads((arguments.out / "machine.json").read_text(encoding="utf-8"))
    for path in plots.draw_all(runs, arguments.docs.parent / "images"):
        print(f"  {path}")
    missing = document.rewrite(arguments.docs, runs, about)
    print(f"  {arguments.docs / 'performance.md'}, {arguments.docs / 'ablation.md'}")
    if missing:
        print(f"  Without figures: {', '.join(missing)}")


if __name__ == "__main__":
    main()
