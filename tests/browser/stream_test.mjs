// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// stream_test.mjs SOURCE: the package's decoder in Node: good files in pieces of any size, bad ones, and how large it all is.
import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { readdirSync, readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { join } from 'node:path';
import { test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { gzipSync } from 'node:zlib';

const source = process.argv[2];
const dist = join(source, 'lib/wasm/npm/dist');
const { compileVsplit, VsplitError, VsplitStream } = await import(pathToFileURL(join(dist, 'index.js')));
const wasm = readFileSync(join(dist, 'vsplit.wasm'));
const module = await compileVsplit(wasm);
const golden = join(source, 'formats/golden'), malformed = join(source, 'formats/malformed');
const pmesh = (folder) => readdirSync(folder).filter((name) => name.endsWith('.pmesh'));

/** Feeds it all, says that it ends there, and decodes it. */
function feed(stream, bytes, piece) {
    for (let at = 0; at < bytes.length; at += piece) {
        stream.feed(at, bytes.subarray(at, at + piece));
        if (stream.info) stream.update();
    }
    stream.end(bytes.length);
    stream.update();
}
/** Goes to a target in steps, each of them taken. */
function go(stream, target, maxSplits, take = () => {}) {
    stream.setTarget(target);
    for (;;) {
        const { more } = stream.update({ maxSplits });
        take();
        if (!more) return;
    }
}

/** Keeps arrays up to date by patches, as a page does. */
class Page {
    arrays = new Map();
    take({ arrays, counts, level }) {
        this.counts = counts;
        this.level = level;
        for (const { array, group = '', ranges, data } of arrays) {
            const name = array + group;
            let at = 0;
            for (let i = 0; i < ranges.length; i += 2) {
                let old = this.arrays.get(name) ?? new data.constructor(0);
                if (old.length < ranges[i] + ranges[i + 1]) {
                    const grown = new data.constructor(ranges[i] + ranges[i + 1]);
                    grown.set(old);
                    old = grown;
                }
                old.set(data.subarray(at, at += ranges[i + 1]), ranges[i]);
                this.arrays.set(name, old);
            }
            assert.equal(at, data.length);
        }
    }
    /** Of what is drawn: of vertex arrays what the level has, of each index its triangles. */
    digest(info) {
        const hash = createHash('sha256');
        for (const [name, values] of [...this.arrays].sort(([a], [b]) => (a < b ? -1 : 1))) {
            const group = /^index(\d+)$/.exec(name);
            const each = group ? 0 : name === 'position' ? 3 : name === 'normal' ? 4 : name === 'weight' ? 1 : info.attributes.find((a) => a.name === name).components;
            const used = values.subarray(0, group ? 3 * this.counts[group[1]] : each * this.level.vertices);
            hash.update(name).update(new Uint8Array(used.buffer, used.byteOffset, used.byteLength));
        }
        return hash.digest('hex');
    }
}

test('the module is small', () => {
    const bytes = gzipSync(wasm, { level: 9 }).length;
    assert.ok(bytes < 200 * 1024, `${bytes} bytes gzipped`);
});

for (const name of pmesh(golden)) {
    test(`golden/${name}: pieces of any size, every level there and back`, () => {
        const bytes = readFileSync(join(golden, name));
        const digests = [];
        for (const piece of [1 << 30, 4096, 61]) {
            const stream = new VsplitStream(module);
            feed(stream, bytes, piece);
            assert.ok(stream.complete);
            const page = new Page();
            go(stream, { ratio: 1 }, 1000);
            page.take(stream.patch());
            assert.deepEqual(page.level, { vertices: stream.info.vertices, triangles: stream.info.triangles, error: 0 });
            assert.equal(page.counts.reduce((a, b) => a + b, 0), stream.info.triangles);
            digests.push(page.digest(stream.info));
            // Down and up again by small patches: a split undoes its collapse, for the page, too.
            const seen = new Map();
            for (const triangles of [...Array(9).keys(), ...[...Array(9).keys()].reverse(), 4, 8, 0, 8].map((i) => Math.round((i * stream.info.triangles) / 8))) {
                go(stream, { triangles }, 7, () => page.take(stream.patch()));
                const digest = page.digest(stream.info);
                assert.equal(seen.get(triangles) ?? digest, digest, `${triangles} triangles look different the second time`);
                seen.set(triangles, digest);
                for (const [g, count] of page.counts.entries())
                    for (const v of page.arrays.get(`index${g}`)?.subarray(0, 3 * count) ?? []) assert.ok(v < page.level.vertices);
            }
        }
        assert.equal(new Set(digests).size, 1);
    });
}

for (const name of pmesh(malformed)) {
    test(`malformed/${name} is an error with that name`, () => {
        const bytes = readFileSync(join(malformed, name));
        const stream = new VsplitStream(module);
        let error;
        try {
            feed(stream, bytes, 1000);
        } catch (caught) {
            error = caught;
        }
        const code = name.split('-')[0];
        assert.ok(error instanceof VsplitError, `${error}`);
        assert.equal(error.code, code);
        assert.ok(error.message.length > 5);
    });
}

test('cut or damaged anywhere: an error or less of the mesh, never a crash', () => {
    const bytes = readFileSync(join(golden, '1-attributes.pmesh'));
    for (let size = 0; size < bytes.length; size += 23) {
        const stream = new VsplitStream(module);
        try {
            feed(stream, bytes.subarray(0, size), 4096);
        } catch (error) {
            assert.ok(error instanceof VsplitError, `cut at ${size}: ${error}`);
        }
        assert.ok(!stream.complete);
    }
    for (let at = 0; at < bytes.length; at += 17) {
        const copy = Buffer.from(bytes);
        copy[at] ^= 1 << at % 8;
        const stream = new VsplitStream(module);
        assert.throws(() => { feed(stream, copy, 4096); }, VsplitError, `byte ${at}`);
    }
});

test('a file may not ask for more memory than it is given', () => {
    const stream = new VsplitStream(module, { maxBytes: 10_000 });
    assert.throws(() => feed(stream, readFileSync(join(golden, '1-sphere.pmesh')), 4096), (error) => error.code === 'limit');
});

test('a damaged block is wanted again', () => {
    const bytes = readFileSync(join(golden, '1-sphere.pmesh'));
    const whole = new VsplitStream(module), stream = new VsplitStream(module);
    feed(whole, bytes, 4096);
    const { end } = whole.info.blocks[0];
    const copy = Buffer.from(bytes);
    copy[end - 3] ^= 4;
    assert.throws(() => feed(stream, copy, 1 << 20), (error) => error.code === 'checksum');
    assert.equal(stream.blocks, 0);
    assert.equal(stream.broken, false);
    const [range] = stream.wants();
    assert.equal(range.offset, stream.fed);
    assert.ok(range.offset < end);
    for (const { offset, size } of stream.wants()) stream.feed(offset, bytes.subarray(offset, offset + size));
    stream.update();
    assert.ok(stream.complete);
    assert.deepEqual(stream.wants(), []);
});

test('wants() names what a target needs and nothing else, and feed() takes it from anywhere', () => {
    const bytes = readFileSync(join(golden, '1-attributes-lossless.pmesh'));
    const stream = new VsplitStream(module);
    stream.setTarget({ ratio: 0 });
    let read = 0;
    const fetch = (most) => {
        for (let i = 0; ; ++i) {
            assert.ok(i < 10_000);
            const ranges = stream.wants(most);
            if (ranges.length === 0) return;
            for (const { offset, size } of ranges.reverse()) {
                const part = bytes.subarray(offset, Math.min(bytes.length, offset + size));
                read += part.length;
                stream.feed(offset, part);
            }
            stream.update();
        }
    };
    fetch(1 << 20);
    assert.ok(read <= 16384 && read < stream.info.bytes, `${read} bytes`);
    assert.equal(stream.level.triangles, stream.info.baseTriangles);
    stream.setTarget({ error: stream.info.blocks.at(-1).error });
    fetch(100);
    assert.equal(read, bytes.length);
    assert.ok(stream.update().reached);
    // A pixel error is followed once it has changed by enough: coming from below, the level has room to stay.
    stream.setTarget({ ratio: 0 });
    stream.update();
    const { error } = stream.info.blocks[Math.floor(stream.info.blocks.length / 2)];
    stream.setTarget({ pixels: error });
    stream.update();
    const at = stream.level;
    assert.ok(at.error <= error);
    stream.setTarget({ pixels: error * 1.05 });
    assert.equal(stream.update().changed, false);
    stream.setTarget({ error: error * 1.5 });
    stream.update();
    assert.ok(stream.level.triangles <= at.triangles);
    // With a number of triangles: the coarser of the two, and no bytes beyond it are needed.
    const most = Math.floor(at.triangles * 2 / 3);
    for (const target of [{ error, maxTriangles: most }, { pixels: error, maxTriangles: most }, { ratio: 1, maxTriangles: most }]) {
        stream.setTarget({ ratio: 1 });
        stream.update();
        stream.setTarget(target);
        assert.ok(stream.update().reached);
        assert.ok(stream.level.triangles <= most && stream.level.triangles + 4 > most, `${stream.level.triangles} of ${most}`);
        assert.ok(stream.needed(target) < stream.info.bytes);
    }
    stream.setTarget({ error, maxTriangles: stream.info.triangles });
    stream.update();
    assert.ok(stream.level.error <= error && stream.level.triangles > most);
});

test('a connection killed at a hundred points ends in the identical mesh', async (t) => {
    const { HttpReader, readerDefaults } = await import(pathToFileURL(join(dist, 'range_reader.js')));
    const bytes = readFileSync(join(golden, '1-many-components-weighted-lossless.pmesh'));
    let killed = 0, seed = 7;
    const random = (n) => (seed = (seed * 1103515245 + 12345) % 2147483648) % n;
    const server = createServer((request, response) => {
        const [, from, to] = /^bytes=(\d+)-(\d+)$/.exec(request.headers.range);
        const first = Number(from), last = Math.min(Number(to), bytes.length - 1);
        response.writeHead(206, { 'Content-Range': `bytes ${first}-${last}/${bytes.length}`, 'Content-Length': last - first + 1 });
        if (killed >= 100) return void response.end(bytes.subarray(first, last + 1));
        killed++;
        response.write(bytes.subarray(first, Math.min(last + 1, first + random(300))), () => response.destroy());
    });
    await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
    t.after(() => { server.closeAllConnections(); server.close(); });
    const reader = new HttpReader(`http://127.0.0.1:${server.address().port}/`, { ...readerDefaults, retryDelay: 0, attempts: 100 });
    const stream = new VsplitStream(module), whole = new VsplitStream(module);
    const never = new AbortController().signal;
    for (let range = stream.wants()[0]; range; range = stream.wants()[0]) {
        await reader.read(range.offset, range.offset + range.size, (part) => { stream.feed(stream.fed, part); stream.update(); return true; }, never);
        if (!stream.info && reader.size <= stream.fed) break;
    }
    assert.ok(stream.complete);
    assert.equal(killed, 100);
    feed(whole, bytes, 1 << 20);
    const page = new Page(), other = new Page();
    page.take(stream.patch());
    other.take(whole.patch());
    assert.equal(page.digest(stream.info), other.digest(whole.info));
});
