// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Bytes of a file, in order from any offset, from a server that may break off, ignore ranges, or lie.
import { VsplitError } from './errors.js';

export interface ReaderOptions {
    /** Bytes a second that are let through; 0 for all. May be changed at any time. */
    bytesPerSecond: number;
    /** Without a byte for so long, a connection counts as broken, in milliseconds. */
    stallTime: number;
    /** Attempts in a row that bring no byte before it gives up; three times as many where the server answered, and then broke off. */
    attempts: number;
    /** The wait before the second attempt, in milliseconds; doubles with each, up to the eightfold. */
    retryDelay: number;
    /** Sent with each request. */
    headers: Record<string, string>;
    /** Cookies and the like, as for fetch(). */
    credentials: RequestCredentials;
    /** Told of each attempt after the first. */
    onRetry: (attempt: number, reason: string) => void;
}

export const readerDefaults: ReaderOptions = {
    bytesPerSecond: 0,
    stallTime: 20_000,
    attempts: 6,
    retryDelay: 400,
    headers: {},
    credentials: 'same-origin',
    onRetry: () => {},
};

/** Without any length, the file ends where so many answers end. */
const kEnds = 3;
/** After a break so many bytes are asked for, and half as many after each further one: a browser throws away what it had not yet handed on. */
const kBytesAfterBreak = 32 * 1024, kLeastBytes = 2048;

/** Called with each piece; false when no more is wanted. */
export type Sink = (bytes: Uint8Array) => boolean | Promise<boolean>;

export interface ByteReader {
    /** The file's length, once it is known. */
    readonly size: number | undefined;
    /** Bytes that came over the wire so far, whatever for. */
    readonly received: number;
    /**
     * Gives bytes `begin` to `end` (excluded), or to the file's end, in order. Comes back when all were given, the
     * sink wants no more, or the signal is aborted. Fewer bytes than that mean that the file ends there.
     */
    read(begin: number, end: number, sink: Sink, signal: AbortSignal, fresh?: boolean): Promise<number>;
}

const pause = (milliseconds: number, signal: AbortSignal) => new Promise<void>((resolve) => {
    if (signal.aborted) return resolve();
    const timer = setTimeout(done, milliseconds);
    function done() {
        clearTimeout(timer);
        signal.removeEventListener('abort', done);
        resolve();
    }
    signal.addEventListener('abort', done);
});

/** Lets bytes through at a rate, in pieces that keep a slow rate smooth. */
async function* throttled(bytes: Uint8Array, options: ReaderOptions, signal: AbortSignal) {
    for (let at = 0; at < bytes.length && !signal.aborted;) {
        const rate = options.bytesPerSecond;
        const piece = rate > 0 ? Math.max(1024, Math.floor(rate / 20)) : bytes.length;
        const part = bytes.subarray(at, at + piece);
        if (rate > 0) await pause((1000 * part.length) / rate, signal);
        at += part.length;
        yield part;
    }
}

/** A file that the user chose, or bytes in memory. */
export class BlobReader implements ByteReader {
    received = 0;
    constructor(private readonly blob: Blob, private readonly options: ReaderOptions) {}
    get size() { return this.blob.size; }

    async read(begin: number, end: number, sink: Sink, signal: AbortSignal): Promise<number> {
        const step = 256 * 1024;
        end = Math.min(end, this.blob.size);
        let at = begin;
        while (at < end && !signal.aborted) {
            let bytes: Uint8Array;
            try {
                bytes = new Uint8Array(await this.blob.slice(at, Math.min(end, at + step)).arrayBuffer());
            } catch (error) {
                throw new VsplitError('network', `The file cannot be read any more: ${(error as Error).message}`);
            }
            for await (const part of throttled(bytes, this.options, signal)) {
                this.received += part.length;
                at += part.length;
                if (!await sink(part)) return at - begin;
            }
        }
        return at - begin;
    }
}

/** Where a 206 says that its bytes begin and how long the file is; nothing if it does not say, or may not (CORS). */
function contentRange(response: Response): { first: number; size?: number } | undefined {
    const match = /^bytes (\d+)-(\d+)\/(\d+|\*)$/.exec(response.headers.get('Content-Range') ?? '');
    return match ? { first: Number(match[1]), size: match[3] === '*' ? undefined : Number(match[3]) } : undefined;
}

interface Judged {
    skip: number;
    /** Ranges are ignored: it is all of the file. */
    whole: boolean;
    /** Takes over what the headers say. */
    believe(): void;
}

/** Any HTTP server. */
export class HttpReader implements ByteReader {
    size: number | undefined;
    received = 0;
    /** False once the server answered a range with the whole file. */
    ranges = true;
    private tag: string | null = null;
    /** The last attempt had an answer that could have been right. */
    private answered = false;
    /** And it said how long it is: then the browser sees to it that it is. */
    private announced = false;

    constructor(readonly url: string, private readonly options: ReaderOptions) {}

