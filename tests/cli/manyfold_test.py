#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
"""GLBs of MANYFOLD_mesh_progressive: written, looked at, replayed by a reader of the test's own, damaged."""
from harness import *

from scenes_test import SceneTest

EXTENSION = 'MANYFOLD_mesh_progressive'


def parts_of(glb):
    size = struct.unpack_from('<I', glb, 12)[0]
    return json.loads(glb[20:20 + size]), glb[28 + size:]


def rows(document, data, accessor):
    a = document['accessors'][accessor]
    view = document['bufferViews'][a['bufferView']]
    width = {'SCALAR': 1, 'VEC3': 3}[a['type']]
    kind = {5125: 'I', 5126: 'f'}[a['componentType']]
    stride = view.get('byteStride', 4 * width)
    at = view['byteOffset'] + a.get('byteOffset', 0)
    return [struct.unpack_from(f'<{width}{kind}', data, at + i * stride) for i in range(a['count'])]


def replay(path):
    """The full mesh, by the words of formats/gltf/MANYFOLD_mesh_progressive.md and nothing else: points and faces."""
    document, data = parts_of(path.read_bytes())
    primitive = document['meshes'][0]['primitives'][0]
    points = [list(p) for p in rows(document, data, primitive['attributes']['POSITION'])]
    corners = [i for i, in rows(document, data, primitive['indices'])]
    faces = [corners[i:i + 3] for i in range(0, len(corners), 3)]
    around = [set() for _ in points]
    for number, face in enumerate(faces):
        for v in face:
            around[v].add(number)
    extension = primitive['extensions'][EXTENSION]
    splits, moves = (rows(document, data, a) for a in (extension['indices'], extension['attributes']['POSITION']))
    assert len(splits) == len(moves)
    for (vs, vl, vr), d in zip(splits, moves):
        vt = len(points)
        points.append([f32(a + b) for a, b in zip(points[vs], d)])
        points[vs] = [f32(a - b) for a, b in zip(points[vs], d)]
        wings = {}
        for number in around[vs]:
            face = faces[number]
            k = face.index(vs)
            wings[face[(k + 1) % 3]] = (face[(k + 2) % 3], number)
        ends = {to for to, _ in wings.values()}
        at = vr if vr != vs else next((a for a in wings if a not in ends), None)
        if vr == vs and vl not in ends:
            at = vl  # nothing before it
        goes = []
        while at != vl and at in wings:
            at, number = wings[at]
            goes.append(number)
        around.append(set(goes))
        around[vs] -= set(goes)
        for number in goes:
            faces[number] = [vt if v == vs else v for v in faces[number]]
        for face in ([vs, vt, vl] if vl != vs else None, [vt, vs, vr] if vr != vs else None):
            if face is None:
                continue
            for v in face:
                around[v].add(len(faces))
            faces.append(face)
    return points, faces


def keys(points, faces, scale):
    """Faces by their corners' places, rounded."""
    out = []
    for face in faces:
        corners = [tuple(round(c * scale) for c in points[v]) for v in face]
        k = corners.index(min(corners))
        out.append(tuple(corners[k:] + corners[:k]))
    return sorted(out)


