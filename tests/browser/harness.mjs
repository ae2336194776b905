// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What the browser tests share: Chromium with software GL, and servers that are as they should be or not.
import { spawn } from 'node:child_process';
import { readFileSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join } from 'node:path';
import { chromium } from 'playwright-core';

export const launch = () => chromium.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync'],
});

/** `vsplit serve` of a folder. */
export async function serve(vsplit, folder, ...args) {
    const process = spawn(vsplit, ['serve', folder, '--port', '0', '--json', ...args], { stdio: ['ignore', 'pipe', 'inherit'] });
    let text = '';
    for await (const chunk of process.stdout) {
        text += chunk;
        if (text.trimEnd().endsWith('}')) break;
    }
    const said = JSON.parse(text);
    return { url: said.url, said, stop: () => process.kill() };
}

const kTypes = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.wasm': 'application/wasm' };

/**
 * A server of files whose answers `answer` may spoil: called with (request, response, {path, bytes, first, last}), it returns true if it has
 * answered. Counts what it was asked.
 */
export async function spoiled(folder, answer = () => false) {
    const asked = [];
    const server = createServer((request, response) => {
        const path = decodeURIComponent(new URL(request.url, 'http://x').pathname);
        response.setHeader('Access-Control-Allow-Origin', '*');
        let bytes;
        try {
            if (!statSync(join(folder, path)).isFile()) throw new Error();
            bytes = readFileSync(join(folder, path));
        } catch {
            response.writeHead(404).end('no such file');
            return;
        }
        const range = /^bytes=(\d+)-(\d*)$/.exec(request.headers.range ?? '');
        const first = range ? Number(range[1]) : 0, last = Math.min(range?.[2] ? Number(range[2]) : bytes.length - 1, bytes.length - 1);
        asked.push({ path, first, last, range: request.headers.range });
        if (answer(request, response, { path, bytes, first, last, range: Boolean(range), times: asked.length })) return;
        plain(response, { path, bytes, first, last, range: Boolean(range) });
    });
    await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
    return {
        url: `http://127.0.0.1:${server.address().port}/`, asked,
        stop: () => { server.closeAllConnections(); server.close(); },
    };
}

/** What a good server answers. */
export function plain(response, { path, bytes, first, last, range }) {
    response.setHeader('Content-Type', kTypes[extname(path)] ?? 'application/octet-stream');
    if (!range) return void response.writeHead(200, { 'Content-Length': bytes.length }).end(bytes);
    if (first >= bytes.length) return void response.writeHead(416, { 'Content-Range': `bytes */${bytes.length}` }).end();
    response.setHeader('Access-Control-Expose-Headers', 'Content-Range');
    response.writeHead(206, { 'Content-Range': `bytes ${first}-${last}/${bytes.length}`, 'Content-Length': last - first + 1 }).end(bytes.subarray(first, last + 1));
}
