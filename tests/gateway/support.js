// What the tests of haptic-view share: a daemon and a gateway of their own, a page that speaks haptic.v1, and a
// viewer by Foxglove's own client library. HAPTICD, HAPTICCTL and HAPTIC_VIEW name the programs.

import assert from "node:assert/strict";
import { execFileSync, spawn, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { setTimeout as sleep } from "node:timers/promises";
import { fileURLToPath } from "node:url";

import foxglove from "@foxglove/ws-protocol";
import protobuf from "protobufjs";
import "protobufjs/ext/descriptor/index.js";
import WebSocket from "ws";

export const root = fileURLToPath(new URL("../..", import.meta.url));
export const { HAPTICD, HAPTICCTL, HAPTIC_VIEW } = process.env;
const PATIENCE = 30_000; // ms; a sanitizer's build on a busy machine is slow

const schema = new protobuf.Root();
schema.resolvePath = (_, target) => join(root, "proto", target);
schema.loadSync("haptic/v1/control.proto");
export const Envelope = schema.lookupType("haptic.v1.Envelope");
export const enumOf = (name) => schema.lookupEnum(`haptic.v1.${name}`).values;
export const Role = enumOf("Role");
export const Topic = enumOf("Topic");
export const Code = enumOf("Error.Code");

export function temporaryFolder() {
  const folder = mkdtempSync(join(tmpdir(), "haptic_gateway."));
  return { folder, file: (name) => join(folder, name), remove: () => rmSync(folder, { recursive: true }) };
}

/** Waits until the condition gives something, which is returned. */
export async function eventually(condition, what) {
  const giveUp = Date.now() + PATIENCE;
  for (;;) {
    const value = await condition();
    if (value) {
      return value;
    }
    assert(Date.now() < giveUp, `in vain: ${what ?? condition}`);
    await sleep(10);
  }
}

/** A program in the background; `errors` is what it has told so far. */
export function start(program, args) {
  const child = spawn(program, args, { stdio: ["ignore", "ignore", "pipe"] });
  const run = { child, errors: "" };
  child.stderr.on("data", (text) => {
    run.errors += text;
  });
  run.done = new Promise((resolve) => child.on("close", (code, signal) => resolve(code ?? signal)));
  run.stop = async (signal = "SIGTERM") => {
    child.kill(signal);
    return run.done;
  };
  return run;
}

/** A daemon, as soon as it answers. */
export async function startDaemon(socket, config) {
  const run = start(HAPTICD, ["run", "--config", resolve(root, config), "--socket", socket]);
  const ctl = (...args) => execFileSync(HAPTICCTL, ["--socket", socket, ...args], { stdio: "pipe" }).toString();
  await eventually(() => spawnSync(HAPTICCTL, ["--socket", socket, "status"]).status === 0, "the daemon");
  return { ...run, stop: run.stop, ctl, status: () => JSON.parse(ctl("--json", "status")) };
}

/** A gateway on a free port, as soon as it listens. */
export async function startGateway(...args) {
  const run = start(HAPTIC_VIEW, ["--listen", "127.0.0.1:0", ...args]);
  const [, url] = await eventually(() => /serves (\S+)/.exec(run.errors), "haptic-view");
  return Object.assign(run, { url, socketUrl: url.replace(/^http/, "ws") });
}

/** At most one frame for so many ticks; one that was late does not put off the next. */
export function assertOneForEach(ticks, frames) {
  const groups = frames.map(({ tick }) => Math.floor(tick / ticks));
  groups.slice(1).forEach((group, i) => assert(group > groups[i], `two frames for ${ticks} ticks: ${frames[i + 1].tick}`));
}

/** Resident memory of a process, bytes. */
export function memoryOf(child) {
  const [, kilobytes] = /VmRSS:\s+(\d+) kB/.exec(readFileSync(`/proc/${child.pid}/status`, "utf8"));
  return 1024 * Number(kilobytes);
}

/** What a WebSocket is answered that is not let in, as HTTP's status; 101 if it is. */
export function knock(url, subprotocols, options = {}) {
  return new Promise((resolve, reject) => {
    const socket = new WebSocket(url, subprotocols, options);
    socket.on("open", () => {
      socket.terminate();
      resolve(101);
    });
    socket.on("unexpected-response", (_, response) => {
      response.resume();
      resolve(response.statusCode);
    });
    socket.on("error", reject);
  });
}

/** A page that speaks haptic.v1. */
export class Page {
  messages = []; // that are no responses
  #answers = new Map();
  #lastId = 0;

  constructor(url, options) {
    this.socket = new WebSocket(url, ["haptic.v1"], options);
    this.socket.on("error", () => {});
    this.closed = new Promise((resolve) => {
      this.socket.on("close", (code, reason) => resolve({ code, reason: reason.toString() }));
    });
    this.socket.on("message", (bytes) => {
      const envelope = Envelope.toObject(Envelope.decode(bytes), { longs: Number, arrays: true });
      if (envelope.response) {
        this.#answers.set(envelope.response.id, envelope.response);
      } else {
        this.messages.push(envelope);
      }
    });
  }

  /** A page that has got its hello; fails at once where it is not let in. */
  static async open(gateway, query = "", options = {}) {
    const page = new Page(`${gateway.socketUrl}ws${query}`, options);
    let closed = false;
    page.closed.then(() => (closed = true));
    await eventually(() => page.messages.length > 0 || closed, "hello");
    assert(page.messages.length > 0, "closed before hello");
    page.hello = page.messages.shift().hello;
    return page;
  }

  get frames() {
    return this.messages.filter(({ frame }) => frame).map(({ frame }) => frame);
  }

  send(envelope) {
    this.socket.send(Envelope.encode(Envelope.fromObject(envelope)).finish());
  }

  /** The answer to a request, an error included. */
  async ask(call) {
    const id = ++this.#lastId;
    this.send({ request: { id, ...call } });
    return eventually(() => this.#answers.get(id), `an answer to ${JSON.stringify(call)}`);
  }

  /** The answer to a request, which must be no error. */
  async get(call) {
    const response = await this.ask(call);
    assert.equal(response.error, undefined, JSON.stringify(response.error));
    return response;
  }

  close() {
    this.socket.close();
    return this.closed;
  }
}

/** A viewer of Foxglove's kind. */
export class Viewer {
  channels = new Map(); // by topic
  messages = new Map(); // by topic: [{time, value}]
  statuses = [];
  removed = [];
  errors = [];
  #types = new Map();
  #topics = new Map(); // by subscription

  constructor(url, subprotocols = ["foxglove.sdk.v1", "foxglove.websocket.v1"]) {
    this.socket = new WebSocket(url, subprotocols);
    this.client = new foxglove.FoxgloveClient({ ws: this.socket });
    this.client.on("error", (error) => this.errors.push(error));
    this.client.on("serverInfo", (info) => {
      this.info = info;
    });
    this.client.on("status", (status) => this.statuses.push(status));
    this.client.on("removeStatus", ({ statusIds }) => this.removed.push(...statusIds));
    this.closed = new Promise((resolve) => this.client.on("close", resolve));
    this.client.on("advertise", (channels) => {
      for (const channel of channels) {
        this.channels.set(channel.topic, channel);
        const set = protobuf.descriptor.FileDescriptorSet.decode(Buffer.from(channel.schema, "base64"));
        this.#types.set(channel.topic, protobuf.Root.fromDescriptor(set).lookupType(channel.schemaName));
      }
    });
    this.client.on("message", ({ subscriptionId, timestamp, data }) => {
      const topic = this.#topics.get(subscriptionId);
      assert(topic, `nobody has subscribed by ${subscriptionId}`);
      const type = this.#types.get(topic);
      const bytes = new Uint8Array(data.buffer, data.byteOffset, data.byteLength);
      this.messages.get(topic).push({ time: timestamp, value: type.toObject(type.decode(bytes), { longs: Number, arrays: true }) });
    });
  }

  /** A viewer that knows what there is. */
  static async open(gateway, ...args) {
    const viewer = new Viewer(gateway.socketUrl, ...args);
    await eventually(() => viewer.channels.size > 0, "channels");
    return viewer;
  }

  subscribe(topic) {
    const id = this.client.subscribe(this.channels.get(topic).id);
    this.#topics.set(id, topic);
    this.messages.set(topic, []);
    return id;
  }

  /** What has come, as soon as there are so many. */
  async some(topic, count = 1) {
    const messages = this.messages.get(topic);
    await eventually(() => messages.length >= count, `${count} of ${topic}`);
    return messages;
  }

  close() {
    this.client.close();
    return this.closed;
  }
}
