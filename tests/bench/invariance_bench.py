#!/usr/bin/env python3
"""The same object written down otherwise: how far the answers lie apart.

invariance_bench.py PROGRAM FOLDER [--size 256x160x240] [--seeds 2] [--contact film --film .3 ...] [--wanted .01]

Phantoms of each seed are processed as they are, with margins cropped by 1 to 11 voxels, mirrored along each axis and with axes
exchanged (--axis-order: what is read is another volume of the same object). Printed: mean, standard deviation and largest deviation
from the run as it is, for the volume of the tablet, its area, and the shares of film and of what is inferred of the contact. Further
options go to `dubsar phantom`. Ends with 1 where a volume or area is more than --wanted off.
"""
import argparse, json, os, statistics, subprocess, sys


def answer(program, scan, out, options):
    done = subprocess.run([program, "process", scan, "-o", out, "--no-ao", "--quiet", "--json", "-", *options],
                          capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(options)}: {done.stderr.strip()[-300:]}")
    report = json.loads(done.stdout)
    tablet = [part for part in report["partitions"] if part["name"] == "tablet"]
    contact = report["contact"] or {}
    film, inferred = contact.get("film_vertices", 0), contact.get("inferred_vertices", 0)
    return {"tablet mm3": sum(part["volume_mm3"] for part in tablet), "tablet mm2": sum(part["area_mm2"] for part in tablet),
            "film": film / max(1, film + inferred), "two clays": float(contact.get("clays_differ", False))}


def variants(size):
    x, y, z = size
    crops = [(0, 1, 0), (0, 2, 1), (1, 5, 0), (2, 8, 2), (0, 11, 1)]
    yield "as it is", []
    for a, b, c in crops:
        yield f"crop {a},{b},{c}", ["--crop", f"{a}:,{b}:{y - b},{c}:"]
    for order in ("zy-x", "z-yx", "-zyx", "xyz", "yzx"):
        yield f"axes {order}", ["--axis-order", order]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program"), parser.add_argument("folder")
    parser.add_argument("--size", default="256x160x240"), parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--first-seed", type=int, default=31), parser.add_argument("--wanted", type=float, default=0.01)
    options, phantom = parser.parse_known_args()
    os.makedirs(options.folder, exist_ok=True)
    size = [int(n) for n in options.size.split("x")]
    worst = 0.0
    for seed in range(options.first_seed, options.first_seed + options.seeds):
        scan, out = os.path.join(options.folder, "scan.h5"), os.path.join(options.folder, "scan.exa")
        subprocess.run([options.program, "phantom", scan, "--size", options.size, "--seed", str(seed), "--quiet", *phantom], check=True,
                       stdout=subprocess.DEVNULL)
        found = [(name, answer(options.program, scan, out, words)) for name, words in variants(size)]
        print(f"seed {seed}, {options.size} {' '.join(phantom)}: {len(found)} ways to write it")
        for key, first in found[0][1].items():
            values = [result[key] for _, result in found]
            unit = abs(first) if key.startswith("tablet") and first else 1.0
            off, name = max((abs(result[key] - first) / unit, name) for name, result in found)
            if key.startswith("tablet"):
                worst = max(worst, off)
            print(f"  {key:<12}{statistics.mean(values):12.4g} +- {statistics.pstdev(values):<10.3g} at most {100 * off:.2f} % off ({name})")
    return 1 if worst > options.wanted else 0


if __name__ == "__main__":
    sys.exit(main())
