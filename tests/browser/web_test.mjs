// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// web_test.mjs VSPLIT PICTURES: the viewer in Chromium, against good servers and bad ones. Pictures are left in a folder, to be looked at.
import assert from 'node:assert/strict';
import { execFileSync, spawn, spawnSync } from 'node:child_process';
import { chmodSync, cpSync, existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:net';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { after, before, test } from 'node:test';
import { launch, plain, serve, spoiled } from './harness.mjs';

const [vsplit, pictures] = process.argv.slice(2).map((path) => resolve(path));
const run = (...args) => execFileSync(vsplit, args, { cwd: folder, stdio: ['ignore', 'pipe', 'inherit'] }).toString();
const folder = mkdtempSync(join(tmpdir(), 'vsplit-web-'));
mkdirSync(pictures, { recursive: true });

let browser, site, whale;

before(async () => {
    run('sample', 'whale', '--mesh', '--triangles', '24000', '-o', 'whale.ply');
    run('bake', 'whale.ply', '-o', 'whale.pmesh', '--block-bytes', '4096', '-q');
    run('extract', 'whale.pmesh', '--ratio', '1', '-o', 'scene.glb', '-q');
    run('bake', 'scene.glb', '-o', 'scene.vsplit.glb', '--block-bytes', '4096', '-q');
    whale = JSON.parse(run('info', 'whale.pmesh', '--json'));
    site = await serve(vsplit, folder);
    assert.equal(site.said.viewer, true, 'this vsplit has no viewer: ./run web comes before ./run build');
    browser = await launch();
});
after(async () => {
    await browser?.close();
    site?.stop();
    rmSync(folder, { recursive: true, force: true });
});

/** A page of the viewer. Its own errors fail the test, but for failed requests, which are what is tested. */
async function view(t, source, { query = '', size = [480, 320], scheme = 'light', ...more } = {}) {
    const page = await browser.newPage({ viewport: { width: size[0], height: size[1] }, colorScheme: scheme, ...more });
    t.after(() => page.close());
    const faults = [];
    page.on('pageerror', (error) => faults.push(error.message));
    page.on('console', (message) => { if ((message.type() === 'error' && !/Failed to load resource|net::|CORS policy/.test(message.text())) || /INVALID_/.test(message.text())) faults.push(message.text()); });
    t.after(() => assert.deepEqual(faults, []));
    await page.goto(`${site.url}_vsplit/index.html?retry=1${source ? `&src=${encodeURIComponent(source)}` : ''}${query}`);
    return page;
}
const until = (page, condition, argument) => page.waitForFunction(condition, argument, { timeout: 40_000, polling: 50 });
const level = (page) => page.evaluate(() => window.vsplit.state.level);
/** Until all of it is drawn. An error that the page reports is one of the test. */
const whole = async (page) => {
    await until(page, () => window.vsplit?.state.error || (window.vsplit?.model?.info && window.vsplit.state.level?.triangles === window.vsplit.model.info.triangles));
    assert.equal(await page.evaluate(() => window.vsplit.state.error?.message), undefined);
};
const failure = async (page) => {
    await until(page, () => window.vsplit.state.error);
    return page.evaluate(() => ({ code: window.vsplit.state.error.code, message: window.vsplit.state.error.message, shown: document.getElementById('notice').checkVisibility() && document.getElementById('notice-text').textContent }));
};

/** Triangles by their corners' coordinates, each from its least corner on, sorted. */
function canonical(positions, indices) {
    const triangles = [];
    for (let i = 0; i < indices.length; i += 3) {
        const corners = [0, 1, 2].map((k) => Array.from(positions.subarray(3 * indices[i + k], 3 * indices[i + k] + 3)).join(' '));
        const first = corners.indexOf(corners.toSorted()[0]);
        triangles.push([...corners.slice(first), ...corners.slice(0, first)].join(','));
    }
    return triangles.sort();
}
async function drawn(page) {
    const [positions, indices] = await page.evaluate(() => {
        const { arrays, parts, shown } = window.vsplit.model;
        const all = parts.flatMap((part) => Array.from(part.copies[shown].geometry.index.array.subarray(0, 3 * part.copies[shown].triangles)));
        return [Array.from(arrays.get('position').data), all];
    });
    return canonical(new Float32Array(positions), indices);
}
/** A binary PLY as vsplit writes it. */
function ply(name) {
    const bytes = readFileSync(join(folder, name));
    const begin = bytes.indexOf('end_header\n') + 11;
    const head = bytes.subarray(0, begin).toString();
    const vertices = Number(/element vertex (\d+)/.exec(head)[1]), faces = Number(/element face (\d+)/.exec(head)[1]);
    assert.equal([...head.matchAll(/property float/g)].length, 3);
    const positions = new Float32Array(3 * vertices), indices = new Uint32Array(3 * faces);
    for (let i = 0; i < positions.length; ++i) positions[i] = bytes.readFloatLE(begin + 4 * i);
    for (let f = 0, at = begin + 12 * vertices; f < faces; ++f, at += 13) for (let k = 0; k < 3; ++k) indices[3 * f + k] = bytes.readUInt32LE(at + 1 + 4 * k);
    return canonical(positions, indices);
}
const extracted = (name, ...args) => {
    run('extract', name, ...args, '-o', 'level.ply', '-f', '-q');
    return ply('level.ply');
};
const picture = (page, name) => page.screenshot({ path: join(pictures, `${name}.png`) });
/** How many of the canvas's pixels are not empty, and whether all of them have one colour. */
const painted = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => {
    const { renderer, scene, camera } = window.vsplit;
    renderer.render(scene, camera);
    const gl = renderer.getContext(), { drawingBufferWidth: w, drawingBufferHeight: h } = gl;
    const pixels = new Uint8Array(4 * w * h);
    gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
    let count = 0;
    const colours = new Set();
    for (let i = 0; i < pixels.length; i += 4) if (pixels[i + 3] > 200) { count++; colours.add((pixels[i] << 16) | (pixels[i + 1] << 8) | pixels[i + 2]); }
    done({ share: count / (w * h), colours: colours.size });
})));

