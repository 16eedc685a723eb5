/** Items in the order of their time, of which the oldest go. */
export class Track<Item extends { time: number }> {
  private items: Item[] = [];
  private first = 0;
  private weight = 0;

  /** At most `seconds` of them, that weigh no more than `limit` together. */
  constructor(
    private readonly seconds: number,
    private readonly limit = Number.POSITIVE_INFINITY,
    private readonly weigh: (item: Item) => number = () => 1,
  ) {}

  get length(): number {
    return this.items.length - this.first;
  }

  at(index: number): Item | undefined {
    return index < 0 ? undefined : this.items[this.first + index];
  }

  get oldest(): Item | undefined {
    return this.at(0);
  }

  get newest(): Item | undefined {
    return this.items[this.items.length - 1];
  }

  /** One that is older than the newest is ignored. */
  push(item: Item): void {
    if (this.newest && item.time < this.newest.time) return;
    this.items.push(item);
    this.weight += this.weigh(item);
    while (this.length > 1) {
      const oldest = this.items[this.first] as Item;
      if (item.time - oldest.time <= this.seconds && this.weight <= this.limit) break;
      this.weight -= this.weigh(oldest);
      this.first += 1;
    }
    if (this.first > 512 && this.first > this.items.length / 2) {
      this.items = this.items.slice(this.first);
      this.first = 0;
    }
  }

  clear(): void {
    this.items = [];
    this.first = 0;
    this.weight = 0;
  }

  /** Index of the last item at or before `time`; -1 if there is none. */
  indexAt(time: number): number {
    let low = 0;
    let high = this.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if ((this.at(middle) as Item).time <= time) low = middle + 1;
      else high = middle;
    }
    return low - 1;
  }

  /** Calls `visit` with each item from `from` to `to`. */
  each(from: number, to: number, visit: (item: Item) => void): void {
    for (let i = this.indexAt(from) + 1; i < this.length; ++i) {
      const item = this.at(i) as Item;
      if (item.time > to) return;
      visit(item);
    }
  }
}
