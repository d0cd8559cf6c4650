"""What Python's own zipfile and XML parser say about a 3MF file, one fact a line."""
import sys
import xml.etree.ElementTree as ElementTree
import zipfile

CORE = "{http://schemas.microsoft.com/3dmanufacturing/core/2015/02}"
MATERIAL = "{http://schemas.microsoft.com/3dmanufacturing/material/2015/02}"

archive = zipfile.ZipFile(sys.argv[1])
assert archive.testzip() is None, "a sum is wrong"
relations = ElementTree.fromstring(archive.read("_rels/.rels"))
target = relations[0].attrib["Target"].lstrip("/")
types = ElementTree.fromstring(archive.read("[Content_Types].xml"))
assert {t.attrib["Extension"] for t in types} == {"rels", "model"}
model = ElementTree.fromstring(archive.read(target))
print("unit", model.attrib["unit"])
colours = [c.attrib["color"] for c in model.iter(MATERIAL + "color")]
assert len(colours) == len(set(colours))
shifts = {i.attrib["objectid"]: [float(n) for n in i.attrib["transform"].split()[9:]] for i in model.iter(CORE + "item")}
for thing in model.iter(CORE + "object"):
    points = [tuple(float(v.attrib[a]) for a in "xyz") for v in thing.iter(CORE + "vertex")]
    triangles = list(thing.iter(CORE + "triangle"))
    edges = {}
    for t in triangles:
        corners = [int(t.attrib[k]) for k in ("v1", "v2", "v3")]
        assert all(0 <= c < len(points) for c in corners) and len(set(corners)) == 3
        assert all(0 <= int(t.attrib[k]) < len(colours) for k in ("p1", "p2", "p3"))
        for a, b in zip(corners, corners[1:] + corners[:1]):
            edges[(a, b)] = edges.get((a, b), 0) + 1
    closed = all(n == 1 and edges.get((b, a)) == 1 for (a, b), n in edges.items())
    shift = shifts[thing.attrib["id"]]
    low = [min(p[a] for p in points) + shift[a] for a in range(3)]
    high = [max(p[a] for p in points) + shift[a] for a in range(3)]
    assert min(low) > -1e-6, "below the bed"
    size = " ".join("%.3f" % (h - l) for h, l in zip(high, low))
    print("object", thing.attrib["name"], len(points), len(triangles), "closed" if closed else "open", size,
          colours[int(triangles[0].attrib["p1"])])
