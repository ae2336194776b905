// SPDX-FileCopyrightText: 2026 The vsplit authors
// SPDX-License-Identifier: MIT
//
// Progressive meshes for three.js: a loader, and the object that it gives.
import {
    Box3, BufferAttribute, BufferGeometry, Group, Loader, LoadingManager, Material, Mesh, MeshBasicMaterial, MeshStandardMaterial,
    Object3D, PerspectiveCamera, Sphere, Vector3,
} from 'three';
import type { GLTF } from 'three/addons/loaders/GLTFLoader.js';
import { VsplitError } from './errors.js';
import { GlbFront, parseGlbFront, plainGlb } from './glb.js';
import type { ArrayPatch, Level, MeshPatch, Progress, StreamInfo, Target } from './messages.js';
import { VsplitSession, type SessionOptions } from './session.js';
import { GpuCopy, LiveArray, PatchCursor, StreamedAttribute } from './three_buffers.js';

export { VsplitError } from './errors.js';
export type { Level, Progress, StreamInfo, Target } from './messages.js';

export interface ModelOptions extends SessionOptions {
    /** For a .pmesh: the material of all groups, or one a group. A grey one if there is none. */
    material?: Material | Material[];
    /** For a progressive GLB: a GLTFLoader, to which decoders may have been given. Needed only for these. */
    gltfLoader?: { parse(data: ArrayBuffer, path: string, onLoad: (gltf: GLTF) => void, onError?: (error: any) => void): void };
    /** What update() may take, in milliseconds. */
    frameTime?: number;
    /** What one frame may send to the GPU: the first ones; then what takes about frameTime. */
    frameBytes?: number;
}

const kNames: Record<string, string> = { NORMAL: 'normal', TANGENT: 'tangent', TEXCOORD_0: 'uv', TEXCOORD_1: 'uv1', TEXCOORD_2: 'uv2', TEXCOORD_3: 'uv3', COLOR_0: 'color', JOINTS_0: 'skinIndex', WEIGHTS_0: 'skinWeight' };

/** More than that at once may have to wait until the GPU has taken what came before. */
const kLeastFrameBytes = 256 * 1024, kMostFrameBytes = 2 * 1024 * 1024;

/** One group of triangles, and the objects that draw it. */
interface Part {
    group: number;
    index: LiveArray;
    copies: [GpuCopy, GpuCopy];
    objects: Mesh[];
    uploader: Mesh;
    /** The stream's attributes that it has, by name; all if undefined. */
    attributes?: Set<string>;
}

const draws = (part: Part, name: string) => !part.attributes || name === 'position' || name === 'normal' || part.attributes.has(name);

/**
 * A mesh, or a scene, whose triangles come and go. Call update() once a frame, before the renderer draws.
 * Events: 'progress', 'level', 'error' (each with its value as a property of that name), 'bounds' (they are others than before).
 */
export class VsplitModel extends Group<{ progress: { progress: Progress }; level: { level: Level }; bounds: {}; error: { error: VsplitError } } & import('three').Object3DEventMap> {
    readonly isVsplitModel = true;
    info!: StreamInfo;
    level: Level = { vertices: 0, triangles: 0, error: Infinity };
    /** Of a progressive GLB: what GLTFLoader gave, with animations. */
    gltf?: GLTF;
    /** Around the full mesh. */
    readonly bounds = new Box3();
    progress?: Progress;
    frameTime: number;
    frameBytes: number;

    private sentAt = 0;
    /** Of the renderer that draws it; null if that is none of WebGL, undefined before it has drawn. */
    private gl?: WebGL2RenderingContext | null;
    private readonly session: VsplitSession;
    private readonly arrays = new Map<string, LiveArray>();
    /** Of each copy: shared by all parts. */
    private readonly attributes: [Map<string, BufferAttribute>, Map<string, BufferAttribute>] = [new Map(), new Map()];
    private readonly parts: Part[] = [];
    private readonly waiting: MeshPatch[] = [];
    private cursor?: PatchCursor;
    private applied?: MeshPatch;
    /** Which copy is drawn. */
    private shown: 0 | 1 = 0;
    private front?: GlbFront;
    private sceneReady: Promise<void> | undefined;
    private first?: (error?: VsplitError) => void;
    /** Settles when there is something to draw. */
    readonly ready: Promise<this>;

