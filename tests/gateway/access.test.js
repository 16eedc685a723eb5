// Who gets what from haptic-view: files, WebSockets, with and without tokens and TLS.

import assert from "node:assert/strict";
import { execFileSync, spawnSync } from "node:child_process";
import { mkdirSync, readFileSync, symlinkSync, writeFileSync } from "node:fs";
import { request as httpRequest } from "node:http";
import { request as httpsRequest } from "node:https";
import { connect, createServer } from "node:net";
import { after, before, describe, it } from "node:test";

import { HAPTICCTL, HAPTICD, HAPTIC_VIEW, Page, Role, eventually, knock, start, startDaemon, startGateway,
  temporaryFolder } from "./support.js";

const WATCHER = "a-token-of-a-watcher";
const DRIVER = "a-token-of-the-driver";

let folder;
let daemon;
let server; // the options that name the daemon

before(async () => {
  folder = temporaryFolder();
  writeFileSync(folder.file("watcher"), `${WATCHER}\n`);
  writeFileSync(folder.file("driver"), `${DRIVER}\n`);
  writeFileSync(folder.file("secret"), "not for browsers");
  mkdirSync(folder.file("page/assets"), { recursive: true });
  writeFileSync(folder.file("page/index.html"), "<!doctype html><title>page</title>");
  writeFileSync(folder.file("page/assets/a-1.js"), "export {};\n");
  symlinkSync(folder.file("secret"), folder.file("page/link.txt"));
  daemon = await startDaemon(folder.file("hapticd.sock"), "config/devices/virtual.txtpb");
  server = ["--server", folder.file("hapticd.sock")];
});
after(async () => {
  await daemon.stop();
  folder.remove();
});

/** The answer to one request: status, headers and body. */
function fetchFrom(url, options = {}) {
  return new Promise((resolve, reject) => {
    const send = url.startsWith("https") ? httpsRequest : httpRequest;
    const request = send(url, options, (response) => {
      let body = "";
      response.on("data", (text) => {
        body += text;
      });
      response.on("end", () => resolve({ status: response.statusCode, headers: response.headers, body }));
    });
    request.on("error", reject);
    request.end();
  });
}

/** A port that nobody listened at just now. */
function freePort() {
  return new Promise((resolve) => {
    const listener = createServer().listen(0, "127.0.0.1", () => {
      const { port } = listener.address();
      listener.close(() => resolve(port));
    });
  });
}

/** What is answered to these bytes until the connection ends. */
function say(url, bytes) {
  return new Promise((resolve, reject) => {
    const { hostname, port } = new URL(url);
    const socket = connect(Number(port), hostname, () => socket.write(bytes));
    let answer = "";
    socket.on("data", (text) => {
      answer += text;
    });
    socket.on("close", () => resolve(answer));
    socket.on("error", reject);
  });
}

