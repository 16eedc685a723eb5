// Cells of objects. Those of meshes come with the scene; those of generated shapes are made here in the way the
// daemon makes them (daemon/engine: shapes.cpp, icosphere.cpp, extrusion.cpp, cell_builder.cpp), so that their
// number is the one that the scene's description tells.
import type { Object$, Scene } from '../gen/haptic/v1/scene_pb';
import { boxCorners, type Icospheres, icospheres, materialsByTag } from './shapes';

export interface Cells {
  vertices: number[]; // x, y, z of each, m, object frame
  cells: number[]; // four vertices of each, positive
  material: number[]; // of each: index in the scene; -1: unknown
}

type Side = 'inside' | 'outside';
type Corners = [number, number, number];

class Builder {
  readonly vertices: number[] = [];
  readonly cells: number[] = [];
  readonly sides: Side[] = [];

  get count(): number {
    return this.vertices.length / 3;
  }

  /** One cell, made positive whatever the order of its vertices. */
  addCell(a: number, b: number, c: number, d: number, side: Side): void {
    const [ux, uy, uz] = this.way(a, b);
    const [vx, vy, vz] = this.way(a, c);
    const [wx, wy, wz] = this.way(a, d);
    const volume = ux * (vy * wz - vz * wy) + uy * (vz * wx - vx * wz) + uz * (vx * wy - vy * wx);
    if (volume < 0) this.cells.push(a, b, d, c);
    else this.cells.push(a, b, c, d);
    this.sides.push(side);
  }

  /** A convex piece: each face that does not have its vertex of lowest number makes cells with that vertex. */
  addPiece(faces: number[][], side: Side): void {
    const apex = Math.min(...faces.flat());
    for (const face of faces) {
      if (face.includes(apex)) continue;
      const start = face.indexOf(Math.min(...face));
      const around = face.map((_, k) => face[(start + k) % face.length] as number) as [number, number, number, number?];
      this.addCell(apex, around[0], around[1], around[2], side);
      if (around[3] !== undefined) this.addCell(apex, around[0], around[2], around[3], side);
    }
  }

  addPrism([a, b, c]: Corners, [d, e, f]: Corners, side: Side): void {
    this.addPiece([[a, b, c], [d, e, f], [a, b, e, d], [b, c, f, e], [c, a, d, f]], side);
  }

  private way(from: number, to: number): Corners {
    const v = this.vertices;
    return [0, 1, 2].map((k) => (v[3 * to + k] as number) - (v[3 * from + k] as number)) as Corners;
  }
}

const BOX_FACES = [
  [0, 2, 6, 4],
  [1, 3, 7, 5],
  [0, 1, 5, 4],
  [2, 3, 7, 6],
  [0, 1, 3, 2],
  [4, 5, 7, 6],
];

function box(x: number, y: number, z: number, margin: number): Builder {
  const builder = new Builder();
  builder.vertices.push(...boxCorners(x, y, z));
  builder.addPiece(BOX_FACES, 'inside');
  if (margin === 0) return builder;
  builder.vertices.push(...boxCorners(x + 2 * margin, y + 2 * margin, z + 2 * margin));
  for (const face of BOX_FACES) {
    const outer = face.map((corner) => corner + 8);
    const sides = face.map((corner, k) => {
      const next = (k + 1) % 4;
      return [corner, face[next] as number, outer[next] as number, outer[k] as number];
    });
    builder.addPiece([face, outer, ...sides], 'outside');
  }
  return builder;
}

// --- icosphere: concentric layers, the surface being the finest ------------------------------------------------

const LAYER_THICKNESS = 0.75; // between level k - 1 and level k, times 2^k, over the radius of level k
const SAG_PART = 0.1; // what coarse hull triangles may take from the air

interface Layer {
  level: number;
  radius: number;
  first: number;
}

function leastInradius({ directions, triangles }: Icospheres, level: number): number {
  const at = (i: number): Corners => [directions[3 * i], directions[3 * i + 1], directions[3 * i + 2]] as Corners;
  const flat = triangles[level] as Uint32Array;
  let least = 1;
  for (let t = 0; t < flat.length; t += 3) {
    const [p, q, r] = [at(flat[t] as number), at(flat[t + 1] as number), at(flat[t + 2] as number)];
    const u = [q[0] - p[0], q[1] - p[1], q[2] - p[2]] as Corners;
    const v = [r[0] - p[0], r[1] - p[1], r[2] - p[2]] as Corners;
    const n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]] as Corners;
    least = Math.min(least, (n[0] * p[0] + n[1] * p[1] + n[2] * p[2]) / Math.hypot(...n));
  }
  return least;
}