    constructor(source: string | URL | Blob, private readonly options: ModelOptions = {}) {
        super();
        this.frameTime = options.frameTime ?? 4;
        this.frameBytes = options.frameBytes ?? 1024 * 1024;
        const { material: _m, gltfLoader: _g, frameTime: _t, frameBytes: _b, ...session } = options;
        this.ready = new Promise((resolve, reject) => { this.first = (error) => { this.first = undefined; if (error) reject(error); else resolve(this); }; });
        this.ready.catch(() => {});
        this.session = new VsplitSession(source, {
            onScene: (bytes) => { this.sceneReady = this.takeScene(bytes); this.sceneReady.catch((e) => this.fail(e)); },
            onInfo: (info) => this.takeInfo(info),
            onPatch: (patch) => { this.waiting.push(patch); if (!this.first) this.dispatchEvent({ type: 'progress', progress: this.progress! }); this.begin(); },
            onProgress: (progress) => { this.progress = progress; this.dispatchEvent({ type: 'progress', progress }); },
            onError: (error) => this.fail(error),
        }, session);
    }

    setTarget(target: Target) { this.session.setTarget(target); }
    setThrottle(bytesPerSecond: number) { this.session.setThrottle(bytesPerSecond); }
    /** After an error: tries what failed again. */
    again() { this.session.again(); }

    /** The error, in the object's units, that is `pixels` on a screen of `height` pixels where the object is nearest to the camera. */
    errorForPixels(pixels: number, camera: PerspectiveCamera, height: number): number {
        const sphere = this.bounds.getBoundingSphere(new Sphere());
        const scale = this.getWorldScale(new Vector3());
        sphere.applyMatrix4(this.matrixWorld);
        const distance = Math.max(camera.near, camera.getWorldPosition(new Vector3()).distanceTo(sphere.center) - sphere.radius);
        const unit = this.front?.extension.unit ?? 1;
        return (pixels * 2 * distance * Math.tan((camera.fov * Math.PI) / 360)) / (height * camera.zoom) / Math.max(scale.x, scale.y, scale.z) / unit;
    }

    /**
     * Takes what has come, for at most `frameTime`. True if the next frame looks different, or there is more to do: then draw, and
     * call it again.
     */
    update(): boolean {
        if (!this.cursor && !this.applied && !this.begin()) return false;
        if (this.gl?.isContextLost()) return true;
        const hidden = (1 - this.shown) as 0 | 1;
        const until = performance.now() + this.frameTime;
        if (this.cursor) {
            if (!this.cursor.run(until)) return true;
            this.cursor = undefined;
            this.session.taken();
            // The next patches go the same way, as long as there is time: fewer uploads.
            while (this.waiting.length > 0 && performance.now() < until) {
                this.open(this.waiting.shift()!);
                if (!this.cursor!.run(until)) return true;
                this.cursor = undefined;
                this.session.taken();
            }
        }
        if (performance.now() > until || !this.upload(hidden)) return true;
        this.swap(hidden);
        return true;
    }

    override dispose() {
        this.session.close();
        this.gl?.canvas.removeEventListener('webglcontextrestored', this.restored);
        for (const attribute of this.streamed()) attribute.free();
        for (const part of this.parts) {
            for (const copy of part.copies) copy.geometry.dispose();
        }
    }

    private streamed(): StreamedAttribute[] {
        const all = [...this.attributes[0].values(), ...this.attributes[1].values(), ...this.parts.flatMap((part) => part.copies.map((copy) => copy.geometry.index))];
        return all.filter((attribute) => attribute instanceof StreamedAttribute);
    }
    private readonly restored = () => { for (const attribute of this.streamed()) attribute.restore(); };
    private drawnBy(renderer: { isWebGLRenderer?: boolean; getContext?(): unknown }) {
        if (this.gl === undefined) {
            this.gl = renderer.isWebGLRenderer ? renderer.getContext!() as WebGL2RenderingContext : null;
            this.gl?.canvas.addEventListener('webglcontextrestored', this.restored);
            for (const part of this.parts) part.uploader.visible = !this.gl;
        }
        if (!this.gl) this.measure();
    }

