#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
"""Real models, where they are: bake, verify against the input, cut at 60 % and 40 %. Says plainly what it skips."""
from harness import *
import harness

MODELS = ['meshes/stanford-bunny.obj', 'meshes/armadillo.obj', 'meshes/nefertiti.obj', 'meshes/igea.ply', 'meshes/fandisk.obj', 'meshes/rocker-arm.obj',
          'meshes/spot.obj', 'meshes/homer.obj', 'gltf/2CylinderEngine.glb', 'gltf/Duck.glb', 'gltf/CesiumMan.glb']


def add(model):
    def test(self):
        path = harness.CORPUS / model
        if not path.is_file():
            print(f'SKIPPED: {path} is not here', file=sys.stderr)
            self.skipTest(f'{path} is not here')
        # As most will bake it, places rounded; then without, since rounding may flatten an assembly's smallest triangles.
        self.json('bake', path, '-o', 'rounded.pmesh')
        self.json('verify', 'rounded.pmesh', '--against', path)
        report = self.json('bake', path, '--lossless', '-o', 'x.pmesh')
        mesh, triangles = report['mesh'], report['ratio_1_triangles']
        verified = self.json('verify', 'x.pmesh', '--against', path)
        self.assertTrue(verified['passed'], verified)
        manifold = mesh['non_manifold_edges'] == 0 and mesh['non_manifold_vertices'] == 0 and mesh['misoriented_edges'] == 0
        # At most 64 vertices a component, or as far as the topology allows, and then it is said why.
        if report['base']['vertices'] > 64 * max(1, mesh['components'] - report['components_vanished']):
            self.assertTrue(report['stopped_by'])
            print(f'{model}: base of {report["base"]["vertices"]} vertices: {report["stopped_by"]}', file=sys.stderr)
        for ratio in (0.6, 0.4):
            wanted = round(ratio * triangles)
            out = f'{ratio}.ply'
            cut = self.json('extract', 'x.pmesh', '--ratio', ratio, '-o', out)
            self.assertTrue(0 <= wanted - cut['triangles'] <= 1 or 'asked for' in cut.get('note', ''), cut)
            level = read_ply(self.path(out))
            self.assertEqual(len(level.faces), cut['triangles'])
            if mesh['zero_area_triangles'] == 0:
                self.assertEqual(level.degenerate(), 0, f'degenerate triangles at {ratio}')
            self.assertLessEqual(level.non_manifold_edges(), mesh['non_manifold_edges'])
            boundary = level.boundary_edges()
            if manifold:
                self.assertLessEqual(boundary, mesh['boundary_edges'])
                self.assertEqual(boundary == 0, mesh['boundary_edges'] == 0)
            self.vsplit('lods', 'x.pmesh', '--ratios', '0.6,0.4,0.1,0.01', '-o', 'lods.glb', '--force')
    return test


class Corpus(CommandTest):
    pass


for each in MODELS:
    setattr(Corpus, 'test_' + each.split('/')[-1].replace('-', '_').replace('.', '_'), add(each))

if __name__ == '__main__':
    main()
