"""The range coder of EXA files and its models, by docs/exa.md."""

LOGISTIC = [22, 36, 60, 98, 162, 267, 439, 720, 1179, 1921, 3108, 4971, 7812, 11955, 17625, 24743, 32768, 40793, 47911,
            53581, 57724, 60565, 62428, 63615, 64357, 64816, 65097, 65269, 65374, 65438, 65476, 65500, 65514]


def clamp(v, low, high):
    return low if v < low else high if v > high else v


class AdaptiveBit:
    __slots__ = ("p", "seen")

    def __init__(self, p=32768, seen=0):
        self.p, self.seen = p << 6, seen

    def learn(self, bit):
        change = ((1 << 22) - 1 if bit else 0) - self.p
        change *= 131072 // (2 * self.seen + 3)
        self.p += change // 65536 if change >= 0 else -(-change // 65536)
        self.seen = min(self.seen + 1, 159)


class Decoder:
    def __init__(self, data):
        self.data, self.at, self.range, self.code = data, 0, 0xFFFFFFFF, 0
        for _ in range(4):
            self.shift()

    def shift(self):
        self.code = (self.code << 8 | (self.data[self.at] if self.at < len(self.data) else 0)) & 0xFFFFFFFF
        self.at += 1

    def normalise(self):
        while self.range < 1 << 24:
            self.range = self.range << 8 & 0xFFFFFFFF
            self.shift()

    def bit(self, p):
        bound = (self.range >> 16) * p
        one = self.code < bound
        if one:
            self.range = bound
        else:
            self.code -= bound
            self.range -= bound
        self.normalise()
        return int(one)

    def adaptive(self, model):
        bit = self.bit(clamp(model.p >> 6, 8, 65528))
        model.learn(bit)
        return bit

    def place(self):
        self.range >>= 16
        return min(self.code // self.range, 65535)

    def take(self, start, size):
        self.code -= self.range * start
        self.range *= size
        self.normalise()

    def raw(self, count):
        if count == 0:
            return 0
        v = self.place() >> (16 - count)
        self.take(v << (16 - count), 1 << (16 - count))
        return v


class Tree:
    def __init__(self, bits):
        self.bits, self.models = bits, {}

    def get(self, decoder):
        node = 1
        for _ in range(self.bits):
            node = node << 1 | decoder.adaptive(self.models.setdefault(node, AdaptiveBit()))
        return node - (1 << self.bits)


class SignedNumber:
    def __init__(self):
        self.length, self.sign, self.second = Tree(4), AdaptiveBit(), [AdaptiveBit() for _ in range(16)]

    def get(self, decoder):
        length = self.length.get(decoder)
        if length == 0:
            return 0
        negative = decoder.adaptive(self.sign)
        value = 1
        if length > 1:
            value = 2 | decoder.adaptive(self.second[length])
            value = value << (length - 2) | decoder.raw(length - 2)
        return -value if negative else value


def curve_at(curve, z):
    i, f = (z + 2048) >> 7, (z + 2048) & 127
    return (curve[i] * (128 - f) + curve[i + 1] * f) >> 7


class Refiner:
    def __init__(self):
        self.curve = list(LOGISTIC)

    def predict(self, z):
        self.j = ((z + 2048) >> 7) + (((z + 2048) & 127) >= 64)
        return (curve_at(self.curve, z) + curve_at(LOGISTIC, z)) >> 1

    def learn(self, bit):
        self.curve[self.j] += ((65520 if bit else 16) - self.curve[self.j]) >> 6
