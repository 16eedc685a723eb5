// The line at the top: what the page is connected to, whether force is allowed, and how to end it.
import { h, setClass, setText } from './dom';

export interface HeaderActions {
  arm(): void;
  disarm(): void;
  stop(): void;
  theme(): void;
  help(): void;
  open(): void;
  live(): void;
}

export class Header {
  private readonly dot = h('span', { class: 'dot', 'aria-hidden': 'true' });
  private readonly connection = h('span', { id: 'connection', role: 'status' });
  private readonly scene = h('span', { id: 'scene-name' });
  private readonly pace = h('span', { class: 'quiet hide-narrow', id: 'pace' });
  private readonly armed = h('span', { class: 'chip', id: 'armed' });
  readonly arm: HTMLButtonElement;
  readonly disarm: HTMLButtonElement;
  readonly stop: HTMLButtonElement;
  private readonly live: HTMLButtonElement;
  readonly root: HTMLElement;

  constructor(actions: HeaderActions) {
    this.arm = h('button', { id: 'arm', class: 'go', onclick: () => actions.arm(), title: 'Allow force (A)' }, 'Arm');
    this.disarm = h('button', { id: 'disarm', onclick: () => actions.disarm(), title: 'Forbid force; it goes down smoothly (D)' }, 'Disarm');
    this.stop = h(
      'button',
      { id: 'stop', class: 'stop', onclick: () => actions.stop(), title: 'All forces end at once, and a fault is latched (S)' },
      'STOP',
    );
    this.live = h('button', { id: 'live', class: 'accent', hidden: true, onclick: () => actions.live() }, 'Back to now');
    this.root = h(
      'header',
      { class: 'bar' },
      h('h1', {}, 'haptic', h('span', {}, 'view')),
      h('div', { class: 'where' }, this.dot, this.connection, this.scene, this.pace),
      h('div', { class: 'spacer' }),
      this.live,
      h('button', { class: 'ghost hide-narrow', onclick: () => actions.open(), title: 'Open a recording, or drop one on the page (O)' }, 'Open…'),
      h('button', { class: 'ghost icon', onclick: () => actions.theme(), title: 'Light or dark (T)', 'aria-label': 'Light or dark' }, '◐'),
      h('button', { class: 'ghost icon hide-narrow', onclick: () => actions.help(), title: 'Keys (?)', 'aria-label': 'Keys' }, '?'),
      h('div', { class: 'force', role: 'group', 'aria-label': 'Force' }, this.armed, this.arm, this.disarm, this.stop),
    );
  }

  connected(state: 'up' | 'down' | 'connecting' | 'file', text: string): void {
    this.dot.dataset.state = state;
    setText(this.connection, text);
    this.live.hidden = state !== 'file';
  }

  tell(scene: string, pace: string): void {
    setText(this.scene, scene);
    setText(this.pace, pace);
  }

  /** `may`: this browser is allowed to. */
  force(armed: boolean | undefined, may: boolean, live: boolean): void {
    setText(this.armed, armed === undefined ? 'unknown' : armed ? 'armed' : 'no force');
    setClass(this.armed, 'on', armed === true);
    const why = may ? '' : 'This browser may only look: it has no token of a driver';
    for (const button of [this.arm, this.disarm, this.stop]) {
      button.hidden = !live;
      button.disabled = !may;
      if (why) button.title = why;
    }
    if (may) {
      this.arm.disabled = armed === true;
      this.disarm.disabled = armed === false;
    }
  }
}
