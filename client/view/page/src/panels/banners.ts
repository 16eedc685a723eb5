// What must be seen: faults and what to do, and that the connection is lost. Short notes go by themselves.
import { type Fault, FaultKind } from '../gen/haptic/v1/device_pb';
import { wordsOfFault } from '../model/words';
import { h } from './dom';

const NOTE_TIME = 6000; // ms

export class Banners {
  readonly root = h('div', { id: 'banners', 'aria-live': 'assertive' });
  private readonly faults = h('div', {});
  private readonly link = h('div', {});
  private readonly notes = h('div', { class: 'notes', 'aria-live': 'polite' });
  private shown = '';

  constructor(private readonly clear: () => void) {
    this.root.append(this.link, this.faults, this.notes);
  }

  showFaults(faults: Fault[], mayClear: boolean): void {
    const latched = faults.filter((fault) => fault.kind !== FaultKind.FAULT_NONE);
    const key = `${mayClear} ${latched.map((fault) => `${fault.kind}/${fault.device}/${fault.tick}`).join()}`;
    if (key === this.shown) return;
    this.shown = key;
    this.faults.replaceChildren(
      ...latched.map((fault) => {
        const words = wordsOfFault(fault);
        return h(
          'div',
          { class: 'banner fault', role: 'alert' },
          h('strong', {}, words.title),
          h('span', { class: 'detail' }, words.detail),
          h('span', { class: 'todo' }, words.todo),
          h(
            'button',
            { class: 'clear', disabled: !mayClear, title: mayClear ? '' : 'This browser may only look', onclick: this.clear },
            'Clear fault',
          ),
        );
      }),
    );
  }

  showLost(text: string | undefined): void {
    this.link.replaceChildren(
      ...(text === undefined ? [] : [h('div', { class: 'banner lost', role: 'alert' }, h('strong', {}, 'Connection lost'), h('span', { class: 'detail' }, text))]),
    );
  }

  note(text: string, kind: 'note' | 'wrong' = 'note'): void {
    const note = h('div', { class: `note ${kind}`, role: kind === 'wrong' ? 'alert' : 'status' }, text);
    this.notes.append(note);
    while (this.notes.childElementCount > 4) this.notes.firstElementChild?.remove();
    setTimeout(() => note.remove(), NOTE_TIME);
  }
}
