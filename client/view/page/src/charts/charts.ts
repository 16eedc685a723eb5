// Strip charts of what is shown: half a minute of it.
import uPlot from 'uplot';
import 'uplot/dist/uPlot.min.css';
import type { Moment } from '../model/moment';
import type { Player } from '../model/player';
import { h, setText } from '../panels/dom';
import { seriesColour } from '../scene/palette';

const SPAN = 30; // s
const AHEAD = 10; // s after the shown time, of what stands still
const HEIGHT = 92; // px

interface Curve {
  name: string;
  colour: string;
  dash?: number[];
}

interface Strip {
  title: string;
  unit: string;
  digits: number;
  least: number; // the range of values is no smaller
  curves: Curve[];
  /** Which of the data columns its curves are. */
  columns: () => { times: number[]; values: (number | null)[][] };
}

interface Drawn {
  strip: Strip;
  plot: uPlot;
  readouts: HTMLElement[];
  root: HTMLElement;
}

export interface ChartsInput {
  devices: string[];
  fingers: string[];
  /** Of each finger; remembers what it has told of a moment. */
  friction: (moment: Moment) => number[];
}

const finite = (value: number | undefined): number | null => (value !== undefined && Number.isFinite(value) ? value : null);

export class Charts {
  readonly root = h('div', { class: 'charts' });
  private drawn: Drawn[] = [];
  private input: ChartsInput = { devices: [], fingers: [], friction: () => [] };
  private moments: Moment[] = [];
  private range: [number, number] = [0, SPAN];
  private readonly resized = new ResizeObserver(() => this.fit());

  constructor(private player: Player) {
    this.resized.observe(this.root);
  }

  setPlayer(player: Player): void {
    this.player = player;
  }

  setInput(input: ChartsInput): void {
    this.input = input;
    this.rebuild();
  }

  /** After the colours of the page have changed, too. */
  rebuild(): void {
    for (const { plot } of this.drawn) plot.destroy();
    const style = getComputedStyle(document.documentElement);
    const axis = style.getPropertyValue('--quiet').trim();
    const grid = style.getPropertyValue('--line').trim();
    this.drawn = this.strips().map((strip) => this.make(strip, axis, grid));
    this.root.replaceChildren(...this.drawn.map(({ root }) => root));
    this.fit();
  }

  private strips(): Strip[] {
    const { devices, fingers } = this.input;
    const named = (names: string[]): Curve[] => names.map((name, i) => ({ name, colour: seriesColour(i) }));
    const ofMoments = (count: number, value: (moment: Moment, i: number) => number | null) => () => ({
      times: this.moments.map((moment) => moment.time),
      values: Array.from({ length: count }, (_, i) => this.moments.map((moment) => value(moment, i))),
    });
    const pace = (mean: 'tickMean' | 'wakeupMean', max: 'tickMax' | 'wakeupMax') => () => {
      const times: number[] = [];
      const means: (number | null)[] = [];
      const largest: (number | null)[] = [];
      this.player.source.paces.each(this.range[0], this.range[1], (item) => {
        times.push(item.time);
        means.push(finite(item[mean] * 1e6));
        largest.push(finite(item[max] * 1e6));
      });
      return { times, values: [means, largest] };
    };
    const meanAndMax: Curve[] = [
      { name: 'mean', colour: seriesColour(0) },
      { name: 'max', colour: seriesColour(1) },
    ];
    return [
      {
        title: 'Force',
        unit: 'N',
        digits: 2,
        least: 0.1,
        curves: named(devices),
        columns: ofMoments(devices.length, ({ devices: d }, i) =>
          d && d.force.length >= 3 * i + 3 ? Math.hypot(d.force[3 * i] as number, d.force[3 * i + 1] as number, d.force[3 * i + 2] as number) : null,
        ),
      },
      {
        title: 'Friction ratio',
        unit: '',
        digits: 2,
        least: 0.1,
        curves: named(fingers),
        columns: ofMoments(fingers.length, (moment, i) => finite(this.input.friction(moment)[i])),
      },
      { title: 'Tick', unit: 'µs', digits: 1, least: 10, curves: meanAndMax, columns: pace('tickMean', 'tickMax') },
      { title: 'Wake-up', unit: 'µs', digits: 1, least: 10, curves: meanAndMax, columns: pace('wakeupMean', 'wakeupMax') },
      {
        title: 'Energy given',
        unit: 'J',
        digits: 4,
        least: 0.01,
        curves: named(devices),
        columns: ofMoments(devices.length, ({ devices: d }, i) => finite(d?.energy[i])),
      },
    ];
  }

