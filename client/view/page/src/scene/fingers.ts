// Fingers as the scene describes them: how large they are, and the body that is drawn around their HIPs.
import { Group, Mesh, MeshStandardMaterial, SphereGeometry } from 'three';
import type { SceneDescription } from '../gen/haptic/v1/control_pb';
import type { DeviceDescription } from '../gen/haptic/v1/device_pb';
import type { Finger } from '../gen/haptic/v1/scene_pb';
import type { DevicesFrame } from '../gen/haptic/v1/telemetry_pb';
import { seriesColour } from './palette';

/** The greatest distance of a HIP from the device's origin, m. */
export function reachOf(finger: Finger): number {
  const { layout } = finger;
  const length = (v: { x: number; y: number; z: number } | undefined): number => (v ? Math.hypot(v.x, v.y, v.z) : 0);
  switch (layout.case) {
    case 'fingertip':
      return layout.value.radius;
    case 'line':
      return Math.max(length(layout.value.start), length(layout.value.end));
    case 'points':
      return Math.max(0, ...layout.value.hip.map(length));
    default:
      return 0;
  }
}

export interface FingerSpan {
  name: string;
  device: string;
  firstHip: number;
  hips: number;
  reach: number; // m
}

export function fingersOf(scene: SceneDescription): FingerSpan[] {
  return scene.finger.map((finger, i) => ({
    name: finger.name,
    device: finger.device,
    firstHip: finger.firstHip,
    hips: finger.hips,
    reach: scene.scene?.finger[i] ? reachOf(scene.scene.finger[i]) : 0,
  }));
}

/** A ball at each device on which a finger rides: something to see and to take hold of. */
export class FingerBodies {
  readonly root = new Group();
  readonly bodies: { mesh: Mesh<SphereGeometry, MeshStandardMaterial>; name: string; finger: number; device: number }[] = [];
  private readonly geometry = new SphereGeometry(1, 28, 18);

  constructor(scene: SceneDescription, devices: DeviceDescription[], smallest: number) {
    fingersOf(scene).forEach((finger, i) => {
      const device = devices.findIndex((description) => description.name === finger.device);
      if (device < 0) return;
      const mesh = new Mesh(
        this.geometry,
        new MeshStandardMaterial({ color: seriesColour(i), roughness: 0.6, transparent: true, opacity: 0.28, depthWrite: false }),
      );
      mesh.scale.setScalar(Math.max(0.92 * finger.reach, smallest));
      mesh.userData.finger = i;
      mesh.visible = false;
      this.root.add(mesh);
      this.bodies.push({ mesh, name: finger.name, finger: i, device });
    });
  }

  place(frame: DevicesFrame): void {
    for (const { mesh, device } of this.bodies) {
      mesh.visible = frame.present[device] === true && frame.position.length >= 3 * device + 3;
      if (mesh.visible) mesh.position.fromArray(frame.position, 3 * device);
    }
  }

  select(finger: number): void {
    for (const body of this.bodies) body.mesh.material.opacity = body.finger === finger ? 0.5 : 0.28;
  }

  dispose(): void {
    this.geometry.dispose();
    for (const { mesh } of this.bodies) mesh.material.dispose();
  }
}
