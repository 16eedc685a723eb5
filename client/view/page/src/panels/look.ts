// What is drawn, and how.
import { STATES, helpOfState, nameOfState } from '../model/words';
import { SLIPPING_COLOUR, STATE_COLOURS, STICKING_COLOUR } from '../scene/palette';
import type { Look } from '../scene/view';
import { h, setText } from './dom';

export class LookPanel {
  readonly root = h('div', { class: 'look' });
  readonly legend = h('div', { class: 'legend', id: 'legend' });
  readonly scaleText = h('span', { class: 'num' });
  private readonly slider: HTMLInputElement;
  private readonly cutSlider: HTMLInputElement;
  private readonly cellsToggle: HTMLInputElement;
  private readonly checks = new Map<keyof Look, HTMLInputElement>();

  constructor(
    private readonly look: Look,
    private readonly changed: () => void,
  ) {
    this.slider = h('input', {
      type: 'range',
      min: '-4',
      max: '0',
      step: '0.05',
      id: 'arrow-scale',
      'aria-label': 'Length of force arrows',
      oninput: () => {
        look.arrowScale = 10 ** Number(this.slider.value);
        this.apply();
      },
    });
    this.cutSlider = h('input', {
      type: 'range',
      min: '0',
      max: '1',
      step: '0.01',
      'aria-label': 'Place of the cut',
      oninput: () => {
        look.cutAt = Number(this.cutSlider.value);
        this.apply();
      },
    });
    const cut = h(
      'select',
      {
        id: 'cut-axis',
        'aria-label': 'Cut across an axis of the object',
        onchange: (event) => {
          look.cutAxis = (event.target as HTMLSelectElement).value as Look['cutAxis'];
          this.apply();
        },
      },
      ...(['none', 'x', 'y', 'z'] as const).map((axis) => h('option', { value: axis }, axis === 'none' ? 'no cut' : `across ${axis}`)),
    );
    const colouring = h(
      'select',
      {
        id: 'colouring',
        'aria-label': 'Colour of HIPs',
        onchange: (event) => {
          look.colouring = (event.target as HTMLSelectElement).value as Look['colouring'];
          this.apply();
        },
      },
      h('option', { value: 'state' }, 'by state'),
      h('option', { value: 'slipping' }, 'by slipping'),
    );
    this.cellsToggle = this.check('cells', 'shown');
    this.root.append(
      h('div', { class: 'line' }, h('span', { class: 'label' }, 'HIPs'), this.wrap('HIPs', 'hips'), this.wrap('proxies', 'proxies'), colouring),
      h('div', { class: 'line' }, h('span', { class: 'label' }, 'Forces'), this.wrap('of HIPs', 'hipForces'), this.wrap('of devices', 'deviceForces'), this.wrap('on objects', 'objectForces')),
      h('div', { class: 'line' }, h('span', { class: 'label' }, 'Scale'), this.slider, this.scaleText),
      h(
        'div',
        { class: 'line', title: 'Cells of extrusions are known to the daemon alone' },
        h('span', { class: 'label' }, 'Cells'),
        h('label', { class: 'check' }, this.cellsToggle, 'show (C)'),
        this.wrap('wires', 'wireframe'),
        this.wrap('by material', 'byMaterial'),
      ),
      h('div', { class: 'line' }, h('span', { class: 'label' }, 'Cut'), cut, this.cutSlider),
    );
    this.refresh();
  }

  private check(name: string, key: keyof Look): HTMLInputElement {
    const box = h('input', {
      type: 'checkbox',
      id: `show-${name}`,
      onchange: () => {
        Object.assign(this.look, { [key]: box.checked });
        this.apply();
      },
    });
    this.checks.set(key, box);
    return box;
  }

  private wrap(text: string, key: keyof Look): HTMLElement {
    return h('label', { class: 'check' }, this.check(key, key), text);
  }

  private apply(): void {
    this.refresh();
    this.changed();
  }

  /** After the look was changed from elsewhere. */
  refresh(): void {
    const { look } = this;
    for (const [key, box] of this.checks) box.checked = look[key] === true;
    this.slider.value = String(Math.log10(look.arrowScale));
    this.cutSlider.value = String(look.cutAt);
    this.cutSlider.disabled = look.cutAxis === 'none';
    setText(this.scaleText, `1 N = ${(1000 * look.arrowScale).toPrecision(2)} mm`);
    const entry = (colour: string, name: string, title: string): HTMLElement => {
      const swatch = h('i', {});
      swatch.style.background = colour;
      return h('span', { title }, swatch, name);
    };
    this.legend.replaceChildren(
      ...(look.colouring === 'state'
        ? STATES.map((state) => entry(STATE_COLOURS[state], nameOfState(state), helpOfState(state)))
        : [
            entry(STICKING_COLOUR, 'sticks', 'held by static friction'),
            entry(SLIPPING_COLOUR, 'slips', 'moves along the surface'),
            entry('#8b929b', 'free', 'touches nothing'),
          ]),
    );
  }
}
