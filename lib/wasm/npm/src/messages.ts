// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// What the page and the worker say to each other.
import type { VsplitErrorCode } from './errors.js';

/**
 * How fine the mesh is to be. Ratio, triangles and vertices: the finest level with at most so many. An error is in the object's own units: the
 * coarsest level with at most that. `pixels` is one that spans so many on the screen (VsplitModel.errorForPixels()): the same, but small changes
 * are not followed. With `maxTriangles` never more than so many, whatever else is asked: { pixels, maxTriangles } is an error on the screen and what
 * the machine can draw, in one.
 */
export type Target = ({ ratio: number } | { triangles: number } | { vertices: number } | { error: number } | { pixels: number }) & { maxTriangles?: number };

export interface AttributeInfo {
    /** As in glTF: NORMAL, TEXCOORD_0, ... */
    name: string;
    components: number;
}

/** What the front of the file says. */
export interface StreamInfo {
    vertices: number;
    triangles: number;
    baseVertices: number;
    baseTriangles: number;
    /** Bytes of the .pmesh. */
    bytes: number;
    boundsMin: [number, number, number];
    boundsMax: [number, number, number];
    lossless: boolean;
    hasWeights: boolean;
    /** Groups (materials) are 0 to this - 1. */
    groups: number;
    attributes: AttributeInfo[];
    baseError: number;
    /** Per block: where in the file it ends, and what the mesh has after it. */
    blocks: { end: number; vertices: number; triangles: number; error: number }[];
}

export interface Level {
    vertices: number;
    triangles: number;
    error: number;
}

/** New contents of stretches of one array. `ranges` are pairs: first element (not vertex), number of elements; `data` has them in a row. */
export interface ArrayPatch {
    /** 'position', 'normal', 'weight', an attribute's name, or 'index' of `group`. */
    array: string;
    group?: number;
    ranges: Uint32Array;
    data: Float32Array | Uint32Array | Int16Array;
}

/** From one whole mesh to another: all of it, or nothing of it, is to be drawn. */
export interface MeshPatch {
    level: Level;
    /** Triangles per group. */
    counts: number[];
    arrays: ArrayPatch[];
}

export interface Progress {
    /** Over the wire, for whatever. */
    received: number;
    /** Of the file, in a row from its front. */
    fed: number;
    /** Of the file, that the target needs. */
    needed: number;
    fileBytes?: number;
    /** Triangles that what has arrived can show. */
    availableTriangles: number;
    ranges: boolean;
    /** Nothing is on its way, and the target is reached. */
    idle: boolean;
    retry?: { attempt: number; reason: string };
}

export interface OpenOptions {
    bytesPerSecond?: number;
    headers?: Record<string, string>;
    credentials?: RequestCredentials;
    attempts?: number;
    retryDelay?: number;
    stallTime?: number;
    /** Smooth normals where the file has none. */
    normals?: boolean;
    /** Splits between two patches, at most. */
    splitsPerPatch?: number;
    /** Memory that a file may ask for. */
    maxBytes?: number;
}

export type ToWorker =
    | { type: 'open'; source: string | Blob; wasm: string; options: OpenOptions; target: Target }
    | { type: 'target'; target: Target }
    | { type: 'throttle'; bytesPerSecond: number }
    | { type: 'taken' }
    | { type: 'again' }
    | { type: 'close' };

export type FromWorker =
    | { type: 'scene'; bytes: Uint8Array }
    | { type: 'info'; info: StreamInfo }
    | { type: 'patch'; patch: MeshPatch }
    | { type: 'progress'; progress: Progress }
    | { type: 'error'; code: VsplitErrorCode; message: string; offset?: number };
