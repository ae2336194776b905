// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The page's end of a worker that fetches, decodes and refines.
import { VsplitError } from './errors.js';
import type { FromWorker, MeshPatch, OpenOptions, Progress, StreamInfo, Target, ToWorker } from './messages.js';

export interface SessionHandlers {
    /** The scene around the stream: the bytes of the GLB before it. Before onInfo; not called for a .pmesh. */
    onScene?(bytes: Uint8Array): void;
    onInfo?(info: StreamInfo): void;
    /** To be taken in this order; call session.taken() for each once it is done, or no more come. */
    onPatch?(patch: MeshPatch): void;
    onProgress?(progress: Progress): void;
    /** What was shown stays valid. again() takes up where it ended. */
    onError?(error: VsplitError): void;
}

export interface SessionOptions extends OpenOptions {
    target?: Target;
    /** Where the worker's script and the module are, if not beside this one. */
    workerUrl?: string | URL;
    wasmUrl?: string | URL;
}

export class VsplitSession {
    private readonly worker: Worker;

    constructor(source: string | URL | Blob, private readonly handlers: SessionHandlers, options: SessionOptions = {}) {
        const { target, workerUrl, wasmUrl, ...open } = options;
        this.worker = workerUrl
            ? new Worker(workerUrl, { type: 'module' })
            : new Worker(new URL('./worker.js', import.meta.url), { type: 'module' });
        this.worker.onmessage = ({ data }: MessageEvent<FromWorker>) => this.receive(data);
        this.worker.onerror = (event) => {
            event.preventDefault();
            this.handlers.onError?.(new VsplitError('network', `The worker cannot be started or has failed${event.message ? `: ${event.message}` : ''}.`));
        };
        this.send({
            type: 'open',
            source: source instanceof Blob ? source : new URL(source, globalThis.document?.baseURI).href,
            wasm: String(wasmUrl ?? new URL('./vsplit.wasm', import.meta.url)),
            options: open,
            target: target ?? { ratio: 1 },
        });
    }

    /** Where the mesh is to go from where it is. */
    setTarget(target: Target) { this.send({ type: 'target', target }); }
    setThrottle(bytesPerSecond: number) { this.send({ type: 'throttle', bytesPerSecond }); }
    taken() { this.send({ type: 'taken' }); }
    /** After an error: tries what failed again. */
    again() { this.send({ type: 'again' }); }
    close() { this.worker.terminate(); }

    private send(message: ToWorker) { this.worker.postMessage(message); }

    private receive(message: FromWorker) {
        switch (message.type) {
            case 'scene': return this.handlers.onScene?.(message.bytes);
            case 'info': return this.handlers.onInfo?.(message.info);
            case 'patch': return this.handlers.onPatch ? this.handlers.onPatch(message.patch) : this.taken();
            case 'progress': return this.handlers.onProgress?.(message.progress);
            case 'error': return this.handlers.onError?.(new VsplitError(message.code, message.message, message.offset));
        }
    }
}
