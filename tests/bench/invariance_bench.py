#!/usr/bin/python3
"""The same object written down otherwise: how far the answers lie apart.

invariance_bench.py PROGRAM FOLDER [--size 256x160x240] [--seeds 5] [--detail scan] [--wanted .01] [--contact film --film .35 ...]

The volume of each seed's phantom is processed as it is, then rolled by 1 to 24 voxels (what leaves at one side comes in at the other:
air), with its margins cropped, mirrored, with axes exchanged, turned by a quarter, with other grey values and in chunks. Printed for
each kind, over all seeds: mean and greatest difference from the scan as it is, in percent: of the tablet's volume and area, of what is
film in its contact, and of what is film, inferred and measured of its area. `sides`: the greatest difference of the areas of its six
sides, of its area (no mirror images: their writing is mirrored, too). `way up`: probability, mean and least. Greys upside down are told
to be so. Further options go to `dubsar phantom`. Ends with 1 where volume, area or an area of evidence is more than --wanted off.
Needs python3-h5py and python3-numpy.
"""
import argparse, json, os, statistics, subprocess, sys

import h5py
import numpy as np

DATASET = "entry/data/data"


def rolled(x, y, z):
    return lambda v: np.roll(v, (z, y, x), (0, 1, 2))


def cropped(x, y, z):
    return lambda v: v[z[0]:v.shape[0] - z[1], y[0]:v.shape[1] - y[1], x[0]:v.shape[2] - x[1]]


def scaled(span, to, offset):
    return lambda v: (np.float32(to / span) * v + np.float32(offset)).astype(np.float32)


def ways(volume):
    """Kind, name, the volume written so, its chunks. Arrays are z, y, x."""
    span = float(np.percentile(volume, 99) - np.percentile(volume, 1))
    same = lambda v: v
    for shift in ((1, 0, 0), (0, 3, 0), (2, 2, 2), (8, -8, 8), (-13, 24, -9), (19, -17, 10)):
        yield "shift", "shift {} {} {}".format(*shift), rolled(*shift), None
    for crop in (((2, 2), (2, 2), (2, 2)), ((5, 0), (0, 7), (3, 1)), ((8, 8), (8, 8), (8, 8))):
        yield "crop", "crop " + " ".join(f"{a}+{b}" for a, b in crop), cropped(*crop), None
    yield "mirror", "mirror x", lambda v: v[:, :, ::-1], None
    yield "mirror", "mirror y", lambda v: v[:, ::-1], None
    yield "mirror", "mirror z", lambda v: v[::-1], None
    yield "mirror", "mirror xyz", lambda v: v[::-1, ::-1, ::-1], None
    yield "axes", "axes zxy", lambda v: v.transpose(2, 0, 1), None
    yield "axes", "axes yzx", lambda v: v.transpose(1, 2, 0), None
    yield "turn", "quarter turn about z", lambda v: v.transpose(0, 2, 1)[:, :, ::-1], None
    yield "turn", "quarter turn about x", lambda v: v.transpose(1, 0, 2)[:, ::-1], None
    yield "grey", "16-bit like", scaled(span, 8000.0, 1000.0), None
    yield "grey", "attenuation like", scaled(span, 0.02, -0.3), None
    yield "chunks", "chunks 32x40x64", same, (32, 40, 64)


def write(path, volume, chunks):
    with h5py.File(path, "w") as file:
        file.create_dataset(DATASET, data=np.ascontiguousarray(volume), chunks=chunks)


def run(program, arguments):
    done = subprocess.run([program, *arguments], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(arguments)}: {done.stderr.strip()[-300:]}")
    return json.loads(done.stdout)


def answer(program, scan, out, detail):
    if os.path.exists(out):
        os.remove(out)
    report = run(program, ["process", scan, "-o", out, "--no-ao", "--voxel-size", "1mm", "--detail", detail, "--quiet", "--json", "-"])
    facts = run(program, ["info", out, "--json", "-"])["facts"]
    tablet = [part for part in facts["parts"] if part["name"].startswith("tablet")]
    if not tablet:
        return None, report["warnings"]
    area, of = tablet[0]["area"], tablet[0]["evidence"]
    film, inferred = of.get("film", 0.0), of.get("inferred", 0.0)
    return {"volume": tablet[0]["volume"], "area": area, "film of contact": film / max(film + inferred, 1e-9), "film": film / area,
            "inferred": inferred / area, "measured": of.get("measured", 0.0) / area, "way up": facts["up_probability"],
            "mirrored": facts["mirrored_probability"],
            "sides": [sum(side.values()) / area for _, side in sorted(tablet[0]["sides"].items())]}, report["warnings"]


