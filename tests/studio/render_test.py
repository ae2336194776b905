#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
"""render_test.py VSPLIT: `vsplit render` draws what it is told, off the screen, on an X server that xvfb-run gives."""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

VSPLIT = ''


class RenderTest(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix='vsplit-render-'))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)

    def run_vsplit(self, *arguments, display=True, code=0, name=None):
        command = [VSPLIT, *map(str, arguments)]
        environment = dict(os.environ)
        if display:
            command = ['xvfb-run', '-a', *command]
        else:
            environment.pop('DISPLAY', None)
            if name:
                environment['DISPLAY'] = name
        ran = subprocess.run(command, cwd=self.folder, env=environment, capture_output=True, timeout=120, check=False)
        self.assertEqual(ran.returncode, code, ran.stderr.decode())
        return ran

    def pixels(self, name):
        return subprocess.run(['convert', str(self.folder / name), 'rgb:-'], capture_output=True, check=True).stdout

    def test_pictures(self):
        self.run_vsplit('sample', 'whale', '--mesh', '--triangles', 3000, '-o', 'whale.ply', display=False)
        self.run_vsplit('sample', 'whale', '--mesh', '--triangles', 3000, '-o', 'whale.glb', display=False)
        self.run_vsplit('sample', 'ocean', '--points', 2000, '-o', 'ocean.xyz', display=False)
        self.run_vsplit('bake', 'whale.ply', '-o', 'whale.pmesh', display=False)
        seen = set()
        size = ('--size', '320x240')
        for i, how in enumerate([('whale.pmesh',), ('whale.pmesh', '--ratio', '0.1'), ('whale.ply', '--view', 'top'), ('whale.glb', '--view', '20,-40'),
                                 ('whale.pmesh', '--heat', 'curvature'), ('whale.pmesh', '--ratio', '0.2', '--heat', 'error'), ('whale.pmesh', '--heat', 'quality'),
                                 ('whale.pmesh', '--wireframe'), ('whale.pmesh', '--flat'), ('ocean.xyz',)]):
            with self.subTest(how=how):
                self.run_vsplit('render', *how, *size, '-o', f'{i}.png')
                pixels = self.pixels(f'{i}.png')
                self.assertEqual(len(pixels), 3 * 320 * 240)
                # Something is drawn on the background's few greys.
                self.assertGreater(len({pixels[k:k + 3] for k in range(0, len(pixels), 3)}), 40 if how != ('ocean.xyz',) else 10)
                seen.add(pixels)
        self.assertEqual(len(seen), 10, 'two pictures are the same')
        # Twice the same is the same.
        self.run_vsplit('render', 'whale.pmesh', *size, '-o', 'again.png')
        self.assertEqual(self.pixels('again.png'), self.pixels('0.png'))
        ran = self.run_vsplit('render', 'whale.pmesh', '--ratio', '0.25', '-o', 'told.png', '--json')
        told = json.loads(ran.stdout)
        self.assertEqual((told['output'], told['size'], told['bytes']), ('told.png', '1280x800', (self.folder / 'told.png').stat().st_size))
        self.assertAlmostEqual(told['ratio'], 0.25, delta=0.01)
        self.assertGreater(told['error'], 0)
        # Without a display, and with one that is not there: an answer, and no picture.
        for display in (None, ':4242'):
            for command in (('render', 'whale.pmesh', '-o', 'x.png'), ('studio', 'whale.pmesh')):
                ran = self.run_vsplit(*command, display=False, code=3, name=display)
                self.assertIn('xvfb-run', ran.stderr.decode())
        self.assertFalse((self.folder / 'x.png').exists())
        self.run_vsplit('render', 'whale.pmesh', '-o', 'x.gif', display=False, code=2)
        self.run_vsplit('render', 'whale.pmesh', '--view', 'inside', '-o', 'x.png', display=False, code=2)
        self.run_vsplit('render', 'whale.pmesh', '--size', '1x1', '-o', 'x.png', display=False, code=2)
        self.run_vsplit('render', 'whale.pmesh', '-o', '0.png', code=4)


if __name__ == '__main__':
    if len(sys.argv) != 2 or not os.access(sys.argv[1], os.X_OK):
        sys.exit(__doc__)
    VSPLIT = os.path.abspath(sys.argv.pop())
    unittest.main()
