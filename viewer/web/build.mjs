// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// build.mjs VSPLIT_WASM OUT: the viewer as files for any static server, and for `vsplit serve`. Uses what npm has installed for
// the package in lib/wasm/npm, which is to be built first.
import { copyFileSync, mkdirSync, rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import { execFileSync } from 'node:child_process';
import { join } from 'node:path';

const here = import.meta.dirname;
const npm = join(here, '../../lib/wasm/npm');
const { build } = createRequire(join(npm, 'package.json'))('esbuild');
const [module, out] = process.argv.slice(2);
execFileSync(process.execPath, [join(npm, 'node_modules/typescript/bin/tsc'), '-p', here], { stdio: 'inherit' });
rmSync(out, { recursive: true, force: true });
mkdirSync(out, { recursive: true });
await build({
    entryPoints: { viewer: join(here, 'src/viewer.ts'), previews: join(here, 'src/previews.ts'), worker: join(npm, 'src/worker.ts') },
    bundle: true, splitting: true, minify: true, format: 'esm', target: 'es2022', outdir: out, nodePaths: [join(npm, 'node_modules')],
    chunkNames: 'shared-[hash]', legalComments: 'none', banner: { js: '/* three.js: MIT, (c) the three.js authors. vsplit: MIT, (c) the vsplit authors. */' }, logLevel: 'warning',
});
for (const file of ['index.html', 'style.css']) copyFileSync(join(here, file), join(out, file));
copyFileSync(module, join(out, 'vsplit.wasm'));