class Manyfold(SceneTest):
    def setUp(self):
        CommandTest.setUp(self)

    def test_what_is_written_replays_by_the_page_alone(self):
        # A power of two as coordinates' unit, so that halves of halves stay exact enough to be rounded back.
        for name, kind, triangles in (('whale.ply', 'whale', 1500), ('ocean.ply', 'ocean', 900)):
            self.sample(name, triangles, kind)
            said = self.json('bake', name, '--manyfold', '-o', 'out.glb', '-f')
            source = read_ply(self.path(name))
            points, faces = replay(self.path('out.glb'))
            self.assertEqual(len(faces), len(source.faces), name)
            self.assertEqual(len(points), len(source.points), name)
            self.assertLess(said['base']['triangles'], 0.2 * len(faces), name)
            size = max(abs(c) for p in source.points for c in p)
            nearest = sorted(tuple(p) for p in points)
            for a, b in zip(nearest, sorted(source.points)):
                self.assertLess(max(abs(x - y) for x, y in zip(a, b)), 1e-5 * size)
            info = self.json('info', 'out.glb')
            self.assertEqual((info['records'], info['sound'], info['fault']), (said['records'], said['records'], ''))
            self.assertEqual(info['triangles'], len(faces))
            # Our own reader: the same faces, at full and at a coarse level.
            self.vsplit('extract', 'out.glb', '--ratio', 1, '-o', 'full.ply', '-f')
            full = read_ply(self.path('full.ply'))
            self.assertEqual(keys(full.points, full.faces, 1e4 / size), keys(points, faces, 1e4 / size))
            half = self.json('extract', 'out.glb', '--ratio', 0.5, '-o', 'half.glb', '-f')
            self.assertAlmostEqual(half['ratio'], 0.5, delta=0.01)
            self.assertGreater(half['error'], 0)
            self.vsplit('lods', 'out.glb', '--ratios', '1,0.4', '-o', 'lods.glb', '-f')

    def test_the_validator_says_nothing(self):
        self.sample('whale.ply', 1500)
        self.vsplit('bake', 'whale.ply', '--manyfold', '-o', 'out.glb')
        self.assertEqual(self.validate(['out.glb']), {'out.glb': []})

    def test_damaged_records(self):
        self.sample('whale.ply', 1500)
        self.vsplit('bake', 'whale.ply', '--manyfold', '-o', 'sound.glb')
        glb = bytearray(self.path('sound.glb').read_bytes())
        document, data = parts_of(bytes(glb))
        extension = document['meshes'][0]['primitives'][0]['extensions'][EXTENSION]
        view = document['bufferViews'][document['accessors'][extension['indices']]['bufferView']]
        records = document['accessors'][extension['indices']]['count']
        start = len(glb) - len(data) + view['byteOffset']
        at = start + 100 * view['byteStride']
        for offset, value in ((0, b'\xff\xff\xff\x7f'), (4, glb[at + 8:at + 12]), (12, b'\0\0\xc0\x7f')):
            bad = bytearray(glb)
            bad[at + offset:at + offset + 4] = value
            self.write('bad.glb', bytes(bad))
            self.assertIn('record 100 of', self.vsplit('info', 'bad.glb', code=BAD_INPUT).err)
            said = self.json('info', 'bad.glb', code=BAD_INPUT)
            self.assertEqual((said['sound'], said['records']), (100, records))
            self.assertTrue(said['fault'])
            ran = self.vsplit('extract', 'bad.glb', '--ratio', 1, '-o', 'part.ply', '-f')
            self.assertIn('record 100 of', ran.err)
            self.assertLess(len(read_ply(self.path('part.ply')).faces), 1500)
        for size in (20, len(glb) - len(data), start + 10, at, len(glb) - 4):
            self.write('cut.glb', bytes(glb[:size]))
            self.vsplit('info', 'cut.glb', code=BAD_INPUT)
            self.vsplit('extract', 'cut.glb', '--ratio', 1, '-o', 'never.ply', code=BAD_INPUT)
        self.assertNotIn('never.ply', self.names())

    def test_options_that_do_not_go_together(self):
        self.sample('whale.ply', 500)
        for flags in (['-o', 'x.pmesh'], ['--draco', '-o', 'x.glb'], ['--meshopt', '-o', 'x.glb'], ['--show', '0.5', '-o', 'x.glb'],
                      ['--lossless', '-o', 'x.glb']):
            self.vsplit('bake', 'whale.ply', '--manyfold', *flags, code=USAGE)
        self.write('x.glb', 'precious')
        self.vsplit('bake', 'whale.ply', '--manyfold', '-o', 'x.glb', code=BAD_OUTPUT)
        self.assertEqual(self.path('x.glb').read_text(), 'precious')


if __name__ == '__main__':
    del SceneTest  # a base, not a test
    main()