    async read(begin: number, end: number, sink: Sink, signal: AbortSignal, fresh = false): Promise<number> {
        let at = begin;
        let failures = 0, silent = 0, ends = 0;
        let satisfied = false;
        const take = async (bytes: Uint8Array) => {
            for await (const part of throttled(bytes, this.options, signal)) {
                at += part.length;
                failures = ends = 0;
                if (!await sink(part)) return (satisfied = true), false;
            }
            return at < end;
        };
        while (at < end && !satisfied && !signal.aborted && !(this.size !== undefined && at >= this.size)) {
            const asked = failures === 0 || !this.ranges ? end : Math.min(end, at + Math.max(kLeastBytes, kBytesAfterBreak >> (failures - 1)));
            this.answered = this.announced = false;
            try {
                await this.attempt(at, asked, end, take, signal, fresh);
                // A body that ends before its time is a broken connection, too. If nobody said how long the file is, it may end there.
                if (at < asked && !satisfied && !signal.aborted) {
                    if (this.size === undefined && (this.announced || ++ends >= kEnds)) break;
                    if (this.size === undefined || at < this.size) throw new TypeError('the connection ended too early');
                }
            } catch (error) {
                if (signal.aborted) break;
                if (error instanceof VsplitError) throw error;
                const reason = (error as Error).message || String(error);
                failures++;
                silent = this.answered ? 0 : silent + 1;
                if (silent >= this.options.attempts || failures >= 3 * this.options.attempts)
                    throw new VsplitError('network', at > 0 || this.received > 0
                        ? `The connection broke ${failures} times in a row (${reason}). ${at} bytes of the file had arrived.`
                        : `The server cannot be reached (${reason}). It may be down, not allow pages of other origins (CORS), or redirect in circles.`);
                this.options.onRetry(failures, reason);
                await pause(this.options.retryDelay * 2 ** Math.min(failures - 1, 3), signal);
            }
        }
        return at - begin;
    }

    /** One request from `at` on. Throws VsplitError for what will not get better by asking again. */
    private async attempt(at: number, asked: number, end: number, take: (bytes: Uint8Array) => Promise<boolean>, signal: AbortSignal, fresh: boolean) {
        const stop = new AbortController();
        const abort = () => stop.abort();
        signal.addEventListener('abort', abort);
        let timer = setTimeout(abort, this.options.stallTime);
        const rest = () => clearTimeout(timer);
        const wait = () => {
            rest();
            timer = setTimeout(abort, this.options.stallTime);
        };
        try {
            const response = await fetch(this.url, {
                // A simple Range needs no preflight; an If-Range would.
                headers: { ...this.options.headers, Range: Number.isFinite(asked) ? `bytes=${at}-${asked - 1}` : `bytes=${at}-` },
                credentials: this.options.credentials,
                cache: fresh ? 'no-store' : 'default',
                signal: stop.signal,
            });
            const judged = this.judge(response, at);
            if (!judged || !response.body) return;
            this.answered = true;
            this.announced = Boolean(response.headers.get('Content-Length'));
            const body = response.body.getReader();
            try {
                // Where ranges are ignored all comes at once.
                await this.drain(body, judged, (judged.whole ? end : asked) - at, take, wait, rest);
            } finally {
                body.cancel().catch(() => {});
            }
        } catch (error) {
            if (stop.signal.aborted && !signal.aborted) throw new TypeError('no bytes for a long time');
            throw error;
        } finally {
            rest();
            signal.removeEventListener('abort', abort);
            stop.abort();
        }
    }

    /**
     * How many bytes of the body come before those asked for; undefined if the file ends before them. A browser takes headers that were
     * cut off for whole ones: what they say is believed with the first byte that comes after them.
     */
    private judge(response: Response, at: number): Judged | undefined {
        const status = `${response.status}${response.statusText ? ` ${response.statusText}` : ''}`;
        if (response.status === 416) {
            const size = /^bytes \*\/(\d+)$/.exec(response.headers.get('Content-Range') ?? '');
            this.size = size ? Number(size[1]) : at;
            return undefined;
        }
        if (response.status < 200 || response.status >= 500 || response.status === 408 || response.status === 429)
            throw new TypeError(`the server answered ${status}`);
        if (!response.ok) throw new VsplitError('http', `The server answered ${status} for ${response.url || this.url}.`);
        const whole = response.status !== 206;
        const believe = () => {
            const tag = response.headers.get('ETag');
            if (tag && this.tag && tag !== this.tag) throw new VsplitError('server', 'The file has changed on the server while it was read. Load it again.');
            this.tag ??= tag;
            this.ranges = !whole;
            if (whole) {
                const length = response.headers.get('Content-Length');
                if (length && !response.headers.get('Content-Encoding')) this.learn(Number(length));
                return;
            }
            const range = contentRange(response);
            if (range && range.first !== at) throw new VsplitError('server', `The server was asked for bytes from ${at} on, and sent those from ${range.first} on.`);
            if (range?.size !== undefined) this.learn(range.size);
        };
        // Of the whole file, what comes before is read again, and thrown away.
        return { skip: whole ? at : 0, whole, believe };
    }

    private learn(size: number) {
        if (!Number.isSafeInteger(size) || size < 0) return;
        if (this.size !== undefined && this.size !== size) throw new VsplitError('server', `The server said first that the file has ${this.size} bytes, and now ${size}.`);
        this.size = size;
    }

    /** The clock runs only while the server is waited for, not while its bytes are throttled or decoded. */
    private async drain(body: ReadableStreamDefaultReader<Uint8Array>, { skip, believe }: Judged, wanted: number, take: (bytes: Uint8Array) => Promise<boolean>, wait: () => void, rest: () => void) {
        while (wanted > 0) {
            wait();
            const { done, value } = await body.read();
            rest();
            if (done) return;
            if (value.length > 0) believe();
            this.received += value.length;
            const over = Math.min(skip, value.length);
            skip -= over;
            // More than was asked for, perhaps without end: the rest is not read.
            const bytes = value.subarray(over, over + wanted);
            wanted -= bytes.length;
            if (bytes.length > 0 && !await take(bytes)) return;
        }
    }
}
