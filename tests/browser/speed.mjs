#!/usr/bin/env node
// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// speed.mjs FILE.pmesh... [--module MODULE.wasm] [--runs N]: how fast the package's decoder makes bytes drawable in Node, on one thread: what a
// worker does with a file that is there, fed in pieces as a network gives them. CPU time, median of N runs.
import { readFileSync } from 'node:fs';
import { basename, join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { parseArgs } from 'node:util';

const dist = join(import.meta.dirname, '../../lib/wasm/npm/dist');
const { values: options, positionals: files } = parseArgs({ allowPositionals: true, options: { module: { type: 'string', default: join(dist, 'vsplit.wasm') }, runs: { type: 'string', default: '3' } } });
const { compileVsplit, VsplitStream } = await import(pathToFileURL(join(dist, 'index.js')));
const module = await compileVsplit(readFileSync(options.module));
const kPiece = 64 * 1024, kSplits = 128 * 1024;

function measure(bytes) {
    const cpu = () => { const { user, system } = process.cpuUsage(); return (user + system) / 1000; };
    const spent = { feed: 0, decode: 0, refine: 0, patch: 0 };
    let at = cpu();
    const lap = (what) => { const now = cpu(); spent[what] += now - at; at = now; };
    const stream = new VsplitStream(module);
    lap('feed');
    for (let offset = 0; offset < bytes.length; offset += kPiece) {
        stream.feed(offset, bytes.subarray(offset, offset + kPiece));
        lap('feed');
        if (!stream.info) continue;
        stream.update({ maxSplits: 0 });
        lap('decode');
        // As the worker does while blocks go on coming: a patch once there is a third more.
        const whole = offset + kPiece >= bytes.length;
        if (!whole && stream.availableTriangles < 1.3 * stream.level.triangles) continue;
        for (let more = true; more;) {
            ({ more } = stream.update({ maxSplits: kSplits, maxBlocks: 0 }));
            lap('refine');
            stream.patch();
            lap('patch');
        }
    }
    if (!stream.complete || stream.level.triangles !== stream.info.triangles) throw new Error('the file is not whole');
    return { ...spent, all: spent.feed + spent.decode + spent.refine + spent.patch, vertices: stream.info.vertices };
}

for (const file of files) {
    const bytes = readFileSync(file);
    const runs = Array.from({ length: Number(options.runs) }, () => measure(bytes)).sort((a, b) => a.all - b.all);
    const { all, vertices, ...spent } = runs[runs.length >> 1];
    console.log(`${basename(file)}: ${(vertices / all / 1000).toFixed(3)} M vertices/s; ${Object.entries(spent).map(([what, ms]) => `${what} ${ms.toFixed(0)}`).join(', ')} ms`);
}
