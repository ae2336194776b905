// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// build.mjs VSPLIT_WASM: dist/ of the package, which `npm pack` takes.
import { execFileSync } from 'node:child_process';
import { copyFileSync, readFileSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { gzipSync } from 'node:zlib';

const here = import.meta.dirname;
const module = process.argv[2];
rmSync(join(here, 'dist'), { recursive: true, force: true });
execFileSync(process.execPath, [join(here, 'node_modules/typescript/bin/tsc'), '-p', here], { stdio: 'inherit' });
copyFileSync(module, join(here, 'dist/vsplit.wasm'));
copyFileSync(join(here, '../../../LICENSES/MIT.txt'), join(here, 'LICENSE'));
console.log(`vsplit.wasm: ${gzipSync(readFileSync(module), { level: 9 }).length} bytes gzipped`);
