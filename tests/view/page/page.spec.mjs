// The page in a browser, against a daemon that runs.
import { readFile } from 'node:fs/promises';
import { drawn, expect, open, test } from './lab.mjs';

const armed = async (lab) => (await lab.ask('status'))[0].armed;
/** A tick that was late just then, or a force near its limit, refuses it: then once more. */
const arm = (lab, action) =>
  expect(async () => {
    if (!(await armed(lab))) await action();
    await expect.poll(() => armed(lab), { timeout: 5_000 }).toBe(true);
  }).toPass();
const project = (page, at) => page.evaluate(([x, y, z]) => globalThis.hapticView.project(x, y, z), at);
const fingers = (page) => page.evaluate(() => globalThis.hapticView.fingers());

async function drag(page, from, to) {
  const [a, b] = [await project(page, from), await project(page, to)];
  await page.mouse.move(a.x, a.y);
  await page.mouse.down();
  await page.mouse.move(b.x, b.y, { steps: 12 });
  await page.mouse.up();
}

test('an object moves on the page when it moves in the daemon', async ({ lab, page }) => {
  await lab.start('hands.txtpb');
  await open(page, await lab.serve());
  await lab.ctl('object', 'move', 'box', '--at', '0.01', '0.02', '-0.03');
  await expect.poll(async () => (await drawn(page)).objects.box.map((x) => Number(x.toFixed(6)))).toEqual([0.01, 0.02, -0.03]);
});

test('a force arrow is as long as the force that the daemon tells times the scale', async ({ lab, page }) => {
  await lab.start(lab.armable('grasp.txtpb')); // in the end two hands hold a box still
  await lab.ctl('arm');
  await open(page, await lab.serve());
  const told = async () => (await lab.ask('devices')).map(({ wrench: { force } }) => Math.hypot(force.x, force.y, force.z));
  let before = [];
  await expect
    .poll(async () => {
      const [last, now] = [before, await told()];
      before = now;
      return now.every((force, i) => force > 0.1 && Math.abs(force - last[i]) < 1e-4);
    }, 'both fingers press, as before')
    .toBe(true);
  // 0.005 N: what the force may still wander
  await expect
    .poll(async () => {
      const { arrows, arrowScale } = await drawn(page);
      return arrows.devices.map((length, i) => Math.abs(length / arrowScale - before[i]) < 5e-3);
    })
    .toEqual([true, true]);
  await page.locator('#scene').focus();
  await page.keyboard.press(' ');
  const { arrows, arrowScale, forces } = await drawn(page);
  expect(arrows.hips.length).toBeGreaterThan(10);
  arrows.hips.forEach((length, i) => expect(length).toBeCloseTo(forces.hips[i] * arrowScale, 6));
});

test('arm, disarm and stop do in the daemon what they say', async ({ lab, page }) => {
  await lab.start('demo.txtpb');
  await open(page, await lab.serve());
  await arm(lab, () => page.click('#arm', { timeout: 5_000 }));
  await expect(page.locator('#armed')).toHaveText('armed');
  await page.click('#disarm');
  await expect.poll(() => armed(lab)).toBe(false);
  await arm(lab, () => page.keyboard.press('a'));
  await page.click('#stop');
  await expect.poll(() => armed(lab)).toBe(false);
  await expect(page.locator('.banner.fault')).toContainText('Emergency stop');
  await expect.poll(async () => (await lab.ask('devices')).every(({ wrench: { force } }) => force.z === 0)).toBe(true);
});

test('a browser that may only look can neither arm nor stop', async ({ lab, page }) => {
  await lab.start('demo.txtpb');
  await open(page, await lab.serve({ observe: true }));
  for (const button of ['#arm', '#disarm', '#stop']) await expect(page.locator(button)).toBeDisabled();
  await page.keyboard.press('a');
  await page.waitForTimeout(500);
  expect(await armed(lab)).toBe(false);
});

