#!/usr/bin/env python3
"""First pictures, pictures a second and memory of viewers of the same meshes, in one run on one machine.

view_bench.py PROGRAM [--sizes 0.4,1.4,12] [--format ply|stl|obj] [--style STYLE] [--seconds 4] [--json FILE] [--work FOLDER]

Each viewer opens the same file in its window on an X server in memory (1280x720, llvmpipe where there is no GPU). The picture
is looked at in the server's memory, so that nobody is asked how quick he is: the first picture is the first one that looks
like the one that stays; then the mouse turns the object, and different pictures are counted; then it rests, and the last
change after that says when what is shown is exact.
"""
import argparse, collections, mmap, os, shutil, struct, subprocess, sys, tempfile, time, zlib
import figures
import numpy as np

WIDTH, HEIGHT = 1280, 720
LEFT, TOP, RIGHT, BOTTOM = 200, 200, 700, 560  # what is looked at: beside all panels
LIKE, SAME = 0.25, 1.5  # share of the object's contrast; grey levels
MOUSE_S = 0.008  # as mice tell where they are
POLL_S, QUIET_S, LONGEST_S = 0.02, 3.0, 240.0
IDLE = 0.1  # of a core: whoever works more is still loading


def write_mesh(path, millions):
    """A pillow of 60 x 45 x 20 mm with waves like wedges, in the format of the suffix: binary PLY or STL, or OBJ."""
    n = int(round((millions * 1e6) ** 0.5))
    u = np.linspace(0, 2 * np.pi, n, endpoint=False, dtype=np.float32)[None, :]
    v = np.linspace(1e-3, np.pi - 1e-3, n, dtype=np.float32)[:, None]
    power = lambda x, e: np.sign(x) * np.abs(x) ** e
    bumps = 1 + 0.012 * np.sin(40 * u) * np.sin(34 * v)
    x = 30 * power(np.sin(v), 0.4) * power(np.cos(u), 0.4) * bumps
    y = 22.5 * power(np.sin(v), 0.4) * power(np.sin(u), 0.4) * bumps
    z = 10 * power(np.cos(v), 0.6) * bumps
    points = np.stack([x, y, np.broadcast_to(z, x.shape)], -1).reshape(-1, 3).astype("<f4")
    a = np.arange(n - 1, dtype=np.int32)[:, None] * n + np.arange(n, dtype=np.int32)[None, :]
    b = np.arange(n - 1, dtype=np.int32)[:, None] * n + (np.arange(n, dtype=np.int32)[None, :] + 1) % n
    faces = np.zeros(2 * a.size, dtype=[("n", "u1"), ("v", "<i4", 3)])
    faces["n"] = 3
    faces["v"][: a.size] = np.stack([a, a + n, b + n], -1).reshape(-1, 3)
    faces["v"][a.size :] = np.stack([a, b + n, b], -1).reshape(-1, 3)
    if path.endswith(".stl"):
        facets = np.zeros(len(faces), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
        facets["corners"] = points[faces["v"]]
        with open(path, "wb") as out:
            out.write(b"bench".ljust(80) + struct.pack("<I", len(faces)))
            facets.tofile(out)
        return len(points), len(faces)
    if path.endswith(".obj"):
        with open(path, "w") as out:
            out.writelines("v %.5f %.5f %.5f\n" % tuple(p) for p in points.tolist())
            out.writelines("f %d %d %d\n" % tuple(f) for f in (faces["v"] + 1).tolist())
        return len(points), len(faces)
    with open(path, "wb") as out:
        out.write(
            f"ply\nformat binary_little_endian 1.0\nelement vertex {len(points)}\nproperty float x\nproperty float y\n"
            f"property float z\nelement face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n".encode()
        )
        points.tofile(out)
        faces.tofile(out)
    return len(points), len(faces)


class Screen:
    """An X server whose picture lies in a file."""

    def __init__(self, folder):
        read, write = os.pipe()
        self.server = subprocess.Popen(
            ["Xvfb", "-displayfd", str(write), "-screen", "0", f"{WIDTH}x{HEIGHT}x24", "-fbdir", folder, "-noreset"],
            pass_fds=[write], stderr=subprocess.DEVNULL,
        )
        os.close(write)
        self.display = ":" + os.read(read, 16).decode().strip()
        os.close(read)
        self.fitted = collections.Counter()
        self.file = open(os.path.join(folder, "Xvfb_screen0"), "rb")
        self.memory = mmap.mmap(self.file.fileno(), 0, prot=mmap.PROT_READ)
        header, = struct.unpack(">I", self.memory[:4])
        colours, = struct.unpack(">I", self.memory[76:80])
        stride, = struct.unpack(">I", self.memory[48:52])
        start = header + 12 * colours
        whole = np.frombuffer(self.memory, dtype=np.uint8, offset=start, count=stride * HEIGHT)
        self.pixels = whole.reshape(HEIGHT, stride)[:, : 4 * WIDTH].reshape(HEIGHT, WIDTH, 4)

    def look(self):
        return self.pixels[TOP:BOTTOM:4, LEFT:RIGHT:4, 1].astype(np.int16)

    def serves(self):
        found = subprocess.run(["xdotool", "getmouselocation"], env={**os.environ, "DISPLAY": self.display},
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)
        return found.returncode == 0

    def save(self, path):
        rows = np.pad(self.pixels[:, :, 2::-1], ((0, 0), (1, 0), (0, 0))).reshape(HEIGHT, -1)[:, 2:]
        rows[:, 0] = 0
        chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        with open(path, "wb") as out:
            out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", WIDTH, HEIGHT, 8, 2, 0, 0, 0))
                      + chunk(b"IDAT", zlib.compress(rows.tobytes(), 6)) + chunk(b"IEND", b""))

    def say(self, *words):
        subprocess.run(["xdotool", *map(str, words)], env={**os.environ, "DISPLAY": self.display},
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=False)

    def fit(self, process):
        found = subprocess.run(["xdotool", "search", "--onlyvisible", "--pid", str(process.pid)], capture_output=True,
                               env={**os.environ, "DISPLAY": self.display}, text=True, check=False)
        for window in found.stdout.split():
            if self.fitted[window] >= 3:  # some take their own size again while they start
                continue
            self.fitted[window] += 1
            size = subprocess.run(["xdotool", "getwindowgeometry", "--shell", window], capture_output=True,
                                  env={**os.environ, "DISPLAY": self.display}, text=True, check=False).stdout
            if f"X=0\nY=0\nWIDTH={WIDTH}\nHEIGHT={HEIGHT}\n" not in size:
                self.say("windowmove", window, 0, 0, "windowsize", window, WIDTH, HEIGHT)

    def close(self):
        self.server.terminate()
        self.server.wait()


