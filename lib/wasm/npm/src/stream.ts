// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The library itself, without network and without a worker: bytes of a .pmesh in, meshes of any level out.
import { VsplitError, type VsplitErrorCode } from './errors.js';
import type { ArrayPatch, Level, MeshPatch, StreamInfo, Target } from './messages.js';

/** In the order of vsplit::ErrorCode. */
const kCodes: VsplitErrorCode[] = ['network', 'unsupported', 'truncated', 'malformed', 'checksum', 'limit', 'argument', 'argument', 'cancelled'];
const kTruncated = 2;
const kFirstTry = 4096;

interface Exports {
    memory: WebAssembly.Memory;
    _initialize(): void;
    vsplit_allocate(bytes: number): number;
    vsplit_free(at: number): void;
    vsplit_begin(at: number, size: number, maxBytes: number, normals: number): number;
    vsplit_failure(): number;
    vsplit_failure_offset(): number;
    vsplit_info(what: number): number;
    vsplit_block(block: number, what: number): number;
    vsplit_attribute_name(attribute: number): number;
    vsplit_attribute_components(attribute: number): number;
    vsplit_decode(at: number, size: number): number;
    vsplit_blocks(): number;
    vsplit_set_scale(group: number, scale: number): void;
    vsplit_advance(kind: number, value: number, most: number): number;
    vsplit_level_vertices(): number;
    vsplit_level_triangles(): number;
    vsplit_level_error(): number;
    vsplit_pack_vertices(array: number): number;
    vsplit_pack_group(group: number): number;
    vsplit_group_triangles(group: number): number;
    vsplit_data(): number;
    vsplit_ranges(): number;
    vsplit_range_count(): number;
}

export interface StreamOptions {
    /** Smooth normals where the file has none. */
    normals?: boolean;
    /** Memory that the file may ask for; 1 GiB if not said. */
    maxBytes?: number;
}

/** Compiles the module once; streams made of it are independent. */
export async function compileVsplit(source: string | URL | BufferSource): Promise<WebAssembly.Module> {
    if (typeof source !== 'string' && !(source instanceof URL)) return WebAssembly.compile(source);
    const response = await fetch(source);
    if (!response.ok) throw new VsplitError('http', `vsplit.wasm: the server answered ${response.status} for ${response.url}.`);
    // Servers that do not know the type are not worth an error.
    return WebAssembly.compile(await response.arrayBuffer());
}

/** As glTF demands of joint weights. Files that do not obey are common, and the stream has what the file had. */
function sumToOne(weights: ArrayPatch['data']) {
    for (let i = 0; i + 3 < weights.length; i += 4) {
        const sum = weights[i] + weights[i + 1] + weights[i + 2] + weights[i + 3];
        if (sum > 0) for (let k = 0; k < 4; ++k) weights[i + k] /= sum;
        else weights[i] = 1;
    }
}

/**
 * One progressive mesh. Bytes are fed in the file's order in pieces of any size. An error leaves the mesh as it was; after 'checksum',
 * `fed` is where the damaged block begins, and it may be fed again.
 */
export class VsplitStream {
    /** There once enough of the file was fed. */
    info?: StreamInfo;
    /** Bytes of the file, from its front, that have been fed and are not wanted again. */
    fed = 0;
    private readonly wasm: Exports;
    private held: Uint8Array<ArrayBufferLike> = new Uint8Array(kFirstTry);
    private holds = 0;
    private nextTry = kFirstTry;
    private readonly normals: boolean;
    private readonly maxBytes: number;

    constructor(module: WebAssembly.Module, options: StreamOptions = {}) {
        this.normals = options.normals ?? true;
        this.maxBytes = options.maxBytes ?? 2 ** 30;
        let memory: WebAssembly.Memory | undefined;
        const imports: WebAssembly.Imports = {};
        for (const { module: from, name } of WebAssembly.Module.imports(module))
            (imports[from] ??= {})[name] = name === 'proc_exit' ? () => { throw new VsplitError('memory', 'The browser gives no more memory.'); } : () => 0;
        this.wasm = new WebAssembly.Instance(module, imports).exports as unknown as Exports;
        memory = this.wasm.memory;
        if (!memory) throw new VsplitError('argument', 'This is not vsplit.wasm.');
        this.wasm._initialize();
    }

