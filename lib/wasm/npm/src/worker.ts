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
/** Decoding in a row before messages are looked at, in milliseconds. */
const kTurn = 25;
/** While blocks are still to be decoded a patch waits for so many more triangles, or so many milliseconds. */
const kGrowth = 1.3, kPatchEvery = 150;

const post = (message: FromWorker, transfer: Transferable[] = []) => (self as unknown as { postMessage(m: unknown, t: Transferable[]): void }).postMessage(message, transfer);

class Session {
    private readonly reader: ByteReader;
    private readonly settings: ReaderOptions;
    private stream!: VsplitStream;
    /** Where the stream begins in the file. */
    private start = 0;
    private front = new Uint8Array(0);
    private onTheirWay = 0;
    private patched = 0;
    private patchedTriangles = 0;
    private fetching?: AbortController;
    private wake?: () => void;
    private failed = false;
    /** Of work beside the fetching; ends that. */
    private fault?: unknown;
    /** There is something to decode or to refine that has come. */
    private busy = false;
    /** The page knows what it is about. */
    private opened = false;
    private saidIdle = false;
    private last?: VsplitError;
    private readonly turn = new MessageChannel();
    private turning = false;
    private damaged = { block: -1, times: 0 };
    private retry?: { attempt: number; reason: string };
    private lastProgress = 0;

    constructor(source: string | Blob, private readonly wasm: string, private readonly options: OpenOptions, private target: Target) {
        this.settings = { ...readerDefaults, ...Object.fromEntries(Object.entries(options).filter(([, value]) => value !== undefined)) };
        this.settings.onRetry = (attempt, reason) => { this.retry = { attempt, reason }; this.progress(true); };
        this.turn.port1.onmessage = () => { this.turning = false; this.pump(); };
        this.reader = typeof source === 'string' ? new HttpReader(source, this.settings) : new BlobReader(source, this.settings);
    }

    async run() {
        for (;;) {
            try {
                if (!this.opened) await this.open();
                await this.follow();
            } catch (error) {
                const { opened } = this;
                if (this.refetch(error, opened)) continue;
                if (opened) this.progress(true);
                const known = error instanceof VsplitError ? error : new VsplitError('malformed', String((error as Error)?.message ?? error));
                post({ type: 'error', code: known.code, message: known.message, offset: known.offset === undefined ? undefined : known.offset + (opened ? this.start : 0) });
                this.failed = true;
                this.last = known;
                if (!opened) this.front = new Uint8Array(0);
                while (this.failed) await this.sleep();
            }
        }
    }

    setTarget(target: Target) {
        this.target = target;
        if (!this.stream) return;
        this.stream.setTarget(target);
        // What is on its way for a finer target is not needed; without ranges it could not be had again.
        if (this.stream.info && this.ranges && !this.next()) this.fetching?.abort();
        this.soon();
        this.wake?.();
    }
    setThrottle(bytesPerSecond: number) { this.settings.bytesPerSecond = bytesPerSecond; }
    taken() {
        this.onTheirWay--;
        this.soon();
    }
    again() {
        this.failed = false;
        this.damaged.times = 1;  // Past the caches.
        this.wake?.();
    }

    private get ranges() { return !(this.reader instanceof HttpReader) || this.reader.ranges; }
    private get position() { return this.start + (this.stream?.fed ?? 0); }
    /** The bytes to fetch next, in the file; nothing if the target needs none. */
    private next(): { begin: number; end: number } | undefined {
        const [first] = this.stream.wants();
        if (!first) return undefined;
        const begin = this.start + first.offset;
        if (!this.stream.info) return { begin, end: begin + Math.max(first.size, kFirstBytes) };
        return { begin, end: this.ranges ? begin + first.size : this.start + this.stream.info.bytes };
    }
    /** Lets messages through first. */
    private soon() {
        if (this.turning) return;
        this.turning = true;
        this.turn.port2.postMessage(0);
    }
    private sleep() { return new Promise<void>((resolve) => { this.wake = () => { this.wake = undefined; resolve(); }; }); }

