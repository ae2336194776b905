# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
"""glTF scenes made for the tests, with what real assets have: skins, morph targets, several primitives that share points, instances,
animations, lights, extensions, strips, sparse accessors, external files. Standard library only."""
import base64
import json
import math
import struct
import zlib

FLOAT, UBYTE, USHORT, UINT, BYTE, SHORT = 5126, 5121, 5123, 5125, 5120, 5122
FORMATS = {FLOAT: 'f', UBYTE: 'B', USHORT: 'H', UINT: 'I', BYTE: 'b', SHORT: 'h'}
WIDTHS = {'SCALAR': 1, 'VEC2': 2, 'VEC3': 3, 'VEC4': 4, 'MAT4': 16}


def png(red, green, blue):
    """A picture of 2 by 2 pixels."""
    def chunk(kind, data):
        return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))
    rows = b''.join(b'\0' + bytes([red, green, blue] * 2) for _ in range(2))
    return b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', 2, 2, 8, 2, 0, 0, 0)) + chunk(b'IDAT', zlib.compress(rows)) + \
        chunk(b'IEND', b'')


class Scene:
    def __init__(self):
        self.root = {'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': []}]}
        self.bin = bytearray()

    def add(self, array, thing):
        self.root.setdefault(array, []).append(thing)
        return len(self.root[array]) - 1

    def use(self, *names):
        used = self.root.setdefault('extensionsUsed', [])
        used += [name for name in names if name not in used]

    def view(self, data, **more):
        self.bin += bytes(-len(self.bin) % 4)
        at = len(self.bin)
        self.bin += data
        return self.add('bufferViews', {'buffer': 0, 'byteOffset': at, 'byteLength': len(data), **more})

    def accessor(self, rows, component=FLOAT, kind='VEC3', bounds=False, padded=True, **more):
        """Elements begin at multiples of four, as those of vertices must; indices are not `padded`."""
        rows = [r if isinstance(r, (tuple, list)) else (r,) for r in rows]
        width = WIDTHS[kind]
        size = struct.calcsize(f'<{width}{FORMATS[component]}')
        padding = bytes(-size % 4) if padded else b''
        data = b''.join(struct.pack(f'<{width}{FORMATS[component]}', *r) + padding for r in rows)
        stride = {'byteStride': size + len(padding)} if padding else {}
        if bounds:
            near = [struct.unpack('<f', struct.pack('<f', c))[0] for r in rows for c in r] if component == FLOAT else [c for r in rows for c in r]
            more['min'] = [min(near[i::width]) for i in range(width)]
            more['max'] = [max(near[i::width]) for i in range(width)]
        return self.add('accessors', {'bufferView': self.view(data, **stride), 'componentType': component, 'count': len(rows), 'type': kind, **more})

    def node(self, root=True, **node):
        number = self.add('nodes', node)
        if root:
            self.root['scenes'][0]['nodes'].append(number)
        return number

    def glb(self):
        root = dict(self.root)
        root['buffers'] = [{'byteLength': len(self.bin)}]
        text = json.dumps(root).encode()
        text += b' ' * (-len(text) % 4)
        data = bytes(self.bin) + bytes(-len(self.bin) % 4)
        return struct.pack('<4sII', b'glTF', 2, 28 + len(text) + len(data)) + struct.pack('<I4s', len(text), b'JSON') + text + \
            struct.pack('<I4s', len(data), b'BIN\0') + data

    def gltf(self, uri=None):
        """Text; the buffer is inside, or at `uri`."""
        root = dict(self.root)
        data = bytes(self.bin)
        root['buffers'] = [{'byteLength': len(data), 'uri': uri or 'data:application/octet-stream;base64,' + base64.b64encode(data).decode()}]
        return json.dumps(root).encode()