test('every level is the one that vsplit extract cuts, triangle by triangle, there and back', async (t) => {
    const page = await view(t, '/whale.pmesh');
    await whole(page);
    assert.deepEqual(await level(page), { vertices: whale.vertices, triangles: whale.triangles, error: 0 });
    assert.deepEqual(await drawn(page), extracted('whale.pmesh', '--ratio', '1'));
    for (const triangles of [5000, 700, 12000, 100, whale.triangles]) {
        await page.evaluate((n) => window.vsplit.model.setTarget({ triangles: n }), triangles);
        await page.evaluate(() => window.dispatchEvent(new Event('resize')));
        await until(page, (n) => { const at = window.vsplit.state.level.triangles; return at <= n && at > n - 8; }, triangles);
        assert.deepEqual(await drawn(page), extracted('whale.pmesh', '--triangles', String(triangles)), `${triangles} triangles`);
    }
    await picture(page, 'whale-whole');
});

test('the first 32 KiB are enough to see it', async (t) => {
    const server = await spoiled(folder, (request, response, { first }) => first >= 32768);  // The rest never comes.
    t.after(server.stop);
    const page = await view(t, `${server.url}whale.pmesh`);
    await until(page, () => window.vsplit.state.level?.triangles > 1000);
    assert.ok(server.asked[0].last < 32768);
    const { share, colours } = await painted(page);
    assert.ok(share > 0.03 && colours > 30, `${share} of the picture, ${colours} colours`);
    const fed = await page.evaluate(() => window.vsplit.state.progress.fed);
    assert.ok(fed <= 32768, `${fed} bytes`);
    await picture(page, 'whale-32-KiB');
});

test('a ratio asks for no more of the file than it needs', async (t) => {
    const server = await spoiled(folder);
    t.after(server.stop);
    const page = await view(t, `${server.url}whale.pmesh`, { query: '&ratio=0.02' });
    await until(page, () => window.vsplit.state.progress?.idle && window.vsplit.state.level);
    const reached = Math.max(...server.asked.map((a) => a.last));
    assert.ok(reached <= 32767 && whale.bytes > 50000, `${reached} of ${whale.bytes} bytes`);
    assert.ok(Math.abs((await level(page)).triangles - 0.02 * whale.triangles) < 12);
    await page.keyboard.press('End');
    await whole(page);
});

test('a server that ignores ranges', async (t) => {
    const server = await spoiled(folder, (request, response, { path, bytes, range }) => (plain(response, { path, bytes, range: false }), true));
    t.after(server.stop);
    const page = await view(t, `${server.url}whale.pmesh`);
    await whole(page);
    assert.deepEqual(await drawn(page), extracted('whale.pmesh', '--ratio', '1'));
    assert.ok(server.asked.length <= 3, `${server.asked.length} requests`);
});

