#!/usr/bin/env bash
# make_handcopy_pictures.sh PROGRAM FOLDER [S264.glb]: FOLDER/handcopy.png, an obverse in raking light, its hand copy and what
# was pressed; with the GLB of S264 (docs/edition.md says where it is) FOLDER/handcopy_s264.png, its obverse as a
# photograph, in raking light and as a hand copy. Needs ghostscript, ImageMagick, python3-h5py. Minutes of a slow machine.
set -euo pipefail
program=$(realpath "$1") out=$(realpath "$2") scripts=$(dirname "$(realpath "$0")")
s264=${3:+$(realpath "$3")}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
export XDG_STATE_HOME=$work/state XDG_CONFIG_HOME=$work/config
dpi=254  # ten pixels a mm

# drawn OPTIONS... -o NAME: the hand copy of one side as NAME.png.
drawn() {
  local name=${*: -1}
  "$program" handcopy "${@:1:$#-1}" "$name.pdf" -q --progress none >/dev/null
  gs -q -dNOPAUSE -dBATCH -dTextAlphaBits=4 -dGraphicsAlphaBits=4 -sDEVICE=png16m -r$dpi -sOutputFile="$name.png" "$name.pdf"
}
joined() { convert -background white -gravity center "${@:2}" +append -resize 1500x -strip -define png:compression-level=9 -colors 128 "$1"; }

"$program" phantom scan.h5 --size 320x192x304 --seed 101 --wedge-depth 7 --truth truth.h5 --json phantom.json -q >/dev/null
"$program" process scan.h5 -o tablet.exa -q --progress none >/dev/null
voxel=$(python3 -c 'import json; print(json.load(open("phantom.json"))["voxel_size_mm"])')
"$scripts/phantom_truth_wedges.py" truth.h5 "$voxel" truth.json
"$program" render tablet.exa -o light.png --partition tablet --style raking --light 315,25 --dpi $dpi --ground white -q >/dev/null
drawn tablet.exa --found --side obverse --title "found" -o found
drawn tablet.exa --work truth.json --side obverse --title "pressed" -o pressed
joined "$out/handcopy.png" light.png found.png pressed.png

[ -n "$s264" ] || exit 0
for style in photograph raking; do
  "$program" render "$s264" -o $style.png --unit mm --style $style --light 315,20 --dpi 508 --ground white -q >/dev/null
done
drawn "$s264" --unit mm --side obverse --title "S264" -o s264
gs -q -dNOPAUSE -dBATCH -dGraphicsAlphaBits=4 -dTextAlphaBits=4 -sDEVICE=png16m -r508 -sOutputFile=s264.png s264.pdf
convert s264.png -crop 560x620+80+220 +repage s264.png
joined "$out/handcopy_s264.png" photograph.png raking.png s264.png
