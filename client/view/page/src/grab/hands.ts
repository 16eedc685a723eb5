// Virtual devices that the pointer moves: taken to a surface, dragged in a plane that faces the camera, let go where
// they are. Two of them pinch, and dragged together they lift.
import { Plane, Vector3 } from 'three';
import type { SceneDescription } from '../gen/haptic/v1/control_pb';
import type { DeviceDescription } from '../gen/haptic/v1/device_pb';
import type { Moment } from '../model/moment';
import { type FingerSpan, fingersOf } from '../scene/fingers';
import { Spring } from '../scene/spring';
import type { SceneView, Selection } from '../scene/view';

const CLICK = 4; // px that a click may wander
const PRESS = 0.004; // m beyond the plane through what was hit, away from the camera: so that there is something to feel
const PRESS_STEP = 0.001; // m for a notch of the wheel
const CLEARANCE = 0.003; // m from the surface where a hand begins
const NO_FORCE = 1e-6; // N

export interface Holder {
  hold(device: string, target: [number, number, number]): void;
}

interface Hand {
  name: string;
  device: number;
  finger: FingerSpan | undefined;
  stiffness: number; // N/m of each HIP
  held: boolean;
  target: Vector3;
  spring: Spring;
}

interface Drag {
  pointer: number;
  startX: number;
  startY: number;
  /** What it may become, once it moves. */
  begin: (() => Hand | undefined) | undefined;
  hand: Hand | undefined;
  plane: Plane;
  offset: Vector3; // from the point of the plane under the pointer to the target
  press: number; // m, along the view
  selection: Selection;
}

export class Hands {
  private hands: Hand[] = [];
  private drag: Drag | undefined;
  private readonly at = new Vector3();
  private readonly mean = new Vector3();
  mayDrive = false;
  /** The picture shows what is now, and not something recorded or past. */
  live = true;

  constructor(
    private readonly view: SceneView,
    private readonly holder: Holder,
    private readonly select: (selection: Selection) => void,
  ) {
    const area = view.stage.renderer.domElement.parentElement as HTMLElement;
    area.addEventListener('pointerdown', (event) => this.down(event), { capture: true });
    area.addEventListener('pointermove', (event) => this.move(event), { capture: true });
    area.addEventListener('pointerup', (event) => this.up(event), { capture: true });
    area.addEventListener('pointercancel', () => this.cancel(), { capture: true });
    area.addEventListener('wheel', (event) => this.wheel(event), { capture: true, passive: false });
  }

  /** Any that is held must be told again and again. */
  get holding(): boolean {
    return this.hands.some((hand) => hand.held);
  }

  setScene(scene: SceneDescription | undefined, devices: DeviceDescription[]): void {
    const held = new Map(this.hands.filter((hand) => hand.held).map((hand) => [hand.name, hand.target]));
    for (const hand of this.hands) hand.spring.mesh.removeFromParent();
    const spans = scene ? fingersOf(scene) : [];
    this.hands = devices.flatMap((device, index) => {
      if (device.driver !== 'virtual') return [];
      const finger = spans.findIndex((span) => span.device === device.name);
      const spring = new Spring(0.022 * this.view.size);
      this.view.stage.scene.add(spring.mesh);
      const target = held.get(device.name);
      return {
        name: device.name,
        device: index,
        finger: spans[finger],
        stiffness: scene?.scene?.finger[finger]?.stiffness ?? Number.NaN,
        held: target !== undefined,
        target: target ?? new Vector3(),
        spring,
      };
    });
    this.drag = undefined;
  }

  /** The connection is gone, and with it what was held. */
  forget(): void {
    for (const hand of this.hands) hand.held = false;
    this.cancel();
  }

  /** Beside the scene, where it touches nothing and can be dragged from. */
  putBeside(name: string): void {
    const place = this.hands.findIndex((hand) => hand.name === name);
    const hand = this.hands[place];
    if (!hand || !this.mayDrive) return;
    const { camera, controls } = this.view.stage;
    const right = new Vector3().setFromMatrixColumn(camera.matrixWorld, 0);
    const side = (place % 2 === 0 ? -1 : 1) * (0.85 + 0.25 * Math.floor(place / 2)) * this.view.size;
    this.tell(hand, controls.target.clone().addScaledVector(right, side));
  }

  /** Springs of held hands, as the moment has them. */
  draw({ hips, devices }: Moment): void {
    for (const hand of this.hands) {
      hand.spring.hide();
      const { finger } = hand;
      if (!finger || !hips || !devices || !devices.present[hand.device]) continue;
      let touching = 0;
      this.mean.set(0, 0, 0);
      for (let hip = finger.firstHip; hip < finger.firstHip + finger.hips; ++hip) {
        this.at.fromArray(hips.force, 3 * hip);
        if (!(this.at.length() > NO_FORCE)) continue;
        this.mean.add(this.at);
        touching += 1;
      }
      if (touching === 0 || !(hand.stiffness > 0)) continue;
      this.at.fromArray(devices.position, 3 * hand.device);
      this.mean.divideScalar(touching * hand.stiffness).add(this.at);
      hand.spring.stretch(this.at, this.mean);
    }
  }

