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

/**
 * An attribute whose buffer on the GPU is ours: three.js would send the whole array when it first sees it, and a large one takes longer than a
 * frame. It draws what it takes for a GLBufferAttribute; for rays and wireframes it is a BufferAttribute as any other.
 */
export class StreamedAttribute extends BufferAttribute {
    readonly isGLBufferAttribute = true;
    readonly type: number;
    readonly elementSize: number;
    buffer: WebGLBuffer | null = null;

    constructor(private readonly gl: WebGL2RenderingContext, array: Numbers, itemSize: number, normalized: boolean, private readonly isIndex: boolean) {
        super(array, itemSize, normalized);
        this.type = array instanceof Float32Array ? gl.FLOAT : array instanceof Uint32Array ? gl.UNSIGNED_INT : gl.SHORT;
        this.elementSize = array.BYTES_PER_ELEMENT;
        this.make(array.byteLength);
    }

    /** The array from `start` on is sent: `count` elements. */
    send(start: number, count: number) {
        // A target that three.js does not use, and that says nothing about what the buffer is for.
        this.gl.bindBuffer(this.gl.COPY_WRITE_BUFFER, this.buffer);
        this.gl.bufferSubData(this.gl.COPY_WRITE_BUFFER, start * this.elementSize, this.array as Numbers, start, count);
    }
    /** After the context was lost: all of it, at once. */
    restore() {
        this.make(this.array as Numbers);
        this.needsUpdate = true;
    }
    free() { this.gl.deleteBuffer(this.buffer); }

    private make(content: number | Numbers) {
        const { gl } = this;
        this.buffer = gl.createBuffer();
        if (this.isIndex) {
            // What a buffer is bound to first says whether it may be an index. That binding belongs to a vertex array.
            const bound = gl.getParameter(gl.VERTEX_ARRAY_BINDING);
            gl.bindVertexArray(null);
            gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, this.buffer);
            gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, null);
            gl.bindVertexArray(bound);
        }
        gl.bindBuffer(gl.COPY_WRITE_BUFFER, this.buffer);
        gl.bufferData(gl.COPY_WRITE_BUFFER, content as number, gl.DYNAMIC_DRAW);
    }
}

/** One array, and which chunks of it each of the two GPU copies lacks. */
export class LiveArray {
    private dirty: [Uint8Array, Uint8Array];
    /** Chunks that were ever written. */
    private used: Uint8Array;

    constructor(public data: Numbers, readonly itemSize: number, readonly normalized = false, private readonly isIndex = false) {
        this.dirty = LiveArray.flags(data);
        this.used = this.dirty[0].slice();
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
        const { used } = this;
        this.used = this.dirty[0].slice();
        this.used.set(used);
    }

    write(start: number, values: Numbers) {
        this.data.set(values as never, start);
        const last = Math.floor((start + values.length - 1) / kChunk);
        for (let chunk = Math.floor(start / kChunk); chunk <= last; ++chunk) this.dirty[0][chunk] = this.dirty[1][chunk] = this.used[chunk] = 1;
    }

    /** Of the same kind, for one vertex. */
    placeholder(): BufferAttribute {
        return new BufferAttribute(new (this.data.constructor as { new(n: number): Numbers })(this.itemSize), this.itemSize, this.normalized);
    }

    /** With a context, a buffer that is yet to be filled; without, three.js sends all of the array as it is. */
    attribute(side: 0 | 1, gl: WebGL2RenderingContext | null): BufferAttribute {
        if (gl) {
            this.dirty[side].set(this.used);
            return new StreamedAttribute(gl, this.data, this.itemSize, this.normalized, this.isIndex);
        }
        const made = new BufferAttribute(this.data, this.itemSize, this.normalized);
        made.setUsage(DynamicDrawUsage);
        this.dirty[side].fill(0);
        return made;
    }

    /** Sends, or marks for three.js to send, what `side` lacks, at most about `bytes`; returns what is left of them. */
    flush(side: 0 | 1, attribute: BufferAttribute, bytes: number): number {
        const flags = this.dirty[side];
        for (let chunk = flags.indexOf(1); chunk >= 0 && bytes > 0; chunk = flags.indexOf(1, chunk)) {
            let end = chunk;
            while (end < flags.length && flags[end] && bytes > 0) {
                flags[end++] = 0;
                bytes -= kChunk * this.data.BYTES_PER_ELEMENT;
            }
            const start = chunk * kChunk;
            const count = Math.min(end * kChunk, this.data.length) - start;
            if (attribute instanceof StreamedAttribute) attribute.send(start, count);
            else attribute.addUpdateRange(start, count);
            // A wireframe is made anew.
            attribute.needsUpdate = true;
            chunk = end;
        }
        return bytes;
    }

    clean(side: 0 | 1) { return this.dirty[side].indexOf(1) < 0; }
}

/** Elements written between two looks at the clock. */
const kPiece = 64 * 1024;

/** Applies a patch to arrays piece by piece, so that a large one takes several frames. */
export class PatchCursor {
    private array = 0;
    private range = 0;
    /** Elements of `range` that are written. */
    private within = 0;
    private taken = 0;

    constructor(private readonly patches: ArrayPatch[], private readonly find: (patch: ArrayPatch) => LiveArray | undefined) {}

    /** True when all is applied; false when the time is over. */
    run(until: number): boolean {
        let written = 0;
        for (; this.array < this.patches.length; ++this.array, this.range = this.within = this.taken = 0) {
            const { ranges, data } = this.patches[this.array];
            const target = this.find(this.patches[this.array]);
            while (target && this.range < ranges.length) {
                if (written >= kPiece) {
                    if (performance.now() > until) return false;
                    written = 0;
                }
                const size = Math.min(ranges[this.range + 1] - this.within, kPiece);
                target.write(ranges[this.range] + this.within, data.subarray(this.taken, this.taken + size));
                this.taken += size;
                this.within += size;
                // A range costs, however short it is.
                written += size + 64;
                if (this.within < ranges[this.range + 1]) continue;
                this.range += 2;
                this.within = 0;
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
