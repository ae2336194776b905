// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// peer.mjs IN OUT: meshoptimizer's attribute-aware simplification of the primitives in IN (peer.cpp writes it).
// IN, all of 32 bits: weights of normals, texture coordinates, colours and joints; 1 if vertices may be moved; how many ratios; the ratios; how many
// primitives; of each: vertices, indices, attributes a vertex, a weight kind (0 to 3) each; positions, attributes, indices.
// OUT: of each primitive, of each ratio: how many indices, the indices; positions and attributes if they may be moved.
import { readFileSync, writeFileSync } from 'node:fs';
import { MeshoptSimplifier } from 'meshoptimizer';

await MeshoptSimplifier.ready;
const bytes = readFileSync(process.argv[2]);
const data = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
let at = 0;
const floats = (n) => new Float32Array(data, (at += 4 * n) - 4 * n, n);
const words = (n) => new Uint32Array(data, (at += 4 * n) - 4 * n, n);
const weights = floats(4);
const [moves, ratioCount] = words(2);
const ratios = floats(ratioCount);
const [primitives] = words(1);
const out = [];
for (let p = 0; p < primitives; ++p) {
    const [vertices, indexCount, stride] = words(3);
    const kinds = [...words(stride)];
    const positions = floats(3 * vertices), attributes = floats(stride * vertices), indices = words(indexCount);
    for (const ratio of ratios) {
        const target = 3 * Math.floor((ratio * indexCount) / 3);
        if (moves) {
            const i = indices.slice(), v = positions.slice(), a = attributes.slice();
            const [count] = MeshoptSimplifier.simplifyWithUpdate(i, v, 3, a, stride, kinds.map((k) => weights[k]), null, target, 1e9, []);
            out.push(new Uint32Array([count]), i.subarray(0, count), v, a);
        } else {
            const [result] = MeshoptSimplifier.simplifyWithAttributes(indices, positions, 3, attributes, stride, kinds.map((k) => weights[k]), null, target, 1e9, []);
            out.push(new Uint32Array([result.length]), result);
        }
    }
}
writeFileSync(process.argv[3], Buffer.concat(out.map((a) => Buffer.from(a.buffer, a.byteOffset, a.byteLength))));
