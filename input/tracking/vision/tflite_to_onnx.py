#!/usr/bin/env python3
"""Writes a network of palms, hands or faces that is kept as TensorFlow Lite as ONNX, which OpenCV reads.

usage: tflite_to_onnx.py IN.tflite OUT.onnx

Python's own library is enough. Read: schema version 3, weights of 32 or 16 bits, the operations of CONVERTERS, one input that is a picture. Pictures are
rows x columns x channels in the file and channels x rows x columns in ONNX. Written: opset 11; outputs are named output_00, output_01 ... in the order
of the file. What is not known ends with one sentence and exit code 65.
Sources: tensorflow/lite/schema/schema.fbs, onnx/onnx.proto.
"""
import struct
import sys


def refuse(what):
    print(f"tflite_to_onnx: {what}", file=sys.stderr)
    sys.exit(65)


# ---- flat buffers


class Table:
    def __init__(self, data, at):
        self.data, self.at = data, at
        self.slots = at - struct.unpack_from("<i", data, at)[0]

    def _field(self, i):
        size = struct.unpack_from("<H", self.data, self.slots)[0]
        offset = struct.unpack_from("<H", self.data, self.slots + 4 + 2 * i)[0] if 4 + 2 * i < size else 0
        return self.at + offset if offset else None

    def value(self, i, form, default=0):
        at = self._field(i)
        return default if at is None else struct.unpack_from("<" + form, self.data, at)[0]

    def _target(self, at):
        return at + struct.unpack_from("<I", self.data, at)[0]

    def table(self, i):
        at = self._field(i)
        return None if at is None else Table(self.data, self._target(at))

    def _vector(self, i):
        at = self._field(i)
        if at is None:
            return 0, 0
        at = self._target(at)
        return at + 4, struct.unpack_from("<I", self.data, at)[0]

    def tables(self, i):
        at, count = self._vector(i)
        return [Table(self.data, self._target(at + 4 * k)) for k in range(count)]

    def integers(self, i):
        at, count = self._vector(i)
        return list(struct.unpack_from(f"<{count}i", self.data, at)) if count else []

    def bytes(self, i):
        at, count = self._vector(i)
        return self.data[at : at + count]


# ---- protocol buffers


def varint(n):
    n &= (1 << 64) - 1
    out = bytearray()
    while n > 127:
        out.append(n & 127 | 128)
        n >>= 7
    out.append(n)
    return bytes(out)


def number(field, n):
    return varint(field << 3) + varint(n)


def message(field, content):
    content = content.encode() if isinstance(content, str) else content
    return varint(field << 3 | 2) + varint(len(content)) + content


def tensor(name, shape, values, form):
    """TensorProto: floats ("f") or 64-bit integers ("q")."""
    head = b"".join(number(1, n) for n in shape) + number(2, 1 if form == "f" else 7)
    return head + message(8, name) + message(9, struct.pack(f"<{len(values)}{form}", *values))


def attribute(name, value):
    if isinstance(value, str):
        return message(1, name) + message(4, value) + number(20, 3)
    if isinstance(value, float):
        return message(1, name) + varint(2 << 3 | 5) + struct.pack("<f", value) + number(20, 1)
    if isinstance(value, list):
        return message(1, name) + b"".join(number(8, n) for n in value) + number(20, 7)
    return message(1, name) + number(3, value) + number(20, 2)


def value_info(name, shape):
    dims = b"".join(message(1, number(1, n)) for n in shape)
    return message(1, name) + message(2, message(1, number(1, 1) + message(2, dims)))


# ---- the network


