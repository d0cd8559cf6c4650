#!/usr/bin/env python3
"""extract_recorded_hands.py leap_grab.json > recorded_hands.inc: how a real hand's fingers closed and opened, twice.

The recording is of leapmotion/leapjs-playback (Apache-2.0), recorder/recordings/grab: 374 frames of one right hand at 115 Hz.
Written are every second frame of each movement: seconds, grab strength 0..1, millimetres from thumb's to index's tip, and how far
the palm went meanwhile (mm: right, up, to the viewer).
"""

import json
import sys

import numpy as np

# From when the fingers begin until they rest, and when they have come to where they were going (s), seen in the file.
MOVEMENTS = [("kCloses", 0.14, 0.98, 0.50), ("kOpens", 0.98, 1.50, 1.42), ("kCloses", 1.76, 2.88, 2.14), ("kOpens", 2.88, 3.08, 2.99)]


def main():
    t, rows = 0.0, []
    for frame in json.load(open(sys.argv[1]))["frames"]:
        t += 1.0 / frame["currentFrameRate"]
        tips = {p["type"]: np.array(p["tipPosition"]) for p in frame["pointables"]}
        hand = frame["hands"][0]
        rows.append((t, hand["grabStrength"], np.linalg.norm(tips[0] - tips[1]), *hand["palmPosition"]))
    rows = np.array(rows)
    for name, first, last, there in MOVEMENTS:
        part = rows[(rows[:, 0] >= first) & (rows[:, 0] <= last)][::2]
        print(f"// {name[1:]}: {first} to {last} s of the file.")
        print(f"{{RecordedFingers::{name}, {there - first:.2f}, {{")
        for row in part:
            x, y, z = row[3:6] - part[0, 3:6]
            print(f"    {{{row[0] - part[0, 0]:.3f}, {row[1]:.2f}, {row[2]:.0f}, {{{x:.1f}, {y:.1f}, {z:.1f}}}}},")
        print("}},")


main()