def sheet(n, height=lambda u, v: 0.1 * math.sin(6 * u) * math.cos(5 * v)):
    """(n + 1)^2 points of a bumpy square with normals and texture coordinates, and its triangles."""
    points, normals, uvs, corners = [], [], [], []
    for i in range(n + 1):
        for j in range(n + 1):
            u, v = j / n, i / n
            e = 1e-4
            dx, dy = (height(u + e, v) - height(u - e, v)) / (2 * e), (height(u, v + e) - height(u, v - e)) / (2 * e)
            length = math.sqrt(dx * dx + dy * dy + 1)
            points.append((u, v, height(u, v)))
            normals.append((-dx / length, -dy / length, 1 / length))
            uvs.append((u, v))
    for i in range(n):
        for j in range(n):
            a = i * (n + 1) + j
            corners += [a, a + 1, a + n + 2, a, a + n + 2, a + n + 1]
    return points, normals, uvs, corners


def tangents(normals):
    out = []
    for x, _, z in normals:
        length = math.hypot(x, z)
        out.append((z / length, 0.0, -x / length, 1.0 if x >= 0 else -1.0))
    return out


def skinned(n=12):
    """A bar on two joints that bend, byte joints and weights of both kinds, an animation."""
    s = Scene()
    points, normals, uvs, corners = sheet(n)
    weights = [(1 - p[1], p[1], 0.0, 0.0) for p in points]
    byte_weights = [(255 - round(255 * w[1]), round(255 * w[1]), 0, 0) for w in weights]
    joints = [(0 if w[0] else 0, 1 if w[1] else 0, 0, 0) for w in weights]
    joints_byte = [(0, 1 if w[1] else 0, 0, 0) for w in byte_weights]
    common = {'POSITION': s.accessor(points, bounds=True), 'NORMAL': s.accessor(normals), 'TANGENT': s.accessor(tangents(normals), kind='VEC4'),
              'TEXCOORD_0': s.accessor(uvs, kind='VEC2')}
    indices = s.accessor(corners, USHORT, 'SCALAR', padded=False)
    image = s.add('images', {'bufferView': s.view(png(200, 80, 80)), 'mimeType': 'image/png'})
    texture = s.add('textures', {'source': image})
    material = s.add('materials', {'pbrMetallicRoughness': {'baseColorTexture': {'index': texture}}, 'doubleSided': True})
    meshes = []
    for joint, weight in ((s.accessor(joints, UBYTE, 'VEC4'), s.accessor(weights, kind='VEC4')),
                          (s.accessor(joints_byte, USHORT, 'VEC4'), s.accessor(byte_weights, UBYTE, 'VEC4', normalized=True))):
        meshes.append(s.add('meshes', {'primitives': [{'attributes': {**common, 'JOINTS_0': joint, 'WEIGHTS_0': weight}, 'indices': indices,
                                                       'material': material}]}))
    tip = s.node(root=False, name='tip', translation=[0, 1, 0])
    base = s.node(name='base', children=[tip])
    inverse = s.accessor([[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1], [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -1, 0, 1]], kind='MAT4')
    skin = s.add('skins', {'joints': [base, tip], 'inverseBindMatrices': inverse})
    for mesh in meshes:
        s.node(mesh=mesh, skin=skin)
    times = s.accessor([0.0, 1.0], kind='SCALAR', bounds=True)
    turns = s.accessor([(0, 0, 0, 1), (math.sin(0.5), 0, 0, math.cos(0.5))], kind='VEC4')
    s.add('animations', {'samplers': [{'input': times, 'output': turns}], 'channels': [{'sampler': 0, 'target': {'node': tip, 'path': 'rotation'}}]})
    return s