describe("files", () => {
  let gateway;
  before(async () => {
    gateway = await startGateway(...server, "--page", folder.file("page"));
  });
  after(() => gateway.stop());

  it("are those of the page, with their types", async () => {
    const index = await fetchFrom(gateway.url);
    assert.equal(index.status, 200);
    assert.equal(index.body, readFileSync(folder.file("page/index.html"), "utf8"));
    assert.equal(index.headers["content-type"], "text/html; charset=utf-8");
    assert.equal(index.headers["cache-control"], "no-cache");
    const script = await fetchFrom(`${gateway.url}assets/a-1.js`);
    assert.equal(script.headers["content-type"], "text/javascript; charset=utf-8");
    assert.match(script.headers["cache-control"], /immutable/);
  });

  it("come with headers that leave a browser no choice", async () => {
    for (const path of ["", "none"]) {
      const { headers } = await fetchFrom(gateway.url + path);
      assert.match(headers["content-security-policy"], /default-src 'self'/);
      assert.match(headers["content-security-policy"], /frame-ancestors 'none'/);
      assert.equal(headers["x-content-type-options"], "nosniff");
      assert.equal(headers["x-frame-options"], "DENY");
      assert.equal(headers["referrer-policy"], "no-referrer");
    }
  });

  it("have a head alone, too", async () => {
    const { status, headers, body } = await fetchFrom(gateway.url, { method: "HEAD" });
    assert.equal(status, 200);
    assert.equal(Number(headers["content-length"]), readFileSync(folder.file("page/index.html")).length);
    assert.equal(body, "");
  });

  it("are read and nothing else", async () => {
    for (const method of ["POST", "PUT", "DELETE"]) {
      assert.equal((await fetchFrom(gateway.url, { method })).status, 405, method);
    }
    assert.equal((await fetchFrom(`${gateway.url}none.html`)).status, 404);
    assert.equal((await fetchFrom(`${gateway.url}ws`)).status, 426);
  });

  it("are never those beside the page", async () => {
    for (const target of ["/../secret", "/%2e%2e/secret", "/assets/../../secret", "//secret", "/..%2fsecret",
      "/link.txt", "/.hidden", folder.file("secret")]) {
      const answer = await say(gateway.url, `GET ${target} HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n`);
      assert.match(answer, /^HTTP\/1.1 40[04] /, target);
      assert(!answer.includes("not for browsers"));
    }
  });

  it("are for nobody who calls this server by a strange name", async () => {
    const headers = { Host: "rebound.example" };
    assert.equal((await fetchFrom(gateway.url, { headers })).status, 421);
    assert.match(await say(gateway.url, "GET / HTTP/1.1\r\n\r\n"), /^HTTP\/1.1 400 /);
    assert.match(await say(gateway.url, "GET / HTTP/1.1\r\nHost: a\r\nHost: localhost\r\n\r\n"), /^HTTP\/1.1 400 /);
  });

  it("are for nobody who speaks no HTTP", async () => {
    assert.match(await say(gateway.url, "nonsense\r\n\r\n"), /^HTTP\/1.1 400 /);
    const longest = "x".repeat(20 * 1024);
    assert.match(await say(gateway.url, `GET / HTTP/1.1\r\nHost: localhost\r\nX: ${longest}\r\n\r\n`),
      /^HTTP\/1.1 400 /);
  });

  it("do not wait for who says nothing", async () => {
    const begin = Date.now();
    assert.equal(await say(gateway.url, "GET / HT"), "");
    assert(Date.now() - begin > 5_000);
  });
});

describe("a gateway without a page", () => {
  it("says so and serves viewers all the same", async () => {
    const gateway = await startGateway(...server);
    await eventually(() => /no page/.test(gateway.errors));
    const { status, body } = await fetchFrom(gateway.url);
    assert.equal(status, 404);
    assert.match(body, /not installed/);
    assert.equal(await knock(gateway.socketUrl, ["foxglove.websocket.v1"]), 101);
    await gateway.stop();
  });
});

describe("a WebSocket", () => {
  let gateway;
  before(async () => {
    gateway = await startGateway(...server, "--clients", "2", "--allow-origin", "https://app.example",
      "--allow-host", "lab.example");
  });
  after(() => gateway.stop());
  const at = (path) => gateway.socketUrl + path;

  it("is for pages of ours, and of whom is allowed", async () => {
    const own = gateway.url.slice(0, -1);
    assert.equal(await knock(at("ws"), ["haptic.v1"], { origin: own }), 101);
    assert.equal(await knock(at("ws"), ["haptic.v1"], { origin: "https://app.example" }), 101);
    assert.equal(await knock(at("ws"), ["haptic.v1"], { origin: "https://evil.example" }), 403);
    assert.equal(await knock(at("ws"), ["haptic.v1"], { origin: "null" }), 403);
  });

  it("is not had by a strange name", async () => {
    const named = (host) => ({ headers: { Host: host }, origin: `http://${host}` });
    assert.equal(await knock(at("ws"), ["haptic.v1"], named("rebound.example")), 421);
    assert.equal(await knock(at("ws"), ["haptic.v1"], named("lab.example")), 101);
  });

  it("is not had without a subprotocol that is known, nor elsewhere", async () => {
    assert.equal(await knock(at("ws"), []), 400);
    assert.equal(await knock(at("ws"), ["haptic.v9"]), 400);
    assert.equal(await knock(at("elsewhere"), ["haptic.v1"]), 404);
    assert.equal(await knock(at(""), ["foxglove.websocket.v1"]), 101);
  });

  it("is not had while as many as may be are open", async () => {
    const pages = [await Page.open(gateway), await Page.open(gateway)];
    assert.equal(await knock(at("ws"), ["haptic.v1"]), 503);
    await pages[0].close();
    pages[0] = await eventually(() => Page.open(gateway).catch(() => undefined));
    await Promise.all(pages.map((page) => page.close()));
  });
});