    private fail(error: VsplitError) {
        if (this.first) this.first(error);
        this.dispatchEvent({ type: 'error', error });
    }

    private begin(): boolean {
        if (this.cursor || this.applied) return true;
        const next = this.parts.length > 0 ? this.waiting.shift() : undefined;
        if (!next) return false;
        this.open(next);
        if (this.first) this.first();
        return true;
    }

    private open(patch: MeshPatch) {
        this.applied = patch;
        for (const part of this.parts) {
            // Half as much again, for few do not change their shares.
            const needed = 3 * (patch.counts[part.group] ?? 0);
            if (needed > part.index.data.length) part.index.grow(Math.min(3 * this.info.triangles, Math.ceil(needed * 1.5)));
        }
        this.cursor = new PatchCursor(patch.arrays, (array) => this.arrayOf(array));
    }

    private arrayOf(patch: ArrayPatch) {
        return patch.array === 'index' ? this.parts.find((p) => p.group === patch.group)?.index : this.arrays.get(patch.array);
    }

    /** Brings the hidden copy nearer to the arrays, by one frame's share. True if it is there. */
    private upload(side: 0 | 1): boolean {
        const { gl } = this;
        if (gl === undefined) return false;
        const attributes: [LiveArray, BufferAttribute][] = [];
        const seen = new Set<string>();
        let fresh = 0;
        for (const part of this.parts) {
            const geometry = part.copies[side].geometry;
            for (const [name, array] of this.arrays) {
                if (!draws(part, name)) continue;
                const used = kNames[name] ?? name;
                let attribute = this.attributes[side].get(name);
                if (!attribute) {
                    this.attributes[side].set(name, attribute = array.attribute(side, gl));
                    // three.js sends it whole, however large.
                    if (!gl) fresh += array.data.byteLength;
                }
                if (geometry.getAttribute(used) !== attribute) geometry.setAttribute(used, attribute);
                if (!seen.has(name)) attributes.push([array, attribute]);
                seen.add(name);
                if (fresh > this.frameBytes) return false;
            }
            if (geometry.index?.array !== part.index.data) {
                if (geometry.index instanceof StreamedAttribute) geometry.index.free();
                geometry.setIndex(part.index.attribute(side, gl));
                if (!gl) fresh += part.index.data.byteLength;
                if (fresh > this.frameBytes) return false;
            }
            attributes.push([part.index, geometry.index!]);
        }
        // What three.js was given in the frame before has to be gone, or nobody draws.
        if (!gl && (fresh > 0 || attributes.some(([, attribute]) => attribute.updateRanges.length > 0))) return false;
        let left = this.frameBytes;
        this.sentAt = performance.now();
        for (const [array, attribute] of attributes) if (left > 0) left = array.flush(side, attribute, left);
        if (gl) this.measure();
        return left > 0 && (gl !== null || left === this.frameBytes);
    }

    /** Fast machines send more a frame, slow ones less. */
    private measure() {
        if (this.sentAt === 0) return;
        const taken = performance.now() - this.sentAt;
        this.sentAt = 0;
        if (taken < this.frameTime / 2) this.frameBytes = Math.min(2 * this.frameBytes, kMostFrameBytes);
        else if (taken > this.frameTime) this.frameBytes = Math.max(this.frameBytes / 2, kLeastFrameBytes);
    }

    private swap(side: 0 | 1) {
        const patch = this.applied!;
        for (const part of this.parts) {
            const copy = part.copies[side], old = part.copies[this.shown];
            copy.show(patch.counts[part.group] ?? 0);
            old.hide();
            for (const object of part.objects) object.geometry = copy.geometry;
            part.uploader.geometry = old.geometry;
        }
        this.shown = side;
        this.applied = undefined;
        this.level = patch.level;
        this.dispatchEvent({ type: 'level', level: patch.level });
    }

