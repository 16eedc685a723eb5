// The objects of a scene: surfaces that follow their poses, and their cells on request.
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DoubleSide,
  Group,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  Mesh,
  MeshStandardMaterial,
  Plane,
  Quaternion,
  Vector3,
} from 'three';
import { acceleratedRaycast, MeshBVH } from 'three-mesh-bvh';
import type { SceneDescription } from '../gen/haptic/v1/control_pb';
import type { ObjectsFrame } from '../gen/haptic/v1/telemetry_pb';
import { type Cells, cellsOf } from './cells';
import { materialColour } from './palette';
import { CELL_FACES, isFree, neighboursOf, type Surface, surfaceOf } from './shapes';

Mesh.prototype.raycast = acceleratedRaycast;

export interface CellsLook {
  shown: boolean;
  wireframe: boolean;
  /** World axis that the cut is across; 'none': no cut. */
  cutAxis: 'none' | 'x' | 'y' | 'z';
  /** Where the cut is, from 0, the lower end of the object, to 1. */
  cutAt: number;
  byMaterial: boolean;
}

/** What is behind an object, or pressed into it, shines through. */
const SOLID = 0.82;
const UNIFORM_MOVABLE = new Color('#8fb4d9');
const UNIFORM_FIXED = new Color('#9aa3ad');

function triangleSoup(surface: Surface, colourOf: (material: number) => Color): BufferGeometry {
  const count = surface.triangles.length;
  const positions = new Float32Array(3 * count);
  const colours = new Float32Array(3 * count);
  for (let i = 0; i < count; ++i) {
    const vertex = surface.triangles[i] as number;
    positions.set(surface.vertices.subarray(3 * vertex, 3 * vertex + 3), 3 * i);
    const colour = colourOf(surface.material[Math.floor(i / 3)] as number);
    colours.set([colour.r, colour.g, colour.b], 3 * i);
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(positions, 3));
  geometry.setAttribute('color', new BufferAttribute(colours, 3));
  geometry.computeVertexNormals();
  geometry.computeBoundingSphere();
  geometry.computeBoundingBox();
  return geometry;
}

/** One object: its frame, of which the surface and the cells are children. */
export class SceneObject {
  readonly frame = new Group();
  readonly surface: Mesh<BufferGeometry, MeshStandardMaterial>;
  readonly bvh: MeshBVH | undefined;
  readonly triangles: number;
  private cells: Cells | undefined;
  private neighbours: Int32Array | undefined;
  private cellMesh: Mesh<BufferGeometry, MeshStandardMaterial> | undefined;
  private cellLines: LineSegments<BufferGeometry, LineBasicMaterial> | undefined;
  private cut = '';

  constructor(
    readonly index: number,
    readonly scene: SceneDescription,
  ) {
    const object = this.description;
    const surface = surfaceOf(object, scene.scene as NonNullable<typeof scene.scene>);
    this.triangles = surface.triangles.length / 3;
    const geometry = triangleSoup(surface, (material) => new Color(materialColour(material)));
    this.surface = new Mesh(
      geometry,
      new MeshStandardMaterial({ roughness: 0.75, metalness: 0, flatShading: false, transparent: true, opacity: SOLID }),
    );
    if (this.triangles > 0) {
      this.bvh = new MeshBVH(geometry);
      geometry.boundsTree = this.bvh;
    }
    this.surface.castShadow = true;
    this.surface.receiveShadow = true;
    this.surface.userData.object = index;
    this.frame.add(this.surface);
    this.frame.matrixAutoUpdate = false;
    this.paint(false, false);
    const { position, orientation } = object.pose ?? {};
    this.place(
      new Vector3(position?.x, position?.y, position?.z),
      orientation
        ? new Quaternion(orientation.x, orientation.y, orientation.z, orientation.w).normalize()
        : new Quaternion(),
    );
  }

  get description() {
    const object = this.scene.scene?.object[this.index];
    if (!object) throw new RangeError(`the scene has no object ${this.index}`);
    return object;
  }

  get name(): string {
    return this.description.name;
  }

  get hasCells(): boolean {
    const kind = this.description.shape?.kind.case;
    return kind !== undefined && kind !== 'extrusion';
  }

