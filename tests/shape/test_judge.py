#!/usr/bin/env python3
"""Does bench/shape/judge.py judge rightly? Exit code 77 without numpy or scipy."""

import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "bench/shape"), str(ROOT / "bench/improve")]
try:
    import numpy as np

    import judge
except ImportError as error:
    print(f"skipped: {error}")
    sys.exit(77)


def sampled(points):
    """The least of the Jacobian's determinants at a grid of points of one cell, with floating point alone."""
    least = np.inf
    grid = np.linspace(0, 1, 5)
    signs = 2 * judge.CORNERS - 1
    for place in np.stack(np.meshgrid(grid, grid, grid), axis=-1).reshape(-1, 3):
        shape = np.where(judge.CORNERS == 1, place, 1 - place)
        ways = [np.prod(np.delete(shape, axis, axis=1), axis=1) * signs[:, axis] @ points for axis in range(3)]
        least = min(least, float(np.linalg.det(ways)))
    return least


def write_grid(file, n, scale=(1.0, 1.0, 1.0)):
    """A cube of n^3 cells, or a box."""
    places = np.stack(np.meshgrid(*3 * [range(n + 1)], indexing="ij"), axis=-1).reshape(-1, 3)
    number = {tuple(place): i for i, place in enumerate(places.tolist())}
    cells = [[number[tuple(np.array(low) + corner)] + 1 for corner in judge.CORNERS.tolist()]
             for low in places.tolist() if max(low) < n]
    lines = ["MeshVersionFormatted 2", "Dimension 3", "Vertices", str(len(places))]
    lines += [" ".join(map(str, point)) + " 0" for point in (places / n * scale).tolist()]
    lines += ["Hexahedra", str(len(cells)), *(" ".join(map(str, cell)) + " 0" for cell in cells), "End"]
    file.write_text("\n".join(lines) + "\n", encoding="ascii")


class Positivity(unittest.TestCase):
    def test_agrees_with_samples(self):
        draw = np.random.default_rng(1)
        only_inside = divided = 0
        cells = judge.CORNERS + draw.uniform(-0.6, 0.6, (400, 8, 3))
        for i, (points, coefficients) in enumerate(zip(cells, judge.bezier(judge.integers(cells)))):
            corners_positive = (coefficients[::2, ::2, ::2] > 0).all()
            all_positive = (coefficients > 0).all()
            if i % 20 and (all_positive or not corners_positive):
                continue  # that is easy; some will do
            positive = judge.positive_everywhere(coefficients)
            least = sampled(points)
            if abs(least) > 0.02:
                self.assertEqual(positive, least > 0)
            only_inside += bool(corners_positive and not positive)
            divided += bool(positive and not all_positive)
        self.assertGreater(only_inside, 0)
        self.assertGreater(divided, 0)

    def test_decides_the_last_bit(self):
        """A flat cell is bad, and one that is thicker by the smallest number is not."""
        flat = judge.CORNERS * [1.0, 1.0, 0.0]
        self.assertEqual(judge.bad_cells(flat, np.arange(8)[None]), 1)
        thin = judge.CORNERS * [1.0, 1.0, 5e-324]
        self.assertEqual(judge.bad_cells(thin, np.arange(8)[None]), 0)

    def test_refuses_mirrored_cells(self):
        mirrored = judge.CORNERS * [-1.0, 1.0, 1.0]
        self.assertEqual(judge.bad_cells(mirrored, np.arange(8)[None]), 1)


class Verdicts(unittest.TestCase):
    POINTS = judge.CORNERS.astype(float)
    TETS = np.array([[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]])

    def judged(self, scale):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder) / "box.mesh"
            write_grid(file, 4, scale)
            return judge.judge(file, self.POINTS, self.TETS)

    def test_finds_nothing_wrong_with_a_cube(self):
        verdict = self.judged((1.0, 1.0, 1.0))
        self.assertEqual((verdict.cells, verdict.bad), (64, 0))
        self.assertAlmostEqual(verdict.minimum, 1)
        self.assertLess(max(verdict.to_surface, verdict.from_surface), 1e-12)
        self.assertAlmostEqual(verdict.followed, 1)
        self.assertTrue(verdict.good())

    def test_measures_what_is_off(self):
        verdict = self.judged((1.0, 1.0, 1.1))
        for away in (verdict.to_surface, verdict.from_surface):
            self.assertAlmostEqual(away, 0.1 / 3**0.5, places=6)
        # The four edges at z = 1 are followed at their ends only, the others everywhere.
        self.assertAlmostEqual(verdict.followed, 2 / 3, delta=0.01)
        self.assertFalse(verdict.good())


if __name__ == "__main__":
    unittest.main()
