"""Random parts: boolean operations of solids in any position, by Open CASCADE through Gmsh (PyPI: gmsh), and their tets.

A seed is a part: what is drawn depends on nothing but it (and on Gmsh's version, whose tets differ). A part begins as
a box, cylinder, cone, ball or torus and gets up to four features: another of these fused to it, a rib, a hole, a
fillet or a chamfer. Half of what is added is turned by right angles, half by any angle. A feature that leaves several
bodies or none, changes hardly anything, leaves an edge shorter than a fiftieth of the diagonal, or what Gmsh cannot fill
with positive tets, is drawn again."""
import contextlib
import math
import multiprocessing
import random
import resource
from dataclasses import dataclass, field

import gmsh
import numpy as np

SOLIDS = ("box", "cylinder", "cone", "ball", "torus")
FEATURES = (*SOLIDS, "rib", "hole", "hole", "fillet", "chamfer")  # holes are what parts have most of
KINDS = (*SOLIDS, "rib", "hole", "fillet", "chamfer", "oblique")
MOST_FEATURES = 4
SHORTEST_EDGE = 1 / 50  # of the diagonal
LEAST_CHANGE = 5e-3  # of the volume
TRIES = 12  # of a feature, until one is as it should be
LONGEST = 15  # seconds of processor time for a solid and its tets; most take less than one
PER_TURN = 12  # edges of tets around a whole circle, at least


@dataclass
class Part:
    """Kinds of what it is made of, in order."""

    seed: int
    kinds: list = field(default_factory=list)
    oblique: bool = False

    @property
    def features(self):
        return len(self.kinds) - 1

    def has(self, kind):
        return self.oblique if kind == "oblique" else kind in self.kinds


class NotDrawn(Exception):
    """What was drawn is no feature."""


@contextlib.contextmanager
def kernel():
    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("General.NumThreads", 1)
        yield gmsh.model.occ
    finally:
        gmsh.finalize()


def solid(occ, draw, kind, size):
    """One around the origin, about `size` across."""
    radius, height = size * draw.uniform(0.25, 0.45), size * draw.uniform(0.5, 1.2)
    if kind == "box":
        sides = [size * draw.uniform(0.45, 1) for _ in range(3)]
        return occ.addBox(*(-side / 2 for side in sides), *sides)
    if kind == "rib":
        sides = size * draw.uniform(0.1, 0.16), size * draw.uniform(0.6, 1), size * draw.uniform(0.4, 0.7)
        return occ.addBox(*(-side / 2 for side in sides), *sides)
    if kind == "hole":
        return occ.addCylinder(0, 0, -3 * size, 0, 0, 6 * size, size * draw.uniform(0.08, 0.18))
    if kind == "cylinder":
        return occ.addCylinder(0, 0, -height / 2, 0, 0, height, radius)
    if kind == "cone":
        return occ.addCone(0, 0, -height / 2, 0, 0, height, radius, radius * draw.choice((0, 0.3, 0.6)))
    if kind == "ball":
        return occ.addSphere(0, 0, 0, radius)
    return occ.addTorus(0, 0, 0, radius, radius * draw.uniform(0.35, 0.6))


def turned(occ, draw, body):
    """Turns it; whether by another angle than a right one."""
    oblique = draw.random() < 0.5
    if oblique:
        axis = [draw.gauss(0, 1) for _ in range(3)]
        occ.rotate([body], 0, 0, 0, *axis, draw.uniform(0, math.pi))
    else:
        for axis in ((1, 0, 0), (0, 1, 0), (0, 0, 1)):
            occ.rotate([body], 0, 0, 0, *axis, draw.randrange(4) * math.pi / 2)
    return oblique


def box_of(body):
    low_high = np.array(gmsh.model.getBoundingBox(*body)).reshape(2, 3)
    return low_high[0], low_high[1]


def edges_of(body):
    faces = gmsh.model.getBoundary([body], oriented=False)
    return sorted({abs(tag) for _, tag in gmsh.model.getBoundary(faces, combined=False, oriented=False)})


def rounded(occ, draw, body, kind):
    """With a fillet or a chamfer at some of its edges."""
    edges = [tag for tag in edges_of(body) if occ.getMass(1, tag) > 1e-9]
    if not edges:
        raise NotDrawn
    chosen = draw.sample(edges, min(len(edges), draw.randint(1, 4)))
    width = draw.uniform(0.05, 0.1)
    if kind == "fillet":
        return occ.fillet([body[1]], chosen, [width])
    faces = [int(gmsh.model.getAdjacencies(1, tag)[0][0]) for tag in chosen]
    return occ.chamfer([body[1]], chosen, faces, [width])


