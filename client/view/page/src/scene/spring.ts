// The force of a held device, drawn as a spring between where it is and what holds it.
import { Curve, Mesh, MeshStandardMaterial, Quaternion, TubeGeometry, Vector3 } from 'three';
import { SPRING_COLOUR } from './palette';

const TURNS = 9;

class Helix extends Curve<Vector3> {
  // the base's is protected in its types
  constructor() {
    super();
  }

  override getPoint(t: number, out = new Vector3()): Vector3 {
    // the ends run in to the axis
    const radius = Math.min(1, 8 * t, 8 * (1 - t));
    const angle = 2 * Math.PI * TURNS * t;
    return out.set(radius * Math.cos(angle), t, radius * Math.sin(angle));
  }
}

const up = new Vector3(0, 1, 0);

export class Spring {
  readonly mesh: Mesh<TubeGeometry, MeshStandardMaterial>;
  private readonly way = new Vector3();
  private readonly turn = new Quaternion();

  constructor(private readonly radius: number) {
    this.mesh = new Mesh(
      new TubeGeometry(new Helix(), 220, 0.14, 6),
      new MeshStandardMaterial({ color: SPRING_COLOUR, roughness: 0.4, metalness: 0.2 }),
    );
    this.mesh.frustumCulled = false;
    this.mesh.raycast = () => undefined;
    this.mesh.visible = false;
  }

  stretch(from: Vector3, to: Vector3): void {
    this.way.subVectors(to, from);
    const length = this.way.length();
    this.mesh.visible = length > this.radius / 50;
    if (!this.mesh.visible) return;
    this.mesh.position.copy(from);
    this.mesh.quaternion.copy(this.turn.setFromUnitVectors(up, this.way.divideScalar(length)));
    this.mesh.scale.set(this.radius, length, this.radius);
  }

  hide(): void {
    this.mesh.visible = false;
  }
}