test('a fault shows with what to do, and is cleared', async ({ lab, page, quiet }) => {
  quiet.allow.push(/WebSocket/);
  await lab.start(lab.patientHands());
  const url = await lab.serve();
  await open(page, url);
  await page.locator('button.hand').first().click();
  await expect.poll(async () => Object.keys(await fingers(page))).toEqual(['first']);
  await arm(lab, () => page.click('#arm', { timeout: 5_000 }));
  // nobody tells where the hand is any more
  await lab.gateway.close();
  await expect.poll(() => armed(lab), 'the fault ends force').toBe(false);
  await lab.serve({ port: Number(new URL(url).port) });
  const banner = page.locator('.banner.fault');
  await expect(banner).toContainText(/No new sample came from the device|The device is gone/);
  await expect(banner).toContainText('device first_hand');
  await expect(banner).toContainText('clear the fault');
  await banner.getByRole('button', { name: 'Clear fault' }).click();
  await expect(banner).toHaveCount(0);
  expect((await lab.ask('status'))[0].fault ?? []).toEqual([]);
});

test('a connection that is lost is told, and comes back without a reload', async ({ lab, page, quiet }) => {
  quiet.allow.push(/WebSocket/);
  await lab.start('demo.txtpb');
  const url = await lab.serve();
  await open(page, url);
  await page.evaluate(() => {
    globalThis.notReloaded = true;
  });
  await lab.gateway.close();
  await expect(page.locator('.banner.lost')).toContainText('Connection lost');
  await expect(page.locator('#connection')).toHaveText(/lost|connecting/);
  await lab.serve({ port: Number(new URL(url).port) });
  await expect(page.locator('.banner.lost')).toHaveCount(0);
  await expect(page.locator('#connection')).toHaveText('live');
  const before = (await drawn(page)).tick ?? 0;
  await expect.poll(async () => (await drawn(page)).tick ?? 0).toBeGreaterThan(before);
  expect(await page.evaluate(() => globalThis.notReloaded)).toBe(true);
});

test('two hands that the pointer places pinch the box and lift it', async ({ lab, page }) => {
  await lab.start(lab.patientHands());
  await open(page, await lab.serve());
  await page.locator('#scene').focus();
  await page.keyboard.press('1'); // from the front: x is right, y is up
  for (const i of [0, 1]) await page.locator('button.hand').nth(i).click();
  await expect.poll(async () => Object.keys(await fingers(page)).sort()).toEqual(['first', 'second']);
  await expect.poll(async () => (await fingers(page)).second?.[0], 'it stands beside').toBeGreaterThan(0.035);
  await arm(lab, () => page.click('#arm', { timeout: 5_000 }));
  // the box is 50 mm wide, and the fingers are 6 mm thick: each presses 5 mm into its side
  for (const [name, x] of [['first', -0.026], ['second', 0.026]]) {
    await drag(page, (await fingers(page))[name], [x, 0.03, 0]);
    await expect.poll(async () => Math.abs((await fingers(page))[name][0] - x), `${name} arrives`).toBeLessThan(0.002);
  }
  await expect.poll(async () => (await drawn(page)).forces.devices.length, 'both feel the box').toBe(2);
  expect((await drawn(page)).objects.box[1]).toBeCloseTo(0.03, 2);
  await page.keyboard.down('Shift');
  const [x, y, z] = (await fingers(page)).first;
  await drag(page, [x, y, z], [x, y + 0.025, z]);
  await page.keyboard.up('Shift');
  await expect.poll(async () => (await drawn(page)).objects.box[1], 'the box is lifted').toBeGreaterThan(0.048);
  expect(await page.locator('.banner').allTextContents()).toEqual([]);
});

test('the picture stands still, steps and goes on with what is now', async ({ lab, page }) => {
  await lab.start('demo.txtpb');
  await open(page, await lab.serve());
  await page.locator('#scene').focus();
  await page.keyboard.press(' ');
  await expect(page.locator('#shown-time')).not.toContainText('live');
  const { tick } = await drawn(page);
  await page.waitForTimeout(400);
  expect((await drawn(page)).tick).toBe(tick);
  await page.keyboard.press('ArrowLeft');
  await expect.poll(async () => (await drawn(page)).tick).toBeLessThan(tick);
  await page.keyboard.press(' ');
  await expect.poll(async () => (await drawn(page)).tick).toBeGreaterThan(tick);
});

