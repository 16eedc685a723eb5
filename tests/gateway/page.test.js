// haptic-view as its own page sees it: haptic.v1, with the rights of an observer and of a driver.

import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, describe, it } from "node:test";
import { setTimeout as sleep } from "node:timers/promises";

import { Code, Page, Role, Topic, assertOneForEach, eventually, memoryOf, root, startDaemon,
  startGateway, temporaryFolder } from "./support.js";

const DRIVER = "a-token-of-the-driver";
const LEAST = 17; // ticks: 1000 Hz / 17 = 59 Hz
const asDriver = `?token=${DRIVER}`;

let folder;
let socket;
let config;
let daemon;
let gateway;

before(async () => {
  folder = temporaryFolder();
  socket = folder.file("hapticd.sock");
  config = folder.file("config.txtpb");
  // patient with a page on a busy machine
  writeFileSync(config, `device { name: "hand" virtual {} }
    safety { max_sample_age: 1 }
    drive { heartbeat: 5 }
    scene: "${join(root, "config/scenes/hand_box.scene.txtpb")}"\n`);
  writeFileSync(folder.file("token"), `${DRIVER}\n`, { mode: 0o600 });
  daemon = await startDaemon(socket, config);
  gateway = await startGateway("--server", socket, "--drive-token-file", folder.file("token"));
});
after(async () => {
  await gateway.stop();
  await daemon.stop();
  folder.remove();
});

const subscribe = (topic, wish = {}) => ({ subscribe: { topic: topic.map((name) => Topic[name]), ...wish } });
const move = (x) => ({ moveDevice: { device: "hand", pose: { position: { x }, orientation: { w: 1 } } } });

describe("a page", () => {
  it("is greeted first, as an observer", async () => {
    const page = await Page.open(gateway);
    assert.equal(page.hello.role, Role.OBSERVE);
    assert.equal(page.hello.program, "hapticd");
    assert(page.hello.feature.includes("subscribe.delivery"));
    assert(!page.hello.feature.includes("device.move"));
    assert(page.hello.sceneRevision > 0);
    await page.close();
  });

  it("is answered what it asks", async () => {
    const page = await Page.open(gateway);
    assert.equal((await page.get({ getStatus: {} })).status.scene, "hand_box");
    assert.equal((await page.get({ listDevices: {} })).devices.device[0].description.name, "hand");
    assert.equal((await page.get({ getScene: { embedMeshes: true } })).scene.scene.object[0].name, "box");
    assert.equal((await page.get({ getStats: {} })).stats.rateHz, 1000);
    await page.close();
  });

  it("gets frames, no more than a screen shows whatever it asks for", async () => {
    const page = await Page.open(gateway);
    const LOSSLESS = 2;
    const { subscribed } = await page.get(subscribe(["OBJECTS", "DEVICES"], { delivery: LOSSLESS, decimation: 1 }));
    await eventually(() => page.frames.length >= 40, "frames");
    assert(page.messages.every(({ batch }) => !batch));
    page.frames.forEach((frame) => assert.equal(frame.subscription, subscribed.subscription));
    assertOneForEach(LEAST, page.frames);
    await page.get({ unsubscribe: subscribed });
    await page.close();
  });

  it("gets fewer if it wants fewer", async () => {
    const page = await Page.open(gateway);
    await page.get(subscribe(["OBJECTS"], { decimation: 100 }));
    await eventually(() => page.frames.length >= 5, "frames");
    assertOneForEach(100, page.frames);
    await page.close();
  });

  it("is told what happens without asking", async () => {
    const page = await Page.open(gateway);
    daemon.ctl("pause");
    daemon.ctl("resume");
    await eventually(() => page.messages.filter(({ event }) => event).length >= 2, "events");
    await page.close();
  });

  it("gets the daemon's own refusals", async () => {
    const page = await Page.open(gateway);
    const { error } = await page.ask(subscribe(["HIPS"], { finger: ["nobody"] }));
    assert.equal(error.code, Code.NOT_FOUND);
    await page.close();
  });

  it("that only observes drives nothing", async () => {
    const page = await Page.open(gateway);
    for (const call of ["arm", "disarm", "emergencyStop", "clearFault", "pause", "resume", "step", "resetScene",
      "acquireDrive", "releaseDrive", "heartbeat", "moveDevice", "loadScene", "editScene", "getState",
      "manageDevice"]) {
      const { error } = await page.ask({ [call]: {} });
      assert.equal(error.code, Code.REFUSED, call);
    }
    const status = daemon.status();
    assert(!status.armed && !status.paused);
    await page.close();
  });
});

