#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
"""Malformed files: an error that names the file and the place, exit 3, and nothing left behind; never a crash."""
import random
import re

from harness import *

# "(offset 12)", "(line 3)", or the name of an object in a glTF: "meshes[3].primitives[0]".
PLACE = re.compile(r'\(offset \d+\)|\(line \d+\)|\w+\[\d+\]')


class Malformed(CommandTest):
    def refuse(self, args, name, place=True):
        ran = self.vsplit(*args, code=BAD_INPUT)
        self.assertIn(name, ran.err)
        # A file that holds no triangle at all is at fault as a whole.
        if place and 'no triangle in it' not in ran.err:
            self.assertRegex(ran.err, PLACE)
        self.assertEqual(len(ran.err.strip().splitlines()), 1, ran.err)
        self.nothing_left()

    def nothing_left(self):
        left = [n for n in self.names() if n.startswith('out') or '.tmp' in n]
        self.assertEqual(left, [])

    def takes_or_refuses(self, args, name):
        """For damage that may leave a file valid: done, or refused as it should be."""
        ran = self.run_vsplit(*args)
        self.assertIn(ran.code, (DONE, BAD_INPUT), ran.err)
        if ran.code == BAD_INPUT:
            self.assertIn(name, ran.err)
            self.nothing_left()
        for out in ('out.pmesh', 'out.ply'):
            self.path(out).unlink(missing_ok=True)
        return ran.code

    def commands(self, name):
        return (('info', name), ('verify', name), ('extract', name, '--ratio', '0.5', '-o', 'out.ply'), ('lods', name, '--ratios', '1,0.5', '-o', 'out.glb'))

    def test_pmesh_cut_anywhere(self):
        self.baked(triangles=300)
        data = self.path('model.pmesh').read_bytes()
        sizes = sorted({0, 1, 7, 8, 11, 12, 100, 119, 120, 121, len(data) // 2, len(data) - 1, *random.Random(1).sample(range(len(data)), 25)})
        for size in sizes:
            self.write('cut.pmesh', data[:size])
            for args in self.commands('cut.pmesh')[:4 if size % 4 == 0 else 1] + (('verify', 'cut.pmesh'),):
                with self.subTest(size=size, command=args[0]):
                    self.refuse(args, 'cut.pmesh')

    def test_pmesh_flipped_anywhere(self):
        self.baked(triangles=300)
        data = self.path('model.pmesh').read_bytes()
        chance = random.Random(2)
        for _ in range(80):
            at, bit = chance.randrange(len(data)), chance.randrange(8)
            flipped = bytearray(data)
            flipped[at] ^= 1 << bit
            self.write('flipped.pmesh', bytes(flipped))
            with self.subTest(at=at, bit=bit):
                self.refuse(('verify', 'flipped.pmesh'), 'flipped.pmesh')
                self.refuse(('extract', 'flipped.pmesh', '--ratio', '0.5', '-o', 'out.ply'), 'flipped.pmesh')

    def test_pmesh_with_more_behind(self):
        self.baked(triangles=300)
        data = self.path('model.pmesh').read_bytes()
        self.write('more.pmesh', data + b'x')
        self.write('twice.pmesh', data + data)
        for name in ('more.pmesh', 'twice.pmesh'):
            for args in self.commands(name):
                self.refuse(args, name)

    def test_other_formats_under_a_wrong_name(self):
        points, faces = bumpy_grid(4)
        self.sample('scene.glb', 300)
        self.baked(triangles=300)
        contents = {'ply': encode_ply(points, faces), 'obj': encode_obj(points, faces).encode(), 'off': encode_off(points, faces).encode(),
                    'stl': encode_stl_binary(points, faces), 'glb': self.path('scene.glb').read_bytes(),
                    'png': b'\x89PNG\r\n\x1a\n' + bytes(range(256)) * 4, 'zip': b'PK\x03\x04' + bytes(500), 'text': b'Call me Ishmael.\n' * 30, 'zeros': bytes(2000),
                    'xml': b'<?xml version="1.0"?><COLLADA/>', 'json': b'{"asset": 3}', 'elf': pathlib.Path(sys.executable).read_bytes()[:5000],
                    'utf16': 'v 0 0 0\nf 1 1 1\n'.encode('utf-16'), 'pmesh': self.path('model.pmesh').read_bytes()}
        for kind, data in contents.items():
            if kind != 'pmesh':
                self.write('wrong.pmesh', data)
                for args in self.commands('wrong.pmesh'):
                    with self.subTest(kind, as_='pmesh'):
                        self.refuse(args, 'wrong.pmesh')
            for extension in ('ply', 'obj', 'off', 'stl', 'glb', 'gltf', 'pmesh', 'xyz', ''):
                name = 'wrong.' + extension if extension else 'wrong'
                self.write(name, data)
                with self.subTest(kind, as_=extension):
                    code = self.takes_or_refuses(('bake', name, '-o', 'out.pmesh'), name)
                    # What no one could take for a mesh is refused under any name.
                    if kind in ('png', 'zip', 'text', 'zeros', 'xml', 'json', 'elf', 'utf16', 'pmesh'):
                        self.assertEqual(code, BAD_INPUT)

    def test_empty_files(self):
        for extension in ('ply', 'obj', 'off', 'stl', 'glb', 'gltf'):
            name = 'empty.' + extension
            self.write(name, b'')
            self.refuse(('bake', name, '-o', 'out.pmesh'), name)
        self.write('empty.pmesh', b'')
        for args in self.commands('empty.pmesh'):
            self.refuse(args, 'empty.pmesh')

    def inputs(self):
        points, faces = bumpy_grid(6)
        self.sample('scene.glb', 200)
        return {'a.ply': encode_ply(points, faces), 'l.ply': encode_ply(points, faces, [1.0] * len(points), 'binary_little_endian'),
                'b.ply': encode_ply(points, faces, form='binary_big_endian'), 'o.obj': encode_obj(points, faces).encode(),
                'f.off': encode_off(points, faces).encode(), 's.stl': encode_stl_binary(points, faces), 't.stl': encode_stl_ascii(points, faces).encode(),
                'g.glb': self.path('scene.glb').read_bytes()}

    def test_inputs_cut(self):
        chance = random.Random(3)
        for name, data in self.inputs().items():
            # A text cut at a line's end, or within a number, may be a smaller mesh; binary files say how long they are.
            binary = name in ('l.ply', 'b.ply', 's.stl', 'g.glb')
            for size in sorted({1, 5, 20, len(data) - 1, *chance.sample(range(len(data)), 12)}):
                self.write(name, data[:size])
                with self.subTest(name, size=size):
                    if binary:
                        self.refuse(('bake', name, '-o', 'out.pmesh'), name)
                    else:
                        self.takes_or_refuses(('bake', name, '-o', 'out.pmesh'), name)

    def test_inputs_flipped(self):
        chance = random.Random(4)
        for name, data in self.inputs().items():
            for _ in range(25):
                broken = bytearray(data)
                for _ in range(chance.randrange(1, 4)):
                    broken[chance.randrange(len(data))] ^= 1 << chance.randrange(8)
                self.write(name, bytes(broken))
                with self.subTest(name):
                    self.takes_or_refuses(('bake', name, '-o', 'out.pmesh'), name)

    def test_absurd_counts(self):
        big = 2 ** 31 - 1
        cases = {
            'vertices.ply': f'ply\nformat binary_little_endian 1.0\nelement vertex {big}\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n',
            'more.ply': f'ply\nformat ascii 1.0\nelement vertex 99999999999999999999999\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n',
            'faces.ply': f'ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face {big}\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n',
            'negative.ply': 'ply\nformat ascii 1.0\nelement vertex -3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n',
            'counts.off': f'OFF\n{big} {big} 0\n0 0 0\n',
            'corners.off': f'OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n{big} 0 1 2\n',
            'index.off': 'OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n',
            'index.obj': 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n',
            'zero.obj': 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n',
            'huge.obj': 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999999999999999\n',
            'back.obj': 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf -1 -2 -4\n',
            'count.stl': bytes(80) + struct.pack('<I', 0xFFFFFFFF) + bytes(50),
            'length.glb': struct.pack('<4sII', b'glTF', 2, 0xFFFFFFFF) + struct.pack('<I4s', 0xFFFFFFF0, b'JSON') + b'{}  ',
            'deep.gltf': '{"asset":{"version":"2.0"},"x":' + '[' * 200000,
            'accessor.gltf': json.dumps({'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': [0]}], 'nodes': [{'mesh': 0}],
                                         'meshes': [{'primitives': [{'attributes': {'POSITION': 0}}]}],
                                         'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': big, 'type': 'VEC3', 'min': [0, 0, 0], 'max': [1, 1, 1]}],
                                         'bufferViews': [{'buffer': 0, 'byteLength': 36}],
                                         'buffers': [{'byteLength': 36, 'uri': 'data:application/octet-stream;base64,' + 'A' * 48}]}),
            'cycle.gltf': json.dumps({'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': [0]}], 'nodes': [{'children': [1]}, {'children': [0]}]}),
            'escape.gltf': json.dumps({'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': [0]}], 'nodes': [{'mesh': 0}],
                                       'meshes': [{'primitives': [{'attributes': {'POSITION': 0}}]}],
                                       'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': 3, 'type': 'VEC3', 'min': [0, 0, 0], 'max': [1, 1, 1]}],
                                       'bufferViews': [{'buffer': 0, 'byteLength': 36}], 'buffers': [{'byteLength': 36, 'uri': '../../../../etc/passwd'}]}),
        }
        for name, data in cases.items():
            self.write(name, data)
            with self.subTest(name):
                ran = self.vsplit('bake', name, '-o', 'out.pmesh', code=BAD_INPUT, timeout=20)
                self.assertIn(name, ran.err)
                self.assertNotIn('memory', ran.err)
                self.nothing_left()


if __name__ == '__main__':
    main()
