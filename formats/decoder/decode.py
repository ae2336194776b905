#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The vsplit authors
# SPDX-License-Identifier: MIT
"""Slow reference decoder of .pmesh version 1, in the order of ../spec/pmesh-1.md.

    decode.py FILE        one line a prefix (base, then each block): counts, and checksums of all arrays

Python's standard library; a base mesh in Draco's bytes is decoded by the command `draco_decoder` (Debian package
draco). It believes the writer where the C++ reader distrusts it: an oracle for what the bytes mean, not for
what is wrong with them.
"""
import itertools
import math
import os
import struct
import subprocess
import sys
import tempfile

NONE = 0xFFFFFFFF
M32 = 0xFFFFFFFF
M64 = 0xFFFFFFFFFFFFFFFF


class Bad(Exception):
    """The file contradicts the format."""


# ---- Notation

def xxh64(data):
    p1, p2, p3, p4, p5 = (0x9E3779B185EBCA87, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9, 0x85EBCA77C2B2AE63,
                          0x27D4EB2F165667C5)
    rotl = lambda x, r: ((x << r) | (x >> (64 - r))) & M64
    rnd = lambda s, lane: rotl((s + lane * p2) & M64, 31) * p1 & M64
    at, size = 0, len(data)
    if size >= 32:
        lanes = [(p1 + p2) & M64, p2, 0, (-p1) & M64]
        while at + 32 <= size:
            for i, lane in enumerate(struct.unpack_from('<4Q', data, at)):
                lanes[i] = rnd(lanes[i], lane)
            at += 32
        s = (rotl(lanes[0], 1) + rotl(lanes[1], 7) + rotl(lanes[2], 12) + rotl(lanes[3], 18)) & M64
        for lane in lanes:
            s = ((s ^ rnd(0, lane)) * p1 + p4) & M64
    else:
        s = p5
    s = (s + size) & M64
    while at + 8 <= size:
        s = (rotl(s ^ rnd(0, struct.unpack_from('<Q', data, at)[0]), 27) * p1 + p4) & M64
        at += 8
    if at + 4 <= size:
        s = (rotl(s ^ (struct.unpack_from('<I', data, at)[0] * p1 & M64), 23) * p2 + p3) & M64
        at += 4
    for byte in data[at:]:
        s = rotl(s ^ (byte * p5 & M64), 11) * p1 & M64
    s = (s ^ (s >> 33)) * p2 & M64
    s = (s ^ (s >> 29)) * p3 & M64
    return s ^ (s >> 32)


def xxh32(data):
    """The low half, which files have."""
    return xxh64(data) & 0xFFFFFFFF


def unzigzag(n):
    return (n >> 1) ^ (M32 if n & 1 else 0)


def signed(n):
    return n - (1 << 32) if n & 0x80000000 else n


def f32(x):
    most = struct.unpack('<f', b'\xff\xff\x7f\x7f')[0]
    return struct.unpack('<f', struct.pack('<f', min(max(x, -most), most)))[0]


def ordered_number(x):
    bits = struct.unpack('<I', struct.pack('<f', x))[0]
    return signed(~(bits & 0x7FFFFFFF) & M32 if bits & 0x80000000 else bits)


def ordered_float(n):
    bits = n & M32
    return struct.unpack('<f', struct.pack('<I', (~bits & M32) | 0x80000000 if n < 0 else bits))[0]


# ---- Whole-number arithmetic

def _log_fraction(i):
    y, bits = (1024 + i) << 20, 0
    for _ in range(8):
        y = (y * y) >> 30
        bits <<= 1
        if y >= 2 << 30:
            bits |= 1
            y >>= 1
    return bits


LOG_FRACTIONS = [_log_fraction(i) for i in range(1024)]


def log2(x):
    if x == 0:
        return 0
    top = x.bit_length() - 1
    return 256 * top + LOG_FRACTIONS[(x >> (top - 10) if top >= 10 else x << (10 - top)) & 1023]


def log2_linear(x):
    top = x.bit_length() - 1
    return 256 * top + ((x << 8 >> top) & 255)


ROOTS = [1076653033, 1079572136, 1085434106, 1097253708, 1121280436, 1170923762, 1276901417, 1518500250]


def _power(i):
    product = 1 << 30
    for k in range(8):
        if i >> k & 1:
            product = (product * ROOTS[k]) >> 30
    return product >> 15


POWERS = [_power(i) for i in range(256)]


def share(below):
    i = min(below >> 7, 511)
    octaves = (i + 31) // 32
    return min(2 * POWERS[8 * (32 * octaves - i)] >> octaves, 65535)


def half_octave(x):
    if x < 2:
        return x
    top = x.bit_length() - 1
    return 2 * top + 1 + (x >> (top - 1) & 1)


