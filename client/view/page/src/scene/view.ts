// The picture of a moment: everything of a scene, put where the moment says.
import { Raycaster, Sphere, Vector2, Vector3 } from 'three';
import type { SceneDescription } from '../gen/haptic/v1/control_pb';
import type { DeviceDescription } from '../gen/haptic/v1/device_pb';
import type { Moment } from '../model/moment';
import { Arrows } from './arrows';
import { FingerBodies } from './fingers';
import { type HipColouring, Hips } from './hips';
import { type CellsLook, SceneObjects } from './objects';
import { DEVICE_FORCE_COLOUR, FORCE_COLOUR, OBJECT_FORCE_COLOUR } from './palette';
import { roundUp, Stage } from './stage';

export interface Look extends CellsLook {
  hips: boolean;
  proxies: boolean;
  colouring: HipColouring;
  hipForces: boolean;
  deviceForces: boolean;
  objectForces: boolean;
  /** m of an arrow for 1 N. */
  arrowScale: number;
}

export const initialLook: Look = {
  shown: false,
  wireframe: true,
  cutAxis: 'none',
  cutAt: 0.5,
  byMaterial: true,
  hips: true,
  proxies: true,
  colouring: 'state',
  hipForces: true,
  deviceForces: true,
  objectForces: false,
  arrowScale: 0.02,
};

export type Selection = { kind: 'object' | 'finger'; index: number } | undefined;
export interface Picked {
  selection: NonNullable<Selection>;
  point: Vector3;
  normal: Vector3;
}

/** Away from the floor: against gravity, or +y. */
export function upOf(scene: SceneDescription): Vector3 {
  const gravity = scene.scene?.gravity;
  const up = new Vector3(-(gravity?.x ?? 0), -(gravity?.y ?? 0), -(gravity?.z ?? 0));
  return up.lengthSq() > 0 ? up.normalize() : new Vector3(0, 1, 0);
}

export class SceneView {
  readonly stage: Stage;
  objects: SceneObjects | undefined;
  bodies: FingerBodies | undefined;
  readonly hips = new Hips();
  readonly hipForces = new Arrows(FORCE_COLOUR, 0.001);
  readonly deviceForces = new Arrows(DEVICE_FORCE_COLOUR, 0.002, 8);
  readonly objectForces = new Arrows(OBJECT_FORCE_COLOUR, 0.002, 8);
  size = 0.05; // m, radius of the scene
  hipRadius = 0.001; // m
  private revision: bigint | undefined;
  /** The moment that is drawn. */
  current: Moment | undefined;
  private stale = true; // what is drawn is not as it should be, though the moment is
  private readonly caster = new Raycaster();

  constructor(
    canvas: HTMLCanvasElement,
    readonly look: Look,
    adapts: boolean,
  ) {
    this.stage = new Stage(canvas, adapts);
    this.stage.scene.add(this.hips.root, this.hipForces.root, this.deviceForces.root, this.objectForces.root);
  }

  /** Another scene, or none. The camera stays unless the scene has another name. */
  setScene(scene: SceneDescription | undefined, devices: DeviceDescription[], keepCamera: boolean): void {
    for (const part of [this.objects, this.bodies]) {
      part?.root.removeFromParent();
      part?.dispose();
    }
    this.objects = undefined;
    this.bodies = undefined;
    this.current = undefined;
    this.revision = scene?.revision;
    if (!scene) {
      this.stage.draw();
      return;
    }
    this.objects = new SceneObjects(scene);
    this.stage.scene.add(this.objects.root);
    if (!keepCamera) {
      const bounds = this.boundsOf();
      this.size = bounds.radius;
      this.hipRadius = 0.013 * bounds.radius;
      this.look.arrowScale = roundUp(0.25 * bounds.radius);
      this.hipForces.setThickness(0.014 * bounds.radius);
      this.deviceForces.setThickness(0.028 * bounds.radius);
      this.objectForces.setThickness(0.028 * bounds.radius);
      this.stage.frame(bounds, upOf(scene));
    }
    this.bodies = new FingerBodies(scene, devices, 0.03 * this.size);
    this.stage.scene.add(this.bodies.root);
    this.applyLook(undefined);
  }

