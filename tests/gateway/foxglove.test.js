// haptic-view as viewers see it: Foxglove's own client library, and nothing of ours but what the server tells.

import assert from "node:assert/strict";
import { after, before, describe, it } from "node:test";
import { setTimeout as sleep } from "node:timers/promises";

import { Viewer, assertOneForEach, eventually, memoryOf, startDaemon, startGateway, temporaryFolder } from "./support.js";

const TOPICS = ["/tf", "/scene", "/haptic/frame", "/log", "/stats"];

let folder;
let socket;
let daemon;
let gateway;

before(async () => {
  folder = temporaryFolder();
  socket = folder.file("hapticd.sock");
  daemon = await startDaemon(socket, "config/teapot.txtpb");
  gateway = await startGateway("--server", socket);
});
after(async () => {
  await gateway.stop();
  await daemon.stop();
  folder.remove();
});

describe("a viewer", () => {
  it("is told what there is, in the subprotocol that it offers", async () => {
    for (const subprotocol of ["foxglove.sdk.v1", "foxglove.websocket.v1"]) {
      const viewer = await Viewer.open(gateway, [subprotocol]);
      assert.equal(viewer.socket.protocol, subprotocol);
      assert.match(viewer.info.name, /^haptic-view \d/);
      assert.deepEqual(viewer.info.capabilities, []);
      assert.deepEqual([...viewer.channels.keys()], TOPICS);
      await viewer.close();
      assert.deepEqual(viewer.errors, []);
    }
  });

  it("knows a server again by its session", async () => {
    const [first, second] = [await Viewer.open(gateway), await Viewer.open(gateway)];
    assert.equal(first.info.sessionId, second.info.sessionId);
    await Promise.all([first.close(), second.close()]);
  });

  it("sees where things are, in frames that tie them to the world", async () => {
    const viewer = await Viewer.open(gateway);
    viewer.subscribe("/tf");
    const [{ value }] = await viewer.some("/tf");
    const frames = value.transforms.map((transform) => {
      assert.equal(transform.parent_frame_id, "world");
      return transform.child_frame_id;
    });
    assert.deepEqual(frames.sort(), ["device/left", "device/right", "object/teapot"]);
    await viewer.close();
  });

  it("sees a mesh as triangles, HIPs and their forces", async () => {
    const viewer = await Viewer.open(gateway);
    viewer.subscribe("/scene");
    const [first, second] = await viewer.some("/scene", 2);
    const ALL = 1;
    assert.equal(first.value.deletions[0].type, ALL);
    const teapot = first.value.entities.find(({ id }) => id === "teapot");
    assert.equal(teapot.frame_id, "object/teapot");
    assert(teapot.triangles[0].indices.length > 3 * 100);
    const corners = teapot.triangles[0].points.length;
    assert(teapot.triangles[0].indices.every((index) => index < corners));
    assert.deepEqual(second.value.entities.map(({ id }) => id), ["HIPs", "forces"]);
    assert.equal(second.value.deletions.length, 0);
    await viewer.close();
  });

  it("gets shapes and not only what moves, however late it comes", async () => {
    const early = await Viewer.open(gateway);
    early.subscribe("/scene");
    await early.some("/scene", 5);
    const late = await Viewer.open(gateway);
    late.subscribe("/scene");
    const [{ value }] = await late.some("/scene");
    assert(value.entities.some(({ id }) => id === "teapot"));
    await Promise.all([early.close(), late.close()]);
  });

  it("gets the daemon's frames, with their time, and no more than a screen shows", async () => {
    const viewer = await Viewer.open(gateway);
    viewer.subscribe("/haptic/frame");
    const frames = await viewer.some("/haptic/frame", 40);
    const LEAST = 17; // ticks: 1000 Hz / 17 = 59 Hz
    for (const [i, { time, value }] of frames.entries()) {
      assert(Math.abs(Number(time) / 1e6 - Date.now()) < 30_000, "the clock of the wall");
      assert(Math.abs(Number(time) - value.realtime_ns) < 1000); // what a double keeps of nanoseconds
      assert.equal(value.objects.position.length, 3);
      assert.equal(value.devices.present.length, 2);
      assert(value.hips.position.length > 0);
      if (i > 0) {
        assert(value.tick > frames[i - 1].value.tick);
        assert(time > frames[i - 1].time);
      }
    }
    assertOneForEach(LEAST, frames.map(({ value }) => value));
    await viewer.close();
  });

  it("gets statistics and what happens", async () => {
    const viewer = await Viewer.open(gateway);
    viewer.subscribe("/stats");
    viewer.subscribe("/log");
    const [{ value: stats }] = await viewer.some("/stats");
    assert.equal(stats.rate_hz, 1000);
    assert(stats.stage.some(({ name }) => name === "tick"));
    daemon.ctl("pause");
    daemon.ctl("resume");
    const log = await viewer.some("/log", 2);
    assert(log.every(({ value }) => value.name === "hapticd"));
    assert.notEqual(log[0].value.message, "");
    await viewer.close();
  });

  it("gets nothing more of what it has left", async () => {
    const viewer = await Viewer.open(gateway);
    const id = viewer.subscribe("/haptic/frame");
    await viewer.some("/haptic/frame", 3);
    viewer.client.unsubscribe(id);
    viewer.subscribe("/tf"); // what was said before has been heard when this comes
    await viewer.some("/tf");
    const count = viewer.messages.get("/haptic/frame").length;
    await viewer.some("/tf", 20);
    assert.equal(viewer.messages.get("/haptic/frame").length, count);
    await viewer.close();
  });

  it("sees another scene as soon as it runs", async () => {
    const viewer = await Viewer.open(gateway);
    viewer.subscribe("/scene");
    await viewer.some("/scene", 3);
    daemon.ctl("object", "add", "ball", "--sphere", "0.01", "--inside", "china", "--outside", "air", "--air-margin",
      "0.01", "--at", "0", "0.2", "0");
    await eventually(() => viewer.messages.get("/scene").some(({ value }) =>
      value.entities.some(({ id }) => id === "ball")), "the ball");
    await viewer.close();
  });

  it("is told what it said wrong, and what is not to be had, and goes on", async () => {
    const viewer = await Viewer.open(gateway);
    const ERROR = 2;
    viewer.socket.send("nonsense");
    viewer.socket.send(JSON.stringify({ op: "subscribe", subscriptions: [{ id: 1, channelId: 99 }] }));
    viewer.socket.send(Buffer.from([1, 0, 0, 0, 0]));
    viewer.client.getParameters([]);
    await eventually(() => viewer.statuses.length === 4);
    assert(viewer.statuses.every(({ level }) => level === ERROR));
    viewer.subscribe("/tf");
    await viewer.some("/tf");
    await viewer.close();
  });

  it("is closed if a message is longer than any that it may send", async () => {
    const viewer = await Viewer.open(gateway);
    const TOO_BIG = 1009;
    viewer.socket.send("x".repeat(65 * 1024));
    assert.equal((await viewer.closed).code, TOO_BIG);
  });
});

