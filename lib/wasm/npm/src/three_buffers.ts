// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The arrays of a mesh that changes while it is drawn. There is one copy for the CPU and two for the GPU: while one is drawn
// the other is brought up to date, a slice a frame, and then they change places. So what is drawn is always one whole mesh, and no
// frame has more to do than its share, however large the mesh and the change.
import { BufferAttribute, BufferGeometry, DynamicDrawUsage } from 'three';
import type { ArrayPatch } from './messages.js';

const kChunk = 16 * 1024;  // elements; three.js merges neighbours

type Numbers = Float32Array | Uint32Array | Int16Array;

/** One array, and which chunks of it each of the two GPU copies lacks. */
export class LiveArray {
    private dirty: [Uint8Array, Uint8Array];

    constructor(public data: Numbers, readonly itemSize: number, readonly normalized = false) {
        this.dirty = LiveArray.flags(data);
    }

    private static flags(data: Numbers): [Uint8Array, Uint8Array] {
        const chunks = Math.ceil(data.length / kChunk);
        return [new Uint8Array(chunks), new Uint8Array(chunks)];
    }

    /** Room for `elements`; the old ones stay. */
    grow(elements: number) {
        if (elements <= this.data.length) return;
        const grown = new (this.data.constructor as { new(n: number): Numbers })(elements);
        grown.set(this.data as never);
        this.data = grown;
        this.dirty = LiveArray.flags(grown);
    }

    write(start: number, values: Numbers) {
        this.data.set(values as never, start);
        const last = Math.floor((start + values.length - 1) / kChunk);
        for (let chunk = Math.floor(start / kChunk); chunk <= last; ++chunk) this.dirty[0][chunk] = this.dirty[1][chunk] = 1;
    }

    /** A new attribute has all of the array as it is. */
    attribute(side: 0 | 1): BufferAttribute {
        const made = new BufferAttribute(this.data, this.itemSize, this.normalized);
        made.setUsage(DynamicDrawUsage);
        this.dirty[side].fill(0);
        return made;
    }

    /** Marks for upload what `side` lacks, at most about `bytes`; returns what is left of them. */
    flush(side: 0 | 1, attribute: BufferAttribute, bytes: number): number {
        const flags = this.dirty[side];
        for (let chunk = flags.indexOf(1); chunk >= 0 && bytes > 0; chunk = flags.indexOf(1, chunk)) {
            let end = chunk;
            while (end < flags.length && flags[end] && bytes > 0) {
                flags[end++] = 0;
                bytes -= kChunk * this.data.BYTES_PER_ELEMENT;
            }
            const start = chunk * kChunk;
            attribute.addUpdateRange(start, Math.min(end * kChunk, this.data.length) - start);
            attribute.needsUpdate = true;
            chunk = end;
        }
        return bytes;
    }

    clean(side: 0 | 1) { return this.dirty[side].indexOf(1) < 0; }
}

/** Applies a patch to arrays piece by piece, so that a large one takes several frames. */
export class PatchCursor {
    private array = 0;
    private range = 0;
    private taken = 0;

    constructor(private readonly patches: ArrayPatch[], private readonly find: (patch: ArrayPatch) => LiveArray | undefined) {}

    /** True when all is applied; false when the time is over. */
    run(until: number): boolean {
        for (; this.array < this.patches.length; ++this.array, this.range = this.taken = 0) {
            const patch = this.patches[this.array];
            const target = this.find(patch);
            for (let count = 0; target && this.range < patch.ranges.length; this.range += 2, ++count) {
                if ((count & 255) === 255 && performance.now() > until) return false;
                const start = patch.ranges[this.range], size = patch.ranges[this.range + 1];
                target.write(start, patch.data.subarray(this.taken, this.taken + size));
                this.taken += size;
            }
            if (performance.now() > until && this.array + 1 < this.patches.length) {
                ++this.array;
                this.range = this.taken = 0;
                return false;
            }
        }
        return true;
    }
}

/** One of the two GPU copies of one part: vertex attributes, shared by all parts, and an index of its own. */
export class GpuCopy {
    readonly geometry = new BufferGeometry();
    triangles = 0;

    constructor(readonly side: 0 | 1) { this.hide(); }

    show(triangles: number) {
        this.triangles = triangles;
        this.geometry.setDrawRange(0, 3 * triangles);
    }
    hide() { this.geometry.setDrawRange(0, 0); }
}
