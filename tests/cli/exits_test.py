#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
"""Exit codes, and what is left behind: 0 done, 1 a check failed, 2 usage, 3 bad input, 4 output exists or cannot be written."""
import signal
import time

from harness import *
import harness


class Exits(CommandTest):
    def test_usage(self):
        self.baked()
        before = self.names()
        for args in ((), ('frobnicate',), ('bake',), ('bake', 'model.ply'), ('bake', 'model.ply', '-o'), ('bake', 'model.ply', '-o', 'x.pmesh', '--cost', 'cheap'),
                     ('bake', 'model.ply', '-o', 'x.pmesh', '--placement', 'middle'), ('bake', 'model.ply', '-o', 'x.pmesh', '--lock', 'everything'),
                     ('bake', 'model.ply', '-o', 'x.pmesh', '--profile', 'small'), ('bake', 'model.ply', '-o', 'x.pmesh', '--profile', 'stream', '--placement', 'optimal'),
                     ('bake', 'model.ply', '-o', 'x.pmesh', '--lock', 'features='), ('bake', 'model.ply', '-o', 'x.pmesh', '--lock', 'features=nan'),
                     ('bake', 'model.ply', '-o', 'x.pmesh', '--lock', 'features=200'), ('bake', 'model.ply', '-o', 'x.pmesh', '--weld', 'some'),
                     ('bake', 'model.ply', '-o', 'x.pmesh', '--threads', '-1'), ('bake', 'model.ply', '-o', 'x.pmesh', '--threads', '999999'),
                     ('bake', 'model.ply', '-o', 'x.pmesh', '--block-bytes', '10'), ('bake', 'model.ply', 'model.ply', '-o', 'x.pmesh'),
                     ('bake', 'model.ply', '-o', 'x.pmesh', '--weights', 'no_such_property'), ('bake', 'model.ply', '-o', 'x.pmesh', '--no-such-flag'),
                     ('extract', 'model.pmesh', '-o', 'x.ply'), ('extract', 'model.pmesh', '--ratio', '0.5', '--triangles', '7', '-o', 'x.ply'),
                     ('extract', 'model.pmesh', '--ratio', '1.5', '-o', 'x.ply'), ('extract', 'model.pmesh', '--ratio', '-0.5', '-o', 'x.ply'),
                     ('extract', 'model.pmesh', '--ratio', 'nan', '-o', 'x.ply'), ('extract', 'model.pmesh', '--ratio', 'half', '-o', 'x.ply'),
                     ('extract', 'model.pmesh', '--ratio', '%', '-o', 'x.ply'), ('extract', 'model.pmesh', '--ratio', '101%', '-o', 'x.ply'),
                     ('extract', 'model.pmesh', '--ratio', 'nan%', '-o', 'x.ply'), ('lods', 'model.pmesh', '--ratios', '50%,0%', '-o', 'x.glb'),
                     ('extract', 'model.pmesh', '--triangles', '-3', '-o', 'x.ply'), ('extract', 'model.pmesh', '--error', '-1', '-o', 'x.ply'),
                     ('extract', 'model.pmesh', '--error', 'nan', '-o', 'x.ply'),
                     ('extract', 'model.pmesh', '--ratio', '0.5', '-o', 'x.fbx'), ('extract', 'model.pmesh', '--ratio', '0.5', '-o', 'x'),
                     ('lods', 'model.pmesh', '-o', 'x.glb'), ('lods', 'model.pmesh', '--ratios', '1,2', '-o', 'x.glb'), ('lods', 'model.pmesh', '--ratios', '1,0', '-o', 'x.glb'),
                     ('lods', 'model.pmesh', '--ratios', '1,nan', '-o', 'x.glb'), ('lods', 'model.pmesh', '--ratios', 'a,b', '-o', 'x.glb'), ('lods', 'model.pmesh', '--ratios', '1,0.5', '-o', 'x.ply'),
                     ('sample', 'elephant', '--mesh', '-o', 'x.ply'), ('sample', 'whale', '-o', 'x.ply'), ('sample', 'whale', '--mesh', '--points', '9', '-o', 'x.ply'),
                     ('sample', 'whale', '--mesh', '--triangles', '1', '-o', 'x.ply'), ('sample', 'whale', '--mesh', '-o', 'x.stl'), ('sample', 'whale', '--points', '9', '-o', 'x.ply'),
                     ('info',), ('verify',)):
            with self.subTest(args):
                self.vsplit(*args, code=USAGE)
                self.assertEqual(self.names(), before)
                self.path('x.ply').unlink(missing_ok=True)

    def test_missing_and_unreadable_input(self):
        self.path('folder').mkdir()
        self.path('folder.ply').mkdir()
        self.path('folder.pmesh').mkdir()
        before = self.names()
        for name in ('missing.ply', 'missing.pmesh', 'folder', 'folder.ply', 'folder.pmesh', 'missing/deep.ply', 'n' * 300 + '.ply', ''):
            with self.subTest(name):
                for args in (('bake', name, '-o', 'x.pmesh'), ('info', name), ('verify', name), ('extract', name, '--ratio', '1', '-o', 'x.ply'),
                             ('lods', name, '--ratios', '1', '-o', 'x.glb')):
                    ran = self.vsplit(*args, code=BAD_INPUT)
                    self.assertIn(name, ran.err)
                    self.assertEqual(self.names(), before)
        self.sample('model.ply')
        self.vsplit('bake', 'model.ply', '-o', 'model.pmesh')
        self.vsplit('verify', 'model.pmesh', '--against', 'missing.ply', code=BAD_INPUT)
        if os.getuid() != 0:
            self.path('model.ply').chmod(0)
            self.vsplit('bake', 'model.ply', '-o', 'x.pmesh', code=BAD_INPUT)

    def test_output_exists(self):
        self.baked()
        self.write('there.pmesh', 'precious')
        self.write('there.glb', 'precious')
        self.write('there.ply', 'precious')
        for args in (('bake', 'model.ply', '-o', 'there.pmesh'), ('extract', 'model.pmesh', '--ratio', '0.5', '-o', 'there.glb'),
                     ('lods', 'model.pmesh', '--ratios', '1,0.5', '-o', 'there.glb'), ('sample', 'whale', '--mesh', '--triangles', '500', '-o', 'there.ply')):
            with self.subTest(args):
                ran = self.vsplit(*args, code=BAD_OUTPUT)
                self.assertIn(args[-1], ran.err)
                self.assertIn('--force', ran.err)
                self.assertEqual(self.path(args[-1]).read_bytes(), b'precious')
                self.vsplit(*args, '--force')
                self.assertNotEqual(self.path(args[-1]).read_bytes(), b'precious')
                self.path(args[-1]).write_bytes(b'precious')

    def test_bad_input_leaves_an_old_output_alone(self):
        self.write('bad.ply', 'ply\nformat ascii 1.0\nnonsense')
        self.write('old.pmesh', 'precious')
        self.vsplit('bake', 'bad.ply', '-o', 'old.pmesh', '--force', code=BAD_INPUT)
        self.assertEqual(self.path('old.pmesh').read_bytes(), b'precious')
        self.assertEqual(self.names(), ['bad.ply', 'old.pmesh'])

    def test_unwritable_output(self):
        self.baked()
        self.path('folder.pmesh').mkdir()
        before = self.names()
        for out in ('no/such/folder/x.pmesh', 'folder.pmesh', 'model.ply/x.pmesh', 'n' * 300 + '.pmesh'):
            with self.subTest(out):
                ran = self.vsplit('bake', 'model.ply', '-o', out, code=BAD_OUTPUT)
                self.assertIn(out, ran.err)
                self.assertEqual(self.names(), before)
        self.vsplit('bake', 'model.ply', '-o', '/dev/full', code=BAD_OUTPUT)
        # A full standard output is no success either.
        with open('/dev/full', 'wb') as full:
            process = subprocess.run([harness.VSPLIT, 'info', 'model.pmesh'], cwd=self.folder, stdout=full, stderr=subprocess.PIPE, check=False)
        self.assertEqual(process.returncode, BAD_OUTPUT)

    def test_input_as_output(self):
        self.baked()
        before = self.path('model.pmesh').read_bytes()
        self.vsplit('bake', 'model.ply', '-o', 'model.ply', code=BAD_OUTPUT)
        # By force a level may replace the file that it came of: it was read whole.
        self.vsplit('extract', 'model.pmesh', '--ratio', '1', '-o', 'model.ply', '--force')
        self.assertEqual(self.path('model.pmesh').read_bytes(), before)
        self.vsplit('verify', 'model.pmesh', '--against', 'model.ply')

    def test_verify_tells_another_mesh(self):
        self.baked(triangles=1200)
        points, faces = bumpy_grid(8)
        self.write('grid.obj', encode_obj(points, faces))
        other = [(x, y, f32(z + 1e-3) if i == 5 else z) for i, (x, y, z) in enumerate(points)]
        self.write('moved.obj', encode_obj(other, faces))
        self.write('turned.obj', encode_obj(points, [faces[0][::-1], *faces[1:]]))
        self.write('fewer.obj', encode_obj(points, faces[:-1]))
        self.vsplit('bake', 'grid.obj', '-o', 'grid.pmesh')
        self.vsplit('verify', 'grid.pmesh', '--against', 'grid.obj')
        for name in ('moved.obj', 'turned.obj', 'fewer.obj', 'model.ply'):
            with self.subTest(name):
                self.vsplit('verify', 'grid.pmesh', '--against', name, code=FAILED)
                report = json.loads(self.vsplit('verify', 'grid.pmesh', '--against', name, '--json', code=FAILED).out)
                self.assertFalse(report['passed'])
                quiet = self.vsplit('verify', 'grid.pmesh', '--against', name, '--quiet', code=FAILED)
                self.assertEqual(quiet.out, '')

    def test_verify_tells_other_weights(self):
        points, faces = bumpy_grid(8)
        self.write('grid.obj', encode_obj(points, faces))
        self.write('two.txt', '2\n' * len(points))
        self.write('three.txt', '3\n' * len(points))
        self.vsplit('bake', 'grid.obj', '--weights', 'two.txt', '-o', 'grid.pmesh')
        self.vsplit('verify', 'grid.pmesh', '--against', 'grid.obj', '--weights', 'two.txt')
        self.vsplit('verify', 'grid.pmesh', '--against', 'grid.obj', '--weights', 'three.txt', code=FAILED)

    def test_bad_weights(self):
        points, faces = bumpy_grid(4)
        self.write('grid.obj', encode_obj(points, faces))
        for text, place in (('1\n2\n', 'weights.txt'), ('1\n' * 100, 'weights.txt'), ('1\n' * 20 + 'x\n' + '1\n' * 4, '21'), ('1\n' * 24 + '-1\n', '25'),
                            ('1\n' * 24 + 'nan\n', '25'), ('', 'weights.txt'), ('\0' * 50, 'weights.txt')):
            with self.subTest(text[:20]):
                self.write('weights.txt', text)
                ran = self.run_vsplit('bake', 'grid.obj', '--weights', 'weights.txt', '-o', 'x.pmesh')
                self.assertIn(ran.code, (USAGE, BAD_INPUT))
                self.assertIn('weights.txt', ran.err)
                self.assertIn(place, ran.err)
                self.assertFalse(self.path('x.pmesh').exists())

    def test_killed_bake_leaves_no_output(self):
        self.sample('big.ply', 60000)
        started = time.monotonic()
        self.vsplit('bake', 'big.ply', '-o', 'whole.pmesh')
        whole = time.monotonic() - started
        killed = 0
        for step in range(1, 9):
            process = subprocess.Popen([harness.VSPLIT, 'bake', 'big.ply', '-o', 'killed.pmesh', '--quiet'], cwd=self.folder)
            time.sleep(whole * step / 9)
            process.send_signal(signal.SIGKILL if step % 2 else signal.SIGTERM)
            process.wait()
            if process.returncode < 0:
                killed += 1
                # What may be left has another name; under the final one there is nothing, or all (killed after the rename).
                if self.path('killed.pmesh').exists():
                    self.vsplit('verify', 'killed.pmesh', '--quiet')
                    self.path('killed.pmesh').unlink()
            elif self.path('killed.pmesh').exists():
                self.path('killed.pmesh').unlink()
        self.assertGreater(killed, 2, 'the bakes ended before they could be killed')

    def test_empty_mesh_is_said(self):
        for name, text in (('no-faces.obj', 'v 0 0 0\nv 1 0 0\nv 0 1 0\n'), ('empty.off', 'OFF\n0 0 0\n'), ('all-degenerate.obj', 'v 0 0 0\nv 1 0 0\nf 1 1 2\n'),
                           ('nan.obj', 'v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n')):
            self.write(name, text)
            ran = self.vsplit('bake', name, '-o', 'x.pmesh', code=BAD_INPUT)
            self.assertIn(name, ran.err)
            self.assertFalse(self.path('x.pmesh').exists())


if __name__ == '__main__':
    main()
