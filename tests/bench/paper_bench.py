#!/usr/bin/env python3
"""The program at the sizes of the paper and of the scanner, beside the paper's figures.

paper_bench.py PROGRAM paper  [--size 1871x999x1723] [--no-ao] ...   Table 2 line by line, per core too
paper_bench.py PROGRAM linear [--size 1024x544x944] [--phantoms 3]   four sizes, fitted exponents of cost
paper_bench.py PROGRAM killed [--size 200x106x184]                   kill -9 at 20 random moments, then --resume: same bytes?
paper_bench.py PROGRAM scanner --maker PROGRAM [--size 3072x3072x1944] [--memory 6G] [--scan FILE]   larger than memory

Common: [--threads N] [--work FOLDER] [--json FILE] [--history FILE] [--seed N]

Scans are phantoms; they are made where they are not in the folder yet and stay there. Seconds of a core are user and
system time of all threads: they can be compared on a busy machine, too, seconds of the clock cannot.
"""
import argparse, json, math, os, random, re, shutil, signal, subprocess, sys, time

import figures

PAPER_CORES = 8
PAPER_VOXELS, PAPER_GRID, PAPER_VERTICES = 1871 * 999 * 1723, 935 * 499 * 861, 10_011_300
# Lines of Table 2: what it says, its seconds, our stages, what their cost grows with. Stages of ours that a line leaves out
# have no counterpart there: they come below.
TABLE_2 = [
    ("import of the HDF5 file", 6.699, ["import"], "voxels"),
    ("Gauss 3x3x3 and 2:1", 0.601, ["resample"], "voxels"),
    ("noise, threshold", 0.233 + 0.232, ["estimate"], "grid"),
    ("denoising, 2 passes", 5.757, ["denoise"], "grid"),
    ("isosurface", 1.273, ["extract", "mesh"], "grid"),
    ("vertices, normals, smoothing (32 + 8)", 1.770 + 9.636 + 0.224 + 2.663, ["smooth"], "vertices"),
    ("curvatures", 0.425, ["curvature"], "vertices"),
    ("segmentation", 1.639, ["segment"], "vertices"),
    ("writing EXA", 2.058, ["write"], "vertices"),
    ("ambient occlusion, 160 rays, radius 64", 28.6 * 60, ["occlusion"], "vertices"),
]
VOLUME_STAGES = {"import", "resample", "denoise", "extract"}
NOT_FITTED = {"estimate_raw", "blur", "estimate", "fill_holes", "contact", "occlusion"}  # samples, histograms, loops, bands


class Run:
    """A program that was run to its end: what it printed, seconds by the clock and of a core, most memory."""

    def __init__(self, text, wall, usage):
        self.text, self.wall = text, wall
        self.cpu = usage.ru_utime + usage.ru_stime
        self.peak_mib = usage.ru_maxrss / 1024

    def peak_with(self, stages):
        """A run that takes the peak of each stage begins it anew each time, for the kernel, too."""
        return max([self.peak_mib] + [s["peak_rss_mib"] for s in stages.values()])


def run(command):
    start = time.monotonic()
    child = subprocess.Popen(command, stdout=subprocess.PIPE, text=True)
    text = child.stdout.read()
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        sys.exit(f"{' '.join(command)}: exit code {child.returncode}")
    return Run(text, time.monotonic() - start, usage)


def dims_of(text):
    if not re.fullmatch(r"\d+x\d+x\d+", text):
        sys.exit(f'size "{text}" not understood, expected XxYxZ')
    return [int(n) for n in text.split("x")]


def phantom(options, size, seed=None):
    seed = options.seed if seed is None else seed
    path = os.path.join(options.work, f"phantom_{size}_{seed}.h5")
    if not os.path.exists(path):
        print(f"making {path}", file=sys.stderr)
        run([options.program, "phantom", path, "--size", size, "--seed", str(seed), "-q"])
    return path


def summed(records):
    """The stages of a report, those of one name together."""
    stages = {}
    for stage in records:
        sums = stages.setdefault(stage["name"], {"wall_s": 0.0, "cpu_s": 0.0, "peak_rss_mib": 0.0})
        sums["wall_s"] += stage["wall_s"]
        sums["cpu_s"] += stage["cpu_s"]
        sums["peak_rss_mib"] = max(sums["peak_rss_mib"], stage["peak_rss_mib"])
    return stages


