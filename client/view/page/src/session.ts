// The daemon as the page sees it: what it is, asked for again and again, and every moment that it tells.
import { Client, type Listener, Refused } from './connection/client';
import type { WorkerTransport } from './connection/worker_transport';
import { Role } from './gen/haptic/v1/config_pb';
import { Delivery, type FaultList_FaultRecord, type Hello, type SceneDescription, type Status, Topic } from './gen/haptic/v1/control_pb';
import type { DeviceStatus } from './gen/haptic/v1/device_pb';
import { type Event, Event_Kind, type Frame, type Stats } from './gen/haptic/v1/telemetry_pb';
import { markOf } from './model/marks';
import { momentOf, paceOf } from './model/moment';
import { LIVE_SECONDS, makeSource, type Source } from './model/source';

const PICTURES = 60; // Hz, of moments
const SILENCE = 10_000; // ms before the same refusal is told again
const POLL = 1000; // ms between two questions for status and devices

export interface Watcher {
  connection(state: 'up' | 'down' | 'connecting', text: string): void;
  status(): void;
  devices(): void;
  scene(): void;
  faults(): void;
  wrong(text: string): void;
  happened(event: Event): void;
}

export class Session {
  readonly source: Source = makeSource('live', LIVE_SECONDS);
  readonly client: Client;
  hello: Hello | undefined;
  status: Status | undefined;
  statuses: DeviceStatus[] = [];
  scene: SceneDescription | undefined;
  /** Since the daemon's start; nothing if it does not tell them. */
  faults: FaultList_FaultRecord[] | undefined;
  /** Frames that the daemon says this page was too slow for. */
  lostFrames = 0;
  private complaint = { text: '', at: 0 };
  private startNs: bigint | undefined;
  private stats: Stats | undefined;
  private asking = 0n;
  private deviceNames = '';
  private pollTimer: ReturnType<typeof setInterval> | undefined;

  constructor(
    transport: WorkerTransport,
    url: string,
    private readonly watcher: Watcher,
  ) {
    const listener: Listener = {
      connecting: () => watcher.connection('connecting', 'connecting …'),
      greeted: (hello) => void this.greet(hello),
      frame: (frame) => this.take(frame),
      event: (event) => this.hear(event),
      gap: (gap) => {
        this.lostFrames += Number(gap.lastSequence - gap.firstSequence) + 1;
      },
      refused: (message) => this.complain(message),
      lost: (reason, retry) => {
        clearInterval(this.pollTimer);
        this.hello = undefined;
        this.status = undefined;
        watcher.connection('down', `${reason}. Next attempt in ${retry < 1 ? retry.toFixed(1) : retry.toFixed(0)} s.`);
        watcher.status();
      },
    };
    this.client = new Client(transport, url, listener);
  }

  /** The same again and again is told once in a while. */
  private complain(message: string): void {
    const now = performance.now();
    if (message === this.complaint.text && now - this.complaint.at < SILENCE) return;
    this.complaint = { text: message, at: now };
    this.watcher.wrong(message);
  }

  get mayDrive(): boolean {
    return (this.hello?.role ?? Role.ROLE_UNSPECIFIED) >= Role.DRIVE;
  }

  get armed(): boolean | undefined {
    return this.source.moments.newest?.armed ?? this.status?.armed;
  }

  connect(): void {
    this.client.connect();
  }

  private async greet(hello: Hello): Promise<void> {
    this.hello = hello;
    this.startNs = undefined;
    this.stats = undefined;
    this.source.moments.clear();
    this.source.paces.clear();
    this.source.marks.clear();
    this.source.scenes.clear();
    this.scene = undefined;
    this.asking = 0n;
    this.watcher.connection('up', 'live');
    try {
      await this.poll();
      await this.fetchScene();
      await this.fetchFaults();
      const rate = this.status?.rateHz || 1000;
      const decimation = Math.max(1, Math.round(rate / PICTURES));
      const topic = [Topic.OBJECTS, Topic.HIPS, Topic.DEVICES];
      await this.client.call({ case: 'subscribe', value: { topic, decimation, delivery: Delivery.LATEST } }, 'subscribed');
      await this.client.call({ case: 'subscribe', value: { topic: [Topic.STATS], delivery: Delivery.LATEST } }, 'subscribed');
      clearInterval(this.pollTimer);
      this.pollTimer = setInterval(() => void this.poll().catch(() => undefined), POLL);
    } catch (error) {
      if (this.hello === hello) this.watcher.wrong(error instanceof Refused ? error.message : String(error));
    }
  }

