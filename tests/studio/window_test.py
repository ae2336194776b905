#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
"""window_test.py VSPLIT [PICTURES]: the studio's real window on an X server of its own, with a synthetic mouse and keyboard (xdotool).
Pictures of the screen are looked at by their pixels, and kept in the folder PICTURES if it is named."""
import json
import math
import os
import pathlib
import shutil
import signal
import struct
import subprocess
import sys
import tempfile
import time
import unittest

VSPLIT = ''
PICTURES = None
WIDTH, HEIGHT, PANEL = 1280, 800, 264
ORANGE, BLUE = (0xE6, 0x55, 0x0D), (0x31, 0x82, 0xBD)


class Picture:
    def __init__(self, data):
        magic, size, depth, self.pixels = data.split(b'\n', 3)
        assert magic == b'P6' and depth == b'255', (magic, depth)
        self.width, self.height = map(int, size.split())

    def at(self, x, y):
        i = 3 * (y * self.width + x)
        return tuple(self.pixels[i:i + 3])

    def like(self, colour, box):
        """Pixels in the box whose hue is the colour's, in any light."""
        x0, y0, x1, y1 = box
        count = 0
        for y in range(y0, y1, 2):
            for x in range(x0, x1, 2):
                r, g, b = self.at(x, y)
                high, low = max(r, g, b), min(r, g, b)
                if high - low < 60:
                    continue
                want_high, want_low = max(colour), min(colour)
                count += all(abs((c - low) / (high - low) - (w - want_low) / (want_high - want_low)) < 0.2 for c, w in zip((r, g, b), colour))
        return count


def write_scene(path):
    """Two spheres, red and green, as two meshes at three nodes: the green one is there twice."""
    rows, columns = 16, 24
    points, corners = [], []
    for i in range(rows + 1):
        for j in range(columns):
            a, b = math.pi * i / rows, 2 * math.pi * j / columns
            points.append((math.sin(a) * math.cos(b), math.cos(a), math.sin(a) * math.sin(b)))
    at = lambda i, j: i * columns + j % columns
    for i in range(rows):
        for j in range(columns):
            corners += [] if i == 0 else [at(i, j), at(i, j + 1), at(i + 1, j)]
            corners += [] if i == rows - 1 else [at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)]
    data = struct.pack(f'<{3 * len(points)}f', *(c for p in points for c in p)) + struct.pack(f'<{len(corners)}I', *corners)
    first = 12 * len(points)
    primitive = lambda material: {'attributes': {'POSITION': 0}, 'indices': 1, 'material': material}
    document = {
        'asset': {'version': '2.0'}, 'scene': 0, 'scenes': [{'nodes': [0, 1, 2]}],
        'nodes': [{'mesh': 0, 'translation': [-2.5, 0, 0]}, {'mesh': 1}, {'mesh': 1, 'translation': [2.5, 0, 0], 'scale': [1, 0.7, 1]}],
        'meshes': [{'primitives': [primitive(0)]}, {'primitives': [primitive(1)]}],
        'materials': [{'name': 'red', 'pbrMetallicRoughness': {'baseColorFactor': [0.8, 0.02, 0.02, 1]}},
                      {'name': 'green', 'pbrMetallicRoughness': {'baseColorFactor': [0.02, 0.6, 0.02, 1]}}],
        'accessors': [{'bufferView': 0, 'componentType': 5126, 'count': len(points), 'type': 'VEC3', 'min': [-1, -1, -1], 'max': [1, 1, 1]},
                      {'bufferView': 1, 'componentType': 5125, 'count': len(corners), 'type': 'SCALAR'}],
        'bufferViews': [{'buffer': 0, 'byteOffset': 0, 'byteLength': first}, {'buffer': 0, 'byteOffset': first, 'byteLength': len(data) - first}],
        'buffers': [{'byteLength': len(data)}]}
    text = json.dumps(document).encode()
    text += b' ' * (-len(text) % 4)
    path.write_bytes(struct.pack('<III', 0x46546C67, 2, 28 + len(text) + len(data)) + struct.pack('<II', len(text), 0x4E4F534A) + text +
                     struct.pack('<II', len(data), 0x004E4942) + data)


