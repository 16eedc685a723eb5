// Force arrows, all of one kind in two draw calls. An arrow is as long as its force times the scale, head included.
import { ConeGeometry, CylinderGeometry, Group, InstancedMesh, Matrix4, MeshStandardMaterial, Quaternion, Vector3 } from 'three';

const HEAD_SHARE = 0.3; // of an arrow's length, at most
const SMALLEST = 1e-6; // N; has no arrow

const up = new Vector3(0, 1, 0);
const at = new Vector3();
const direction = new Vector3();
const size = new Vector3();
const turn = new Quaternion();
const matrix = new Matrix4();

export class Arrows {
  readonly root = new Group();
  private shafts: InstancedMesh;
  private heads: InstancedMesh;
  private count = 0;
  private readonly material: MeshStandardMaterial;

  /** `thickness`: of the shaft, m. */
  constructor(
    colour: string,
    private thickness: number,
    private capacity = 64,
  ) {
    this.material = new MeshStandardMaterial({ color: colour, roughness: 0.5, emissive: colour, emissiveIntensity: 0.25 });
    this.shafts = this.make(new CylinderGeometry(0.5, 0.5, 1, 10).translate(0, 0.5, 0));
    this.heads = this.make(new ConeGeometry(0.5, 1, 14).translate(0, 0.5, 0));
  }

  private make(geometry: InstancedMesh['geometry']): InstancedMesh {
    const mesh = new InstancedMesh(geometry, this.material, this.capacity);
    mesh.frustumCulled = false;
    mesh.raycast = () => undefined;
    mesh.count = 0;
    this.root.add(mesh);
    return mesh;
  }

  setThickness(thickness: number): void {
    this.thickness = thickness;
  }

  begin(wanted: number): void {
    this.count = 0;
    if (wanted <= this.capacity) return;
    this.capacity = Math.max(wanted, 2 * this.capacity);
    for (const mesh of [this.shafts, this.heads]) {
      this.root.remove(mesh);
      mesh.dispose();
    }
    this.shafts = this.make(this.shafts.geometry);
    this.heads = this.make(this.heads.geometry);
  }

  /** Adds the force at `force[offset]` (N) at the place at `place[offset]` (m); `scale` in m/N. */
  add(place: ArrayLike<number>, force: ArrayLike<number>, offset: number, scale: number): void {
    direction.fromArray(force, offset);
    const magnitude = direction.length();
    if (!(magnitude > SMALLEST) || !Number.isFinite(magnitude)) return;
    const length = magnitude * scale;
    const head = Math.min(HEAD_SHARE * length, 4 * this.thickness);
    at.fromArray(place, offset);
    direction.divideScalar(magnitude);
    turn.setFromUnitVectors(up, direction);
    const width = Math.min(this.thickness, 0.3 * length);
    this.shafts.setMatrixAt(this.count, matrix.compose(at, turn, size.set(width, length - head, width)));
    at.addScaledVector(direction, length - head);
    this.heads.setMatrixAt(this.count, matrix.compose(at, turn, size.set(2.6 * width, head, 2.6 * width)));
    this.count += 1;
  }

  end(): void {
    for (const mesh of [this.shafts, this.heads]) {
      mesh.count = this.count;
      mesh.instanceMatrix.needsUpdate = true;
    }
  }

  /** Lengths as drawn, head included, m. */
  lengths(): number[] {
    return Array.from({ length: this.count }, (_, i) => {
      this.shafts.getMatrixAt(i, matrix);
      const shaft = size.setFromMatrixScale(matrix).y;
      this.heads.getMatrixAt(i, matrix);
      return shaft + size.setFromMatrixScale(matrix).y;
    });
  }

  dispose(): void {
    this.shafts.geometry.dispose();
    this.heads.geometry.dispose();
    this.shafts.dispose();
    this.heads.dispose();
    this.material.dispose();
  }
}
