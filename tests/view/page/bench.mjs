// What the page costs: pictures and bytes for each second, without a graphics card, for scenes of 2 000, 20 000 and
// 200 000 triangles over which two fingers of 20 HIPs move, with the pictures as fine as on a graphics card.
//
//     node bench.mjs SECONDS JSON
import { spawn } from 'node:child_process';
import { existsSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { setTimeout as sleep } from 'node:timers/promises';
import { chromium } from '@playwright/test';
import { launchOptions } from './browser.mjs';
import { root, startGateway } from './gateway.mjs';

const hapticd = process.env.HAPTICD ?? join(root, 'build/dev/daemon/hapticd');
const folder = mkdtempSync(join(tmpdir(), 'haptic-page-bench-'));
const [seconds, json] = [Number(process.argv[2] ?? 5), process.argv[3]];
const OBJECTS = 20;
const SIZE = { width: 1280, height: 800 };

/** Cylinders of s sides have 4 s - 4 triangles. */
function scene(triangles) {
  const segments = triangles / OBJECTS / 4 + 1;
  const objects = Array.from({ length: OBJECTS }, (_, i) => {
    const at = `position { x: ${(0.03 * (i % 5) - 0.06).toFixed(3)} z: ${(0.03 * Math.floor(i / 5) - 0.045).toFixed(3)} }`;
    return `object { name: "can${i}" shape { cylinder { radius: 0.01 height: 0.02 segments: ${segments} } } inside: "wood" pose { ${at} } }`;
  });
  const finger = (i) => `finger { name: "finger${i}" device: "device${i}" stiffness: 100 fingertip { radius: 0.008 cap_angle: 1 hips: 20 direction { z: -1 } } }`;
  return `name: "bench"
material { name: "wood" density: 500 rigid { static_friction: 1 kinetic_friction: 0.5 } }
${objects.join('\n')}
${finger(0)}
${finger(1)}
`;
}

function configure(triangles) {
  writeFileSync(join(folder, 'path.csv'), 'time,x,y,z\n0,-0.06,0,0.02\n1,0.06,0,0.02\n2,-0.06,0,0.02\n');
  writeFileSync(join(folder, 'bench.scene.txtpb'), scene(triangles));
  const device = (i) => `device { name: "device${i}" playback { path: "path.csv" repeat: true } }`;
  writeFileSync(join(folder, 'bench.txtpb'), `${device(0)}\n${device(1)}\nscene: "bench.scene.txtpb"\n`);
  return join(folder, 'bench.txtpb');
}

async function measure(browser, triangles) {
  const socket = join(folder, 'daemon.sock');
  const daemon = spawn(hapticd, ['run', '--config', configure(triangles), '--socket', socket], { stdio: 'ignore' });
  const ended = new Promise((resolve) => daemon.once('exit', resolve));
  while (!existsSync(socket)) await sleep(50);
  const gateway = await startGateway({ socket });
  const page = await browser.newPage({ viewport: SIZE });
  const drawn = () => page.evaluate(() => globalThis.hapticView.drawn());
  await page.goto(`${gateway.url}?quality=full`);
  const begin = performance.now();
  while ((await drawn()).moments < 10 || (await drawn()).triangles === 0) await sleep(100);
  const opened = (performance.now() - begin) / 1000;
  await sleep(1000);
  const [first, start] = [await drawn(), performance.now()];
  await sleep(1000 * seconds);
  const [last, stop] = [await drawn(), performance.now()];
  const span = (stop - start) / 1000;
  await page.close();
  await gateway.close();
  daemon.kill();
  await ended;
  rmSync(socket, { force: true });
  return {
    triangles: last.triangles,
    opened_s: Number(opened.toFixed(2)),
    pictures_per_s: Number(((last.pictures - first.pictures) / span).toFixed(1)),
    bytes_per_s: Math.round((last.received - first.received) / span),
  };
}

const browser = await chromium.launch(launchOptions);
const results = [];
try {
  for (const triangles of [2_000, 20_000, 200_000]) {
    const result = await measure(browser, triangles);
    results.push(result);
    console.log(`${result.triangles} triangles: ${result.pictures_per_s} pictures/s, ${(result.bytes_per_s / 1024).toFixed(0)} KiB/s, open after ${result.opened_s} s`);
  }
} finally {
  await browser.close();
  rmSync(folder, { recursive: true, force: true });
}
if (json) writeFileSync(json, `${JSON.stringify({ size: SIZE, renderer: 'SwiftShader', results }, undefined, 2)}\n`);
