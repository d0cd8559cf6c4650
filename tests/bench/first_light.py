#!/usr/bin/env python3
"""First light of a kiosk: from the start of its process to the first picture of the object, by the wall's clock.

first_light.py PROGRAM SURFACE [--runs 3] [--display quilt:looking-glass-portrait] [--wanted 1.5] [--json FILE]

The kiosk covers an X server in memory (1280x720, llvmpipe where there is no GPU) and is looked at there, so that nobody is asked
how quick he is: light is there when a tenth of the screen is brighter than the ground, which words alone never are, and every run
has its own server and process. Ends with 1 where the median of the runs is later than wanted.
"""
import argparse, json, os, re, shutil, statistics, subprocess, sys, tempfile, time
import figures
import view_bench

POLL_S, LONGEST_S, GROUND, LIT = 0.01, 60.0, 60.0, 0.1  # grey level that no ground has, share of the screen above it


def first_light(program, surface, display, work, pictures):
    """Seconds by the wall and of the processor, or None where the kiosk ended before, or showed nothing."""
    folder = tempfile.mkdtemp(dir=work)
    screen = next(s for s in (view_bench.Screen(folder) for _ in range(10)) if s.serves())
    profile = os.path.join(folder, "kiosk.json")
    with open(profile, "w") as out:
        json.dump({"format": "dubsar kiosk", "version": 1, "objects": [{"file": os.path.abspath(surface)}], "display": display,
                   "pin": "70415", "inputs": []}, out)
    env = {**os.environ, "DISPLAY": screen.display, "HOME": folder, "XDG_STATE_HOME": folder}
    for taken in ("WAYLAND_DISPLAY", "XDG_CONFIG_HOME", "NOTIFY_SOCKET"):
        env.pop(taken, None)
    with open(os.path.join(folder, "talk"), "w+") as talk:
        start = time.monotonic()
        process = subprocess.Popen([program, "view", "--kiosk", profile], env=env, stdout=talk, stderr=talk)
        try:
            while time.monotonic() - start < LONGEST_S and process.poll() is None:
                if (screen.look() > GROUND).mean() > LIT:
                    seconds = time.monotonic() - start, view_bench.cpu_s(process)
                    if pictures:
                        screen.save(os.path.join(pictures, "first_light.png"))
                    return seconds
                time.sleep(POLL_S)
            talk.seek(0)
            print(f"no picture (exit code {process.poll()}): {talk.read().strip()[-300:]}", file=sys.stderr)
            return None
        finally:
            process.kill()
            process.wait()
            screen.close()
            shutil.rmtree(folder)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program", help="the dubsar that is measured")
    parser.add_argument("surface", help="what is shown, of about 1.4 million vertices")
    parser.add_argument("--runs", type=int, default=3)
    parser.add_argument("--display", default="quilt:looking-glass-portrait", help="48 views")
    parser.add_argument("--wanted", type=float, default=1.5, help="seconds")
    parser.add_argument("--pictures", help="folder for a picture of the screen at that moment")
    figures.add_options(parser)
    options = parser.parse_args()
    program = os.path.abspath(options.program)
    told = subprocess.run([program, "info", options.surface], capture_output=True, check=True, text=True).stdout
    vertices = int(re.search(r"(\d+) vertices", told).group(1))
    out = {**figures.machine(), "display": options.display, "vertices": vertices, "seconds": [], "cpu_s": []}
    print(f"{vertices:,} vertices, {options.display}, load {out['load']:.1f} on {out['cores']} cores")
    for _ in range(options.runs):
        found = first_light(program, options.surface, options.display, tempfile.gettempdir(), options.pictures)
        if found is None:
            return 1
        out["seconds"].append(round(found[0], 3))
        out["cpu_s"].append(round(found[1], 3))
        print(f"first light of the kiosk after {found[0]:.2f} s, {found[1]:.2f} s of the processor, load "
              f"{os.getloadavg()[0]:.1f}", flush=True)
    median = statistics.median(out["seconds"])
    print(f"median {median:.2f} s of {options.runs} runs, {options.wanted:.1f} s wanted")
    figures.keep(options, out)
    return 0 if median <= options.wanted else 1


if __name__ == "__main__":
    sys.exit(main())
