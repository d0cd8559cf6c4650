#!/usr/bin/env bash
# make_pictures.sh PROGRAM FOLDER: makes those pictures of docs/ that show a session, from a small phantom and the scripts
# beside this file. Minutes of a slow machine are seconds here: a test makes them again and compares.
set -euo pipefail
program=$(realpath "$1") out=$(realpath "$2") scripts=$(dirname "$(realpath "$0")")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"$program" phantom scan.h5 --size 224x128x208 --seed 5 -q >/dev/null
"$program" process scan.h5 -o tablet.exa --no-ao -q --progress none >/dev/null
for script in "$scripts"/reading.txt "$scripts"/film.txt; do
  name=$(basename "$script" .txt)
  "$program" view tablet.exa --offscreen --size 960x540 --fps 10 --samples 2 --every 5 --steps "$script" --frames "$name" \
    -q --progress none >/dev/null
  frames=("$name"/frame-*.png)
  cp "${frames[-1]}" "$out/$name.png"
done
