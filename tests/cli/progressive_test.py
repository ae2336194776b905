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
            # Levels cut from it are those that the scene gives, but for numbers of accessors.
            for source in (scene, out):
                self.vsplit('lods', source, '--ratios', '1,0.3', '-o', f'{stem}-from.glb', '-f')
                document = glb_json(self.path(f'{stem}-from.glb'))
                counts = sorted(triangles_of(document, m) for m in range(len(document['meshes'])))
                if source == scene:
                    direct = (counts, document['nodes'])
                else:
                    self.assertEqual((counts, document['nodes']), direct, scene)
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