def morphing(n=10):
    """Two targets, one of them sparse, animated weights, target names."""
    s = Scene()
    points, normals, uvs, corners = sheet(n)
    rise = [(0.0, 0.0, 0.3 * math.sin(3 * p[0])) for p in points]
    moved = list(range(0, len(points), 3))
    sparse = s.add('accessors', {'componentType': FLOAT, 'count': len(points), 'type': 'VEC3', 'min': [0, 0, 0], 'max': [0.5, 0, 0], 'sparse': {
        'count': len(moved), 'indices': {'bufferView': s.view(struct.pack(f'<{len(moved)}H', *moved)), 'componentType': USHORT},
        'values': {'bufferView': s.view(struct.pack('<3f', 0.5, 0, 0) * len(moved))}}})
    mesh = s.add('meshes', {'weights': [0.0, 0.5], 'extras': {'targetNames': ['rise', 'bend']}, 'primitives': [{
        'attributes': {'POSITION': s.accessor(points, bounds=True), 'NORMAL': s.accessor(normals), 'TEXCOORD_0': s.accessor(uvs, kind='VEC2'),
                       'COLOR_0': s.accessor([(255, 128, int(255 * u), 255) for u, _ in uvs], UBYTE, 'VEC4', normalized=True)},
        'targets': [{'POSITION': s.accessor(rise, bounds=True), 'NORMAL': s.accessor([(0.1, 0.0, 0.0)] * len(points))}, {'POSITION': sparse}],
        'indices': s.accessor(corners, USHORT, 'SCALAR', padded=False)}]})
    still = s.node(mesh=mesh, name='face', weights=[0.25, 0.0])
    moving = s.node(mesh=mesh, name='moving', translation=[2, 0, 0], children=[s.node(root=False, name='hat')])
    times = s.accessor([0.0, 1.0], kind='SCALAR', bounds=True)
    s.add('animations', {'samplers': [{'input': times, 'output': s.accessor([0.0, 0.0, 1.0, 1.0], kind='SCALAR')},
                                      {'input': times, 'output': s.accessor([(2, 0, 0), (2, 1, 0)])}],
                         'channels': [{'sampler': 0, 'target': {'node': still, 'path': 'weights'}},
                                      {'sampler': 0, 'target': {'node': moving, 'path': 'weights'}},
                                      {'sampler': 1, 'target': {'node': moving, 'path': 'translation'}}]})
    return s