def memory_mib(process):
    try:
        with open(f"/proc/{process.pid}/status") as status:
            for line in status:
                if line.startswith("VmHWM"):
                    return int(line.split()[1]) / 1024
    except OSError:
        pass
    return 0.0


def cpu_s(process):
    try:
        with open(f"/proc/{process.pid}/stat") as stat:
            fields = stat.read().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")
    except OSError:
        return 0.0


def contrast(picture):
    """Grey levels along rows: 0 for a ground that is brighter below than above."""
    return float(picture.std(axis=1).mean())


def wait_for_picture(screen, process):
    """Seconds to the first picture that looks like the one that stays, and to the one that stays."""
    start, seen, last_change, fitted = time.monotonic(), [], time.monotonic(), 0.0
    worked = collections.deque()
    while time.monotonic() - start < LONGEST_S and process.poll() is None:
        if time.monotonic() - fitted > 0.25:  # nobody else does it: there is no window manager
            screen.fit(process)
            fitted = time.monotonic()
        now, picture = time.monotonic(), screen.look()
        if not seen or np.abs(picture - seen[-1][1]).mean() > 0.05:
            seen.append((now - start, picture))
            last_change = now
        worked.append((now, cpu_s(process)))
        while now - worked[0][0] > QUIET_S:
            worked.popleft()
        rests = now - start > QUIET_S and worked[-1][1] - worked[0][1] < IDLE * QUIET_S
        if contrast(picture) > 8 and now - last_change > QUIET_S and rests:
            break
        time.sleep(POLL_S)
    if process.poll() is not None or not seen or contrast(seen[-1][1]) <= 8:
        return None
    final = seen[-1][1]
    like = next(t for t, p in seen if np.abs(p - final).mean() < LIKE * contrast(final))
    same = next(t for k, (t, p) in enumerate(seen) if all(np.abs(q - final).mean() < SAME for _, q in seen[k:]))
    return like, same


def turn(screen, seconds):
    """Different pictures a second while the mouse turns the object."""
    x, y = (LEFT + RIGHT) // 2, (TOP + BOTTOM) // 2
    way = lambda k: (x + int(150 * np.sin(k / 60)), y + int(60 * np.cos(k / 60)))  # it never stands still
    screen.say("mousemove", *way(0), "mousedown", 1)
    steps = []
    for k in range(int(seconds / MOUSE_S)):
        steps += ["mousemove", *way(k), "sleep", str(MOUSE_S)]
    mover = subprocess.Popen(["xdotool", *map(str, steps)], env={**os.environ, "DISPLAY": screen.display},
                             stdout=subprocess.DEVNULL)
    times, before = [], screen.look()
    while mover.poll() is None:
        picture = screen.look()
        if (np.abs(picture - before) > 1).mean() > 0.005:  # the pointer alone, .3 %, is no picture
            times.append(time.monotonic())
            before = picture
        time.sleep(0.004)
    screen.say("mouseup", 1)
    if len(times) < 3:
        return {"pictures": len(times), "per_s": len(times) / seconds, "worst_ms": None}
    gaps = np.diff(times)
    return {"pictures": len(times), "per_s": float(1 / np.mean(gaps)), "worst_ms": float(1000 * gaps.max())}