function icosphere(radius: number, subdivisions: number, margin: number): Builder {
  const builder = new Builder();
  const levels = icospheres(subdivisions);
  const addLayer = (level: number, size: number): Layer => {
    const first = builder.count;
    const values = 3 * (10 * 4 ** level + 2);
    for (let i = 0; i < values; ++i) builder.vertices.push(size * (levels.directions[i] as number));
    return { level, radius: size, first };
  };
  const corners = (level: number, t: number, first: number): Corners => {
    const flat = levels.triangles[level] as Uint32Array;
    return [0, 1, 2].map((k) => first + (flat[3 * t + k] as number)) as Corners;
  };
  const count = (level: number): number => 20 * 4 ** level;
  const fillCoarser = (fine: Layer, coarse: Layer, side: Side): void => {
    for (let t = 0; t < count(coarse.level); ++t) {
      const inner = corners(coarse.level, t, coarse.first);
      const outer = corners(coarse.level, t, fine.first);
      const middle = corners(fine.level, 4 * t + 3, fine.first);
      for (let k = 0; k < 3; ++k) {
        builder.addCell(inner[k] as number, outer[k] as number, middle[k] as number, middle[(k + 2) % 3] as number, side);
      }
      const around = [inner[1], inner[2], middle[2], middle[0]];
      for (let k = 0; k < 4; ++k) {
        builder.addCell(inner[0], middle[1], around[k] as number, around[(k + 1) % 4] as number, side);
      }
    }
  };

  const surface = addLayer(subdivisions, radius);
  let layer = surface;
  while (layer.level > 0) {
    const inner = addLayer(layer.level - 1, layer.radius * (1 - LAYER_THICKNESS / 2 ** layer.level));
    fillCoarser(layer, inner, 'inside');
    layer = inner;
  }
  const centre = builder.count;
  builder.vertices.push(0, 0, 0);
  for (let t = 0; t < count(layer.level); ++t) builder.addCell(centre, ...corners(layer.level, t, layer.first), 'inside');
  if (margin === 0) return builder;

  layer = surface;
  const last = radius + margin;
  while (layer.level > 0) {
    const next = layer.radius * (1 + LAYER_THICKNESS / 2 ** layer.level);
    const sag = last * (1 - leastInradius(levels, layer.level - 1));
    if (2 * next - layer.radius > last || sag > SAG_PART * margin) break;
    const outer = addLayer(layer.level - 1, next);
    fillCoarser(layer, outer, 'outside');
    layer = outer;
  }
  const ideal = (2 * LAYER_THICKNESS * layer.radius) / 2 ** layer.level;
  const shells = Math.max(1, Math.floor((last - layer.radius) / ideal));
  const start = layer.radius;
  const step = (last - start) / shells;
  for (let i = 1; i <= shells; ++i) {
    const outer = addLayer(layer.level, i === shells ? last : start + i * step);
    for (let t = 0; t < count(layer.level); ++t) {
      builder.addPrism(corners(layer.level, t, layer.first), corners(layer.level, t, outer.first), 'outside');
    }
    layer = outer;
  }
  return builder;
}

// --- cylinder: a disc of rings that grow coarser from the surface, carried along z -----------------------------

const INNERMOST = 6; // points of a ring that is filled without further rings
const OUTERMOST = 24; // points below which the air's rings grow no coarser

interface Ring {
  first: number;
  steps: number[]; // its points, as multiples of a full turn over the segments
  radius: number;
}

class Disc {
  readonly points: [number, number][] = [];
  readonly triangles: Corners[] = [];
  readonly sides: Side[] = [];

  constructor(private readonly segments: number) {}

  addRing(steps: number[], radius: number): Ring {
    const first = this.points.length;
    for (const step of steps) {
      const angle = (2 * Math.PI * step) / this.segments;
      this.points.push([radius * Math.cos(angle), radius * Math.sin(angle)]);
    }
    return { first, steps, radius };
  }

  addCoarser(ring: Ring, radius: number): Ring {
    return this.addRing(
      ring.steps.filter((_, i) => i % 2 === 0),
      radius,
    );
  }

