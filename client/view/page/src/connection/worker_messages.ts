// What the page and the worker that owns its WebSocket say to each other.

export type ToWorker =
  | { kind: 'open'; url: string }
  | { kind: 'send'; data: Uint8Array }
  | { kind: 'close' }
  | { kind: 'hold'; device: string; target: [number, number, number] }
  | { kind: 'release'; device: string };

export type FromWorker =
  | { kind: 'open' }
  | { kind: 'message'; data: ArrayBuffer }
  | { kind: 'held'; device: string; position: [number, number, number] }
  | { kind: 'close'; code: number; reason: string };