def assembly(parts=12):
    """Many primitives: a mesh of two that share a border, mirrored texture coordinates, one that is instanced, a strip, lines, two sets of
    texture coordinates, custom attributes, lights, a camera, extensions of materials and of primitives, small and large scales."""
    s = Scene()
    s.use('KHR_lights_punctual', 'KHR_materials_transmission', 'KHR_materials_clearcoat', 'KHR_materials_variants')
    s.root['extensions'] = {'KHR_lights_punctual': {'lights': [{'type': 'point', 'intensity': 5}]},
                            'KHR_materials_variants': {'variants': [{'name': 'day'}, {'name': 'night'}]}}
    glass = s.add('materials', {'name': 'glass', 'extensions': {'KHR_materials_transmission': {'transmissionFactor': 0.9}}})
    paint = s.add('materials', {'name': 'paint', 'extensions': {'KHR_materials_clearcoat': {'clearcoatFactor': 1}}, 'extras': {'tag': [1, 2]}})
    points, normals, uvs, corners = sheet(8)
    mirrored = [(u if u <= 0.5 else 1 - u, v) for u, v in uvs]
    shared = {'POSITION': s.accessor(points, bounds=True), 'NORMAL': s.accessor(normals), 'TEXCOORD_0': s.accessor(mirrored, kind='VEC2'),
              'TEXCOORD_1': s.accessor([(round(65535 * u), round(65535 * v)) for u, v in uvs], USHORT, 'VEC2', normalized=True),
              '_HEAT': s.accessor([u + v for u, v in uvs], kind='SCALAR'), '_ID': s.accessor([i % 200 for i in range(len(points))], UBYTE, 'SCALAR')}
    half = len(corners) // 2 // 3 * 3
    variants = {'KHR_materials_variants': {'mappings': [{'variants': [0], 'material': glass}, {'variants': [1], 'material': paint}]}}
    two = s.add('meshes', {'name': 'two', 'primitives': [
        {'attributes': shared, 'indices': s.accessor(corners[:half], USHORT, 'SCALAR', padded=False), 'material': glass, 'extensions': variants},
        {'attributes': shared, 'indices': s.accessor(corners[half:], USHORT, 'SCALAR', padded=False), 'material': paint, 'extras': {'side': 'right'}}]})
    for i in range(parts):
        turn = 0.3 * i
        s.node(mesh=two, name=f'two {i}', translation=[1.5 * (i % 4), 1.5 * (i // 4), 0], rotation=[0, 0, math.sin(turn), math.cos(turn)],
               scale=[0.01 if i == 3 else -1.0 if i == 4 else 1.0] + [0.01 if i == 3 else 1.0] * 2)
    strip = [c for i in range(8) for c in (i, 9 + i)]
    lines = s.accessor([(0.0, 0.0, 1.0), (1.0, 1.0, 1.0)], bounds=True)
    mixed = s.add('meshes', {'name': 'mixed', 'primitives': [
        {'attributes': {'POSITION': lines}, 'mode': 1},
        {'attributes': {'POSITION': shared['POSITION'], 'NORMAL': shared['NORMAL']}, 'indices': s.accessor(strip, UBYTE, 'SCALAR', padded=False), 'mode': 5}]})
    light = s.node(root=False, extensions={'KHR_lights_punctual': {'light': 0}})
    s.node(mesh=mixed, matrix=[100, 0, 0, 0, 0, 100, 0, 0, 0, 0, 100, 0, 5, 6, 7, 1], children=[light])
    camera = s.add('cameras', {'type': 'perspective', 'perspective': {'yfov': 1, 'znear': 0.1}})
    s.node(camera=camera, mesh=mixed, translation=[0, 0, 9])
    return s


def textured(name):
    """A buffer and a picture in files of their own: the scene's text, and the files by name."""
    s = Scene()
    points, normals, uvs, corners = sheet(6)
    image = s.add('images', {'uri': f'{name}%20picture.png'})
    sampler = s.add('samplers', {'magFilter': 9729})
    texture = s.add('textures', {'source': image, 'sampler': sampler})
    material = s.add('materials', {'pbrMetallicRoughness': {'baseColorTexture': {'index': texture}}})
    mesh = s.add('meshes', {'primitives': [{'attributes': {'POSITION': s.accessor(points, bounds=True), 'NORMAL': s.accessor(normals),
                                                           'TEXCOORD_0': s.accessor(uvs, kind='VEC2')},
                                            'indices': s.accessor(corners, USHORT, 'SCALAR', padded=False), 'material': material}]})
    s.node(mesh=mesh)
    return s.gltf(f'{name}.bin'), {f'{name}.bin': bytes(s.bin), f'{name} picture.png': png(10, 200, 30)}


def quantised(n=8):
    """KHR_mesh_quantization: shorts and bytes, undone by the node's scale."""
    s = Scene()
    s.use('KHR_mesh_quantization')
    s.root['extensionsRequired'] = ['KHR_mesh_quantization']
    points, normals, uvs, corners = sheet(n)
    mesh = s.add('meshes', {'primitives': [{'attributes': {
        'POSITION': s.accessor([tuple(round(4000 * c) for c in p) for p in points], SHORT, bounds=True),
        'NORMAL': s.accessor([tuple(round(127 * c) for c in v) for v in normals], BYTE, normalized=True),
        'TEXCOORD_0': s.accessor([tuple(round(65535 * c) for c in t) for t in uvs], USHORT, 'VEC2', normalized=True)},
        'indices': s.accessor(corners, USHORT, 'SCALAR', padded=False)}]})
    s.node(mesh=mesh, scale=[1 / 4000] * 3)
    return s


def instanced_on_gpu(n=6):
    s = Scene()
    s.use('EXT_mesh_gpu_instancing')
    points, normals, _, corners = sheet(n)
    mesh = s.add('meshes', {'primitives': [{'attributes': {'POSITION': s.accessor(points, bounds=True), 'NORMAL': s.accessor(normals)},
                                            'indices': s.accessor(corners, USHORT, 'SCALAR', padded=False)}]})
    places = s.accessor([(2.0 * i, 0.0, 0.0) for i in range(5)])
    s.node(mesh=mesh, extensions={'EXT_mesh_gpu_instancing': {'attributes': {'TRANSLATION': places}}})
    return s


def crowded(parts=110):
    """More than 100 primitives in as many meshes, a fan, 8 joints a vertex, cubic steps of an animation, glass of several extensions."""
    s = Scene()
    s.use('KHR_materials_transmission', 'KHR_materials_volume', 'KHR_materials_ior', 'KHR_materials_clearcoat')
    glass = s.add('materials', {'extensions': {'KHR_materials_transmission': {'transmissionFactor': 1.0}, 'KHR_materials_ior': {'ior': 1.4},
                                               'KHR_materials_volume': {'thicknessFactor': 0.5}}})
    coat = s.add('materials', {'extensions': {'KHR_materials_clearcoat': {'clearcoatFactor': 0.8, 'clearcoatRoughnessFactor': 0.1}}, 'alphaMode': 'MASK'})
    for i in range(parts):
        points, normals, uvs, corners = sheet(4, lambda u, v, i=i: 0.1 * math.sin(i + 5 * u) * math.cos(4 * v))
        s.node(mesh=s.add('meshes', {'primitives': [{
            'attributes': {'POSITION': s.accessor(points, bounds=True), 'NORMAL': s.accessor(normals), 'TEXCOORD_0': s.accessor(uvs, kind='VEC2')},
            'indices': s.accessor(corners, USHORT, 'SCALAR', padded=False), 'material': (glass, coat)[i % 2]}]}),
            translation=[1.2 * (i % 11), 1.2 * (i // 11), 0])
    ring = [(0.0, 0.0, 0.2)] + [(math.cos(0.3 * i), math.sin(0.3 * i), 0.0) for i in range(15)]
    s.node(mesh=s.add('meshes', {'primitives': [{'attributes': {'POSITION': s.accessor(ring, bounds=True)}, 'mode': 6, 'material': coat}]}), translation=[-3, 0, 0])
    points, normals, uvs, corners = sheet(10)
    share = [[math.exp(-3 * (8 * p[1] - j) ** 2 / 8) for j in range(8)] for p in points]
    rows = [[round(4096 * w / sum(row)) for w in row] for row in share]
    for row in rows:
        row[row.index(max(row))] += 4096 - sum(row)
    rows = [[w / 4096 for w in row] for row in rows]
    # A joint without weight is 0.
    joints = [s.accessor([tuple(j if row[j] > 0 else 0 for j in range(4 * k, 4 * k + 4)) for row in rows], UBYTE, 'VEC4') for k in range(2)]
    weights = [s.accessor([tuple(row[4 * k:4 * k + 4]) for row in rows], kind='VEC4') for k in range(2)]
    bones = [s.node(root=False, name=f'bone {j}', translation=[0, j / 8, 0]) for j in range(8)]
    s.node(name='bones', children=bones)
    inverse = s.accessor([[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -j / 8, 0, 1] for j in range(8)], kind='MAT4')
    mesh = s.add('meshes', {'primitives': [{'attributes': {'POSITION': s.accessor(points, bounds=True), 'NORMAL': s.accessor(normals),
                                                           'JOINTS_0': joints[0], 'JOINTS_1': joints[1], 'WEIGHTS_0': weights[0], 'WEIGHTS_1': weights[1]},
                                            'indices': s.accessor(corners, USHORT, 'SCALAR', padded=False), 'material': coat}]})
    s.node(mesh=mesh, skin=s.add('skins', {'joints': bones, 'inverseBindMatrices': inverse}))
    times = s.accessor([0.0, 1.0], kind='SCALAR', bounds=True)
    cubic = s.accessor([(0, 0, 0)] * 3 + [(0, 0, 0), (0, 1, 0), (0, 0, 0)])
    s.add('animations', {'samplers': [{'input': times, 'output': cubic, 'interpolation': 'CUBICSPLINE'}],
                         'channels': [{'sampler': 0, 'target': {'node': bones[7], 'path': 'translation'}}]})
    return s


def ring(n, m, radius=1.0, tube=0.35):
    """A torus whose texture is mirrored half way round: points, normals, tangents, texture coordinates, triangles."""
    points, normals, along, uvs, corners = [], [], [], [], []
    for i in range(n + 1):
        for j in range(m + 1):
            a, b = 2 * math.pi * (i % n) / n, 2 * math.pi * (j % m) / m
            out = radius + tube * math.cos(b)
            points.append((out * math.cos(a), out * math.sin(a), tube * math.sin(b)))
            normals.append((math.cos(b) * math.cos(a), math.cos(b) * math.sin(a), math.sin(b)))
            along.append((-math.sin(a), math.cos(a), 0.0, 1.0 if 2 * i <= n else -1.0))
            uvs.append((1 - abs(1 - 2 * i / n), j / m))
    for i in range(n):
        for j in range(m):
            a = i * (m + 1) + j
            corners += [a, a + m + 1, a + m + 2, a, a + m + 2, a + 1]
    return points, normals, along, uvs, corners


def shapes(n=20, m=10):
    """Every mode and way to store: interleaved, without indices, strips with and without, a fan by bytes, a sparse accessor over another, loops,
    line strips and points, two scenes, a mirroring node."""
    s = Scene()
    points, normals, along, uvs, corners = ring(n, m)
    rows = b''.join(struct.pack('<3f3f2H4B', *p, *v, round(65535 * u), round(65535 * w), 255, 128, 64, 255) for p, v, (u, w) in zip(points, normals, uvs))
    view = s.view(rows, byteStride=32, target=34962)
    near = [struct.unpack('<3f', struct.pack('<3f', *p)) for p in points]

    def column(offset, component, kind, **more):
        return s.add('accessors', {'bufferView': view, 'byteOffset': offset, 'componentType': component, 'count': len(points), 'type': kind, **more})

    def moved(places, x, y):
        return s.accessor([(p[0] + x, p[1] + y, p[2]) for p in places], bounds=True)
    strip = []
    for i in range(n):
        row = [k for j in range(m + 1) for k in (i * (m + 1) + j, (i + 1) * (m + 1) + j)]
        strip += ([strip[-1], row[0]] if strip else []) + row
    rim = [(0.0, 0.0, 0.0)] + [(math.cos(0.1 * i), math.sin(0.1 * i), 0.1 * math.sin(i)) for i in range(60)]
    s.node(mesh=s.add('meshes', {'primitives': [
        {'attributes': {'POSITION': column(0, FLOAT, 'VEC3', min=[min(p[c] for p in near) for c in range(3)], max=[max(p[c] for p in near) for c in range(3)]),
                        'NORMAL': column(12, FLOAT, 'VEC3'), 'TEXCOORD_0': column(24, USHORT, 'VEC2', normalized=True),
                        'COLOR_0': column(28, UBYTE, 'VEC4', normalized=True)}, 'indices': s.accessor(corners, UINT, 'SCALAR', padded=False)},
        {'attributes': {'POSITION': moved([points[c] for c in corners], 3, 0), 'NORMAL': s.accessor([normals[c] for c in corners])}},
        {'attributes': {'POSITION': moved(points, -3, 0)}, 'indices': s.accessor(strip, USHORT, 'SCALAR', padded=False), 'mode': 5},
        {'attributes': {'POSITION': moved([points[c] for c in strip[:21]], 0, 3)}, 'mode': 5},
        {'attributes': {'POSITION': moved(rim, 0, -3)}, 'indices': s.accessor(list(range(61)), UBYTE, 'SCALAR', padded=False), 'mode': 6},
        {'attributes': {'POSITION': moved(rim, 6, 0)}, 'mode': 2}, {'attributes': {'POSITION': moved(rim, 6, 0)}, 'mode': 3},
        {'attributes': {'POSITION': moved(rim, 6, 0)}, 'mode': 0}]}))
    risen = [(x, y, z + 1) for x, y, z in points[:20]]
    position = s.accessor(points, bounds=True)
    there = [struct.unpack('<3f', struct.pack('<3f', *p)) for p in risen + points[20:]]
    s.root['accessors'][position].update(
        {'min': [min(p[c] for p in there) for c in range(3)], 'max': [max(p[c] for p in there) for c in range(3)], 'sparse': {
            'count': 20, 'indices': {'bufferView': s.view(bytes(range(20))), 'componentType': UBYTE},
            'values': {'bufferView': s.view(b''.join(struct.pack('<3f', *p) for p in risen))}}})
    mirrored = s.add('meshes', {'primitives': [{'attributes': {'POSITION': position, 'NORMAL': s.accessor(normals), 'TANGENT': s.accessor(along, kind='VEC4'),
                                                               'TEXCOORD_0': s.accessor(uvs, kind='VEC2')},
                                                'indices': s.accessor(corners, USHORT, 'SCALAR', padded=False)}]})
    s.node(mesh=mirrored, translation=[0, 0, 4])
    s.root['scenes'].append({'nodes': [s.node(root=False, mesh=mirrored, scale=[-1, 1, 1])]})
    return s


def seamed(n=24, m=12):
    """A skinned ring with a morph target beside, of two primitives that meet but for rounding, as some exporters write them."""
    s = Scene()
    points, normals, along, uvs, corners = ring(n, m)
    target = {'POSITION': s.accessor([(0.0, 0.0, 0.3 * math.sin(4 * p[0])) for p in points], bounds=True),
              'NORMAL': s.accessor([(0.05, 0.0, 0.0)] * len(points)), 'TANGENT': s.accessor([(0.0, 0.01, 0.0)] * len(points))}
    share = [max(0.0, min(1.0, 0.5 + p[0] / 2)) for p in points]
    skin = {'JOINTS_0': s.accessor([(0, 1 if w else 0, 0, 0) for w in share], UBYTE, 'VEC4'),
            'WEIGHTS_0': s.accessor([(1 - w, w, 0.0, 0.0) for w in share], kind='VEC4')}
    other = {'NORMAL': s.accessor(normals), 'TANGENT': s.accessor(along, kind='VEC4'), 'TEXCOORD_0': s.accessor(uvs, kind='VEC2')}
    half = len(corners) // 2
    primitives = []
    for part, shift in ((corners[:half], 0.0), (corners[half:], 2e-5)):
        place = s.accessor([tuple(c + shift for c in p) for p in points], bounds=True)
        primitives.append({'attributes': {'POSITION': place, **other, **skin}, 'targets': [target], 'indices': s.accessor(part, UINT, 'SCALAR', padded=False)})
    mesh = s.add('meshes', {'weights': [0.2], 'primitives': primitives})
    tip = s.node(root=False, translation=[1, 0, 0])
    base = s.node(children=[tip])
    inverse = s.accessor([[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1], [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 1]], kind='MAT4')
    node = s.node(mesh=mesh, skin=s.add('skins', {'joints': [base, tip], 'inverseBindMatrices': inverse, 'skeleton': base}))
    times = s.accessor([0.0, 1.0], kind='SCALAR', bounds=True)
    turns = s.accessor([(0, 0, 0, 1), (math.sin(0.5), 0, 0, math.cos(0.5))], kind='VEC4')
    s.add('animations', {'samplers': [{'input': times, 'output': turns},
                                      {'input': times, 'output': s.accessor([0.0, 1.0], kind='SCALAR'), 'interpolation': 'STEP'}],
                         'channels': [{'sampler': 0, 'target': {'node': tip, 'path': 'rotation'}}, {'sampler': 1, 'target': {'node': node, 'path': 'weights'}}]})
    return s


def in_two_files(s, name):
    """The scene's views in turn in two files beside it: its text, and the files by name."""
    root = json.loads(json.dumps(s.root))
    parts = [bytearray(), bytearray()]
    for i, view in enumerate(root['bufferViews']):
        part = parts[i % 2]
        part += bytes(-len(part) % 4)
        data = s.bin[view['byteOffset']:view['byteOffset'] + view['byteLength']]
        view.update({'buffer': i % 2, 'byteOffset': len(part)})
        part += data
    root['buffers'] = [{'uri': f'{name}%20{i}.bin', 'byteLength': len(part)} for i, part in enumerate(parts)]
    return json.dumps(root).encode(), {f'{name} {i}.bin': bytes(part) for i, part in enumerate(parts)}


def values(root, data, number):
    """All values of an accessor as they are stored, sparse or not, of a GLB."""
    a = root['accessors'][number]
    width, letter = WIDTHS[a['type']], FORMATS[a['componentType']]
    size = struct.calcsize(f'<{width}{letter}')

    def rows(view, offset, count, size, form):
        v = root['bufferViews'][view]
        at = v.get('byteOffset', 0) + offset
        return [struct.unpack_from(form, data, at + i * v.get('byteStride', size)) for i in range(count)]
    out = rows(a['bufferView'], a.get('byteOffset', 0), a['count'], size, f'<{width}{letter}') if 'bufferView' in a else [(0,) * width] * a['count']
    if 'sparse' in a:
        sparse = a['sparse']
        kind = FORMATS[sparse['indices']['componentType']]
        at = rows(sparse['indices']['bufferView'], sparse['indices'].get('byteOffset', 0), sparse['count'], struct.calcsize('<' + kind), '<' + kind)
        for (i,), row in zip(at, rows(sparse['values']['bufferView'], sparse['values'].get('byteOffset', 0), sparse['count'], size, f'<{width}{letter}')):
            out[i] = row
    return out


def triangles(root, data, primitive):
    """The triangles of a primitive of any mode, each as what its corners have, least corner first; those that name a vertex twice left out."""
    columns = [values(root, data, primitive['attributes'][name]) for name in sorted(primitive['attributes'])]
    for target in primitive.get('targets', []):
        columns += [values(root, data, target[name]) for name in sorted(target)]
    corners = [i for i, in values(root, data, primitive['indices'])] if 'indices' in primitive else list(range(len(columns[0])))
    mode = primitive.get('mode', 4)
    if mode == 4:
        named = [tuple(corners[i:i + 3]) for i in range(0, len(corners) - 2, 3)]
    elif mode == 5:
        named = [tuple(corners[i:i + 3]) if i % 2 == 0 else (corners[i + 1], corners[i], corners[i + 2]) for i in range(len(corners) - 2)]
    else:
        named = [(corners[0], corners[i], corners[i + 1]) for i in range(1, len(corners) - 1)]
    out = []
    for t in named:
        if len(set(t)) == 3:
            full = [tuple(column[i] for column in columns) for i in t]
            least = full.index(min(full))
            out.append((full[least:] + full[:least]))
    return sorted(out)


def write_all(folder):
    """Every scene as a file; the names of the scenes."""
    made = {'skinned.glb': skinned().glb(), 'morphing.glb': morphing().glb(), 'assembly.glb': assembly().glb(), 'embedded.gltf': assembly(3).gltf(),
            'quantised.glb': quantised().glb(), 'instanced.glb': instanced_on_gpu().glb(), 'crowded.glb': crowded().glb(),
            'shapes.glb': shapes().glb(), 'seamed.glb': seamed().glb()}
    made['textured.gltf'], files = textured('outside')
    made['parted.gltf'], more = in_two_files(seamed(12), 'parted')
    for name, data in {**made, **files, **more}.items():
        (folder / name).write_bytes(data)
    return list(made)
