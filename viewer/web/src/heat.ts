// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Materials that show numbers as colours.
import { DataTexture, DoubleSide, FloatType, GLSL3, NearestFilter, RGFormat, ShaderMaterial } from 'three';
import type { StreamInfo } from '../../../lib/wasm/npm/src/messages.js';

const kRamp = `
vec3 ramp(float t) {
    t = clamp(t, 0.0, 1.0) * 4.0;
    vec3 a = vec3(0.173, 0.243, 0.561), b = vec3(0.165, 0.549, 0.612), c = vec3(0.486, 0.769, 0.420), d = vec3(0.949, 0.820, 0.310), e = vec3(0.851, 0.314, 0.180);
    return t < 1.0 ? mix(a, b, t) : t < 2.0 ? mix(b, c, t - 1.0) : t < 3.0 ? mix(c, d, t - 2.0) : mix(d, e, t - 3.0);
}`;

const kFragment = `
${kRamp}
in vec3 v_normal;
in float v_value;
out vec4 colour;
void main() {
    vec3 n = normalize(gl_FrontFacing ? v_normal : -v_normal);
    float light = 0.55 + 0.45 * max(0.0, dot(n, normalize(vec3(0.3, 0.5, 0.8))));
    colour = vec4(ramp(v_value) * light, 1.0);
}`;

export interface Heat { material: ShaderMaterial; low: string; high: string }

const short = (value: number) => Number(value.toPrecision(3)).toString();

/**
 * How coarse the mesh was where a vertex was born: vertices are numbered in order of birth and errors only fall, so the file's
 * table says it, and no array is needed. Logarithmic.
 */
export function errorHeat(info: StreamInfo): Heat {
    const errors = [info.baseError, ...info.blocks.map((b) => b.error)].filter((e) => e > 0);
    const high = Math.max(...errors, 1e-12), low = Math.max(Math.min(...errors, high), high * 1e-5);
    const count = Math.min(info.blocks.length + 1, 2048);
    const table = new Float32Array(2 * count);
    for (let i = 0; i < count; ++i) {
        const at = i === 0 ? { vertices: info.baseVertices, error: info.baseError } : info.blocks[Math.round((i * info.blocks.length) / (count - 1 || 1)) - 1];
        table[2 * i] = at.vertices;
        table[2 * i + 1] = Math.log(Math.max(at.error, low));
    }
    const texture = new DataTexture(table, count, 1, RGFormat, FloatType);
    texture.minFilter = texture.magFilter = NearestFilter;
    texture.needsUpdate = true;
    return {
        low: short(low), high: short(high),
        material: new ShaderMaterial({
            glslVersion: GLSL3, side: DoubleSide,
            uniforms: { table: { value: texture }, count: { value: count }, low: { value: Math.log(low) }, high: { value: Math.log(high) } },
            vertexShader: `
uniform highp sampler2D table;
uniform int count;
uniform float low, high;
out vec3 v_normal;
out float v_value;
void main() {
    int from = 0, to = count - 1;
    float at = float(gl_VertexID);
    while (from < to) {
        int middle = (from + to) / 2;
        if (texelFetch(table, ivec2(middle, 0), 0).r > at) to = middle; else from = middle + 1;
    }
    vec2 end = texelFetch(table, ivec2(from, 0), 0).rg;
    vec2 begin = from > 0 ? texelFetch(table, ivec2(from - 1, 0), 0).rg : vec2(0.0, end.g);
    float error = mix(begin.g, end.g, clamp((at - begin.r) / max(1.0, end.r - begin.r), 0.0, 1.0));
    v_value = (error - low) / max(1e-6, high - low);
    v_normal = normalize(normalMatrix * normal);
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`,
            fragmentShader: kFragment,
        }),
    };
}

/** Painted weights; all 1 where there are none. Logarithmic from a tenth to ten. */
export function weightHeat(info: StreamInfo): Heat {
    return {
        low: '0.1', high: '10',
        material: new ShaderMaterial({
            glslVersion: GLSL3, side: DoubleSide,
            vertexShader: `
${info.hasWeights ? 'in float weight;' : 'const float weight = 1.0;'}
out vec3 v_normal;
out float v_value;
void main() {
    v_value = 0.5 + 0.5 * log(max(weight, 1e-6)) / log(10.0);
    v_normal = normalize(normalMatrix * normal);
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`,
            fragmentShader: kFragment,
        }),
    };
}