    /** Blocks that are decoded. */
    get blocks() { return this.info ? this.wasm.vsplit_blocks() : 0; }
    get availableTriangles() {
        if (!this.info) return 0;
        return this.blocks > 0 ? this.info.blocks[this.blocks - 1].triangles : this.info.baseTriangles;
    }
    get complete() { return this.info !== undefined && this.blocks === this.info.blocks.length; }
    get level(): Level {
        return { vertices: this.wasm.vsplit_level_vertices(), triangles: this.wasm.vsplit_level_triangles(), error: this.wasm.vsplit_level_error() };
    }

    /** How much of the file, from its front, the target needs. A little, while nothing is known. */
    needed(target: Target): number {
        if (!this.info) return this.nextTry;
        const { blocks, baseTriangles, baseVertices, baseError } = this.info;
        const enough = (at: { triangles: number; vertices: number; error: number }) =>
            'error' in target ? at.error <= target.error
            : 'vertices' in target ? at.vertices >= target.vertices
            : at.triangles >= this.triangleTarget(target);
        if (enough({ triangles: baseTriangles, vertices: baseVertices, error: baseError })) return this.wasm.vsplit_info(17);
        return (blocks.find(enough) ?? blocks.at(-1))?.end ?? this.wasm.vsplit_info(17);
    }

    /** The next bytes of the file, which begin at `fed`. `last` if the file ends with them. */
    feed(bytes: Uint8Array, last = false) {
        this.guarded(() => {
            while (bytes.length > 0 || (last && !this.info)) {
                const wanted = this.wanted() - this.holds;
                if (wanted <= 0 && this.info) return;  // Behind the end.
                const part = bytes.subarray(0, wanted);
                this.hold(part);
                bytes = bytes.subarray(part.length);
                this.fed += part.length;
                if (this.holds < this.wanted()) {
                    if (!last || bytes.length > 0) return;
                    if (this.info) throw new VsplitError('truncated', `The file ends within block ${this.blocks}.`, this.fed);
                }
                if (this.info) this.decode();
                else bytes = this.begin(bytes, last && bytes.length === 0);
                if (!this.info && last && bytes.length === 0) return;
            }
        });
    }

    /** Positions of vertices of this group's triangles come out times `scale`. At once after `info` is there. */
    setScale(group: number, scale: number) { this.wasm.vsplit_set_scale(group, scale); }

    /** Goes towards the target by at most `most` splits, as far as bytes have come. True if there is more to do. */
    advance(target: Target, most: number): boolean {
        const [kind, value] = 'error' in target ? [2, target.error] : 'vertices' in target ? [1, target.vertices] : [0, this.triangleTarget(target)];
        return this.guarded(() => this.wasm.vsplit_advance(kind, value, most) !== 0);
    }

    /** What changed since the last one. Its arrays are copies. */
    patch(): MeshPatch {
        return this.guarded(() => {
            const arrays: ArrayPatch[] = [];
            const info = this.info!;
            const named = info.attributes.some((a) => a.name === 'NORMAL');
            this.take(arrays, { array: 'position' }, () => this.wasm.vsplit_pack_vertices(0), Float32Array);
            if (info.hasWeights) this.take(arrays, { array: 'weight' }, () => this.wasm.vsplit_pack_vertices(1), Float32Array);
            if (this.normals && !named) this.take(arrays, { array: 'normal' }, () => this.wasm.vsplit_pack_vertices(2), Int16Array);
            info.attributes.forEach((attribute, i) => this.take(arrays, { array: attribute.name }, () => this.wasm.vsplit_pack_vertices(3 + i), Float32Array));
            for (const array of arrays) if (array.array === 'WEIGHTS_0') sumToOne(array.data);
            const counts: number[] = [];
            for (let group = 0; group < info.groups; ++group) {
                counts.push(this.wasm.vsplit_group_triangles(group));
                this.take(arrays, { array: 'index', group }, () => this.wasm.vsplit_pack_group(group), Uint32Array);
            }
            return { level: this.level, counts, arrays };
        });
    }

    private triangleTarget(target: { ratio: number } | { triangles: number }): number {
        return 'ratio' in target ? Math.round(Math.min(1, Math.max(0, target.ratio)) * this.info!.triangles) : target.triangles;
    }

