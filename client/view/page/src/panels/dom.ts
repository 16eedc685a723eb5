// Elements, made in one expression.

type Attributes = Record<string, string | boolean | number | ((event: Event) => void) | undefined>;
export type Child = Node | string | undefined;

/** An element; `class` and other attributes by name, `on...` as listeners. */
export function h<Tag extends keyof HTMLElementTagNameMap>(
  tag: Tag,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[Tag] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === false) continue;
    if (typeof value === 'function') element.addEventListener(name.slice(2), value);
    else element.setAttribute(name, value === true ? '' : String(value));
  }
  element.append(...children.filter((child): child is Node | string => child !== undefined));
  return element;
}

/** Sets the text if it is another: so that what has not changed is not laid out again. */
export function setText(element: Element, text: string): void {
  if (element.textContent !== text) element.textContent = text;
}

export function setClass(element: Element, name: string, on: boolean): void {
  if (element.classList.contains(name) !== on) element.classList.toggle(name, on);
}

/** "1.25 N": three digits, a fixed width for readable columns. */
export function number(value: number, unit: string, digits = 2): string {
  return Number.isFinite(value) ? `${value.toFixed(digits)} ${unit}` : `– ${unit}`;
}

/** A time with the unit that suits it. */
export function time(seconds: number): string {
  if (!Number.isFinite(seconds)) return '–';
  if (seconds < 1e-3) return `${(seconds * 1e6).toFixed(1)} µs`;
  return seconds < 1 ? `${(seconds * 1e3).toFixed(1)} ms` : `${seconds.toFixed(1)} s`;
}
