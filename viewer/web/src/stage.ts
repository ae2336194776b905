// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Light, camera and ground of the viewer and of the previews.
import { ACESFilmicToneMapping, Box3, Color, DirectionalLight, HemisphereLight, PerspectiveCamera, Scene, Sphere, Vector3, WebGLRenderer } from 'three';

export function makeRenderer(canvas: HTMLCanvasElement | undefined, options: { preserve?: boolean } = {}): WebGLRenderer {
    const renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true, powerPreference: 'high-performance', preserveDrawingBuffer: options.preserve });
    renderer.setClearColor(new Color(0, 0, 0), 0);
    // Asking for errors waits until the shaders are linked.
    renderer.debug.checkShaderErrors = false;
    renderer.toneMapping = ACESFilmicToneMapping;
    renderer.toneMappingExposure = 1.05;
    return renderer;
}

export function makeScene(): { scene: Scene; camera: PerspectiveCamera } {
    const scene = new Scene();
    const camera = new PerspectiveCamera(35, 1, 0.01, 100);
    const key = new DirectionalLight(0xfff4e5, 2.6), fill = new DirectionalLight(0xdbe8ff, 0.8);
    key.position.set(0.6, 0.9, 0.7);
    fill.position.set(-0.9, 0.1, 0.4);
    // They go with the camera: whatever side is looked at is lit.
    camera.add(key, fill, key.target, fill.target);
    key.target.position.set(0, 0, -1);
    fill.target.position.set(0, 0, -1);
    scene.add(camera, new HemisphereLight(0xf3f6fa, 0x8a8178, 1.1));
    return { scene, camera };
}

/** Looks at all of the box from a little above, so that it fills `share` of the camera's height and does not leave its width. */
export function frame(camera: PerspectiveCamera, box: Box3, target: Vector3, share = 1, turn = 0.45, above = 0.22) {
    const sphere = box.getBoundingSphere(new Sphere());
    const radius = Math.max(sphere.radius, 1e-6);
    const slope = Math.tan((camera.fov * Math.PI) / 360) * Math.min(share, camera.aspect);
    const distance = (1.02 * radius) / Math.sin(Math.atan(slope));
    target.copy(sphere.center);
    camera.position.set(Math.sin(turn) * Math.cos(above), Math.sin(above), Math.cos(turn) * Math.cos(above)).multiplyScalar(distance).add(sphere.center);
    camera.near = distance / 200;
    camera.far = distance * 20;
    camera.updateProjectionMatrix();
    camera.lookAt(target);
}