def process(options, scan, *more):
    """The report of a run, its stages summed by name."""
    out = os.path.join(options.work, "surface.exa")
    done = run([options.program, "process", scan, "-o", out, "--json", "-", "-q", "--threads", str(options.threads), *more,
                *options.with_options])
    report = json.loads(done.text)
    stages = summed(report["stages"])
    return {"wall_s": done.wall, "cpu_s": done.cpu, "stages": stages, "dims": report["input"]["dims"],
            "grid": report["input"]["grid"], "vertices": report["mesh"]["vertices"], "bytes": report["exa"]["bytes"],
            "peak_mib": done.peak_with(stages)}


def paper(options):
    scan = phantom(options, options.size)
    with open(scan, "rb") as file:  # into the page cache, as in the paper after a first look
        while file.read(1 << 24):
            pass
    more = ["--detail", "half", "--no-contact"] + (["--no-ao"] if options.no_ao else [])
    result = process(options, scan, *more)
    work = {"voxels": math.prod(result["dims"]), "grid": math.prod(result["grid"]), "vertices": result["vertices"]}
    theirs = {"voxels": PAPER_VOXELS, "grid": PAPER_GRID, "vertices": PAPER_VERTICES}
    print(f"{'x'.join(map(str, result['dims']))} voxels, {result['vertices']:,} vertices, {options.threads or os.cpu_count()} threads")
    print(f"{'Table 2':<40}{'paper s':>10}{'here s':>10}{'core s':>10}{'times as fast a core':>24}")
    rows, taken = [], set()
    for name, seconds, stages, by in TABLE_2:
        here = [result["stages"][s] for s in stages if s in result["stages"]]
        taken.update(stages)
        if not here:
            continue
        wall, cpu = sum(s["wall_s"] for s in here), sum(s["cpu_s"] for s in here)
        ratio = seconds * PAPER_CORES / theirs[by] / (max(cpu, 1e-3) / work[by])
        rows.append({"line": name, "paper_s": seconds, "wall_s": wall, "cpu_s": cpu, "per_core": ratio})
        print(f"{name:<40}{seconds:>10.2f}{wall:>10.2f}{cpu:>10.2f}{ratio:>24.2f}")
    print("not in the paper's table:")
    for name, stage in result["stages"].items():
        if name not in taken:
            rows.append({"line": name, "paper_s": None, "wall_s": stage["wall_s"], "cpu_s": stage["cpu_s"], "per_core": None})
            print(f"  {name:<38}{'':>10}{stage['wall_s']:>10.2f}{stage['cpu_s']:>10.2f}")
    print(f"{'the whole program':<40}{'':>10}{result['wall_s']:>10.2f}{result['cpu_s']:>10.2f}")
    print(f"most memory {result['peak_mib']:.0f} MiB, EXA {result['bytes']:,} bytes, {8 * result['bytes'] / result['vertices']:.2f} bits a vertex"
          " (paper: 60.67)")
    return {**result, "rows": rows}, True


def slope(points):
    xs, ys = [math.log(x) for x, _ in points], [math.log(max(y, 1e-3)) for _, y in points]
    mx, my = sum(xs) / len(xs), sum(ys) / len(ys)
    return sum((x - mx) * (y - my) for x, y in zip(xs, ys)) / sum((x - mx) ** 2 for x in xs)


def least(options, scan):
    """A run whose stages have the least time of some runs: what disturbs only adds."""
    best = None
    for _ in range(options.repeat):
        one = process(options, scan, "--detail", "scan", "--no-ao", "--no-contact")
        if best is None:
            best = one
        for name, stage in one["stages"].items():
            best["stages"][name]["cpu_s"] = min(best["stages"][name]["cpu_s"], stage["cpu_s"])
    return best


def joined(runs):
    """Runs over different phantoms of one size as one: what a phantom's cracks and glued places cost differs between them."""
    stages = summed([{"name": n, **s} for r in runs for n, s in r["stages"].items()])
    return {"voxels": sum(math.prod(r["grid"]) for r in runs), "vertices": sum(r["vertices"] for r in runs), "stages": stages,
            "volume_s": sum(s["cpu_s"] for n, s in stages.items() if n in VOLUME_STAGES),
            "surface_s": sum(s["cpu_s"] for n, s in stages.items() if n not in VOLUME_STAGES | NOT_FITTED)}


