#!/usr/bin/env node
// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// render.mjs [--engine three|babylon] [--out PICTURE.png] [--size N] [--time SECONDS] [--yaw DEGREES] [--pitch DEGREES] FILE.glb...
// Every file as one picture, side by side, in headless Chromium, all with the camera that fits the first. Babylon also says how many levels
// of MSFT_lod it has loaded. Errors and warnings of the page are printed; exits 1 if there is an error, 2 if a file does not load.
import { createServer } from 'node:http';
import { existsSync } from 'node:fs';
import { readFile, writeFile } from 'node:fs/promises';
import { dirname, extname, join, normalize, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { chromium } from 'playwright-core';

const here = dirname(fileURLToPath(import.meta.url));
const options = { engine: 'three', out: 'render.png', size: 512, time: 0, yaw: 30, pitch: 20 };
const files = [];
for (let args = process.argv.slice(2); args.length > 0; ) {
    const arg = args.shift();
    if (arg.startsWith('--')) {
        const key = arg.slice(2);
        if (!(key in options)) throw new Error(`unknown option ${arg}`);
        const value = args.shift();
        options[key] = typeof options[key] === 'number' ? Number(value) : value;
    } else files.push(resolve(arg));
}
if (files.length === 0) {
    console.error('usage: render.mjs [options] FILE.glb...');
    process.exit(2);
}

const kinds = { '.js': 'text/javascript', '.mjs': 'text/javascript', '.html': 'text/html', '.wasm': 'application/wasm' };
const server = createServer(async (request, response) => {
    const path = decodeURIComponent(new URL(request.url, 'http://localhost').pathname);
    if (path === '/favicon.ico') return response.writeHead(204).end();
    try {
        const file = path.startsWith('/file/') ? files[Number(path.split('/')[2])] : join(here, normalize(path));
        const bytes = await readFile(file);
        response.writeHead(200, { 'content-type': kinds[extname(file)] ?? 'application/octet-stream' });
        response.end(bytes);
    } catch {
        response.writeHead(404);
        response.end();
    }
});
await new Promise((done) => server.listen(0, '127.0.0.1', done));
const root = `http://127.0.0.1:${server.address().port}`;

const candidates = [process.env.CHROMIUM, '/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'];
const executablePath = candidates.find((path) => path && existsSync(path));
if (!executablePath) {
    console.error('render.mjs: no Chromium found; set CHROMIUM');
    process.exit(2);
}
const browser = await chromium.launch({
    executablePath,
    args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'],
});
let status = 0;
try {
    const page = await browser.newPage({ viewport: { width: options.size * files.length, height: options.size } });
    page.on('console', (message) => {
        if (['error', 'warning'].includes(message.type()) && !message.text().includes('GPU stall')) {
            console.log(`  page ${message.type()}: ${message.text()}`);
            if (message.type() === 'error') status = Math.max(status, 1);
        }
    });
    page.on('pageerror', (error) => {
        console.log(`  page: ${error.message}`);
        status = Math.max(status, 1);
    });
    await page.goto(`${root}/${options.engine}.html`);
    await page.waitForFunction(() => window.ready === true, null, { timeout: 60000 });
    const columns = [];
    let view = null;
    for (let i = 0; i < files.length; ++i) {
        const result = await page.evaluate(([n, o, v]) => window.render(`/file/${n}/scene.glb`, o, v), [i, options, view]).catch((error) => ({ error: error.message }));
        if (result.error) {
            console.log(`${files[i]}: ${result.error}`);
            status = 2;
            continue;
        }
        view ??= result.view;
        console.log(`${files[i]}: ${result.said}`);
        columns.push(result.picture);
    }
    if (columns.length > 0) {
        const picture = await page.evaluate(async ([urls, size]) => {
            const canvas = document.createElement('canvas');
            canvas.width = size * urls.length;
            canvas.height = size;
            const context = canvas.getContext('2d');
            for (let i = 0; i < urls.length; ++i) {
                const image = new Image();
                image.src = urls[i];
                await image.decode();
                context.drawImage(image, i * size, 0);
            }
            return canvas.toDataURL('image/png');
        }, [columns, options.size]);
        await writeFile(options.out, Buffer.from(picture.split(',')[1], 'base64'));
    }
} finally {
    await browser.close();
    server.close();
}
process.exitCode = status;
