// Recordings as others read them: by Foxglove's own readers, with the schemas that are in the file and nothing
// else of ours. HAPTICD and HAPTICCTL name the programs.

import assert from "node:assert/strict";
import { execFileSync, spawn, spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, truncateSync, statSync, existsSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, describe, it } from "node:test";
import { setTimeout as sleep } from "node:timers/promises";
import { fileURLToPath } from "node:url";

import { crc32 } from "@foxglove/crc";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { loadDecompressHandlers } from "@mcap/support";
import protobuf from "protobufjs";
import "protobufjs/ext/descriptor/index.js";

const root = fileURLToPath(new URL("../..", import.meta.url));
const { HAPTICD: hapticd, HAPTICCTL: hapticctl } = process.env;
const decompressHandlers = await loadDecompressHandlers();

/** A file in memory as the indexed reader wants it. */
function readable(bytes) {
  return {
    size: async () => BigInt(bytes.length),
    read: async (offset, length) => bytes.subarray(Number(offset), Number(offset + length)),
  };
}

/** The type of each channel, from the schema in the file. */
function typesOf(channels, schemas) {
  const types = new Map();
  for (const channel of channels.values()) {
    const schema = schemas.get(channel.schemaId);
    assert.equal(schema.encoding, "protobuf");
    const set = protobuf.descriptor.FileDescriptorSet.decode(schema.data);
    types.set(channel.id, protobuf.Root.fromDescriptor(set).lookupType(schema.name));
  }
  return types;
}

/** All messages in the order of their time, decoded: topic -> [{logTime, value}]. */
async function readIndexed(bytes) {
  const reader = await McapIndexedReader.Initialize({ readable: readable(bytes), decompressHandlers });
  const types = typesOf(reader.channelsById, reader.schemasById);
  const topics = new Map();
  let last = 0n;
  for await (const message of reader.readMessages({ validateCrcs: true })) {
    assert(message.logTime >= last);
    last = message.logTime;
    const { topic } = reader.channelsById.get(message.channelId);
    const value = types.get(message.channelId).decode(message.data);
    topics.set(topic, [...(topics.get(topic) ?? []), { logTime: message.logTime, value }]);
  }
  return { reader, topics };
}

/** The records of the file from its start to its end, those in chunks included. */
function readStream(bytes) {
  const reader = new McapStreamReader({ includeChunks: true, decompressHandlers, validateCrcs: true });
  const records = [];
  reader.append(bytes);
  for (let record = reader.nextRecord(); record; record = reader.nextRecord()) {
    records.push(record);
  }
  assert(reader.done());
  return records;
}

/** What `mcap doctor` would complain of. */
function checkAsDoctor(bytes, reader) {
  const records = readStream(bytes);
  const of = (type) => records.filter((record) => record.type === type);
  const [header] = of("Header");
  assert.equal(header.profile, "");
  assert.notEqual(header.library, "");
  const [dataEnd] = of("DataEnd");
  const dataLength = findDataEnd(bytes);
  assert.equal(dataEnd.dataSectionCrc, crc32(bytes.subarray(0, dataLength)));
  const beforeEnd = records.slice(0, records.indexOf(dataEnd));
  for (const [type, all] of [["Schema", reader.schemasById], ["Channel", reader.channelsById]]) {
    const ids = beforeEnd.filter((record) => record.type === type).map((record) => record.id);
    assert.equal(new Set(ids).size, ids.length, `a ${type} is told twice`);
    assert.deepEqual([...all.keys()].sort(), [...ids].sort(), `${type} in the summary and in the data`);
  }
  const chunks = of("Chunk");
  assert.equal(reader.chunkIndexes.length, chunks.length);
  assert.equal(of("ChunkIndex").length, chunks.length);
  let last = 0n;
  let inChunks = 0;
  for (const chunk of chunks) {
    assert(chunk.messageEndTime - chunk.messageStartTime < 500_000_000n, "half a second at most");
    assert.notEqual(chunk.uncompressedCrc, 0);
  }
  for (const message of of("Message")) {
    assert(message.logTime >= last, "time goes backwards");
    last = message.logTime;
    inChunks += 1;
  }
  assert.equal(reader.statistics.messageCount, BigInt(inChunks));
}

/** Where the DataEnd record begins: 13 bytes before the summary. */
function findDataEnd(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  return Number(view.getBigUint64(bytes.length - 37 + 9, true)) - 13;
}

let folder;
before(() => {
  folder = mkdtempSync(join(tmpdir(), "haptic_recording."));
});
after(() => rmSync(folder, { recursive: true }));

