#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
"""Scenes with things changed at random, in their JSON, in their arrays, or anywhere: `lods` and `bake` do their work or refuse with a message, and never
crash. Every change is named by a number, so that a failure can be had again."""
import copy
import json
import random
import struct

from harness import *

import scenes

CHANGES = 320


def parts_of(glb):
    size = struct.unpack_from('<I', glb, 12)[0]
    return json.loads(glb[20:20 + size]), glb[28 + size:]


def sealed(root, data):
    text = json.dumps(root).encode()
    text += b' ' * (-len(text) % 4)
    return struct.pack('<4sII', b'glTF', 2, 28 + len(text) + len(data)) + struct.pack('<I4s', len(text), b'JSON') + text + \
        struct.pack('<I4s', len(data), b'BIN\0') + data


def places(value, path=()):
    """Every value of the document, by the way to it."""
    if path:
        yield path
    children = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, child in children:
        yield from places(child, path + (key,))


def change_document(root, chance):
    root = copy.deepcopy(root)
    for _ in range(chance.randint(1, 3)):
        path = chance.choice(list(places(root)))
        holder = root
        for key in path[:-1]:
            holder = holder[key]
        old = holder[path[-1]]
        kind = chance.randrange(4)
        if kind == 0 and isinstance(holder, dict):
            del holder[path[-1]]
        elif kind == 1 and isinstance(old, (int, float)) and not isinstance(old, bool):
            holder[path[-1]] = chance.choice([old + 1, old - 1, -1, 0, 2 ** 31, 2 ** 32 - 1, 2 ** 53, 1e30, old * 7])
        elif kind == 2 and isinstance(old, list) and old:
            chance.choice([old.pop, old.clear, lambda old=old: old.append(old[0])])()
        else:
            holder[path[-1]] = chance.choice([None, True, -1, 'x', [], {}, 5126, 'VEC3', 'SCALAR'])
    return root


def change_bytes(data, chance):
    data = bytearray(data)
    for _ in range(chance.randint(1, 12)):
        at = chance.randrange(len(data))
        kind = chance.randrange(3)
        if kind == 0:
            data[at] ^= 1 << chance.randrange(8)
        elif kind == 1:
            data[at:at + 4] = chance.choice([b'\xff' * 4, b'\0\0\x80\x7f', b'\0\0\xc0\x7f', bytes(4)])[:len(data) - at]
        else:
            other = chance.randrange(len(data))
            data[at:at + 32] = data[other:other + min(32, len(data) - at)].ljust(min(32, len(data) - at), b'\0')
    return bytes(data)


class Mutated(CommandTest):
    def test_never_a_crash(self):
        sources = [scenes.skinned(5).glb(), scenes.morphing(5).glb(), scenes.assembly(3).glb(), scenes.quantised(5).glb(),
                   scenes.instanced_on_gpu(4).glb(), scenes.crowded(4).glb()]
        self.write('plain.glb', sources[0])
        for flags in (['--draco'], ['--meshopt', '--quantized']):
            self.vsplit('lods', 'plain.glb', '--ratios', '1,0.4', *flags, '-o', 'packed.glb', '-f', '-q')
            sources.append(self.path('packed.glb').read_bytes())
        self.vsplit('bake', 'plain.glb', '-o', 'progressive.glb', '-q')
        sources.append(self.path('progressive.glb').read_bytes())
        done = refused = 0
        for number in range(CHANGES):
            chance = random.Random(number)
            root, data = parts_of(chance.choice(sources))
            kind = number % 3
            if kind == 0:
                glb = sealed(change_document(root, chance), data)
            elif kind == 1:
                glb = sealed(root, change_bytes(data, chance))
            else:
                glb = change_bytes(sealed(root, data), chance)
            self.write('changed.glb', glb)
            command = (('lods', 'changed.glb', '--ratios', '1,0.3', '-o', 'out.glb'), ('bake', 'changed.glb', '-o', 'out.glb'),
                       ('lods', 'changed.glb', '--ratios', '0.5', '--draco', '-o', 'out.glb'),
                       ('lods', 'changed.glb', '--errors', '0.01', '--quantized', '--meshopt', '-o', 'out.glb'))[number % 4]
            with self.subTest(number=number, command=command):
                ran = self.run_vsplit(*command, '-q')
                self.assertIn(ran.code, (DONE, BAD_INPUT, BAD_OUTPUT), ran.err)
                done += ran.code == DONE
                refused += ran.code != DONE
                self.assertEqual(ran.code == DONE, self.path('out.glb').exists())
                if ran.code == DONE:
                    glb_json(self.path('out.glb'))  # is one
            self.path('out.glb').unlink(missing_ok=True)
        # Both happen, or the changes say little.
        self.assertGreater(done, CHANGES // 8)
        self.assertGreater(refused, CHANGES // 8)


if __name__ == '__main__':
    main()