    private async takeScene(bytes: Uint8Array) {
        if (!this.options.gltfLoader) throw new VsplitError('argument', 'A progressive GLB needs a GLTFLoader: new VsplitLoader().setGltfLoader(new GLTFLoader()).');
        this.front = parseGlbFront(bytes);
        const glb = plainGlb(this.front, bytes);
        this.gltf = await new Promise<GLTF>((resolve, reject) => this.options.gltfLoader!.parse(glb, '', resolve, reject)).catch((error) => {
            throw new VsplitError('malformed', `The scene around the progressive mesh cannot be loaded: ${error?.message ?? error}`);
        });
        this.add(this.gltf.scene);
        this.updateWorldMatrix(true, true);
        this.bounds.setFromObject(this.gltf.scene).applyMatrix4(this.matrixWorld.clone().invert());
        this.dispatchEvent({ type: 'bounds' });
        this.first?.();
    }

    private takeInfo(info: StreamInfo) {
        this.info = info;
        const low = new Vector3(...info.boundsMin), high = new Vector3(...info.boundsMax);
        const capacity = info.vertices;
        this.arrays.set('position', new LiveArray(new Float32Array(3 * capacity), 3));
        for (const { name, components } of info.attributes)
            if (kNames[name]) this.arrays.set(name, new LiveArray(new Float32Array(components * capacity), components));
        if (this.options.normals !== false && !this.arrays.has('NORMAL')) this.arrays.set('normal', new LiveArray(new Int16Array(4 * capacity), 4, true));
        if (info.hasWeights) this.arrays.set('weight', new LiveArray(new Float32Array(capacity), 1));
        if (!this.sceneReady) {
            this.bounds.set(low, high);
            const given = this.options.material;
            const colours = info.attributes.some((a) => a.name === 'COLOR_0');
            const plain = given ? undefined : new MeshStandardMaterial({ color: 0xc9c4ba, roughness: 0.62, metalness: 0, vertexColors: colours });
            for (let group = 0; group < info.groups; ++group) {
                const mesh = new Mesh(new BufferGeometry(), (Array.isArray(given) ? given[group % given.length] : given) ?? plain);
                this.add(mesh);
                this.addPart(group, [mesh], 1, low, high);
                mesh.geometry = this.parts[group].copies[0].geometry;
            }
            this.begin();
            return;
        }
        this.sceneReady.then(() => this.takeParts(low, high)).catch(() => {});
    }

    /** The objects of the scene that draw a mesh's primitives, wherever it is used. */
    private takeParts(low: Vector3, high: Vector3) {
        const { extension } = this.front!;
        const places = new Map<string, Mesh[]>();
        const associations = this.gltf!.parser.associations as Map<unknown, { meshes?: number; primitives?: number }>;
        this.gltf!.scene.traverse((object: Object3D) => {
            const at = associations.get(object);
            if (!(object as Mesh).isMesh || at?.meshes === undefined) return;
            const key = `${at.meshes}/${at.primitives ?? 0}`;
            places.set(key, [...places.get(key) ?? [], object as Mesh]);
        });
        for (const mesh of extension.meshes) {
            for (const primitive of mesh.primitives) {
                const objects = primitive.shown === undefined ? [] : places.get(`${mesh.mesh}/${primitive.shown}`) ?? [];
                // three.js keeps morph targets in textures, which are not refined: these stay as they are shown.
                if (objects.some((o) => o.morphTargetInfluences)) continue;
                this.addPart(primitive.group, objects, 2 ** -mesh.exponent, low, high, new Set(primitive.attributes.map((a) => extension.attributes[a.attribute].name)));
            }
        }
        // The base mesh may be smaller than the whole. The stream's box is that of all meshes; with several, none is further off than the error.
        this.bounds.expandByScalar(this.info.baseError * (extension.unit ?? 1));
        const one = extension.meshes.length === 1 ? this.parts.flatMap((part) => part.objects) : [];
        if (one.length > 0 && !one.some((object) => (object as { isSkinnedMesh?: boolean }).isSkinnedMesh)) {
            this.updateWorldMatrix(true, true);
            const back = this.matrixWorld.clone().invert(), box = this.parts[0].copies[0].geometry.boundingBox!;
            this.bounds.makeEmpty();
            for (const object of one) this.bounds.union(box.clone().applyMatrix4(back.clone().multiply(object.matrixWorld)));
        }
        this.dispatchEvent({ type: 'bounds' });
        this.begin();
    }