  async poll(): Promise<void> {
    const [status, devices] = await Promise.all([
      this.client.call({ case: 'getStatus', value: {} }, 'status'),
      this.client.call({ case: 'listDevices', value: {} }, 'devices'),
    ]);
    this.status = status;
    this.statuses = devices.device;
    const descriptions = devices.device.flatMap((device) => device.description ?? []);
    const names = descriptions.map((d) => `${d.name}/${d.driver}/${d.maxForce}`).join();
    this.source.devices = descriptions;
    if (names !== this.deviceNames) {
      this.deviceNames = names;
      this.watcher.devices();
    }
    this.watcher.status();
  }

  private async fetchFaults(): Promise<void> {
    try {
      this.faults = (await this.client.call({ case: 'listFaults', value: {} }, 'faults')).fault;
    } catch {
      this.faults = undefined; // a daemon from before there was the call
    }
    this.watcher.faults();
  }

  private async askScene(): Promise<SceneDescription> {
    try {
      return await this.client.call({ case: 'getScene', value: { embedMeshes: true } }, 'scene');
    } catch (error) {
      // its meshes may be larger than the daemon sends; the rest can be seen
      const scene = await this.client.call({ case: 'getScene', value: {} }, 'scene');
      this.watcher.wrong(`Meshes cannot be drawn: ${error instanceof Error ? error.message : String(error)}`);
      return scene;
    }
  }

  private async fetchScene(): Promise<void> {
    const scene = await this.askScene();
    this.source.scenes.set(scene.revision, scene);
    while (this.source.scenes.size > 8) {
      const [oldest] = this.source.scenes.keys();
      if (oldest !== undefined) this.source.scenes.delete(oldest);
    }
    this.scene = scene;
    this.watcher.scene();
  }

  private take(frame: Frame): void {
    this.startNs ??= frame.monotonicNs;
    const time = Number(frame.monotonicNs - this.startNs) * 1e-9;
    if (frame.stats) {
      if (this.stats) this.source.paces.push(paceOf(this.stats, frame.stats, time));
      this.stats = frame.stats;
      return;
    }
    this.source.moments.push(momentOf(frame, this.startNs));
    if (!this.source.scenes.has(frame.sceneRevision) && this.asking !== frame.sceneRevision && this.scene) {
      this.asking = frame.sceneRevision;
      void this.fetchScene().catch((error: unknown) => this.watcher.wrong(`the scene: ${String(error)}`));
    }
  }

  private hear(event: Event): void {
    this.source.marks.push(markOf(event, this.source.moments.newest?.time ?? 0));
    this.watcher.happened(event);
    if (event.kind === Event_Kind.TICKS_MISSED) return;
    void this.poll().catch(() => undefined);
    const isFault = [Event_Kind.FAULT_LATCHED, Event_Kind.FAULT_CLEARED, Event_Kind.FAULT_RECORDED].includes(event.kind);
    if (isFault) void this.fetchFaults();
  }

  // --- what a driver may do; each tells what went wrong -------------------------------------------------------

  private async does(what: string, action: () => Promise<unknown>): Promise<void> {
    try {
      await action();
    } catch (error) {
      this.watcher.wrong(`${what}: ${error instanceof Error ? error.message : String(error)}`);
    }
    await this.poll().catch(() => undefined);
  }

  arm(): Promise<void> {
    return this.does('Arm', () => this.client.call({ case: 'arm', value: {} }, 'done'));
  }

  disarm(): Promise<void> {
    return this.does('Disarm', () => this.client.call({ case: 'disarm', value: {} }, 'done'));
  }

  /** Emergency stop. A daemon that does not know it is disarmed, at least. */
  stop(): Promise<void> {
    return this.does('Stop', async () => {
      try {
        await this.client.call({ case: 'emergencyStop', value: {} }, 'done');
      } catch {
        await this.client.call({ case: 'disarm', value: {} }, 'done');
      }
    });
  }

  clearFault(): Promise<void> {
    return this.does('Clear fault', () => this.client.call({ case: 'clearFault', value: {} }, 'done'));
  }

  pauseOrResume(): Promise<void> {
    const call = this.status?.paused ? ({ case: 'resume', value: {} } as const) : ({ case: 'pause', value: {} } as const);
    return this.does('Pause', () => this.client.call(call, 'done'));
  }

  step(ticks: number): Promise<void> {
    return this.does('Step', () => this.client.call({ case: 'step', value: { ticks: BigInt(ticks) } }, 'done'));
  }

  resetScene(): Promise<void> {
    return this.does('Reset', () => this.client.call({ case: 'resetScene', value: {} }, 'done'));
  }
}
