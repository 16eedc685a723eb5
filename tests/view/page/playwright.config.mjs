// A browser that draws without a graphics card: one test at a time, with patience.
import { defineConfig } from '@playwright/test';
import { launchOptions } from './browser.mjs';

export default defineConfig({
  testDir: '.',
  testMatch: '*.spec.mjs',
  workers: 1,
  timeout: 300_000,
  outputDir: process.env.HAPTIC_TEST_OUTPUT ?? 'test-results',
  snapshotPathTemplate: '{testDir}/screenshots/{arg}{ext}',
  reporter: [['list']],
  expect: {
    timeout: 60_000,
    // fonts and rasterisers differ a little from machine to machine
    toHaveScreenshot: { maxDiffPixelRatio: 0.03, threshold: 0.25, animations: 'disabled', timeout: 60_000 },
  },
  use: {
    viewport: { width: 900, height: 640 },
    colorScheme: 'light',
    screenshot: 'only-on-failure',
    launchOptions,
  },
});