test('a connection killed at a hundred points: before, in and after the headers, and anywhere in the body', async (t) => {
    const kills = 100;
    let killed = 0, seed = 7;
    const random = (n) => (seed = (seed * 1103515245 + 12345) % 2147483648) % n;
    const server = await spoiled(folder, (request, response, { bytes, first, last }) => {
        if (killed >= kills) return false;
        const { socket } = response, body = bytes.subarray(first, Math.min(last + 1, first + 1 + random(900)));
        const head = `HTTP/1.1 206 Partial Content\r\nAccess-Control-Allow-Origin: *\r\nContent-Range: bytes ${first}-${last}/${bytes.length}\r\nContent-Length: ${last - first + 1}\r\n\r\n`;
        const kill = () => setTimeout(() => socket.destroy(), 1);
        switch (killed++ % 10) {
        case 0: kill(); break;
        case 3: socket.write(head.slice(0, 1 + random(head.length - 1)), kill); break;
        case 6: socket.write(head, kill); break;
        case 8: setTimeout(() => socket.write(Buffer.concat([Buffer.from(head), body]), kill), 150); break;
        default: socket.write(Buffer.concat([Buffer.from(head), body]), kill);
        }
        return true;
    });
    t.after(server.stop);
    const page = await view(t, `${server.url}whale.pmesh`, { size: [160, 120] });
    await whole(page);
    assert.equal(killed, kills);
    assert.deepEqual(await drawn(page), extracted('whale.pmesh', '--ratio', '1'));
});

test('a slow connection shows one mesh after the other', async (t) => {
    const page = await view(t, '/whale.pmesh', { query: '&throttle=12000' });
    const levels = new Set();
    for (let i = 0; i < 200 && !levels.has(whale.triangles); ++i) {
        const at = await level(page);
        if (at) levels.add(at.triangles);
        await page.waitForTimeout(25);
    }
    assert.ok(levels.size > 3, `${[...levels]}`);
    await whole(page);
    assert.deepEqual(await drawn(page), extracted('whale.pmesh', '--ratio', '1'));
});

test('a block that arrives damaged is fetched again', async (t) => {
    const at = whale.blocks[2].offset + 100;
    let damaged = 0;
    const damage = (limit) => (request, response, { path, bytes, first, last }) => {
        if (first > at || last < at || damaged >= limit) return false;
        damaged++;
        const copy = Buffer.from(bytes);
        copy[at] ^= 0x10;
        plain(response, { path, bytes: copy, first, last, range: true });
        return true;
    };
    const once = await spoiled(folder, damage(1));
    t.after(once.stop);
    const page = await view(t, `${once.url}whale.pmesh`);
    await whole(page);
    assert.equal(damaged, 1);
    assert.deepEqual(await drawn(page), extracted('whale.pmesh', '--ratio', '1'));
    // Always damaged: said, and what came before stays; once it is whole again, "Try again" goes on.
    damaged = 0;
    const always = await spoiled(folder, damage(3));
    t.after(always.stop);
    const other = await view(t, `${always.url}whale.pmesh`);
    const { code, message, shown } = await failure(other);
    assert.equal(code, 'checksum');
    assert.match(message, /Block 2 arrived damaged/);
    assert.equal(shown, message);
    await until(other, (n) => window.vsplit.state.level?.triangles === n, whale.blocks[1].triangles);
    await picture(other, 'damaged-block');
    await other.click('#again');
    await whole(other);
});