    private addPart(group: number, objects: Mesh[], scale: number, low: Vector3, high: Vector3, attributes?: Set<string>) {
        const room = Math.ceil((3 * this.info.triangles) / (this.info.groups > 1 ? this.info.groups / 1.2 : 1));
        const part: Part = {
            group, objects, attributes,
            index: new LiveArray(new Uint32Array(Math.min(room, 3 * this.info.triangles)), 1, false, true),
            copies: [new GpuCopy(0), new GpuCopy(1)],
            // Drawn with no triangles: that is how three.js brings arrays to the GPU, and how we hear which renderer it is.
            uploader: new Mesh(undefined, objects[0]?.material ?? new MeshBasicMaterial()),
        };
        const box = new Box3(low.clone().multiplyScalar(scale), high.clone().multiplyScalar(scale));
        for (const copy of part.copies) {
            // three.js chooses the shader by the attributes that it sees first, and does not look again: without normals, facets.
            for (const [name, array] of this.arrays) if (draws(part, name)) copy.geometry.setAttribute(kNames[name] ?? name, array.placeholder());
            copy.geometry.boundingBox = box;
            copy.geometry.boundingSphere = box.getBoundingSphere(new Sphere());
        }
        // Their own bounds follow the bones, over all vertices, each frame.
        for (const object of objects) if ((object as { isSkinnedMesh?: boolean }).isSkinnedMesh) object.frustumCulled = false;
        part.uploader.geometry = part.copies[1].geometry;
        // Without a context of ours three.js sends all arrays before it draws the first object: the time until then is theirs.
        if (this.parts.length === 0) part.uploader.onBeforeRender = (renderer) => this.drawnBy(renderer);
        part.uploader.frustumCulled = false;
        part.uploader.raycast = () => {};
        part.uploader.name = 'vsplit upload';
        this.add(part.uploader);
        this.parts.push(part);
    }
}

/** Loads .pmesh files and progressive GLBs. What it gives is there as soon as its base mesh is. */
export class VsplitLoader extends Loader<VsplitModel> {
    private options: ModelOptions = {};

    constructor(manager?: LoadingManager) { super(manager); }

    /** For progressive GLBs. */
    setGltfLoader(loader: ModelOptions['gltfLoader']): this { this.options.gltfLoader = loader; return this; }
    setOptions(options: ModelOptions): this { Object.assign(this.options, options); return this; }

    override load(url: string, onLoad: (model: VsplitModel) => void, onProgress?: (event: ProgressEvent) => void, onError?: (error: unknown) => void) {
        const source = this.manager.resolveURL((this.path ?? '') + url);
        this.manager.itemStart(source);
        const model = new VsplitModel(source, {
            ...this.options,
            headers: { ...this.requestHeader, ...this.options.headers },
            credentials: this.options.credentials ?? (this.withCredentials ? 'include' : 'same-origin'),
        });
        if (onProgress) model.addEventListener('progress', ({ progress }) => progress && onProgress(new ProgressEvent('progress', { lengthComputable: true, loaded: progress.fed, total: progress.fileBytes ?? 0 })));
        model.ready.then((ready) => { onLoad(ready); this.manager.itemEnd(source); }, (error) => {
            model.dispose();
            if (onError) onError(error); else console.error(error);
            this.manager.itemError(source);
            this.manager.itemEnd(source);
        });
    }

    /** The same of a file that the user chose. */
    parse(blob: Blob): Promise<VsplitModel> { return new VsplitModel(blob, this.options).ready; }
}
