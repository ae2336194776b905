#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
"""The way through, for every format: bake, info, extract, lods, verify; and what comes out is what went in."""
from harness import *


class Formats(CommandTest):
    def inputs(self):
        """One surface in every format, n-gons too: (file, its triangles)."""
        points, faces = bumpy_grid(16)
        quads = [(a, b, c, d) for (a, b, c), (_, _, d) in zip(faces[::2], faces[1::2])]
        weights = [1 + i % 5 for i in range(len(points))]
        self.write('off.off', encode_off(points, faces))
        self.write('quads.off', encode_off(points, quads))
        self.write('stl-ascii.stl', encode_stl_ascii(points, faces))
        self.write('stl-binary.stl', encode_stl_binary(points, faces))
        self.write('obj.obj', encode_obj(points, faces))
        self.write('quads.obj', encode_obj(points, quads))
        for form in ('ascii', 'binary_little_endian', 'binary_big_endian'):
            self.write(f'{form}.ply', encode_ply(points, faces, form=form))
            self.write(f'{form}-weights.ply', encode_ply(points, faces, weights, form))
        names = [n for n in self.names() if n.rpartition('.')[2] in ('off', 'stl', 'obj', 'ply')]
        return names, Mesh(points, faces)

    def test_every_text_and_binary_format_comes_back(self):
        names, mesh = self.inputs()
        self.assertEqual(len(names), 12)
        for name in names:
            with self.subTest(name):
                out = name + '.pmesh'
                self.vsplit('bake', name, '-o', 'rounded-' + out)
                self.vsplit('verify', 'rounded-' + out, '--against', name)
                self.vsplit('bake', name, '--lossless', '-o', out)
                self.vsplit('verify', out, '--against', name)
                self.vsplit('extract', out, '--ratio', 1, '-o', name + '.full.ply')
                back = read_ply(self.path(name + '.full.ply'))
                self.assertEqual(len(back.points), len(mesh.points))
                if 'quads' not in name:
                    self.assertEqual(back.triangle_set(), mesh.triangle_set())
                self.assertEqual(back.weights is not None, 'weights' in name)

    def test_samples_in_every_format_give_the_same_surface(self):
        sizes = set()
        for kind in ('whale', 'ocean'):
            for extension in ('ply', 'obj', 'glb'):
                name = f'{kind}.{extension}'
                self.sample(name, 1500, kind)
                self.vsplit('bake', name, '-o', name + '.pmesh')
                self.vsplit('verify', name + '.pmesh', '--against', name)
                self.vsplit('extract', name + '.pmesh', '--ratio', 1, '-o', name + '.obj')
            same = {tuple(read_obj(self.path(f'{kind}.{e}.obj')).triangle_set()) for e in ('ply', 'obj', 'glb')}
            self.assertEqual(len(same), 1, f'{kind}: PLY, OBJ and GLB hold different surfaces')
            sizes.add(len(same.pop()))
            # A file that another was written of is that one's equal.
            self.vsplit('verify', f'{kind}.ply.pmesh', '--against', f'{kind}.obj')
        self.assertEqual(len(sizes), 2)

    def test_whale_is_closed_and_ocean_bounded_at_every_ratio(self):
        for kind, closed in (('whale', True), ('ocean', False)):
            self.sample(f'{kind}.ply', 2000, kind)
            self.vsplit('bake', f'{kind}.ply', '-o', f'{kind}.pmesh')
            for ratio in (0.9, 0.6, 0.4, 0.1, 0.02):
                out = f'{kind}-{ratio}.obj'
                self.vsplit('extract', f'{kind}.pmesh', '--ratio', ratio, '-o', out)
                cut = read_obj(self.path(out))
                self.assertEqual(cut.boundary_edges() == 0, closed)
                self.assertEqual(cut.non_manifold_edges(), 0)
                self.assertEqual(cut.degenerate(), 0)

    def test_sample_points(self):
        for count in (4, 100, 3000):
            self.vsplit('sample', 'ocean', '--points', count, '-o', f'{count}.xyz')
            lines = self.path(f'{count}.xyz').read_text().splitlines()
            self.assertEqual(len(lines), count)
            self.assertTrue(all(len([float(c) for c in line.split()]) == 3 for line in lines))

    def test_targets_are_met(self):
        self.baked(triangles=2000)
        full = self.json('info', 'model.pmesh')
        triangles, vertices = full['triangles'], full['vertices']
        for ratio in (0.95, 0.6, 0.4, 0.25, 0.073, 0.01):
            wanted = round(ratio * triangles)
            ran = self.vsplit('extract', 'model.pmesh', '--ratio', ratio, '-o', 'cut.ply', '--force')
            got = len(read_ply(self.path('cut.ply')).faces)
            self.assertLessEqual(got, max(wanted, full['base']['triangles']))
            self.assertTrue(wanted - got <= 1 or 'asked for' in ran.err, f'{ratio}: {got} for {wanted}, and no reason given')
        for wanted in (triangles, 1000, 501, 4, 1, 0, 10 * triangles):
            ran = self.vsplit('extract', 'model.pmesh', '--triangles', wanted, '-o', 'cut.ply', '--force')
            got = len(read_ply(self.path('cut.ply')).faces)
            self.assertTrue(0 <= wanted - got <= 1 or 'asked for' in ran.err)
        for wanted in (vertices, 700, 33, 1):
            ran = self.vsplit('extract', 'model.pmesh', '--vertices', wanted, '-o', 'cut.ply', '--force')
            got = len(read_ply(self.path('cut.ply')).points)
            self.assertTrue(got == wanted or 'asked for' in ran.err)
        last = None
        for error in (0, 1e-4, 1e-3, 1e-2, 0.1, 1e9):
            report = self.json('extract', 'model.pmesh', '--error', error, '-o', 'cut.ply', '--force')
            self.assertLessEqual(report['error'], error)
            self.assertTrue(last is None or report['triangles'] <= last)
            last = report['triangles']
        self.assertEqual(last, full['base']['triangles'])

    def test_profiles(self):
        self.sample('whale.ply', 3000, 'whale')
        for name, flags in (('default', ()), ('quality', ('--profile', 'quality')), ('stream', ('--profile', 'stream')),
                            ('endpoint', ('--placement', 'endpoint'))):
            self.vsplit('bake', 'whale.ply', *flags, '-o', name + '.pmesh')
        read = lambda name: self.path(name + '.pmesh').read_bytes()
        self.assertEqual(read('quality'), read('default'))
        self.assertEqual(read('stream'), read('endpoint'))
        self.assertLess(len(read('stream')), 0.9 * len(read('quality')))

    def test_percentages_are_ratios(self):
        self.sample('whale.ply', 1500, 'whale')
        self.vsplit('bake', 'whale.ply', '-o', 'whale.pmesh')
        for percent, ratio in (('40%', '0.4'), ('7.3%', '0.073'), ('100%', '1'), ('1e1%', '0.1')):
            for name, said in (('percent', percent), ('ratio', ratio)):
                self.vsplit('extract', 'whale.pmesh', '--ratio', said, '-o', name + '.ply', '--force')
                self.vsplit('lods', 'whale.pmesh', '--ratios', '1,' + said, '-o', name + '.glb', '--force')
            self.assertEqual(self.path('percent.ply').read_bytes(), self.path('ratio.ply').read_bytes())
            self.assertEqual(self.path('percent.glb').read_bytes(), self.path('ratio.glb').read_bytes())

    def test_info_says_what_extract_gives(self):
        self.baked(triangles=3000)
        info = self.json('info', 'model.pmesh')
        self.assertEqual(info['bytes'], self.path('model.pmesh').stat().st_size)
        self.assertGreaterEqual(len(info['blocks']), 2)
        end = info['blocks'][0]['offset']
        self.assertGreater(end, info['base']['offset'] + info['base']['bytes'])
        for block in info['blocks']:
            self.assertEqual(block['offset'], end)
            end += block['bytes']
            report = self.json('extract', 'model.pmesh', '--vertices', block['vertices'], '-o', 'cut.ply', '--force')
            self.assertEqual((report['triangles'], report['vertices']), (block['triangles'], block['vertices']))
            self.assertAlmostEqual(report['error'], block['error'], delta=1e-6 * (1 + block['error']))
        self.assertEqual(end, info['bytes'])

    def test_lods(self):
        self.baked(triangles=2000)
        report = self.json('lods', 'model.pmesh', '--ratios', '0.25,1,0.5', '-o', 'lods.glb')
        document = glb_json(self.path('lods.glb'))
        self.assertIn('MSFT_lod', document['extensionsUsed'])
        root = next(n for n in document['nodes'] if 'MSFT_lod' in n.get('extensions', {}))
        self.assertEqual(len(root['extensions']['MSFT_lod']['ids']), 2)
        coverage = root['extras']['MSFT_screencoverage']
        self.assertEqual(len(coverage), 3)
        self.assertEqual(coverage, sorted(coverage, reverse=True))
        nodes = [root] + [document['nodes'][i] for i in root['extensions']['MSFT_lod']['ids']]
        counts = [glb_triangles(document, n['mesh']) for n in nodes]
        self.assertEqual(counts, [level['triangles'] for level in report['levels']])
        self.assertEqual(counts, sorted(counts, reverse=True))

    def test_json_has_its_keys(self):
        self.sample('model.ply')
        bake = self.json('bake', 'model.ply', '-o', 'model.pmesh')
        for key in ('input', 'output', 'read', 'mesh', 'ratio_1_triangles', 'base', 'splits', 'components_vanished', 'fixed_vertices',
                    'stopped_by', 'weights', 'bytes', 'seconds', 'peak_memory_bytes'):
            self.assertIn(key, bake)
        self.assertEqual(bake['bytes'], self.path('model.pmesh').stat().st_size)
        for key in ('vertices', 'triangles', 'components', 'boundary_edges', 'non_manifold_edges', 'misoriented_edges',
                    'non_manifold_vertices', 'duplicate_triangles', 'zero_area_triangles'):
            self.assertIn(key, bake['mesh'])
        info = self.json('info', 'model.pmesh')
        for key in ('version', 'bytes', 'vertices', 'triangles', 'splits', 'weights', 'bounds', 'base', 'blocks'):
            self.assertIn(key, info)
        extract = self.json('extract', 'model.pmesh', '--ratio', 0.5, '-o', 'half.glb')
        for key in ('input', 'output', 'level', 'triangles', 'vertices', 'ratio', 'error', 'bytes'):
            self.assertIn(key, extract)
        self.assertEqual(glb_triangles(glb_json(self.path('half.glb'))), extract['triangles'])
        lods = self.json('lods', 'model.pmesh', '--ratios', '1,0.1', '-o', 'lods.glb')
        for key in ('input', 'output', 'levels', 'bytes', 'notes'):
            self.assertIn(key, lods)
        verify = self.json('verify', 'model.pmesh', '--against', 'model.ply')
        self.assertTrue(verify['passed'])
        self.assertTrue(all(check['passed'] for check in verify['checks']))
        self.assertIn('output', self.json('sample', 'ocean', '--points', 50, '-o', 'points.xyz'))
        # A file's name that is no UTF-8 and one with quotes make valid JSON, too.
        odd = self.path('a "quoted" name.ply')
        odd.write_bytes(self.path('model.ply').read_bytes())
        self.assertEqual(self.json('bake', odd.name, '-o', 'odd.pmesh')['input'], odd.name)

    def test_quiet_is_quiet(self):
        for args in (('sample', 'whale', '--mesh', '--triangles', 500, '-o', 'm.ply'), ('bake', 'm.ply', '-o', 'm.pmesh'), ('info', 'm.pmesh'),
                     ('extract', 'm.pmesh', '--ratio', 0.001, '-o', 'm.glb'), ('lods', 'm.pmesh', '--ratios', '1,0.5,0.00001,0.00002', '-o', 'l.glb'),
                     ('verify', 'm.pmesh', '--against', 'm.ply')):
            ran = self.vsplit(*args, '--quiet')
            self.assertEqual((ran.out, ran.err), ('', ''), args)

    def test_no_progress_bar_on_a_pipe(self):
        self.sample('big.ply', 40000)
        ran = self.vsplit('bake', 'big.ply', '-o', 'big.pmesh')
        self.assertEqual(ran.err, '')
        self.assertNotIn('\r', ran.out)
        self.assertNotIn('\033', ran.out)

    def test_same_bytes_for_any_number_of_threads(self):
        self.sample('model.ply', 30000)
        for cost in ('quadric', 'paper'):
            files = []
            for threads in (1, 2, 7):
                self.vsplit('bake', 'model.ply', '--cost', cost, '--threads', threads, '-o', f'{threads}.pmesh', '--force')
                files.append(self.path(f'{threads}.pmesh').read_bytes())
            self.assertEqual(files[0], files[1])
            self.assertEqual(files[0], files[2])

    def test_costs_placements_and_locks(self):
        points, faces = bumpy_grid(16)
        self.write('grid.ply', encode_ply(points, faces))
        files = set()
        for cost in ('quadric', 'paper'):
            for placement in ('optimal', 'endpoint'):
                self.vsplit('bake', 'grid.ply', '--cost', cost, '--placement', placement, '-o', 'x.pmesh', '--force')
                self.vsplit('verify', 'x.pmesh', '--against', 'grid.ply')
                files.add(self.path('x.pmesh').read_bytes())
        self.assertEqual(len(files), 4)
        self.vsplit('bake', 'grid.ply', '--lock', 'boundary', '-o', 'locked.pmesh')
        self.vsplit('extract', 'locked.pmesh', '--triangles', 0, '-o', 'locked.obj')
        self.assertEqual(read_obj(self.path('locked.obj')).boundary_edges(), 64)
        self.vsplit('bake', 'grid.ply', '--lock', 'boundary', '--lock', 'features=1', '-o', 'both.pmesh')

    def test_weights_in_and_out(self):
        points, faces = bumpy_grid(20)
        weights = [10.0 if x < 0.5 else 1.0 for x, _, _ in points]
        self.write('plain.obj', encode_obj(points, faces))
        self.write('weights.txt', '# painted\n\n' + '\n'.join(map(str, weights)) + '\n')
        self.write('quality.ply', encode_ply(points, faces, weights))
        self.write('named.ply', encode_ply(points, faces, weights, name='importance'))
        baked = {}
        for name, args in (('text', ('plain.obj', '--weights', 'weights.txt')), ('quality', ('quality.ply',)),
                           ('named', ('named.ply', '--weights', 'importance'))):
            self.vsplit('bake', *args, '--lossless', '-o', f'{name}.pmesh')
            baked[name] = self.path(f'{name}.pmesh').read_bytes()
            self.assertTrue(self.json('info', f'{name}.pmesh')['weights'])
        self.assertEqual(baked['text'], baked['quality'])
        self.assertEqual(baked['text'], baked['named'])
        self.vsplit('extract', 'text.pmesh', '--ratio', 1, '-o', 'full.ply')
        full = read_ply(self.path('full.ply'))
        self.assertEqual(sorted(zip(full.points, full.weights)), sorted(zip(points, weights)))
        self.vsplit('extract', 'text.pmesh', '--ratio', 0.3, '-o', 'cut.ply')
        self.vsplit('bake', 'plain.obj', '-o', 'none.pmesh')
        self.vsplit('extract', 'none.pmesh', '--ratio', 0.3, '-o', 'none.ply')
        left = [sum(1 for x, _, _ in read_ply(self.path(n)).points if x < 0.5) for n in ('cut.ply', 'none.ply')]
        self.assertGreater(left[0], 1.2 * left[1])
        # A GLB carries them as _WEIGHT, and a bake takes them up again.
        self.vsplit('extract', 'text.pmesh', '--ratio', 1, '-o', 'full.glb')
        self.vsplit('bake', 'full.glb', '--lossless', '-o', 'again.pmesh')
        self.vsplit('extract', 'again.pmesh', '--ratio', 1, '-o', 'again.ply')
        again = read_ply(self.path('again.ply'))
        self.assertEqual(sorted(zip(again.points, again.weights)), sorted(zip(points, weights)))
        # An infinite one stays to the last.
        self.write('inf.txt', '\n'.join('inf' if i == 0 else '1' for i in range(len(points))))
        self.vsplit('bake', 'plain.obj', '--weights', 'inf.txt', '--lossless', '-o', 'inf.pmesh')
        self.vsplit('extract', 'inf.pmesh', '--triangles', 0, '-o', 'inf.ply')
        self.assertIn(points[0], read_ply(self.path('inf.ply')).points)

    def test_help_and_version(self):
        ran = self.vsplit('--help')
        for name in ('bake', 'extract', 'lods', 'info', 'verify', 'sample'):
            self.assertIn(name, ran.out)
            self.assertIn('Example', self.vsplit(name, '--help').out)
        self.assertRegex(self.vsplit('--version').out, r'^vsplit \d+\.\d+\.\d+\n$')

    def test_output_to_a_device(self):
        self.baked()
        ran = self.run_vsplit('extract', 'model.pmesh', '--ratio', 0.5, '-o', '/dev/null')
        # No extension, so no format: a usage error, said plainly.
        self.assertEqual(ran.code, USAGE)
        self.vsplit('bake', 'model.ply', '-o', '/dev/null')


if __name__ == '__main__':
    main()
