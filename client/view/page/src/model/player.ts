import type { Moment } from './moment';
import type { Source } from './source';

const REFRESH = 0.25; // s; a picture may be so late without time running away

/** Which moment of a source is shown: the newest one, one that stands still, or one after the other. */
export class Player {
  /** The newest moment is shown, whichever it is. Only of a live source. */
  following: boolean;
  playing: boolean;
  position = 0; // s; where it is not following

  constructor(readonly source: Source) {
    this.following = source.live;
    this.playing = !source.live;
    this.position = source.moments.oldest?.time ?? 0;
  }

  get start(): number {
    return this.source.moments.oldest?.time ?? 0;
  }

  get end(): number {
    return this.source.moments.newest?.time ?? 0;
  }

  /** The time that is shown. */
  get time(): number {
    return this.following ? this.end : this.position;
  }

  get moment(): Moment | undefined {
    const { moments } = this.source;
    if (this.following) return moments.newest;
    return moments.at(moments.indexAt(this.position)) ?? moments.oldest;
  }

  get moving(): boolean {
    return this.following || this.playing;
  }

  advance(seconds: number): void {
    if (this.following) return;
    if (this.playing) this.position += Math.min(seconds, REFRESH);
    if (this.position >= this.end && this.playing) {
      if (this.source.live) this.following = true;
      else this.playing = false;
    }
    this.position = Math.min(Math.max(this.position, this.start), this.end);
  }

  pause(): void {
    this.position = this.time;
    this.following = false;
    this.playing = false;
  }

  resume(): void {
    if (this.source.live) {
      this.following = true;
      return;
    }
    if (this.position >= this.end) this.position = this.start;
    this.playing = true;
  }

  toggle(): void {
    if (this.moving) this.pause();
    else this.resume();
  }

  seek(time: number): void {
    this.pause();
    this.position = Math.min(Math.max(time, this.start), this.end);
  }

  /** To the moment `count` after the shown one, or before it. */
  step(count: number): void {
    const { moments } = this.source;
    const index = moments.indexAt(this.time) + count;
    const moment = moments.at(Math.min(Math.max(index, 0), moments.length - 1));
    if (moment) this.seek(moment.time);
  }
}
