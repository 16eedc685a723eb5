import { create, type MessageInitShape } from '@bufbuild/protobuf';
import { describe, expect, test } from 'vitest';
import { ObjectSchema, SceneSchema, ShapeSchema } from '../src/gen/haptic/v1/scene_pb';
import { cellsOf } from '../src/scene/cells';
import { neighboursOf, surfaceOf } from '../src/scene/shapes';

const scene = create(SceneSchema, {
  material: [
    { name: 'air', motion: { case: 'free', value: {} } },
    { name: 'wood', motion: { case: 'rigid', value: {} } },
  ],
});
const object = (shape: MessageInitShape<typeof ShapeSchema>, airMargin = 0) => create(ObjectSchema, { name: 'x', shape, inside: 'wood', outside: 'air', airMargin });

const box = { kind: { case: 'box', value: { size: { x: 0.05, y: 0.03, z: 0.02 } } } } as const;
const ball = (subdivisions: number) => ({ kind: { case: 'icosphere', value: { radius: 0.02, subdivisions } } }) as const;
const can = (segments: number) => ({ kind: { case: 'cylinder', value: { radius: 0.02, height: 0.05, segments } } }) as const;
// an L of two squares and one: area 3e-4
const corner = (points: number[][]) =>
  ({ kind: { case: 'extrusion', value: { outline: points.map(([x, y]) => ({ x: x as number, y: y as number })), height: 0.01 } } }) as const;
const letter = [
  [0, 0],
  [0.02, 0],
  [0.02, 0.01],
  [0.01, 0.01],
  [0.01, 0.02],
  [0, 0.02],
];

/** Of a closed surface, by the divergence theorem; positive if its triangles are counter-clockwise from outside. */
function volume({ vertices: v, triangles }: { vertices: ArrayLike<number>; triangles: ArrayLike<number> }): number {
  let sum = 0;
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => [0, 1, 2].map((axis) => v[3 * (triangles[t + k] as number) + axis] as number)) as number[][] as [
      number[],
      number[],
      number[],
    ];
    const [ax, ay, az] = a as [number, number, number];
    const [bx, by, bz] = b as [number, number, number];
    const [cx, cy, cz] = c as [number, number, number];
    sum += (ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)) / 6;
  }
  return sum;
}

/** Each edge of a closed surface is met once in each sense. */
function isClosed(triangles: ArrayLike<number>): boolean {
  const seen = new Map<string, number>();
  for (let t = 0; t < triangles.length; t += 3) {
    for (let k = 0; k < 3; ++k) {
      const [a, b] = [triangles[t + k] as number, triangles[t + ((k + 1) % 3)] as number];
      seen.set(`${a}/${b}`, (seen.get(`${a}/${b}`) ?? 0) + 1);
    }
  }
  return [...seen].every(([key, count]) => count === 1 && seen.get(key.split('/').reverse().join('/')) === 1);
}

/** Area of a regular polygon of n corners at the distance r. */
const polygon = (n: number, r: number) => (n / 2) * r * r * Math.sin((2 * Math.PI) / n);

describe('surfaces', () => {
  test.each([
    ['box', box, 12, 0.05 * 0.03 * 0.02],
    ['cylinder', can(7), 4 * 7 - 4, polygon(7, 0.02) * 0.05],
    ['extrusion', corner(letter), 4 * 6 - 4, 3e-4 * 0.01],
    ['extrusion in the other sense', corner([...letter].reverse()), 4 * 6 - 4, 3e-4 * 0.01],
  ])('of a %s are closed, seen from outside, and hold its volume', (_name, shape, count, expected) => {
    const surface = surfaceOf(object(shape), scene);
    expect(surface.triangles.length / 3).toBe(count);
    expect(isClosed(surface.triangles)).toBe(true);
    expect(volume(surface) / expected).toBeCloseTo(1, 5);
  });

  test('of an icosphere have 20 * 4^n triangles with their corners at the radius', () => {
    for (const n of [0, 1, 3]) {
      const surface = surfaceOf(object(ball(n)), scene);
      expect(surface.triangles.length / 3).toBe(20 * 4 ** n);
      expect(isClosed(surface.triangles)).toBe(true);
      expect(volume(surface)).toBeGreaterThan(0);
      for (let i = 0; i < surface.vertices.length; i += 3) expect(Math.hypot(...surface.vertices.subarray(i, i + 3))).toBeCloseTo(0.02, 7);
    }
  });

  test('of a mesh are the faces of its solid cells towards free ones and towards nothing', () => {
    // two cells on one face: one of wood (tag 1), one of air (tag 0)
    const mesh = {
      vertex: [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1],
      cell: [0, 1, 2, 3, 0, 2, 1, 4],
      tag: [1, 0],
    };
    const meshObject = create(ObjectSchema, {
      shape: { kind: { case: 'mesh', value: { embedded: mesh } } },
      region: [
        { tag: 0, material: 'air' },
        { tag: 1, material: 'wood' },
      ],
    });
    const surface = surfaceOf(meshObject, scene);
    expect(surface.triangles.length / 3).toBe(4);
    expect(volume(surface)).toBeCloseTo(1 / 6, 6);
    expect([...surface.material]).toEqual([1, 1, 1, 1]);
  });
});

describe('cells', () => {
  // numbers as `hapticd check` tells them of the same shapes
  test.each([
    ['box', object(box, 0.015), 42, 16],
    ['icosphere without air', object(ball(1)), 160, 55],
    ['icosphere in thin air', object(ball(2), 0.01), 1680, 379],
    ['icosphere in thick air', object(ball(3), 0.03), 8080, 1507],
    ['cylinder without air', object(can(7)), 39, 22],
    ['cylinder in air', object(can(64), 0.02), 3078, 752],
  ])('of a %s are as many as the daemon makes', (_name, described, cells, vertices) => {
    const made = cellsOf(described, scene);
    expect(made?.cells.length).toBe(4 * cells);
    expect(made?.vertices.length).toBe(3 * vertices);
    expect(made?.material.length).toBe(cells);
  });

  test('fill the shape: their faces that have no neighbour or another material are its surface', () => {
    for (const shape of [box, ball(2), can(64)]) {
      const described = object(shape, 0.01);
      const made = cellsOf(described, scene);
      if (!made) throw new Error('no cells');
      const neighbours = neighboursOf(made.cells);
      let between = 0;
      neighbours.forEach((other, i) => {
        if (other >= 0 && made.material[Math.floor(i / 4)] === 1 && made.material[other] === 0) between += 1;
      });
      // the middle of a cylinder's ends is cut otherwise, by as many triangles or more
      const surface = surfaceOf(described, scene).triangles.length / 3;
      if (shape.kind.case === 'cylinder') expect(between).toBeGreaterThanOrEqual(surface);
      else expect(between).toBe(surface);
    }
  });

  test('of an extrusion are not known', () => {
    expect(cellsOf(object(corner(letter), 0.01), scene)).toBeUndefined();
  });
});
