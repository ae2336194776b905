#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
"""scenes.py CORPUS OUT: scenes for `bench assets` that the corpus lacks, of the sizes and kinds of real assets: a textured cow, a car of panels and
wheels, a skinned arm, a morphing head, a torso of mirrored texture coordinates, terrain with colours. Standard library only."""
import math
import pathlib
import struct
import sys
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / 'cli'))
from scenes import FLOAT, UBYTE, UINT, Scene, sheet  # noqa: E402


def picture(size, pixel):
    """A PNG; `pixel(u, v)` says red, green, blue of 0 to 1."""
    def chunk(kind, data):
        return struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))
    rows = bytearray()
    for y in range(size):
        rows.append(0)
        for x in range(size):
            rows += bytes(max(0, min(255, round(255 * c))) for c in pixel((x + 0.5) / size, (y + 0.5) / size))
    return b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', struct.pack('>IIBBBBB', size, size, 8, 2, 0, 0, 0)) + \
        chunk(b'IDAT', zlib.compress(bytes(rows))) + chunk(b'IEND', b'')


def noise(x, y, seed=1):
    """Smooth, -1 to 1."""
    return (math.sin(1.7 * x + 2.3 * y + seed) + math.sin(-2.9 * x + 1.1 * y + 2.1 * seed) + math.sin(0.7 * x - 3.1 * y + 0.7 * seed)) / 3


def checks(u, v):
    """Squares of several colours with numbers' worth of detail: shows every slide of a texture."""
    i, j = int(16 * u), int(16 * v)
    shade = 0.55 + 0.35 * ((i + j) % 2) + 0.1 * noise(60 * u, 60 * v)
    return shade * (0.6 + 0.4 * (i / 16)), shade * (0.6 + 0.4 * (j / 16)), shade * (0.9 - 0.4 * ((i * 7 + j * 3) % 5) / 5)


def paint(u, v):
    """Two tones, a stripe, panel lines."""
    line = 0.4 if min((8 * u) % 1, (8 * v) % 1) < 0.04 else 1.0
    base = (0.75, 0.1, 0.1) if abs(v - 0.5) > 0.08 else (0.95, 0.95, 0.9)
    return tuple(line * c * (0.95 + 0.05 * noise(40 * u, 40 * v)) for c in base)


def material(s, pixel, size=256, **more):
    image = s.add('images', {'bufferView': s.view(picture(size, pixel)), 'mimeType': 'image/png'})
    return s.add('materials', {'pbrMetallicRoughness': {'baseColorTexture': {'index': s.add('textures', {'source': image})}, 'metallicFactor': 0}, **more})


def unit(v):
    n = math.sqrt(sum(c * c for c in v)) or 1
    return tuple(c / n for c in v)


def grid(nu, nv, place, u_of=lambda t: t, v_of=lambda t: t):
    """(nu + 1)(nv + 1) points of a patch with normals by differences; texture coordinates are the parameters."""
    points, normals, uvs, corners = [], [], [], []
    e = 1e-4
    for i in range(nv + 1):
        for j in range(nu + 1):
            u, v = u_of(j / nu), v_of(i / nv)
            p = place(u, v)
            a, b = place(u + e, v), place(u - e, v)
            c, d = place(u, v + e), place(u, v - e)
            du, dv = [x - y for x, y in zip(a, b)], [x - y for x, y in zip(c, d)]
            n = (du[1] * dv[2] - du[2] * dv[1], du[2] * dv[0] - du[0] * dv[2], du[0] * dv[1] - du[1] * dv[0])
            points.append(p)
            normals.append(unit(n))
            uvs.append((u, v))
    for i in range(nv):
        for j in range(nu):
            a = i * (nu + 1) + j
            corners += [a, a + 1, a + nu + 2, a, a + nu + 2, a + nu + 1]
    return points, normals, uvs, corners


def primitive(s, patch, mat, **attributes):
    points, normals, uvs, corners = patch
    return {'attributes': {'POSITION': s.accessor(points, bounds=True), 'NORMAL': s.accessor(normals), 'TEXCOORD_0': s.accessor(uvs, kind='VEC2'),
                           **attributes},
            'indices': s.accessor(corners, UINT, 'SCALAR', padded=False), 'material': mat}


def spot(path):
    """A mesh with an atlas: vertices for every pair of place and texture coordinates, normals by area."""
    s = Scene()
    places, coords, faces = [], [], []
    for line in path.read_text().splitlines():
        words = line.split()
        if not words:
            continue
        if words[0] == 'v':
            places.append(tuple(map(float, words[1:4])))
        elif words[0] == 'vt':
            coords.append((float(words[1]), 1 - float(words[2])))
        elif words[0] == 'f':
            ring = [tuple(int(i) - 1 for i in w.split('/')[:2]) for w in words[1:]]
            faces += [(ring[0], ring[i], ring[i + 1]) for i in range(1, len(ring) - 1)]
    sums = [[0.0, 0.0, 0.0] for _ in places]
    for face in faces:
        a, b, c = (places[i] for i, _ in face)
        u, v = [y - x for x, y in zip(a, b)], [y - x for x, y in zip(a, c)]
        n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        for i, _ in face:
            sums[i] = [x + y for x, y in zip(sums[i], n)]
    numbers, corners = {}, []
    for face in faces:
        corners += [numbers.setdefault(corner, len(numbers)) for corner in face]
    patch = ([places[i] for i, _ in numbers], [unit(sums[i]) for i, _ in numbers], [coords[t] for _, t in numbers], corners)
    s.node(mesh=s.add('meshes', {'primitives': [primitive(s, patch, material(s, checks, 512))]}))
    return s


