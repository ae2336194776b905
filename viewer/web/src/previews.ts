// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Small pictures for a page that lists models: each [data-preview=ADDRESS] that comes into sight gets a canvas. One renderer
// draws them all, one after the other, from the first few thousand triangles of each file.
import { Vector3 } from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js';
import { VsplitModel } from '../../../lib/wasm/npm/src/three.js';
import { frame, makeRenderer, makeScene } from './stage.js';

const kTriangles = 6000;
const kPatience = 15_000;
const width = 480, height = 360;

const renderer = makeRenderer(undefined, { preserve: true });
renderer.setSize(width, height, false);

async function draw(stage: HTMLElement) {
    const { scene, camera } = makeScene();
    camera.aspect = width / height;
    const model = new VsplitModel(new URL(stage.dataset.preview!, location.href), {
        gltfLoader: new GLTFLoader().setMeshoptDecoder(MeshoptDecoder), target: { triangles: kTriangles },
        wasmUrl: new URL('vsplit.wasm', import.meta.url), workerUrl: new URL('worker.js', import.meta.url),
    });
    scene.add(model);
    try {
        await Promise.race([model.ready, new Promise((_, reject) => setTimeout(reject, kPatience))]);
        const until = performance.now() + kPatience;
        for (let still = 0; still < 3 && performance.now() < until;) {
            await new Promise((next) => requestAnimationFrame(next));
            if (!model.bounds.isEmpty()) frame(camera, model.bounds, new Vector3());
            still = !model.update() && model.progress?.idle && model.level.triangles > 0 ? still + 1 : 0;
            renderer.render(scene, camera);
        }
        const canvas = document.createElement('canvas');
        Object.assign(canvas, { width, height });
        canvas.getContext('2d')!.drawImage(renderer.domElement, 0, 0);
        stage.replaceChildren(canvas);
        stage.dataset.drawn = String(model.level.triangles);
    } catch {
        stage.textContent = 'no preview';
        stage.dataset.drawn = '0';
    } finally {
        model.dispose();
    }
}

let queue = Promise.resolve();
const seen = new IntersectionObserver((entries) => {
    for (const { isIntersecting, target } of entries) {
        if (!isIntersecting) continue;
        seen.unobserve(target);
        queue = queue.then(() => draw(target as HTMLElement));
    }
}, { rootMargin: '200px' });
for (const stage of document.querySelectorAll('[data-preview]')) seen.observe(stage);