test('servers that lie end in an error that a person understands', async (t) => {
    const cut = (response, bytes, type = 'application/octet-stream') => { response.writeHead(200, { 'Content-Type': type, 'Content-Length': bytes.length }).end(bytes); return true; };
    const endless = (response) => {
        const block = Buffer.alloc(65536, 0x5a);
        const pump = () => { while (response.writable && response.write(block)); };
        response.on('drain', pump);
        pump();
    };
    const cases = {
        'a web page': [(q, r) => cut(r, Buffer.from('<!DOCTYPE html><title>Please log in</title>'), 'text/html'), 'not-a-model', /web page instead of a model/],
        'not there': [(q, r) => (r.writeHead(404).end(), true), 'http', /404/],
        'forbidden': [(q, r) => (r.writeHead(403).end('no'), true), 'http', /403/],
        'broken': [(q, r) => (r.writeHead(503).end(), true), 'network', /503/],
        'circles': [(q, r) => (r.writeHead(302, { Location: q.url }).end(), true), 'network', /redirect/],
        'empty': [(q, r) => cut(r, Buffer.alloc(0)), 'not-a-model', /empty/],
        'noise': [(q, r, { bytes }) => cut(r, Buffer.from(bytes).reverse()), 'not-a-model', /neither a \.pmesh nor/],
        'endless noise': [(q, r) => (r.writeHead(200), endless(r), true), 'not-a-model', /neither/],
        'endless model': [(q, r, { bytes }) => (r.writeHead(200), r.write(bytes), endless(r), true), undefined],
        'ends early': [(q, r, { bytes }) => cut(r, bytes.subarray(0, 40000)), 'truncated', /ends after 40000 bytes, but announces \d+/],
        'ends in the front': [(q, r, { bytes }) => cut(r, bytes.subarray(0, 300)), 'truncated', /./],
        'other bytes': [(q, r, { path, bytes, first, last, range }) => {
            if (first === 0) return false;
            r.setHeader('Access-Control-Expose-Headers', 'Content-Range');
            r.writeHead(206, { 'Content-Range': `bytes 0-${last}/${bytes.length}` }).end(bytes.subarray(0, last + 1));
            return true;
        }, 'server', /asked for bytes from \d+ on, and sent those from 0/],
        'another length': [(q, r, { path, bytes, first, last }) => {
            if (first === 0) return false;
            r.setHeader('Access-Control-Expose-Headers', 'Content-Range');
            r.writeHead(206, { 'Content-Range': `bytes ${first}-${last}/${bytes.length + 7}` }).end(bytes.subarray(first, last + 1));
            return true;
        }, 'server', /said first that the file has/],
        'too long answers': [(q, r, { bytes, first, range }) => {
            r.writeHead(206, { 'Content-Range': `bytes ${first}-${bytes.length - 1}/${bytes.length}` }).end(bytes.subarray(first));
            return true;
        }, undefined],
        'changed': [(q, r, { path, bytes, first, last }) => {
            r.setHeader('Access-Control-Expose-Headers', 'Content-Range, ETag');
            // Another file of the same length.
            const sent = first === 0 ? bytes.subarray(first, last + 1) : Buffer.alloc(last + 1 - first, 0x33);
            r.writeHead(206, { ETag: first === 0 ? '"a"' : '"b"', 'Content-Range': `bytes ${first}-${last}/${bytes.length}` }).end(sent);
            return true;
        }, 'server', /has changed/],
        'damaged front': [(q, r, { path, bytes, first, last }) => { const b = Buffer.from(bytes); b[60] ^= 1; plain(r, { path, bytes: b, first, last, range: true }); return true; }, 'checksum', /checksum/],
        'vast counts': [(q, r, { path, bytes, first, last }) => { const b = Buffer.from(bytes); b.fill(0xff, 28, 44); plain(r, { path, bytes: b, first, last, range: true }); return true; }, 'checksum', /./],
        'a GLB of junk': [(q, r) => cut(r, Buffer.concat([Buffer.from('glTF\x02\0\0\0', 'latin1'), Buffer.from([0xff, 0xff, 0xff, 0x7f, 0xff, 0xff, 0xff, 0x7f]), Buffer.from('JSON{{{{{{{')])), 'limit', /JSON/],
    };
    for (const [name, [answer, code, words]] of Object.entries(cases)) {
        await t.test(name, async (t) => {
            const server = await spoiled(folder, answer);
            t.after(server.stop);
            const page = await view(t, `${server.url}whale.pmesh`, { size: [160, 120] });
            if (!code) return whole(page);
            const failed = await failure(page);
            assert.equal(failed.code, code, failed.message);
            assert.match(failed.message, words);
            assert.equal(failed.shown, failed.message);
            if (name === 'a web page') {
                await page.setViewportSize({ width: 800, height: 500 });
                await picture(page, 'error');
            }
        });
    }
    const page = await view(t, 'http://127.0.0.1:9/whale.pmesh');
    assert.match((await failure(page)).message, /cannot be reached/);
});

test('a progressive GLB: the scene at once, then all its triangles', async (t) => {
    const page = await view(t, '/scene.vsplit.glb');
    await whole(page);
    assert.deepEqual((await drawn(page)).length, whale.triangles);
    const { groups, name } = await page.evaluate(() => ({ groups: window.vsplit.model.info.groups, name: window.vsplit.model.gltf.scene.type }));
    assert.equal(groups, 1);
    assert.equal(name, 'Group');
    const { share } = await painted(page);
    assert.ok(share > 0.03);
    await picture(page, 'scene');
    // Cut off anywhere, it says so.
    const bytes = readFileSync(join(folder, 'scene.vsplit.glb'));
    writeFileSync(join(folder, 'cut.vsplit.glb'), bytes.subarray(0, 900));
    assert.equal((await failure(await view(t, '/cut.vsplit.glb'))).code, 'truncated');
    assert.match((await failure(await view(t, '/scene.glb'))).message, /carries no progressive mesh/);
});