def rest(screen, process):
    """Seconds from the mouse's rest to the last change of the picture."""
    start, last, before = time.monotonic(), 0.0, screen.look()
    worked = collections.deque()
    while time.monotonic() - start < LONGEST_S and process.poll() is None:
        time.sleep(POLL_S)
        now, picture = time.monotonic() - start, screen.look()
        if np.abs(picture - before).mean() > 0.05:
            last, before = now, picture
        worked.append((now, cpu_s(process)))
        while now - worked[0][0] > QUIET_S:
            worked.popleft()
        if now - last > QUIET_S and worked[-1][1] - worked[0][1] < IDLE * QUIET_S:
            return last
    return None


def measure(name, command, mesh, work, seconds, pictures):
    folder = tempfile.mkdtemp(dir=work)
    screen = next(s for s in (Screen(folder) for _ in range(10)) if s.serves())
    home = os.path.join(folder, "home")
    os.mkdir(home)
    env = {**os.environ, "DISPLAY": screen.display, "HOME": home, "XDG_STATE_HOME": home, "QT_QPA_PLATFORM": "xcb"}
    for taken in ("WAYLAND_DISPLAY", "XDG_CONFIG_HOME"):
        env.pop(taken, None)
    talk = open(os.path.join(folder, "talk"), "w+")
    process = subprocess.Popen([*command, mesh], env=env, stdout=subprocess.DEVNULL, stderr=talk)
    row = {"viewer": name, "first_s": None, "exact_s": None}
    try:
        found = wait_for_picture(screen, process)
        if found:
            row["first_s"], row["exact_s"] = (round(t, 2) for t in found)
            if pictures:
                screen.save(os.path.join(pictures, f"{name}_first.png"))
            row.update(turn(screen, seconds))
            row["rest_s"] = rest(screen, process)
            if pictures:
                screen.save(os.path.join(pictures, f"{name}_turned.png"))
        else:
            talk.seek(0)
            print(f"{name}: no picture (exit code {process.poll()}): {talk.read().strip()[-300:]}", file=sys.stderr)
        row["memory_mib"] = round(memory_mib(process))
    finally:
        process.kill()
        process.wait()
        screen.close()
        shutil.rmtree(folder)
    return row


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("program", help="the dubsar that is measured")
    parser.add_argument("--sizes", default="0.4,1.4,12", help="millions of vertices")
    parser.add_argument("--seconds", type=float, default=4.0, help="how long the object is turned")
    figures.add_options(parser)
    parser.add_argument("--format", default="ply", choices=("ply", "stl", "obj"), help="of the files")
    parser.add_argument("--style", help="that dubsar shows them in, such as raking")
    parser.add_argument("--only", help="one viewer: dubsar, f3d or MeshLab")
    parser.add_argument("--pictures", help="folder for pictures of the screen, to see what was measured")
    parser.add_argument("--work", default=tempfile.gettempdir(), help="folder with room for the meshes (430 MB)")
    options = parser.parse_args()
    style = ["--style", options.style] if options.style else []
    viewers = [("dubsar", [os.path.abspath(options.program), "view", "-q", *style])]
    for name, program in (("f3d", ["f3d", f"--resolution={WIDTH},{HEIGHT}"]), ("MeshLab", ["meshlab"])):
        if shutil.which(program[0]):
            viewers.append((name, program))
        else:
            print(f"{name} is not installed and is left out", file=sys.stderr)
    out = {**figures.machine(), "window": [WIDTH, HEIGHT], "format": options.format, "style": options.style, "rows": []}
    print(f"load {out['load']:.1f} on {out['cores']} cores\n")
    print("| vertices | viewer | first picture | it stays | pictures a second | longest wait | exact after rest | memory |")
    print("|---|---|---|---|---|---|---|---|", flush=True)
    text = lambda value, unit, digits=1: "none" if value is None else f"{value:.{digits}f} {unit}"
    for millions in map(float, options.sizes.split(",")):
        mesh = os.path.join(options.work, f"view_bench_{millions:g}.{options.format}")
        vertices, triangles = write_mesh(mesh, millions)
        try:
            for name, command in viewers:
                if options.only not in (None, name):
                    continue
                row = measure(name, command, mesh, options.work, options.seconds, options.pictures)
                row.update({"vertices": vertices, "triangles": triangles, "load": round(os.getloadavg()[0], 1)})
                out["rows"].append(row)
                print(f"| {vertices:,} | {name} | {text(row['first_s'], 's', 2)} | {text(row['exact_s'], 's', 2)} | "
                      f"{text(row.get('per_s'), '')} | {text(row.get('worst_ms'), 'ms', 0)} | {text(row.get('rest_s'), 's', 2)} | "
                      f"{row['memory_mib']} MiB |", flush=True)
        finally:
            os.remove(mesh)
    figures.keep(options, out)


if __name__ == "__main__":
    main()
