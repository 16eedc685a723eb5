// Keys, and the list of them.
import { h } from './panels/dom';

export interface Key {
  key: string; // KeyboardEvent.key, lower case
  shown: string;
  does: string;
  run: () => void;
}

function isTyping(target: EventTarget | null): boolean {
  return target instanceof HTMLSelectElement || (target instanceof HTMLInputElement && target.type !== 'checkbox' && target.type !== 'range');
}

export function listen(keys: Key[]): void {
  const byKey = new Map(keys.map((key) => [key.key, key]));
  window.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || isTyping(event.target)) return;
    // what has the focus answers to the space bar and the arrows itself
    const focused = event.target instanceof HTMLElement ? event.target : undefined;
    if (event.key === ' ' && focused?.closest('button, input, summary, a')) return;
    if (event.key.startsWith('Arrow') && focused?.closest('input')) return;
    const key = byKey.get(event.key.toLowerCase());
    if (!key || (event.repeat && !event.key.startsWith('Arrow'))) return;
    event.preventDefault();
    key.run();
  });
}

export function makeHelp(keys: Key[]): HTMLDialogElement {
  const dialog = h(
    'dialog',
    { id: 'help', 'aria-label': 'Keys and pointer' },
    h('h2', {}, 'Keys'),
    h('dl', {}, ...keys.flatMap(({ shown, does }) => [h('dt', {}, h('kbd', {}, shown)), h('dd', {}, does)])),
    h('h2', {}, 'Pointer'),
    h(
      'dl',
      {},
      h('dt', {}, 'drag beside things'),
      h('dd', {}, 'turn the view; right button or two fingers: shift it; wheel: nearer'),
      h('dt', {}, 'drag an object or a hand'),
      h('dd', {}, 'a virtual device follows the pointer; where it is let go, it stays. Wheel while dragging: press in or pull out'),
      h('dt', {}, 'Shift + drag a hand'),
      h('dd', {}, 'all virtual devices move together: pinch with two, then lift'),
    ),
    h('form', { method: 'dialog' }, h('button', {}, 'Close'), h('a', { href: './licences.txt', target: '_blank', rel: 'noopener' }, 'Licences')),
  );
  return dialog;
}
