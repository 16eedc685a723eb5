// Makes src/gen, the schema's messages in TypeScript, from proto/haptic/v1 by protoc.
import { spawnSync } from 'node:child_process';
import { mkdirSync, readdirSync, rmSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const page = dirname(dirname(fileURLToPath(import.meta.url)));
const proto = join(page, '../../../proto');
const out = join(page, 'src/gen');

rmSync(out, { recursive: true, force: true });
mkdirSync(out, { recursive: true });
const files = readdirSync(join(proto, 'haptic/v1')).filter((name) => name.endsWith('.proto'));
const run = spawnSync(
  'protoc',
  [
    `--plugin=protoc-gen-es=${join(page, 'node_modules/.bin/protoc-gen-es')}`,
    `-I${proto}`,
    `--es_out=${out}`,
    '--es_opt=target=ts',
    ...files.map((name) => `haptic/v1/${name}`),
  ],
  { stdio: 'inherit' },
);
if (run.error) {
  console.error(`protoc did not run (Debian: protobuf-compiler): ${run.error.message}`);
}
process.exit(run.status ?? 1);