  fillBetween(fine: Ring, coarse: Ring, side: Side): void {
    const n = fine.steps.length;
    const m = coarse.steps.length;
    const stride = n === m ? 1 : 2;
    for (let i = 0; i < n; i += stride) {
      const here = coarse.first + i / stride;
      const next = coarse.first + ((i / stride + 1) % m);
      const middle = fine.first + ((i + 1) % n);
      this.add([fine.first + i, middle, here], side);
      this.add([middle, next, here], side);
      if (stride === 2 && i + 1 < n) this.add([middle, fine.first + ((i + 2) % n), next], side);
    }
  }

  fillMiddle(ring: Ring, side: Side): void {
    let loop = ring.steps.map((_, i) => ring.first + i);
    while (loop.length > 3) {
      const rest: number[] = [];
      for (let i = 0; i < loop.length; i += 2) {
        rest.push(loop[i] as number);
        if (i + 1 < loop.length) {
          this.add([loop[i], loop[i + 1], loop[(i + 2) % loop.length]] as Corners, side);
        }
      }
      loop = rest;
    }
    if (loop.length === 3) this.add(loop as Corners, side);
  }

  private add(triangle: Corners, side: Side): void {
    this.triangles.push(triangle);
    this.sides.push(side);
  }
}

function cylinder(radius: number, height: number, segments: number, margin: number): Builder {
  const disc = new Disc(segments);
  const band = (ring: Ring): number => 4 / ring.steps.length;
  const all = Array.from({ length: segments }, (_, i) => i);
  const surface = disc.addRing(all, radius);
  let ring = surface;
  while (ring.steps.length > INNERMOST) {
    const inner = disc.addCoarser(ring, ring.radius * (1 - band(ring)));
    disc.fillBetween(ring, inner, 'inside');
    ring = inner;
  }
  disc.fillMiddle(ring, 'inside');
  if (margin > 0) {
    ring = surface;
    while (ring.steps.length >= 2 * OUTERMOST && ring.radius * (1 + 2 * band(ring)) < radius + margin) {
      const outer = disc.addCoarser(ring, ring.radius * (1 + band(ring)));
      disc.fillBetween(ring, outer, 'outside');
      ring = outer;
    }
    disc.fillBetween(ring, disc.addRing(ring.steps, radius + margin), 'outside');
  }

  const half = height / 2;
  const levels = margin > 0 ? [-half - margin, -half, half, half + margin] : [-half, half];
  const shapeSlab = levels.length / 2 - 1;
  const builder = new Builder();
  for (const z of levels) {
    for (const [x, y] of disc.points) builder.vertices.push(x, y, z);
  }
  const n = disc.points.length;
  for (let slab = 0; slab + 1 < levels.length; ++slab) {
    disc.triangles.forEach((triangle, t) => {
      const bottom = triangle.map((i) => slab * n + i) as Corners;
      const top = triangle.map((i) => (slab + 1) * n + i) as Corners;
      builder.addPrism(bottom, top, slab === shapeSlab ? (disc.sides[t] as Side) : 'outside');
    });
  }
  return builder;
}

/** The cells of an object; nothing for shapes whose cells are known to the daemon alone. */
export function cellsOf(object: Object$, scene: Scene): Cells | undefined {
  const kind = object.shape?.kind;
  const index = (name: string): number => scene.material.findIndex((material) => material.name === name);
  if (kind?.case === 'mesh') {
    const mesh = kind.value.embedded;
    if (!mesh) return undefined;
    const byTag = materialsByTag(object, scene);
    return { vertices: mesh.vertex, cells: mesh.cell, material: mesh.tag.map((tag) => byTag.get(tag) ?? -1) };
  }
  const margin = object.airMargin;
  let builder: Builder;
  if (kind?.case === 'box') {
    const { x = 0, y = 0, z = 0 } = kind.value.size ?? {};
    builder = box(x, y, z, margin);
  } else if (kind?.case === 'icosphere') {
    builder = icosphere(kind.value.radius, kind.value.subdivisions, margin);
  } else if (kind?.case === 'cylinder') {
    builder = cylinder(kind.value.radius, kind.value.height, kind.value.segments, margin);
  } else {
    return undefined;
  }
  const [inside, outside] = [index(object.inside), index(object.outside)];
  return {
    vertices: builder.vertices,
    cells: builder.cells,
    material: builder.sides.map((side) => (side === 'inside' ? inside : outside)),
  };
}
