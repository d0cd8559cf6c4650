"""A reader of EXA files, by docs/exa.md (of labels only the planes): `python3 exa_reader.py FILE...` prints the sums of each mesh
and fails when they are not those of the header. Needs numpy. Slow: for tests, not for use."""

import itertools
import json
import struct
import sys
import zlib
from functools import lru_cache
from pathlib import Path

import numpy as np
from exa_coding import (LOGISTIC, AdaptiveBit, Decoder, Refiner, SignedNumber, Tree, clamp, curve_at)
from exa_labels import contact_edges, decode_labels

STEEP = [4096, 3444, 2896, 2435, 2048, 1722, 1448, 1218, 1024, 861, 724, 609, 512, 431, 362, 304, 256, 215, 181, 152, 128,
         108, 91, 76, 64, 54, 45, 38, 32, 27, 23, 19]
PHASES = [7, 6, 5, 3, 4, 2, 1]


# Container -----------------------------------------------------------------------------------------------------------


def read_blocks(data):
    """{type: [chunk, ...]}; raises ValueError where a byte is wrong."""

    def need(ok, what):
        if not ok:
            raise ValueError(what)

    need(data[:8] == b"\x89EXA\r\n\x1a\n", "magic")
    major, _, count, size = struct.unpack_from("<HHIQ", data, 8)
    need(major in (3, 4, 5, 6, 7) and count <= 256 and size == len(data), "head")
    end = 24 + 28 * count
    need(zlib.crc32(data[:end]) == struct.unpack_from("<I", data, end)[0], "sum of the table")
    blocks, at = {"major": major}, end + 4
    for row in range(count):
        kind, codec, flags, offset, length, chunks = struct.unpack_from("<4sHHQQI", data, 24 + 28 * row)
        need(offset == at and codec == 0 and kind not in blocks, "table")
        block, at = data[offset:offset + length], offset + length
        place, lengths = 4, []
        for _ in range(chunks):
            n = shift = 0
            while True:
                byte = block[place]
                place += 1
                n |= (byte & 127) << shift
                shift += 7
                if byte < 128:
                    break
            lengths.append(n)
        sums = []
        for n in lengths:
            sums.append(struct.unpack_from("<I", block, place)[0] if n else 0)
            place += 4 if n else 0
        need(zlib.crc32(block[4:place]) == struct.unpack_from("<I", block, 0)[0], "sum of an index")
        out = []
        for n, check in zip(lengths, sums):
            chunk, place = block[place:place + n], place + n
            need(len(chunk) == n and zlib.crc32(chunk) == check, "sum of a chunk")
            out.append(chunk)
        need(place == len(block), "length of a block")
        blocks[kind.decode()] = out
    need(data[at:] == b"EXA.END\n", "end mark")
    return blocks


# Weights -------------------------------------------------------------------------------------------------------------


@lru_cache(None)
def constants():
    """{name: numbers} of docs/exa_constants.txt."""
    lines = (Path(__file__).resolve().parents[2] / "docs" / "exa_constants.txt").read_text().splitlines()
    tables, numbers = {}, None
    for line in lines[1:]:
        name, _, count = line.rpartition(" ")
        if line[:1].isalpha():
            numbers = tables.setdefault(name, [])
        else:
            numbers.extend(int(v) for v in line.split())
    return {name: np.array(values, dtype=np.int64) for name, values in tables.items()}


def sign_taps(phase):
    order = {0: -1, **{p: i for i, p in enumerate(PHASES)}}
    taps = []
    for z, y, x in itertools.product(range(-3, 4), repeat=3):
        if x * x + y * y + z * z > 11:
            continue
        kind = phase ^ (x & 1 | (y & 1) << 1 | (z & 1) << 2)
        if order[kind] < order[phase] or (kind == phase and (z, y, x) < (0, 0, 0)):
            taps.append((z, y, x))
    return taps


@lru_cache(None)
def sign_model(which):
    units = 64 if which == 2 else 16
    values = constants()[f"sign model {which}"]
    at, phases = 0, {}
    for phase in PHASES:
        taps = sign_taps(phase)
        n, end = len(taps) * units, (len(taps) + 2) * units
        w = values[at:at + n].reshape(-1, units)
        bias, out, level = values[at + n:at + n + units], values[at + n + units:at + end], values[at + end:at + end + 3]
        at += end + 3
        phases[phase] = (np.array(taps), w, bias, out, level)
    return phases


@lru_cache(None)
def offset_model(which):
    values, at, axes = constants()[f"offset model {which}"], 0, []
    for _ in range(3):
        axes.append((values[at:at + 1248].reshape(24, 52), values[at + 1248:at + 1272],
                     values[at + 1272:at + 1320].reshape(2, 24), values[at + 1320:at + 1322]))
        at += 1322
    return axes


# Signs ---------------------------------------------------------------------------------------------------------------


