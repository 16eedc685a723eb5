// Owns the WebSocket, and tells the daemon where held devices are. It is a worker because a device must be told again
// within safety.max_sample_age, however long a picture takes and whether the page is seen or not.
import { create, toBinary } from '@bufbuild/protobuf';
import { EnvelopeSchema } from '../gen/haptic/v1/control_pb';
import { type Point, travel } from './held_device';
import type { FromWorker, ToWorker } from './worker_messages';

const PERIOD = 10; // ms between two poses
const LONGEST_STEP = 0.03; // s, after a pause of the worker itself
const FIRST_ID = 2 ** 40; // of requests that nobody waits for; the page counts its own from 1

let socket: WebSocket | undefined;
let nextId = FIRST_ID;
let last = performance.now();
const held = new Map<string, { position: Point; target: Point }>();

function tell(message: FromWorker, transfer: Transferable[] = []): void {
  postMessage(message, { transfer });
}

function open(url: string): void {
  const opened = new WebSocket(url, 'haptic.v1');
  opened.binaryType = 'arraybuffer';
  opened.onopen = () => tell({ kind: 'open' });
  opened.onmessage = (event: MessageEvent<unknown>) => {
    if (socket === opened && event.data instanceof ArrayBuffer) {
      tell({ kind: 'message', data: event.data }, [event.data]);
    }
  };
  opened.onclose = (event) => {
    if (socket !== opened) return;
    socket = undefined;
    held.clear();
    tell({ kind: 'close', code: event.code, reason: event.reason });
  };
  socket = opened;
}

function sendPoses(): void {
  const now = performance.now();
  const seconds = Math.min((now - last) / 1000, LONGEST_STEP);
  last = now;
  if (socket?.readyState !== WebSocket.OPEN) return;
  for (const [device, way] of held) {
    way.position = travel(way.position, way.target, seconds);
    const [x, y, z] = way.position;
    const move = { device, pose: { position: { x, y, z }, orientation: { w: 1 } } };
    const envelope = create(EnvelopeSchema, {
      body: { case: 'request', value: { id: BigInt(nextId++), call: { case: 'moveDevice', value: move } } },
    });
    socket.send(toBinary(EnvelopeSchema, envelope));
    tell({ kind: 'held', device, position: way.position });
  }
}

self.onmessage = (event: MessageEvent<ToWorker>) => {
  const message = event.data;
  switch (message.kind) {
    case 'open':
      open(message.url);
      break;
    case 'send':
      if (socket?.readyState === WebSocket.OPEN) socket.send(message.data);
      break;
    case 'close':
      socket?.close();
      break;
    case 'hold': {
      const way = held.get(message.device);
      if (way) way.target = message.target;
      else held.set(message.device, { position: message.target, target: message.target });
      break;
    }
    case 'release':
      held.delete(message.device);
      break;
  }
};

setInterval(sendPoses, PERIOD);
