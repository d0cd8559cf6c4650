#!/usr/bin/env python3
"""Every stage on one core beside the peers that are installed and beside the floor of the machine.

stage_bench.py OURS [--itk PROGRAM] [--size 512] [--runs 3] [--no-meshlab] [--work FOLDER] [--json FILE] [--history FILE]

OURS is the program stage_bench, which makes the volume and the mesh that all of them get. Seconds are those of a core
(user and system time), the least of some runs, so that they can be compared on a busy machine, too. A ratio is how many
times as long a peer takes; the floor is what memory or arithmetic alone would take, whichever is more, at the rates that
this machine has in the same run. A peer that is not installed is named as such."""
import argparse, json, os, resource, shutil, subprocess, sys

import figures

HERE = os.path.dirname(os.path.abspath(__file__))
PEERS = ["VTK", "ITK", "Embree", "MeshLab"]
# What of a peer stands beside a stage of ours, where it is not the same.
NOTES = {("denoise", "ITK"): "bilateral over 3x3x3, not joint", ("smooth", "MeshLab"): "TwoStep 32 + 8, less loading and saving",
         ("extract", "VTK"): "FlyingEdges, no normals", ("curvature", "VTK"): "least and largest, a filter each",
         ("light", "Embree"): "the same rays, exact"}


def run(command):
    """Text, and seconds of a core; None and why not where it cannot be run."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    try:
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    except OSError as error:
        return None, str(error)
    if done.returncode != 0:
        return None, (done.stderr.strip().splitlines() or [f"exit code {done.returncode}"])[-1]
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return done.stdout, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def vtk(options):
    text, why = run(["/usr/bin/python3", os.path.join(HERE, "vtk_stages.py"), os.path.join(options.work, "volume.raw"),
                     str(options.size), os.path.join(options.work, "mesh.ply"), str(options.runs)])
    return (json.loads(text), None) if text else ({}, why)


def itk(options):
    if not options.itk or not os.path.exists(options.itk):
        return {}, "not installed (libinsighttoolkit5-dev)"
    text, why = run([options.itk, os.path.join(options.work, "volume.raw"), str(options.size), str(options.runs)])
    return (json.loads(text), None) if text else ({}, why)


def meshlab(options):
    """Whole processes: loading and saving alone is taken off."""
    if not shutil.which("meshlabserver"):
        return {}, "not installed (meshlab)"
    mesh, out = os.path.join(options.work, "mesh.ply"), os.path.join(options.work, "meshlab.ply")
    window = ["xvfb-run", "-a"] if shutil.which("xvfb-run") else []
    text, bare = run([*window, "meshlabserver", "-i", mesh, "-o", out])
    if text is None:
        return {}, bare
    text, all_of_it = run([*window, "meshlabserver", "-i", mesh, "-o", out, "-s", os.path.join(HERE, "twostep.mlx")])
    return ({"smooth": max(all_of_it - bare, 0.0)}, None) if text is not None else ({}, all_of_it)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("ours")
    parser.add_argument("--itk")
    parser.add_argument("--size", type=int, default=512)
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--no-meshlab", action="store_true", help="it takes minutes")
    parser.add_argument("--work", default="/var/tmp/dubsar-bench/stages")
    figures.add_options(parser)
    options = parser.parse_args()
    os.makedirs(options.work, exist_ok=True)
    text, why = run([options.ours, options.work, str(options.size), str(options.runs)])
    if text is None:
        sys.exit(f"{options.ours}: {why}")
    ours = json.loads(text)
    stages = {stage["name"]: stage for stage in ours["stages"]}
    embree = stages.pop("light by Embree", None)
    peers, absent = {}, {}
    peers["VTK"], absent["VTK"] = vtk(options)
    peers["ITK"], absent["ITK"] = itk(options)
    peers["Embree"], absent["Embree"] = ({"light": embree["core_s"]}, None) if embree else ({}, "not built in")
    peers["MeshLab"], absent["MeshLab"] = ({}, "left out") if options.no_meshlab else meshlab(options)

    rates = ours["machine"]
    print(f"{options.size}^3 floats, {ours['vertices']:,} vertices, one core; memory {rates['bytes_per_s'] / 1e9:.1f} GB/s, arithmetic "
          f"{rates['operations_per_s'] / 1e9:.0f} billion operations/s")
    print(f"{'stage':<12}{'core s':>9}{'million/s':>11}{'floor s':>9}{'ours/floor':>11}" +
          "".join(f"{name:>10}{'ratio':>8}" for name in PEERS))
    rows = []
    for name, stage in stages.items():
        floor = max(stage["bytes"] / rates["bytes_per_s"], stage["operations"] / rates["operations_per_s"])
        row = {**stage, "floor_s": floor, "peers": {p: peers[p][name] for p in PEERS if name in peers[p]}}
        row["ratios"] = {p: s / stage["core_s"] for p, s in row["peers"].items()}
        rows.append(row)
        line = f"{name:<12}{stage['core_s']:>9.3f}{stage['work'] / stage['core_s'] / 1e6:>11.1f}{floor:>9.3f}{stage['core_s'] / floor:>11.1f}"
        for p in PEERS:
            line += f"{row['peers'][p]:>10.3f}{row['ratios'][p]:>7.1f}x" if p in row["peers"] else f"{'-':>10}{'-':>8}"
        print(line)
    for (stage, peer), note in NOTES.items():
        if stage in stages and stage in peers[peer]:
            print(f"  {peer}, {stage}: {note}")
    for peer in PEERS:
        if absent[peer]:
            print(f"  {peer}: {absent[peer]}")
    figures.keep(options, {"what": "stages", "size": options.size, "vertices": ours["vertices"], "rates": rates, "rows": rows,
                           "absent": {p: w for p, w in absent.items() if w}, **figures.machine()})


if __name__ == "__main__":
    main()