  private tell(hand: Hand, target: Vector3): void {
    hand.held = true;
    hand.target.copy(target);
    this.holder.hold(hand.name, [target.x, target.y, target.z]);
  }

  private down(event: PointerEvent): void {
    if (event.button !== 0 || event.target !== this.view.stage.renderer.domElement) return;
    if (this.drag) return this.cancel();
    const picked = this.view.pick(event.clientX, event.clientY);
    const drag: Drag = {
      pointer: event.pointerId,
      startX: event.clientX,
      startY: event.clientY,
      begin: undefined,
      hand: undefined,
      plane: new Plane(),
      offset: new Vector3(),
      press: 0,
      selection: picked?.selection,
    };
    if (picked && this.mayDrive && this.live) {
      if (picked.selection.kind === 'finger') {
        const name = this.hands.find((hand) => hand.finger && hand.finger === this.spanOf(hand, picked.selection.index));
        if (name) drag.begin = () => this.take(drag, name);
      } else {
        const free = this.hands.find((hand) => hand.finger && !hand.held) ?? this.idleHand();
        if (free) drag.begin = () => this.bring(drag, free, picked.point, picked.normal);
      }
    }
    this.drag = drag;
    if (drag.begin) event.stopPropagation(); // the view does not turn
  }

  private spanOf(hand: Hand, finger: number): FingerSpan | undefined {
    const spans = this.view.objects ? this.view.bodies?.bodies.find((body) => body.finger === finger) : undefined;
    return spans?.device === hand.device ? hand.finger : undefined;
  }

  /** One that touches nothing. */
  private idleHand(): Hand | undefined {
    return this.hands.find((hand) => hand.finger && !hand.spring.mesh.visible);
  }

  private take(drag: Drag, hand: Hand): Hand {
    const place = this.view.bodies?.bodies.find((body) => body.device === hand.device)?.mesh.position;
    if (!hand.held && place) hand.target.copy(place);
    this.facePlane(drag, hand.target);
    const under = this.underPointer(drag, drag.startX, drag.startY);
    if (under) drag.offset.subVectors(hand.target, under);
    return hand;
  }

  private bring(drag: Drag, hand: Hand, point: Vector3, normal: Vector3): Hand {
    const away = (hand.finger?.reach ?? 0) + CLEARANCE;
    this.tell(hand, point.clone().addScaledVector(normal, away));
    this.facePlane(drag, point);
    drag.press = PRESS;
    return hand;
  }

  private facePlane(drag: Drag, through: Vector3): void {
    const { camera } = this.view.stage;
    drag.plane.setFromNormalAndCoplanarPoint(camera.getWorldDirection(new Vector3()).negate(), through);
  }

  private underPointer(drag: Drag, x: number, y: number): Vector3 | undefined {
    return this.view.aim(x, y).ray.intersectPlane(drag.plane, new Vector3()) ?? undefined;
  }

  private move(event: PointerEvent): void {
    const { drag } = this;
    if (!drag || event.pointerId !== drag.pointer) return;
    const far = Math.hypot(event.clientX - drag.startX, event.clientY - drag.startY) > CLICK;
    if (far && !drag.hand && drag.begin) {
      drag.hand = drag.begin();
      (event.target as Element).setPointerCapture?.(event.pointerId);
    }
    if (!drag.hand) return;
    event.stopPropagation();
    this.follow(drag, event.clientX, event.clientY, event.shiftKey);
  }

  private follow(drag: Drag, x: number, y: number, together: boolean): void {
    const under = this.underPointer(drag, x, y);
    if (!under || !drag.hand) return;
    const target = under.add(drag.offset).addScaledVector(drag.plane.normal, -drag.press);
    const way = target.clone().sub(drag.hand.target);
    for (const hand of together ? this.hands.filter((other) => other.held) : [drag.hand]) {
      this.tell(hand, hand.target.clone().add(way));
    }
  }

  private wheel(event: WheelEvent): void {
    const { drag } = this;
    if (!drag?.hand) return;
    event.preventDefault();
    event.stopPropagation();
    drag.press -= Math.sign(event.deltaY) * PRESS_STEP;
    this.follow(drag, event.clientX, event.clientY, event.shiftKey);
  }

  private up(event: PointerEvent): void {
    const { drag } = this;
    if (!drag || event.pointerId !== drag.pointer) return;
    this.drag = undefined;
    if (drag.hand) {
      event.stopPropagation();
      return;
    }
    if (Math.hypot(event.clientX - drag.startX, event.clientY - drag.startY) <= CLICK) this.select(drag.selection);
  }

  private cancel(): void {
    this.drag = undefined;
  }
}