  place(position: Vector3, orientation: Quaternion): void {
    this.frame.position.copy(position);
    this.frame.quaternion.copy(orientation);
    this.frame.updateMatrix();
    this.frame.matrixWorldNeedsUpdate = true;
  }

  paint(byMaterial: boolean, selected: boolean): void {
    const { material } = this.surface;
    if (material.vertexColors !== byMaterial) {
      material.vertexColors = byMaterial;
      material.needsUpdate = true;
    }
    const uniform = this.description.dynamic ? UNIFORM_MOVABLE : UNIFORM_FIXED;
    material.color.copy(byMaterial ? new Color('#ffffff') : uniform);
    material.emissive.set(selected ? '#1d4f7a' : '#000000');
  }

  showCells(look: CellsLook, selected: boolean): void {
    this.paint(look.byMaterial, selected);
    const shown = look.shown && this.hasCells;
    this.surface.material.opacity = shown ? 0.12 : SOLID;
    this.surface.material.depthWrite = !shown;
    this.surface.castShadow = !shown;
    if (!shown) {
      this.dropCells();
      return;
    }
    const cut = `${look.cutAxis}/${look.cutAxis === 'none' ? 0 : look.cutAt}/${look.byMaterial}/${look.wireframe}`;
    if (cut === this.cut) return;
    this.cut = cut;
    this.buildCells(look);
  }

  private dropCells(): void {
    for (const part of [this.cellMesh, this.cellLines]) {
      if (!part) continue;
      this.frame.remove(part);
      part.geometry.dispose();
      part.material.dispose();
    }
    this.cellMesh = undefined;
    this.cellLines = undefined;
    this.cut = '';
  }

  private buildCells(look: CellsLook): void {
    const scene = this.scene.scene;
    if (!scene) return;
    this.cells ??= cellsOf(this.description, scene);
    const { cells } = this;
    if (!cells) return;
    this.neighbours ??= neighboursOf(cells.cells);
    const { neighbours } = this;
    const kept = this.keptCells(cells, look);
    const positions: number[] = [];
    const colours: number[] = [];
    const edges = new Set<number>();
    const lines: number[] = [];
    const put = (out: number[], vertex: number): void => {
      out.push(cells.vertices[3 * vertex] as number, cells.vertices[3 * vertex + 1] as number, cells.vertices[3 * vertex + 2] as number);
    };
    for (let cell = 0; cell < kept.length; ++cell) {
      if (!kept[cell]) continue;
      const material = cells.material[cell] as number;
      const free = isFree(scene, material);
      const colour = look.byMaterial || !this.description.dynamic ? new Color(materialColour(material)) : UNIFORM_MOVABLE;
      CELL_FACES.forEach((face, k) => {
        const other = neighbours[4 * cell + k] as number;
        const isBorder = other < 0 || !kept[other] || cells.material[other] !== material;
        if (!isBorder && look.cutAxis !== 'none') return;
        const corners = face.map((corner) => cells.cells[4 * cell + corner] as number) as [number, number, number];
        if (!free && isBorder) {
          for (const corner of corners) {
            put(positions, corner);
            colours.push(colour.r, colour.g, colour.b);
          }
        }
        if (!look.wireframe) return;
        for (let i = 0; i < 3; ++i) {
          const [a, b] = [corners[i] as number, corners[(i + 1) % 3] as number];
          const key = Math.min(a, b) * 2 ** 26 + Math.max(a, b);
          if (edges.has(key)) continue;
          edges.add(key);
          put(lines, a);
          put(lines, b);
        }
      });
    }
    this.dropCells();
    this.cut = `${look.cutAxis}/${look.cutAxis === 'none' ? 0 : look.cutAt}/${look.byMaterial}/${look.wireframe}`;
    if (look.cutAxis !== 'none' || !look.wireframe) {
      const geometry = new BufferGeometry();
      geometry.setAttribute('position', new BufferAttribute(Float32Array.from(positions), 3));
      geometry.setAttribute('color', new BufferAttribute(Float32Array.from(colours), 3));
      geometry.computeVertexNormals();
      this.cellMesh = new Mesh(
        geometry,
        new MeshStandardMaterial({
          vertexColors: true,
          flatShading: true,
          roughness: 0.8,
          side: DoubleSide,
          polygonOffset: true,
          polygonOffsetFactor: 1,
          polygonOffsetUnits: 1,
        }),
      );
      this.cellMesh.raycast = () => undefined;
      this.cellMesh.castShadow = true;
      this.frame.add(this.cellMesh);
    }
    if (look.wireframe) {
      const geometry = new BufferGeometry();
      geometry.setAttribute('position', new BufferAttribute(Float32Array.from(lines), 3));
      this.cellLines = new LineSegments(geometry, new LineBasicMaterial({ color: '#5b6b7c', transparent: true, opacity: 0.55 }));
      this.cellLines.raycast = () => undefined;
      this.frame.add(this.cellLines);
    }
  }

