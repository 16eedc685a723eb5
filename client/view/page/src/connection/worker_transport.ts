import type { Transport } from './client';
import type { Point } from './held_device';
import type { FromWorker, ToWorker } from './worker_messages';

/** The WebSocket in its worker, which holds devices, too. */
export class WorkerTransport implements Transport {
  onopen: () => void = () => undefined;
  onmessage: (data: Uint8Array) => void = () => undefined;
  onclose: (code: number, reason: string) => void = () => undefined;
  /** A held device was told to be there. m, world frame. */
  onheld: (device: string, position: Point) => void = () => undefined;

  private readonly worker = new Worker(new URL('./worker.ts', import.meta.url), { type: 'module' });

  constructor() {
    this.worker.onmessage = (event: MessageEvent<FromWorker>) => {
      const message = event.data;
      if (message.kind === 'open') this.onopen();
      else if (message.kind === 'message') this.onmessage(new Uint8Array(message.data));
      else if (message.kind === 'held') this.onheld(message.device, message.position);
      else this.onclose(message.code, message.reason);
    };
  }

  open(url: string): void {
    this.tell({ kind: 'open', url });
  }

  send(data: Uint8Array): void {
    this.tell({ kind: 'send', data });
  }

  close(): void {
    this.tell({ kind: 'close' });
  }

  /** From now on the device goes to `target` (m, world frame) and stays there; the first time it begins there. */
  hold(device: string, target: Point): void {
    this.tell({ kind: 'hold', device, target });
  }

  release(device: string): void {
    this.tell({ kind: 'release', device });
  }

  private tell(message: ToWorker): void {
    this.worker.postMessage(message);
  }
}
