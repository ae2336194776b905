#!/usr/bin/env node
// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// validate.mjs [--strict] FILE...: the Khronos glTF validator over each file, every message printed. Exits 1 if any file has an error or a
// warning (or, with --strict, a hint or an information other than those below), 2 if a file cannot be read.
import { readFile } from 'node:fs/promises';
import { createRequire } from 'node:module';
import { dirname, join, normalize } from 'node:path';

const validator = createRequire(import.meta.url)('gltf-validator');
const severities = ['error', 'warning', 'information', 'hint'];
// The validator does not know MSFT_lod: it says so, and takes the nodes that only MSFT_lod names for unused.
const expected = new Set(['UNSUPPORTED_EXTENSION', 'UNUSED_OBJECT']);

const args = process.argv.slice(2);
const strict = args[0] === '--strict';
const files = strict ? args.slice(1) : args;
if (files.length === 0) {
    console.error('usage: validate.mjs [--strict] FILE...');
    process.exit(2);
}
let status = 0;
for (const file of files) {
    try {
        const report = await validator.validateBytes(new Uint8Array(await readFile(file)), {
            uri: file,
            maxIssues: 0,
            externalResourceFunction: async (uri) =>
                new Uint8Array(await readFile(join(dirname(file), normalize(decodeURIComponent(uri))))),
        });
        const { numErrors, numWarnings, numInfos, numHints, messages } = report.issues;
        console.log(`${file}: ${numErrors} errors, ${numWarnings} warnings, ${numInfos} infos, ${numHints} hints`);
        for (const m of messages) console.log(`  ${severities[m.severity]} ${m.code} ${m.pointer ?? m.offset ?? ''}: ${m.message}`);
        const surprise = messages.some((m) => m.severity >= 2 && !(m.severity === 2 && expected.has(m.code)));
        if (numErrors + numWarnings > 0 || (strict && surprise)) status = Math.max(status, 1);
    } catch (error) {
        console.error(`${file}: ${error.message ?? error}`);
        status = 2;
    }
}
process.exitCode = status;