test('local files, keys, colours, sizes', async (t) => {
    const page = await view(t, '', { size: [1100, 700] });
    assert.ok(await page.isVisible('#empty'));
    await picture(page, 'empty');
    await page.setInputFiles('#file', join(folder, 'whale.pmesh'));
    await whole(page);
    assert.equal(await page.textContent('#name'), 'whale.pmesh');
    assert.equal((await page.textContent('#triangles')).replaceAll(',', ''), String(whale.triangles));
    for (let i = 0; i < 15; ++i) await page.keyboard.press('ArrowLeft');
    await until(page, (n) => window.vsplit.state.level.triangles < n / 3, whale.triangles);
    await page.keyboard.press('w');
    assert.ok(await page.isChecked('#wireframe'));
    await page.waitForTimeout(200);
    await picture(page, 'wireframe');
    await page.keyboard.press('w');
    await page.keyboard.press('e');
    assert.ok(await page.isVisible('#legend'));
    await page.waitForTimeout(200);
    const heat = await painted(page);
    assert.ok(heat.share > 0.02 && heat.colours > 50);
    await picture(page, 'error-heat');
    await page.selectOption('#colour', 'weight');
    await page.selectOption('#colour', 'plain');
    // A pixel error asks for fewer triangles from further away.
    await page.keyboard.press('p');
    await until(page, () => 'pixels' in (window.vsplit.state.target ?? {}));
    const near = await page.evaluate(() => window.vsplit.state.target.pixels);
    await page.evaluate(() => window.vsplit.camera.position.multiplyScalar(3));
    await page.mouse.move(500, 200);
    await page.mouse.down();
    await page.mouse.move(540, 210, { steps: 3 });
    await page.mouse.up();
    await until(page, (e) => window.vsplit.state.target.pixels > 1.5 * e, near);
    // The other files are not models.
    await page.setInputFiles('#file', join(folder, 'whale.ply'));
    assert.equal((await failure(page)).code, 'not-a-model');
    await page.setInputFiles('#file', join(folder, 'whale.pmesh'));
    await until(page, () => window.vsplit.state.level);
    const dropped = await page.evaluateHandle(async (bytes) => {
        const transfer = new DataTransfer();
        transfer.items.add(new File([new Uint8Array(bytes)], 'dropped.pmesh'));
        return transfer;
    }, [...readFileSync(join(folder, 'whale.pmesh'))]);
    await page.dispatchEvent('body', 'drop', { dataTransfer: dropped });
    await until(page, () => document.getElementById('name').textContent === 'dropped.pmesh' && window.vsplit.state.level);
});

test('a lost GL context comes back with the mesh', async (t) => {
    const page = await view(t, '/whale.pmesh', { query: '&ratio=0.3' });
    await until(page, (n) => Math.abs(window.vsplit.state.level?.triangles - n) < 60, Math.round(0.3 * whale.triangles));
    const before = await pixels(page);
    await page.evaluate(async () => {
        const { renderer } = window.vsplit, lose = renderer.getContext().getExtension('WEBGL_lose_context');
        const heard = (event) => new Promise((r) => renderer.domElement.addEventListener(event, () => setTimeout(r), { once: true }));
        const lost = heard('webglcontextlost'), back = heard('webglcontextrestored');
        lose.loseContext();
        // Before the page was told, and said that it wants the context back, there is nothing to restore: the call would be ignored.
        await lost;
        lose.restoreContext();
        await back;
    });
    await page.waitForTimeout(300);
    const { overlap, difference } = likeness(before, await pixels(page));
    // Shaders, too, are made anew, from what is known by then: the same ones.
    assert.ok(overlap > 0.999 && difference < 0.1, `${overlap} of the outline, ${difference} of 255 apart`);
    // And goes on.
    await page.keyboard.press('End');
    await whole(page);
    assert.ok((await painted(page)).share > 0.03);
});

test('dark, and on a phone', async (t) => {
    const dark = await view(t, '/whale.pmesh', { size: [1100, 700], scheme: 'dark' });
    await whole(dark);
    await picture(dark, 'dark');
    const phone = await view(t, '/whale.pmesh', { size: [390, 780], hasTouch: true, isMobile: true, deviceScaleFactor: 2 });
    await whole(phone);
    assert.equal(await phone.evaluate(() => document.documentElement.scrollWidth), 390);
    await picture(phone, 'phone');
    await phone.tap('#fold');
    assert.ok(await phone.isVisible('#ratio'));
    const box = await phone.locator('#panel').boundingBox();
    assert.ok(box.x >= 0 && box.x + box.width <= 390 && box.y > 200 && box.y + box.height <= 780);
    await picture(phone, 'phone-controls');
});