  private make(strip: Strip, axis: string, grid: string): Drawn {
    const readouts = strip.curves.map(() => h('b', { class: 'num' }, '–'));
    const names = strip.curves.map((curve, i) => {
      const dot = h('i', {});
      dot.style.background = curve.colour;
      return h('span', {}, dot, `${curve.name} `, readouts[i] as HTMLElement);
    });
    const place = h('div', { class: 'plot' });
    const label = strip.unit === '' ? strip.title : `${strip.title} (${strip.unit})`;
    const root = h('figure', { class: 'chart', 'data-chart': strip.title, 'aria-label': label }, h('figcaption', {}, h('strong', {}, label), ...names), place);
    const font = '10px system-ui, sans-serif';
    const ticks = { stroke: grid, width: 1, size: 3 };
    const plot = new uPlot(
      {
        width: 300,
        height: HEIGHT,
        legend: { show: false },
        cursor: { show: true, x: true, y: false, points: { show: false }, drag: { x: false, y: false } },
        padding: [6, 6, 0, 0],
        scales: {
          x: { time: false, range: () => this.range },
          y: { range: (_plot, low, high) => [Math.min(0, low ?? 0), Math.max(high ?? 0, strip.least) * 1.08] },
        },
        axes: [
          {
            stroke: axis,
            font,
            size: 18,
            gap: 2,
            ticks,
            grid: { stroke: grid, width: 1 },
            splits: (_plot, _axis, low, high) => this.splits(low, high),
            values: (_plot, values) => values.map((value) => `${Number((value - this.origin).toFixed(1))} s`),
          },
          { stroke: axis, font, size: 46, gap: 3, ticks, grid: { stroke: grid, width: 1 } },
        ],
        series: [{}, ...strip.curves.map((curve) => ({ label: curve.name, stroke: curve.colour, width: 1.5, points: { show: false }, spanGaps: false }))],
        hooks: {
          draw: [
            (u) => {
              if (this.player.following) return;
              const at = u.valToPos(this.player.time, 'x', true);
              u.ctx.save();
              u.ctx.strokeStyle = axis;
              u.ctx.beginPath();
              u.ctx.moveTo(at, u.bbox.top);
              u.ctx.lineTo(at, u.bbox.top + u.bbox.height);
              u.ctx.stroke();
              u.ctx.restore();
            },
          ],
        },
      },
      [[], ...strip.curves.map(() => [])],
      place,
    );
    place.addEventListener('click', (event) => {
      const box = plot.over.getBoundingClientRect();
      if (event.clientX >= box.left) this.player.seek(plot.posToVal(event.clientX - box.left, 'x'));
    });
    return { strip, plot, readouts, root };
  }

  /** Where times are counted from: now, or a recording's start. */
  private get origin(): number {
    return this.player.source.live ? this.player.end : this.player.start;
  }

  /** Whole seconds from there. */
  private splits(low: number, high: number): number[] {
    const step = [1, 2, 5, 10].find((s) => (high - low) / s <= 7) ?? 10;
    const { origin } = this;
    const all: number[] = [];
    for (let k = Math.ceil((low - origin) / step); origin + k * step <= high; ++k) all.push(origin + k * step);
    return all;
  }

  private fit(): void {
    const width = this.root.clientWidth;
    if (width <= 0) return;
    for (const { plot } of this.drawn) {
      const inner = plot.root.parentElement?.clientWidth ?? width;
      if (plot.width !== inner) plot.setSize({ width: inner, height: HEIGHT });
    }
  }

  /** Draws anew what is in view; a few times a second are enough. */
  update(): void {
    if (this.root.clientWidth === 0 || this.root.closest('details')?.open === false) return;
    const { player } = this;
    const end = player.following ? player.end : Math.min(player.end, player.time + AHEAD);
    this.range = [Math.max(end - SPAN, Math.min(player.start, end - 5)), end];
    this.moments = [];
    player.source.moments.each(this.range[0], this.range[1], (moment) => this.moments.push(moment));
    for (const { strip, plot, readouts } of this.drawn) {
      const { times, values } = strip.columns();
      plot.setData([times, ...values] as uPlot.AlignedData);
      const at = player.following ? times.length - 1 : times.findLastIndex((time) => time <= player.time);
      readouts.forEach((readout, i) => {
        const value = values[i]?.[at];
        setText(readout, typeof value === 'number' ? value.toFixed(strip.digits) : '–');
      });
    }
  }
}
