#!/usr/bin/python3
"""phantom_truth_wedges.py TRUTH.h5 VOXEL_MM OUT.json: the wedges that a phantom pressed into its tablet, as a session's
file, so that `dubsar handcopy tablet.exa --work OUT.json` draws what was written and not what was found."""
import json
import sys

import h5py
import numpy as np

SIDES = ["obverse", "reverse", "lower-edge", "upper-edge", "left-edge", "right-edge"]  # core/phantom/side.h
READ = ["obverse", "lower-edge", "reverse", "upper-edge", "left-edge", "right-edge"]  # core/script/wedge.h
KINDS = ["horizontal", "vertical", "oblique-down", "oblique-up", "winkelhaken"]  # core/phantom/sign_list.h


def session_wedge(row, voxel_mm):
    """A row of /truth/wedges as app/document/document_fields.h keeps a wedge; lengths in mm."""
    vector = lambda name: np.array([row[f"{name}_{a}"] for a in "xyz"])
    normal, along = vector("out"), vector("tail")
    across = np.cross(normal, along) * row["head_half_width"]
    head, end = vector("head"), vector("end")
    deepest = np.array([row["x"], row["y"], row["z"]]) - row["depth"] * normal
    places = {"head_mm": head, "left_mm": head + across, "right_mm": head - across, "tip_mm": deepest, "tail_mm": end}
    out = {name: [round(float(v), 3) for v in place * voxel_mm] for name, place in places.items()}
    out.update(by="person", deleted=False, kind=KINDS[int(row["kind"])], side=SIDES[int(row["side"])], column=1,
               line=int(row["line"]), order=0, normal=[float(v) for v in normal], direction=[float(v) for v in along],
               depth_mm=float(row["depth"] * voxel_mm), length_mm=float(np.linalg.norm(end - head) * voxel_mm),
               width_mm=float(2 * row["head_half_width"] * voxel_mm), opening_deg=0.0, confidence=1.0,
               pressed_after=[], part="tablet", id="")
    out["along"] = float(head @ vector("right"))
    return out


def main(truth, voxel_mm, out):
    with h5py.File(truth) as file:
        table = file["/truth/wedges"]
        columns = [str(name) for name in table.attrs["columns"]]
        rows = [dict(zip(columns, row)) for row in table[:]]
    wedges = [session_wedge(row, float(voxel_mm)) for row in rows if row["owner"] == 0 and row["air"]]
    wedges.sort(key=lambda w: (READ.index(w["side"]), w["line"], w["along"]))
    for number, wedge in enumerate(wedges, 1):
        wedge["order"] = number
        del wedge["along"]
    with open(out, "w") as file:  # of version 1: what a file lacks is as in a new document
        json.dump({"format": "dubsar document", "version": 1, "wedges": wedges}, file)


if __name__ == "__main__":
    main(*sys.argv[1:4])
