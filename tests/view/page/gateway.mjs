// haptic-view itself, in the background.
import { spawn } from 'node:child_process';
import { dirname, join } from 'node:path';
import { createInterface } from 'node:readline';
import { fileURLToPath } from 'node:url';

export const root = join(dirname(fileURLToPath(import.meta.url)), '../../..');
const HAPTIC_VIEW = process.env.HAPTIC_VIEW ?? join(root, 'build/dev/client/view/haptic-view');
const PAGE = process.env.HAPTIC_PAGE ?? join(root, 'client/view/page/dist');

/** Listens on `port` of the loopback interface; 0: any. `observe`: browsers may only look. */
export async function startGateway({ socket, port = 0, observe = false }) {
  const words = ['--server', socket, '--listen', `127.0.0.1:${port}`, '--page', PAGE, ...(observe ? [] : ['--drive'])];
  const program = spawn(HAPTIC_VIEW, words, { stdio: ['ignore', 'ignore', 'pipe'] });
  const ended = new Promise((resolve) => program.once('close', resolve));
  const told = [];
  const url = await new Promise((resolve, reject) => {
    createInterface({ input: program.stderr }).on('line', (line) => {
      told.push(line);
      const serves = /serves (http:\S+)/.exec(line);
      if (serves) resolve(new URL('/', serves[1]).href);
    });
    program.once('error', reject);
    ended.then((code) => reject(new Error(`haptic-view ended with ${code}: ${told.join('\n')}`)));
  });
  return {
    url,
    close: () => {
      program.kill();
      return ended;
    },
  };
}