test('the list of models has pictures of them', async (t) => {
    const page = await browser.newPage({ viewport: { width: 900, height: 600 } });
    t.after(() => page.close());
    const faults = [];
    page.on('console', (message) => { if (message.type() === 'error') faults.push(message.text()); });
    await page.goto(site.url);
    await until(page, () => [...document.querySelectorAll('[data-preview="/whale.pmesh"], [data-preview="/scene.vsplit.glb"]')].every((at) => at.dataset.drawn > 0));
    await picture(page, 'list');
    assert.deepEqual(faults, []);
    await page.click('text=whale.pmesh');
    await whole(page);
});

test('the page of the documentation, with the package as npm packs it', async (t) => {
    const root = resolve(import.meta.dirname, '../..');
    const example = readFileSync(join(root, 'docs/examples/embed.html'), 'utf8');
    for (const [, snippet] of readFileSync(join(root, 'docs/web.md'), 'utf8').matchAll(/```js\n([^`]*(?:`[^`]+`[^`]*)*?)```\n/g)) assert.ok(example.includes(snippet), snippet);
    const place = mkdtempSync(join(tmpdir(), 'vsplit-page-'));
    t.after(() => rmSync(place, { recursive: true, force: true }));
    mkdirSync(join(place, 'node_modules/vsplit'), { recursive: true });
    execFileSync('tar', ['-xzf', join(root, 'build/web/vsplit-0.1.0.tgz'), '-C', join(place, 'node_modules/vsplit'), '--strip-components=1']);
    symlinkSync(join(root, 'lib/wasm/npm/node_modules/three'), join(place, 'node_modules/three'));
    cpSync(join(folder, 'whale.pmesh'), join(place, 'whale.pmesh'));
    cpSync(join(root, 'docs/examples/embed.html'), join(place, 'index.html'));
    const server = await spoiled(place);
    t.after(server.stop);
    const page = await browser.newPage({ viewport: { width: 480, height: 320 } });
    t.after(() => page.close());
    const faults = [];
    page.on('pageerror', (error) => faults.push(error.message));
    await page.goto(`${server.url}index.html`);
    await until(page, (n) => document.title === `${n} triangles` || document.title === `${n - 1} triangles`, Math.round(0.4 * whale.triangles));
    await picture(page, 'embed');
    assert.deepEqual(faults, []);
});

/** Two pictures of the same size: how many of the pixels that either covers both cover, and by how much these differ, of 255. */
function likeness(one, other) {
    let both = 0, either = 0, difference = 0;
    for (let i = 0; i < one.length; i += 4) {
        const covers = one[i + 3] > 128, does = other[i + 3] > 128;
        either += covers || does;
        both += covers && does;
        if (covers && does) for (let k = 0; k < 3; ++k) difference += Math.abs(one[i + k] - other[i + k]) / 3;
    }
    return { overlap: both / either, difference: difference / both };
}
const pixels = async (page) => Buffer.from(await page.evaluate(() => {
    const { renderer, scene, camera } = window.vsplit;
    renderer.render(scene, camera);
    const gl = renderer.getContext(), { drawingBufferWidth: w, drawingBufferHeight: h } = gl;
    const all = new Uint8Array(4 * w * h);
    gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, all);
    let text = '';
    for (let i = 0; i < all.length; i += 8192) text += String.fromCharCode(...all.subarray(i, i + 8192));
    return btoa(text);
}), 'base64');

const there = (command) => spawnSync('sh', ['-c', `command -v ${command}`]).status === 0;
const corpus = resolve(import.meta.dirname, '../../../shared/corpus');
const noCorpus = !existsSync(corpus) && 'the shared models are not there';

test('nefertiti: recognisable after 32 KiB, and at 3 Mbit/s from nginx never a hole or a spike', { skip: noCorpus || (!there('nginx') && 'nginx is not installed') }, async (t) => {
    run('bake', join(corpus, 'meshes/nefertiti.obj'), '-o', 'nefertiti.pmesh', '-q');
    const server = await spoiled(folder, (request, response, { path, first }) => path.endsWith('nefertiti.pmesh') && first >= 32768);
    t.after(server.stop);
    const look = { size: [600, 640], query: '&zup&panel=0' };
    const early = await view(t, `${server.url}nefertiti.pmesh`, look);
    await until(early, () => window.vsplit.state.level?.triangles > 1000 && window.vsplit.state.progress.fed > 30000);
    assert.ok(await early.evaluate(() => window.vsplit.state.progress.fed) <= 32768);
    await early.waitForTimeout(500);
    const before = await pixels(early);
    await picture(early, 'nefertiti-32-KiB');

    const { url, stop } = await other('nginx');
    t.after(stop);
    const page = await view(t, '', look);
    // Every mesh that is drawn on the way, as it is drawn. The file itself comes past the first page's cache.
    await page.evaluate(() => {
        window.drawn = [];
        Object.defineProperty(window.vsplit.state, 'level', {
            get: () => window.last,
            set: (level) => {
                window.last = level;
                const { arrays, parts, shown } = window.vsplit.model ?? {};
                if (level) window.drawn.push({ triangles: level.triangles, positions: Array.from(arrays.get('position').data.subarray(0, 3 * level.vertices)), indices: Array.from(parts[0].copies[shown].geometry.index.array.subarray(0, 3 * level.triangles)) });
            },
        });
    });
    await page.evaluate((address) => window.vsplit.open(address, 'nefertiti'), `${url}nefertiti.pmesh`);
    await whole(page);
    const levels = await page.evaluate(() => window.drawn);
    assert.ok(levels.length >= 2, `${levels.length} levels were drawn`);
    for (const { triangles, positions, indices } of levels)
        assert.deepEqual(canonical(new Float32Array(positions), indices), extracted('nefertiti.pmesh', '--triangles', String(triangles)), `the mesh of ${triangles} triangles is another one`);
    await page.waitForTimeout(300);
    const { overlap, difference } = likeness(before, await pixels(page));
    await picture(page, 'nefertiti-whole');
    assert.ok(overlap > 0.97 && difference < 12, `${overlap} of the outline, ${difference} of 255 apart`);
});

for (const name of ['Duck', 'CesiumMan']) {
    test(`${name}: the refined scene looks as the original, with its materials, textures and skins`, { skip: noCorpus }, async (t) => {
        const original = `${name}.glb`, progressive = `${name}.vsplit.glb`;
        cpSync(join(corpus, 'gltf', original), join(folder, original));
        chmodSync(join(folder, original), 0o644);
        run('bake', original, '-o', progressive, '--block-bytes', '4096', '-q');
        const server = await spoiled(folder);
        t.after(server.stop);
        const page = await view(t, `${server.url}${progressive}`, { size: [400, 400], query: '&panel=0' });
        await whole(page);
        const { asked } = server;
        assert.ok(asked.filter((a) => a.path.endsWith(progressive)).every((a) => a.range), 'all came by ranges');
        const scene = await page.evaluate(() => {
            const found = { textured: 0, skinned: 0, uv: 0, weighted: 0 };
            const { model } = window.vsplit;
            model.gltf.scene.traverse((o) => {
                if (!o.isMesh) return;
                found.textured += Boolean(o.material.map?.image);
                found.skinned += Boolean(o.isSkinnedMesh);
                found.uv += o.geometry.hasAttribute('uv');
                found.weighted += o.geometry.hasAttribute('skinIndex') && o.geometry.hasAttribute('skinWeight');
            });
            return found;
        });
        assert.ok(scene.textured > 0 && scene.uv > 0, JSON.stringify(scene));
        if (name === 'CesiumMan') assert.ok(scene.skinned > 0 && scene.weighted === scene.skinned, JSON.stringify(scene));
        // The same pose for both.
        const still = (of) => page.evaluate(async ([source, address]) => {
            const { model, scene } = window.vsplit;
            window.vsplit.stop();
            if (source === 'original') {
                const gltf = await new Promise((done, fail) => fetch(address).then((r) => r.arrayBuffer()).then((b) => model.options.gltfLoader.parse(b, '', done, fail)));
                model.visible = false;
                scene.add(gltf.scene);
                gltf.scene.traverse((o) => { o.frustumCulled = false; });
            }
            scene.traverse((o) => o.isSkinnedMesh && o.skeleton.pose());
            scene.updateMatrixWorld(true);
        }, [of, `${server.url}${original}`]);
        await still('refined');
        const refined = await pixels(page);
        await picture(page, `${name}-refined`);
        await still('original');
        const { overlap, difference } = likeness(refined, await pixels(page));
        await picture(page, `${name}-original`);
        assert.ok(overlap > 0.97 && difference < 8, `${overlap} of the outline, ${difference} of 255 apart`);
    });
}

test('the package: what npm packs, its types, and its README, under strict TypeScript', async (t) => {
    const root = resolve(import.meta.dirname, '../..'), npm = join(root, 'lib/wasm/npm');
    const archive = join(root, 'build/web/vsplit-0.1.0.tgz');
    const packed = execFileSync('tar', ['-tzf', archive]).toString().trim().split('\n').map((name) => name.replace(/^package\//, ''));
    for (const wanted of ['package.json', 'README.md', 'LICENSE', 'dist/vsplit.wasm', 'dist/index.js', 'dist/index.d.ts', 'dist/three.js', 'dist/three.d.ts', 'dist/worker.js']) assert.ok(packed.includes(wanted), wanted);
    assert.deepEqual(packed.filter((name) => !/^(package\.json|README\.md|LICENSE|dist\/[a-z_]+(\.js|\.d\.ts|\.wasm))$/.test(name)), []);
    const place = mkdtempSync(join(tmpdir(), 'vsplit-types-'));
    t.after(() => rmSync(place, { recursive: true, force: true }));
    mkdirSync(join(place, 'node_modules/vsplit'), { recursive: true });
    execFileSync('tar', ['-xzf', archive, '-C', join(place, 'node_modules/vsplit'), '--strip-components=1']);
    for (const name of ['three', '@types']) cpSync(join(npm, 'node_modules', name), join(place, 'node_modules', name), { recursive: true });
    const snippets = [...readFileSync(join(npm, 'README.md'), 'utf8').matchAll(/```ts\n([^`]*(?:`[^`]+`[^`]*)*?)```\n/g)];
    assert.ok(snippets.length >= 2);
    snippets.forEach(([, snippet], i) => writeFileSync(join(place, `snippet${i}.ts`), snippet));
    for (const moduleResolution of ['bundler', 'nodenext']) {
        writeFileSync(join(place, 'package.json'), '{ "type": "module" }');
        writeFileSync(join(place, 'tsconfig.json'), JSON.stringify({ compilerOptions: {
            target: 'ES2022', module: moduleResolution === 'nodenext' ? 'NodeNext' : 'ES2022', moduleResolution, lib: ['ES2022', 'DOM', 'DOM.Iterable'], types: [],
            strict: true, exactOptionalPropertyTypes: true, noUncheckedIndexedAccess: true, skipLibCheck: false, noEmit: true }, include: ['*.ts', 'node_modules/vsplit/dist/*.d.ts'] }));
        const { status, stdout } = spawnSync(process.execPath, [join(npm, 'node_modules/typescript/bin/tsc'), '-p', place]);
        // Other packages' own types are not ours to mend.
        const ours = stdout.toString().split('\n').filter((line) => line.includes('error') && !/node_modules\/(three|@types)/.test(line));
        assert.deepEqual(ours, [], moduleResolution);
        assert.ok(status === 0 || stdout.length > 0);
    }
});