describe("tokens", () => {
  it("are needed where they are set, and tell what one may do", async () => {
    const gateway = await startGateway(...server, "--token-file", folder.file("watcher"), "--drive-token-file",
      folder.file("driver"));
    const url = `${gateway.socketUrl}ws`;
    assert.equal(await knock(url, ["haptic.v1"]), 401);
    assert.equal(await knock(`${url}?token=`, ["haptic.v1"]), 401);
    assert.equal(await knock(`${url}?token=a-token-of-nobody`, ["haptic.v1"]), 401);
    assert.equal(await knock(gateway.socketUrl, ["foxglove.websocket.v1"]), 401);
    assert.equal(await knock(`${gateway.socketUrl}?token=${WATCHER}`, ["foxglove.websocket.v1"]), 101);
    const watcher = await Page.open(gateway, `?token=${WATCHER}`);
    assert.equal(watcher.hello.role, Role.OBSERVE);
    const driver = await Page.open(gateway, `?token=${DRIVER}`);
    assert(driver.hello.role >= Role.DRIVE);
    await Promise.all([watcher.close(), driver.close()]);
    await gateway.stop();
    assert(!gateway.errors.includes(WATCHER) && !gateway.errors.includes(DRIVER), "a log with secrets");
  });

  it("are not needed to drive where everybody may", async () => {
    const gateway = await startGateway(...server, "--drive");
    const page = await Page.open(gateway);
    assert(page.hello.role >= Role.DRIVE);
    await page.close();
    assert.match(gateway.errors, /everybody .* may drive/);
    await gateway.stop();
  });
});

