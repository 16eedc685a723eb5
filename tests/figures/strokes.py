"""Scenes in which every transition of the paper's Table 2 happens, of the sizes that it supposes.

edge: twelve cells around one edge, nine of them rigid, so that the edge is a concave one. vertex: twenty cells around
one vertex, five of which make a pit in the others that are rigid. hull: a box whose boundary has twelve triangles, with
nothing around it. Ten HIPs, as the daemon times one tick of 64, stroke at random over each, and often go to a vertex,
which is rarely met by chance.
"""

import math
import random

RADIUS = 0.02  # m
SECONDS = 60
RATE = 1000  # Hz

CONFIG = """servo {{ rate_hz: {rate} }}
device {{ name: "probe" playback {{ path: "{path}" }} }}
safety {{ max_force: 100 max_speed: 100 }}
scene: "{scene}"
"""

SCENE = """name: "{name}"
material {{ name: "air" free {{}} }}
material {{ name: "wood" density: 1000 rigid {{ static_friction: 0.2 kinetic_friction: 0.1 }} }}
object {{
  name: "{name}"
  shape {{ mesh {{ path: "{mesh}" }} }}
  region {{ tag: 0 material: "air" }}
  region {{ tag: 1 material: "wood" }}
}}
finger {{
  name: "probe"
  device: "probe"
  stiffness: 100
  fingertip {{ radius: 0.001 cap_angle: 3 hips: 10 direction {{ z: 1 }} }}
}}
"""


def turned(vertices, cell):
    """The cell, or its mirror image where its volume is negative."""
    a, b, c, d = (vertices[corner] for corner in cell)
    u, v, w = ([x - y for x, y in zip(end, a)] for end in (b, c, d))
    volume = sum(u[i] * (v[i - 2] * w[i - 1] - v[i - 1] * w[i - 2]) for i in range(3))
    return cell if volume > 0.0 else (cell[1], cell[0], *cell[2:])


def edge():
    """Vertices in m; cells as (four vertices, tag), tag 1 being rigid; the vertices that strokes go to, and about where
    strokes begin. So for all of MODELS.
    """
    vertices = [(0.0, 0.0, -RADIUS), (0.0, 0.0, RADIUS)]
    vertices += [(RADIUS * math.cos(a), RADIUS * math.sin(a), 0.0) for a in (math.pi / 6.0 * i for i in range(12))]
    return vertices, [((0, 2 + i, 2 + (i + 1) % 12, 1), int(i >= 3)) for i in range(12)], vertices, vertices[3]


def vertex():
    """An icosahedron, whose triangles make a cell each with its centre."""
    golden = 0.5 * (1.0 + math.sqrt(5.0))
    corners = [(0.0, s, t * golden) for s in (-1.0, 1.0) for t in (-1.0, 1.0)]
    corners = [corner[-turn:] + corner[:-turn] for turn in range(3) for corner in corners]
    size = RADIUS / math.hypot(1.0, golden)
    near = {(i, j) for i in range(12) for j in range(12) if math.dist(corners[i], corners[j]) < 2.1}
    triangles = [(i, j, k) for i, j in sorted(near) for k in range(j + 1, 12) if i < j and {(i, k), (j, k)} <= near]
    triangles.sort(key=lambda triangle: 0 in triangle)  # the last five are around the first corner
    vertices = [tuple(size * x for x in corner) for corner in corners] + [(0.0, 0.0, 0.0)]
    return vertices, [((*triangle, 12), int(i < 15)) for i, triangle in enumerate(triangles)], [vertices[12]], vertices[0]


def hull():
    """Six cells along the diagonal of a box; one is free."""
    side = 1.5 * RADIUS
    vertices = [tuple((0.5 if corner >> axis & 1 else -0.5) * side for axis in range(3)) for corner in range(8)]
    ways = ((1, 3), (1, 5), (2, 3), (2, 6), (4, 5), (4, 6))
    return vertices, [((0, *way, 7), int(i > 0)) for i, way in enumerate(ways)], vertices, (0.0, 0.0, 0.0)


MODELS = {"edge": edge, "vertex": vertex, "hull": hull}


def strokes(visited, begin):
    """Where the finger is at each tick, in m. It begins outside; as 64 ticks are a multiple of no period here, each of its
    moves is timed now and then.
    """
    chance = random.Random(7)

    def scattered(middle, size):
        return tuple(x + size * (chance.random() - 0.5) for x in middle)

    place = (2.0 * RADIUS, 2.0 * RADIUS, 0.0)
    for tick in range(SECONDS * RATE + 1):
        yield place
        if tick % 99 == 98:
            place = scattered(begin, 3.0 * RADIUS)  # a stroke begins
        elif tick % 9 == 0:
            corner = chance.choice(visited)
            place = scattered(corner, 0.05 * RADIUS)
        elif tick % 9 < 4:
            place = scattered(corner, 0.05 * RADIUS)  # it stays
        else:
            place = scattered(tuple(0.98 * x for x in place), 0.2 * RADIUS)


def write(folder, name):
    """Writes what simulating a model takes. Returns the config's path."""
    vertices, cells, visited, begin = MODELS[name]()
    nodes = [f"{len(vertices)} 3 0 0"] + [" ".join(map(repr, (i, *v))) for i, v in enumerate(vertices)]
    elements = [f"{len(cells)} 4 1"] + [" ".join(map(str, (i, *turned(vertices, cell), tag))) for i, (cell, tag) in enumerate(cells)]
    path = [f"{tick / RATE!r},{x!r},{y!r},{z!r}" for tick, (x, y, z) in enumerate(strokes(visited, begin))]
    files = {
        "node": "\n".join(nodes),
        "ele": "\n".join(elements),
        "csv": "\n".join(["time,x,y,z", *path]),
        "scene.txtpb": SCENE.format(name=name, mesh=f"{name}.ele"),
        "txtpb": CONFIG.format(rate=RATE, path=f"{name}.csv", scene=f"{name}.scene.txtpb"),
    }
    for ending, text in files.items():
        (folder / f"{name}.{ending}").write_text(text + "\n", encoding="utf-8")
    return folder / f"{name}.txtpb"
