// Stands in for haptic-view in the tests of its page: serves the page and passes whole messages between the browser's
// WebSocket and a connection to the daemon of its own. No policy: what the daemon allows the user of this program.
import { createServer } from 'node:http';
import { connect } from 'node:net';
import { readFile } from 'node:fs/promises';
import { extname, join, normalize } from 'node:path';
import { WebSocketServer } from 'ws';

const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.svg': 'image/svg+xml', '.txt': 'text/plain' };
const HEADERS = {
  'Content-Security-Policy': "default-src 'self'",
  'X-Content-Type-Options': 'nosniff',
  'Cache-Control': 'no-store',
};

function varint(value) {
  const bytes = [];
  for (; value > 127; value = Math.floor(value / 128)) bytes.push((value % 128) | 128);
  return Buffer.from([...bytes, value]);
}

// Envelope { hello { major: 1 program: "test gateway" } }
function hello() {
  const program = Buffer.from('test gateway');
  const body = Buffer.concat([Buffer.from([0x08, 1, 0x22, program.length]), program]);
  return Buffer.concat([Buffer.from([0x0a, body.length]), body]);
}

// Envelope { hello { role: OBSERVE } }; merged into the Hello that it is appended to
const OBSERVE_ONLY = Buffer.from([0x0a, 0x02, 0x30, 0x01]);

/** Calls `take` with each whole message of a stream. */
function cutter(take) {
  let buffer = Buffer.alloc(0);
  return (chunk) => {
    buffer = buffer.length === 0 ? chunk : Buffer.concat([buffer, chunk]);
    for (;;) {
      let size = 0;
      let at = 0;
      while (at < buffer.length && at < 5 && buffer[at] > 127) size += (buffer[at] & 127) * 128 ** at++;
      if (at >= buffer.length) return;
      size += buffer[at] * 128 ** at;
      at += 1;
      if (buffer.length < at + size) return;
      take(buffer.subarray(at, at + size));
      buffer = buffer.subarray(at + size);
    }
  };
}

/** Listens on `port` of the loopback interface; 0: any. `observe`: browsers may only look. */
export async function startGateway({ page, socket, port = 0, observe = false }) {
  const server = createServer((request, response) => {
    const path = normalize(new URL(request.url, 'http://x').pathname).replace(/^(\.\.[/\\])+/, '');
    const file = join(page, path === '/' ? 'index.html' : path);
    readFile(file).then(
      (content) => response.writeHead(200, { ...HEADERS, 'Content-Type': TYPES[extname(file)] ?? 'application/octet-stream' }).end(content),
      () => response.writeHead(404, HEADERS).end(),
    );
  });
  const sockets = new WebSocketServer({ server, path: '/ws', handleProtocols: (offered) => offered.has('haptic.v1') && 'haptic.v1' });
  sockets.on('connection', (browser) => {
    const daemon = connect(socket);
    const send = (message) => daemon.write(Buffer.concat([varint(message.length), message]));
    let greeted = false;
    daemon.on('connect', () => send(hello()));
    daemon.on(
      'data',
      cutter((message) => {
        browser.send(!greeted && observe ? Buffer.concat([message, OBSERVE_ONLY]) : Buffer.from(message));
        greeted = true;
      }),
    );
    daemon.on('error', (error) => browser.close(1011, `no daemon: ${error.code}`));
    daemon.on('close', () => browser.close(1012, 'the daemon is gone'));
    browser.on('message', (message) => send(message));
    browser.on('close', () => daemon.destroy());
    browser.on('error', () => daemon.destroy());
  });
  await new Promise((resolve) => server.listen(port, '127.0.0.1', resolve));
  return {
    url: `http://127.0.0.1:${server.address().port}/`,
    close: () => {
      for (const browser of sockets.clients) browser.terminate();
      server.closeAllConnections();
      return new Promise((resolve) => server.close(resolve));
    },
  };
}
