// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// The page that shows one model: ?src=ADDRESS, &ratio=, &pixels=, &throttle=, &wireframe, &zup, &colour=error|weight, &panel=0.
import { AnimationMixer, type Material, type Mesh, Timer, Vector3 } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { MeshoptDecoder } from 'three/addons/libs/meshopt_decoder.module.js';
import type { Progress, Target } from '../../../lib/wasm/npm/src/messages.js';
import { type VsplitError, VsplitModel } from '../../../lib/wasm/npm/src/three.js';
import { errorHeat, type Heat, weightHeat } from './heat.js';
import { Pace } from './pace.js';
import { frame, makeRenderer, makeScene } from './stage.js';

const element = <T extends HTMLElement = HTMLElement>(id: string) => document.getElementById(id) as T;
const input = (id: string) => element<HTMLInputElement>(id);
const text = (id: string, value: string) => { const at = element(id); if (at.textContent !== value) at.textContent = value; };
const query = new URLSearchParams(location.search);

const canvas = element<HTMLCanvasElement>('view');
const { scene, camera } = makeScene();
let renderer: ReturnType<typeof makeRenderer>;
// A context of GL takes as long as the scripts did: a task of its own.
await turn();
try {
    renderer = makeRenderer(canvas);
} catch {
    notice('This browser shows no WebGL 2.', false);
    throw new Error('no WebGL 2');
}
await turn();
const pace = new Pace(renderer.getContext() as WebGL2RenderingContext);
const orbit = new OrbitControls(camera, canvas);
orbit.enableDamping = true;
const timer = new Timer();

let model: VsplitModel | undefined;
let mixer: AnimationMixer | undefined;
let framed = false, touched = false;
/** Of the camera's height, what the controls leave free. */
let share = 1, fitted = 1;
let heats: Partial<Record<string, Heat>> = {};
let plain = new Map<Mesh, Material | Material[]>();
let drawn = true;
/** The next frame is the first with new shaders, which takes long: nothing else happens in it. */
let cold = false;
let frames: number[] = [];
let lastTarget = '';

// What tests and the curious read.
const state = { ready: false, level: undefined as unknown, progress: undefined as Progress | undefined, error: undefined as VsplitError | undefined, info: undefined as unknown, firstTrianglesAt: 0, longestUpdate: 0, longestFrame: 0, target: undefined as Target | undefined };
Object.assign(window, { vsplit: { state, get model() { return model; }, renderer, scene, camera, open, stop: () => { mixer?.setTime(0); mixer = undefined; } } });

const bytesText = (bytes: number) => (bytes < 1e6 ? `${(bytes / 1e3).toFixed(0)} kB` : `${(bytes / 1e6).toFixed(2)} MB`);
/** toLocaleString() takes 20 ms the first time. */
const count = (n: number) => String(n).replace(/\B(?=(\d{3})+$)/g, ',');

/** Ends a task of the page: what comes after it is another. */
function turn() { return new Promise<void>((next) => setTimeout(next)); }

/** The slider's ends are the base mesh and all; between them each step is the same factor. */
const sliderRatio = () => {
    const at = Number(input('ratio').value) / 1000;
    return at >= 1 ? 1 : at <= 0 ? 0 : 10 ** (-3 * (1 - at));
};
const sliderOf = (ratio: number) => Math.round(1000 * Math.min(1, Math.max(0, 1 + Math.log10(Math.max(ratio, 1e-6)) / 3)));
const sliderPixels = () => 0.25 * 2 ** (Number(input('pixels').value) / 15);
const mode = () => (document.querySelector<HTMLInputElement>('input[name=mode]:checked')!).value;

function target(): Target {
    if (mode() === 'pixels' && model?.info) return { pixels: model.errorForPixels(sliderPixels(), camera, (canvas.clientWidth / camera.aspect) * renderer.getPixelRatio()) };
    return { ratio: sliderRatio() };
}

function aim() {
    const ratio = sliderRatio();
    text('ratio-text', ratio === 0 ? 'base' : `${Number((100 * ratio).toPrecision(3))} %`);
    text('pixels-text', sliderPixels().toFixed(1));
    input('ratio-row').hidden = mode() !== 'ratio';
    input('pixels-row').hidden = mode() !== 'pixels';
    const next = target();
    // A moving camera changes the wanted error all the time: a twentieth is not seen.
    const key = 'pixels' in next ? `p${Math.round(20 * Math.log(Math.max(next.pixels, 1e-30)))}` : JSON.stringify(next);
    if (!model || key === lastTarget) return;
    lastTarget = key;
    state.target = next;
    model.setTarget(next);
    wake();
}