def mean16(total, n):
    return (total * (65536 // n)) >> 12


def quotient(a, b):
    return (2 * a + b) // (2 * b)


# ---- The range coder and its models

RATES = [131072 // (2 * n + 3) for n in range(256)]


class Bit:
    __slots__ = ('one', 'seen', 'memory')

    def __init__(self, one=32768, seen=0, memory=64):
        self.one, self.seen, self.memory = one, seen, memory

    def learn(self, bit):
        rate = RATES[self.seen]
        if self.seen + 1 < self.memory:
            self.seen += 1
        if bit:
            self.one += ((65535 - 24 - self.one) * rate) >> 16
        else:
            self.one -= ((self.one - 24) * rate) >> 16


class Coder:
    def __init__(self, data):
        self.data, self.taken, self.range, self.code = data, 0, M32, 0
        for _ in range(4):
            self.code = (self.code << 8) | self.byte()

    def byte(self):
        self.taken += 1
        if self.taken > len(self.data) + 4:
            raise Bad('a stream ends too early')
        return self.data[self.taken - 1] if self.taken <= len(self.data) else 0

    def normalise(self):
        while self.range < 1 << 24:
            self.range <<= 8
            self.code = (self.code << 8 | self.byte()) & M32

    def bit(self, model):
        ones = (self.range * model.one) >> 16
        bit = self.code < ones
        if bit:
            self.range = ones
        else:
            self.code -= ones
            self.range -= ones
        model.learn(bit)
        self.normalise()
        return int(bit)

    def raw(self, count):
        value = 0
        while count > 0:
            few = 16 if count > 16 else count
            self.range >>= few
            part = self.code // self.range
            self.code -= self.range * part
            self.normalise()
            value = value << few | part
            count -= few
        return value

    def pick(self, weights):
        unit = self.range // sum(weights)
        at, before, value = self.code // unit, 0, 0
        while value + 1 < len(weights) and at - before >= weights[value]:
            before += weights[value]
            value += 1
        self.code -= unit * before
        self.range = unit * weights[value]
        self.normalise()
        return value

    def end(self):
        if any(self.data[self.taken:]):
            raise Bad('a stream is longer than it needs')


class Symbol:
    def __init__(self, bits):
        self.bits, self.nodes = bits, [Bit() for _ in range(1 << bits)]

    def decode(self, coder):
        node = 1
        for _ in range(self.bits):
            node = 2 * node + coder.bit(self.nodes[node])
        return node - (1 << self.bits)


class Number:
    def __init__(self):
        self.digits, self.second = Symbol(6), [Bit() for _ in range(33)]

    def decode(self, coder):
        count = self.digits.decode(coder)
        if count < 2:
            return count
        if count > 32:
            raise Bad('a number of more than 32 digits')
        high = 2 + coder.bit(self.second[count])
        return high << (count - 2) | coder.raw(count - 2)


ALONG_PRIORS = [
    [442, 553, 702, 842, 1003, 1215, 1157, 863, 383, 117, 13, 4, 2, 1, 1, 1],
    [465, 631, 833, 1095, 1310, 1356, 985, 522, 158, 30, 5, 2, 1, 1, 1, 1],
    [654, 850, 1037, 1228, 1198, 1054, 655, 297, 67, 10, 3, 2, 1, 1, 1, 1]]
ACROSS_PRIORS = [
    [533, 652, 760, 973, 998, 1075, 911, 675, 374, 166, 74, 32, 16, 11, 6, 4],
    [770, 959, 1038, 1120, 953, 791, 484, 242, 111, 55, 36, 20, 12, 6, 4, 2],
    [1397, 1347, 872, 665, 229, 132, 44, 15, 5, 3, 2, 1, 1, 1, 1, 1]]
SECOND_PRIOR = [(46, 49), (46, 48), (45, 48), (41, 46), (33, 42), (25, 36), (16, 30), (13, 28), (20, 35), (26, 37)]


# Odds that a vertex splits in 1/1024, by the parts of the context: star, age (6 touched + 2 acted + again), bump; and
# star, locked triangles, acted, bump.
ROUND_ODDS = [[187, 75, 150, 384, 994, 1543, 1775, 1439],
              [377, 362, 404, 634, 493, 736, 1024, 1024, 634, 1024, 917, 1024, 1024, 1024, 1024, 1024, 451, 1024],
              [178, 299, 369, 425, 540, 700, 864, 1004, 1120, 1098]]
BATCH_ODDS = [[105, 48, 91, 334, 1066, 2701, 4153, 5072, 2784, 1942],
              [1512, 1369, 714, 994, 260, 1024, 118],
              [187, 603, 373],
              [199, 348, 429, 503, 714, 994, 1315, 1671, 1757, 1226]]


def answers(parts):
    models = []
    for odds in itertools.product(*parts):
        odds = math.prod(odds) >> 10 * (len(parts) - 1)
        models.append(Bit(min(max(odds * 65536 // (odds + 1024), 64), 65472), 8))
    return models


class Residual:
    def __init__(self, rows, kinds, prior):
        self.rows, self.kinds = rows, kinds
        self.second = []
        for r in range(64):
            second, third = SECOND_PRIOR[min(max(r - 14, 0), 9)]
            self.second.append([Bit(655 * p, 6, 256) for p in (second, third, third)])
        self.sign = [Bit() for _ in range(64)]
        self.digits = []
        for row in range(rows):
            weight = [0] * 32
            weight.append(prior[row & 1] + sum(prior[at] for at in range(12 - row, -1, -2)))
            for d in range(1, 32):
                at = 2 * d + 12 - row
                weight.append(prior[at] if at < 16 else 1)
            for node in range(31, 0, -1):
                weight[node] = weight[2 * node] + weight[2 * node + 1]
            for _ in range(kinds):
                model = Symbol(5)
                for node in range(1, 32):
                    one = weight[2 * node + 1] * 65536 // weight[node]
                    model.nodes[node] = Bit(min(max(one, 64), 65472), 6)
                self.digits.append(model)

    def decode(self, coder, scale, kind, side=None, likely=0):
        scale = min(scale, 55)
        aside = 0 if scale < self.rows else (scale + 2 - self.rows) // 2
        row = scale - 2 * aside
        count = min(self.digits[row * self.kinds + kind].decode(coder), 31 - aside)
        second = self.second[min(max(2 * count - row + 24, 0), 63)]
        read = min(count, 1)
        if count > 1:
            read = 2 * read + coder.bit(second[0])
        if count > 2:
            read = 2 * read + coder.bit(second[read - 1])
        rest = max(count - 3, 0) + aside
        if count > 0 and side is None:
            raw = coder.raw(rest + 1)
            read = read << rest | raw >> 1
            return -read if raw & 1 else read
        read = read << rest | coder.raw(rest)
        if read == 0:
            return 0
        negative = coder.raw(1) if side is None else coder.bit(self.sign[side]) != likely
        return -read if negative else read


# ---- Header, details, table

class File:
    def __init__(self, data):
        if data[:8] != b'\x8fpmesh\r\n':
            raise Bad('not a .pmesh file')
        self.version, flags, self.base_vertices, self.base_triangles = struct.unpack_from('<4I', data, 8)
        if self.version != 1:
            raise Bad('not version 1')
        if xxh32(data[:120]) != struct.unpack_from('<I', data, 120)[0]:
            raise Bad("the header's checksum")
        self.weighted, self.lossless = flags & 1, flags >> 1 & 1
        *sizes, self.base_error, self.largest_group, self.position_bits = struct.unpack_from('<4IfII', data, 48)
        draco_bytes = sizes.pop(2)
        self.origin = struct.unpack_from('<3d', data, 76)  # of the lattice
        self.step = struct.unpack_from('<d', data, 100)[0]
        parts, at = [], 124
        for size, wanted in zip(sizes, struct.unpack_from('<3I', data, 108)):
            parts.append(data[at:at + size])
            at += size
            if xxh32(parts[-1]) != wanted:
                raise Bad('a checksum of the front')
        details, base, table = parts
        self.draco, self.extras = base[:draco_bytes], base[draco_bytes:]
        self.place_weights, at = [], 1
        for k in range(3):
            flat = [-32, 24, 24] * 14 if k == 2 else [40, 0, 32] * 14
            if details[0] >> k & 1:
                flat = struct.unpack_from('<42b', details, at)
                at += 42
            self.place_weights.append([[flat[(r * 2 + row) * 3:][:3] for row in range(2)] for r in range(7)])
        if details[0] >> 3 & 1:
            at += 24  # what to add for the source's coordinates
        self.attributes = []
        at += 2
        for _ in range(struct.unpack_from('<H', details, at - 2)[0]):
            semantic, components, coding, bits = struct.unpack_from('<4B', details, at)
            at += 4
            grid = []
            if coding == 1:
                grid = [struct.unpack_from('<2d', details, at + 16 * c) for c in range(components)]
                at += 16 * components
            length = struct.unpack_from('<H', details, at)[0]
            name = details[at + 2:at + 2 + length].decode()
            at += 2 + length
            self.attributes.append((name, semantic, components, coding, bits, grid))
        self.read_table(table, at_end=124 + len(details) + len(base) + len(table))

    def read_table(self, table, at_end):
        """Blocks: offset, bytes, checksum, then splits, vertices, triangles, corner changes and moves up to their
        end, and the error."""
        at = count = shift = 0
        while True:
            byte = table[at]
            at += 1
            count |= (byte & 127) << shift
            shift += 7
            if byte < 128:
                break
        checksums = struct.unpack_from('<%dI' % count, table, at)
        coder = Coder(table[at + 4 * count:])
        models = [Number() for _ in range(7)]
        totals = [0, self.base_vertices, self.base_triangles, 0, 0]
        error = struct.unpack('<I', struct.pack('<f', self.base_error))[0]
        self.blocks, self.bytes = [], at_end
        for wanted in checksums:
            size, splits, vertices, triangles, corners, moves, fall = [model.decode(coder) for model in models]
            vertices = (unzigzag(vertices) + splits) & M32
            triangles = (unzigzag(triangles) + 2 * vertices) & M32
            totals = [total + more for total, more in zip(totals, [splits, vertices, triangles, corners, moves])]
            error -= fall
            self.blocks.append((self.bytes, size, wanted, *totals, struct.unpack('<f', struct.pack('<I', error))[0]))
            self.bytes += size
        coder.end()
        self.splits, self.vertices, self.triangles, self.corners, self.moves = totals


# ---- The base mesh

def decode_draco(data):
    with tempfile.TemporaryDirectory() as folder:
        source, target = os.path.join(folder, 'base.drc'), os.path.join(folder, 'base.ply')
        with open(source, 'wb') as out:
            out.write(data)
        subprocess.run(['draco_decoder', '-i', source, '-o', target], check=True, stdout=subprocess.DEVNULL)
        with open(target, 'rb') as ply:
            data = ply.read()
    head, body = data.split(b'end_header\n', 1)
    counts = {line.split()[1]: int(line.split()[2]) for line in head.split(b'\n') if line.startswith(b'element')}
    vertices, faces = counts[b'vertex'], counts[b'face']
    places = [list(struct.unpack_from('<3i', body, 12 * i)) for i in range(vertices)]
    triangles = [list(struct.unpack_from('<3i', body, 12 * vertices + 13 * i + 1)) for i in range(faces)]
    return places, triangles


# ---- The live mesh

class Live:
    def __init__(self):
        self.at, self.star, self.touched, self.acted, self.twin, self.triangles = [], [], [], [], [], []

    def add_vertex(self, at):
        self.twin.append(len(self.at))
        self.at.append(list(at))
        self.star.append(set())     # corners that hold the vertex
        self.touched.append(0)
        self.acted.append(0)

    def add_triangle(self, corners):
        for k, v in enumerate(corners):
            self.star[v].add(3 * len(self.triangles) + k)
        self.triangles.append(list(corners))

    def bump(self, v):
        star = self.star[v]
        if not star or len(star) > 128:
            return [0, 0, 0]
        total = [0, 0, 0]
        for corner in star:
            for w in self.triangles[corner // 3]:
                if w != v:
                    for a in range(3):
                        total[a] += self.at[w][a]
        return [16 * self.at[v][a] - mean16(total[a], 2 * len(star)) for a in range(3)]

    def link_twins(self, first):
        order = sorted(range(first, len(self.at)), key=lambda v: (self.at[v], v))
        i = 0
        while i < len(order):
            end = i + 1
            while end < len(order) and self.at[order[end]] == self.at[order[i]]:
                end += 1
            for j in range(i, end):
                self.twin[order[j]] = order[j + 1 if j + 1 < end else i]
            i = end


class Star:
    """The corners that hold a vertex; if they are a fan: its ring and sectors in order."""

    def __init__(self, live, centre):
        self.centre, self.corners, self.fan, self.closed = centre, sorted(live.star[centre]), False, False
        n = self.size = len(self.corners)
        if n == 0 or n > 32:
            return
        origin, target = [], []
        for corner in self.corners:
            t, k = live.triangles[corner // 3], corner % 3
            origin.append(t[(k + 1) % 3])
            target.append(t[(k + 2) % 3])
        if len(set(origin)) < n or len(set(target)) < n:
            return
        starts = [i for i in range(n) if origin[i] not in target]
        if len(starts) > 1:
            return
        self.closed = not starts
        first = at = starts[0] if starts else origin.index(min(origin))
        self.ring, self.sector = [], []
        while True:
            self.ring.append(origin[at])
            self.sector.append(self.corners[at] // 3)
            end = target[at]
            if len(self.ring) == n:
                break
            if end not in origin or origin.index(end) == first:
                return
            at = origin.index(end)
        if not self.closed:
            self.ring.append(end)
        self.fan = True


# ---- Star cuts

class Role:
    def __init__(self):
        self.count, self.wing, self.child = [2, 2, 2], 0, 0

    def saw(self, role):
        self.count[role] += 4
        if self.count[role] > 1000:
            self.count = [c >> 1 | 1 for c in self.count]
        self.wing = log2(self.count[1]) - log2(self.count[0])
        self.child = log2(self.count[2]) - log2(self.count[0])


def ratio_class(log):
    return min(max((log + 576) >> 7, 0), 8)


class Cuts:
    def __init__(self):
        self.edge, self.chord = [Role() for _ in range(72)], [Role() for _ in range(10)]
        self.lengths = [[[1] * 17 for _ in range(17)] for _ in range(3)]
        self.both, self.last = [Bit() for _ in range(8)], Bit()

    def decode(self, coder, live, star, born_from):
        n, ring, closed = star.size, star.ring, star.closed
        count = len(ring)
        spoke = [[live.at[v][a] - live.at[star.centre][a] for a in range(3)] for v in ring]
        square = [sum(x * x for x in s) + 1 for s in spoke]
        length_log = [log2_linear(s) for s in square]
        mean = log2_linear(sum(square)) - log2_linear(count)
        edge, chord = [], []
        for i, v in enumerate(ring):
            valence = min(max(len(live.star[v]), 2), 9) - 2
            edge.append(9 * valence + ratio_class(length_log[i] - mean))
            if not closed and i in (0, count - 1):
                chord.append(9)
            else:
                across = sum((a - b) ** 2 for a, b in zip(spoke[(i + 1) % count], spoke[i - 1])) + 1
                chord.append(ratio_class(log2_linear(across) - length_log[i] - 256))

        first_wing = last_wing = True
        if not closed and not coder.bit(self.both[min(n, 7)]):
            last_wing = bool(coder.bit(self.last))
            first_wing = not last_wing
        family = 0 if closed else 1 if first_wing and last_wing else 2
        wing = [9 * self.edge[e].wing + 4 * self.chord[c].wing for e, c in zip(edge, chord)]
        child = [9 * self.edge[e].child + 4 * self.chord[c].child for e, c in zip(edge, chord)]
        is_wing = [share(max(wing) - w) for w in wing]
        is_child = [share(max(child) - c) for c in child]
        lengths = self.lengths[family][min(n, 16)]
        scaled = lambda length: length if n <= 16 else length * 16 // n
        shortest, longest = 0 if family == 2 else 1, n - 1 if closed else n
        score = {length: 16 * log2(lengths[scaled(length)]) + (length - shortest) * max(child)
                 for length in range(shortest, longest + 1)}
        shift = 0 if n <= 8 else 2 if n <= 16 else 4
        runs, weights = [], []
        for length in range(shortest, longest + 1):
            if family == 2:
                begins = [n - length if first_wing else 0]
            else:
                begins = range(n if closed else n + 1 - length)
            for begin in begins:
                end = begin + length
                if any(max(ring[i % count], ring[(i + 1) % count]) >= born_from for i in range(begin, end)):
                    continue
                if family == 2:
                    weight, last = 65535, begin if first_wing else end
                    inner = range(n, begin, -1) if first_wing else range(end)
                else:
                    weight, last, inner = is_wing[begin], end % count, range(begin + 1, end)
                for i in inner:
                    weight = weight * is_child[i % count] >> 16
                weight = (weight * is_wing[last] >> 16) * share(max(score.values()) - score[length]) >> 16
                runs.append((begin, length))
                weights.append((weight >> shift) + 1)
        if not runs:
            raise Bad('a run has no place in its fan')
        begin, length = runs[coder.pick(weights)]

        roles = [0] * count
        for i in range(begin, begin + length + 1):
            roles[i % count] = 2
        if first_wing:
            roles[begin] = 1
        if last_wing:
            roles[(begin + length) % count] = 1
        for i in range(count):
            self.edge[edge[i]].saw(roles[i])
            self.chord[chord[i]].saw(roles[i])
        lengths[scaled(length)] += 4
        if lengths[scaled(length)] > 4000:
            lengths[:] = [c >> 1 | 1 for c in lengths]
        return begin, length, first_wing, last_wing


# ---- Places

REACH = 1 << 22


def within(x):
    return min(max(x, -REACH), REACH)


def departure(difference, scale):
    now = half_octave(4 * abs(difference))
    return 0 if now + 2 < scale else 2 if now > scale + 1 else 1


def side_class(from_parent, from_wings, scale):
    size = lambda x: half_octave(abs(x) >> 2) - scale
    far, off = min(max((size(from_parent) + 6) >> 1, 0), 4), min(max((size(from_wings) + 4) >> 1, 0), 2)
    return 6 * far + 2 * off + ((from_parent < 0) != (from_wings < 0))


def rough_shift(scale, bent):
    digits = (scale - 1) // 2 if scale > 0 else 0
    return 0 if bent == 2 else max(0, digits - (4 if bent == 0 else 6))


class Places:
    def __init__(self, weights):
        self.weights = weights
        self.first = [Residual(15, 8, prior) for prior in ALONG_PRIORS]
        self.second = [Residual(15, 18, prior) for prior in ALONG_PRIORS]
        self.third = [Residual(15, 4, prior) for prior in ACROSS_PRIORS]
        self.free = Residual(1, 1, ALONG_PRIORS[0])

    def decode(self, coder, live, kind, parent, ring, open_ring, rough, child=None):
        origin = live.at[parent]
        minus = lambda p: [p[a] - origin[a] for a in range(3)]
        size = len(ring)
        ring_class = 6 if open_ring else min(max(size, 2), 7) - 2
        offsets = [minus(live.at[v]) for v in ring]
        bumps = [sum(live.bump(v)[a] for v in ring) for a in range(3)]
        bump = [mean16(b, size) >> 4 if size else 0 for b in bumps]
        if kind < 2:
            guides = [[mean16(sum(o[a] for o in offsets), size) for a in range(3)],
                      [8 * (offsets[0][a] + offsets[-1][a]) for a in range(3)], bump]
            extra = [0, 0, 0]
        else:
            extra = minus(child)
            guides = [[16 * x for x in extra],
                      [mean16(sum(o[a] for o in offsets) + extra[a], size + 1) for a in range(3)], bump]
        mix = lambda row: [(32 + sum(w * g[a] for w, g in zip(self.weights[kind][ring_class][row], guides))) >> 6
                           for a in range(3)]
        along, across = mix(0), mix(1)
        corners = offsets + [extra]
        count = size + 1
        normal = [0, 0, 0]
        for p, q in zip([corners[-1]] + corners[:-1], corners):
            for a in range(3):
                b, c = (a + 1) % 3, (a + 2) % 3
                normal[a] += p[b] * q[c] - p[c] * q[b]
        c = 2
        largest = 0
        for a in range(3):
            if abs(normal[a]) > largest:
                largest, c = abs(normal[a]), a
        excess = max(0, largest.bit_length() - 24)
        normal = [n >> excess for n in normal]
        spread = [(sum(abs(16 * o[a] - along[a]) for o in corners) // 4 * (65536 // count)) >> 16 for a in range(3)]
        roughness, rise, sinks = 0, 0, 0
        if normal[c] != 0:
            middle = [mean16(sum(o[a] for o in corners), count) for a in range(3)]
            height = lambda d: sum((d[a] - middle[a]) * normal[a] for a in range(3))
            total = sum(abs(height([16 * x for x in o])) >> 4 for o in corners)
            mean = (total >> 8) * (65536 // count) >> 8
            predicted = abs(height(across)) >> 4
            rise = half_octave(4 * predicted) - half_octave(abs(normal[c]))
            sinks = int((height(across) < 0) != (normal[c] < 0))
            roughness = min(4 * (mean + predicted // 2) // abs(normal[c]), 1 << 26)

        a, b = 1 if c == 0 else 0, 1 if c == 2 else 2
        out = [0, 0, 0]
        scale_a, scale_b = half_octave(spread[a]), half_octave(spread[b])
        flatness = min(half_octave(roughness), 55)
        mean_scale = (scale_a + scale_b) // 2
        bent = 0 if flatness + 6 < mean_scale else 1 if flatness + 2 < mean_scale else 2
        at_a, at_b = (within(origin[x] + ((along[x] + 8) >> 4)) for x in (a, b))
        shift_a, shift_b = (rough_shift(x, bent) if rough else 0 for x in (scale_a, scale_b))
        six, regular = ring_class == 3, 0
        if six:
            middles = [[p[x] + q[x] for p, q in zip(corners[:3], corners[3:])] for x in (a, b)]
            skew = sum(abs(u - v) + abs(v - w) + abs(w - u) for u, v, w in middles)
            regular = min(max((half_octave(skew) - half_octave(spread[a] + spread[b]) + 5) >> 1, 0), 4)
        sides = [side_class(along[x], along[x] - guides[1][x], scale) for x, scale in ((a, scale_a), (b, scale_b))]
        step_a = self.first[kind].decode(coder, scale_a - 2 * shift_a, 3 + regular if six else bent,
                                         sides[0], int(along[a] < 0))
        out[a] = within(at_a + (step_a << shift_a))
        sum_a, sum_b = sum(o[a] for o in corners), sum(o[b] for o in corners)
        squares = count * sum(o[a] * o[a] for o in corners) - sum_a * sum_a
        products = count * sum(o[a] * o[b] for o in corners) - sum_a * sum_b
        lean = 0
        if squares > 0:
            excess = max(0, squares.bit_length() - 50)
            squares, products = squares >> excess, products >> excess
            products = min(max(products, -4 * squares), 4 * squares)
            lean = 768 * abs(products) // squares * (-1 if products < 0 else 1)
        at_b = within(at_b + ((lean * (out[a] - at_a) + 512) >> 10))
        missed_a = departure(step_a, scale_a - 2 * shift_a)
        step_b = self.second[kind].decode(coder, scale_b - 2 * shift_b, missed_a + (3 + 3 * regular if six else 0),
                                          sides[1], int(along[b] < 0))
        out[b] = within(at_b + (step_b << shift_b))
        missed = max(missed_a, departure(step_b, scale_b - 2 * shift_b))
        leans = 2 * min(max(rise - mean_scale + 11, 0), 11) + sinks
        slide = 0
        if normal[c] != 0:
            along_plane = sum((16 * (out[x] - origin[x]) - across[x]) * normal[x] for x in (a, b))
            slide = quotient(along_plane, normal[c]) if normal[c] > 0 else quotient(-along_plane, -normal[c])
        at_c = within(origin[c] + ((across[c] - slide + 8) >> 4))
        out[c] = within(at_c + self.third[kind].decode(coder, flatness, missed, leans))
        return out

    def decode_free(self, coder, near):
        return [within(near[a] + self.free.decode(coder, 0, 0)) for a in range(3)]


# ---- Attributes

def numbers_of(attribute):
    return {4: 2, 5: 3}.get(attribute[3], attribute[2])


def from_octahedron(u, v, bits):
    most = (1 << (bits - 1)) - 1
    x, y = (min(max(n, -most), most) / most for n in (u, v))
    z = 1 - abs(x) - abs(y)
    if z < 0:
        x, y = (1 - abs(y)) * (-1 if x < 0 else 1), (1 - abs(x)) * (-1 if y < 0 else 1)
    length = math.sqrt(x * x + y * y + z * z)
    return [f32(x / length), f32(y / length), f32(z / length)]


def finite(x):
    if not math.isfinite(x):
        raise Bad('a place or value is not finite')
    return x


def restore(attribute, numbers):
    _, _, components, coding, bits, grid = attribute
    if coding == 0:
        return [finite(ordered_float(n)) for n in numbers]
    if coding == 1:
        return [f32(grid[c][0] + grid[c][1] * numbers[c]) for c in range(components)]
    if coding == 2:
        return [f32(float(n)) for n in numbers]
    if coding == 3:
        return [f32(n / 255.0) for n in numbers]
    vector = from_octahedron(numbers[0], numbers[1], bits)
    return vector if coding == 4 else vector + [-1.0 if numbers[2] else 1.0]


# ---- Sweeps and splits

class Directions:
    """Of one attribute: two numbers on an octahedron."""

    def __init__(self, bits):
        self.most = (1 << (bits - 1)) - 1
        self.size = 16 * self.most
        self.missed = [[0, 0] for _ in range(16)]
        self.first = [Number() for _ in range(24)]
        self.second = [[Number() for _ in range(24)] for _ in range(4)]

    def direction(self, numbers):
        x, y = (min(max(n, -self.most), self.most) for n in numbers)
        z = self.most - abs(x) - abs(y)
        return self.fold(x, y, self.most) + [z] if z < 0 else [x, y, z]

    @staticmethod
    def fold(x, y, size):
        return [abs(y) - size if x < 0 else size - abs(y), abs(x) - size if y < 0 else size - abs(x)]

    def sized(self, d):
        whole = sum(map(abs, d))
        if whole == 0:
            return [0, 0, self.size]
        over = max(0, whole.bit_length() - 40)
        parts = [(abs(n) >> over) * self.size // max(whole >> over, 1) for n in d]
        return [-part if n < 0 else part for part, n in zip(parts, d)]

    def guess(self, geometric, mean):
        self.guesses = [self.sized(geometric), self.sized(mean)]
        apart = sum(abs(a - b) for a, b in zip(*self.guesses))
        self.late = self.missed[min(half_octave(apart), 31) // 2]
        g, m = (missed + 1 for missed in self.late)
        share = 64 * m // (g + m)
        x, y, z = self.sized([share * a + (64 - share) * b for a, b in zip(*self.guesses)])
        if z < 0:
            x, y = self.fold(x, y, self.size)
        self.at = [(x + 8) >> 4, (y + 8) >> 4]
        self.scale = min(half_octave(min(g, m)) // 2, 23)

    def decode(self, coder):
        first = self.first[self.scale].decode(coder)
        second = self.second[min(first.bit_length(), 3)][self.scale].decode(coder)
        n = [signed(self.at[0] + unzigzag(first) & M32), signed(self.at[1] + unzigzag(second) & M32)]
        for i in range(2):
            if abs(n[i]) > self.most:
                n[i] = signed((-2 if n[i] < 0 else 2) * self.most - n[i] & M32)
                n[1 - i] = signed(-n[1 - i] & M32)
        now = self.direction(n)
        for k in range(2):
            off = sum(abs(16 * a - b) for a, b in zip(now, self.guesses[k]))
            self.late[k] += (off * off - self.late[k]) >> 5
        return n


class Decoder:
    def __init__(self, file):
        self.file, self.live = file, Live()
        self.mixes = []
        for attribute in file.attributes:
            self.mixes += [attribute[3] != 2 and not (attribute[3] == 5 and i == 2)
                           for i in range(numbers_of(attribute))]
        if file.weighted:
            self.mixes.append(False)
        self.group_bits = file.largest_group.bit_length()
        self.values, self.finer, self.groups = [], [], []
        self.cuts, self.places = Cuts(), Places(file.place_weights)

        self.sweep, self.cursor, self.asked, self.row = 0, 0, set(), {}
        self.marked_left = self.unmarked_left = 0
        self.error_bits, self.split_size = 0x7F7FFFFF, 0
        self.mark, self.batch_mark = answers(ROUND_ODDS), answers(BATCH_ODDS)
        self.kind, self.kinds, self.older = 0, Symbol(2), 0
        self.marked, self.unmarked, self.error, self.gap = Number(), Number(), Number(), Number()

        bits = lambda n: [Bit() for _ in range(n)]
        self.plain, self.one_birth, self.regular, self.place_moves, self.same_move, self.same_place = (
            bits(2) for _ in range(6))
        self.rough = bits(2)
        self.implied, self.group_stays, self.in_mask, self.moved, self.twin_moved = \
            Bit(), Bit(), Bit(), bits(3), bits(2)
        (self.births, self.twin, self.far, self.more_moves, self.moved_far, self.extra, self.corner_birth,
         self.corner_parent, self.corner_ring, self.corner_far) = (Number() for _ in range(10))
        self.parent_kind, self.corner_kind = Symbol(2), Symbol(2)
        self.finer_numbers = [Number() for _ in range(3)]
        self.value_numbers = [[Number() for _ in range(14)] for _ in self.mixes]
        self.directions, at = {}, 0  # by their first number's place
        for attribute in file.attributes:
            if attribute[3] == 4:
                self.directions[at] = Directions(attribute[4])
            at += numbers_of(attribute)
        self.last_place, self.last_group = [0, 0, 0], 0

        # The progressive mesh.
        self.behind, self.end = [], 0       # the row of vertices that sweeps ask
        self.positions, self.weights, self.parents, self.born_triangles = [], [], [], []
        self.splits, self.corner_changes, self.moves = [], [], []
        self.attribute_values = [[] for _ in file.attributes]
        self.moved_values = [[] for _ in file.attributes]
        self.decode_base()

    def decode_base(self):
        places, triangles = [[0, 0, 0] for _ in range(self.file.base_vertices)], []
        whole = not self.file.draco
        if not whole:
            places, triangles = decode_draco(self.file.draco)
        for place in places:
            self.live.add_vertex(place)
        for triangle in triangles:
            self.live.add_triangle(triangle)
        coder = Coder(self.file.extras)
        for v in range(len(places)):
            if whole:
                self.live.at[v] = self.places.decode_free(coder, self.live.at[v - 1] if v else [0, 0, 0])
            self.finer.append(self.decode_finer(coder))
            before = self.values[-1] if v else [0] * len(self.mixes)
            self.values.append(self.decode_values(coder, before, [1] * len(self.mixes)))
            self.add_vertex(self.live.at[v], self.finer[v], self.values[v], NONE)
        if whole:
            unnamed, models = 0, [Number() for _ in range(3)]
            for _ in range(self.file.base_triangles):
                triangle = []
                for model in models:
                    triangle.append((unnamed - unzigzag(model.decode(coder))) & M32)
                    unnamed = max(unnamed, triangle[-1] + 1)
                self.live.add_triangle(triangle)
                triangles.append(triangle)
        for triangle in triangles:
            self.born_triangles.append(triangle)
            if self.group_bits:
                self.groups.append(self.decode_group(coder, self.last_group))
        coder.end()
        self.live.link_twins(0)

    def decode_block(self, data, splits_end, error_before):
        coder = Coder(data)
        begin = len(self.splits)
        while len(self.splits) < splits_end:
            if self.marked_left == 0 and self.unmarked_left == 0:
                self.kind = self.kinds.decode(coder)
                if self.kind == 3:
                    raise Bad('a sweep is of no known kind')
                self.marked_left, self.unmarked_left = self.marked.decode(coder), self.unmarked.decode(coder)
                if len(self.splits) == begin:
                    self.error_bits = struct.unpack('<I', struct.pack('<f', error_before))[0]
                else:
                    steps = ((self.error_bits + (1 << 15) - 1) >> 15) - self.error.decode(coder)
                    self.error_bits = min(self.error_bits, steps << 15)
                alive = len(self.live.at)
                self.sweep += 1
                self.older = alive
                self.cursor, self.asked = 0, set(range(alive))  # of rounds: places
                self.lap, self.lap_end, self.piece, self.born, self.again = 0, alive, 0, alive, False
                self.sparse = self.marked_left * 64 < alive
                self.order = [0] if alive else []
                while len(self.order) < alive:
                    self.order.append(self.behind[self.order[-1]])
                self.row = {v: i for i, v in enumerate(self.order)}
            primary = NONE
            if self.marked_left:
                self.marked_left -= 1
                primary = self.decode_mark(coder)
            else:
                self.unmarked_left -= 1
            self.decode_split(coder, primary)
        coder.end()

    def decode_mark(self, coder):
        alive = len(self.live.at)
        if self.sparse:
            self.cursor = (self.cursor + self.gap.decode(coder)) % alive
            return self.cursor
        if self.kind:
            while self.cursor < self.older:
                v = self.order[self.cursor]
                star = self.live.star[v]
                locked = sum(self.is_locked(c // 3) for c in star)
                if self.kind == 2 or locked < len(star):
                    size, bumpy = self.bumpy(v)
                    acted = min(self.sweep - self.live.acted[v], 2)
                    valence = min(max(len(star), 3), 12) - 3
                    if coder.bit(self.batch_mark[((valence * 7 + min(locked, 6)) * 3 + acted) * 10 + bumpy]):
                        self.split_size += (size - self.split_size) >> 5
                        return v
                self.cursor += 1
            raise Bad('a sweep marks fewer vertices than it announces')
        while True:
            self.next_place()
            v = self.order[self.cursor] if self.cursor < self.older else self.cursor
            size, bumpy = self.bumpy(v)
            valence = min(max(len(self.live.star[v]), 3), 10) - 3
            touched, acted = min(self.sweep - self.live.touched[v], 2), min(self.sweep - self.live.acted[v], 2)
            age = (touched * 3 + acted) * 2 + self.again
            if coder.bit(self.mark[(valence * 18 + age) * 10 + bumpy]):
                self.split_size += (size - self.split_size) >> 5
                return v

    def next_place(self):
        """The next place to ask in rounds."""
        while True:
            end = min(self.piece + 1024, self.lap_end)
            ahead = [p for p in self.asked if p >= self.cursor and (p < end or p >= self.born)]
            if ahead:
                self.cursor = min(ahead)
                self.asked.remove(self.cursor)
                return
            if self.cursor > self.piece:
                self.cursor, self.again = self.piece, True
                continue
            ahead = [p for p in self.asked if self.piece <= p < self.lap_end]
            if not ahead:
                if not self.asked:
                    raise Bad('a sweep marks fewer vertices than it announces')
                self.lap, self.lap_end, ahead = self.lap + 1, len(self.live.at), self.asked
            self.piece = self.cursor = min(ahead) // 1024 * 1024
            self.born, self.again = len(self.live.at), self.lap > 0

    def bumpy(self, v):
        size = log2(1 + sum(b * b for b in self.live.bump(v)))
        return size, min(max((size - self.split_size + 1536) >> 8, 0), 9)

    def is_locked(self, triangle):
        return self.kind > 0 and max(self.live.triangles[triangle]) >= self.older

    def decode_finer(self, coder):
        return [n.decode(coder) for n in self.finer_numbers] if self.file.lossless else [0, 0, 0]

    def decode_values(self, coder, predicted, scales, guessed=False):
        values = []
        while len(values) < len(predicted):
            i = len(values)
            if guessed and i in self.directions:
                values += self.directions[i].decode(coder)
            else:
                read = self.value_numbers[i][scales[i]].decode(coder)
                values.append(signed((predicted[i] + unzigzag(read)) & M32))
        return values

    def decode_group(self, coder, predicted):
        if not coder.bit(self.group_stays):
            predicted = coder.raw(self.group_bits)
        self.last_group = predicted
        return predicted

    def decode_split(self, coder, primary):
        live, marked = self.live, primary != NONE
        if marked:
            star = Star(live, primary)
            if star.fan and coder.bit(self.plain[star.closed]):
                return self.decode_plain(coder, primary, star)
        count = 1 if coder.bit(self.one_birth[marked]) else self.births.decode(coder)
        births, taken, moves, implied = [], [], [], []     # births: parent, place, finer, values; moves: the same
        for index in range(count):
            parent = self.decode_parent(coder, primary, index, births)
            run, child_ring, parent_ring = None, [], []
            if parent != NONE:
                if self.kind and parent >= self.older:
                    raise Bad('a batch splits a vertex that it bore')
                child = len(live.at) + index
                star = Star(live, parent)
                if star.fan and coder.bit(self.regular[star.closed]):
                    run = self.cuts.decode(coder, live, star, self.older if self.kind else NONE)
                    child_ring, parent_ring = self.take_run(star, run, child, taken, implied)
                else:
                    mine = [c for c in star.corners
                            if (coder.raw(1) if star.size > 64 else coder.bit(self.in_mask))]
                    if any(self.is_locked(c // 3) for c in mine):
                        raise Bad('a batch changes a triangle twice')
                    taken.append((child, mine))
            moving = False
            if parent != NONE and all(b[0] != parent for b in births):
                moving = bool(coder.bit(self.moved[0 if index == 0 else 1 if not moves else 2]))
            if index > 0 and coder.bit(self.same_place[parent != NONE]):
                place, finer = births[0][1], births[0][2]
            else:
                if run:
                    rough = moving and not self.file.lossless and coder.bit(self.rough[0])
                    place = self.places.decode(coder, live, 1 if moving else 0, parent, child_ring,
                                               not (run[2] and run[3]), rough)
                else:
                    place = self.places.decode_free(coder, live.at[parent] if parent != NONE else self.last_place)
                finer = self.decode_finer(coder)
            self.last_place = place
            predicted = self.predict_values(parent, child_ring if run else None, births)
            guessed = run is not None and self.guess_directions(parent, place, child_ring, run)
            births.append((parent, place, finer, self.decode_values(coder, *predicted, guessed)))
            if moving:
                guide = (parent_ring, not star.closed, place) if run else None
                self.decode_move(coder, parent, guide, moves)
        if births and births[0][0] != NONE:
            first = births[0][0]
            moving = bool(moves) and moves[0][0] == first
            twin = live.twin[first]
            for _ in range(64):
                if twin == first:
                    break
                if all(b[0] != twin for b in births) and coder.bit(self.twin_moved[moving]):
                    self.decode_move(coder, twin, None, moves)
                twin = live.twin[twin]
        for _ in range(self.more_moves.decode(coder)):
            self.decode_move(coder, len(live.at) - 1 - self.moved_far.decode(coder), None, moves)
        triangles, groups = [], []
        if implied and coder.bit(self.implied):
            for triangle, group in implied:
                triangles.append(triangle)
                if self.group_bits:
                    groups.append(self.decode_group(coder, group))
        near = sorted({v for c in live.star[births[0][0]] for v in live.triangles[c // 3]} - {births[0][0]}) \
            if births and births[0][0] != NONE else []
        for _ in range(self.extra.decode(coder)):
            triangles.append([self.decode_corner(coder, births, near) for _ in range(3)])
            if self.group_bits:
                groups.append(self.decode_group(coder, self.last_group))
        self.make_split(births, taken, moves, triangles, groups)

    def decode_plain(self, coder, parent, star):
        taken, moves, implied = [], [], []
        run = self.cuts.decode(coder, self.live, star, self.older if self.kind else NONE)
        child_ring, parent_ring = self.take_run(star, run, len(self.live.at), taken, implied)
        moving = coder.bit(self.moved[0])
        rough = moving and not self.file.lossless and coder.bit(self.rough[0])
        place = self.places.decode(coder, self.live, 1 if moving else 0, parent, child_ring, not (run[2] and run[3]), rough)
        finer = self.decode_finer(coder)
        self.last_place = place
        values = self.decode_values(coder, *self.predict_values(parent, child_ring, []),
                                    self.guess_directions(parent, place, child_ring, run))
        if moving:
            self.decode_move(coder, parent, (parent_ring, not star.closed, place), moves)
        groups = [self.decode_group(coder, group) for _, group in implied] if self.group_bits else []
        self.make_split([(parent, place, finer, values)], taken, moves, [t for t, _ in implied], groups)

    def decode_parent(self, coder, primary, index, births):
        if index == 0 and primary != NONE:
            return primary
        kind = self.parent_kind.decode(coder)
        if kind == 0:
            return NONE
        if kind == 1:
            parent = self.live.twin[primary]
            for _ in range(self.twin.decode(coder)):
                parent = self.live.twin[parent]
            return parent
        if kind == 2:
            return births[self.births.decode(coder)][0]
        return len(self.live.at) - 1 - self.far.decode(coder)

    def take_run(self, star, run, child, taken, implied):
        (begin, length, first_wing, last_wing), n, p = run, star.size, star.centre
        end, size = begin + length, len(star.ring)
        sectors = [star.sector[i % n] for i in range(begin, end)]
        taken.append((child, sorted(3 * t + self.live.triangles[t].index(p) for t in sectors)))
        group = lambda i: self.groups[star.sector[i % n]] if self.groups else 0
        if last_wing:
            implied.append(([child, star.ring[end % size], p], group(end - 1 if end > 0 else 0)))
        if first_wing:
            implied.append(([child, p, star.ring[begin]], group(begin if begin < n else n - 1)))
        child_ring = [star.ring[i % size] for i in range(begin, end + 1)]
        if star.closed:
            return child_ring, [star.ring[i % n] for i in range(end, begin + n + 1)]
        return child_ring, (star.ring[end:] if last_wing else []) + (star.ring[:begin + 1] if first_wing else [])

    def predict_values(self, parent, ring, births):
        if parent == NONE:
            before = births[-1][3] if births else self.values[-1] if self.values else [0] * len(self.mixes)
            return before, [0] * len(self.mixes)
        own, predicted, scales = self.values[parent], [], []
        for i, mixed in enumerate(self.mixes):
            if ring is None or not mixed:
                predicted.append(own[i])
                scales.append(0)
                continue
            offsets = [self.values[v][i] - own[i] for v in ring]
            predicted.append(own[i] + ((mean16(sum(offsets), len(ring) + 1) + 8) >> 4))
            spread = mean16(sum(map(abs, offsets)), len(ring) + 1)
            scales.append(min((half_octave(spread) + 1) // 2 + 1, 13))
        return predicted, scales

    def guess_directions(self, parent, place, ring, run):
        to = [[a - b for a, b in zip(self.live.at[v], place)] for v in ring]
        p = [a - b for a, b in zip(self.live.at[parent], place)]
        row = ([p] if run[2] else []) + to + ([p] if run[3] else [])
        geometric = [0, 0, 0]
        for a, b in zip(row, row[1:]):
            geometric = [geometric[k] + a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3]
                         for k in range(3)]
        for at, model in self.directions.items():
            near = [model.direction(self.values[v][at:at + 2]) for v in [parent] + ring]
            model.guess(geometric, [sum(d[k] for d in near) for k in range(3)])
        return True

    def decode_move(self, coder, vertex, guide, moves):
        guided = guide is not None
        now, finer = self.live.at[vertex], self.finer[vertex]
        if moves and coder.bit(self.same_move[guided]):
            now, finer = moves[0][1], moves[0][2]
        elif coder.bit(self.place_moves[guided]):
            if guided:
                rough = not self.file.lossless and coder.bit(self.rough[1])
                now = self.places.decode(coder, self.live, 2, vertex, guide[0], guide[1], rough, guide[2])
            else:
                now = self.places.decode_free(coder, now)
            finer = self.decode_finer(coder)
        values = self.decode_values(coder, self.values[vertex], [0] * len(self.mixes))
        moves.append((vertex, now, finer, values))

    def decode_corner(self, coder, births, near):
        kind, alive = self.corner_kind.decode(coder), len(self.live.at)
        if kind == 0:
            return alive + len(births) - 1 - self.corner_birth.decode(coder)
        if kind == 1:
            return births[self.corner_parent.decode(coder)][0]
        if kind == 2:
            return near[self.corner_ring.decode(coder)]
        return alive - 1 - self.corner_far.decode(coder)

    def make_split(self, births, taken, moves, triangles, groups):
        live, first = self.live, len(self.live.at)
        changed = set()
        for v in [b[0] for b in births if b[0] != NONE]:
            changed |= {w for c in live.star[v] for w in live.triangles[c // 3]} | {v}
            live.acted[v] = self.sweep
        for vertex, place, finer, values in moves:
            live.at[vertex], self.finer[vertex], self.values[vertex] = list(place), finer, values
            self.add_move(vertex, place, finer, values)
        for parent, place, finer, values in births:
            live.add_vertex(place)
            self.finer.append(finer)
            self.values.append(values)
            self.add_vertex(place, finer, values, parent)
        for child, corners in taken:
            for corner in corners:
                live.star[live.triangles[corner // 3][corner % 3]].remove(corner)
                live.star[child].add(corner)
                live.triangles[corner // 3][corner % 3] = child
                self.corner_changes.append((corner, child))
        for vertex, *_ in moves:
            changed |= {w for c in live.star[vertex] for w in live.triangles[c // 3]} | {vertex}
            live.acted[vertex] = self.sweep
        for triangle in triangles:
            live.add_triangle(triangle)
            self.born_triangles.append(list(triangle))
            changed |= set(triangle)
        self.groups += groups
        changed |= set(range(first, len(live.at)))
        for v in changed:
            live.touched[v] = self.sweep
        for v in range(first, len(live.at)):
            live.acted[v] = self.sweep
        self.asked |= {self.row.get(v, v) for v in changed}
        live.link_twins(first)
        error = struct.unpack('<f', struct.pack('<I', self.error_bits))[0]
        self.splits.append((len(self.positions), len(self.born_triangles), len(self.corner_changes), len(self.moves),
                            error))

    # ---- What the numbers are as floats

    def position(self, place, finer):
        out = []
        for a in range(3):
            x = f32(self.file.origin[a] + self.file.step * place[a])
            if self.file.lossless:
                x = finite(ordered_float(signed((ordered_number(x) + unzigzag(finer[a])) & M32)))
            out.append(x)
        return out

    def floats(self, values, to):
        for i, attribute in enumerate(self.file.attributes):
            count = numbers_of(attribute)
            to[i].extend(restore(attribute, values[:count]))
            values = values[count:]
        weight = ordered_float(values[0]) if self.file.weighted else 1.0
        if not weight >= 0:
            raise Bad('a weight is negative or not a number')
        return weight

    def add_vertex(self, place, finer, values, parent):
        number, before = len(self.positions), self.end if parent == NONE else parent
        if before == self.end:
            self.end = number
        self.behind.append(self.behind[before] if number else NONE)
        if number:
            self.behind[before] = number
        self.positions.append(self.position(place, finer))
        self.parents.append(parent)
        weight = self.floats(values, self.attribute_values)
        if self.file.weighted:
            self.weights.append(weight)

    def add_move(self, vertex, place, finer, values):
        self.moves.append((vertex, *self.position(place, finer), self.floats(values, self.moved_values)))

    def digest(self):
        """Counts, then XXH64 of each array as little-endian bytes in memory order."""
        flat = lambda rows: [x for row in rows for x in row]
        floats = lambda xs: xxh64(struct.pack('<%df' % len(xs), *xs))
        words = lambda xs: xxh64(struct.pack('<%dI' % len(xs), *xs))
        sums = [floats(flat(self.positions)), floats(self.weights), words(self.parents),
                words(flat(self.born_triangles)), xxh64(b''.join(struct.pack('<4If', *s) for s in self.splits)),
                words(flat(self.corner_changes)), xxh64(b''.join(struct.pack('<I4f', *m) for m in self.moves)),
                words(self.groups)]
        sums += [floats(v) for v in self.attribute_values + self.moved_values]
        return '%d %d %d ' % (len(self.positions), len(self.born_triangles), len(self.splits)) + \
            ' '.join('%016x' % s for s in sums)


def main():
    with open(sys.argv[1], 'rb') as source:
        data = source.read()
    file = File(data)
    decoder = Decoder(file)
    print(decoder.digest())
    error_before = file.base_error
    for offset, size, checksum, splits, *_, error in file.blocks:
        block = data[offset:offset + size]
        if xxh32(block) != checksum:
            raise Bad("a block's checksum")
        decoder.decode_block(block, splits, error_before)
        error_before = error
        print(decoder.digest())


if __name__ == '__main__':
    try:
        main()
    except (Bad, OSError, struct.error, subprocess.CalledProcessError) as problem:
        sys.exit('decode.py: %s' % problem)