  /** Those whose middle is below the cut, which is across an axis of the object. */
  private keptCells(cells: Cells, look: CellsLook): boolean[] {
    const count = cells.cells.length / 4;
    if (look.cutAxis === 'none') return new Array<boolean>(count).fill(true);
    const axis = { x: 0, y: 1, z: 2 }[look.cutAxis];
    let low = Number.POSITIVE_INFINITY;
    let high = Number.NEGATIVE_INFINITY;
    for (let i = axis; i < cells.vertices.length; i += 3) {
      low = Math.min(low, cells.vertices[i] as number);
      high = Math.max(high, cells.vertices[i] as number);
    }
    const limit = low + look.cutAt * (high - low);
    const plane = new Plane(new Vector3().setComponent(axis, 1), -limit);
    const middle = new Vector3();
    return Array.from({ length: count }, (_, cell) => {
      middle.set(0, 0, 0);
      for (let k = 0; k < 4; ++k) {
        const vertex = 3 * (cells.cells[4 * cell + k] as number);
        for (let c = 0; c < 3; ++c) {
          middle.setComponent(c, middle.getComponent(c) + (cells.vertices[vertex + c] as number) / 4);
        }
      }
      return plane.distanceToPoint(middle) <= 0;
    });
  }

  dispose(): void {
    this.dropCells();
    this.surface.geometry.dispose();
    this.surface.material.dispose();
  }
}

export class SceneObjects {
  readonly root = new Group();
  readonly items: SceneObject[];
  private readonly position = new Vector3();
  private readonly orientation = new Quaternion();

  constructor(scene: SceneDescription) {
    const count = scene.scene?.object.length ?? 0;
    this.items = Array.from({ length: count }, (_, i) => new SceneObject(i, scene));
    for (const item of this.items) this.root.add(item.frame);
  }

  place(frame: ObjectsFrame): void {
    const { position, orientation } = frame;
    this.items.forEach((item, i) => {
      if (position.length < 3 * i + 3 || orientation.length < 4 * i + 4) return;
      this.position.fromArray(position, 3 * i);
      this.orientation.set(
        orientation[4 * i + 1] as number,
        orientation[4 * i + 2] as number,
        orientation[4 * i + 3] as number,
        orientation[4 * i] as number,
      );
      item.place(this.position, this.orientation);
    });
  }

  private readonly inverse = new Matrix4();
  private readonly local = new Vector3();
  private readonly hit = { point: new Vector3(), distance: 0, faceIndex: 0 };

  /** Unit normal of the surface of object `index` where it is nearest to `point`, in world; false if it has none. */
  normalAt(index: number, point: Vector3, normal: Vector3): boolean {
    const item = this.items[index];
    if (!item?.bvh) return false;
    this.inverse.copy(item.frame.matrix).invert();
    this.local.copy(point).applyMatrix4(this.inverse);
    const found = item.bvh.closestPointToPoint(this.local, this.hit);
    if (!found) return false;
    const positions = item.surface.geometry.getAttribute('position');
    // the tree orders triangles anew in the geometry's index
    const order = item.surface.geometry.index;
    const corner = (k: number): number => (order ? order.getX(3 * found.faceIndex + k) : 3 * found.faceIndex + k);
    const a = new Vector3().fromBufferAttribute(positions, corner(0));
    const b = new Vector3().fromBufferAttribute(positions, corner(1)).sub(a);
    const c = new Vector3().fromBufferAttribute(positions, corner(2)).sub(a);
    normal.crossVectors(b, c).normalize().applyQuaternion(item.frame.quaternion);
    return true;
  }

  dispose(): void {
    for (const item of this.items) item.dispose();
  }
}