  private boundsOf(): Sphere {
    const bounds = new Sphere();
    bounds.makeEmpty();
    for (const item of this.objects?.items ?? []) {
      const sphere = item.surface.geometry.boundingSphere;
      if (!sphere || item.triangles === 0) continue;
      bounds.union(sphere.clone().applyMatrix4(item.frame.matrix));
    }
    if (bounds.isEmpty() || !(bounds.radius > 0)) return new Sphere(new Vector3(), 0.1);
    bounds.radius *= 1.5; // room for the fingers
    return bounds;
  }

  applyLook(selection: Selection): void {
    for (const item of this.objects?.items ?? []) {
      item.showCells(this.look, selection?.kind === 'object' && selection.index === item.index);
    }
    this.bodies?.select(selection?.kind === 'finger' ? selection.index : -1);
    this.stale = true;
    this.stage.draw();
  }

  show(moment: Moment | undefined): void {
    if (!moment || moment.revision !== this.revision || (moment === this.current && !this.stale)) return;
    this.current = moment;
    this.stale = false;
    const { look } = this;
    if (moment.objects) this.objects?.place(moment.objects);
    if (moment.devices) this.bodies?.place(moment.devices);
    if (moment.hips) this.hips.show(moment.hips, look, this.hipRadius);
    else this.hips.hide();
    this.drawForces(moment);
    this.stage.draw();
  }

  private drawForces({ hips, devices, objects }: Moment): void {
    const { look } = this;
    const hipCount = look.hipForces && hips ? Math.floor(hips.force.length / 3) : 0;
    this.hipForces.begin(hipCount);
    for (let i = 0; i < hipCount && hips; ++i) this.hipForces.add(hips.position, hips.force, 3 * i, look.arrowScale);
    this.hipForces.end();
    const deviceCount = look.deviceForces && devices ? Math.floor(devices.force.length / 3) : 0;
    this.deviceForces.begin(deviceCount);
    for (let i = 0; i < deviceCount && devices; ++i) {
      if (devices.present[i]) this.deviceForces.add(devices.position, devices.force, 3 * i, look.arrowScale);
    }
    this.deviceForces.end();
    const objectCount = look.objectForces && objects ? Math.floor(objects.force.length / 3) : 0;
    this.objectForces.begin(objectCount);
    for (let i = 0; i < objectCount && objects; ++i) {
      this.objectForces.add(objects.position, objects.force, 3 * i, look.arrowScale);
    }
    this.objectForces.end();
  }

  /** A ray through the point of the page. */
  aim(clientX: number, clientY: number): Raycaster {
    const box = this.stage.renderer.domElement.getBoundingClientRect();
    const at = new Vector2(
      ((clientX - box.left) / box.width) * 2 - 1,
      1 - ((clientY - box.top) / box.height) * 2,
    );
    this.stage.camera.updateMatrixWorld();
    this.caster.setFromCamera(at, this.stage.camera);
    return this.caster;
  }

  /** What is seen there. A finger that is not far in front of or behind what is hit goes first. */
  pick(clientX: number, clientY: number): Picked | undefined {
    const caster = this.aim(clientX, clientY);
    const fingers = this.bodies?.root.children.filter((child) => child.visible) ?? [];
    for (const part of [this.bodies?.root, this.objects?.root]) part?.updateMatrixWorld(true);
    const hits = caster.intersectObjects([...fingers, ...(this.objects?.items.map((item) => item.surface) ?? [])], false);
    const nearest = hits[0];
    if (!nearest) return undefined;
    const finger = hits.find(
      (hit) => hit.object.userData.finger !== undefined && hit.distance < nearest.distance + 0.25 * this.size,
    );
    const hit = finger ?? nearest;
    const normal = (hit.face?.normal.clone() ?? new Vector3(0, 1, 0)).transformDirection(hit.object.matrixWorld);
    const { finger: fingerIndex, object } = hit.object.userData as { finger?: number; object?: number };
    return {
      selection:
        fingerIndex !== undefined ? { kind: 'finger', index: fingerIndex } : { kind: 'object', index: object as number },
      point: hit.point.clone(),
      normal,
    };
  }

  get triangles(): number {
    return (this.objects?.items ?? []).reduce((sum, item) => sum + item.triangles, 0);
  }
}
