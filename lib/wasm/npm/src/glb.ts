// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// A progressive GLB (formats/gltf/VSPLIT_progressive_mesh) over ranges: where its stream is, and the plain GLB before it.
import { VsplitError } from './errors.js';

export interface ProgressivePrimitive {
    group: number;
    index: number;
    shown?: number;
    attributes: { attribute: number; type: string; componentType: number; normalized?: boolean }[];
    properties?: { material?: number };
}
export interface ProgressiveMeshes {
    bufferView: number;
    radius?: number;
    unit?: number;
    attributes: { name: string; components: number }[];
    meshes: { mesh: number; exponent: number; primitives: ProgressivePrimitive[] }[];
}

export interface GlbFront {
    json: any;
    extension: ProgressiveMeshes;
    /** The stream, in the file. */
    streamOffset: number;
    streamBytes: number;
    /** Where the binary chunk's bytes begin. */
    binaryOffset: number;
}

const kMostJson = 64 * 1024 * 1024;
const malformed = (message: string, offset?: number) => new VsplitError('malformed', message, offset);

export const isGlb = (front: Uint8Array) => front.length >= 4 && front[0] === 0x67 && front[1] === 0x6c && front[2] === 0x54 && front[3] === 0x46;
export const isPmesh = (front: Uint8Array) => front.length >= 6 && front[0] === 0x8f && front[1] === 0x70 && front[2] === 0x6d && front[3] === 0x65 && front[4] === 0x73 && front[5] === 0x68;

/** How many bytes of the file parseGlbFront() needs; `front` has at least 20. */
export function glbFrontBytes(front: Uint8Array): number {
    const view = new DataView(front.buffer, front.byteOffset, front.byteLength);
    if (view.getUint32(4, true) !== 2) throw new VsplitError('unsupported', 'This GLB is not of version 2.', 4);
    if (view.getUint32(16, true) !== 0x4e4f534a) throw malformed('A GLB begins with its JSON; this one does not.', 16);
    const json = view.getUint32(12, true);
    if (json > kMostJson) throw new VsplitError('limit', `The GLB's JSON has ${json} bytes.`, 12);
    return 20 + json + 8;
}

const whole = (value: unknown, below: number) => Number.isInteger(value) && (value as number) >= 0 && (value as number) < below;

/** `front` reaches to the binary chunk's header. All that is used later is checked here. */
export function parseGlbFront(front: Uint8Array): GlbFront {
    const view = new DataView(front.buffer, front.byteOffset, front.byteLength);
    const jsonBytes = view.getUint32(12, true);
    let json: any;
    try {
        json = JSON.parse(new TextDecoder('utf-8', { fatal: true }).decode(front.subarray(20, 20 + jsonBytes)));
    } catch {
        throw malformed('The GLB\'s JSON cannot be read.', 20);
    }
    const extension: ProgressiveMeshes | undefined = json?.extensions?.VSPLIT_progressive_mesh;
    if (!extension) throw new VsplitError('unsupported', 'This GLB carries no progressive mesh: make it with `vsplit bake scene.glb -o scene.vsplit.glb`.');
    const binaryOffset = 20 + jsonBytes + 8;
    if (view.getUint32(20 + jsonBytes + 4, true) !== 0x004e4942) throw malformed('The GLB has no binary chunk behind its JSON.', 20 + jsonBytes + 4);
    const binaryBytes = view.getUint32(20 + jsonBytes, true);
    const bufferView = whole(extension.bufferView, json.bufferViews?.length ?? 0) ? json.bufferViews[extension.bufferView] : undefined;
    const offset = bufferView?.byteOffset ?? 0;
    if (!bufferView || bufferView.buffer !== 0 || !whole(offset, binaryBytes) || !whole(bufferView.byteLength, binaryBytes - offset + 1))
        throw malformed('The GLB\'s progressive mesh is not where it says.');
    if (!Array.isArray(extension.attributes) || !Array.isArray(extension.meshes)) throw malformed('VSPLIT_progressive_mesh lacks attributes or meshes.');
    const groups = new Set<number>();
    for (const mesh of extension.meshes) {
        if (!whole(mesh?.mesh, json.meshes?.length ?? 0) || !Number.isInteger(mesh.exponent) || Math.abs(mesh.exponent) > 126 || !Array.isArray(mesh.primitives))
            throw malformed('VSPLIT_progressive_mesh names a mesh that is not there.');
        for (const primitive of mesh.primitives) {
            if (!whole(primitive?.group, 1 << 24) || groups.has(primitive.group)) throw malformed('VSPLIT_progressive_mesh names a group twice.');
            groups.add(primitive.group);
            if (!Array.isArray(primitive.attributes) || primitive.attributes.some((a) => !whole(a?.attribute, extension.attributes.length)))
                throw malformed('VSPLIT_progressive_mesh names an attribute that is not there.');
        }
    }
    if (extension.attributes.some((a) => typeof a?.name !== 'string' || !whole(a.components, 17))) throw malformed('VSPLIT_progressive_mesh has an attribute without a name.');
    return { json, extension, streamOffset: binaryOffset + offset, streamBytes: bufferView.byteLength, binaryOffset };
}

/** The GLB that ends where the stream begins: what a loader that does not know the extension takes. `bytes` are those before the stream. */
export function plainGlb(front: GlbFront, bytes: Uint8Array): ArrayBuffer {
    const json = structuredClone(front.json);
    const binary = bytes.subarray(front.binaryOffset, front.streamOffset);
    json.buffers[0].byteLength = binary.length;
    // The view of the stream would reach beyond the end.
    Object.assign(json.bufferViews[front.extension.bufferView], { byteOffset: 0, byteLength: 0 });
    const text = new TextEncoder().encode(JSON.stringify(json));
    const jsonBytes = (text.length + 3) & ~3, binaryBytes = (binary.length + 3) & ~3;
    const glb = new Uint8Array(28 + jsonBytes + binaryBytes).fill(0x20, 20, 20 + jsonBytes);
    const view = new DataView(glb.buffer);
    for (const [at, value] of [[0, 0x46546c67], [4, 2], [8, glb.length], [12, jsonBytes], [16, 0x4e4f534a], [20 + jsonBytes, binaryBytes], [24 + jsonBytes, 0x004e4942]])
        view.setUint32(at, value, true);
    glb.set(text, 20);
    glb.set(binary, 28 + jsonBytes);
    return glb.buffer;
}
