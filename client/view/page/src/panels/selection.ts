// The numbers of the object or the finger that is selected.
import type { SceneDescription } from '../gen/haptic/v1/control_pb';
import { ConstraintState } from '../gen/haptic/v1/telemetry_pb';
import type { Moment } from '../model/moment';
import { nameOfState, STATES } from '../model/words';
import { fingersOf } from '../scene/fingers';
import { STATE_COLOURS } from '../scene/palette';
import type { Selection } from '../scene/view';
import { h, number, setText } from './dom';

type Row = [label: string, value: string];

const three = (values: ArrayLike<number>, offset: number): [number, number, number] => [
  values[offset] ?? Number.NaN,
  values[offset + 1] ?? Number.NaN,
  values[offset + 2] ?? Number.NaN,
];
const vector = (v: [number, number, number], unit: string, factor = 1, digits = 1): string =>
  `${v.map((x) => (x * factor).toFixed(digits)).join('  ')} ${unit}`;

/** Angle of a rotation w, x, y, z in degrees. */
function turn(q: ArrayLike<number>, offset: number): number {
  return (2 * Math.acos(Math.min(1, Math.abs(q[offset] ?? 1))) * 180) / Math.PI;
}

export class SelectionPanel {
  readonly choice = h('select', { 'aria-label': 'Selected object or finger', id: 'selected' });
  readonly body = h('dl', { class: 'rows' });
  readonly root = h('div', {}, this.choice, this.body);
  private scene: SceneDescription | undefined;
  private values: HTMLElement[] = [];
  private labels = '';

  constructor(onselect: (selection: Selection) => void) {
    this.choice.addEventListener('change', () => {
      const [kind, index] = this.choice.value.split('/');
      onselect(kind === 'object' || kind === 'finger' ? { kind, index: Number(index) } : undefined);
    });
  }

  setScene(scene: SceneDescription | undefined): void {
    this.scene = scene;
    const option = (kind: string, name: string, i: number): HTMLElement => h('option', { value: `${kind}/${i}` }, name);
    this.choice.replaceChildren(
      h('option', { value: '' }, 'Nothing selected – click in the scene'),
      h('optgroup', { label: 'Objects' }, ...(scene?.object.map((object, i) => option('object', object.name, i)) ?? [])),
      h('optgroup', { label: 'Fingers' }, ...(scene?.finger.map((finger, i) => option('finger', finger.name, i)) ?? [])),
    );
  }

  select(selection: Selection): void {
    this.choice.value = selection ? `${selection.kind}/${selection.index}` : '';
  }

  update(moment: Moment | undefined, selection: Selection): void {
    let rows: Row[] = [];
    if (selection && moment) {
      rows = selection.kind === 'object' ? this.object(moment, selection.index) : this.finger(moment, selection.index);
    }
    const labels = rows.map(([label]) => label).join();
    if (labels !== this.labels) {
      this.labels = labels;
      this.values = rows.map(() => h('dd', { class: 'num' }));
      this.body.replaceChildren(...rows.flatMap(([label], i) => [h('dt', {}, label), this.values[i] as HTMLElement]));
      for (const state of STATES) {
        const at = rows.findIndex(([label]) => label === nameOfState(state));
        if (at >= 0) this.body.querySelectorAll('dt')[at]?.style.setProperty('--state', STATE_COLOURS[state]);
      }
    }
    rows.forEach(([, value], i) => setText(this.values[i] as HTMLElement, value));
  }

  private object({ objects }: Moment, i: number): Row[] {
    const described = this.scene?.object[i];
    const object = this.scene?.scene?.object[i];
    if (!described || !object || !objects) return [];
    const material = object.shape?.kind.case === 'mesh' ? object.region.map((r) => r.material).join(', ') : object.inside;
    return [
      ['position', vector(three(objects.position, 3 * i), 'mm', 1000)],
      ['turned by', number(turn(objects.orientation, 4 * i), '°', 1)],
      ['velocity', vector(three(objects.velocity, 3 * i), 'mm/s', 1000)],
      ['force by HIPs', vector(three(objects.force, 3 * i), 'N', 1, 2)],
      ['torque', vector(three(objects.torque, 3 * i), 'N mm', 1000, 2)],
      ['mass', described.mass > 0 ? number(described.mass * 1000, 'g', 1) : 'fixed'],
      ['shape', object.shape?.kind.case ?? '–'],
      ['material', material || '–'],
      ['cells', `${described.cells} with ${described.vertices} vertices`],
    ];
  }

  private finger({ hips, devices }: Moment, i: number): Row[] {
    const scene = this.scene;
    const finger = scene ? fingersOf(scene)[i] : undefined;
    if (!finger || !hips) return [];
    const last = finger.firstHip + finger.hips;
    const sum: [number, number, number] = [0, 0, 0];
    let largest = 0;
    for (let hip = finger.firstHip; hip < last; ++hip) {
      const f = three(hips.force, 3 * hip);
      f.forEach((value, k) => {
        sum[k as 0 | 1 | 2] += value;
      });
      largest = Math.max(largest, Math.hypot(...f));
    }
    const counts = new Map<ConstraintState, number>();
    const held = new Set<number>();
    let slipping = 0;
    hips.contactHip.forEach((hip, c) => {
      if (hip < finger.firstHip || hip >= last) return;
      const f = three(hips.contactForce, 3 * c);
      if (Math.hypot(...f) < 1e-6 || held.has(hip)) return;
      held.add(hip);
      const state = hips.contactState[c] ?? ConstraintState.OUT;
      counts.set(state, (counts.get(state) ?? 0) + 1);
      if (hips.contactSlipping[c]) slipping += 1;
    });
    counts.set(ConstraintState.OUT, finger.hips - held.size + (counts.get(ConstraintState.OUT) ?? 0));
    const stiffness = scene?.scene?.finger[i]?.stiffness ?? Number.NaN;
    return [
      ['device', finger.device + (devices ? '' : ' (not told)')],
      ['force', `${vector(sum, 'N', 1, 2)}`],
      ['magnitude', number(Math.hypot(...sum), 'N')],
      ['largest of a HIP', number(largest, 'N', 3)],
      ['deepest HIP', number((1000 * largest) / stiffness, 'mm')],
      ['stiffness', number(stiffness, 'N/m', 0)],
      ...STATES.map((state): Row => [nameOfState(state), String(counts.get(state) ?? 0)]),
      ['slipping', `${slipping} of ${held.size} that touch`],
    ];
  }
}
