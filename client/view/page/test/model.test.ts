import { create } from '@bufbuild/protobuf';
import { describe, expect, test } from 'vitest';
import { travel, TRAVEL_SPEED } from '../src/connection/held_device';
import { DevicePhase, FaultKind, FaultSchema } from '../src/gen/haptic/v1/device_pb';
import { StatsSchema } from '../src/gen/haptic/v1/telemetry_pb';
import { type Moment, paceOf } from '../src/model/moment';
import { Player } from '../src/model/player';
import { makeSource } from '../src/model/source';
import { Track } from '../src/model/track';
import { nameOfPhase, namesOfLimits, wordsOfFault } from '../src/model/words';
import { Arrows } from '../src/scene/arrows';

const moment = (time: number): Moment => ({
  time,
  tick: Math.round(time * 1000),
  revision: 1n,
  armed: false,
  paused: false,
  objects: undefined,
  hips: undefined,
  devices: undefined,
});

describe('a track', () => {
  test('keeps as many seconds as it was told', () => {
    const track = new Track<{ time: number }>(30);
    for (let i = 0; i <= 4000; ++i) track.push({ time: i / 100 });
    expect(track.oldest?.time).toBeCloseTo(10, 9);
    expect(track.newest?.time).toBe(40);
    expect(track.length).toBe(3001);
  });

  test('keeps no more than it may weigh', () => {
    const track = new Track<{ time: number }>(30, 5, () => 1);
    for (let i = 0; i < 20; ++i) track.push({ time: i });
    expect(track.length).toBe(5);
  });

  test('finds the last item at or before a time', () => {
    const track = new Track<{ time: number }>(30);
    for (const time of [1, 2, 2, 3]) track.push({ time });
    expect([0.5, 1, 2, 2.5, 9].map((time) => track.indexAt(time))).toEqual([-1, 0, 2, 2, 3]);
    const seen: number[] = [];
    track.each(1, 2, ({ time }) => seen.push(time));
    expect(seen).toEqual([2, 2]);
  });

  test('ignores what is older than its newest', () => {
    const track = new Track<{ time: number }>(30);
    track.push({ time: 2 });
    track.push({ time: 1 });
    expect(track.length).toBe(1);
  });
});

describe('a player', () => {
  const filled = (seconds: number) => {
    const source = makeSource('x', seconds);
    for (let i = 0; i <= 10; ++i) source.moments.push(moment(i));
    return new Player(source);
  };

  test('of what is live follows it until it is paused', () => {
    const player = filled(30);
    expect(player.moment?.time).toBe(10);
    player.pause();
    player.source.moments.push(moment(11));
    expect(player.moment?.time).toBe(10);
    player.toggle();
    expect(player.moment?.time).toBe(11);
  });

  test('steps from moment to moment, and not beyond the ends', () => {
    const player = filled(30);
    player.step(-3);
    expect(player.moment?.time).toBe(7);
    player.step(2);
    expect(player.moment?.time).toBe(9);
    player.step(50);
    expect(player.moment?.time).toBe(10);
    player.step(-50);
    expect(player.moment?.time).toBe(0);
  });

  test('of a recording plays it in its own time, and stops at its end', () => {
    const player = filled(Number.POSITIVE_INFINITY);
    expect(player.moment?.time).toBe(0);
    for (let i = 0; i < 15; ++i) player.advance(0.1);
    expect(player.time).toBeCloseTo(1.5, 9);
    player.position = 9.95;
    player.advance(0.1);
    expect(player.playing).toBe(false);
    expect(player.time).toBe(10);
    player.toggle();
    expect(player.time).toBe(0);
  });

  test('goes on from what is left when the past runs out under it', () => {
    const player = filled(30);
    player.seek(2);
    for (let i = 11; i <= 50; ++i) player.source.moments.push(moment(i));
    player.advance(0.01);
    expect(player.time).toBe(20);
  });
});

test('the pace is that of the ticks since the statistics before', () => {
  const histogram = (count: bigint[], meanNs: number, maxNs: bigint) => ({
    name: 'tick',
    upperNs: [1000n, 2000n, 4000n],
    count,
    total: count.reduce((a, b) => a + b),
    meanNs,
    maxNs,
  });
  // 100 ticks of 1500 ns, then 100 of 500 ns: mean of all 1000 ns
  const before = create(StatsSchema, { stage: [histogram([0n, 100n, 0n], 1500, 1800n)] });
  const after = create(StatsSchema, { stage: [histogram([100n, 100n, 0n], 1000, 1800n)], missedTicks: 3n });
  const pace = paceOf(before, after, 7);
  expect(pace.tickMean).toBeCloseTo(500e-9, 12);
  expect(pace.tickMax).toBeCloseTo(1000e-9, 12);
  expect(pace.missed).toBe(3);
  expect(pace.wakeupMean).toBeNaN();
});

test('a held device goes to its target no faster than it may', () => {
  expect(travel([0, 0, 0], [1, 0, 0], 0.01)).toEqual([0.01 * TRAVEL_SPEED, 0, 0]);
  expect(travel([0, 0, 0], [0.001, 0.002, 0], 0.1)).toEqual([0.001, 0.002, 0]);
  expect(TRAVEL_SPEED).toBeLessThan(2); // safety.max_speed
});

describe('words', () => {
  test('of a fault tell what was measured, what is allowed, and what to do', () => {
    const words = wordsOfFault(create(FaultSchema, { kind: FaultKind.FAULT_OVER_SPEED, device: 'left', tick: 12n, value: 2.345, limit: 2 }));
    expect(words.detail).toBe('device left · 2.35 m/s where 2 m/s is allowed · tick 12');
    expect(words.todo).toContain('clear the fault');
  });

  test('of a fault that this page does not know still tell that there is one', () => {
    const words = wordsOfFault(create(FaultSchema, { kind: 99 as FaultKind, tick: 1n }));
    expect(words.title).toBe('Fault 99');
  });

  test('of limits are those whose bits are set', () => {
    expect(namesOfLimits(0b110010)).toEqual(['force', 'warm motors', 'clutch']);
  });

  test('of a phase that is not told follow from what is', () => {
    const unknown = DevicePhase.DEVICE_PHASE_UNSPECIFIED;
    expect(nameOfPhase(unknown, false, true, FaultKind.FAULT_NONE)).toBe('absent');
    expect(nameOfPhase(unknown, true, true, FaultKind.FAULT_NONE)).toBe('armed');
    expect(nameOfPhase(DevicePhase.DEVICE_HOMING, true, false, FaultKind.FAULT_NONE)).toBe('home it');
  });
});

test('an arrow is as long as its force times the scale, and there is none without force', () => {
  const arrows = new Arrows('#ff0000', 0.001, 1);
  arrows.begin(3);
  const forces = [0, 0, 2, 0, 0, 0, -0.3, 0.4, 0];
  for (let i = 0; i < 9; i += 3) arrows.add([0, 0, 0, 1, 1, 1, 2, 2, 2], forces, i, 0.02);
  arrows.end();
  const lengths = arrows.lengths();
  expect(lengths).toHaveLength(2);
  expect(lengths[0]).toBeCloseTo(0.04, 8);
  expect(lengths[1]).toBeCloseTo(0.01, 8);
});
