# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
"""What the tests of the command share: running it, files to feed it, and reading what it wrote. Standard library only.

Every test file is run as `python3 FILE_test.py VSPLIT [CORPUS]`; CTest passes both."""
import json
import math
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile
import unittest

DONE, FAILED, USAGE, BAD_INPUT, BAD_OUTPUT = 0, 1, 2, 3, 4

VSPLIT = ''
CORPUS = pathlib.Path()


class Ran:
    def __init__(self, process):
        self.code = process.returncode
        self.out = process.stdout.decode('utf-8', 'replace')
        self.err = process.stderr.decode('utf-8', 'replace')


class CommandTest(unittest.TestCase):
    """Each test has a folder of its own, which is the working directory of what it runs."""

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix='vsplit-cli-'))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def run_vsplit(self, *args, timeout=120):
        """Runs the command; a crash or a hang fails the test, whatever it asks for."""
        process = subprocess.run([VSPLIT, *map(str, args)], cwd=self.folder, stdin=subprocess.DEVNULL, capture_output=True,
                                 timeout=timeout, check=False)
        ran = Ran(process)
        self.assertGreaterEqual(ran.code, 0, f'killed by signal {-ran.code}: vsplit {args}\n{ran.err}')
        self.assertNotIn('Sanitizer', ran.err)
        self.assertNotIn('runtime error', ran.err)
        return ran

    def vsplit(self, *args, code=DONE, timeout=120):
        ran = self.run_vsplit(*args, timeout=timeout)
        self.assertEqual(ran.code, code, f'vsplit {" ".join(map(str, args))}\nout: {ran.out}\nerr: {ran.err}')
        if code != DONE:
            self.assertTrue(ran.err.strip() or (code == FAILED and 'FAIL' in ran.out), 'an error that says nothing')
        return ran

    def json(self, *args, code=DONE):
        ran = self.vsplit(*args, '--json', code=code)
        return json.loads(ran.out)

    def path(self, name):
        return self.folder / name

    def write(self, name, data):
        if isinstance(data, str):
            data = data.encode()
        self.path(name).write_bytes(data)
        return name

    def names(self):
        return sorted(entry.name for entry in self.folder.iterdir())

    def sample(self, name, triangles=1200, kind='whale'):
        self.vsplit('sample', kind, '--mesh', '--triangles', triangles, '-o', name)
        return name

    def baked(self, name='model.pmesh', triangles=1200, kind='whale'):
        self.sample('model.ply', triangles, kind)
        self.vsplit('bake', 'model.ply', '-o', name)
        return name


def encode_off(points, faces):
    lines = ['OFF', f'{len(points)} {len(faces)} 0']
    lines += [' '.join(repr(c) for c in p) for p in points]
    lines += [' '.join(map(str, [len(f), *f])) for f in faces]
    return '\n'.join(lines) + '\n'


def encode_stl_ascii(points, faces):
    lines = ['solid test']
    for face in faces:
        lines += ['facet normal 0 0 0', 'outer loop', *('vertex ' + ' '.join(repr(c) for c in points[v]) for v in face), 'endloop', 'endfacet']
    return '\n'.join(lines + ['endsolid test']) + '\n'


def encode_stl_binary(points, faces):
    data = bytes(80) + struct.pack('<I', len(faces))
    for face in faces:
        data += struct.pack('<3f', 0, 0, 0) + b''.join(struct.pack('<3f', *points[v]) for v in face) + b'\0\0'
    return data


def encode_ply(points, faces, weights=None, form='ascii', name='quality'):
    head = f'ply\nformat {form} 1.0\nelement vertex {len(points)}\nproperty float x\nproperty float y\nproperty float z\n'
    if weights is not None:
        head += f'property float {name}\n'
    head += f'element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n'
    rows = [list(p) + ([weights[i]] if weights is not None else []) for i, p in enumerate(points)]
    if form == 'ascii':
        return (head + ''.join(' '.join(repr(c) for c in row) + '\n' for row in rows) +
                ''.join(' '.join(map(str, [len(f), *f])) + '\n' for f in faces)).encode()
    order = '<' if 'little' in form else '>'
    return head.encode() + b''.join(struct.pack(f'{order}{len(row)}f', *row) for row in rows) + \
        b''.join(struct.pack(f'{order}B{len(f)}i', len(f), *f) for f in faces)


def encode_obj(points, faces):
    return ''.join('v ' + ' '.join(repr(c) for c in p) + '\n' for p in points) + \
        ''.join('f ' + ' '.join(str(v + 1) for v in f) + '\n' for f in faces)


