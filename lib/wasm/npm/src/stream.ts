// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The library itself, without network and without a worker: bytes of a .pmesh in, meshes of any level out.
import { VsplitError, type VsplitErrorCode } from './errors.js';
import type { ArrayPatch, Level, MeshPatch, StreamInfo, Target } from './messages.js';

/** In the order of vsplit::ErrorCode. */
const kCodes: VsplitErrorCode[] = ['network', 'unsupported', 'truncated', 'malformed', 'checksum', 'limit', 'argument', 'argument', 'cancelled'];
/** As in module.cpp. */
const kReached = 1, kWantsBytes = 2, kChanged = 4, kMore = 8;
/** Counts of the module's are of 32 bits. */
const kMost = 0xffffffff, kAll = 0x7fffffff;

interface Exports {
    memory: WebAssembly.Memory;
    _initialize(): void;
    vsplit_allocate(bytes: number): number;
    vsplit_free(at: number): void;
    vsplit_open(maxBytes: number, normals: number): void;
    vsplit_feed(offset: number, at: number, size: number): number;
    vsplit_set_file_size(bytes: number): number;
    vsplit_failure(): number;
    vsplit_failure_offset(): number;
    vsplit_set_target(kind: number, value: number, maxTriangles: number): void;
    vsplit_wants(mostBytes: number, ahead: number): number;
    vsplit_wanted(): number;
    vsplit_ready(): number;
    vsplit_broken(): number;
    vsplit_received(): number;
    vsplit_info(what: number): number;
    vsplit_block(block: number, what: number): number;
    vsplit_attribute_name(attribute: number): number;
    vsplit_attribute_components(attribute: number): number;
    vsplit_blocks(): number;
    vsplit_set_scale(group: number, scale: number): void;
    vsplit_update(mostSplits: number, mostBlocks: number): number;
    vsplit_level_vertices(): number;
    vsplit_level_triangles(): number;
    vsplit_level_error(): number;
    vsplit_patch(): void;
    vsplit_patch_vertices(array: number): number;
    vsplit_patch_group(group: number): number;
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

export interface ByteRange { offset: number; size: number }

export interface Bounds {
    /** Splits applied or undone, at most. */
    maxSplits?: number;
    /** Blocks decoded, at most. */
    maxBlocks?: number;
}

export interface Updated {
    /** The target's level is there. */
    reached: boolean;
    /** More of the file is needed before it can be. */
    wantsBytes: boolean;
    /** The mesh is another one than before. */
    changed: boolean;
    /** The bounds ended it: there is more to do with what is there. */
    more: boolean;
}

/**
 * One progressive mesh: vsplit::Stream (lib/include/vsplit/stream.hpp). Fetch what wants() names, feed() it, update(), and draw what patch() gives.
 * Bytes come from anywhere in the file, in pieces of any size and any order. An error leaves the mesh as it was; after 'checksum' what was
 * damaged is wanted again.
 */
export class VsplitStream {
    /** There once enough of the file was fed to draw something. */
    info?: StreamInfo;
    private readonly wasm: Exports;
    private readonly normals: boolean;
    private size?: number;

    constructor(module: WebAssembly.Module, options: StreamOptions = {}) {
        this.normals = options.normals ?? true;
        const imports: WebAssembly.Imports = {};
        for (const { module: from, name } of WebAssembly.Module.imports(module))
            (imports[from] ??= {})[name] = name === 'proc_exit' ? () => { throw new VsplitError('memory', 'The browser gives no more memory.'); } : () => 0;
        this.wasm = new WebAssembly.Instance(module, imports).exports as unknown as Exports;
        if (!this.wasm.memory) throw new VsplitError('argument', 'This is not vsplit.wasm.');
        this.wasm._initialize();
        this.wasm.vsplit_open(options.maxBytes ?? 2 ** 30, this.normals ? 1 : 0);
    }

    /** Blocks that are decoded. */
    get blocks() { return this.info ? this.wasm.vsplit_blocks() : 0; }
    get availableTriangles() {
        if (!this.info) return 0;
        return this.blocks > 0 ? this.info.blocks[this.blocks - 1].triangles : this.info.baseTriangles;
    }
    /** All blocks are decoded. */
    get complete() { return this.info !== undefined && this.blocks === this.info.blocks.length; }
    /** Nothing more will come of it; what was decoded stays. */
    get broken() { return this.wasm.vsplit_broken() !== 0; }
    get level(): Level {
        return { vertices: this.wasm.vsplit_level_vertices(), triangles: this.wasm.vsplit_level_triangles(), error: this.wasm.vsplit_level_error() };
    }
    /** Where the first byte is that has not come, whether the target needs it or not; the file's length if all have. */
    get fed(): number { return this.wants(1, kAll)[0]?.offset ?? this.info?.bytes ?? 0; }

    /** Where the mesh is to go; { ratio: 1 } at first. */
    setTarget(target: Target) {
        const [kind, value] = 'ratio' in target ? [0, target.ratio] : 'triangles' in target ? [1, target.triangles] : 'vertices' in target ? [2, target.vertices]
            : 'error' in target ? [3, target.error] : [4, target.pixels];
        this.wasm.vsplit_set_target(kind, value, target.maxTriangles ?? kAll);
    }

