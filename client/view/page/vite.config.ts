import { existsSync, readFileSync, readdirSync } from 'node:fs';
import { join } from 'node:path';
import { defineConfig, type Plugin } from 'vite';

/** Puts the licences of all packages of which code is in the bundle into it, as licences.txt. */
function licences(): Plugin {
  return {
    name: 'licences',
    generateBundle(_options, bundle) {
      const packages = new Set<string>();
      for (const chunk of Object.values(bundle)) {
        for (const id of chunk.type === 'chunk' ? Object.keys(chunk.modules) : []) {
          const found = /^.*\/node_modules\/(?:@[^/]+\/)?[^/]+/.exec(id.replaceAll('\\', '/').replace('\0', ''));
          if (found) packages.add(found[0]);
        }
      }
      const texts = [...packages].sort().map((folder) => {
        const about = JSON.parse(readFileSync(join(folder, 'package.json'), 'utf8')) as Record<string, string>;
        const file = readdirSync(folder).find((name) => /^licen[cs]e/i.test(name));
        const text = file === undefined ? `Licence: ${about.license}` : readFileSync(join(folder, file), 'utf8');
        return `${about.name} ${about.version} (${about.license})\n\n${text.trim()}\n`;
      });
      const own = join(__dirname, '../../../LICENSE');
      const head = existsSync(own) ? `hapticd (Apache-2.0)\n\n${readFileSync(own, 'utf8').trim()}\n` : '';
      this.emitFile({
        type: 'asset',
        fileName: 'licences.txt',
        source: [head, ...texts].join(`\n${'-'.repeat(100)}\n\n`),
      });
    },
  };
}

const gateway = process.env.HAPTIC_VIEW ?? 'http://127.0.0.1:8765';

export default defineConfig({
  base: './',
  plugins: [licences()],
  build: { target: 'es2022', assetsInlineLimit: 0, chunkSizeWarningLimit: 1200 },
  worker: { format: 'es' },
  server: { proxy: { '/ws': { target: gateway, ws: true } } },
});