def differences(found, first):
    off = {key: 100.0 * abs(found[key] / first[key] - 1.0) for key in ("volume", "area")}
    off |= {key: 100.0 * abs(found[key] - first[key]) for key in ("film of contact", "film", "inferred", "measured")}
    off["sides"] = 100.0 * max(abs(a - b) for a, b in zip(found["sides"], first["sides"]))
    return off


COLUMNS = ("volume", "area", "film of contact", "film", "inferred", "measured", "sides")
CHECKED = ("volume", "area", "film", "inferred", "measured")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program"), parser.add_argument("folder")
    parser.add_argument("--size", default="256x160x240"), parser.add_argument("--seeds", type=int, default=5)
    parser.add_argument("--first-seed", type=int, default=7231), parser.add_argument("--wanted", type=float, default=0.01)
    parser.add_argument("--detail", default="scan", choices=["scan", "half"])
    options, phantom = parser.parse_known_args()
    phantom = phantom or ["--contact", "film", "--film", "0.35"]
    os.makedirs(options.folder, exist_ok=True)
    scan, out = os.path.join(options.folder, "scan.h5"), os.path.join(options.folder, "scan.exa")
    rows, ups = {}, {}
    for seed in range(options.first_seed, options.first_seed + options.seeds):
        if os.path.exists(scan):  # one that was written here from a phantom's, which phantom does not replace
            os.remove(scan)
        subprocess.run([options.program, "phantom", scan, "--size", options.size, "--seed", str(seed), "--quiet", *phantom], check=True,
                       stdout=subprocess.DEVNULL)
        with h5py.File(scan) as file:
            volume = file[DATASET][...]
        write(scan, volume, None)
        first, _ = answer(options.program, scan, out, options.detail)
        if first is None:
            sys.exit(f"seed {seed}: no tablet was found")
        print(f"seed {seed}: film {100 * first['film of contact']:.2f} % of the contact, of the tablet's area {100 * first['film']:.2f} % "
              f"film, {100 * first['inferred']:.2f} % inferred, way up {first['way up']:.3f}", flush=True)
        for kind, name, change, chunks in ways(volume):
            write(scan, change(volume), chunks)
            found, _ = answer(options.program, scan, out, options.detail)
            if found is None:
                sys.exit(f"seed {seed}, {name}: no tablet was found")
            off = differences(found, first)
            print(f"  {name:<23}" + " ".join(f"{key} {off[key]:.3f}" for key in COLUMNS if kind != "mirror" or key != "sides"), flush=True)
            rows.setdefault(kind, []).append(off)
            if kind != "mirror":
                ups.setdefault(kind, []).append(found["way up"])
        write(scan, scaled(-1.0, 1.0, float(volume.max()))(volume), None)
        _, warnings = answer(options.program, scan, out, options.detail)
        told = any("brighter than clay" in warning for warning in warnings)
        print(f"  greys upside down: {'told' if told else 'NOT TOLD'}", flush=True)
    print(f"\n{options.size}, detail {options.detail}, {options.seeds} seeds from {options.first_seed}, {' '.join(phantom)}; "
          "percent, mean and greatest difference")
    print(f"{'':<8}" + "".join(f"{key:>18}" for key in COLUMNS) + f"{'way up':>16}")
    worst = 0.0
    for kind, all_of in rows.items():
        line = f"{kind:<8}"
        for key in COLUMNS:
            values = [off[key] for off in all_of]
            if kind == "mirror" and key == "sides":
                line += f"{'-':>18}"
                continue
            line += f"{statistics.mean(values):>11.3f} {max(values):>6.3f}"
            worst = max(worst, max(values)) if key in CHECKED else worst
        print(line + (f"{statistics.mean(ups[kind]):>9.3f} {min(ups[kind]):>6.3f}" if kind in ups else f"{'-':>16}"))
    return 1 if worst > 100.0 * options.wanted else 0


if __name__ == "__main__":
    sys.exit(main())
