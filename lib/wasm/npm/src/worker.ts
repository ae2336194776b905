// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Fetches, decodes and refines beside the page, and posts patches to it.
import { VsplitError } from './errors.js';
import { glbFrontBytes, isGlb, isPmesh, parseGlbFront } from './glb.js';
import type { FromWorker, MeshPatch, OpenOptions, Target, ToWorker } from './messages.js';
import { BlobReader, HttpReader, readerDefaults, type ByteReader, type ReaderOptions } from './range_reader.js';
import { compileVsplit, VsplitStream } from './stream.js';

const kFirstBytes = 32 * 1024;
const kMostSceneBytes = 1024 * 1024 * 1024;
const kPatchesOnTheirWay = 2;
const kFetches = 3;

const post = (message: FromWorker, transfer: Transferable[] = []) => (self as unknown as { postMessage(m: unknown, t: Transferable[]): void }).postMessage(message, transfer);

class Session {
    private readonly reader: ByteReader;
    private readonly settings: ReaderOptions;
    private stream!: VsplitStream;
    /** Where the stream begins in the file. */
    private start = 0;
    private front = new Uint8Array(0);
    private onTheirWay = 0;
    private patched = false;
    private fetching?: AbortController;
    private wake?: () => void;
    private failed = false;
    private damaged = { block: -1, times: 0 };
    private retry?: { attempt: number; reason: string };
    private lastProgress = 0;

    constructor(source: string | Blob, private readonly wasm: string, private readonly options: OpenOptions, private target: Target) {
        this.settings = { ...readerDefaults, ...Object.fromEntries(Object.entries(options).filter(([, value]) => value !== undefined)) };
        this.settings.onRetry = (attempt, reason) => { this.retry = { attempt, reason }; this.progress(true); };
        this.reader = typeof source === 'string' ? new HttpReader(source, this.settings) : new BlobReader(source, this.settings);
    }

    async run() {
        for (let opened = false; ;) {
            try {
                if (!opened) {
                    await this.open();
                    opened = true;
                }
                await this.follow();
            } catch (error) {
                if (this.refetch(error, opened)) continue;
                if (opened) this.progress(true);
                const known = error instanceof VsplitError ? error : new VsplitError('malformed', String((error as Error)?.message ?? error));
                post({ type: 'error', code: known.code, message: known.message, offset: known.offset === undefined ? undefined : known.offset + (opened ? this.start : 0) });
                this.failed = true;
                if (!opened) this.front = new Uint8Array(0);
                while (this.failed) await this.sleep();
            }
        }
    }

    setTarget(target: Target) {
        this.target = target;
        // What is on its way for a finer target is not needed; without ranges it could not be had again.
        if (this.stream?.info && this.ranges && this.start + this.stream.needed(target) <= this.position) this.fetching?.abort();
        if (!this.failed) this.pump();
        this.wake?.();
    }
    setThrottle(bytesPerSecond: number) { this.settings.bytesPerSecond = bytesPerSecond; }
    taken() {
        this.onTheirWay--;
        this.pump();
        this.wake?.();
    }
    again() {
        this.failed = false;
        this.damaged.times = 1;  // Past the caches.
        this.wake?.();
    }

    private get ranges() { return !(this.reader instanceof HttpReader) || this.reader.ranges; }
    private get position() { return this.start + (this.stream?.fed ?? 0); }
    private sleep() { return new Promise<void>((resolve) => { this.wake = () => { this.wake = undefined; resolve(); }; }); }

    /** Up to the point where the stream begins. */
    private async open() {
        const module = compileVsplit(this.wasm);
        module.catch(() => {});
        await this.readFront(kFirstBytes);
        const whole = () => this.reader.size !== undefined && this.front.length >= this.reader.size;
        if (this.front.length === 0) throw new VsplitError('not-a-model', 'The file is empty.');
        if (isGlb(this.front)) {
            if (this.front.length < 20) throw new VsplitError('truncated', 'The GLB ends within its header.', this.front.length);
            await this.frontOf(glbFrontBytes(this.front), 'the GLB\'s JSON');
            const glb = parseGlbFront(this.front);
            if (glb.streamOffset > kMostSceneBytes) throw new VsplitError('limit', `The scene before the stream has ${glb.streamOffset} bytes.`);
            await this.frontOf(glb.streamOffset, 'the scene before the stream');
            this.start = glb.streamOffset;
            post({ type: 'scene', bytes: this.front.slice(0, glb.streamOffset) });
            this.stream = new VsplitStream(await module, this.options);
            this.feedFront(glb.streamOffset, whole());
            await this.untilInfo();
            for (const mesh of glb.extension.meshes)
                for (const primitive of mesh.primitives) this.stream.setScale(primitive.group, 2 ** -mesh.exponent);
        } else if (isPmesh(this.front)) {
            this.stream = new VsplitStream(await module, this.options);
            this.feedFront(0, whole());
            await this.untilInfo();
        } else {
            const text = new TextDecoder().decode(this.front.subarray(0, 512)).trimStart();
            throw new VsplitError('not-a-model', /^<(!doctype|html|\?xml)/i.test(text)
                ? 'The server sent a web page instead of a model. Is the address right?'
                : 'This is neither a .pmesh nor a progressive GLB.', 0);
        }
        this.front = new Uint8Array(0);
        post({ type: 'info', info: this.stream.info! });
        this.progress(true);
    }

