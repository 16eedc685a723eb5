// A card for each device: where it stands, how fresh its samples are, what it does to its user.
import type { DeviceDescription, DeviceStatus } from '../gen/haptic/v1/device_pb';
import { DevicePhase, FaultKind } from '../gen/haptic/v1/device_pb';
import type { Moment } from '../model/moment';
import { nameOfFault, nameOfPhase, namesOfLimits } from '../model/words';
import { seriesColour } from '../scene/palette';
import { h, number, setClass, setText, time } from './dom';

export interface DeviceActions {
  select(device: number): void;
  /** A virtual device, which the pointer can move: put into the scene, or taken out of the way. */
  hand(device: string): void;
}

class Card {
  private readonly phase = h('span', { class: 'chip phase' });
  private readonly bar = h('i', {});
  private readonly force = h('b', { class: 'num' });
  private readonly age = h('b', { class: 'num' });
  private readonly speed = h('b', { class: 'num' });
  private readonly energy = h('b', { class: 'num' });
  private readonly more = h('p', { class: 'more' });
  readonly root: HTMLElement;

  constructor(
    private readonly description: DeviceDescription,
    private readonly index: number,
    actions: DeviceActions,
    canMove: boolean,
  ) {
    const swatch = h('span', { class: 'swatch' });
    swatch.style.background = seriesColour(index);
    const cell = (name: string, value: HTMLElement): HTMLElement => h('div', {}, h('span', { class: 'label' }, name), value);
    this.root = h(
      'article',
      { class: 'card device', 'data-device': description.name },
      h(
        'button',
        { class: 'title', onclick: () => actions.select(index), title: 'Select its finger' },
        swatch,
        h('strong', {}, description.name),
        h('span', { class: 'quiet' }, description.driver),
      ),
      this.phase,
      h('div', { class: 'meter', title: `of ${number(description.maxForce, 'N', 1)} at most` }, this.bar),
      h('div', { class: 'cells' }, cell('force', this.force), cell('sample age', this.age), cell('speed', this.speed), cell('energy', this.energy)),
      this.more,
      canMove
        ? h('button', { class: 'small hand', onclick: () => actions.hand(description.name), title: 'Put it beside the scene, to be dragged with the pointer' }, 'Put beside')
        : undefined,
    );
  }

  update(moment: Moment | undefined, status: DeviceStatus | undefined): void {
    const frame = moment?.devices;
    const i = this.index;
    const present = frame?.present[i] === true;
    const fault = frame?.fault[i] ?? FaultKind.FAULT_NONE;
    const told = frame?.phase[i] ?? status?.phase ?? DevicePhase.DEVICE_PHASE_UNSPECIFIED;
    const phase = nameOfPhase(told, present, moment?.armed === true, fault);
    setText(this.phase, phase);
    this.phase.dataset.phase = phase;
    setClass(this.root, 'absent', !present);
    const at = (values: number[] | undefined): number =>
      values && values.length >= 3 * i + 3
        ? Math.hypot(values[3 * i] as number, values[3 * i + 1] as number, values[3 * i + 2] as number)
        : Number.NaN;
    const force = at(frame?.force);
    setText(this.force, number(force, 'N'));
    const share = this.description.maxForce > 0 && Number.isFinite(force) ? force / this.description.maxForce : 0;
    this.bar.style.transform = `scaleX(${Math.min(1, share).toFixed(3)})`;
    setText(this.age, present ? time(frame?.sampleAge[i] ?? Number.NaN) : '–');
    setText(this.speed, number(at(frame?.velocity), 'm/s'));
    const energy = frame?.energy[i];
    setText(this.energy, energy === undefined ? '–' : number(energy, 'J', 3));
    const limits = namesOfLimits(frame?.limits[i] ?? 0);
    const words = [
      fault === FaultKind.FAULT_NONE ? '' : nameOfFault(fault),
      status?.reason ?? '',
      limits.length > 0 ? `limited: ${limits.join(', ')}` : '',
      (frame?.buttons[i] ?? 0) !== 0 ? `buttons ${(frame?.buttons[i] ?? 0).toString(2)}` : '',
      status?.serial ? `serial ${status.serial}` : '',
    ];
    setText(this.more, words.filter(Boolean).join(' · '));
  }
}

export class DevicesPanel {
  readonly list = h('div', { class: 'cards' });
  private cards: Card[] = [];
  private statuses: DeviceStatus[] = [];

  constructor(private readonly actions: DeviceActions) {}

  setDevices(devices: DeviceDescription[], mayDrive: boolean): void {
    this.cards = devices.map((device, i) => new Card(device, i, this.actions, mayDrive && device.driver === 'virtual'));
    this.list.replaceChildren(
      ...(this.cards.length > 0 ? this.cards.map((card) => card.root) : [h('p', { class: 'quiet empty' }, 'No device.')]),
    );
  }

  setStatuses(statuses: DeviceStatus[]): void {
    this.statuses = statuses;
  }

  update(moment: Moment | undefined): void {
    this.cards.forEach((card, i) => card.update(moment, this.statuses[i]));
  }
}
