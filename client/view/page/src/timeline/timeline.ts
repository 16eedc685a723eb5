// The line at the bottom: pause, go back, look at each moment; faults and the like are marked.
import type { Player } from '../model/player';
import { h, setText } from '../panels/dom';

const MARK_LIMIT = 200;

export class Timeline {
  private readonly button: HTMLButtonElement;
  private readonly slider: HTMLInputElement;
  private readonly text = h('output', { class: 'num', id: 'shown-time' });
  private readonly marks = h('div', { class: 'marks', 'aria-hidden': 'true' });
  private markKey = '';
  readonly root: HTMLElement;

  constructor(private player: Player) {
    this.button = h('button', { class: 'icon', id: 'play', onclick: () => this.player.toggle() });
    this.slider = h('input', {
      type: 'range',
      id: 'scrub',
      min: '0',
      max: '1',
      step: 'any',
      value: '1',
      'aria-label': 'Time that is shown',
      oninput: () => this.player.seek(this.player.start + Number(this.slider.value) * (this.player.end - this.player.start)),
    });
    this.root = h('footer', { class: 'timeline' }, this.button, h('div', { class: 'track' }, this.marks, this.slider), this.text);
  }

  setPlayer(player: Player): void {
    this.player = player;
    this.markKey = '';
  }

  update(): void {
    const { player } = this;
    const moving = player.moving;
    setText(this.button, moving ? '❚❚' : '▶');
    const label = moving ? 'Pause the picture (space)' : player.source.live ? 'Back to now (space)' : 'Play (space)';
    if (this.button.title !== label) {
      this.button.title = label;
      this.button.setAttribute('aria-label', label);
    }
    const span = player.end - player.start;
    const share = span > 0 ? (player.time - player.start) / span : 1;
    if (Math.abs(Number(this.slider.value) - share) > 1e-4) this.slider.value = share.toFixed(5);
    const behind = player.time - player.end;
    const tick = player.moment?.tick;
    const tickText = tick === undefined ? '' : `  tick ${tick}`;
    const at = player.source.live
      ? player.following
        ? 'live'
        : `${behind.toFixed(2)} s`
      : `${(player.time - player.start).toFixed(2)} / ${span.toFixed(2)} s`;
    setText(this.text, at + tickText);
    this.slider.setAttribute('aria-valuetext', at);
    this.drawMarks(span);
  }

  private drawMarks(span: number): void {
    const { marks } = this.player.source;
    // they wander while live: ten times a second is enough to see
    const key = `${marks.length}/${this.player.start.toFixed(1)}/${span.toFixed(1)}`;
    if (key === this.markKey || span <= 0) return;
    this.markKey = key;
    const items: HTMLElement[] = [];
    for (let i = Math.max(0, marks.length - MARK_LIMIT); i < marks.length; ++i) {
      const mark = marks.at(i);
      if (!mark || mark.time < this.player.start) continue;
      const item = h('i', { 'data-kind': mark.kind, title: mark.text });
      item.style.left = `${(100 * (mark.time - this.player.start)) / span}%`;
      items.push(item);
    }
    this.marks.replaceChildren(...items);
  }
}