class WindowTest(unittest.TestCase):
    servers = 0

    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix='vsplit-studio-'))
        self.addCleanup(shutil.rmtree, self.folder, ignore_errors=True)
        # A number of our own: -displayfd takes that of a server that is just going.
        for attempt in range(20):
            number = 100 + (os.getpid() * 7 + WindowTest.servers) % 900
            WindowTest.servers += 1
            if os.path.exists(f'/tmp/.X11-unix/X{number}'):
                continue
            self.x = subprocess.Popen(['Xvfb', f':{number}', '-screen', '0', f'{WIDTH}x{HEIGHT}x24', '-nolisten', 'tcp', '-noreset'],
                                      stderr=subprocess.DEVNULL)
            self.addCleanup(self.stop, self.x)
            while self.x.poll() is None and not os.path.exists(f'/tmp/.X11-unix/X{number}'):
                time.sleep(0.05)
            if self.x.poll() is None:
                break
        self.environment = {**os.environ, 'DISPLAY': f':{number}'}
        subprocess.run([VSPLIT, 'sample', 'whale', '--mesh', '--triangles', '5000', '-o', 'whale.ply', '--quiet'], cwd=self.folder, check=True)

    def stop(self, process):
        if process.poll() is None:
            process.terminate()
            process.wait(20)

    def open(self, file='whale.ply', height=HEIGHT):
        self.studio = subprocess.Popen([VSPLIT, 'studio', file, '--size', f'{WIDTH}x{height}'], cwd=self.folder,
                                       env=self.environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.addCleanup(self.studio.stdout.close)
        self.addCleanup(self.stop, self.studio)
        self.wait(lambda: self.shot().at(4, height - 4) == (33, 38, 46), 'the window is there')
        self.do('mousemove', PANEL + 20, height - 60)
        time.sleep(0.5)

    def wait(self, condition, what, seconds=30):
        end = time.time() + seconds
        while time.time() < end:
            if condition():
                return
            self.assertTrue(self.x.poll() is None, 'the X server is gone')
            time.sleep(0.1)
        self.keep('failed')
        self.fail(f'waited {seconds} s in vain: {what}')

    def do(self, *arguments):
        subprocess.run(['xdotool', *map(str, arguments)], env=self.environment, check=True)

    def key(self, *names):
        for name in names:
            self.do('key', name)
            time.sleep(0.15)

    def click(self, x, y):
        self.do('mousemove', x, y, 'click', 1)
        time.sleep(0.3)

    def drag(self, points, hold=None):
        if hold:
            self.do('keydown', hold)
        self.do('mousemove', *points[0], 'mousedown', 1)
        for x, y in points[1:]:
            self.do('mousemove', x, y)
            time.sleep(0.05)
        self.do('mouseup', 1)
        if hold:
            self.do('keyup', hold)
        time.sleep(0.5)

    def shot(self):
        # A grab fails while a window is being put on the screen.
        for _ in range(50):
            grab = subprocess.run(['import', '-silent', '-window', 'root', '-depth', '8', 'ppm:-'], env=self.environment, capture_output=True, check=False)
            if grab.returncode == 0:
                return Picture(grab.stdout)
            time.sleep(0.2)
        self.fail(grab.stderr.decode())

    def keep(self, name):
        if PICTURES:
            subprocess.run(['import', '-silent', '-window', 'root', str(PICTURES / f'{name}.png')], env=self.environment, check=False)

    def marked(self, name='whale.autosave.marks'):
        """How many vertices each region has, in a file of marks; nothing if there is none."""
        path = self.folder / name
        if not path.exists():
            return {}
        counts = {}
        for line in path.read_text().splitlines():
            if line[:1].isdigit():
                counts[int(line.split()[0])] = counts.get(int(line.split()[0]), 0) + 1
        return counts

    def test_all_controls_are_in_a_low_window(self):
        self.open(height=500)
        self.keep('15-low')
        picture = self.shot()
        # The panel ends with its last button, [Help], and a margin.
        buttons = [y for y in range(500) if picture.at(20, y) == (58, 66, 78)]
        self.assertTrue(440 < max(buttons) < 500, max(buttons))
        self.click(130, max(buttons) - 3)
        self.wait(lambda: self.shot().at(PANEL + (WIDTH - PANEL) // 2, 250) != picture.at(PANEL + (WIDTH - PANEL) // 2, 250), 'help is shown')

    def test_paint_bake_save_and_close(self):
        self.open()
        middle = (PANEL + (WIDTH - PANEL) // 2, HEIGHT // 2)
        view = (PANEL + 20, 60, WIDTH - 20, HEIGHT - 60)
        self.keep('1-opened')
        self.assertEqual(self.shot().like(ORANGE, view), 0)
        # CTRL and the mouse paint; the stroke is on the screen and in the autosave.
        stroke = [(middle[0] - 60 + 10 * i, middle[1]) for i in range(13)]
        self.drag(stroke, 'ctrl')
        self.wait(lambda: self.marked().get(1, 0) > 10, 'the stroke is saved at once')
        painted = self.marked()[1]
        orange = self.shot().like(ORANGE, view)
        self.assertGreater(orange, 300)
        self.keep('2-painted')
        # SHIFT erases half of it; undo brings it back; redo takes it again.
        self.drag(stroke[6:], 'shift')
        self.wait(lambda: self.marked().get(1, 0) < painted, 'SHIFT erases')
        erased = self.marked()[1]
        self.assertLess(self.shot().like(ORANGE, view), orange)
        self.key('ctrl+z')
        self.wait(lambda: self.marked().get(1, 0) == painted, 'undo')
        self.key('ctrl+y')
        self.wait(lambda: self.marked().get(1, 0) == erased, 'redo')
        self.key('ctrl+z')
        # A second region in its own colour, symmetric.
        self.key('n', 'z')
        self.drag([(middle[0] + 10 * i, middle[1] - 50) for i in range(4)], 'ctrl')
        self.wait(lambda: self.marked().get(2, 0) > 0, 'a second region')
        self.assertGreater(self.shot().like(BLUE, view), 30)
        self.keep('3-two-regions')
        # A drag without a key turns the model and paints nothing.
        before, marks = self.shot(), self.marked()
        self.drag([(middle[0] - 100 + 30 * i, middle[1] + 100) for i in range(6)])
        time.sleep(0.6)
        self.assertNotEqual(before.pixels, self.shot().pixels)
        self.assertEqual(self.marked(), marks)
        # Apply, then a coarser level.
        self.key('Return')
        time.sleep(2.5)
        self.key('Next', 'Next', 'Next', 'Next', 'Next', 'Next', 'w')
        time.sleep(0.8)
        self.keep('4-baked-40')
        # Closing asks; Escape stays; S saves and closes.
        self.key('ctrl+q')
        time.sleep(0.4)
        self.keep('5-asks')
        self.key('Escape')
        time.sleep(0.3)
        self.assertIsNone(self.studio.poll())
        self.key('ctrl+e')
        self.wait(lambda: (self.folder / 'whale.studio.pmesh').exists(), 'export')
        self.key('ctrl+q', 's')
        self.assertEqual(self.studio.wait(20), 0)
        self.assertEqual(self.marked('whale.marks'), marks)
        self.assertFalse((self.folder / 'whale.autosave.marks').exists())
        info = json.loads(subprocess.run([VSPLIT, 'info', 'whale.studio.pmesh', '--json'], cwd=self.folder, capture_output=True, check=True).stdout)
        self.assertTrue(info['weights'])
        # What was saved is what bake reads.
        for flag, name in (('--weights', 'whale.weights.txt'), ('--marks', 'whale.marks')):
            subprocess.run([VSPLIT, 'bake', 'whale.ply', flag, name, '-o', 'again.pmesh', '--force', '--quiet'], cwd=self.folder, check=True)

    def test_crash_loses_nothing_that_was_painted(self):
        self.open()
        middle = (PANEL + (WIDTH - PANEL) // 2, HEIGHT // 2)
        self.drag([(middle[0] - 40 + 10 * i, middle[1]) for i in range(8)], 'ctrl')
        self.wait(lambda: self.marked().get(1, 0) > 5, 'autosave')
        painted = self.marked()
        self.studio.send_signal(signal.SIGKILL)
        self.studio.wait(20)
        self.open()
        time.sleep(0.5)
        self.assertGreater(self.shot().like(ORANGE, (PANEL + 20, 60, WIDTH - 20, HEIGHT - 60)), 100)
        self.keep('6-recovered')
        self.key('ctrl+q', 's')
        self.assertEqual(self.studio.wait(20), 0)
        self.assertEqual(self.marked('whale.marks'), painted)

    def test_looks_and_help(self):
        self.open()
        seen = {}
        for name, keys in {'plain': [], 'flat': ['f'], 'edges': ['s', 'w'], 'error': ['w', 'Next', 'Next', 'Next', 'Next', 'Next', 'e'], 'curvature': ['c'],
                           'quality': ['q'], 'weight': ['t'], 'side-by-side': ['m', 'd'], 'help': ['F1']}.items():
            self.key(*keys)
            time.sleep(0.7)
            self.keep(f'7-{name}')
            seen[name] = self.shot().pixels
        self.assertEqual(len(set(seen.values())), len(seen), 'two looks are the same picture')
        # Any click closes the help; unpainted, the window closes without a question.
        self.click(PANEL + 100, 100)
        self.assertIsNone(self.studio.poll())
        self.key('ctrl+q')
        self.assertEqual(self.studio.wait(20), 0)

    def test_points_become_a_surface_to_paint(self):
        subprocess.run([VSPLIT, 'sample', 'whale', '--points', '5000', '-o', 'cloud.xyz', '--quiet'], cwd=self.folder, check=True)
        self.open('cloud.xyz')
        middle = (PANEL + (WIDTH - PANEL) // 2, HEIGHT // 2)
        self.drag([(middle[0] - 40 + 10 * i, middle[1]) for i in range(8)], 'ctrl')
        self.wait(lambda: self.marked('cloud.autosave.marks').get(1, 0) > 5, 'a stroke on what was points')
        self.keep('9-points')
        self.key('ctrl+q', 'd')
        self.assertEqual(self.studio.wait(20), 0)
        self.assertFalse((self.folder / 'cloud.autosave.marks').exists())

    def test_scene_with_materials(self):
        write_scene(self.folder / 'balls.glb')
        self.open('balls.glb')
        self.keep('10-scene')
        red, green = (0xE7, 0x27, 0x27), (0x27, 0xCB, 0x27)
        view = (PANEL + 20, 60, WIDTH - 20, HEIGHT - 60)
        shot = self.shot()
        self.assertGreater(shot.like(red, view), 3000)
        self.assertGreater(shot.like(green, view), 1.3 * shot.like(red, view))  # twice, one of them flatter
        # G, then a click on what is green: both are marked, and nothing of the red one.
        spots = [(x, y) for y in range(view[1], view[3], 5) for x in range(view[0], view[2], 5) if shot.like(green, (x - 8, y - 8, x + 8, y + 8)) == 64]
        self.key('g')
        self.click(*spots[len(spots) // 2])
        self.wait(lambda: self.marked('balls.autosave.marks').get(1, 0) > 300, 'the green ones are marked')
        shot = self.shot()
        self.assertEqual(shot.like(green, view), 0)
        self.assertGreater(shot.like(red, view), 3000)
        self.assertGreater(shot.like(ORANGE, view), 3000)
        self.keep('11-material')
        counts = self.marked('balls.autosave.marks')
        self.assertEqual(counts[0], counts[1])
        self.key('Return')
        time.sleep(1)
        self.key('ctrl+e')
        self.wait(lambda: (self.folder / 'balls.studio.glb').exists(), 'export')
        data = (self.folder / 'balls.studio.glb').read_bytes()
        document = json.loads(data[20:20 + struct.unpack_from('<I', data, 12)[0]])
        self.assertEqual([m['name'] for m in document['materials']], ['red', 'green'])
        self.assertIn('VSPLIT_progressive_mesh', document['extensionsUsed'])
        self.key('ctrl+q', 'd')
        self.assertEqual(self.studio.wait(20), 0)

    def test_both_panes_follow_a_stroke(self):
        self.open()
        self.key('Next', 'Next', 'Next', 'd')
        time.sleep(0.7)
        quarter = (WIDTH - PANEL) // 4
        left, right = (PANEL + 20, 60, PANEL + 2 * quarter - 10, HEIGHT - 60), (PANEL + 2 * quarter + 10, 60, WIDTH - 20, HEIGHT - 60)
        self.do('keydown', 'ctrl')
        self.do('mousemove', PANEL + quarter - 40, HEIGHT // 2, 'mousedown', 1)
        for i in range(1, 9):
            self.do('mousemove', PANEL + quarter - 40 + 10 * i, HEIGHT // 2)
            time.sleep(0.05)
        # The button is still down.
        self.wait(lambda: min(self.shot().like(ORANGE, left), self.shot().like(ORANGE, right)) > 100, 'the stroke is in both panes')
        self.keep('14-both-panes')
        during = self.shot().like(ORANGE, right)
        self.do('mouseup', 1)
        self.do('keyup', 'ctrl')
        time.sleep(0.8)
        after = self.shot().like(ORANGE, right)
        self.assertAlmostEqual(during / after, 1, delta=0.1)
        self.key('ctrl+q', 'd')
        self.assertEqual(self.studio.wait(20), 0)

    def test_keep_and_keys(self):
        self.open()
        middle = (PANEL + (WIDTH - PANEL) // 2, HEIGHT // 2)
        # Fast and wide, at a coarse level: what is split off from it is marked, too.
        self.key('Next', 'Next', 'Next', 'Next', 'Next', *['bracketright'] * 6)
        self.drag([(middle[0] - 60 + 30 * i, middle[1]) for i in range(5)], 'ctrl')
        self.wait(lambda: self.marked().get(1, 0) > 100, 'a wide stroke')
        coarse = self.shot()
        self.key('r')
        time.sleep(0.5)
        self.keep('12-refined')
        self.assertNotEqual(coarse.pixels, self.shot().pixels)
        weight = lambda: [line.split()[2] for line in (self.folder / 'whale.autosave.marks').read_text().splitlines() if line.startswith('region ')]
        self.assertEqual(weight(), ['auto'])
        self.key('k')
        self.keep('13-searching')
        self.wait(lambda: weight() != ['auto'], 'a weight is found in the background')
        self.assertGreater(float(weight()[0]), 0)
        self.key('a')
        self.wait(lambda: weight() == ['auto'], 'the automatic weight')
        # Every key of the help is one that the window lives through.
        for name in ('F1', 'Escape', 'h', 'h', 'Left', 'Right', 'Prior', 'Home', 'End', 'd', 'd', 'v', 'f', 's', 'w', 'w', 'e', 't', 'c', 'q', 'm', 'n', '1', '2', '9', 'minus', 'equal',
                     'bracketleft', 'semicolon', 'apostrophe', 'x', 'x', 'y', 'y', 'z', 'z', 'p', 'Escape', 'g', 'Escape', 'u', 'ctrl+z', 'ctrl+y', 'Return', 'Escape', 'ctrl+s', 'ctrl+o'):
            self.key(name)
        self.assertIsNone(self.studio.poll())
        self.assertTrue((self.folder / 'whale.weights.txt').exists())
        self.key('ctrl+q')
        time.sleep(0.3)
        if self.studio.poll() is None:
            self.key('d')
        self.assertEqual(self.studio.wait(20), 0)

    def test_panel_by_mouse(self):
        self.open()
        full = self.shot()
        # The first slider is the level.
        self.drag([(240, 52), (200, 52), (100, 52), (60, 52)])
        time.sleep(0.6)
        self.keep('8-slider')
        coarse = self.shot()
        self.assertNotEqual(full.pixels, coarse.pixels)
        self.do('mousemove', PANEL + 200, 300)
        self.key('ctrl+q')
        self.assertEqual(self.studio.wait(20), 0)


if __name__ == '__main__':
    if len(sys.argv) < 2 or not os.access(sys.argv[1], os.X_OK):
        sys.exit(__doc__)
    VSPLIT = os.path.abspath(sys.argv[1])
    if len(sys.argv) > 2:
        PICTURES = pathlib.Path(sys.argv[2]).absolute()
        PICTURES.mkdir(parents=True, exist_ok=True)
    unittest.main(argv=[sys.argv[0], '-v'])
