#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
"""From points to a surface and a progressive mesh, on the command line."""
from harness import *


class Points(CommandTest):
    def whale(self, count=3000):
        self.vsplit('sample', 'whale', '--points', count, '-o', 'whale.xyz', '-q')
        return 'whale.xyz'

    def test_a_closed_cloud_gives_a_watertight_surface(self):
        self.whale()
        for method in ('modified', 'classic'):
            report = self.json('reconstruct', 'whale.xyz', '--method', method, '-o', f'{method}.ply')
            self.assertEqual(report['points'], 3000)
            surface = report['reconstruct']
            self.assertTrue(surface['watertight'])
            self.assertEqual(surface['genus'], 0)
            self.assertEqual(surface['components'], 1)
            self.assertGreater(surface['poles'], 0)
            self.assertTrue(surface['stages'])
            baked = self.json('bake', f'{method}.ply', '-o', f'{method}.pmesh')
            self.assertEqual(baked['mesh']['boundary_edges'], 0)
            self.assertEqual(baked['mesh']['non_manifold_edges'], 0)
            self.assertEqual(baked['mesh']['triangles'], surface['triangles'])

    def test_bake_takes_points(self):
        report = self.json('bake', self.whale(), '-o', 'whale.pmesh')
        self.assertTrue(report['points']['reconstruct']['watertight'])
        self.vsplit('verify', 'whale.pmesh')
        self.vsplit('bake', 'whale.xyz', '--weights', 'COLOR_0.r', '-o', 'no.pmesh', code=USAGE)
        self.assertFalse(self.path('no.pmesh').exists())

    def test_map_coordinates_keep_their_digits(self):
        """Metres in the millions, where floats are half a metre apart: the surface is the one near 0, moved."""
        name = self.whale()
        rows = [[float(c) for c in line.split()] for line in self.path(name).read_text().splitlines()]
        east, north = 500000, 4500000
        self.write('map.xyz', ''.join(f'{x + east:.9f} {y + north:.9f} {z:.9f}\n' for x, y, z in rows).encode())
        self.write('near.xyz', ''.join(f'{x:.9f} {y:.9f} {z:.9f}\n' for x, y, z in rows).encode())
        for stem in ('map', 'near'):
            self.vsplit('bake', f'{stem}.xyz', '-o', f'{stem}.pmesh')
            self.vsplit('extract', f'{stem}.pmesh', '--ratio', 1, '-o', f'{stem}.obj')
            self.vsplit('reconstruct', f'{stem}.xyz', '-o', f'{stem}.ply')
        self.assertEqual(self.json('info', 'near.pmesh')['origin'], [0, 0, 0])
        origin = self.json('info', 'map.pmesh')['origin']
        self.assertTrue(abs(origin[0] - east) < 10 and abs(origin[1] - north) < 10, origin)
        far, near = ([[float(c) for c in line.split()[1:]] for line in self.path(f'{stem}.obj').read_text().splitlines()
                      if line.startswith('v ')] for stem in ('map', 'near'))
        self.assertLess(abs(len(far) - len(near)), 0.02 * len(near))
        for axis, offset in enumerate((east, north, 0)):
            for pick in (min, max):
                a, b = (pick(p[axis] for p in m) for m in (far, near))
                self.assertLess(abs(a - offset - b), 1e-3)
        self.vsplit('verify', 'map.pmesh', '--against', 'map.ply')

    def test_same_bytes_for_any_number_of_threads(self):
        self.whale()
        for threads in (1, 2):
            self.vsplit('reconstruct', 'whale.xyz', '--threads', threads, '-o', f'{threads}.ply')
        self.assertEqual(self.path('1.ply').read_bytes(), self.path('2.ply').read_bytes())

    def test_an_open_sheet(self):
        self.vsplit('sample', 'ocean', '--points', 4000, '-o', 'ocean.xyz')
        report = self.json('reconstruct', 'ocean.xyz', '--open', '-o', 'ocean.glb')
        self.assertEqual(report['reconstruct']['components'], 1)
        self.assertEqual(report['reconstruct']['boundary_loops'], 1)

    def test_what_paraview_opens(self):
        self.whale()
        self.path('dumps').mkdir()
        self.vsplit('reconstruct', 'whale.xyz', '--medial-axis', 'axis.vtp', '--dump', 'voronoi', 'poles', 'labels', 'dumps', '-o', 'whale.obj')
        for name in ('axis.vtp', 'dumps/voronoi.vtp', 'dumps/poles.vtp', 'dumps/labels.vtu'):
            self.assertIn(b'<VTKFile', self.path(name).read_bytes()[:200], name)

    def test_what_is_no_cloud_is_refused_by_name(self):
        for name, text, place in (('three.xyz', '0 0 0\n1 0 0\n0 1 0\n', ''), ('flat.xyz', ''.join(f'{i} {i * i} 0\n' for i in range(50)), ''),
                                  ('bad.xyz', '0 0 0\n1 0 0\n0 1 0\n1 two 0\n', 'line 4'), ('empty.xyz', '', '')):
            self.path(name).write_text(text)
            ran = self.run_vsplit('reconstruct', name, '-o', 'out.ply')
            self.assertIn(ran.code, (USAGE, BAD_INPUT), name)
            self.assertIn(name, ran.err)
            self.assertIn(place, ran.err)
            self.assertFalse(self.path('out.ply').exists())
        self.vsplit('reconstruct', 'bad.xyz', '-o', 'out.stl', code=USAGE)
        self.vsplit('reconstruct', 'missing.xyz', '-o', 'out.ply', code=BAD_INPUT)


if __name__ == '__main__':
    main()