class Converter:
    def __init__(self, data):
        model = Table(data, struct.unpack_from("<I", data, 0)[0])
        if model.value(0, "I") != 3:
            refuse("not a TensorFlow Lite model of version 3")
        graph = model.tables(2)[0]
        buffers = model.tables(4)
        self.shapes, self.constants = [], {}
        for i, t in enumerate(graph.tables(0)):
            self.shapes.append(t.integers(0))
            raw = buffers[t.value(2, "I")].bytes(0)
            if raw:
                form = {0: "f", 1: "e", 2: "i"}.get(t.value(1, "b"))
                if form is None:
                    refuse(f"tensor {i} has numbers of type {t.value(1, 'b')}, expected 32- or 16-bit floats or 32-bit integers")
                self.constants[i] = struct.unpack(f"<{len(raw) // struct.calcsize(form)}{form}", raw)
        self.nodes, self.initializers, self.made = [], [], 0
        self.inputs, self.outputs = graph.integers(1), graph.integers(2)
        codes = [max(c.value(0, "b"), c.value(3, "i")) for c in model.tables(1)]
        self.names = {}
        for k, o in enumerate(self.outputs):
            self.names[o] = f"output_{k:02d}"
        for i, op in enumerate(graph.tables(3)):
            code = codes[op.value(0, "I")]
            if code not in CONVERTERS:
                refuse(f"operation {i} has code {code}, which is not one of the known ones")
            CONVERTERS[code](self, op.integers(1), op.integers(2)[0], op.table(4))

    def name(self, t):
        return self.names.setdefault(t, f"t{t}")

    def constant(self, shape, values, form="f"):
        self.made += 1
        self.initializers.append(tensor(f"c{self.made}", shape, values, form))
        return f"c{self.made}"

    def between(self):
        self.made += 1
        return f"n{self.made}"

    def node(self, kind, inputs, output, **attributes):
        """A node by the name of its output."""
        out = b"".join(message(1, i) for i in inputs) + message(2, output) + message(3, output) + message(4, kind)
        self.nodes.append(out + b"".join(message(5, attribute(k, v)) for k, v in attributes.items()))
        return output

    def activated(self, activation, kind, inputs, output, **attributes):
        if activation == 0:
            return self.node(kind, inputs, output, **attributes)
        if activation not in (1, 3):
            refuse(f"activation {activation} found, expected none, relu or relu6")
        raw = self.node(kind, inputs, self.between(), **attributes)
        if activation == 3:  # limits as attributes, as until opset 10: OpenCV 4.6 knows no others
            return self.node("Clip", [raw], output, min=0.0, max=6.0)
        return self.node("Relu", [raw], output)

    def padded(self, source, begin, end):
        """Zeros around a picture: of channels, rows, columns."""
        pads = self.constant([8], [0, *begin, 0, *end], "q")
        return self.node("Pad", [source, pads], self.between(), mode="constant")

    def window(self, source, picture, same, filters, strides):
        """Padding for a window that goes over a picture: the node that it reads, and the pads at its sides."""
        before, after = [0, 0], [0, 0]
        for a in (0, 1) if same else ():
            size = self.shapes[picture][1 + a]
            both = max(0, ((size + strides[a] - 1) // strides[a] - 1) * strides[a] + filters[a] - size)
            before[a], after[a] = both // 2, both - both // 2
        if before == after:
            return source, before + after
        return self.padded(source, [0, *before], [0, *after]), [0, 0, 0, 0]

    def in_order_of_file(self, t):
        if len(self.shapes[t]) != 4:
            return self.name(t)
        return self.node("Transpose", [self.name(t)], self.between(), perm=[0, 2, 3, 1])

    # One operation each: numbers of its inputs, of its output, its options.

    def conv(self, inputs, output, options, depthwise=False):
        picture, filters, bias = inputs
        shift = 1 if depthwise else 0
        if max(options.value(4 + shift, "i", 1), options.value(5 + shift, "i", 1)) != 1:
            refuse("dilated filters are not known")
        strides = [options.value(2, "i"), options.value(1, "i")]
        values = self.constants[filters]
        o, h, w, i = self.shapes[filters]
        if depthwise:
            o, i = i, 1
            ordered = [values[(y * w + x) * o + c] for c in range(o) for y in range(h) for x in range(w)]
        else:
            ordered = [values[((c * h + y) * w + x) * i + k] for c in range(o) for k in range(i) for y in range(h) for x in range(w)]
        source, pads = self.window(self.name(picture), picture, options.value(0, "b") == 0, [h, w], strides)
        group = self.shapes[picture][3] if depthwise else 1
        parts = [source, self.constant([o, i, h, w], ordered), self.constant([o], self.constants[bias])]
        activation = options.value(3 + shift, "b")
        self.activated(activation, "Conv", parts, self.name(output), kernel_shape=[h, w], strides=strides, pads=pads, group=group, dilations=[1, 1])

    def depthwise(self, inputs, output, options):
        self.conv(inputs, output, options, True)

    def max_pool(self, inputs, output, options):
        strides = [options.value(2, "i"), options.value(1, "i")]
        size = [options.value(4, "i"), options.value(3, "i")]
        source, pads = self.window(self.name(inputs[0]), inputs[0], options.value(0, "b") == 0, size, strides)
        self.activated(options.value(5, "b"), "MaxPool", [source], self.name(output), kernel_shape=size, strides=strides, pads=pads)

    def add(self, inputs, output, options):
        self.activated(options.value(0, "b"), "Add", [self.name(i) for i in inputs], self.name(output))

    def concat(self, inputs, output, options):
        rank = len(self.shapes[output])
        axis = options.value(0, "i") % rank
        axis = {1: 2, 2: 3, 3: 1}.get(axis, 0) if rank == 4 else axis
        self.activated(options.value(1, "b"), "Concat", [self.name(i) for i in inputs], self.name(output), axis=axis)

    def prelu(self, inputs, output, options):
        slopes = self.constants[inputs[1]]
        self.node("PRelu", [self.name(inputs[0]), self.constant([len(slopes), 1, 1], slopes)], self.name(output))

    def relu(self, inputs, output, options):
        self.node("Relu", [self.name(inputs[0])], self.name(output))

    def pad(self, inputs, output, options):
        p = self.constants[inputs[1]]
        self.names[output] = self.padded(self.name(inputs[0]), [p[6], p[2], p[4]], [p[7], p[3], p[5]])

    def resize(self, inputs, output, options):
        mode = "align_corners" if options.value(2, "B") else "half_pixel" if options.value(3, "B") else "asymmetric"
        _, h, w, c = self.shapes[output]
        none = self.constant([0], [])
        size = self.constant([4], [1, c, h, w], "q")
        self.node("Resize", [self.name(inputs[0]), none, none, size], self.name(output), mode="linear", coordinate_transformation_mode=mode)

    def reshape(self, inputs, output, options):
        shape = self.shapes[output]
        self.node("Reshape", [self.in_order_of_file(inputs[0]), self.constant([len(shape)], shape, "q")], self.name(output))

    def mean(self, inputs, output, options):
        if sorted(self.constants[inputs[1]]) != [1, 2]:
            refuse("a mean over rows and columns expected")
        mean = self.node("GlobalAveragePool", [self.name(inputs[0])], self.between())
        shape = self.shapes[output]
        shape = [shape[0], shape[3], 1, 1] if len(shape) == 4 else shape
        self.node("Reshape", [mean, self.constant([len(shape)], shape, "q")], self.name(output))

    def fully_connected(self, inputs, output, options):
        row = self.node("Flatten", [self.name(inputs[0])], self.between(), axis=1)
        weights = self.constant(self.shapes[inputs[1]], self.constants[inputs[1]])
        bias = self.constant(self.shapes[inputs[2]], self.constants[inputs[2]])
        self.activated(options.value(0, "b"), "Gemm", [row, weights, bias], self.name(output), transB=1)

    def logistic(self, inputs, output, options):
        self.node("Sigmoid", [self.name(inputs[0])], self.name(output))

    def widen(self, inputs, output, options):
        self.constants[output] = self.constants[inputs[0]]

    def write(self):
        def picture(shape):
            return [shape[0], shape[3], shape[1], shape[2]] if len(shape) == 4 else shape

        graph = b"".join(message(1, n) for n in self.nodes) + message(2, "network") + b"".join(message(5, i) for i in self.initializers)
        graph += b"".join(message(11, value_info(self.name(t), picture(self.shapes[t]))) for t in self.inputs)
        graph += b"".join(message(12, value_info(self.name(t), picture(self.shapes[t]))) for t in self.outputs)
        return number(1, 6) + message(2, "dubsar") + message(7, graph) + message(8, message(1, "") + number(2, 11))


CONVERTERS = {
    0: Converter.add,
    2: Converter.concat,
    3: Converter.conv,
    4: Converter.depthwise,
    6: Converter.widen,
    9: Converter.fully_connected,
    14: Converter.logistic,
    17: Converter.max_pool,
    19: Converter.relu,
    22: Converter.reshape,
    23: Converter.resize,
    34: Converter.pad,
    40: Converter.mean,
    54: Converter.prelu,
}


def main():
    if len(sys.argv) != 3:
        print("usage: tflite_to_onnx.py IN.tflite OUT.onnx", file=sys.stderr)
        sys.exit(64)
    with open(sys.argv[1], "rb") as file:
        data = file.read()
    try:
        written = Converter(data).write()
    except (struct.error, IndexError, KeyError, ValueError) as fault:
        refuse(f"{sys.argv[1]}: damaged or not of the known kind ({fault})")
    with open(sys.argv[2], "wb") as file:
        file.write(written)


if __name__ == "__main__":
    main()