def padded(n):
    return max(1, (n + 6) // 8) * 8


def bricks_of(dims):
    """(low, cells) of each brick, x y z."""
    along = [[(low, min(128, padded(n) - low)) for low in range(0, padded(n), 128)] for n in dims]
    return [(x, y, z) for z, y, x in itertools.product(along[2], along[1], along[0])]


class Around:
    """What a brick knows of those beside it: `signs` [z, y, x] of the volume, its `low` and `cells`, z y x."""

    def __init__(self, signs, low, cells):
        self.signs, self.low = signs, low
        self.open = [(low[a] > 0, low[a] + cells[a] < padded(signs.shape[a])) for a in range(3)]

    def get(self, places, spacing):
        """Signs at places of the brick's lattice; None beyond the volume."""
        at = [self.low[a] + spacing * places[a] for a in range(3)]
        return self.signs[tuple(at)] if all(0 <= at[a] < self.signs.shape[a] for a in range(3)) else None

    def sides(self, n):
        """The points of the open sides."""
        for place in itertools.product(*(range(k + 1) for k in n)):
            if any(self.open[a][side] and place[a] == (0, n[a])[side] for a in range(3) for side in range(2)):
                yield place


class Lattice:
    """Signs [z, y, x] with a border of 3 that mirrors, or has the points of the bricks `around`."""

    def __init__(self, values, around, spacing):
        self.n = [s - 1 for s in values.shape]
        self.a = np.zeros([s + 6 for s in values.shape], dtype=np.int8)
        # Along each axis: the place that is read; None: outside, of no brick; behind: of a brick beside this one.
        index, behind = [], []
        for axis, n in enumerate(self.n):
            low, high = around.open[axis] if around else (False, False)
            behind.append([(low and c < 0) or (high and c > n) for c in range(-3, n + 4)])
            mirrored = [c if 0 <= c <= n or b else -c if -n <= c < 0 else 2 * n - c if n < c <= 2 * n else None
                        for c, b in zip(range(-3, n + 4), behind[-1])]
            index.append(mirrored)
        for z, y, x in np.ndindex(*self.a.shape):
            s = index[0][z], index[1][y], index[2][x]
            others = behind[0][z] + behind[1][y] + behind[2][x]
            if None not in s and others == 0:
                self.a[z, y, x] = values[s]
            elif None not in s and others == 1:
                self.a[z, y, x] = around.get(s, spacing) or 0
        self.images = [{} for _ in range(3)]
        for axis in range(3):
            for place, source in enumerate(index[axis]):
                if not behind[axis][place]:
                    self.images[axis].setdefault(source, []).append(place)

    def set(self, z, y, x):
        self.a[np.ix_(self.images[0][z], self.images[1][y], self.images[2][x])] = 1

    def values(self):
        return self.a[3:-3, 3:-3, 3:-3]


def uniform_cells(values):
    corners = np.stack([values[dz:values.shape[0] - 1 + dz, dy:values.shape[1] - 1 + dy, dx:values.shape[2] - 1 + dx]
                        for dz in (0, 1) for dy in (0, 1) for dx in (0, 1)])
    return corners.min(0) == corners.max(0)


def decode_brick(chunks, top, coarse, beside):
    """`chunks`: spacing 4, 2, 1; `top`: signs of spacing 8; `beside`: None or what is known. Signs of spacing 1."""
    if not chunks[0]:
        return np.full([(s - 1) * 8 + 1 for s in top.shape], top[0, 0, 0], dtype=np.int8)
    model = sign_model(chunks[0][0])
    hidden_start = ([16, 200, 1500, 2600, 5000, 6000, 8000], [4000, 12000, 20000, 22000, 24000, 26000, 28000])
    flags = {(s, h, c, m): AdaptiveBit(hidden_start[h][m], 20)
             for s in range(3) for h in range(2) for c in range(2) for m in range(7)}
    refiners = {}
    values, active = np.array(top), None
    for step in range(3):
        decoder = Decoder(chunks[step][1:] if step == 0 else chunks[step])
        level = 2 if coarse else (2, 1, 0)[step]
        mixed = ~uniform_cells(values)
        inside_active = np.ones(mixed.shape, bool) if active is None else active.repeat(2, 0).repeat(2, 1).repeat(2, 2)
        active, around = mixed.copy(), np.pad(mixed, 1).astype(int)
        hidden = np.zeros([s + 1 for s in mixed.shape], dtype=int)
        for z, y, x in np.argwhere(inside_active & ~mixed):
            h = hidden[z + 1, y + 1, x] | hidden[z + 1, y, x + 1] | hidden[z, y + 1, x + 1]
            m = (around[z + 1, y + 1, x] + around[z + 1, y + 1, x + 2] + around[z + 1, y, x + 1] +
                 around[z + 1, y + 2, x + 1] + around[z, y + 1, x + 1] + around[z + 2, y + 1, x + 1])
            if decoder.adaptive(flags[step, h, values[z, y, x], m]):
                hidden[z + 1, y + 1, x + 1] = 1
                active[z, y, x] = True
        fine = np.zeros([2 * s - 1 for s in values.shape], dtype=np.int8)
        fine[::2, ::2, ::2] = values
        for z, y, x in np.argwhere(~active & (values[:-1, :-1, :-1] == 1)):
            fine[2 * z:2 * z + 3, 2 * y:2 * y + 3, 2 * x:2 * x + 3] = 1
        known = np.zeros(fine.shape, bool)
        for z, y, x in np.argwhere(~active):
            known[2 * z:2 * z + 3, 2 * y:2 * y + 3, 2 * x:2 * x + 3] = True
        spacing = (4, 2, 1)[step]
        for place in beside.sides([k - 1 for k in fine.shape]) if beside else ():
            sign = beside.get(place, spacing)
            if sign is not None:
                fine[place], known[place] = sign, True
        lattice = Lattice(fine, beside, spacing)
        for phase in PHASES:
            taps, weights, bias, out, level_bias = model[phase]
            refiner = refiners.setdefault((level, phase), Refiner())
            first = [phase >> 2 & 1, phase >> 1 & 1, phase & 1]
            todo = np.argwhere(~known[first[0]::2, first[1]::2, first[2]::2]) * 2 + first
            for z, y, x in todo:
                signs = lattice.a[taps[:, 0] + z + 3, taps[:, 1] + y + 3, taps[:, 2] + x + 3]
                units = np.clip(bias + ((2 * signs.astype(np.int64) - 1)[:, None] * weights).sum(0), 0, 1023)
                logit = clamp((int((units * out).sum()) >> 3) + int(level_bias[level]), -2047, 2047)
                bit = decoder.bit(clamp(refiner.predict(logit), 16, 65520))
                refiner.learn(bit)
                if bit:
                    lattice.set(z, y, x)
        values = lattice.values()
    return np.array(values)


def decode_tier(chunks, dims, top, coarse, major):
    """`chunks`: three lists, spacing 4, 2, 1; `top`: every 8th point. Signs [z, y, x]."""
    signs = np.zeros(dims[::-1], dtype=np.int8)
    bricks = list(enumerate(bricks_of(dims)))
    late = [sum(b[0] // 128 for b in brick) % 2 if major >= 5 else 0 for _, brick in bricks]
    for i, brick in sorted(bricks, key=lambda item: late[item[0]]):
        low = [b[0] for b in brick]
        part = tuple(slice(b[0] // 8, (b[0] + b[1]) // 8 + 1) for b in reversed(brick))
        beside = Around(signs, low[::-1], [b[1] for b in reversed(brick)]) if late[i] else None
        values = decode_brick([c[i] for c in chunks], top[part], coarse, beside)
        ends = [min(low[a] + values.shape[2 - a], dims[a]) for a in range(3)]
        signs[low[2]:ends[2], low[1]:ends[1], low[0]:ends[0]] = values[:ends[2] - low[2], :ends[1] - low[1],
                                                                       :ends[0] - low[0]]
    return signs


def decode_signs(blocks, dims):
    dims1 = [padded(n) // 8 + 1 for n in dims]
    dims2 = [padded(n) // 8 + 1 for n in dims1]
    count = dims2[0] * dims2[1] * dims2[2]
    top = np.unpackbits(np.frombuffer(blocks["SIGC"][0], np.uint8), bitorder="little")[:count].reshape(dims2[::-1])
    n = len(bricks_of(dims1))
    middle = [blocks["SIGC"][1 + n * s:1 + n * (s + 1)] for s in range(3)]
    eighth = decode_tier(middle, dims1, top.astype(np.int8), True, blocks["major"])
    return decode_tier([blocks["SIG2"], blocks["SIG1"], blocks["SIG0"]], dims, eighth, False, blocks["major"])


# Offsets and faces ---------------------------------------------------------------------------------------------------

UNIT = np.eye(3, dtype=int)
COLUMNS = [(-1, 0), (1, 0), (0, -1), (0, 1), (-1, -1), (1, -1), (-1, 1), (1, 1), (-2, 0), (2, 0), (0, -2), (0, 2)]
SIDES = [(-1, 0), (1, 0), (0, -1), (0, 1)]


def item_order(signs, faces):
    """Active edges or ambiguous faces as (x, y, z, axis), in order."""
    s, found = signs.transpose(2, 1, 0), []  # [x, y, z]
    for a in range(3):
        if faces:
            others = [b for b in range(3) if b != a]
            cut = lambda *d: s[tuple(slice(d[others.index(b)], s.shape[b] - 1 + d[others.index(b)]) if b in others
                                     else slice(None) for b in range(3))]
            mask = (cut(0, 0) != cut(1, 0)) & (cut(0, 0) != cut(0, 1)) & (cut(0, 0) == cut(1, 1))
        else:
            low = tuple(slice(0, -1) if b == a else slice(None) for b in range(3))
            high = tuple(slice(1, None) if b == a else slice(None) for b in range(3))
            mask = s[low] != s[high]
        p = np.argwhere(mask)
        found.append(np.c_[p, np.full(len(p), a)])
    items = np.concatenate(found)
    return items[np.lexsort((items[:, 0], items[:, 3], items[:, 1], items[:, 2]))]


def by_brick(items, dims, far_sides):
    grid = [len(range(0, padded(n), 128)) for n in dims]
    brick = np.minimum(items[:, :3] // 128, np.array(grid) - 1)
    owner = brick[:, 0] + grid[0] * (brick[:, 1] + grid[1] * brick[:, 2])
    nobody = (items[:, :3] // 128 >= np.array(grid)).any(axis=1) & (not far_sides)
    return np.where(nobody, -1, owner)


def decode_faces(chunks, items, dims, far_sides):
    owner, joined = by_brick(items, dims, far_sides), np.zeros(len(items), dtype=np.uint8)
    for i, chunk in enumerate(chunks):
        decoder, model = Decoder(chunk), AdaptiveBit(32768, 6)
        for k in np.flatnonzero(owner == i):
            joined[k] = decoder.adaptive(model)
    return joined


def decode_offsets(chunks, signs, edges, bits, far_sides, given=None):
    """`given`: of edges that are not coded, the offset; -1 of others."""
    dims = signs.shape[::-1]
    s, owner, offsets = signs.transpose(2, 1, 0), by_brick(edges, dims, far_sides), np.zeros(len(edges), dtype=np.uint16)
    n, rest = min(bits, 6), bits - min(bits, 6)
    for i, brick in enumerate(bricks_of(dims)):
        if not chunks[i]:
            continue
        model, decoder, known = offset_model(chunks[i][0]), Decoder(chunks[i][1:]), {}
        low = np.array([b[0] for b in brick])
        high = np.minimum(low + 128, np.array(dims) - 1)
        sign = lambda p: s[tuple(np.clip(p, low, high))]
        for k in np.flatnonzero(owner == i):
            p, a = edges[k, :3], int(edges[k, 3])
            if given is not None and given[k] >= 0:
                offsets[k] = given[k]
                known[(*p, a)] = (2 * int(offsets[k]) + 1) << 5 >> bits
                continue
            ua, va = (a + 1) % 3, (a + 2) % 3
            own, inputs = sign(p), []
            for cu, cv in COLUMNS:
                c = p + cu * UNIT[ua] + cv * UNIT[va]
                q = {d: sign(c + d * UNIT[a]) == own for d in range(-1, 3)}
                cell = next((d for d in (0, -1, 1) if q[d] and not q[d + 1]), None)
                if cell is None:
                    inputs += [0, 112 if q[0] and q[1] else 0 if q[0] or q[1] else -112, 0]
                    continue
                middle = known.get((*(c + cell * UNIT[a]), a))
                inputs += [0, 64 * cell, 0] if middle is None else [64 * cell + middle - 32, 0, 64]
            for end in (0, 1):
                for su, sv in SIDES:
                    start = p + end * UNIT[a]
                    other = start + su * UNIT[ua] + sv * UNIT[va]
                    if sign(start) == sign(other):
                        inputs += [0, 0]
                        continue
                    back = su + sv < 0
                    middle = known.get((*(other if back else start), ua if su else va))
                    inputs += [0, 64] if middle is None else [middle + 1 if back else 64 - middle, 0]
            w, bias, out, out_bias = model[a]
            units = np.clip((128 * bias + w @ np.array(inputs)) >> 7, 0, 8191)
            mean = 8 * clamp(((int(out[0] @ units) >> 7) + int(out_bias[0]) + 4) >> 3, -128, 127)
            steep = STEEP[clamp(((int(out[1] @ units) >> 9) + int(out_bias[1])) >> 6, 0, 31)]

            def start_of(symbol):
                if symbol in (0, 1 << n):
                    return 65536 if symbol else 0
                z = clamp((((symbol << (10 - n)) - 512 - mean) * steep) >> 8, -2048, 2047)
                return (curve_at(LOGISTIC, z) * (65536 - (32 << n)) >> 16) + 32 * symbol

            place, symbol = decoder.place(), 0
            for b in reversed(range(n)):
                if start_of(symbol | 1 << b) <= place:
                    symbol |= 1 << b
            decoder.take(start_of(symbol), start_of(symbol + 1) - start_of(symbol))
            offsets[k] = symbol << rest | decoder.raw(rest)
            known[(*p, a)] = (2 * int(offsets[k]) + 1) << 5 >> bits
    return offsets


# Cells ---------------------------------------------------------------------------------------------------------------


def edge_between(c0, c1):
    a = (c0 ^ c1).bit_length() - 1
    low = min(c0, c1)
    return 4 * a + (low >> (a + 1) % 3 & 1) + 2 * (low >> (a + 2) % 3 & 1)


def edge_corners(e):
    a = e // 4
    low = (e & 1) << (a + 1) % 3 | (e >> 1 & 1) << (a + 2) % 3
    return low, low | 1 << a


def face_ring(f):
    a = f // 2
    u, v, o = 1 << (a + 1) % 3, 1 << (a + 2) % 3, (f & 1) << a
    return [o, o | u, o | u | v, o | v] if f & 1 else [o, o | v, o | u | v, o | u]


def ambiguous_faces(signs):
    found = []
    for f in range(6):
        b = [signs >> c & 1 for c in face_ring(f)]
        if b[0] == b[2] != b[1] == b[3]:
            found.append(f)
    return found


def curves_of(signs, joined):
    """[(edges, faces)]; faces[i] is crossed from edges[i] to edges[i + 1]."""
    ambiguous, following = ambiguous_faces(signs), {}
    for f in range(6):
        ring = face_ring(f)
        inside = [signs >> c & 1 for c in ring]
        for i in range(4):
            if not inside[i] or inside[(i + 1) % 4]:
                continue
            back = i + 1
            while not inside[(back + 1) % 4]:
                back += 1
            if f in ambiguous and f not in joined:
                back = i + 3
            edge = lambda k: edge_between(ring[k % 4], ring[(k + 1) % 4])
            following[edge(i)] = (edge(back), f)
    curves, seen = [], set()
    for start in range(12):
        if start not in following or start in seen:
            continue
        edges, faces, e = [], [], start
        while e not in seen:
            seen.add(e)
            edges.append(e)
            faces.append(following[e][1])
            e = following[e][0]
        curves.append((edges, faces))
    return curves


def pieces_of(edges, chords):
    side = [0] * len(edges)
    for k, (a, b) in enumerate(chords):
        if a not in edges or b not in edges:
            continue
        i, j = sorted((edges.index(a), edges.index(b)))
        for s in range(i, j):
            side[s] |= 1 << k
    names = []
    for s in side:
        if s not in names:
            names.append(s)
    return [names.index(s) for s in side]


def splits_of(curve):
    edges, faces = curve
    n = len(edges)
    if len(set(faces)) == n:
        return [[]]
    spans = [(i, j) for i in range(n) for j in range(i + 2, n) if j - i + 2 <= n]
    for size in (1, 2):
        best = []
        for chosen in itertools.combinations(spans, size):
            if size == 2:
                (i, j), (k, l) = chosen
                if {i, j} & {k, l} or (i < k < j) != (i < l < j):
                    continue
            chords = sorted(tuple(sorted((edges[i], edges[j]))) for i, j in chosen)
            piece = pieces_of(edges, chords)
            if len(set(zip(faces, piece))) < n:
                continue
            ends = {}
            for s in range(n):
                ends.setdefault(piece[s], set()).update((edges[s], edges[(s + 1) % n]))
            best.append((sum(len(e) ** 2 for e in ends.values()), chords))
        if best:
            least = min(cost for cost, _ in best)
            return [chords for cost, chords in best if cost == least]
    raise AssertionError("a curve that two chords do not split")


@lru_cache(None)
def symmetries():
    found = []
    for axis in itertools.permutations(range(3)):
        for flips in range(8):
            corner = [sum(((c >> a & 1) ^ (flips >> a & 1)) << axis[a] for a in range(3)) for c in range(8)]
            edge = [edge_between(*(corner[c] for c in edge_corners(e))) for e in range(12)]
            face = [2 * axis[f // 2] + ((f & 1) ^ (flips >> f // 2 & 1)) for f in range(6)]
            for inverted in (0, 1):
                found.append((axis, flips, inverted, corner, edge, face))
    return found


def image_of(config, g):
    signs, joined = config
    _, _, inverted, corner, _, face = g
    image = sum(((signs >> c & 1) ^ inverted) << corner[c] for c in range(8))
    return image, frozenset(face[f] for f in ambiguous_faces(signs) if (f in joined) != bool(inverted))


@lru_cache(None)
def cell_table():
    """{(signs, joined faces): [(edges of a piece, {(edge, face): ...})]}"""
    configs = []
    for signs in range(256):
        ambiguous = ambiguous_faces(signs)
        for bits in range(1 << len(ambiguous)):
            configs.append((signs, frozenset(f for k, f in enumerate(ambiguous) if bits >> k & 1)))
    groups = [symmetries(), [g for g in symmetries() if g[0] == (0, 1, 2)],
              [g for g in symmetries() if g[0] == (0, 1, 2) and g[1] == 0]]
    turned = lambda chords, g: sorted(tuple(sorted((g[4][a], g[4][b]))) for a, b in chords)
    chosen = {}
    for config in configs:
        if config in chosen:
            continue
        options = [sorted(sum(parts, [])) for parts in itertools.product(*map(splits_of, curves_of(*config)))]
        for group in groups:
            keeping = [g for g in group if image_of(config, g) == config]
            split = next((s for s in sorted(options) if all(turned(s, g) == s for g in keeping)), None)
            if split is not None:
                for g in group:
                    chosen[image_of(config, g)] = turned(split, g)
                break
    table = {}
    for config in configs:
        pieces, at = [], {}
        for edges, faces in curves_of(*config):
            first, piece, n = len(pieces), pieces_of(edges, chosen[config]), len(edges)
            pieces += [set() for _ in range(max(piece) + 1)]
            for s in range(n):
                ends = edges[s], edges[(s + 1) % n]
                pieces[first + piece[s]].update(ends)
                for e in ends:
                    at[e, faces[s]] = first + piece[s]
        table[config] = pieces, at
    return table


def build_mesh(signs, edges, offsets, ambiguous, joined, bits, closed):
    """Positions (float32), x-quads, doubled corners, x-quads of each vertex."""
    dims = signs.shape[::-1]
    s = np.pad(signs, 1).transpose(2, 1, 0)  # [x + 1, y + 1, z + 1]
    number = {tuple(e): i for i, e in enumerate(edges.tolist())}
    extended = item_order(np.pad(signs, 1), False) - [1, 1, 1, 0]
    for e in extended.tolist():
        if tuple(e) not in number:
            number[tuple(e)] = len(number)
    decisions = {tuple(f): bool(j) for f, j in zip(ambiguous.tolist(), joined)}
    mixed = np.argwhere(~uniform_cells(np.pad(signs, 1))) - 1  # z, y, x
    table, step = cell_table(), 2 << bits
    positions, corners, doubled, layer = [], {}, [], []
    for z, y, x in mixed.tolist():
        p = (x, y, z)
        pattern = sum(int(s[x + 1 + (c & 1), y + 1 + (c >> 1 & 1), z + 1 + (c >> 2)]) << c for c in range(8))
        faces = set()
        for f in ambiguous_faces(pattern):
            place = tuple(p[a] + (f & 1 if a == f // 2 else 0) for a in range(3)) + (f // 2,)
            if decisions[place]:
                faces.add(f)
        pieces, at = table[pattern, frozenset(faces)]
        first = len(positions)
        for piece in pieces:
            total = [0, 0, 0]
            for e in piece:
                low, a = edge_corners(e)[0], e // 4
                start = tuple(p[b] + (low >> b & 1) for b in range(3))
                q = number[start + (a,)]
                for b in range(3):
                    total[b] += (low >> b & 1) * step
                if q < len(offsets):
                    total[a] += 2 * int(offsets[q]) + 1
                else:
                    total[a] += 0 if pattern >> low & 1 else step
            scale = 1.0 / (float(len(piece)) * step)
            positions.append([float(p[b]) + total[b] * scale for b in range(3)])
            layer.append(any(p[b] < 0 or p[b] == dims[b] - 1 for b in range(3)))
        for e in set().union(*pieces):
            a, ou, ov, low = e // 4, e & 1, e >> 1 & 1, edge_corners(e)[0]
            q = number[tuple(p[b] + (low >> b & 1) for b in range(3)) + (a,)]
            at_u, at_v = at[e, 2 * ((a + 1) % 3) + ou], at[e, 2 * ((a + 2) % 3) + ov]
            turn, forward = (0, 1, 3, 2)[ou + 2 * ov], pattern >> low & 1
            across_v = (turn % 2 == 0) == bool(forward)
            enter, leave = (at_v, at_u) if across_v else (at_u, at_v)
            corner = turn if forward else (4 - turn) % 4
            corners[q, corner] = first + enter
            if enter != leave:
                doubled.append((q, first + leave, corner))
    quads = np.array([[corners[q, c] for c in range(4)] for q in range(len(number))], dtype=np.uint32).reshape(-1, 4)
    doubled.sort(key=lambda d: (d[0], d[2]))
    positions = np.array(positions).astype(np.float32).reshape(-1, 3)
    return (positions, quads, doubled) if closed else open_mesh(positions, quads, doubled, layer)


def polygons_of(quads, doubled):
    polygons = [[[v] for v in quad] for quad in quads.tolist()]
    for q, v, corner in doubled:
        polygons[q][corner].append(v)
    return [sum(p, []) for p in polygons]


def open_mesh(positions, quads, doubled, layer):
    polygons = polygons_of(quads, doubled)
    kept = [q for q, p in enumerate(polygons) if not any(layer[v] for v in p)]
    new_quad = {q: i for i, q in enumerate(kept)}
    around = [[] for _ in positions]
    for q in kept:
        for v in set(polygons[q]):
            around[v].append(q)
    name, order = {}, []
    for v, quads_v in enumerate(around):
        fan = list(range(len(quads_v)))
        sides = []
        for q in quads_v:
            i, n = polygons[q].index(v), len(polygons[q])
            sides.append((polygons[q][i - 1], polygons[q][(i + 1) % n]))
        for i, j in itertools.combinations(range(len(quads_v)), 2):
            if sides[i][0] == sides[j][1] or sides[i][1] == sides[j][0]:
                keep, replace = sorted((fan[i], fan[j]))
                fan = [keep if f == replace else f for f in fan]
        lows = sorted(set(fan))
        for q, f in zip(quads_v, fan):
            name[q, v] = len(order) + lows.index(f)
        order += [v] * len(lows)
    quads = np.array([[name[q, v] for v in quads[q].tolist()] for q in kept], dtype=np.uint32).reshape(-1, 4)
    doubled = [(new_quad[q], name[q, v], c) for q, v, c in doubled if q in new_quad]
    return positions[order].reshape(-1, 3), quads, doubled


# Values --------------------------------------------------------------------------------------------------------------


class Neighbours:
    def __init__(self, vertices, quads, doubled):
        self.quads = quads
        self.polygons = polygons_of(quads, doubled)
        self.around = [[] for _ in range(vertices)]
        for q, polygon in enumerate(self.polygons):
            for v in polygon:
                self.around[v].append(q)

    def known(self, v, first):
        found = []
        for q in self.around[v]:
            p = self.polygons[q]
            i = p.index(v)
            found += [w for w in (p[i - 1], p[(i + 1) % len(p)]) if first <= w < v]
        return found

    def surroundings(self, v, first):
        found = []
        for q in self.around[v]:
            p = self.polygons[q]
            i, n = p.index(v), len(p)
            found += [(p[(i + s) % n], 2 if s in (1, n - 1) else 1) for s in range(1, n)]
        return [(w, share) for w, share in found if first <= w < v]


def chunk_items(chunks, count):
    for i, chunk in enumerate(chunks):
        yield Decoder(chunk), range(65536 * i, min(65536 * (i + 1), count))


def decode_escapes(chunks, positions, mesh):
    positions = positions.copy()
    for decoder, items in chunk_items(chunks, len(positions)):
        flags, numbers, gone = [AdaptiveBit() for _ in range(8)], [SignedNumber() for _ in range(3)], set()
        for v in items:
            near = sum(w in gone for w in mesh.known(v, items[0]))
            if decoder.adaptive(flags[min(near, 7)]):
                gone.add(v)
                k = np.array([n.get(decoder) for n in numbers])
                positions[v] = (positions[v].astype(np.float64) + k / 64.0).astype(np.float32)
    return positions


def decode_floats(chunks, count, columns):
    bits = np.zeros((count, columns), dtype=np.uint32)
    for decoder, items in chunk_items(chunks, count):
        trees, before = [[Tree(8) for _ in range(5)] for _ in range(columns)], [0] * columns
        for i in items:
            for c in range(columns):
                t = trees[c]
                top = t[0].get(decoder)
                value = top << 24 | t[1 if top in (0, 255) else 2].get(decoder) << 16
                value |= t[3].get(decoder) << 8
                value |= t[4].get(decoder)
                before[c] = before[c] + value & 0xFFFFFFFF
                bits[i, c] = before[c]
    return bits.view(np.float32)


def decode_shape(chunks, mesh, count):
    values = np.zeros(count, dtype=np.uint8)
    for decoder, items in chunk_items(chunks, count):
        steps, shapes = [Tree(4) for _ in range(31)], [Tree(4) for _ in range(76)]
        for v in items:
            near = [int(values[w]) for w in mesh.known(v, items[0])]
            n, total = len(near), sum(1 + (c - 1) // 9 for c in near if c)
            step = steps[(2 * total + n // 2) // n if n else 30].get(decoder)
            if step == 0:
                continue
            kinds = [(c - 1) % 9 for c in near if c]
            m = len(kinds)
            mean = (2 * sum(kinds) + m // 2) // m if m else 18
            apart = min(3, abs(kinds[-1] - kinds[-2])) if m > 1 else 0
            values[v] = 1 + 9 * (step - 1) + shapes[4 * mean + apart].get(decoder)
    return values


def decode_light(chunks, mesh, count):
    values = np.zeros(count, dtype=np.uint8)
    for decoder, items in chunk_items([c[1:] for c in chunks], count):
        numbers, step = [SignedNumber() for _ in range(10)], chunks[items[0] // 65536][0]
        for v in items:
            near = [(int(values[w]), share) for w, share in mesh.surroundings(v, items[0])]
            n, total = sum(share for _, share in near), sum(level * share for level, share in near)
            levels = [level for level, _ in near]
            expected, apart = ((total + n // 2) // n, min(8, max(levels) - min(levels))) if n else (48, 9)
            values[v] = clamp(expected + step * numbers[apart].get(decoder), 0, 63)
    return values


def decode_enum(chunks, mesh, count):
    values = np.zeros(count, dtype=np.uint8)
    for decoder, items in chunk_items(chunks, count):
        same, other = [AdaptiveBit() for _ in range(128)], [Tree(3) for _ in range(8)]
        for v in items:
            votes = [0] * 8
            for w, share in mesh.surroundings(v, items[0]):
                votes[values[w]] += share
            best, total = votes.index(max(votes)), sum(votes)
            context = 16 * best + (min(7, total - votes[best]) if total else 8)
            values[v] = best if decoder.adaptive(same[context]) else other[best].get(decoder)
    return values


def decode_partition(chunks, mesh, count):
    values = np.zeros(count, dtype=np.uint8)
    for decoder, items in chunk_items(chunks, count):
        same, other = [AdaptiveBit() for _ in range(25)], [Tree(3) for _ in range(8)]
        for q in items:
            votes = [0] * 8
            for v in mesh.quads[q].tolist():
                before = [b for b in mesh.around[v] if items[0] <= b < q]
                if before:
                    votes[values[before[-1]]] += 1
            best = votes.index(max(votes))
            values[q] = best if decoder.adaptive(same[5 * sum(votes) + votes[best]]) else other[best].get(decoder)
    return values


# Fill patches --------------------------------------------------------------------------------------------------------


class Number:
    def __init__(self):
        self.trees = [Tree(8) for _ in range(5)]

    def get(self, decoder):
        value = 0
        for place, tree in enumerate(self.trees):
            byte = tree.get(decoder)
            value |= (byte & 127) << (7 * place)
            if byte < 128:
                break
        return value & 0xFFFFFFFF

    def signed(self, decoder):
        v = self.get(decoder)
        return (v >> 1) ^ -(v & 1)


def rim_ways(mesh, partition, of, v):
    before, behind = [], []
    for q in mesh.around[v]:
        if of[q] == partition:
            p = mesh.polygons[q]
            before.append(p[p.index(v) - 1])
            behind.append(p[(p.index(v) + 1) % len(p)])
    return [w for w in before if w not in behind]


def walk_disk(rims, choose):
    """Triangles of numbers: 0.. the rims, then vertices as they are met."""
    vertex, nxt, prev, triangles = [], [], [], []
    for size in rims + [3] * rims.count(0):
        first = len(vertex)
        vertex += range(first, first + size)
        nxt += [first + (i + 1) % size for i in range(size)]
        prev += [first + (i - 1) % size for i in range(size)]
        if first >= sum(rims) and size:
            triangles.append((first, first + 1, first + 2))
            vertex[first:] = [first + 2, first + 1, first]
    alive, queue, head, count = [True] * len(vertex), list(range(len(vertex))), 0, len(vertex)
    at = [0] * sum(rims) + [1] * (3 * rims.count(0))
    while head < len(queue):
        i, head = queue[head], head + 1
        if not alive[i]:
            continue
        j = nxt[i]
        if j == i:
            continue
        if nxt[j] == i:
            alive[i] = alive[j] = False
            continue
        step, distance, node = choose(min(at[vertex[i]], 7), min(at[vertex[j]], 7))
        if step == 1:
            k = nxt[j]
            alive[j], nxt[i], prev[k] = False, k, i
            queue.append(i)
        elif step == 2:
            k = prev[i]
            alive[i], nxt[k], prev[j] = False, j, k
            queue.append(k)
        else:
            new = len(vertex)
            if step == 3 and distance == 0 and nxt[node] == node:
                k = node
                nxt[k], prev[k], nxt[i], prev[j] = j, i, k, k
                queue += [i, k]
                triangles.append((vertex[i], vertex[j], vertex[k]))
                for v in triangles[-1]:
                    at[v] += 1
                continue
            if step == 0:
                k = new
                vertex.append(count)
                nxt.append(j)
                prev.append(i)
                nxt[i] = prev[j] = new
                at.append(0)
                count += 1
            else:
                k = node if distance == 0 else j if distance > 0 else i
                for _ in range(abs(distance)):
                    k = nxt[k] if distance > 0 else prev[k]
                vertex.append(vertex[k])
                nxt.append(j)
                prev.append(prev[k])
                nxt[prev[k]] = prev[j] = new
                nxt[i], prev[k] = k, i
            alive.append(True)
            queue += [i, new]
        triangles.append((vertex[i], vertex[j], vertex[k]))
        for v in triangles[-1]:
            at[v] += 1
    return triangles, count - sum(rims)


def relaxed_disk(rim, triangles, count):
    p = [list(r) for r in rim]
    centre = [sum(r[a] for r in rim) // len(rim) for a in range(3)]
    for a, b, c in triangles:
        if c == len(p):
            p.append([(3 * p[a][d] + 3 * p[b][d] + 2 * centre[d]) // 8 for d in range(3)])
    around = [[t[(c + 1) % 3] for t in triangles for c in range(3) if t[c] == len(rim) + i] for i in range(count)]
    for _ in range(32):
        for i, near in enumerate(around):
            for d in range(3):
                here = p[len(rim) + i][d]
                p[len(rim) + i][d] += 3 * (sum(p[w][d] for w in near) // len(near) - here) // 2
    return p[len(rim):], around


def spread_disk(rim, triangles, count):
    p = [list(r) for r in rim] + [list(rim[0]) if rim else [0, 0, 0] for _ in range(count)]
    met = len(rim)
    for a, b, c in triangles:
        if a == met:
            met += 3
        elif c == met:
            met += 1
            p[c] = [(p[a][d] + p[b][d]) // 2 for d in range(3)]
    around = [[] for _ in range(count)]
    for t in triangles:
        for c in range(3):
            if t[c] >= len(rim):
                around[t[c] - len(rim)].append(t[(c + 1) % 3])
    return p[len(rim):], around


def decode_patches(chunk, positions, mesh, of):
    decoder, counts, ids, distances, nodes, floats = Decoder(chunk), Number(), Number(), Number(), Number(), Number()
    way, steps, residuals = Tree(2), [Tree(2) for _ in range(256)], [SignedNumber() for _ in range(3)]
    start, patches = 0, []
    for _ in range(counts.get(decoder)):
        part, reverse, kind_of = counts.get(decoder), counts.get(decoder), counts.get(decoder)
        if not kind_of:
            patches.append((part, reverse, *loose_patch(decoder, counts, floats, len(positions))))
            continue
        rim, rims, last = [], [], 0
        for _ in range(kind_of):
            rims.append(counts.get(decoder))
            for i in range(rims[-1]):
                kind = way.get(decoder) if i else 3
                before = rim[-1] if i else start
                rim.append(rim_ways(mesh, part, of, before)[kind] if kind < 3 else before + ids.signed(decoder))
                if i == 0:
                    start = rim[-1]

        def choose(at_a, at_b):
            nonlocal last
            last = steps[(last * 8 + at_a) * 8 + at_b].get(decoder)
            distance = distances.signed(decoder) if last == 3 else 0
            return last, distance, nodes.get(decoder) if last == 3 and distance == 0 else 0

        triangles, count = walk_disk(rims, choose)
        fine = np.floor(positions[rim].astype(np.float64) * 1024.0 + 0.5).astype(np.int64).tolist()
        relaxed, around = (relaxed_disk if len(rims) == 1 and rim else spread_disk)(fine, triangles, count)
        extra, apart = np.zeros((count, 3), dtype=np.float32), []
        for i in range(count):
            known = [w - len(rim) for w in around[i] if w < len(rim) + i]
            sums = [sum(apart[w][d] for w in known if w >= 0) for d in range(3)]
            n = len(known)
            near = [(2 * t + n) // (2 * n) for t in sums] if n else apart[-1] if apart else [0, 0, 0]
            apart.append([t + r.get(decoder) for t, r in zip(near, residuals)])
            extra[i] = [((relaxed[i][d] + 8) // 16 + apart[i][d]) / 64.0 for d in range(3)]
        named = [[rim[v] if v < len(rim) else v - len(rim) + len(positions) for v in t] for t in triangles]
        patches.append((part, reverse, extra, named))
    return patches


def decode_patch_evidence(chunk, patches):
    """Of the vertices that the patches add, one after the other; nothing for a patch of which nothing is known."""
    decoder, present, models, values = Decoder(chunk), AdaptiveBit(), [Tree(2) for _ in range(16)], []
    for _, _, extra, _ in patches:
        before = 0
        for _ in range(len(extra) if decoder.adaptive(present) else 0):
            values.append(models[before].get(decoder))
            before = (before << 2 | values[-1]) & 15
    return np.array(values, dtype=np.uint8)


def loose_patch(decoder, counts, floats, vertices):
    extra, triangles = counts.get(decoder), counts.get(decoder)
    bits = np.array([floats.get(decoder) for _ in range(3 * extra)], dtype=np.uint32)
    kinds, places, other = Tree(2), Tree(5), Number()
    recent, following, last, ids = [0xFFFFFFFF] * 32, vertices, 0, []
    for _ in range(3 * triangles):
        kind = kinds.get(decoder)
        if kind == 0:
            v = recent[places.get(decoder)]
        elif kind == 1:
            v = following
        else:
            v = last = last + other.signed(decoder) & 0xFFFFFFFF
        following += v == following
        recent = [v] + ([r for r in recent if r != v] if v in recent else recent[:-1])
        ids.append(v)
    return bits.view(np.float32).reshape(-1, 3), np.array(ids, dtype=np.uint32).reshape(-1, 3).tolist()


def read_contact(blocks, head, signs, edges, offsets):
    """Labels of points, offsets of the contact's edges. The mesh of labels is not built here."""
    labels = decode_labels(blocks["LABL"], signs, bricks_of(signs.shape[::-1]))
    contact = contact_edges(labels)
    if len(contact) != head["contact"]["edges"]:
        raise ValueError(f"{len(contact)} edges of the contact found, {head['contact']['edges']} expected")
    of_air = {tuple(e): int(o) for e, o in zip(edges.tolist(), offsets)}
    tablet = (labels == 1).astype(np.uint8)
    active = item_order(tablet, False)
    given = [of_air.get(tuple(e), -1) for e in active.tolist()]
    found = decode_offsets(blocks["LOFS"], tablet, active, head["offset_bits"], head.get("far_sides", False), given)
    own = {tuple(e): o for e, o in zip(active.tolist(), found)}
    return labels, np.array([own[tuple(e)] for e in contact.tolist()], dtype=np.uint16)


def read(path):
    """Header, mesh and attributes of a file; raises ValueError where something is wrong."""
    blocks = read_blocks(Path(path).read_bytes())
    head = json.loads(blocks["HEAD"][0])
    dims, bits = [int(n) for n in head["dims"]], head["offset_bits"]
    signs = decode_signs(blocks, dims)
    edges, ambiguous = item_order(signs, False), item_order(signs, True)
    far_sides = head.get("far_sides", False)
    joined = decode_faces(blocks["FACE"], ambiguous, dims, far_sides)
    offsets = decode_offsets(blocks["OFFS"], signs, edges, bits, far_sides)
    if "contact" in head:
        labels, contact = read_contact(blocks, head, signs, edges, offsets)
        return {"header": head, "labels": labels, "contact": contact}
    positions, quads, doubled = build_mesh(signs, edges, offsets, ambiguous, joined, bits, head["closed"])
    mesh = Neighbours(len(positions), quads, doubled)
    if "ESCP" in blocks:
        positions = decode_escapes(blocks["ESCP"], positions, mesh)
    if "POSN" in blocks:
        positions = decode_floats(blocks["POSN"], len(positions), 3)
    result = {"header": head, "signs": signs, "offsets": offsets, "joined": joined, "positions": positions,
              "quads": quads, "doubled": doubled}
    result["position_sum"] = zlib.crc32(offsets.tobytes(), zlib.crc32(positions.tobytes()))
    result["quad_sum"] = zlib.crc32(b"".join(struct.pack("<IIB", *d) for d in doubled), zlib.crc32(quads.tobytes()))
    for name in ("position_sum", "quad_sum"):
        if result[name] != head[name]:
            raise ValueError(f"{name} {result[name]} found, {head[name]} expected")
    if (len(positions), len(quads)) != (head["vertices"], head["quads"]):
        raise ValueError("vertices or x-quads")
    for kind, name, decode, count in (("SHAP", "shape", decode_shape, len(positions)),
                                      ("AMBO", "ao", decode_light, len(positions)),
                                      ("EVID", "evidence", decode_enum, len(positions)),
                                      ("QPAR", "quad_partition", decode_partition, len(quads))):
        if kind in blocks:
            result[name] = decode(blocks[kind], mesh, count)
    if "FILL" in blocks:
        patches = decode_patches(blocks["FILL"][0], positions, mesh, result.get("quad_partition", np.zeros(len(quads))))
        result["patches"] = np.frombuffer(
            b"".join(bytes([part, reverse]) + extra.tobytes() + np.array(triangles, dtype=np.uint32).tobytes()
                     for part, reverse, extra, triangles in patches), dtype=np.uint8)
        if "FEVI" in blocks:
            result["patch_evidence"] = decode_patch_evidence(blocks["FEVI"][0], patches)
    for kind, name, columns in (("NORM", "normals", 3), ("CURV", "curvatures", 2)):
        if kind in blocks:
            result[name] = decode_floats(blocks[kind], len(positions), columns)
    return result


def main():
    for path in sys.argv[1:]:
        found = read(path)
        head = found["header"]
        print(path, head["vertices"], "vertices", head["quads"], "x-quads",
              *(f"{name} {zlib.crc32(np.ascontiguousarray(found[name]).tobytes()):08x}"
                for name in ("labels", "contact", "positions", "quads", "shape", "ao", "quad_partition", "normals",
                             "curvatures", "patches", "evidence", "patch_evidence")
                if name in found))


if __name__ == "__main__":
    main()
