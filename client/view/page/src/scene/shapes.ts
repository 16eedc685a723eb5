// Surfaces of shapes as triangles, in the object frame: the faces that the daemon makes of the same shapes
// (daemon/engine/shapes.h), seen counter-clockwise from outside. Lengths in m.
import { ShapeUtils, Vector2 } from 'three';
import type { Object$, Scene, Shape } from '../gen/haptic/v1/scene_pb';

export interface Surface {
  vertices: Float32Array; // x, y, z of each
  triangles: Uint32Array; // three vertices of each
  /** Of each triangle: index of the material behind it in the scene; -1: unknown. */
  material: Int32Array;
}

/** Corner i of a box has bit 0 of i in x, bit 1 in y and bit 2 in z. */
export function boxCorners(x: number, y: number, z: number): number[] {
  const corners: number[] = [];
  for (let i = 0; i < 8; ++i) {
    corners.push((i & 1) !== 0 ? x / 2 : -x / 2, (i & 2) !== 0 ? y / 2 : -y / 2, (i & 4) !== 0 ? z / 2 : -z / 2);
  }
  return corners;
}

// each cut through its corner of lowest number, as the cells are
const BOX_TRIANGLES = [0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6];

/** Icospheres of radius 1, from the icosahedron on. The children of triangle t are 4 t to 4 t + 3: at its corners in
 * order, and in its middle. A level's vertices begin with those of the level before. */
export interface Icospheres {
  directions: number[];
  triangles: Uint32Array[]; // by level
}

export function icospheres(subdivisions: number): Icospheres {
  const golden = (1 + Math.sqrt(5)) / 2;
  const length = Math.hypot(1, golden);
  const directions: number[] = [];
  for (let axis = 0; axis < 3; ++axis) {
    for (let i = 0; i < 4; ++i) {
      const v = [0, 0, 0];
      v[axis] = ((i & 1) !== 0 ? 1 : -1) / length;
      v[(axis + 1) % 3] = ((i & 2) !== 0 ? golden : -golden) / length;
      directions.push(...v);
    }
  }
  const triangles = [
    Uint32Array.from(
      [
        [0, 4, 1, 0, 1, 6, 0, 8, 4, 0, 6, 9, 0, 9, 8, 1, 4, 10, 1, 11, 6, 1, 10, 11, 2, 3, 5, 2, 7, 3],
        [2, 5, 8, 2, 9, 7, 2, 8, 9, 3, 10, 5, 3, 7, 11, 3, 11, 10, 4, 8, 5, 4, 5, 10, 6, 7, 9, 6, 11, 7],
      ].flat(),
    ),
  ];
  for (let level = 0; level < subdivisions; ++level) {
    const parents = triangles[level] as Uint32Array;
    const children = new Uint32Array(4 * parents.length);
    const middles = new Map<number, number>();
    const middle = (a: number, b: number): number => {
      const key = Math.min(a, b) * 2 ** 26 + Math.max(a, b);
      let index = middles.get(key);
      if (index === undefined) {
        index = directions.length / 3;
        const sum = [0, 1, 2].map((k) => (directions[3 * a + k] as number) + (directions[3 * b + k] as number));
        const norm = Math.hypot(...sum);
        for (const s of sum) directions.push(s / norm);
        middles.set(key, index);
      }
      return index;
    };
    for (let t = 0; t < parents.length; t += 3) {
      const [a, b, c] = [parents[t] as number, parents[t + 1] as number, parents[t + 2] as number];
      const [ab, bc, ca] = [middle(a, b), middle(b, c), middle(c, a)];
      children.set([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca], 4 * t);
    }
    triangles.push(children);
  }
  return { directions, triangles };
}

function extrude(outline: [number, number][], faces: number[][], height: number): { vertices: number[]; triangles: number[] } {
  const n = outline.length;
  const vertices: number[] = [];
  for (const z of [-height / 2, height / 2]) {
    for (const [x, y] of outline) vertices.push(x, y, z);
  }
  const triangles: number[] = [];
  for (const [a, b, c] of faces as [number, number, number][]) triangles.push(a, c, b, n + a, n + b, n + c);
  for (let i = 0; i < n; ++i) {
    const next = (i + 1) % n;
    triangles.push(i, next, n + next, i, n + next, n + i);
  }
  return { vertices, triangles };
}

function isClockwise(outline: [number, number][]): boolean {
  let area = 0;
  outline.forEach(([x, y], i) => {
    const [u, v] = outline[(i + 1) % outline.length] as [number, number];
    area += x * v - u * y;
  });
  return area < 0;
}