    private take(arrays: ArrayPatch[], which: { array: string; group?: number }, pack: () => number, Type: { new(buffer: ArrayBufferLike): any }) {
        const bytes = pack();
        if (bytes === 0) return;
        const { buffer } = this.wasm.memory;
        const ranges = this.wasm.vsplit_ranges(), at = this.wasm.vsplit_data();
        arrays.push({ ...which, ranges: new Uint32Array(buffer.slice(ranges, ranges + 4 * this.wasm.vsplit_range_count())), data: new Type(buffer.slice(at, at + bytes)) });
    }

    /** Of the bytes held, how many have to be there before something can be done with them. */
    private wanted(): number {
        if (!this.info) return this.nextTry;
        const block = this.blocks;
        return block < this.info.blocks.length ? this.wasm.vsplit_block(block, 1) : 0;
    }

    private hold(bytes: Uint8Array) {
        const size = this.holds + bytes.length;
        if (size > this.held.length) {
            const grown = new Uint8Array(Math.max(size, 2 * this.held.length));
            grown.set(this.held.subarray(0, this.holds));
            this.held = grown;
        }
        this.held.set(bytes, this.holds);
        this.holds = size;
    }

    /** Calls with the bytes held in the module's memory. */
    private with(use: (at: number, size: number) => number): number {
        const at = this.wasm.vsplit_allocate(Math.max(1, this.holds));
        if (at === 0) throw new VsplitError('memory', 'The browser gives no more memory.');
        new Uint8Array(this.wasm.memory.buffer).set(this.held.subarray(0, this.holds), at >>> 0);
        try {
            return use(at, this.holds);
        } finally {
            this.wasm.vsplit_free(at);
        }
    }

    /** Returns what is to be fed again. */
    private begin(rest: Uint8Array, last: boolean): Uint8Array {
        const code = this.with((at, size) => this.wasm.vsplit_begin(at, size, this.maxBytes, this.normals ? 1 : 0));
        if (code === kTruncated && !last) {
            this.nextTry *= 2;
            return rest;
        }
        if (code >= 0) this.fail(code);
        const w = this.wasm;
        const number = (what: number) => w.vsplit_info(what);
        const attributes = [];
        for (let i = 0; i < number(15); ++i) attributes.push({ name: this.text(w.vsplit_attribute_name(i)), components: w.vsplit_attribute_components(i) });
        const blocks = [];
        for (let i = 0; i < number(16); ++i)
            blocks.push({ end: w.vsplit_block(i, 0) + w.vsplit_block(i, 1), vertices: w.vsplit_block(i, 2), triangles: w.vsplit_block(i, 3), error: w.vsplit_block(i, 4) });
        this.info = {
            vertices: number(0), triangles: number(1), baseVertices: number(2), baseTriangles: number(3), bytes: number(4),
            boundsMin: [number(5), number(6), number(7)], boundsMax: [number(8), number(9), number(10)], lossless: number(11) !== 0, hasWeights: number(12) !== 0,
            groups: number(13), attributes, baseError: number(14), blocks,
        };
        // What was held behind the front belongs to blocks.
        const over = this.held.slice(number(17), this.holds);
        this.fed = number(17);
        this.holds = 0;
        const joined = new Uint8Array(over.length + rest.length);
        joined.set(over);
        joined.set(rest, over.length);
        return joined;
    }

    private decode() {
        const begin = this.fed - this.holds;
        const code = this.with((at, size) => this.wasm.vsplit_decode(at, size));
        this.holds = 0;
        if (code < 0) return;
        this.fed = begin;
        this.fail(code);
    }

    private fail(code: number): never {
        const offset = this.wasm.vsplit_failure_offset();
        throw new VsplitError(kCodes[code] ?? 'malformed', this.text(this.wasm.vsplit_failure()), offset < 0 ? undefined : offset);
    }

    private text(at: number): string {
        const bytes = new Uint8Array(this.wasm.memory.buffer, at >>> 0);
        return new TextDecoder().decode(bytes.slice(0, bytes.indexOf(0)));
    }

    private guarded<T>(run: () => T): T {
        try {
            return run();
        } catch (error) {
            // A trap: memory that could not be had, most likely. The instance is of no use any more.
            if (error instanceof WebAssembly.RuntimeError || error instanceof RangeError)
                throw new VsplitError('memory', `The mesh does not fit into the memory that the browser gives (${(error as Error).message}).`);
            throw error;
        }
    }
}