def f32(value):
    return struct.unpack('<f', struct.pack('<f', value))[0]


def bumpy_grid(n):
    """n * n cells, 2 n^2 triangles, one boundary; coordinates that a float holds exactly."""
    points = [(f32(j / n), f32(i / n), f32(0.1 * math.sin(5 * i / n) * math.cos(7 * j / n))) for i in range(n + 1) for j in range(n + 1)]
    faces = []
    for i in range(n):
        for j in range(n):
            a = i * (n + 1) + j
            faces += [(a, a + 1, a + n + 2), (a, a + n + 2, a + n + 1)]
    return points, faces


class Mesh:
    def __init__(self, points, faces, weights=None):
        self.points, self.faces, self.weights = points, faces, weights

    def edges(self):
        """Uses of every edge, as a dictionary of sorted pairs."""
        uses = {}
        for a, b, c in self.faces:
            for edge in ((a, b), (b, c), (c, a)):
                key = (min(edge), max(edge))
                uses[key] = uses.get(key, 0) + 1
        return uses

    def boundary_edges(self):
        return sum(1 for n in self.edges().values() if n == 1)

    def non_manifold_edges(self):
        return sum(1 for n in self.edges().values() if n > 2)

    def degenerate(self):
        count = 0
        for face in self.faces:
            a, b, c = (self.points[v] for v in face)
            u, v = [b[i] - a[i] for i in range(3)], [c[i] - a[i] for i in range(3)]
            n = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
            count += len(set(face)) < 3 or n == (0, 0, 0)
        return count

    def triangle_set(self):
        """Triangles by their corners' coordinates: the same however vertices are numbered."""
        result = []
        for face in self.faces:
            corners = [tuple(self.points[v]) for v in face]
            first = corners.index(min(corners))
            result.append(tuple(corners[first:] + corners[:first]))
        return sorted(result)


def read_ply(path):
    """What vsplit writes: binary little endian, float x y z and perhaps quality, triangles."""
    data = pathlib.Path(path).read_bytes()
    end = data.index(b'end_header\n') + len(b'end_header\n')
    head = data[:end].decode().splitlines()
    count = {line.split()[1]: int(line.split()[2]) for line in head if line.startswith('element')}
    vertex_properties = head[head.index(f'element vertex {count["vertex"]}') + 1:head.index(f'element face {count["face"]}')]
    names = [line.split()[-1] for line in vertex_properties]
    assert all(line.split()[1] == 'float' for line in vertex_properties), vertex_properties
    rows = list(struct.iter_unpack(f'<{len(names)}f', data[end:end + 4 * len(names) * count['vertex']]))
    faces = [face[1:] for face in struct.iter_unpack('<B3i', data[end + 4 * len(names) * count['vertex']:])]
    assert len(rows) == count['vertex'] and len(faces) == count['face']
    at = names.index('quality') if 'quality' in names else None
    return Mesh([row[:3] for row in rows], faces, [row[at] for row in rows] if at is not None else None)


def read_obj(path):
    points, faces = [], []
    for line in pathlib.Path(path).read_text().splitlines():
        words = line.split()
        if words[:1] == ['v']:
            points.append(tuple(f32(float(c)) for c in words[1:4]))
        elif words[:1] == ['f']:
            faces.append(tuple(int(w.split('/')[0]) - 1 for w in words[1:]))
    return Mesh(points, faces)


def glb_json(path):
    data = pathlib.Path(path).read_bytes()
    magic, version, length = struct.unpack_from('<4sII', data)
    assert magic == b'glTF' and version == 2 and length == len(data)
    size, kind = struct.unpack_from('<I4s', data, 12)
    assert kind == b'JSON'
    return json.loads(data[20:20 + size])


def glb_triangles(document, mesh=0):
    return sum(document['accessors'][p['indices']]['count'] // 3 for p in document['meshes'][mesh]['primitives'])


def main():
    global VSPLIT, CORPUS
    if len(sys.argv) < 2 or not os.access(sys.argv[1], os.X_OK):
        sys.exit(f'usage: {sys.argv[0]} VSPLIT [CORPUS] [unittest arguments]')
    # The test files import this module by its name; as __main__'s import it is the same one.
    VSPLIT = os.path.abspath(sys.argv[1])
    CORPUS = pathlib.Path(sys.argv[2] if len(sys.argv) > 2 else 'no corpus').absolute()
    unittest.main(module='__main__', argv=[sys.argv[0], *sys.argv[3:]])
