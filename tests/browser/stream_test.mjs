// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// stream_test.mjs SOURCE: the package's decoder in Node: good files in pieces of any size, bad ones, and how large it all is.
import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { readdirSync, readFileSync } from 'node:fs';
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

/** Feeds it all; the last piece is said to be the last. */
function feed(stream, bytes, piece) {
    for (let at = 0; at < bytes.length; at += piece) stream.feed(bytes.subarray(at, at + piece), at + piece >= bytes.length);
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
            while (stream.advance({ ratio: 1 }, 1000));
            page.take(stream.patch());
            assert.deepEqual(page.level, { vertices: stream.info.vertices, triangles: stream.info.triangles, error: 0 });
            assert.equal(page.counts.reduce((a, b) => a + b, 0), stream.info.triangles);
            digests.push(page.digest(stream.info));
            // Down and up again by small patches: a split undoes its collapse, for the page, too.
            const seen = new Map();
            for (const triangles of [...Array(9).keys(), ...[...Array(9).keys()].reverse(), 4, 8, 0, 8].map((i) => Math.round((i * stream.info.triangles) / 8))) {
                while (stream.advance({ triangles }, 7)) page.take(stream.patch());
                page.take(stream.patch());
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
        // What follows the end is never read.
        if (stream.complete && name.includes('behind-the-end')) return;
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
        assert.throws(() => { feed(stream, copy, 4096); while (stream.advance({ ratio: 1 }, 1e9)); }, VsplitError, `byte ${at}`);
    }
});

test('a file may not ask for more memory than it is given', () => {
    const stream = new VsplitStream(module, { maxBytes: 10_000 });
    assert.throws(() => feed(stream, readFileSync(join(golden, '1-sphere.pmesh')), 4096), (error) => error.code === 'limit');
});

test('a damaged block may be fed again', () => {
    const bytes = readFileSync(join(golden, '1-sphere.pmesh'));
    const whole = new VsplitStream(module), stream = new VsplitStream(module);
    feed(whole, bytes, 4096);
    const { end } = whole.info.blocks[0];
    const copy = Buffer.from(bytes);
    copy[end - 3] ^= 4;
    assert.throws(() => feed(stream, copy, 4096), (error) => error.code === 'checksum');
    assert.equal(stream.blocks, 0);
    feed(stream, bytes.subarray(stream.fed), 4096);
    assert.ok(stream.complete);
});