describe("a simulated run", () => {
  let bytes;
  let reader;
  let topics;
  before(async () => {
    const file = join(folder, "grasp.mcap");
    execFileSync(hapticd, ["simulate", "--config", join(root, "config/grasp.txtpb"), "--duration", "1.2",
      "--record", file], { stdio: "pipe" });
    bytes = readFileSync(file);
    ({ reader, topics } = await readIndexed(bytes));
  });

  it("is replayed to the bit", () => {
    const replayed = spawnSync(hapticd, ["simulate", "--replay", join(folder, "grasp.mcap"), "--json"]);
    assert.equal(replayed.status, 0, replayed.stderr.toString());
    assert.equal(JSON.parse(replayed.stdout).compared, 1200);
  });

  it("has each tick of each topic, in order", () => {
    for (const topic of ["/haptic/objects", "/haptic/hips", "/haptic/devices"]) {
      const frames = topics.get(topic);
      assert.equal(frames.length, 1201);
      frames.forEach(({ logTime, value }, tick) => {
        assert.equal(Number(value.tick), tick);
        assert.equal(logTime, BigInt(tick) * 1_000_000n);
      });
    }
  });

  it("has the scene whose objects the frames tell of", () => {
    const [{ value: scene }] = topics.get("/haptic/scene");
    const frame = topics.get("/haptic/objects")[0].value;
    assert.equal(frame.objects.position.length, 3 * scene.scene.object.length);
  });

  it("has transforms that tie every object's frame to the world", () => {
    const [{ value: scene }] = topics.get("/haptic/scene");
    const pictures = topics.get("/foxglove/transforms");
    assert.equal(pictures.length, 61); // 50 a second
    const children = pictures[0].value.transforms.map((transform) => {
      assert.equal(transform.parent_frame_id, "world");
      return transform.child_frame_id;
    });
    for (const { name } of scene.scene.object) {
      assert(children.includes(`object/${name}`), name);
    }
  });

  it("has shapes in these frames, and HIPs", () => {
    const [{ value: shapes }] = topics.get("/foxglove/shapes");
    const [{ value: scene }] = topics.get("/haptic/scene");
    assert.deepEqual(shapes.entities.map((entity) => entity.frame_id),
      scene.scene.object.map(({ name }) => `object/${name}`));
    const hips = topics.get("/haptic/hips")[0].value.hips.position.length / 3;
    const [points] = topics.get("/foxglove/hips")[0].value.entities;
    assert.equal(points.spheres.length, hips);
  });

  it("has nothing that a doctor would complain of", () => checkAsDoctor(bytes, reader));

  it("is the same to the bit when it is run again", () => {
    const again = join(folder, "again.mcap");
    execFileSync(hapticd, ["simulate", "--config", join(root, "config/grasp.txtpb"), "--duration", "1.2",
      "--record", again], { stdio: "pipe" });
    assert(bytes.equals(readFileSync(again)));
  });

  it("is readable after a cut and a recovery", async () => {
    const file = join(folder, "cut.mcap");
    execFileSync("cp", [join(folder, "grasp.mcap"), file]);
    truncateSync(file, Math.floor(statSync(file).size * 0.7));
    execFileSync(hapticctl, ["recover", file], { stdio: "pipe" });
    const recovered = readFileSync(join(folder, "cut.recovered.mcap"));
    const read = await readIndexed(recovered);
    const frames = read.topics.get("/haptic/objects");
    assert(frames.length >= 499 && frames.length < 1201, `${frames.length}`);
    checkAsDoctor(recovered, read.reader);
  });
});

/** A daemon of its own, as soon as it answers. */
async function startDaemon(name) {
  const socket = join(folder, `${name}.sock`);
  const daemon = spawn(hapticd, ["run", "--config", join(root, "config/demo.txtpb"), "--socket", socket], {
    stdio: "ignore" });
  daemon.gone = new Promise((resolve) => daemon.on("exit", resolve));
  for (let i = 0; i < 300; ++i) {
    if (existsSync(socket) && spawnSync(hapticctl, ["--socket", socket, "status"]).status === 0) {
      return { daemon, socket };
    }
    await sleep(100);
  }
  return assert.fail("the daemon does not answer");
}

/** hapticctl record, as soon as there is something in its file. */
async function startRecorder(socket, file, ...options) {
  const recorder = spawn(hapticctl, ["--socket", socket, "record", file, ...options], { stdio: "pipe" });
  recorder.output = "";
  for (const stream of [recorder.stdout, recorder.stderr]) {
    stream.on("data", (text) => {
      recorder.output += text;
    });
  }
  recorder.done = new Promise((resolve) => recorder.on("close", resolve));
  for (let i = 0; i < 300 && !(existsSync(file) && statSync(file).size > 20_000); ++i) {
    await sleep(100);
  }
  return recorder;
}

