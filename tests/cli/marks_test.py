# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
"""Regions on the command line, and the studio's scripts: everything that its mouse does."""
import json

from harness import BAD_INPUT, BAD_OUTPUT, USAGE, CommandTest, main, read_ply


class MarksTest(CommandTest):
    def marked(self):
        self.sample('model.ply', 3000)
        mesh = read_ply(self.path('model.ply'))
        front = sorted(range(len(mesh.points)), key=lambda v: -mesh.points[v][0])[:len(mesh.points) // 5]
        chosen = set(front)
        self.write('model.marks', 'region head auto #e6550d\n' + ''.join(f'{int(v in chosen)}\n' for v in range(len(mesh.points))))
        return mesh

    def test_keep_hits_its_target(self):
        self.marked()
        for cost in ('quadric', 'paper'):
            told = self.json('bake', 'model.ply', '--marks', 'model.marks', '--keep', 'head=90%@40%', '--cost', cost, '-o', 'out.pmesh', '--force')
            region = told['marks']['regions'][0]
            self.assertAlmostEqual(region['kept']['share'], 0.9, delta=0.01)
            # Counted from the outside: an extracted level's vertices in front, by the weight that they have.
            self.vsplit('extract', 'out.pmesh', '--ratio', '0.4', '-o', 'out.ply', '--force')
            level = read_ply(self.path('out.ply'))
            heavy = sum(1 for w in level.weights if w > 1 + 0.4 * (region['weight'] - 1))
            self.assertGreater(heavy, 0.85 * region['vertices'])

    def test_weights_of_regions(self):
        self.marked()
        told = self.json('bake', 'model.ply', '--marks', 'model.marks', '-o', 'a.pmesh')['marks']
        automatic = told['automatic']
        self.assertAlmostEqual(automatic['initial_weight'], (automatic['smallest_error'] + automatic['largest_error']) / 2)
        self.assertAlmostEqual(automatic['mark_weight'], (automatic['initial_weight'] + automatic['largest_error']) / 2)
        self.assertTrue(told['regions'][0]['automatic'])
        told = self.json('bake', 'model.ply', '--marks', 'model.marks', '--region', 'head=7.5', '-o', 'b.pmesh')['marks']
        self.assertEqual(told['regions'][0]['weight'], 7.5)
        # Painted weights are a region, too.
        self.write('w.txt', ''.join('3\n' if line == '1' else '1\n' for line in self.path('model.marks').read_text().split('\n')[1:-1]))
        told = self.json('bake', 'model.ply', '--weights', 'w.txt', '--keep', 'painted=80%@40%', '-o', 'c.pmesh')['marks']
        self.assertAlmostEqual(told['regions'][0]['kept']['share'], 0.8, delta=0.01)

    def test_refusals(self):
        self.marked()
        bake = ('bake', 'model.ply', '-o', 'x.pmesh')
        self.vsplit(*bake, '--marks', 'model.marks', '--keep', 'head=95', code=USAGE)
        self.vsplit(*bake, '--marks', 'model.marks', '--region', 'head=-1', code=USAGE)
        self.vsplit(*bake, '--marks', 'model.marks', '--region', 'tail=2', code=USAGE)
        self.vsplit(*bake, '--auto-weights', code=USAGE)
        self.write('bad.marks', 'region head auto\n1\n1\n')
        self.vsplit(*bake, '--marks', 'bad.marks', code=BAD_INPUT)
        self.vsplit(*bake, '--marks', 'none.marks', code=BAD_INPUT)
        self.assertFalse(self.path('x.pmesh').exists())

    def script(self, steps, code=0, *more):
        self.write('script.json', json.dumps(steps))
        ran = self.vsplit('studio', 'model.ply', '--script', 'script.json', '--json', *more, code=code)
        return json.loads(ran.out)['steps'] if ran.out.strip() else []

    def test_script_paints_bakes_and_exports(self):
        self.sample('model.ply', 3000)
        steps = self.script([
            {'do': 'view', 'from': 'front', 'width': 800, 'height': 500},
            {'do': 'level', 'ratio': 0.3},
            {'do': 'stroke', 'region': 'flank', 'points': [[380, 250], [400, 250], [420, 250], [1, 1]], 'radius': 30},
            {'do': 'counts'}, {'do': 'undo'}, {'do': 'counts'}, {'do': 'redo'}, {'do': 'counts'},
            {'do': 'stroke', 'region': 'tip', 'space': 'object', 'points': [[2.1, 0, 0]], 'radius': 0.4, 'strength': 0.5, 'mirror': 'z'},
            {'do': 'stroke', 'erase': True, 'space': 'object', 'points': [[2.1, 0, 0]], 'radius': 0.1},
            {'do': 'select', 'by': 'curvature', 'degrees': 70, 'region': 'sharp'},
            {'do': 'weight', 'region': 'sharp', 'weight': 4},
            {'do': 'keep', 'region': 'flank', 'share': 0.9, 'ratio': 0.3},
            {'do': 'apply'}, {'do': 'level', 'ratio': 0.3},
            {'do': 'save-marks', 'file': 'm.marks'}, {'do': 'save-weights', 'file': 'w.txt'},
            {'do': 'export', 'file': 'm.pmesh'}, {'do': 'export', 'file': 'm.ply', 'ratio': 0.3}, {'do': 'refine', 'file': 'r.ply'}])
        by = {}
        for step in steps:
            by.setdefault(step['do'], []).append(step)
        self.assertEqual([s['missed'] for s in by['stroke']], [1, 0, 0])
        painted, undone, redone = (c['regions']['flank'] for c in by['counts'])
        # Painted at a coarse level: what is split off from there is marked, too.
        self.assertGreater(painted['of'], painted['vertices'])
        self.assertEqual(undone['of'], 0)
        self.assertEqual(redone, painted)
        last = by['level'][-1]['regions']['flank']
        self.assertGreaterEqual(last['vertices'], 0.85 * last['of'])
        self.assertGreater(by['refine'][0]['vertices'], 0)
        # The same files that bake reads.
        self.vsplit('bake', 'model.ply', '--marks', 'm.marks', '-o', '1.pmesh', '--lossless')
        self.vsplit('bake', 'model.ply', '--weights', 'w.txt', '-o', '2.pmesh', '--lossless')
        self.assertEqual(self.path('1.pmesh').read_bytes(), self.path('2.pmesh').read_bytes())
        self.vsplit('verify', 'm.pmesh')
        # Files are not overwritten unasked.
        self.script([{'do': 'save-marks', 'file': 'm.marks'}], BAD_OUTPUT)
        self.script([{'do': 'load', 'file': 'm.marks'}, {'do': 'save-marks', 'file': 'm.marks'}], 0, '--force')

    def test_script_refusals(self):
        self.sample('model.ply', 300)
        for steps in ({}, {'steps': 3}, [3], [{}], [{'do': 'dance'}], [{'do': 'stroke'}], [{'do': 'stroke', 'points': [[1]]}],
                      [{'do': 'stroke', 'space': 'object', 'points': [[1, 2, 'x']]}], [{'do': 'stroke', 'points': [[1, 2]], 'strength': 2}],
                      [{'do': 'level', 'ratio': -1}], [{'do': 'keep', 'region': 'x', 'share': 0.5, 'ratio': 0.5}],
                      [{'do': 'select', 'by': 'luck'}], [{'do': 'view', 'from': 'inside'}], [{'do': 'export', 'file': 'a.gif'}],
                      [{'do': 'stroke', 'region': 'a b', 'points': [[1, 2]]}], [{'do': 'load', 'file': 'none'}]):
            with self.subTest(steps=steps):
                self.write('script.json', json.dumps(steps))
                ran = self.run_vsplit('studio', 'model.ply', '--script', 'script.json')
                self.assertIn(ran.code, (USAGE, BAD_INPUT), ran.err)
        self.write('script.json', '{"steps": [')
        self.vsplit('studio', 'model.ply', '--script', 'script.json', code=BAD_INPUT)


if __name__ == '__main__':
    main()
