// HIPs, their proxies, and the line between the two.
import {
  BufferAttribute,
  BufferGeometry,
  Color,
  DynamicDrawUsage,
  Group,
  InstancedMesh,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  MeshStandardMaterial,
  SphereGeometry,
} from 'three';
import { ConstraintState, type HipsFrame } from '../gen/haptic/v1/telemetry_pb';
import { slippingColour, stateColours, stickingColour } from './palette';

export type HipColouring = 'state' | 'slipping';

export interface HipsLook {
  hips: boolean;
  proxies: boolean;
  colouring: HipColouring;
}

const NO_FORCE = 1e-6; // N
const free = new Color(stateColours[ConstraintState.OUT]);
const matrix = new Matrix4();

export class Hips {
  readonly root = new Group();
  private readonly geometry = new SphereGeometry(1, 12, 8);
  private readonly hipMaterial = new MeshStandardMaterial({ roughness: 0.45 });
  private readonly proxyMaterial = new MeshStandardMaterial({ roughness: 0.3, transparent: true, opacity: 0.75 });
  private readonly lineMaterial = new LineBasicMaterial({ color: '#b9c2cc' });
  private hips: InstancedMesh | undefined;
  private proxies: InstancedMesh | undefined;
  private lines: LineSegments<BufferGeometry, LineBasicMaterial> | undefined;
  private colours: Color[] = [];
  /** State of each HIP with the firmest hold, for the numbers. */
  states: ConstraintState[] = [];

  private reserve(hips: number, contacts: number): void {
    if (!this.hips || this.hips.instanceMatrix.count < hips) {
      this.hips?.removeFromParent();
      this.hips?.dispose();
      this.hips = this.instances(this.hipMaterial, Math.max(32, hips));
    }
    if (!this.proxies || this.proxies.instanceMatrix.count < contacts) {
      this.proxies?.removeFromParent();
      this.proxies?.dispose();
      this.proxies = this.instances(this.proxyMaterial, Math.max(32, 2 * contacts));
    }
    const places = this.lines?.geometry.getAttribute('position').count ?? 0;
    if (!this.lines || places < 2 * contacts) {
      this.lines?.removeFromParent();
      this.lines?.geometry.dispose();
      const geometry = new BufferGeometry();
      const attribute = new BufferAttribute(new Float32Array(6 * Math.max(32, 2 * contacts)), 3);
      attribute.setUsage(DynamicDrawUsage);
      geometry.setAttribute('position', attribute);
      this.lines = new LineSegments(geometry, this.lineMaterial);
      this.lines.frustumCulled = false;
      this.lines.raycast = () => undefined;
      this.root.add(this.lines);
    }
  }

  private instances(material: MeshStandardMaterial, capacity: number): InstancedMesh {
    const mesh = new InstancedMesh(this.geometry, material, capacity);
    mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    mesh.frustumCulled = false;
    mesh.raycast = () => undefined;
    this.root.add(mesh);
    return mesh;
  }

  /** `radius`: of a HIP, m. */
  show(frame: HipsFrame, look: HipsLook, radius: number): void {
    const count = Math.floor(frame.position.length / 3);
    const contacts = frame.contactHip.length;
    this.reserve(count, contacts);
    const { hips, proxies, lines } = this;
    if (!hips || !proxies || !lines) return;

    while (this.colours.length < count) this.colours.push(new Color());
    for (let i = 0; i < count; ++i) {
      (this.colours[i] as Color).copy(free);
      this.states[i] = ConstraintState.OUT;
    }
    this.states.length = count;
    const places = lines.geometry.getAttribute('position') as BufferAttribute;
    for (let c = 0; c < contacts; ++c) {
      const hip = frame.contactHip[c] as number;
      const state = frame.contactState[c] ?? ConstraintState.OUT;
      const f = frame.contactForce;
      const force = Math.hypot(f[3 * c] ?? 0, f[3 * c + 1] ?? 0, f[3 * c + 2] ?? 0);
      const touches = force > NO_FORCE;
      const colour =
        look.colouring === 'state'
          ? (stateColours[state] ?? free)
          : !touches
            ? free
            : frame.contactSlipping[c]
              ? slippingColour
              : stickingColour;
      if (hip < count && (touches || this.states[hip] === ConstraintState.OUT)) {
        (this.colours[hip] as Color).copy(colour);
        this.states[hip] = state;
      }
      const [x, y, z] = [3 * c, 3 * c + 1, 3 * c + 2].map((k) => frame.contactProxy[k] ?? 0) as [number, number, number];
      const size = touches ? 0.8 * radius : 0;
      proxies.setMatrixAt(c, matrix.makeScale(size, size, size).setPosition(x, y, z));
      proxies.setColorAt(c, colour);
      places.setXYZ(2 * c, x, y, z);
      places.setXYZ(2 * c + 1, frame.position[3 * hip] ?? x, frame.position[3 * hip + 1] ?? y, frame.position[3 * hip + 2] ?? z);
    }
    for (let i = 0; i < count; ++i) {
      matrix.makeScale(radius, radius, radius);
      matrix.setPosition(frame.position[3 * i] as number, frame.position[3 * i + 1] as number, frame.position[3 * i + 2] as number);
      hips.setMatrixAt(i, matrix);
      hips.setColorAt(i, this.colours[i] as Color);
    }
    hips.count = count;
    proxies.count = contacts;
    lines.geometry.setDrawRange(0, 2 * contacts);
    hips.visible = look.hips;
    proxies.visible = look.proxies;
    lines.visible = look.proxies;
    places.needsUpdate = true;
    for (const mesh of [hips, proxies]) {
      mesh.instanceMatrix.needsUpdate = true;
      if (mesh.instanceColor) mesh.instanceColor.needsUpdate = true;
    }
  }

  hide(): void {
    this.states = [];
    for (const part of [this.hips, this.proxies, this.lines]) {
      if (part) part.visible = false;
    }
  }
}