def with_feature(occ, draw, body, kind):
    """What is made of a body by a feature, and whether that is oblique."""
    if kind in ("fillet", "chamfer"):
        return rounded(occ, draw, body, kind), False
    low, high = box_of(body)
    size = float((high - low).max())
    other = (3, solid(occ, draw, kind, size if kind in ("hole", "rib") else size * draw.uniform(0.4, 0.8)))
    oblique = turned(occ, draw, other)
    reach = 0.25 if kind == "hole" else 0.45
    place = [(a + b) / 2 + reach * draw.uniform(-1, 1) * (b - a) for a, b in zip(low, high)]
    if kind != "hole":  # to some side of the body
        axis, end = draw.randrange(3), draw.randrange(2)
        place[axis] = (low, high)[end][axis]
    occ.translate([other], *map(float, place))
    return (occ.cut if kind == "hole" else occ.fuse)([body], [other])[0], oblique


def checked(occ, made, volume):
    """The only body of `made`, if it is a part that differs from one of that volume."""
    occ.synchronize()
    bodies = [body for body in made if body[0] == 3]
    if len(bodies) != 1 or gmsh.model.getEntities(3) != bodies:
        raise NotDrawn
    low, high = box_of(bodies[0])
    if abs(occ.getMass(*bodies[0]) - volume) < LEAST_CHANGE * volume:
        raise NotDrawn
    lengths = [occ.getMass(1, tag) for tag in edges_of(bodies[0])]
    diagonal = float(np.linalg.norm(high - low))
    # Those at poles and tips have no length, and are no edges of the surface.
    if any(1e-9 * diagonal < length < SHORTEST_EDGE * diagonal for length in lengths):
        raise NotDrawn
    return bodies[0]


def replayed(occ, seed, drawn):
    """The part of a seed whose solids are those of the attempts `drawn`: one number for the first and each feature."""
    gmsh.clear()
    part = Part(seed)
    body = None
    for step, number in enumerate(drawn):
        draw = random.Random(f"{seed}/{step}/{number}")
        kind = draw.choice(FEATURES if step else SOLIDS)
        try:
            if step:
                volume = occ.getMass(*body)
                made, oblique = with_feature(occ, draw, body, kind)
                body = checked(occ, made, volume)
            else:
                body = (3, solid(occ, draw, kind, 1.0))
                oblique = turned(occ, draw, body)
                occ.synchronize()
        except NotDrawn:
            raise
        except Exception as error:  # Gmsh raises nothing more special
            raise NotDrawn from error
        part.kinds.append(kind)
        part.oblique |= oblique
    return part


def tets_of(edge):
    """Points and tets with edges of about that share of the diagonal; NotDrawn if there are none."""
    low, high = box_of((-1, -1))
    length = edge * float(np.linalg.norm(high - low))
    gmsh.model.mesh.clear()
    for name, value in (("MeshSizeMax", length), ("MeshSizeMin", length / 4), ("MeshSizeFromCurvature", PER_TURN)):
        gmsh.option.setNumber(f"Mesh.{name}", value)
    try:
        gmsh.model.mesh.generate(3)
    except Exception as error:
        raise NotDrawn from error
    tags, points, _ = gmsh.model.mesh.getNodes()
    kinds, _, nodes = gmsh.model.mesh.getElements(3)
    if list(kinds) != [4]:
        raise NotDrawn
    index = np.zeros(int(tags.max()) + 1, dtype=int)
    index[tags.astype(int)] = np.arange(len(tags))
    tets = index[nodes[0].astype(int)].reshape(-1, 4)
    used, tets = np.unique(tets, return_inverse=True)
    return points.reshape(-1, 3)[used], tets.reshape(-1, 4)


def positive(points, tets):
    corners = points[tets]
    return bool((np.linalg.det(corners[:, 1:] - corners[:, :1]) > 0).all())


def send_part(pipe, seed, drawn, edges):
    resource.setrlimit(resource.RLIMIT_CPU, (LONGEST, LONGEST))
    with kernel() as occ:
        try:
            part = replayed(occ, seed, drawn)
            meshes = [tets_of(edge) for edge in edges]
        except NotDrawn:
            pipe.send(None)
            return
    pipe.send((part, meshes) if all(positive(*mesh) for mesh in meshes) else None)


def in_a_child(*arguments):
    """What send_part() sends of these: in a process of its own, for some solids never come back or crash."""
    fork = multiprocessing.get_context("fork")
    here, there = fork.Pipe(duplex=False)
    child = fork.Process(target=send_part, args=(there, *arguments))
    child.start()
    there.close()
    try:
        return here.recv()
    except EOFError:
        return None
    finally:
        child.join()


def draw_part(seed, edges):
    """The part of a seed, and its points and tets at each of these lengths of edges (shares of the diagonal)."""
    features = seed % (MOST_FEATURES + 1)  # so that each number is as frequent as another
    drawn = [0]
    while True:
        last = len(drawn) > features
        made = in_a_child(seed, drawn, edges if last else ())
        if made and last:
            return made
        if made:
            drawn.append(0)
        elif len(drawn) > 1 and drawn[-1] + 1 == TRIES:  # what is there takes no feature: begin with another solid
            drawn = [drawn[0] + 1]
        else:
            drawn[-1] += 1