    /** The bytes of the file that the target needs next, in the order in which they help; of `ahead` more blocks, too. */
    wants(mostBytes = Number.MAX_SAFE_INTEGER, ahead = 0): ByteRange[] {
        const count = this.wasm.vsplit_wants(mostBytes, ahead);
        const numbers = new Float64Array(this.wasm.memory.buffer, this.wasm.vsplit_wanted() >>> 0, 2 * count);
        return Array.from({ length: count }, (_, i) => ({ offset: numbers[2 * i], size: numbers[2 * i + 1] }));
    }

    /** Up to where in the file the target needs bytes, whether they are there or not. A little, while nothing is known. */
    needed(target: Target): number {
        if (!this.info) return this.wants()[0]?.offset + this.wants()[0]?.size || 0;
        const { blocks, baseError } = this.info;
        const error = 'error' in target ? target.error : 'pixels' in target ? target.pixels : undefined;
        const front = this.wasm.vsplit_info(17);
        if (error !== undefined && baseError <= error) return front;
        const triangles = 'ratio' in target ? Math.round(Math.min(1, Math.max(0, target.ratio)) * this.info.triangles) : 'triangles' in target ? target.triangles : 0;
        const most = target.maxTriangles ?? Infinity;
        const enough = blocks.find((at) => at.triangles > most || (error !== undefined ? at.error <= error : 'vertices' in target ? at.vertices > target.vertices : at.triangles > triangles));
        return (enough ?? blocks.at(-1))?.end ?? front;
    }

    /** Bytes of the file, from `offset` on. Does not decode blocks, but the base mesh once the front is complete. */
    feed(offset: number, bytes: Uint8Array) {
        this.guarded(() => {
            if (bytes.length === 0) return;
            const at = this.wasm.vsplit_allocate(bytes.length);
            if (at === 0) throw new VsplitError('memory', 'The browser gives no more memory.');
            new Uint8Array(this.wasm.memory.buffer).set(bytes, at >>> 0);
            let code: number;
            try {
                code = this.wasm.vsplit_feed(offset, at, bytes.length);
            } finally {
                this.wasm.vsplit_free(at);
            }
            if (!this.info && this.wasm.vsplit_ready()) this.begin();
            if (code >= 0) this.fail(code);
        });
    }

    /** The file has so many bytes, a server says, or ended there. An error if that contradicts what it announces. */
    end(size: number) {
        if (this.info && size < this.info.bytes) throw new VsplitError('truncated', `The file ends after ${size} bytes, but announces ${this.info.bytes}.`, size);
        this.size = size;
        const code = this.wasm.vsplit_set_file_size(size);
        if (code >= 0) this.fail(code);
        if (!this.info && this.fed >= size) throw new VsplitError('truncated', 'The file ends before its base mesh is complete.', size);
    }

    /** Positions of vertices of this group's triangles come out times `scale`. At once after `info` is there. */
    setScale(group: number, scale: number) { this.wasm.vsplit_set_scale(group, scale); }

    /** Decodes what the target needs, then refines or coarsens towards it. */
    update({ maxSplits = kMost, maxBlocks = kMost }: Bounds = {}): Updated {
        return this.guarded(() => {
            const flags = this.info ? this.wasm.vsplit_update(maxSplits, maxBlocks) : kWantsBytes;
            if (flags < 0) this.fail(-2 - flags);
            return { reached: (flags & kReached) !== 0, wantsBytes: (flags & kWantsBytes) !== 0, changed: (flags & kChanged) !== 0, more: (flags & kMore) !== 0 };
        });
    }

    /** What changed since the last one. Its arrays are copies. */
    patch(): MeshPatch {
        return this.guarded(() => {
            const arrays: ArrayPatch[] = [];
            const info = this.info!;
            const named = info.attributes.some((a) => a.name === 'NORMAL');
            this.wasm.vsplit_patch();
            this.take(arrays, { array: 'position' }, () => this.wasm.vsplit_patch_vertices(0), Float32Array);
            if (info.hasWeights) this.take(arrays, { array: 'weight' }, () => this.wasm.vsplit_patch_vertices(1), Float32Array);
            if (this.normals && !named) this.take(arrays, { array: 'normal' }, () => this.wasm.vsplit_patch_vertices(2), Int16Array);
            info.attributes.forEach((attribute, i) => this.take(arrays, { array: attribute.name }, () => this.wasm.vsplit_patch_vertices(3 + i), Float32Array));
            for (const array of arrays) if (array.array === 'WEIGHTS_0') sumToOne(array.data);
            const counts: number[] = [];
            for (let group = 0; group < info.groups; ++group) {
                counts.push(this.wasm.vsplit_group_triangles(group));
                this.take(arrays, { array: 'index', group }, () => this.wasm.vsplit_patch_group(group), Uint32Array);
            }
            return { level: this.level, counts, arrays };
        });
    }

    private take(arrays: ArrayPatch[], which: { array: string; group?: number }, pack: () => number, Type: { new(buffer: ArrayBufferLike): any }) {
        const bytes = pack();
        if (bytes === 0) return;
        const { buffer } = this.wasm.memory;
        const ranges = this.wasm.vsplit_ranges() >>> 0, at = this.wasm.vsplit_data() >>> 0;
        arrays.push({ ...which, ranges: new Uint32Array(buffer.slice(ranges, ranges + 4 * this.wasm.vsplit_range_count())), data: new Type(buffer.slice(at, at + bytes)) });
    }

    private begin() {
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
        if (this.size !== undefined) this.end(this.size);
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