test('what is clicked tells its numbers', async ({ lab, page }) => {
  await lab.start('hands.txtpb');
  await open(page, await lab.serve());
  await lab.ctl('object', 'move', 'box', '--at', '0.01', '0.02', '-0.03');
  await expect.poll(async () => (await drawn(page)).objects.box[2]).toBeCloseTo(-0.03, 6);
  const at = await project(page, [0.01, 0.02, -0.03]);
  await page.mouse.click(at.x, at.y);
  await expect(page.locator('#selected')).toHaveValue('object/0');
  await expect(page.locator('.rows')).toContainText('10.0  20.0  -30.0 mm');
  await expect(page.locator('.rows')).toContainText('22.5 g');
});

async function dropRecording(page, file) {
  const content = (await readFile(file)).toString('base64');
  await page.evaluate((base64) => {
    const file = new File([Uint8Array.from(atob(base64), (c) => c.charCodeAt(0))], 'demo.mcap');
    const transfer = new DataTransfer();
    transfer.items.add(file);
    globalThis.dispatchEvent(new DragEvent('drop', { dataTransfer: transfer, bubbles: true, cancelable: true }));
  }, content);
  await expect(page.locator('#connection')).toHaveText('demo.mcap');
}

async function showAt(page, share) {
  await page.locator('#scrub').evaluate((slider, value) => {
    slider.value = String(value);
    slider.dispatchEvent(new Event('input'));
  }, share);
}

test('a recording opens where it is dropped, and shows the moment that is asked for', async ({ lab, page }) => {
  await lab.start('hands.txtpb');
  const recording = await lab.simulate(4);
  await open(page, await lab.serve());
  await dropRecording(page, recording);
  await showAt(page, 0.9);
  // 4 s of 60 moments and a little
  expect((await drawn(page)).moments).toBeGreaterThan(230);
  await expect.poll(async () => (await drawn(page)).tick).toBeGreaterThan(3500);
  // the fingers hold the box, one on each side
  await expect.poll(async () => (await drawn(page)).arrows.devices.length).toBe(2);
  await page.click('#live');
  await expect(page.locator('#connection')).toHaveText('live');
});

test('a file that is no recording is refused in words', async ({ lab, page }) => {
  await lab.start('hands.txtpb');
  await open(page, await lab.serve());
  await page.setInputFiles('#file', { name: 'x.mcap', mimeType: 'application/octet-stream', buffer: Buffer.from('no recording') });
  await expect(page.locator('.note.wrong')).toContainText('x.mcap is no whole recording');
  await expect(page.locator('#connection')).toHaveText('live');
});

for (const [name, size, theme] of [
  ['laptop-light', { width: 1280, height: 800 }, 'light'],
  ['laptop-dark', { width: 1280, height: 800 }, 'dark'],
  ['phone', { width: 390, height: 844 }, 'light'],
]) {
  test(`the page looks as it did: ${name}`, async ({ lab, page }) => {
    await page.setViewportSize(size);
    await page.emulateMedia({ colorScheme: theme });
    await lab.start('hands.txtpb');
    const recording = await lab.simulate(4);
    await open(page, `${await lab.serve()}?quality=full`);
    await dropRecording(page, recording);
    await showAt(page, 0.9);
    await page.locator('#selected').selectOption('finger/0');
    await expect.poll(async () => (await drawn(page)).arrows.devices.length).toBe(2);
    const { width } = size;
    expect(await page.evaluate(() => document.documentElement.scrollWidth), 'nothing is cut off at the side').toBeLessThanOrEqual(width);
    await page.waitForTimeout(1000);
    await expect(page).toHaveScreenshot(`${name}.png`);
  });
}
