// Recordings (MCAP, as hapticctl record makes them) as a source, read in the browser alone.
import { fromBinary } from '@bufbuild/protobuf';
import { McapIndexedReader, type McapTypes } from '@mcap/core';
import { decompress } from 'fzstd';
import { DeviceListSchema, SceneDescriptionSchema } from '../gen/haptic/v1/control_pb';
import { type Event, type Frame, FrameSchema, type Stats } from '../gen/haptic/v1/telemetry_pb';
import { markOf } from '../model/marks';
import { type Moment, momentOf, paceOf } from '../model/moment';
import { makeSource, type Source } from '../model/source';

const RATE = 60; // moments for each second of recording
const FEWEST_RATE = 5;
const MOST_MOMENTS = 36_000; // ten minutes; a longer recording gets fewer for each second

const PARTS = ['/haptic/objects', '/haptic/hips', '/haptic/devices'];
const OTHERS = ['/haptic/events', '/haptic/stats', '/haptic/scene', '/haptic/device_list'];

const decompressHandlers: McapTypes.DecompressHandlers = {
  zstd: (buffer, size) => decompress(buffer, new Uint8Array(Number(size))),
};

class BlobReadable implements McapTypes.IReadable {
  constructor(private readonly blob: Blob) {}

  size(): Promise<bigint> {
    return Promise.resolve(BigInt(this.blob.size));
  }

  async read(offset: bigint, size: bigint): Promise<Uint8Array> {
    const begin = Number(offset);
    return new Uint8Array(await this.blob.slice(begin, begin + Number(size)).arrayBuffer());
  }
}

function merge(moment: Moment, frame: Frame): void {
  moment.objects ??= frame.objects;
  moment.hips ??= frame.hips;
  moment.devices ??= frame.devices;
}

/** Reads a recording. `progress` gets the share that is read. Throws with words for a person. */
export async function openRecording(file: Blob, name: string, progress: (share: number) => void): Promise<Source> {
  let reader: McapIndexedReader;
  try {
    reader = await McapIndexedReader.Initialize({ readable: new BlobReadable(file), decompressHandlers });
  } catch (error) {
    throw new Error(`${name} is no whole recording (hapticctl recover mends one that was cut): ${String(error)}`);
  }
  const { statistics } = reader;
  const ours = [...reader.channelsById.values()].some((channel) => channel.topic.startsWith('/haptic/'));
  if (!statistics || !ours) throw new Error(`${name} holds nothing of hapticd`);
  const startNs = statistics.messageStartTime;
  const seconds = Number(statistics.messageEndTime - startNs) * 1e-9;
  const rate = Math.max(FEWEST_RATE, Math.min(RATE, MOST_MOMENTS / Math.max(seconds, 1)));
  const source = makeSource(name, Number.POSITIVE_INFINITY);

  const taken = new Map<bigint, Moment>(); // by log time, of the one or two latest
  const topics = new Map([...reader.channelsById.values()].map((channel) => [channel.id, channel.topic]));
  let nextNs = startNs;
  const step = BigInt(Math.round(1e9 / rate));
  let stats: Stats | undefined;
  let clockNs: bigint | undefined;
  let told = 0;
  for await (const message of reader.readMessages({ topics: [...PARTS, ...OTHERS], validateCrcs: false })) {
    const topic = topics.get(message.channelId) ?? '';
    const elapsed = Number(message.logTime - startNs) * 1e-9;
    if (PARTS.includes(topic)) {
      let moment = taken.get(message.logTime);
      if (!moment && message.logTime < nextNs) continue;
      const frame = fromBinary(FrameSchema, message.data);
      clockNs ??= frame.monotonicNs - (message.logTime - startNs);
      if (!moment) {
        moment = momentOf(frame, clockNs);
        taken.clear();
        taken.set(message.logTime, moment);
        source.moments.push(moment);
        nextNs = message.logTime + step;
      } else {
        merge(moment, frame);
      }
    } else if (topic === '/haptic/scene') {
      const scene = fromBinary(SceneDescriptionSchema, message.data);
      source.scenes.set(scene.revision, scene);
    } else if (topic === '/haptic/device_list') {
      const list = fromBinary(DeviceListSchema, message.data);
      source.devices = list.device.flatMap((status) => status.description ?? []);
    } else {
      const frame = fromBinary(FrameSchema, message.data);
      if (frame.stats) {
        if (stats) source.paces.push(paceOf(stats, frame.stats, elapsed));
        stats = frame.stats;
      }
      const event: Event | undefined = frame.event;
      if (event) source.marks.push(markOf(event, elapsed));
    }
    if (seconds > 0 && elapsed / seconds > told + 0.02) {
      told = elapsed / seconds;
      progress(told);
      await new Promise((resolve) => setTimeout(resolve)); // let the page breathe
    }
  }
  if (source.moments.length === 0) throw new Error(`${name} has no frames`);
  return source;
}