def car():
    """Panels that meet at hard edges with gaps between, one of glass, four instances of a wheel, lamps, many bolts."""
    s = Scene()
    s.use('KHR_materials_clearcoat', 'KHR_materials_transmission')
    body = material(s, paint, extensions={'KHR_materials_clearcoat': {'clearcoatFactor': 1}})
    glass = s.add('materials', {'pbrMetallicRoughness': {'baseColorFactor': [0.2, 0.3, 0.35, 1]},
                                'extensions': {'KHR_materials_transmission': {'transmissionFactor': 0.8}}})
    rubber = material(s, lambda u, v: (0.12 + 0.1 * ((40 * u) % 1 < 0.5),) * 3)
    steel = s.add('materials', {'pbrMetallicRoughness': {'baseColorFactor': [0.7, 0.7, 0.75, 1], 'metallicFactor': 0.9}})

    def shell(u, v):
        """u around the body, v along it."""
        a, x = 2 * math.pi * u, 4 * v - 2
        cabin = 0.55 * math.exp(-((x + 0.2) / 0.9) ** 4)
        r = (0.9 * (1 - 0.25 * abs(x / 2) ** 3), 0.45 + cabin * (math.sin(a) > 0) * math.sin(a) ** 2)
        super_c, super_s = math.copysign(abs(math.cos(a)) ** 0.6, math.cos(a)), math.copysign(abs(math.sin(a)) ** 0.6, math.sin(a))
        crease = 0.015 * math.sin(12 * a) * math.exp(-x * x)
        return x, (r[1] + crease) * super_s, -(r[0] + crease) * super_c

    panels = []
    for i in range(6):
        for j in range(5):
            u0, v0 = i / 6 + 0.002, j / 5 + 0.002
            patch = grid(24, 24, shell, lambda t, u0=u0: u0 + t * (1 / 6 - 0.004), lambda t, v0=v0: v0 + t * (1 / 5 - 0.004))
            window = j in (1, 2) and i in (0, 2)
            panels.append(primitive(s, patch, glass if window else body))
    s.node(name='body', mesh=s.add('meshes', {'primitives': panels}))

    def tyre(u, v):
        a, b = 2 * math.pi * u, 2 * math.pi * v
        tread = 0.008 * (math.cos(b) > 0.3) * math.sin(48 * a)
        return (0.34 + (0.11 + tread) * math.cos(b)) * math.cos(a), (0.34 + (0.11 + tread) * math.cos(b)) * math.sin(a), 0.12 * math.sin(b)

    def rim(u, v):
        a = 2 * math.pi * u
        return 0.25 * v * math.cos(a), 0.25 * v * math.sin(a), 0.03 + 0.03 * math.cos(5 * a) * v * (1 - v) * 4

    wheel = s.add('meshes', {'primitives': [primitive(s, grid(120, 28, tyre), rubber), primitive(s, grid(100, 16, rim, v_of=lambda t: 0.02 + 0.98 * t), steel)]})
    for x in (-1.3, 1.3):
        for z in (-0.8, 0.8):
            s.node(mesh=wheel, translation=[x, -0.4, z], rotation=[0, 0 if z > 0 else 1, 0, 1 if z > 0 else 0])

    def bolt(u, v):
        a = 2 * math.pi * u
        r, h = (0.02, 0.03 * v * 2) if v < 0.5 else (0.02 * (2 - 2 * v), 0.03)
        return r * math.cos(a), h, -r * math.sin(a)

    bolt_mesh = s.add('meshes', {'primitives': [primitive(s, grid(16, 6, bolt), steel)]})
    for i in range(40):
        s.node(mesh=bolt_mesh, translation=[-1.8 + 0.09 * i, 0.2 + 0.2 * math.sin(i), 0.95])
    return s