function dress() {
    if (!model?.info) return;
    const colour = element<HTMLSelectElement>('colour').value;
    const wireframe = input('wireframe').checked;
    if (colour !== 'plain') heats[colour] ??= colour === 'error' ? errorHeat(model.info) : weightHeat(model.info);
    const heat = colour === 'plain' ? undefined : heats[colour];
    model.traverse((object) => {
        const mesh = object as Mesh;
        if (!mesh.isMesh || mesh.name === 'vsplit upload') return;
        if (!plain.has(mesh)) plain.set(mesh, mesh.material);
        mesh.material = heat ? heat.material : plain.get(mesh)!;
        for (const material of [mesh.material].flat()) (material as Material & { wireframe?: boolean }).wireframe = wireframe;
    });
    element('legend').hidden = !heat;
    if (heat) {
        text('legend-low', heat.low);
        text('legend-high', heat.high);
    }
    wake();
}

function notice(message: string, canTryAgain: boolean, soft = false) {
    text('notice-text', message);
    element('notice').hidden = false;
    element('notice').classList.toggle('soft', soft);
    element('again').hidden = !canTryAgain;
}

function open(source: string | File, name: string) {
    model?.dispose();
    model?.removeFromParent();
    for (const heat of Object.values(heats)) heat?.material.dispose();
    heats = {};
    plain = new Map();
    mixer = undefined;
    framed = touched = false;
    lastTarget = '';
    Object.assign(state, { ready: false, level: undefined, progress: undefined, error: undefined, info: undefined, firstTrianglesAt: 0, longestUpdate: 0, longestFrame: 0 });
    element('notice').hidden = element('empty').hidden = true;
    text('name', name);
    text('facts', 'Asking for it …');
    document.title = `${name} – vsplit`;
    const opened = new VsplitModel(source, {
        gltfLoader: new GLTFLoader().setMeshoptDecoder(MeshoptDecoder),
        bytesPerSecond: Number(element<HTMLSelectElement>('throttle').value),
        target: mode() === 'ratio' ? { ratio: sliderRatio() } : { ratio: 0 },
        wasmUrl: new URL('vsplit.wasm', import.meta.url), workerUrl: new URL('worker.js', import.meta.url),
        retryDelay: Number(query.get('retry') ?? 400),
    });
    model = opened;
    scene.add(opened);
    stand();
    opened.addEventListener('error', ({ error }) => {
        state.error = error!;
        notice(error!.message, error!.code === 'network' || error!.code === 'checksum' || error!.code === 'server');
        if (!opened.info) text('facts', '');
    });
    opened.addEventListener('progress', ({ progress }) => {
        if (!progress || model !== opened) return;
        state.progress = progress;
        showProgress(progress);
        wake();
    });
    opened.addEventListener('bounds', () => { if (model === opened && framed && !touched) frameAll(); });
    opened.addEventListener('level', ({ level }) => {
        state.level = level;
        if (level && level.triangles > 0 && state.firstTrianglesAt === 0) state.firstTrianglesAt = state.progress?.fed ?? 1;
        text('triangles', count(level!.triangles));
        text('error', level!.error === 0 ? '0' : Number(level!.error.toPrecision(3)).toString());
        if (plain.size === 0) dress();
    });
    opened.ready.then(async () => {
        // Shaders are compiled beside the page: the first frame would wait for them.
        opened.visible = false;
        await renderer.compileAsync(opened, camera, scene);
        for (const program of renderer.info.programs ?? []) {
            program.getUniforms();
            await turn();
        }
        opened.visible = cold = true;
        if (model !== opened) return;
        state.ready = true;
        if (opened.info) start(opened);
        else frameAll();
        if (opened.gltf?.animations.length) {
            mixer = new AnimationMixer(opened.gltf.scene);
            mixer.clipAction(opened.gltf.animations[0]).play();
        }
        wake();
    }).catch(() => {});
    wake();
}

