// One tick as the page keeps it, whether it came from the daemon or from a recording.
import type { DevicesFrame, Frame, HipsFrame, ObjectsFrame, Stats } from '../gen/haptic/v1/telemetry_pb';

export interface Moment {
  time: number; // s, of the source's clock
  tick: number;
  revision: bigint; // of the scene that indices refer to
  armed: boolean;
  paused: boolean;
  objects: ObjectsFrame | undefined;
  hips: HipsFrame | undefined;
  devices: DevicesFrame | undefined;
}

/** Something to be marked on the time line. */
export interface Mark {
  time: number; // s
  kind: 'fault' | 'arm' | 'note';
  text: string;
}

/** What the servo thread's statistics tell of the ticks since the ones before. */
export interface Pace {
  time: number; // s
  tickMean: number; // s
  tickMax: number; // s, an upper bound: of the histogram's highest bin that counted
  wakeupMean: number; // s
  wakeupMax: number;
  missed: number; // ticks, since the daemon's start
  rate: number; // Hz
}

export function momentOf(frame: Frame, startNs: bigint): Moment {
  return {
    time: Number(frame.monotonicNs - startNs) * 1e-9,
    tick: Number(frame.tick),
    revision: frame.sceneRevision,
    armed: frame.armed,
    paused: frame.paused,
    objects: frame.objects,
    hips: frame.hips,
    devices: frame.devices,
  };
}

/** Bytes of memory, about. */
export function weigh(moment: Moment): number {
  const { objects, hips, devices } = moment;
  const numbers =
    (objects ? 7 * objects.position.length : 0) +
    (hips ? hips.position.length + hips.force.length + 4 * hips.contactForce.length : 0) +
    (devices ? 8 * devices.position.length : 0);
  return 600 + 8 * numbers;
}

interface Counts {
  upperNs: bigint[];
  count: bigint[];
  total: bigint;
  meanNs: number;
  maxNs: bigint;
}

/** Mean and an upper bound of what `after` counted beyond `before`, s. */
function since(before: Counts | undefined, after: Counts | undefined): { mean: number; max: number } {
  if (!after) return { mean: Number.NaN, max: Number.NaN };
  const old = before && before.total <= after.total ? before : undefined;
  const count = Number(after.total - (old?.total ?? 0n));
  if (count === 0) return { mean: Number.NaN, max: Number.NaN };
  const sum = after.meanNs * Number(after.total) - (old ? old.meanNs * Number(old.total) : 0);
  let max = after.maxNs;
  for (let i = after.count.length - 1; i >= 0; --i) {
    if ((after.count[i] ?? 0n) > (old?.count[i] ?? 0n)) {
      const upper = after.upperNs[i] ?? after.maxNs;
      max = upper < after.maxNs ? upper : after.maxNs;
      break;
    }
  }
  return { mean: Math.max(0, sum / count) * 1e-9, max: Number(max) * 1e-9 };
}

export function paceOf(before: Stats, after: Stats, time: number): Pace {
  const stage = (stats: Stats) => stats.stage.find((histogram) => histogram.name === 'tick');
  const tick = since(stage(before), stage(after));
  const wakeup = since(before.wakeup, after.wakeup);
  return {
    time,
    tickMean: tick.mean,
    tickMax: tick.max,
    wakeupMean: wakeup.mean,
    wakeupMax: wakeup.max,
    missed: Number(after.missedTicks),
    rate: after.rateHz,
  };
}
