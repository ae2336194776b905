#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
"""Scenes through `lods` and `bake`, from end to end: what comes out is a scene that the Khronos validator finds no more fault with than with what
went in, with fewer triangles a level, and everything else as it was.

Needs node and `npm install --prefix tests/gltf`, as validator_test.py does."""
from harness import *

import harness
import scenes

SCRIPT = pathlib.Path(__file__).resolve().parent.parent / 'gltf' / 'validate.mjs'
FORMATS = {'plain': [], 'quantized': ['--quantized'], 'draco': ['--draco'], 'meshopt': ['--meshopt'], 'both': ['--quantized', '--meshopt'],
           'shared': ['--shared-vertices']}


def triangles_of(document, mesh):
    return sum(document['accessors'][p['indices']]['count'] // 3 for p in document['meshes'][mesh]['primitives']
               if p.get('mode', 4) == 4 and 'indices' in p)


class SceneTest(CommandTest):
    """Has every scene in its folder, and what the validator says of them."""

    def setUp(self):
        super().setUp()
        self.scenes = scenes.write_all(self.folder)
        for name in ('CesiumMan.glb', 'Duck.glb', '2CylinderEngine.glb'):
            if (harness.CORPUS / 'gltf' / name).is_file():
                shutil.copyfile(harness.CORPUS / 'gltf' / name, self.path(name))
                self.scenes.append(name)
            else:
                print(f'SKIPPED: {name} is not in the corpus', file=sys.stderr)

    def validate(self, names):
        """Errors and warnings by file. Where the validator may not run, says so and finds none."""
        if os.environ.get('VSPLIT_NO_VALIDATOR') == '1':
            print('SKIPPED: VSPLIT_NO_VALIDATOR=1, no scene is validated', file=sys.stderr)
            return {name: [] for name in names}
        self.assertTrue(shutil.which('node') and (SCRIPT.parent / 'node_modules' / 'gltf-validator').is_dir(),
                        f'node or the package gltf-validator is missing: run npm install --prefix {SCRIPT.parent}, or set VSPLIT_NO_VALIDATOR=1')
        process = subprocess.run(['node', SCRIPT, *names], cwd=self.folder, capture_output=True, timeout=300, check=False)
        faults, name = {}, None
        for line in process.stdout.decode().splitlines():
            if not line.startswith(' '):
                name = line.split(':')[0]
                faults[name] = []
            elif line.split()[0] in ('error', 'warning'):
                faults[name].append(' '.join(line.split()[:2]))
        self.assertEqual(sorted(faults), sorted(names), process.stderr.decode())
        return faults

    def same_or_fewer(self, written, inputs):
        """`written` maps names of outputs to those of inputs. A fault of the input may come again with each level."""
        faults = self.validate(sorted({*written, *inputs}))
        for name, source in written.items():
            self.assertLessEqual(set(faults[name]), set(faults[source]), f'{name}, made of {source}')