const port = () => new Promise((done) => { const s = createServer().listen(0, '127.0.0.1', () => { const { port: free } = s.address(); s.close(() => done(free)); }); });
const others = {
    nginx: (at, dir) => {
        writeFileSync(join(dir, 'nginx.conf'), `daemon off; master_process off; pid ${dir}/pid; error_log ${dir}/log; events {}
http { access_log off; ${['client_body', 'proxy', 'fastcgi', 'uwsgi', 'scgi'].map((n) => `${n}_temp_path ${dir}/t;`).join(' ')}
 server { listen 127.0.0.1:${at}; root ${folder}; limit_rate 375000; add_header Access-Control-Allow-Origin * always; gzip on; gzip_types *; } }\n`);
        return ['nginx', '-c', join(dir, 'nginx.conf')];
    },
    caddy: (at, dir) => {
        writeFileSync(join(dir, 'Caddyfile'), `{\n admin off\n auto_https off\n}\nhttp://127.0.0.1:${at} {\n root * ${folder}\n header Access-Control-Allow-Origin *\n file_server\n encode gzip\n}\n`);
        return ['caddy', 'run', '--adapter', 'caddyfile', '--config', join(dir, 'Caddyfile')];
    },
    'vsplit serve': (at) => [vsplit, 'serve', folder, '--port', String(at), '-q'],
};
/** One of them over the folder. */
async function other(name) {
    const dir = mkdtempSync(join(tmpdir(), 'vsplit-server-'));
    const at = await port();
    const [program, ...args] = others[name](at, dir);
    const server = spawn(program, args, { stdio: 'ignore', env: { ...process.env, HOME: dir, XDG_CONFIG_HOME: dir, XDG_DATA_HOME: dir } });
    const url = `http://127.0.0.1:${at}/`;
    for (let i = 0; ; ++i) {
        if (await fetch(`${url}whale.pmesh`, { method: 'HEAD' }).then((r) => r.ok, () => false)) break;
        assert.ok(i < 200, `${name} does not start`);
        await new Promise((r) => setTimeout(r, 50));
    }
    return { url, stop: () => { server.kill(); rmSync(dir, { recursive: true, force: true }); } };
}
for (const name of Object.keys(others)) {
    test(`another origin: ${name}`, { skip: !name.startsWith('vsplit') && !there(name) && `${name} is not installed` }, async (t) => {
        const { url, stop } = await other(name);
        t.after(stop);
        const page = await view(t, `${url}whale.pmesh`);
        await whole(page);
        assert.deepEqual(await drawn(page), extracted('whale.pmesh', '--ratio', '1'));
    });
}