describe("a viewer that does not read", () => {
  it("costs the gateway a bounded memory and others nothing, and sees the newest when it reads again", async () => {
    const stalled = await Viewer.open(gateway);
    const other = await Viewer.open(gateway);
    for (const topic of TOPICS) {
      stalled.subscribe(topic);
    }
    other.subscribe("/haptic/frame");
    await stalled.some("/haptic/frame", 5);
    stalled.socket._socket.pause();
    await sleep(2000); // what the system keeps is full
    const before = memoryOf(gateway.child);
    const count = other.messages.get("/haptic/frame").length;
    await sleep(4000);
    assert(memoryOf(gateway.child) - before < 4 * 1024 * 1024, "it grows");
    assert(other.messages.get("/haptic/frame").length - count > 40, "others wait for it");

    const frames = stalled.messages.get("/haptic/frame");
    const last = frames.at(-1).value.tick;
    stalled.socket._socket.resume();
    const now = other.messages.get("/haptic/frame").at(-1).value.tick;
    await eventually(() => frames.at(-1).value.tick > now, "the newest");
    const since = frames.filter(({ value }) => value.tick > last);
    const steps = since.map(({ value }, i) => value.tick - (i > 0 ? since[i - 1].value.tick : last));
    assert(Math.max(...steps) > 1000, "nothing was left out");
    await Promise.all([stalled.close(), other.close()]);
  });
});

describe("a daemon that goes", () => {
  it("is told of, and found again without a new connection", async () => {
    const viewer = await Viewer.open(gateway);
    viewer.subscribe("/haptic/frame");
    viewer.subscribe("/scene");
    await viewer.some("/haptic/frame", 3);
    await daemon.stop("SIGKILL");
    const status = await eventually(() => viewer.statuses.at(-1), "a status");
    assert.equal(status.id, "daemon");
    assert.match(status.message, /hapticd\.sock/);

    // who comes now is told, too
    const late = await Viewer.open(gateway);
    assert.equal((await eventually(() => late.statuses[0])).id, "daemon");

    const frames = viewer.messages.get("/haptic/frame").length;
    const scenes = viewer.messages.get("/scene").length;
    daemon = await startDaemon(socket, "config/teapot.txtpb");
    await eventually(() => viewer.removed.includes("daemon") && late.removed.includes("daemon"), "the daemon");
    await viewer.some("/haptic/frame", frames + 5);
    await eventually(() => viewer.messages.get("/scene").slice(scenes).some(({ value }) =>
      value.entities.some(({ id }) => id === "teapot")), "shapes");
    await Promise.all([viewer.close(), late.close()]);
  });

  it("is not connected to while nobody looks", async () => {
    await eventually(() => daemon.status().clients === 1, "the gateway has left"); // hapticctl itself
    const viewer = await Viewer.open(gateway);
    await eventually(() => daemon.status().clients === 2);
    const second = await Viewer.open(gateway);
    second.subscribe("/tf");
    await second.some("/tf");
    assert.equal(daemon.status().clients, 2); // one for all viewers
    await Promise.all([viewer.close(), second.close()]);
    await eventually(() => daemon.status().clients === 1);
  });
});
