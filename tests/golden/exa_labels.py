"""Labels of files of tablets in envelopes, by docs/exa.md: the plane LABL. Needs numpy."""

import itertools

import numpy as np
from exa_coding import LOGISTIC, AdaptiveBit, Decoder, clamp, curve_at


def logit(p):
    """The least z in -2047..2047 whose logistic is not below 16 (p >> 4) + 8."""
    low, high = -2047, 2047
    while low < high:
        middle = (low + high) // 2
        low, high = (low, middle) if curve_at(LOGISTIC, middle) >= 16 * (p >> 4) + 8 else (middle + 1, high)
    return low


class Mixer:
    def __init__(self):
        self.weights = {}

    def get(self, decoder, chosen, models):
        w = self.weights.setdefault(chosen, [26214] * 6)
        z = [logit(clamp(model.p >> 6, 8, 65528)) for model in models]
        p = clamp(curve_at(LOGISTIC, clamp(sum(a * b for a, b in zip(w, z)) >> 16, -2047, 2047)), 32, 65504)
        bit = decoder.bit(p)
        error = 7 * (((65535 if bit else 0) - p) >> 4)
        for i in range(6):
            w[i] += (z[i] * error + 32768) >> 16
        for model in models:
            model.learn(bit)
        return bit


NEAR = [(-1, 0, 0), (0, -1, 0), (0, 0, -1), (-1, -1, 0), (1, -1, 0), (-1, 0, -1), (1, 0, -1), (0, -1, -1), (0, 1, -1)]
FAR = [(-1, 0, 0), (-2, 0, 0), (0, -1, 0), (0, -2, 0), (0, 0, -1), (0, 0, -2), (-1, -1, -1), (1, 1, -1), (2, 0, -1)]
LINES = [(-1, 0, 0), (-2, 0, 0), (-3, 0, 0), (0, -1, 0), (0, -2, 0), (0, -3, 0), (0, 0, -1), (0, 0, -2), (0, 0, -3)]
BEHIND = [(-1, 0, 0), (0, -1, 0), (0, 0, -1)]
BESIDE = BEHIND + [(1, 0, 0), (0, 1, 0), (0, 0, 1)]
AROUND = [d for d in itertools.product((-1, 0, 1), repeat=3) if d != (0, 0, 0)] + [(-2, 0, 0), (0, -2, 0), (0, 0, -2)]
AIRS = [(1, 0, 0), (0, 1, 0), (0, 0, 1), (-1, 0, 0), (0, -1, 0), (0, 0, -1), (2, 0, 0), (0, 2, 0), (0, 0, 2)]


def decode_brick(chunk, clay):
    """Labels of the points [x, y, z] of a brick whose clay is given."""
    decoder, mixed, whose, mixer, models = Decoder(chunk), {}, {}, Mixer(), [{} for _ in range(6)]
    count = [(n + 3) // 4 for n in clay.shape]
    kind, labels = np.zeros([n + 1 for n in count], dtype=np.int64), np.zeros(clay.shape, dtype=np.int64)
    tile = lambda x, y, z: tuple(slice(4 * c, 4 * c + 4) for c in (x, y, z))
    for z, y, x in itertools.product(*(range(n) for n in reversed(count))):
        if not clay[tile(x, y, z)].any():
            continue
        context = int(16 * kind[x - 1, y, z] + 4 * kind[x, y - 1, z] + kind[x, y, z - 1])  # the last of each is 0
        if decoder.adaptive(mixed.setdefault(context, AdaptiveBit())):
            kind[x, y, z] = 3
            continue
        kind[x, y, z] = 1 + decoder.adaptive(whose.setdefault(context, AdaptiveBit()))
        labels[tile(x, y, z)] = kind[x, y, z] * clay[tile(x, y, z)]
    state = np.zeros([n + 6 for n in clay.shape], dtype=np.int64)
    state[3:-3, 3:-3, 3:-3] = np.where(clay, labels, 3)
    for z, y, x in itertools.product(*(range(n) for n in reversed(clay.shape))):
        if not clay[x, y, z] or kind[x // 4, y // 4, z // 4] != 3:
            continue
        at = lambda d: int(state[x + 3 + d[0], y + 3 + d[1], z + 3 + d[2]])
        code = lambda places: sum(at(d) % 3 * 3 ** k for k, d in enumerate(reversed(places)))
        around = [at(d) % 3 for d in AROUND]
        behind, both = code(BEHIND), sum(t > 0 for t in around)
        contexts = [sum(at(d) << 2 * k for k, d in enumerate(BESIDE)), code(NEAR), code(FAR), code(LINES),
                    8 * (around.count(2) - around.count(1) + 32) + min(7, both // 4),
                    512 * behind + sum((at(d) == 3) << k for k, d in enumerate(AIRS))]
        bit = mixer.get(decoder, behind, [m.setdefault(c, AdaptiveBit()) for m, c in zip(models, contexts)])
        state[x + 3, y + 3, z + 3] = labels[x, y, z] = 1 + bit
    return labels


def decode_labels(chunks, signs, bricks):
    """0 air, 1 tablet, 2 envelope of each point [z, y, x]."""
    clay = signs.transpose(2, 1, 0).astype(bool)
    labels = clay.astype(np.uint8)
    for chunk, brick in zip(chunks, bricks):
        if not chunk:
            continue
        box = tuple(slice(low, n if n - low <= 129 else low + 128) for (low, _), n in zip(brick, clay.shape))
        labels[box] = decode_brick(chunk, clay[box])
    return labels.transpose(2, 1, 0)


def contact_edges(labels):
    """Grid edges between clay of both, as (x, y, z, axis), in order."""
    found = []
    for axis in range(3):
        cut = [slice(None)] * 3
        cut[2 - axis] = slice(0, -1)
        low = labels[tuple(cut)]
        cut[2 - axis] = slice(1, None)
        high = labels[tuple(cut)]
        p = np.argwhere((low > 0) & (high > 0) & (low != high))
        found.append(np.c_[p[:, ::-1], np.full(len(p), axis)])
    edges = np.concatenate(found)
    return edges[np.lexsort((edges[:, 0], edges[:, 3], edges[:, 1], edges[:, 2]))]
