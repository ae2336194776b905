#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
"""Every GLB that the command writes, through the Khronos glTF validator: no errors, no warnings.

Needs node and `npm install --prefix tests/gltf`. Where they are missing the test fails, unless VSPLIT_NO_VALIDATOR=1 says that it may not run."""
from harness import *

SCRIPT = pathlib.Path(__file__).resolve().parent.parent / 'gltf' / 'validate.mjs'


class Validator(CommandTest):
    def setUp(self):
        super().setUp()
        have = shutil.which('node') and (SCRIPT.parent / 'node_modules' / 'gltf-validator').is_dir()
        if os.environ.get('VSPLIT_NO_VALIDATOR') == '1':
            print('SKIPPED: VSPLIT_NO_VALIDATOR=1, no GLB is validated', file=sys.stderr)
            self.skipTest('VSPLIT_NO_VALIDATOR=1')
        self.assertTrue(have, f'node or the package gltf-validator is missing: run npm install --prefix {SCRIPT.parent}, or set VSPLIT_NO_VALIDATOR=1')

    def validate(self, *names):
        process = subprocess.run(['node', SCRIPT, *names], cwd=self.folder, capture_output=True, timeout=120, check=False)
        return process.returncode, process.stdout.decode() + process.stderr.decode()

    def test_the_validator_finds_faults(self):
        self.sample('good.glb', 300)
        data = self.path('good.glb').read_bytes()
        self.write('bad.glb', data.replace(b'"POSITION"', b'"POSITIOM"'))
        self.write('cut.glb', data[:-7])
        self.assertEqual(self.validate('good.glb')[0], 0)
        self.assertEqual(self.validate('bad.glb')[0], 1)
        self.assertEqual(self.validate('cut.glb')[0], 1)

    def test_levels_and_chains(self):
        points, faces = bumpy_grid(12)
        self.write('weights.ply', encode_ply(points, faces, [1 + i % 3 for i in range(len(points))]))
        self.sample('whale.ply', 3000)
        self.sample('ocean.ply', 3000, 'ocean')
        # A flat sheet, a triangle, parts of which one is far off, triangles without area: normals and bounds have their traps.
        self.write('flat.obj', encode_obj([(x, y, 0.0) for x, y, _ in points], faces))
        self.write('one.obj', 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n')
        self.write('line.obj', 'v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 4\n')
        self.write('huge.obj', encode_obj([(x * 1e30, y * 1e30, z * 1e30) for x, y, z in points], faces))
        self.write('tiny.obj', encode_obj([(x * 1e-30, y * 1e-30, z * 1e-30) for x, y, z in points], faces))
        written = ['sample.glb']
        self.sample('sample.glb', 1000)
        for name in ('weights.ply', 'whale.ply', 'ocean.ply', 'flat.obj', 'one.obj', 'line.obj', 'huge.obj', 'tiny.obj'):
            stem = name.split('.')[0]
            self.vsplit('bake', name, '-o', f'{stem}.pmesh')
            for ratio in (1, 0.4, 0.05):
                out = f'{stem}-{ratio}.glb'
                self.vsplit('extract', f'{stem}.pmesh', '--ratio', ratio, '-o', out)
                written.append(out)
            for ratios in ('1', '1,0.6,0.4,0.1,0.01'):
                out = f'{stem}-lods-{len(ratios)}.glb'
                self.vsplit('lods', f'{stem}.pmesh', '--ratios', ratios, '-o', out)
                written.append(out)
        code, said = self.validate(*written)
        self.assertEqual(code, 0, said)
        self.assertEqual(said.count(': 0 errors, 0 warnings'), len(written), said)


if __name__ == '__main__':
    main()