    /** Reads on until the front has so many bytes, or the file ends. */
    private async readFront(bytes: number) {
        const parts: Uint8Array[] = [this.front];
        let have = this.front.length;
        try {
            await this.reader.read(have, bytes, (part) => { parts.push(part.slice()); have += part.length; this.retry = undefined; this.progress(); return true; }, new AbortController().signal, this.damaged.times > 0);
        } finally {
            const joined = new Uint8Array(have);
            let at = 0;
            for (const part of parts) { joined.set(part, at); at += part.length; }
            this.front = joined;
        }
    }
    private async frontOf(bytes: number, what: string) {
        if (this.front.length < bytes) await this.readFront(bytes);
        if (this.front.length < bytes) throw new VsplitError('truncated', `The file ends within ${what}.`, this.front.length);
    }
    private async untilInfo() {
        while (!this.stream.info) {
            const before = this.position;
            await this.fetchTo(before + kFirstBytes);
            if (!this.stream.info && this.position < before + kFirstBytes) {
                this.stream.feed(new Uint8Array(0), true);
                if (!this.stream.info) throw new VsplitError('truncated', 'The file ends before its base mesh is complete.', this.position);
            }
        }
    }

    /** Follows the target, for ever. */
    private async follow() {
        for (;;) {
            this.pump();
            const { info } = this.stream;
            const end = this.start + (this.ranges ? this.stream.needed(this.target) : info!.bytes);
            if (this.position >= end) {
                this.progress(true);
                await this.sleep();
                continue;
            }
            await this.fetchTo(end);
            // Fewer bytes than that, and nobody stopped it.
            if (this.position < end && !this.fetching!.signal.aborted)
                throw new VsplitError('truncated', `The file ends after ${this.position} bytes, but announces ${this.start + info!.bytes}.`, this.position - this.start);
        }
    }

    private async fetchTo(end: number) {
        this.fetching = new AbortController();
        // What is held of a block that is not whole has been fed, and is not fetched again.
        await this.reader.read(this.position, end, (part) => {
            this.retry = undefined;
            this.stream.feed(part);
            this.pump();
            this.progress();
            // A target that moved nearer: the block that is on its way is still taken.
            return !(this.ranges && this.stream.info && this.position >= this.start + this.stream.needed(this.target)) || !this.stream.info;
        }, this.fetching.signal, this.damaged.times > 0);
    }

    /** What is behind the front may be damaged: that is fetched again once all is set up. */
    private feedFront(from: number, last: boolean) {
        try {
            this.stream.feed(this.front.subarray(from), last);
        } catch (error) {
            if (!this.stream.info || !this.refetch(error, true)) throw error;
        }
    }

    /** What came damaged is fetched again, past the caches, before anybody hears of it. */
    private refetch(error: unknown, opened: boolean): boolean {
        if (!(error instanceof VsplitError) || error.code !== 'checksum') return false;
        const block = opened ? this.stream.blocks : -1;
        this.damaged = { block, times: this.damaged.block === block ? this.damaged.times + 1 : 1 };
        if (!opened) this.front = new Uint8Array(0);
        if (this.damaged.times < kFetches) return true;
        error.message = opened
            ? `Block ${block} arrived damaged ${kFetches} times (its checksum does not match). What is shown is what came before it.`
            : `The front of the file arrived damaged ${kFetches} times: ${error.message}.`;
        return false;
    }

    /** Refines by a bounded amount and posts it, if the page keeps up. */
    private pump() {
        while (this.stream?.info && this.onTheirWay < kPatchesOnTheirWay) {
            const before = this.patched ? this.stream.level.triangles : -1;
            const more = this.stream.advance(this.target, this.options.splitsPerPatch ?? 128 * 1024);
            if (this.stream.level.triangles === before && !more) return;
            const patch: MeshPatch = this.stream.patch();
            this.patched = true;
            this.onTheirWay++;
            post({ type: 'patch', patch }, patch.arrays.flatMap((a) => [a.ranges.buffer, a.data.buffer]) as Transferable[]);
            if (!more) return;
        }
    }

    private progress(now = false) {
        const time = performance.now();
        if (!now && time - this.lastProgress < 50) return;
        this.lastProgress = time;
        const stream = this.stream as VsplitStream | undefined;
        const needed = this.start + (stream?.needed(this.target) ?? kFirstBytes);
        post({
            type: 'progress',
            progress: {
                received: this.reader.received, fed: stream ? this.position : this.front.length, needed,
                fileBytes: stream?.info ? this.start + stream.info.bytes : this.reader.size,
                availableTriangles: stream?.availableTriangles ?? 0, ranges: this.ranges, idle: stream?.info !== undefined && this.position >= needed, retry: this.retry,
            },
        });
    }
}

let session: Session | undefined;
self.onmessage = ({ data }: MessageEvent<ToWorker>) => {
    switch (data.type) {
        case 'open':
            session = new Session(data.source, data.wasm, data.options, data.target);
            session.run();
            break;
        case 'target': session?.setTarget(data.target); break;
        case 'throttle': session?.setThrottle(data.bytesPerSecond); break;
        case 'taken': session?.taken(); break;
        case 'again': session?.again(); break;
        case 'close': self.close(); break;
    }
};