class Scenes(SceneTest):
    def test_levels_in_all_formats(self):
        written = {}
        for scene in self.scenes:
            stem = scene.split('.')[0]
            for what, flags in FORMATS.items():
                out = f'{stem}-{what}.glb'
                said = self.json('lods', scene, '--ratios', '1,0.4,0.1', *flags, '-o', out)
                written[out] = scene
                counts = [level['triangles'] for level in said['levels']]
                self.assertEqual(counts, sorted(counts, reverse=True))
                errors = [level['error'] for level in said['levels']]
                self.assertEqual(errors, sorted(errors))
                document = glb_json(self.path(out))
                for node in document['nodes']:
                    lod = node.get('extensions', {}).get('MSFT_lod')
                    if lod is None:
                        continue
                    at = [triangles_of(document, node['mesh'])] + [triangles_of(document, document['nodes'][i]['mesh']) for i in lod['ids']]
                    self.assertEqual(at, sorted(at, reverse=True), out)
                    coverage = node['extras']['MSFT_screencoverage']
                    self.assertEqual(len(coverage), len(at))
                    self.assertEqual(coverage, sorted(coverage, reverse=True))
                    self.assertTrue(all(document['nodes'][i].get('skin') == node.get('skin') for i in lod['ids']))
                self.assertTrue(all(mesh['primitives'] for mesh in document.get('meshes', [])))
        self.same_or_fewer(written, self.scenes)

    def test_one_file_a_level(self):
        written = {}
        for scene in self.scenes:
            stem = scene.split('.')[0]
            for flags in ([], ['--draco'], ['--quantized', '--meshopt']):
                out = f'{stem}{"".join(flags)}.glb'
                said = self.json('lods', scene, '--ratios', '0.5,0.05', '--separate', *flags, '-o', out)
                self.assertEqual(len(said['files']), len(said['levels']))
                for name in said['files']:
                    written[name] = scene
                    self.assertNotIn('MSFT_lod', glb_json(self.path(name)).get('extensionsUsed', []))
        self.same_or_fewer(written, self.scenes)

    def test_the_finest_level_is_what_was_read(self):
        def parts(name):
            glb = self.path(name).read_bytes()
            root = glb_json(self.path(name))
            return root, glb[28 + struct.unpack_from('<I', glb, 12)[0]:]
        for scene in self.scenes:
            # CesiumMan has weights that do not sum to 1; they do when they are written.
            if not scene.endswith('.glb') or scene == 'CesiumMan.glb':
                continue
            for flags in ([], ['--shared-vertices']):
                self.vsplit('lods', scene, '--ratios', '1', *flags, '-o', 'out.glb', '-f')
                (before, data), (after, written) = parts(scene), parts('out.glb')
                for i, mesh in enumerate(before['meshes']):
                    for j, primitive in enumerate(mesh['primitives']):
                        if primitive.get('mode', 4) < 4:
                            self.assertEqual(primitive, {**after['meshes'][i]['primitives'][j], 'attributes': primitive['attributes']})
                            continue
                        other = after['meshes'][i]['primitives'][j]
                        self.assertEqual(scenes.triangles(before, data, primitive), scenes.triangles(after, written, other), f'{scene} {i} {j}')

    def test_what_is_not_triangles_stays(self):
        for scene in self.scenes:
            if not scene.endswith('.glb'):
                continue
            self.vsplit('lods', scene, '--ratios', '1', '-o', 'out.glb', '-f')
            before, after = glb_json(self.path(scene)), glb_json(self.path('out.glb'))
            for key in ('asset', 'scene', 'scenes', 'nodes', 'materials', 'textures', 'samplers', 'cameras', 'extensions', 'skins', 'extensionsUsed'):
                if key == 'skins':
                    strip = lambda skins: [{k: v for k, v in s.items() if k != 'inverseBindMatrices'} for s in skins or []]
                    self.assertEqual(strip(before.get(key)), strip(after.get(key)), scene)
                else:
                    self.assertEqual(before.get(key), after.get(key), f'{scene}: {key}')
            self.assertEqual(len(before.get('animations', [])), len(after.get('animations', [])))

    def test_pictures_in_other_files_come_along(self):
        self.vsplit('lods', 'textured.gltf', '--ratios', '1', '-o', 'out.glb')
        image = glb_json(self.path('out.glb'))['images'][0]
        self.assertEqual(image['mimeType'], 'image/png')
        self.assertNotIn('uri', image)
        self.path('outside picture.png').unlink()
        said = self.json('lods', 'textured.gltf', '--ratios', '1', '-o', 'out.glb', '-f')
        self.assertEqual(len(said['notes']), 1)
        self.assertEqual(glb_json(self.path('out.glb'))['images'][0]['uri'], 'outside%20picture.png')

    def test_errors_and_pixels(self):
        said = self.json('lods', 'assembly.glb', '--errors', '0,0.05,1', '-o', 'errors.glb')
        for asked, level in zip((0, 0.05, 1), said['levels']):
            self.assertLessEqual(level['error'], asked)
        said = self.json('lods', 'skinned.glb', '--pixels', '1080:1', '-o', 'pixels.glb')
        self.assertGreater(len(said['levels']), 1)
        first = glb_json(self.path('pixels.glb'))['nodes'][2]['extras']['MSFT_screencoverage']
        self.vsplit('lods', 'skinned.glb', '--pixels', '2160:1', '--ratios', '1,0.5', '-o', 'a.glb')
        self.vsplit('lods', 'skinned.glb', '--pixels', '2160:2', '--ratios', '1,0.5', '-o', 'b.glb')
        fine, coarse = (glb_json(self.path(name))['nodes'][2]['extras']['MSFT_screencoverage'][0] for name in ('a.glb', 'b.glb'))
        self.assertTrue(coarse == 1 or abs(coarse / fine - 4) < 1e-6, (fine, coarse))
        self.assertGreater(first[0], first[-1])

    def test_coarse_levels_of_scenes_full_of_seams(self):
        for name, ratio in (('2CylinderEngine.glb', 0.01), ('CesiumMan.glb', 0.015), ('crowded.glb', 0.05)):
            if name not in self.scenes:
                continue  # said in setUp
            said = self.json('lods', name, '--ratios', f'1,{ratio}', '-o', 'coarse.glb', '-f')
            full, coarse = (level['triangles'] for level in said['levels'])
            self.assertLessEqual(coarse, ratio * full + 1, name)
            self.assertGreater(coarse, 0)

    def test_a_pmesh_of_a_scene_keeps_attributes(self):
        written = {}
        for scene in self.scenes:
            stem = scene.split('.')[0]
            said = self.json('bake', scene, '-o', f'{stem}.pmesh', '-f')
            self.vsplit('verify', f'{stem}.pmesh', '--against', scene)
            held = self.json('info', f'{stem}.pmesh')
            self.assertEqual(held['triangles'], said['ratio_1_triangles'])
            self.assertEqual(len(held['attributes']), said['attributes'])
            if scene.endswith('.glb'):
                names = {name for mesh in glb_json(self.path(scene))['meshes'] for p in mesh['primitives'] if p.get('mode', 4) >= 4
                         for name in p['attributes']} - {'POSITION'}
                self.assertLessEqual(names, {a['name'] for a in held['attributes']}, scene)
            for name, flags in (('stream', ['--profile', 'stream']), ('exact', ['--lossless'])):
                if name == 'exact' and scene == '2CylinderEngine.glb':
                    continue  # the others have all that it has
                self.vsplit('bake', scene, *flags, '-o', f'{name}.pmesh', '-f')
                self.vsplit('verify', f'{name}.pmesh', '--against', scene)
            for ratio, flags in ((1, ['--quantized', '--meshopt']), (0.3, [])):
                out = f'{stem}-of-pmesh-{ratio}.glb'
                self.vsplit('lods', f'{stem}.pmesh', '--ratios', ratio, *flags, '-o', out)
                written[out] = scene
        self.same_or_fewer(written, self.scenes)
        self.vsplit('bake', 'skinned.glb', '--shape-only', '-o', 'shape.pmesh')
        self.assertEqual(self.json('info', 'shape.pmesh')['attributes'], [])
        self.vsplit('verify', 'shape.pmesh', '--against', 'skinned.glb')
        self.vsplit('bake', 'skinned.glb', '--shape-only', '-o', 'shape.glb', code=USAGE)

    def test_poses(self):
        # The bar bends: what is measured there is farther off than in the bind pose alone.
        errors = {}
        for poses in (0, 1, 8):
            errors[poses] = self.json('lods', 'skinned.glb', '--ratios', '0.1', '--poses', poses, '-o', 'x.glb', '-f')['levels'][0]['error']
        self.assertGreater(errors[8], 0)
        self.assertIn('8 poses', self.vsplit('lods', 'skinned.glb', '--ratios', '0.1', '-o', 'x.glb', '-f').out)
        self.assertIn('8 poses', self.vsplit('bake', 'morphing.glb', '-o', 'x.pmesh').out)
        self.assertNotIn('poses', self.vsplit('lods', 'skinned.glb', '--ratios', '0.1', '--poses', 0, '-o', 'x.glb', '-f').out)
        self.assertNotIn('poses', self.vsplit('lods', 'quantised.glb', '--ratios', '0.1', '-o', 'x.glb', '-f').out)
        for bad in ('-1', '1025', 'many', '1.5'):
            self.vsplit('lods', 'skinned.glb', '--ratios', '0.1', '--poses', bad, '-o', 'never.glb', code=USAGE)
        self.assertNotIn('never.glb', self.names())

    def test_options_that_do_not_go_together(self):
        for flags in (['--ratios', '1', '--errors', '0'], [], ['--ratios', '1', '--draco', '--meshopt'], ['--pixels', '1080'], ['--pixels', '0:1'],
                      ['--pixels', '1080:1:1'], ['--ratios', '1', '--separate', '--shared-vertices'], ['--errors', '-1'], ['--ratios', '2']):
            if flags == ['--pixels', '1080']:
                continue  # one pixel is meant
            self.vsplit('lods', 'skinned.glb', *flags, '-o', 'x.glb', code=USAGE)
        self.vsplit('bake', 'skinned.glb', '--draco', '--meshopt', '-o', 'x.glb', code=USAGE)
        self.write('one.obj', 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n')
        self.vsplit('bake', 'one.obj', '-o', 'x.glb', code=USAGE)
        self.assertNotIn('x.glb', self.names())


if __name__ == '__main__':
    main()
