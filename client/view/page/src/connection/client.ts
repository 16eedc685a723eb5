// A client of the daemon over the gateway: says what it wants, gets what there is, comes back by itself.
import { create, fromBinary, type MessageInitShape, toBinary } from '@bufbuild/protobuf';
import {
  type Envelope,
  EnvelopeSchema,
  Error_Code,
  type Gap,
  type Hello,
  type RequestSchema,
  type Response,
} from '../gen/haptic/v1/control_pb';
import type { Event, Frame } from '../gen/haptic/v1/telemetry_pb';

/** What carries whole messages; open() may be called again after onclose. */
export interface Transport {
  onopen: () => void;
  onmessage: (data: Uint8Array) => void;
  onclose: (code: number, reason: string) => void;
  open(url: string): void;
  send(data: Uint8Array): void;
  close(): void;
}

export interface Listener {
  /** The gateway's first message: from here on calls are answered. */
  greeted(hello: Hello): void;
  frame(frame: Frame): void;
  event(event: Event): void;
  gap(gap: Gap): void;
  /** A request for which nobody waits, as the worker makes them for held devices, was refused. */
  refused(message: string): void;
  /** `retry`: s until the next attempt. */
  lost(reason: string, retry: number): void;
  connecting(): void;
}

type Call = NonNullable<MessageInitShape<typeof RequestSchema>['call']>;
export type Result<Case extends Response['result']['case']> = Extract<Response['result'], { case: Case }>['value'];

/** The daemon, or the gateway for it, said no; or the connection was lost before there was an answer. */
export class Refused extends Error {
  constructor(
    readonly code: Error_Code,
    message: string,
  ) {
    super(message);
  }
}

const FIRST_RETRY = 0.5; // s; doubled with each failure,
const LAST_RETRY = 8; // up to this

interface Open {
  resolve: (response: Response) => void;
  reject: (error: Refused) => void;
}

export class Client {
  private readonly open = new Map<bigint, Open>();
  private lastId = 0n;
  private failures = 0;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private goodbye = '';
  /** Bytes received since the start. */
  received = 0;

  constructor(
    private readonly transport: Transport,
    private readonly url: string,
    private readonly listener: Listener,
  ) {
    transport.onmessage = (data) => this.take(data);
    transport.onclose = (_code, reason) => this.lose(reason);
    transport.onopen = () => undefined;
  }

  connect(): void {
    clearTimeout(this.timer);
    this.timer = undefined;
    this.goodbye = '';
    this.listener.connecting();
    this.transport.open(this.url);
  }

  /** The result of `call`, which is of the case `result`. Throws Refused. */
  async call<Case extends NonNullable<Response['result']['case']>>(call: Call, result: Case): Promise<Result<Case>> {
    const id = ++this.lastId;
    const envelope = create(EnvelopeSchema, { body: { case: 'request', value: { id, call } } });
    const response = await new Promise<Response>((resolve, reject) => {
      this.open.set(id, { resolve, reject });
      this.transport.send(toBinary(EnvelopeSchema, envelope));
    });
    if (response.error) throw new Refused(response.error.code, response.error.message);
    if (response.result.case !== result) {
      throw new Refused(Error_Code.UNSPECIFIED, `the answer is ${response.result.case ?? 'empty'}, not ${result}`);
    }
    return response.result.value as Result<Case>;
  }

  private take(data: Uint8Array): void {
    this.received += data.byteLength;
    let envelope: Envelope;
    try {
      envelope = fromBinary(EnvelopeSchema, data);
    } catch (error) {
      this.goodbye = `a message that cannot be read: ${String(error)}`;
      this.transport.close();
      return;
    }
    const { body } = envelope;
    switch (body.case) {
      case 'hello':
        this.failures = 0;
        this.listener.greeted(body.value);
        break;
      case 'response':
        this.answer(body.value);
        break;
      case 'frame':
        this.listener.frame(body.value);
        break;
      case 'batch':
        for (const frame of body.value.frame) this.listener.frame(frame);
        break;
      case 'event':
        this.listener.event(body.value);
        break;
      case 'gap':
        this.listener.gap(body.value);
        break;
      case 'goodbye':
        this.goodbye = body.value.error?.message ?? '';
        break;
      default: // of a newer gateway
        break;
    }
  }

  private answer(response: Response): void {
    const open = this.open.get(response.id);
    this.open.delete(response.id);
    if (open) open.resolve(response);
    else if (response.error && response.error.code !== Error_Code.NOTHING_TO_DO) this.listener.refused(response.error.message);
  }

  private lose(reason: string): void {
    const why = this.goodbye || reason || 'the connection was closed';
    const failed = new Refused(Error_Code.FAILED, why);
    for (const { reject } of this.open.values()) reject(failed);
    this.open.clear();
    const retry = Math.min(FIRST_RETRY * 2 ** this.failures, LAST_RETRY);
    this.failures += 1;
    this.timer = setTimeout(() => this.connect(), retry * 1000);
    this.listener.lost(why, retry);
  }
}
