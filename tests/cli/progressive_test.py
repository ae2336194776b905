#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
"""Progressive GLBs, from a scene and back to levels of it."""
from harness import *

from scenes_test import SceneTest, triangles_of

SCHEMA = pathlib.Path(__file__).resolve().parents[2] / 'formats/gltf/VSPLIT_progressive_mesh/schema/VSPLIT_progressive_mesh.schema.json'


class Progressive(SceneTest):
    def test_progressive_scenes(self):
        written = {}
        for scene in self.scenes:
            stem = scene.split('.')[0]
            out = f'{stem}.vsplit.glb'
            said = self.json('bake', scene, '--show', '0.2', '-o', out)
            written[out] = scene
            self.assertEqual(self.json('info', out)['triangles'], said['ratio_1_triangles'])
            self.vsplit('verify', out, '--against', scene)
            # Levels cut from it are those that the scene gives, but for the order of splits within a sweep of the stream.
            for source in (scene, out):
                self.vsplit('lods', source, '--ratios', '1,0.3', '-o', f'{stem}-from.glb', '-f')
                document = glb_json(self.path(f'{stem}-from.glb'))
                counts = sorted(triangles_of(document, m) for m in range(len(document['meshes'])))
                coverages = [c for node in document['nodes'] for c in node.get('extras', {}).pop('MSFT_screencoverage', [])]
                if source == scene:
                    direct, direct_counts, direct_coverages = document['nodes'], counts, coverages
                else:
                    self.assertEqual(document['nodes'], direct, scene)
                    self.assertEqual(len(counts), len(direct_counts))
                    self.assertAlmostEqual(sum(counts), sum(direct_counts), delta=8 + 0.01 * sum(direct_counts), msg=scene)
                    # They fall with the error, which the stream tells by its sweeps of splits: never less than the scene's.
                    self.assertEqual(len(coverages), len(direct_coverages))
                    for ours, theirs in zip(coverages, direct_coverages):
                        self.assertTrue(0 <= ours <= 1.1 * theirs + 1e-6, f'{scene}: {ours}, {theirs}')
            written[f'{stem}-from.glb'] = scene
            for extension in ('glb', 'ply', 'obj'):
                self.vsplit('extract', out, '--ratio', '0.5', '-o', f'{stem}-half.{extension}')
            written[f'{stem}-half.glb'] = scene
            try:
                import jsonschema
            except ImportError:
                print('SKIPPED: no jsonschema, the extension is not held against its schema', file=sys.stderr)
            else:
                jsonschema.validate(glb_json(self.path(out))['extensions']['VSPLIT_progressive_mesh'], json.loads(SCHEMA.read_text()))
        self.same_or_fewer(written, self.scenes)


if __name__ == '__main__':
    del SceneTest  # a base, not a test
    main()