describe("a page with the token of a driver", () => {
  it("is told so", async () => {
    const page = await Page.open(gateway, asDriver);
    assert(page.hello.role >= Role.DRIVE);
    assert(page.hello.feature.includes("device.move"));
    await page.close();
  });

  it("arms, moves a device, and disarms", async () => {
    const page = await Page.open(gateway, asDriver);
    await page.get(subscribe(["DEVICES"]));
    const moving = setInterval(() => page.send({ request: { id: 1_000_000, ...move(0.05) } }), 10);
    await eventually(() => page.frames.at(-1)?.devices.position[0] === 0.05, "the device is there");
    await page.get({ arm: {} });
    assert.equal((await page.get({ getStatus: {} })).status.armed, true);
    await page.get({ disarm: {} });
    clearInterval(moving);
    assert(!daemon.status().armed);
    await page.close();
  });

  it("does not change scenes", async () => {
    const page = await Page.open(gateway, asDriver);
    assert.equal((await page.ask({ loadScene: { path: "/etc/passwd" } })).error.code, Code.REFUSED);
    assert.equal((await page.ask({ editScene: {} })).error.code, Code.REFUSED);
    assert.equal((await page.ask(subscribe(["INPUTS"]))).error.code, Code.REFUSED);
    await page.close();
  });

  it("is one client of the daemon: another page does not take its device from it", async () => {
    const [first, second] = [await Page.open(gateway, asDriver), await Page.open(gateway, asDriver)];
    const takes = (page) => eventually(async () => !(await page.ask(move(0.01))).error, "the one before has let go");
    await takes(first);
    assert.equal((await second.ask(move(0.02))).error.code, Code.REFUSED);
    await takes(second);
    await Promise.all([first.close(), second.close()]);
  });

  it("that holds the drive lease loses it with its end", async () => {
    const page = await Page.open(gateway, asDriver);
    const { driveLease } = await page.get({ acquireDrive: {} });
    const other = await Page.open(gateway, asDriver);
    const beat = setInterval(() => page.send({ request: { id: 1_000_000, heartbeat: {} } }),
      driveLease.heartbeatMs / 4);
    assert.equal((await other.ask({ acquireDrive: {} })).error.code, Code.REFUSED);
    assert.equal((await other.ask({ arm: {} })).error.code, Code.REFUSED);
    clearInterval(beat);
    page.socket.terminate();
    await page.closed;
    await eventually(() => !daemon.status().driveHolder && !daemon.status().drive_holder, "the lease is free");
    await other.close();
  });
});

describe("a page that talks nonsense", () => {
  const cases = [
    ["text", 1003, "get_status"],
    ["what is no envelope", 1007, Buffer.from([0xff, 0xff, 0xff])],
    ["a hello of its own", 1002, Buffer.from([0x0a, 0x02, 0x08, 0x01])],
    ["a message that is too long", 1009, Buffer.alloc(65 * 1024)],
  ];
  for (const [what, code, message] of cases) {
    it(`is closed after ${what}`, async () => {
      const page = await Page.open(gateway);
      page.socket.send(message);
      assert.equal((await page.closed).code, code);
    });
  }

  it("is not closed after an envelope of a newer protocol", async () => {
    const page = await Page.open(gateway);
    page.socket.send(Buffer.from([0xa2, 0x06, 0x00])); // field 100, of a later version
    page.socket.send(Buffer.alloc(0));
    await page.get({ getStatus: {} });
    await page.close();
  });
});

describe("a page that does not read", () => {
  it("costs a bounded memory, and gets the newest when it reads again", async () => {
    const stalled = await Page.open(gateway);
    const other = await Page.open(gateway);
    // what it would get fills what the systems keep, so that it stalls soon
    for (let i = 0; i < 12; ++i) {
      await stalled.get(subscribe(["OBJECTS", "HIPS", "DEVICES", "STATS"]));
    }
    await other.get(subscribe(["OBJECTS"]));
    await eventually(() => stalled.frames.length > 20 && other.frames.length > 20, "frames");
    stalled.socket._socket.pause();
    await sleep(3000);
    const before = memoryOf(gateway.child);
    const daemonBefore = memoryOf(daemon.child);
    const count = other.frames.length;
    await sleep(5000);
    assert(memoryOf(gateway.child) - before < 4 * 1024 * 1024, "the gateway grows");
    assert(memoryOf(daemon.child) - daemonBefore < 8 * 1024 * 1024, "the daemon grows");
    assert(other.frames.length - count > 50, "others wait for it");
    stalled.socket._socket.resume();
    const now = other.frames.at(-1).tick;
    await eventually(() => stalled.frames.at(-1).tick > now, "the newest");
    await Promise.all([stalled.close(), other.close()]);
    assert.equal(gateway.child.exitCode, null);
  });
});

describe("a daemon that goes", () => {
  it("ends the page with the reason, and the next one finds it when it is back", async () => {
    const page = await Page.open(gateway);
    const TRY_AGAIN_LATER = 1013;
    await daemon.stop("SIGKILL");
    const closed = await page.closed;
    assert.equal(closed.code, TRY_AGAIN_LATER);
    assert.match(closed.reason, /closed the connection/);

    const early = new Page(`${gateway.socketUrl}ws`);
    const refused = await early.closed;
    assert.equal(refused.code, TRY_AGAIN_LATER);
    assert.match(refused.reason, /cannot reach the daemon/);

    daemon = await startDaemon(socket, config);
    const late = await Page.open(gateway);
    await late.get({ getStatus: {} });
    await late.close();
  });

  it("that stops in peace says goodbye to the page", async () => {
    const page = await Page.open(gateway);
    await daemon.stop();
    await page.closed;
    assert(page.messages.some(({ goodbye }) => goodbye));
    daemon = await startDaemon(socket, config);
  });
});
