#!/usr/bin/env bash
# make_contact_pictures.sh PROGRAM FOLDER: the obverse of a tablet that touches its envelope, a film of .35 voxel between
# them: before.png as a surface at half of the resolution with smooth patches shows it, after.png as it is shown without
# options. Some minutes on two cores.
set -euo pipefail
program=$(realpath "$1") out=$(realpath "$2")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"$program" phantom scan.h5 --size 384x208x360 --seed 77 --contact film --film 0.35 --contact-share 0.35 -q >/dev/null
"$program" process scan.h5 -o before.exa --detail half --no-contact -q --progress none >/dev/null
"$program" process scan.h5 -o after.exa -q --progress none >/dev/null
for name in before after; do
  "$program" render "$name.exa" -o "$out/contact_$name.png" --partition tablet --style raking --light 315,20 --size 900x900
done