    /** Up to the point where the stream begins. */
    private async open() {
        const module = compileVsplit(this.wasm);
        module.catch(() => {});
        await this.readFront(kFirstBytes);
        if (this.front.length === 0) throw new VsplitError('not-a-model', 'The file is empty.');
        if (isGlb(this.front)) {
            if (this.front.length < 20) throw new VsplitError('truncated', 'The GLB ends within its header.', this.front.length);
            await this.frontOf(glbFrontBytes(this.front), 'the GLB\'s JSON');
            const glb = parseGlbFront(this.front);
            if (glb.streamOffset > kMostSceneBytes) throw new VsplitError('limit', `The scene before the stream has ${glb.streamOffset} bytes.`);
            await this.frontOf(glb.streamOffset, 'the scene before the stream');
            this.start = glb.streamOffset;
            post({ type: 'scene', bytes: this.front.slice(0, glb.streamOffset) });
            await this.begin(module, glb.streamOffset);
            for (const mesh of glb.extension.meshes)
                for (const primitive of mesh.primitives) this.stream.setScale(primitive.group, 2 ** -mesh.exponent);
        } else if (isPmesh(this.front)) {
            await this.begin(module, 0);
        } else {
            const text = new TextDecoder().decode(this.front.subarray(0, 512)).trimStart();
            throw new VsplitError('not-a-model', /^<(!doctype|html|\?xml)/i.test(text)
                ? 'The server sent a web page instead of a model. Is the address right?'
                : 'This is neither a .pmesh nor a progressive GLB.', 0);
        }
        this.front = new Uint8Array(0);
        post({ type: 'info', info: this.stream.info! });
        this.opened = true;
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
    /** `at` is where in the front the stream begins. */
    private async begin(module: Promise<WebAssembly.Module>, at: number) {
        this.stream = new VsplitStream(await module, this.options);
        this.stream.setTarget(this.target);
        try {
            this.stream.feed(0, this.front.subarray(at));
        } catch (error) {
            // What is behind the front may be damaged: that is fetched again once all is set up.
            if (!this.stream.info || !this.refetch(error, true)) throw error;
        }
        for (let next = this.next(); !this.stream.info && next; next = this.next()) {
            const ended = await this.fetch(next.begin, next.end);
            if (ended !== undefined) this.stream.end(ended - this.start);
        }
    }

    /** Follows the target, for ever. */
    private async follow() {
        this.soon();
        for (;;) {
            if (this.fault) {
                const { fault } = this;
                this.fault = undefined;
                throw fault;
            }
            const next = this.next();
            if (!next) {
                if (this.stream.broken && this.last) throw this.last;
                this.progress(true);
                await this.sleep();
                continue;
            }
            const ended = await this.fetch(next.begin, next.end);
            const announced = this.start + this.stream.info!.bytes;
            if (ended !== undefined && ended < announced)
                throw new VsplitError('truncated', `The file ends after ${ended} bytes, but announces ${announced}.`, ended - this.start);
        }
    }

    /** Feeds these bytes, as long as they are wanted. Where the file ended, if it did. */
    private async fetch(begin: number, end: number): Promise<number | undefined> {
        this.fetching = new AbortController();
        const { signal } = this.fetching;
        let at = begin, enough = false;
        await this.reader.read(begin, end, (part) => {
            this.retry = undefined;
            at += part.length;
            this.stream.feed(at - part.length - this.start, part);
            this.soon();
            this.progress();
            // A target that moved nearer: the block that is on its way is still taken.
            if (this.stream.info && this.ranges) enough = this.next()?.begin !== at;
            return !enough && !this.fault;
        }, signal, this.damaged.times > 0);
        return at < end && !enough && !signal.aborted && !this.fault ? at : undefined;
    }

    /** What came damaged is fetched again, past the caches, before anybody hears of it. */
    private refetch(error: unknown, opened: boolean): boolean {
        if (!(error instanceof VsplitError) || error.code !== 'checksum') return false;
        const block = opened ? this.stream.info!.blocks.findIndex((b) => b.end > (error.offset ?? 0)) : -1;
        this.damaged = { block, times: this.damaged.block === block ? this.damaged.times + 1 : 1 };
        if (!opened) this.front = new Uint8Array(0);
        if (this.damaged.times < kFetches) return true;
        error.message = opened
            ? `Block ${block} arrived damaged ${kFetches} times (its checksum does not match). What is shown is what came before it.`
            : `The front of the file arrived damaged ${kFetches} times: ${error.message}.`;
        return false;
    }

    /** Decodes for a while, refines by a bounded amount and posts that, if the page keeps up; and again, if there is more to do. */
    private pump() {
        if (!this.opened || this.failed || this.fault) return;
        try {
            const began = performance.now();
            let decoding = true;
            while (decoding && performance.now() - began < kTurn) decoding = this.stream.update({ maxSplits: 0, maxBlocks: 1 }).more;
            let refining = false;
            const ripe = !decoding || began - this.patched > kPatchEvery || this.stream.availableTriangles > kGrowth * this.patchedTriangles;
            if (ripe && this.onTheirWay < kPatchesOnTheirWay) {
                const { changed, more } = this.stream.update({ maxSplits: this.options.splitsPerPatch ?? 128 * 1024, maxBlocks: 0 });
                refining = more;
                if (changed || this.patched === 0) this.send();
            }
            // Once the page has taken a patch there is another turn.
            this.busy = decoding || refining || this.onTheirWay >= kPatchesOnTheirWay;
            if (decoding || refining) this.soon();
            if (this.idle !== this.saidIdle) this.progress(true);
        } catch (error) {
            this.fault = error;
            this.fetching?.abort();
            this.wake?.();
        }
    }

    private send() {
        const patch: MeshPatch = this.stream.patch();
        this.patched = performance.now();
        this.patchedTriangles = patch.level.triangles;
        this.onTheirWay++;
        post({ type: 'patch', patch }, patch.arrays.flatMap((a) => [a.ranges.buffer, a.data.buffer]) as Transferable[]);
    }

    private get idle() { return this.opened && !this.next() && !this.busy && !this.turning; }

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
                availableTriangles: stream?.availableTriangles ?? 0, ranges: this.ranges, idle: this.saidIdle = this.idle, retry: this.retry,
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