def linear(options):
    """Cost against work: voxels of the grid for volume stages, vertices for surface stages."""
    largest = dims_of(options.size)
    runs = []
    for share in (0.5, 0.63, 0.79, 1.0):  # steps of 2 in the number of voxels
        size = "x".join(str(max(96, round(n * share))) for n in largest)
        of_size = joined([least(options, phantom(options, size, options.seed + k)) for k in range(options.phantoms)])
        runs.append(of_size)
        print(f"{size:>16}: {of_size['voxels'] / 1e6:8.1f} million voxels {of_size['volume_s']:8.2f} s, "
              f"{of_size['vertices'] / 1e6:6.2f} million vertices {of_size['surface_s']:8.2f} s of a core")
    volume = slope([(r["voxels"], r["volume_s"]) for r in runs])
    surface = slope([(r["vertices"], r["surface_s"]) for r in runs])
    good = abs(volume - 1.0) <= 0.1 and abs(surface - 1.0) <= 0.1
    print(f"exponents: volume stages {volume:.3f}, surface stages {surface:.3f} (1.0 +- 0.1 wanted): {'good' if good else 'NOT LINEAR'}")
    stages = {}
    for name in runs[0]["stages"]:
        by = "voxels" if name in VOLUME_STAGES else "vertices"
        if name not in NOT_FITTED and all(name in r["stages"] for r in runs):
            stages[name] = slope([(r[by], r["stages"][name]["cpu_s"]) for r in runs])
    print("each stage: " + ", ".join(f"{n} {e:.2f}" for n, e in stages.items()))
    return {"volume": volume, "surface": surface, "stages": stages, "runs": runs}, good


def killed(options):
    """Many scans in one run, killed -9 at random moments: what --resume makes of it is what one whole run makes."""
    folder = os.path.join(options.work, f"killed_{options.size}")  # scans of one size alone
    for name in ("whole", "resumed"):
        shutil.rmtree(os.path.join(folder, name), ignore_errors=True)
    scans = os.path.join(folder, "scans")
    os.makedirs(scans, exist_ok=True)
    for seed in (1, 2, 3):
        path = os.path.join(scans, f"scan_{options.size}_{seed}.h5")
        if not os.path.exists(path):
            run([options.program, "phantom", path, "--size", options.size, "--seed", str(seed), "-q"])
    command = [options.program, "process", scans, "-q", "--no-ao", "--no-contact", "--threads", str(options.threads)]
    wall = run(command + ["-o", os.path.join(folder, "whole")]).wall
    moments = random.Random(options.seed)
    resume = command + ["-o", os.path.join(folder, "resumed"), "--resume"]
    kills = finished = 0
    while kills < options.kills:
        child = subprocess.Popen(resume, stdout=subprocess.DEVNULL, start_new_session=True)
        try:
            child.wait(timeout=moments.uniform(0.02, 0.4 * wall))
            finished += 1  # all is made: once more from the start
            if kills < options.kills:
                shutil.rmtree(os.path.join(folder, "resumed"))
        except subprocess.TimeoutExpired:
            os.killpg(child.pid, signal.SIGKILL)
            child.wait()
            kills += 1
    run(resume)

    def surfaces(name):
        path = os.path.join(folder, name)
        return {n: open(os.path.join(path, n), "rb").read() for n in sorted(os.listdir(path)) if n.endswith(".exa")}

    whole, resumed = surfaces("whole"), surfaces("resumed")
    good = whole == resumed and len(whole) == 3
    left = [n for n in os.listdir(os.path.join(folder, "resumed")) if not n.endswith((".exa", ".run.json"))]
    print(f"{kills} runs killed within {0.4 * wall:.1f} s, {finished} were quicker and began anew; then --resume: "
          f"{len(resumed)} surfaces, {'the same bytes' if good else 'OTHER BYTES'}; left over: {', '.join(left) or 'nothing'}")
    return {"wall_s": wall, "killed": kills, "finished": finished, "same": good, "left": left}, good


def own_groups():
    """Where this process stands in the trees of cgroups that can limit memory: (folder, file of the limit)."""
    for line in open("/proc/self/cgroup"):
        _, controllers, path = line.strip().split(":", 2)
        if controllers == "":
            yield "/sys/fs/cgroup" + path.rstrip("/"), "memory.max"
        elif "memory" in controllers.split(","):
            yield "/sys/fs/cgroup/memory" + path.rstrip("/"), "memory.limit_in_bytes"