describe("a recording of the daemon", () => {
  let daemon;
  let socket;
  before(async () => {
    ({ daemon, socket } = await startDaemon("served"));
  });
  after(async () => {
    daemon.kill("SIGTERM");
    await daemon.gone;
  });

  for (const signal of ["SIGINT", "SIGTERM"]) {
    it(`that ${signal} ends is whole, with the events and scenes of its time`, async () => {
      const file = join(folder, `${signal}.mcap`);
      const recorder = await startRecorder(socket, file);
      execFileSync(hapticctl, ["--socket", socket, "gravity", "set", "0", "-1", "0"], { stdio: "pipe" });
      await sleep(1500);
      recorder.kill(signal);
      assert.equal(await recorder.done, 0);

      const bytes = readFileSync(file);
      const { reader, topics } = await readIndexed(bytes);
      const scenes = topics.get("/haptic/scene").map(({ value }) => Number(value.revision));
      assert.equal(scenes.length, 2);
      assert.equal(scenes[1], scenes[0] + 1);
      const SCENE_CHANGED = 7;
      const events = topics.get("/haptic/events").map(({ value }) => value.event);
      assert(events.some((event) => event.kind === SCENE_CHANGED));
      assert(topics.get("/foxglove/log").length === events.length);
      assert(topics.get("/haptic/stats").length > 0);
      const ticks = topics.get("/haptic/objects").map(({ value }) => Number(value.tick));
      const gaps = topics.get("/haptic/gaps") ?? [];
      if (gaps.length === 0) {
        const frames = new Map([...topics.get("/haptic/objects"), ...topics.get("/haptic/events"),
          ...topics.get("/haptic/stats")].map(({ value }) => [Number(value.sequence), value]));
        const sequences = [...frames.keys()].sort((a, b) => a - b);
        sequences.forEach((sequence, i) => assert.equal(sequence, sequences[0] + i));
      }
      assert(ticks.length > 100);
      checkAsDoctor(bytes, reader);
      assert.equal(reader.metadataIndexes[0].name, "hapticd");
    });
  }

  it("is refused where a file is", () => {
    const file = join(folder, "SIGINT.mcap");
    const size = statSync(file).size;
    const result = spawnSync(hapticctl, ["--socket", socket, "record", file, "--seconds", "0.2"]);
    assert.equal(result.status, 1);
    assert.match(result.stderr.toString(), /File exists/);
    assert.equal(statSync(file).size, size);
  });

  it("tells which frames it could not take, and goes on", async () => {
    const file = join(folder, "gaps.mcap");
    const recorder = await startRecorder(socket, file, "--json");
    recorder.kill("SIGSTOP");
    await sleep(5000); // the daemon keeps a second or so
    recorder.kill("SIGCONT");
    await sleep(2000);
    recorder.kill("SIGINT");
    assert.equal(await recorder.done, 0);
    const told = JSON.parse(recorder.output);
    assert(told.gaps > 0);
    assert(told.lost_frames > 500, recorder.output);

    const { topics } = await readIndexed(readFileSync(file));
    const lost = new Set();
    const inputs = 6; // haptic.v1.INPUTS is another subscription
    for (const { value } of topics.get("/haptic/gaps").filter((gap) => !gap.value.topic.includes(inputs))) {
      for (let i = Number(value.first_sequence); i <= Number(value.last_sequence); ++i) {
        lost.add(i);
      }
    }
    assert.equal(lost.size, told.lost_frames);
    const taken = new Set();
    for (const topic of ["objects", "events", "stats"]) {
      for (const { value } of topics.get(`/haptic/${topic}`) ?? []) {
        taken.add(Number(value.sequence));
      }
    }
    // each is either there or told to be lost
    for (let i = 1; i <= Math.max(...taken); ++i) {
      assert.notEqual(taken.has(i), lost.has(i), `frame ${i}`);
    }
    const info = JSON.parse(execFileSync(hapticctl, ["info", file, "--json"]));
    assert.equal(info.lost_frames, told.lost_frames);
  });

  it("shows its progress in one line of a terminal", () => {
    const file = join(folder, "terminal.mcap");
    const command = `'${hapticctl}' --socket '${socket}' record '${file}' --seconds 1.3`;
    const shown = execFileSync("script", ["--quiet", "--return", "--command", command, "/dev/null"]).toString();
    assert.match(shown, /\r\d+(\.\d+)? s  \d+ frames \(\d+\/s\)  .* 0 lost/);
    assert.match(shown, /terminal\.mcap: \d+ frames in .*; none is lost/);
    assert.equal(shown.trimEnd().split("\n").length, 1);
  });

  it("onto a full disk ends with a clear error", () => {
    const result = spawnSync(hapticctl, ["--socket", socket, "record", "/dev/full", "--replace"]);
    assert.equal(result.status, 1);
    assert.match(result.stderr.toString(), /\/dev\/full: cannot be written: No space left on device/);
  });

  it("is closed well when the daemon goes away, which the exit status tells", async () => {
    const other = await startDaemon("killed");
    const file = join(folder, "killed.mcap");
    const recorder = await startRecorder(other.socket, file);
    other.daemon.kill("SIGKILL");
    await other.daemon.gone;
    const UNREACHABLE = 5;
    assert.equal(await recorder.done, UNREACHABLE);
    const { topics } = await readIndexed(readFileSync(file));
    assert(topics.get("/haptic/objects").length > 0);
  });

  it("that was killed is read and recovered up to its last chunk", async () => {
    const file = join(folder, "crashed.mcap");
    const recorder = await startRecorder(socket, file);
    await sleep(1500);
    recorder.kill("SIGKILL");
    await recorder.done;
    const cut = JSON.parse(execFileSync(hapticctl, ["info", file, "--json"]));
    assert.equal(cut.whole, false);
    assert(cut.seconds > 0.5);
    execFileSync(hapticctl, ["recover", file], { stdio: "pipe" });
    const recovered = readFileSync(join(folder, "crashed.recovered.mcap"));
    const { reader } = await readIndexed(recovered);
    assert.equal(Number(reader.statistics.messageCount), cut.messages);
    checkAsDoctor(recovered, reader);
  });

  it("has the chosen topics, decimated, and tells what it holds", () => {
    const file = join(folder, "chosen.mcap");
    const recorded = spawnSync(hapticctl, ["--socket", socket, "record", file, "--seconds", "1", "--topics",
      "devices", "--decimation", "10", "--no-viewers", "--no-inputs", "--json"]);
    assert.equal(recorded.status, 0, recorded.stderr.toString());
    const info = JSON.parse(execFileSync(hapticctl, ["info", file, "--json"]));
    assert.equal(info.whole, true);
    assert.equal(info.decimation, "10");
    const rates = new Map(info.channels.map(({ topic, messages }) => [topic, messages]));
    assert.deepEqual([...rates.keys()].sort(), ["/haptic/device_list", "/haptic/devices", "/haptic/scene"]);
    assert.equal(rates.get("/haptic/devices"), JSON.parse(recorded.stdout).frames);
    assert(rates.get("/haptic/devices") <= 120);
    assert.equal(info.scenes.length, 1);
    assert.match(info.replay, /^no/);
  });

  it("is replayed to the bit, unless it was made without inputs", () => {
    const info = JSON.parse(execFileSync(hapticctl, ["info", join(folder, "SIGINT.mcap"), "--json"]));
    assert.match(info.replay, /^(yes|with gaps)/);
    const replayed = spawnSync(hapticctl, ["replay", join(folder, "SIGINT.mcap"), "--json"]);
    assert.equal(replayed.status, 0, replayed.stdout.toString() + replayed.stderr.toString());
    const found = JSON.parse(replayed.stdout);
    assert.equal(found.difference, null);
    assert(found.compared > 100);
    assert.equal(spawnSync(hapticctl, ["replay", join(folder, "chosen.mcap")]).status, 1);
  });
});

describe("hapticctl", () => {
  it("has nothing to recover of a whole file", () => {
    const result = spawnSync(hapticctl, ["recover", join(folder, "grasp.mcap")]);
    assert.equal(result.status, 2);
    assert(!existsSync(join(folder, "grasp.recovered.mcap")));
  });

  it("names a file that is no recording", () => {
    const result = spawnSync(hapticctl, ["info", join(root, "README.md")]);
    assert.equal(result.status, 1);
    assert.match(result.stderr.toString(), /README\.md: is no MCAP file/);
  });

  it("tells that a file was cut off", () => {
    const info = JSON.parse(execFileSync(hapticctl, ["info", join(folder, "cut.mcap"), "--json"]));
    assert.equal(info.whole, false);
    assert.match(info.damage, /cut off/);
  });

  it("ends a simulation whose disk is full with a clear error", () => {
    const result = spawnSync(hapticd, ["simulate", "--config", join(root, "config/grasp.txtpb"), "--duration",
      "0.1", "--record", "/dev/full"]);
    assert.equal(result.status, 1);
    assert.match(result.stderr.toString(), /\/dev\/full: cannot be written: No space left on device/);
  });
});
