// Where moments come from: the daemon, of which the last half minute is kept, or a recording, kept whole.
import type { SceneDescription } from '../gen/haptic/v1/control_pb';
import type { DeviceDescription } from '../gen/haptic/v1/device_pb';
import { type Mark, type Moment, type Pace, weigh } from './moment';
import { Track } from './track';

export const LIVE_SECONDS = 30;
const MOST_BYTES = 400e6; // of moments in memory

export interface Source {
  readonly name: string;
  readonly live: boolean;
  readonly moments: Track<Moment>;
  readonly paces: Track<Pace>;
  readonly marks: Track<Mark>;
  readonly scenes: Map<bigint, SceneDescription>;
  devices: DeviceDescription[];
}

export function makeSource(name: string, seconds: number): Source {
  return {
    name,
    live: Number.isFinite(seconds),
    moments: new Track<Moment>(seconds, MOST_BYTES, weigh),
    paces: new Track<Pace>(seconds),
    marks: new Track<Mark>(seconds),
    scenes: new Map(),
    devices: [],
  };
}