describe("TLS", () => {
  let gateway;
  let ca;
  before(async () => {
    const lab = folder.file("lab");
    execFileSync(HAPTICCTL, ["certificates", lab, "--server-name", "localhost", "--server-name", "127.0.0.1"],
      { stdio: "pipe" });
    ca = readFileSync(`${lab}/authority.crt`);
    const run = start(HAPTIC_VIEW, [...server, "--listen", "0.0.0.0:0", "--certificate", `${lab}/server.crt`, "--key",
      `${lab}/server.key`, "--token-file", folder.file("watcher"), "--page", folder.file("page")]);
    const [, port] = await eventually(() => /serves https:\/\/0\.0\.0\.0:(\d+)\//.exec(run.errors), "haptic-view");
    gateway = Object.assign(run, { url: `https://localhost:${port}/`, socketUrl: `wss://localhost:${port}/`, port });
  });
  after(() => gateway.stop());

  it("is what a gateway beyond its machine speaks", async () => {
    assert.equal((await fetchFrom(gateway.url, { ca })).status, 200);
    assert.equal(await knock(`${gateway.socketUrl}ws`, ["haptic.v1"], { ca }), 401);
    const page = await Page.open(gateway, `?token=${WATCHER}`, { ca, origin: `https://localhost:${gateway.port}` });
    await page.get({ getStatus: {} });
    await page.get({ subscribe: { topic: [1, 2, 3] } });
    await eventually(() => page.frames.length > 10, "frames");
    await page.close();
  });

  it("knows pages of ours by https alone", async () => {
    assert.equal(await knock(`${gateway.socketUrl}ws?token=${WATCHER}`, ["haptic.v1"],
      { ca, origin: `http://localhost:${gateway.port}` }), 403);
  });

  it("is not had without it", async () => {
    await assert.rejects(fetchFrom(`http://localhost:${gateway.port}/`));
  });
});

describe("a daemon elsewhere", () => {
  const certificatesOf = (lab, client) => ["--daemon-certificate", `${lab}/${client}.crt`, "--daemon-key",
    `${lab}/${client}.key`, "--daemon-authority", `${lab}/authority.crt`];
  let port;
  let remote;
  let lab;
  let other;

  before(async () => {
    [lab, other] = ["daemons", "others"].map((name) => {
      execFileSync(HAPTICCTL, ["certificates", folder.file(name), "--server-name", "127.0.0.1", "--client", "view"],
        { stdio: "pipe" });
      return folder.file(name);
    });
    port = await freePort();
    writeFileSync(folder.file("remote.txtpb"), `
      listen { tcp { address: "127.0.0.1" port: ${port}
        tls { certificate: "${lab}/server.crt" key: "${lab}/server.key" authority: "${lab}/authority.crt" }
        allow { name: "view" role: OBSERVE } } }`);
    remote = start(HAPTICD, ["run", "--config", folder.file("remote.txtpb")]);
    await eventually(() => spawnSync(HAPTICCTL, ["--server", `127.0.0.1:${port}`, "--certificate", `${lab}/view.crt`,
      "--key", `${lab}/view.key`, "--authority", `${lab}/authority.crt`, "status"]).status === 0, "the daemon");
  });
  after(() => remote.stop());

  it("is reached by a gateway that it knows", async () => {
    const gateway = await startGateway("--server", `127.0.0.1:${port}`, "--drive", ...certificatesOf(lab, "view"));
    const page = await Page.open(gateway);
    assert.equal(page.hello.role, Role.OBSERVE); // that of the gateway
    await page.get({ getStatus: {} });
    await page.close();
    await gateway.stop();
  });

  it("is not believed without a certificate of the authority that is believed", async () => {
    const gateway = await startGateway("--server", `127.0.0.1:${port}`, ...certificatesOf(other, "view"));
    const { code, reason } = await new Page(`${gateway.socketUrl}ws`).closed;
    const TRY_AGAIN_LATER = 1013;
    assert.equal(code, TRY_AGAIN_LATER);
    assert.match(reason, /cannot trust it/);
    await gateway.stop();
  });

  it("is not reached without TLS", async () => {
    const gateway = await startGateway("--server", `127.0.0.1:${port}`);
    assert.match((await new Page(`${gateway.socketUrl}ws`).closed).reason, /closed the connection/);
    await gateway.stop();
  });

  it("is none where nobody listens", async () => {
    const gateway = await startGateway("--server", `127.0.0.1:${await freePort()}`);
    assert.match((await new Page(`${gateway.socketUrl}ws`).closed).reason, /cannot reach the daemon.*refused/);
    await gateway.stop();
  });

  it("is not asked for with a certificate that is none", () => {
    const { status, stderr } = spawnSync(HAPTIC_VIEW, ["--server", `127.0.0.1:${port}`, "--listen", "127.0.0.1:0",
      "--daemon-certificate", `${lab}/view.crt`, "--daemon-key", folder.file("watcher"), "--daemon-authority",
      `${lab}/authority.crt`], { timeout: 20_000 });
    assert.equal(status, 1);
    assert.match(stderr.toString(), /watcher" as the key for the daemon/);
  });
});

describe("haptic-view", () => {
  const runOnce = (...args) => spawnSync(HAPTIC_VIEW, args, { timeout: 20_000 });
  const USAGE = 64;

  it("does not go beyond its machine without TLS and a token", () => {
    const { status, stderr } = runOnce("--listen", "0.0.0.0:0");
    assert.equal(status, USAGE);
    assert.match(stderr.toString(), /beyond this machine/);
  });

  it("tells what is wrong with a token's file", () => {
    writeFileSync(folder.file("short"), "secret\n");
    const { status, stderr } = runOnce("--token-file", folder.file("short"));
    assert.equal(status, 1);
    assert.match(stderr.toString(), /short: a token has 16 to 256 characters/);
  });

  it("reads its options from a file", async () => {
    writeFileSync(folder.file("view.conf"), `token-file = "${folder.file("watcher")}"\nallow-host = ["lab.example"]\n`);
    const gateway = await startGateway(...server, "--config", folder.file("view.conf"));
    const named = { headers: { Host: "lab.example" } };
    assert.equal(await knock(`${gateway.socketUrl}ws?token=${WATCHER}`, ["haptic.v1"], named), 101);
    assert.equal(await knock(`${gateway.socketUrl}ws`, ["haptic.v1"], named), 401);
    await gateway.stop();
    writeFileSync(folder.file("wrong.conf"), "no-such = 1\n");
    assert.equal(runOnce("--config", folder.file("wrong.conf")).status, USAGE);
  });

  it("tells why it cannot listen", async () => {
    const gateway = await startGateway(...server);
    const { status, stderr } = runOnce("--listen", new URL(gateway.url).host);
    assert.equal(status, 1);
    assert.match(stderr.toString(), /cannot listen at 127\.0\.0\.1:\d+: Address already in use/);
    await gateway.stop();
  });

  it("says goodbye to everybody and ends well", async () => {
    for (const signal of ["SIGTERM", "SIGINT"]) {
      const gateway = await startGateway(...server);
      const page = await Page.open(gateway);
      const GOING_AWAY = 1001;
      assert.equal(await gateway.stop(signal), 0);
      assert.equal((await page.closed).code, GOING_AWAY);
    }
  });

  it("ends in time though a page does not read", async () => {
    const gateway = await startGateway(...server);
    const page = await Page.open(gateway);
    page.socket._socket.pause();
    const begin = Date.now();
    assert.equal(await gateway.stop(), 0);
    assert(Date.now() - begin < 10_000);
    page.socket.terminate();
  });
});