function start(of: VsplitModel) {
    state.info = of.info;
    text('all-triangles', count(of.info.triangles));
    text('facts', `${count(of.info.vertices)} vertices${of.info.lossless ? ', lossless' : ''}${of.info.groups > 1 ? `, ${of.info.groups} materials` : ''}`);
    const weights = element<HTMLSelectElement>('colour').querySelector<HTMLOptionElement>('[value=weight]')!;
    weights.textContent = of.info.hasWeights ? 'Weight' : 'Weight (none painted)';
    if (!framed) frameAll();
    aim();
    dress();
}

function showProgress(progress: Progress) {
    if (model?.info && !state.info) start(model);
    text('bytes', bytesText(progress.fed));
    const whole = progress.fileBytes ?? Math.max(progress.needed, 1);
    element('arrived').style.width = `${(100 * progress.fed) / whole}%`;
    element('wanted').style.width = `${(100 * progress.needed) / whole}%`;
    if (progress.retry) notice(`The connection broke (${progress.retry.reason}). Trying again${progress.retry.attempt > 1 ? `, attempt ${progress.retry.attempt}` : ''} …`, false, true);
    else if (element('notice').classList.contains('soft')) element('notice').hidden = true;
}

/** Scans often have their third axis upwards, where glTF has the second. */
function stand() {
    model?.rotation.set(input('z-up').checked ? -Math.PI / 2 : 0, 0, 0);
    model?.updateMatrixWorld(true);
}

function frameAll() {
    if (!model || model.bounds.isEmpty()) return;
    framed = true;
    frame(camera, model.bounds.clone().applyMatrix4(model.matrixWorld), orbit.target, share);
    orbit.minDistance = camera.near * 2;
    orbit.maxDistance = camera.far / 3;
    orbit.update();
    wake();
}

function resize() {
    const width = canvas.clientWidth, height = canvas.clientHeight;
    renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    renderer.setSize(width, height, false);
    // The model stands in the part that the controls leave free.
    const panel = element('panel').getBoundingClientRect();
    const below = panel.left < width * 0.4 && panel.right > width * 0.6 ? Math.max(0, height - panel.top) : 0;
    const covered = below < height * 0.6 ? below : 0;
    const all = height + covered;
    share = (height - covered) / all;
    camera.aspect = width / Math.max(1, all);
    camera.setViewOffset(width, all, 0, covered, width, height);
    // What filled the free part before fills it still.
    const fits = Math.min(share, camera.aspect);
    if (framed) camera.position.sub(orbit.target).multiplyScalar(fitted / fits).add(orbit.target);
    fitted = fits;
    camera.updateProjectionMatrix();
    wake();
}

let asleep = true;
function wake() {
    drawn = false;
    if (asleep) {
        asleep = false;
        requestAnimationFrame(tick);
    }
}

function tick(now: number) {
    if (!pace.free()) return void requestAnimationFrame(tick);
    const began = performance.now();
    timer.update();
    orbit.autoRotate = input('turn').checked;
    const moved = orbit.update(timer.getDelta());
    if (mode() === 'pixels') aim();
    const changed = cold || (model?.update() ?? false);
    cold = false;
    const updated = performance.now();
    mixer?.update(timer.getDelta());
    if (changed || moved || mixer || !drawn) {
        renderer.render(scene, camera);
        pace.drawn();
        drawn = true;
        frames.push(now);
        state.longestUpdate = Math.max(state.longestUpdate, updated - began);
        state.longestFrame = Math.max(state.longestFrame, performance.now() - began);
    }
    while (frames.length > 1 && frames[0] < now - 500) frames.shift();
    if (frames.length > 2) text('frame', `${((frames.at(-1)! - frames[0]) / (frames.length - 1)).toFixed(1)} ms`);
    // Nothing moves and nothing comes: the battery rests until something does.
    if (changed || moved || mixer || orbit.autoRotate) requestAnimationFrame(tick);
    else asleep = true;
}

function setRatio(slider: number) {
    input('ratio').value = String(slider);
    aim();
}
function choose(id: string, value: string) {
    element<HTMLSelectElement>(id).value = value;
    element(id).dispatchEvent(new Event('change'));
}

