// A daemon, the gateway and the page, for one test.
import { execFile, spawn } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { promisify } from 'node:util';
import { expect, test as base } from '@playwright/test';
import { root, startGateway } from './gateway.mjs';

const HAPTICD = process.env.HAPTICD ?? join(root, 'build/dev/daemon/hapticd');
const HAPTICCTL = process.env.HAPTICCTL ?? join(root, 'build/dev/client/cli/hapticctl');

const run = promisify(execFile);

export class Lab {
  constructor() {
    this.folder = mkdtempSync(join(tmpdir(), 'haptic-page-'));
    this.socket = join(this.folder, 'daemon.sock');
    this.recording = join(this.folder, 'demo.mcap');
  }

  /** `config`: below config/ of the tree. */
  async start(config) {
    this.daemon = spawn(HAPTICD, ['run', '--config', config.startsWith('/') ? config : join(root, 'config', config), '--socket', this.socket], { stdio: 'ignore' });
    this.ended = new Promise((resolve) => this.daemon.once('exit', resolve));
    await expect.poll(() => existsSync(this.socket), 'the daemon listens').toBe(true);
  }

  /** A config of two hands for a browser that has little of a machine: their poses may be late. */
  patientHands() {
    const config = join(this.folder, 'hands.txtpb');
    const scene = join(root, 'config/scenes/hands.scene.txtpb');
    const device = (name) => `device { name: "${name}" virtual {} }\n`;
    writeFileSync(config, `${device('first_hand')}${device('second_hand')}safety { max_sample_age: 5 }\nscene: "${scene}"\n`);
    return config;
  }

  /** A config of the tree that permits to arm whatever waits for the hands, which here are simulated. */
  armable(name) {
    const config = join(this.folder, 'armable.txtpb');
    const text = readFileSync(join(root, 'config', name), 'utf8').replaceAll(/"(paths|scenes)\//g, `"${root}/config/$1/`);
    writeFileSync(config, `${text}\nsafety { max_arm_force: 100 }\n`);
    return config;
  }

  async serve(options = {}) {
    this.gateway = await startGateway({ socket: this.socket, ...options });
    return this.gateway.url;
  }

  /** Runs hapticctl; what it prints. */
  async ctl(...words) {
    const { stdout } = await run(HAPTICCTL, words, { env: { ...process.env, HAPTICD_SOCKET: this.socket } });
    return stdout;
  }

  /** The lines of JSON that it prints. */
  async ask(...words) {
    const lines = (await this.ctl('--json', ...words)).trim().split('\n');
    return lines.map((line) => JSON.parse(line));
  }

  /** Records `seconds` of the demo, the same to the bit each time. */
  async simulate(seconds) {
    await run(HAPTICD, ['simulate', '--config', join(root, 'config/demo.txtpb'), '--duration', String(seconds), '--record', this.recording]);
    return this.recording;
  }

  async end() {
    await this.gateway?.close();
    this.daemon?.kill();
    await this.ended;
    rmSync(this.folder, { recursive: true, force: true });
  }
}

export const drawn = (page) => page.evaluate(() => globalThis.hapticView.drawn());

/** Opens the page and waits until it shows what is now. */
export async function open(page, url) {
  await page.goto(url);
  await expect.poll(async () => (await drawn(page)).moments, 'moments come in').toBeGreaterThan(3);
}

export const test = base.extend({
  lab: async ({}, use) => {
    const lab = new Lab();
    await use(lab);
    await lab.end();
  },
  /** The page, of which nothing may go wrong: no error and no warning at the console. `quiet.allow` are exceptions. */
  quiet: [
    async ({ page }, use) => {
      const heard = [];
      const quiet = { allow: [] };
      page.on('console', (message) => {
        if (['error', 'warning'].includes(message.type())) heard.push(message.text());
      });
      page.on('pageerror', (error) => heard.push(String(error)));
      await use(quiet);
      expect(heard.filter((text) => !quiet.allow.some((pattern) => pattern.test(text)))).toEqual([]);
    },
    { auto: true },
  ],
});

export { expect };