def arm():
    """A tube on five joints, bent by an animation, four influences a vertex."""
    s = Scene()

    def tube(u, v):
        a = 2 * math.pi * u
        r = 0.25 + 0.06 * math.sin(9 * v) + 0.02 * math.sin(5 * a + 6 * v)
        return r * math.cos(a), 4 * v, -r * math.sin(a)

    patch = grid(48, 96, tube)
    joints, weights = [], []
    for p in patch[0]:
        near = sorted((abs(p[1] - j), j) for j in range(5))[:4]
        w = [math.exp(-4 * d * d) for d, _ in near]
        joints.append(tuple(j for _, j in near))
        weights.append(tuple(x / sum(w) for x in w))
    mesh = s.add('meshes', {'primitives': [primitive(s, patch, material(s, checks, 512), JOINTS_0=s.accessor(joints, UBYTE, 'VEC4'),
                                                     WEIGHTS_0=s.accessor(weights, kind='VEC4'))]})
    chain = []
    for j in range(4, -1, -1):
        chain.insert(0, s.node(root=j == 0, translation=[0, 1 if j else 0, 0], **({'children': [chain[0]]} if chain else {})))
    inverse = s.accessor([[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -j, 0, 1] for j in range(5)], kind='MAT4')
    s.node(mesh=mesh, skin=s.add('skins', {'joints': chain, 'inverseBindMatrices': inverse}))
    times = s.accessor([0.0, 1.0], kind='SCALAR', bounds=True)
    turns = s.accessor([(0, 0, 0, 1), (0, 0, math.sin(0.5), math.cos(0.5))], kind='VEC4')
    s.add('animations', {'samplers': [{'input': times, 'output': turns}],
                         'channels': [{'sampler': 0, 'target': {'node': j, 'path': 'rotation'}} for j in chain[1:]]})
    return s


def head():
    """A ball with features and two morph targets, animated."""
    s = Scene()

    def ball(u, v):
        a, b = 2 * math.pi * u, math.pi * (0.02 + 0.96 * v)
        r = 1 + 0.08 * noise(3 * math.cos(a) + 4 * b, 3 * math.sin(a)) + 0.25 * math.exp(-30 * ((u - 0.25) ** 2 + (v - 0.5) ** 2))
        return r * math.sin(b) * math.cos(a), -r * math.cos(b), -r * math.sin(b) * math.sin(a)

    patch = grid(96, 64, ball)
    smile = [(0.0, 0.25 * math.exp(-60 * ((u - 0.25) ** 2 + (v - 0.38) ** 2)), 0.0) for u, v in patch[2]]
    blink = [tuple(-0.15 * math.exp(-90 * ((u - 0.18) ** 2 + (v - 0.62) ** 2)) * c for c in p) for p, (u, v) in zip(patch[0], patch[2])]
    face = primitive(s, patch, material(s, checks, 512))
    face['targets'] = [{'POSITION': s.accessor(smile, bounds=True)}, {'POSITION': s.accessor(blink, bounds=True)}]
    node = s.node(mesh=s.add('meshes', {'primitives': [face], 'weights': [0, 0]}))
    times = s.accessor([0.0, 1.0], kind='SCALAR', bounds=True)
    s.add('animations', {'samplers': [{'input': times, 'output': s.accessor([0.0, 0.0, 1.0, 1.0], kind='SCALAR')}],
                         'channels': [{'sampler': 0, 'target': {'node': node, 'path': 'weights'}}]})
    return s


def torso():
    """Both halves use the same part of the texture: mirrored along a seam in the middle."""
    s = Scene()

    def half(u, v):
        a = math.pi * u
        r = 0.6 + 0.25 * math.sin(4 * v + 0.5) + 0.05 * math.sin(3 * a) + 0.02 * noise(20 * u, 20 * v)
        return r * math.sin(a), 2.4 * v, r * 0.7 * math.cos(a)

    points, normals, uvs, corners = grid(48, 64, half)
    n = len(points)
    points += [(-x, y, z) for x, y, z in points]
    normals += [(-x, y, z) for x, y, z in normals]
    uvs += uvs
    corners += [n + corners[i + k] for i in range(0, len(corners), 3) for k in (0, 2, 1)]
    s.node(mesh=s.add('meshes', {'primitives': [primitive(s, (points, normals, uvs, corners), material(s, checks, 512))]}))
    return s


def terrain():
    """Colours at vertices, none of textures."""
    s = Scene()
    height = lambda u, v: 0.12 * noise(9 * u, 9 * v) + 0.04 * noise(31 * u, 27 * v, 3)
    points, normals, uvs, corners = sheet(100, height)
    colors = []
    for p in points:
        t = max(0.0, min(1.0, 0.5 + 4 * p[2] + 0.2 * noise(40 * p[0], 40 * p[1])))
        colors.append((round(255 * (0.2 + 0.6 * t)), round(255 * (0.45 + 0.3 * t)), round(255 * (0.15 + 0.7 * t * t)), 255))
    s.node(mesh=s.add('meshes', {'primitives': [primitive(s, (points, normals, uvs, corners), s.add('materials', {'doubleSided': True}),
                                                          COLOR_0=s.accessor(colors, UBYTE, 'VEC4', normalized=True))]}), rotation=[-math.sqrt(0.5), 0, 0, math.sqrt(0.5)])
    return s


def main():
    corpus, out = map(pathlib.Path, sys.argv[1:3])
    out.mkdir(parents=True, exist_ok=True)
    for name, scene in (('spot', lambda: spot(corpus / 'meshes' / 'spot.obj')), ('car', car), ('arm', arm), ('head', head), ('torso', torso), ('terrain', terrain)):
        (out / f'{name}.glb').write_bytes(scene().glb())


if __name__ == '__main__':
    main()