input('ratio').addEventListener('input', aim);
input('pixels').addEventListener('input', aim);
for (const radio of document.querySelectorAll('input[name=mode]')) radio.addEventListener('change', aim);
element('colour').addEventListener('change', dress);
input('wireframe').addEventListener('change', dress);
input('turn').addEventListener('change', wake);
input('z-up').addEventListener('change', () => { stand(); frameAll(); });
element('throttle').addEventListener('change', () => model?.setThrottle(Number(element<HTMLSelectElement>('throttle').value)));
element('reset').addEventListener('click', frameAll);
element('close').addEventListener('click', () => { element('notice').hidden = true; });
element('again').addEventListener('click', () => { element('notice').hidden = true; state.error = undefined; if (model?.info) model.again(); else if (current) open(current.source, current.name); });
element('fold').addEventListener('click', () => {
    const open = element('fold').getAttribute('aria-expanded') === 'true';
    element('fold').setAttribute('aria-expanded', String(!open));
    resize();
});
orbit.addEventListener('change', wake);
orbit.addEventListener('start', () => { touched = true; wake(); });
new ResizeObserver(resize).observe(canvas);

let current: { source: string | File; name: string } | undefined;
function openFile(file: File | undefined | null) {
    if (!file) return;
    current = { source: file, name: file.name };
    open(file, file.name);
}
for (const id of ['file', 'first-file']) input(id).addEventListener('change', () => { openFile(input(id).files?.[0]); input(id).value = ''; });
addEventListener('dragover', (event) => { event.preventDefault(); element('drop').hidden = false; });
addEventListener('dragleave', (event) => { if (!event.relatedTarget) element('drop').hidden = true; });
addEventListener('drop', (event) => { event.preventDefault(); element('drop').hidden = true; openFile(event.dataTransfer?.files[0]); });
addEventListener('keydown', (event) => {
    const typing = /^(INPUT|SELECT|TEXTAREA)$/.test((event.target as HTMLElement).tagName);
    if (event.ctrlKey || event.metaKey || event.altKey || (typing && event.key.startsWith('Arrow'))) return;
    const step = event.shiftKey ? 100 : 20, at = Number(input('ratio').value);
    switch (event.key) {
        case 'ArrowLeft': setRatio(at - step); break;
        case 'ArrowRight': setRatio(at + step); break;
        case 'Home': setRatio(0); break;
        case 'End': setRatio(1000); break;
        case 'w': case 'W': input('wireframe').click(); break;
        case 't': case 'T': input('turn').click(); break;
        case 'e': case 'E': choose('colour', element<HTMLSelectElement>('colour').value === 'error' ? 'plain' : 'error'); break;
        case 'p': case 'P': document.querySelector<HTMLInputElement>(`input[value=${mode() === 'ratio' ? 'pixels' : 'ratio'}]`)!.click(); break;
        case 'f': case 'F': frameAll(); break;
        case 'z': case 'Z': input('z-up').click(); break;
        default: return;
    }
    event.preventDefault();
});

if (query.has('ratio')) input('ratio').value = String(sliderOf(Number(query.get('ratio'))));
if (query.has('pixels')) {
    input('pixels').value = String(Math.round(15 * Math.log2(Number(query.get('pixels')) / 0.25)));
    document.querySelector<HTMLInputElement>('input[value=pixels]')!.checked = true;
}
if (query.has('throttle')) {
    const select = element<HTMLSelectElement>('throttle'), value = String(Number(query.get('throttle')));
    if (![...select.options].some((o) => o.value === value)) select.add(new Option(`${(Number(value) * 8) / 1000} kbit/s`, value));
    select.value = value;
}
if (query.has('zup')) input('z-up').checked = true;
if (query.has('wireframe')) input('wireframe').checked = true;
if (query.has('colour')) element<HTMLSelectElement>('colour').value = query.get('colour')!;
if (query.get('panel') === '0') element('panel').hidden = true;
element('home').hidden = !location.pathname.startsWith('/_vsplit/');
// On a phone the controls begin folded: the model is what is looked at.
if (matchMedia('(max-width: 620px)').matches) element('fold').setAttribute('aria-expanded', 'false');
aim();
resize();
const source = query.get('src');
if (source) {
    const name = decodeURIComponent(new URL(source, location.href).pathname.split('/').pop() || source);
    current = { source: new URL(source, location.href).href, name };
    open(current.source, name);
} else {
    element('empty').hidden = false;
    camera.position.copy(new Vector3(0, 0, 4));
}