function trianglesOf(shape: Shape): { vertices: ArrayLike<number>; triangles: ArrayLike<number> } {
  const { kind } = shape;
  switch (kind.case) {
    case 'box': {
      const { x = 0, y = 0, z = 0 } = kind.value.size ?? {};
      return { vertices: boxCorners(x, y, z), triangles: BOX_TRIANGLES };
    }
    case 'icosphere': {
      const { directions, triangles } = icospheres(kind.value.subdivisions);
      const { radius } = kind.value;
      return {
        vertices: directions.map((d) => radius * d),
        triangles: triangles[kind.value.subdivisions] as Uint32Array,
      };
    }
    case 'cylinder': {
      const { radius, height, segments } = kind.value;
      const outline: [number, number][] = [];
      for (let i = 0; i < segments; ++i) {
        const angle = (2 * Math.PI * i) / segments;
        outline.push([radius * Math.cos(angle), radius * Math.sin(angle)]);
      }
      const fan: number[][] = [];
      for (let i = 1; i + 1 < segments; ++i) fan.push([0, i, i + 1]);
      return extrude(outline, fan, height);
    }
    case 'extrusion': {
      const outline = kind.value.outline.map(({ x, y }): [number, number] => [x, y]);
      if (isClockwise(outline)) outline.reverse();
      const faces = ShapeUtils.triangulateShape(
        outline.map(([x, y]) => new Vector2(x, y)),
        [],
      );
      return extrude(outline, faces, kind.value.height);
    }
    default:
      return { vertices: [], triangles: [] };
  }
}

/** Corners of the faces of a positive cell, seen counter-clockwise from outside; face k is opposite to vertex k. */
export const CELL_FACES = [
  [1, 2, 3],
  [0, 3, 2],
  [0, 1, 3],
  [0, 2, 1],
] as const;

/** Of each face of each cell, the cell on its other side; -1: none. Item 4 cell + face. */
export function neighboursOf(cells: ArrayLike<number>): Int32Array {
  const count = cells.length / 4;
  const neighbours = new Int32Array(4 * count).fill(-1);
  const open = new Map<string, number>();
  for (let cell = 0; cell < count; ++cell) {
    CELL_FACES.forEach((face, k) => {
      const key = face
        .map((corner) => cells[4 * cell + corner] as number)
        .sort((a, b) => a - b)
        .join();
      const other = open.get(key);
      if (other === undefined) {
        open.set(key, 4 * cell + k);
      } else {
        open.delete(key);
        neighbours[4 * cell + k] = Math.floor(other / 4);
        neighbours[other] = cell;
      }
    });
  }
  return neighbours;
}

/** Of each region of a mesh, by its tag, the index of its material in the scene. */
export function materialsByTag(object: Object$, scene: Scene): Map<number, number> {
  const index = new Map(scene.material.map((material, i) => [material.name, i]));
  return new Map(object.region.map((region) => [region.tag, index.get(region.material) ?? -1]));
}

export function isFree(scene: Scene, material: number): boolean {
  return scene.material[material]?.motion.case === 'free';
}

/** The surface of all cells that are not free, towards those that are and towards nothing; of all cells if all are. */
function surfaceOfMesh(object: Object$, scene: Scene): Surface {
  const kind = object.shape?.kind;
  const mesh = kind?.case === 'mesh' ? kind.value.embedded : undefined;
  if (!mesh) return { vertices: new Float32Array(), triangles: new Uint32Array(), material: new Int32Array() };
  const byTag = materialsByTag(object, scene);
  const materials = mesh.tag.map((tag) => byTag.get(tag) ?? -1);
  const solid = materials.map((material) => !isFree(scene, material));
  const all = !solid.includes(true);
  const neighbours = neighboursOf(mesh.cell);
  const triangles: number[] = [];
  const material: number[] = [];
  for (let cell = 0; 4 * cell < mesh.cell.length; ++cell) {
    if (!all && !solid[cell]) continue;
    CELL_FACES.forEach((face, k) => {
      const other = neighbours[4 * cell + k] as number;
      if (other >= 0 && (all || solid[other])) return;
      for (const corner of face) triangles.push(mesh.cell[4 * cell + corner] as number);
      material.push(materials[cell] ?? -1);
    });
  }
  return {
    vertices: Float32Array.from(mesh.vertex),
    triangles: Uint32Array.from(triangles),
    material: Int32Array.from(material),
  };
}

export function surfaceOf(object: Object$, scene: Scene): Surface {
  if (!object.shape || object.shape.kind.case === 'mesh') return surfaceOfMesh(object, scene);
  const { vertices, triangles } = trianglesOf(object.shape);
  const inside = scene.material.findIndex((material) => material.name === object.inside);
  return {
    vertices: Float32Array.from(vertices),
    triangles: Uint32Array.from(triangles),
    material: new Int32Array(triangles.length / 3).fill(inside),
  };
}