def limited(command, memory):
    """Under a limit of its own for memory and page cache, where this machine lets us have one: the command, what was
    done, and the folder of a group that is to be removed afterwards."""
    scope = ["systemd-run", "--quiet", "--scope", f"--property=MemoryMax={memory}", "--property=MemorySwapMax=0"]
    try:
        if subprocess.run(scope + ["true"], stderr=subprocess.DEVNULL).returncode == 0:
            return scope + command, "in a scope of systemd", None
    except OSError:
        pass
    for folder, limit in own_groups():
        group = os.path.join(folder, f"dubsar-bench-{os.getpid()}")
        try:
            os.mkdir(group)
        except OSError:
            continue
        try:
            with open(os.path.join(group, limit), "w") as file:
                file.write(memory)
            enter = 'echo $$ > "$0/cgroup.procs" && exec "$@"'
            if subprocess.run(["sh", "-c", enter, group, "true"], stderr=subprocess.DEVNULL).returncode == 0:
                return ["sh", "-c", enter, group, *command], "in a cgroup", group
        except OSError:
            pass
        os.rmdir(group)
    return command, "without a cgroup: none can be made here", None


def scanner(options):
    scan = options.scan or os.path.join(options.work, f"scanner_{options.size}_{options.depth}_{options.seed}.h5")
    maker = None
    if not os.path.exists(scan):
        maker = run([options.maker, scan, *map(str, dims_of(options.size)), str(options.depth), str(options.seed),
                     str(options.threads)])
        print(f"made {scan}: {maker.wall:.0f} s, {maker.cpu:.0f} s of a core, {maker.peak_mib:.0f} MiB")
    out = os.path.join(options.work, "scanner.exa")
    command = [options.program, "process", scan, "-o", out, "--memory", options.memory, "--scratch", options.work, "--json", "-", "-q",
               "--threads", str(options.threads), *(["--no-ao"] if options.no_ao else []), *options.with_options]
    told = json.loads(run([options.program, "info", scan, "--memory", options.memory, "--threads", str(options.threads),
                             "--json", "-", "-q"]).text)["process"]
    command, how, group = limited(command, options.memory)
    try:
        done = run(command)
    finally:
        if group:
            os.rmdir(group)
    report = json.loads(done.text)
    stages = summed(report["stages"])
    vertices = report["mesh"]["vertices"]
    peak = done.peak_with(stages)
    print(f"{options.size}, {os.path.getsize(scan) / 1e9:.1f} GB in the file, {vertices:,} vertices: {done.wall:.0f} s, "
          f"{done.cpu:.0f} s of a core, at most {peak:.0f} MiB resident, {how}")
    if "core_s" in told:
        print(f"told by info: {told['vertices']:,} vertices, {told['core_s']:.0f} s of a core, {told['memory_bytes'] / 2**20:.0f} MiB, "
              f"{told['scratch_bytes'] / 1e9:.1f} GB of scratch, {told['product_bytes'] / 1e6:.1f} MB of surface "
              f"(found: {os.path.getsize(out) / 1e6:.1f} MB)")
    for name, s in stages.items():
        print(f"  {name:<14}{s['wall_s']:>10.1f}{s['cpu_s']:>10.1f}{s['peak_rss_mib']:>10.0f} MiB")
    return {"wall_s": done.wall, "cpu_s": done.cpu, "peak_mib": peak, "limit": how, "told": told, "stages": stages,
            "vertices": vertices, "maker_cpu_s": maker.cpu if maker else None}, True


def main():
    sizes = {"paper": "1871x999x1723", "linear": "1024x544x944", "killed": "200x106x184", "scanner": "3072x3072x1944"}
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("what", choices=sizes)
    parser.add_argument("--size")
    parser.add_argument("--no-ao", action="store_true")
    parser.add_argument("--threads", type=int)
    parser.add_argument("--repeat", type=int, default=2)
    parser.add_argument("--phantoms", type=int, default=3, help="phantoms of each size, of seeds that follow one another")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--memory", default="6G")
    parser.add_argument("--depth", type=int, default=32, help="slices in a chunk")
    parser.add_argument("--maker", help="the program scanner_scan")
    parser.add_argument("--scan", help="take this scan instead")
    parser.add_argument("--with-options", nargs=argparse.REMAINDER, default=[], help="of process; comes last")
    parser.add_argument("--work", default="/var/tmp/dubsar-bench")
    figures.add_options(parser)
    options = parser.parse_args()
    options.size = options.size or sizes[options.what]
    if options.threads is None:
        options.threads = 1 if options.what == "linear" else 0
    os.makedirs(options.work, exist_ok=True)
    result, good = {"paper": paper, "linear": linear, "killed": killed, "scanner": scanner}[options.what](options)
    figures.keep(options, {"what": options.what, "size": options.size, **figures.machine(), **result})
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
