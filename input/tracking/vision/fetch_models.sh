#!/usr/bin/env bash
# Fetches the networks for faces and hands (Apache-2.0) with npm into the user's data folder, checksums compared;
# with --photographs also the pictures that tests use (MIT). Nothing of it is ever part of the program or of its repository.
# usage: fetch_models.sh [--from FOLDER] [--photographs] [--timeout SECONDS]
set -euo pipefail

here=$(dirname "$(realpath "$0")")
given=/nonexistent photographs= seconds=120
while [ $# -gt 0 ]; do
  case "$1" in
    --from) given=$(realpath "$2"); shift ;;
    --photographs) photographs=1 ;;
    --timeout) seconds=$2; shift ;;
    *) echo "models: \"$1\" found, expected --from FOLDER, --photographs or --timeout SECONDS" >&2; exit 64 ;;
  esac
  shift
done

data=${XDG_DATA_HOME:-${HOME:-/nonexistent}/.local/share}/dubsar
mkdir -p "$data/models" && work=$(mktemp -d "$data/fetch.XXXXXX") || exit 73
trap 'rm -rf "$work"' EXIT

# package NAME VERSION SHA512: prints the file of an npm package, its content checked.
package() {
  local name=${1#@}-$2.tgz
  name=${name//\//-}
  local file=$given/$name
  if [ ! -f "$file" ]; then
    file=$work/$name
    command -v npm >/dev/null ||
      { echo "models: npm is missing; ./do models installs it, or put $name into a folder and say --from FOLDER" >&2; return 69; }
    (cd "$work" && timeout "$seconds" npm pack --loglevel=error --fetch-retries=0 --fetch-timeout="${seconds}000" "$1@$2" >/dev/null 2>log) ||
      { echo "models: $1@$2 could not be fetched: $(grep -m 1 "ERR!" "$work/log" || echo "no answer in $seconds s")" >&2; return 69; }
  fi
  echo "$3  $file" | sha512sum --check --status ||
    { echo "models: $file is not the $1@$2 that was expected: its SHA-512 differs" >&2; return 65; }
  echo "$file"
}

# network NAME BYTES: whether it is here; made of the .tflite file, if that lies beside it or in the work folder.
network() {
  local onnx=$data/models/$1.onnx tflite
  if [ -f "$onnx" ] && [ "$(stat -c %s "$onnx")" -eq "$2" ]; then return 0; fi
  for tflite in "$work/$1.tflite" "$data/models/$1.tflite"; do
    [ -f "$tflite" ] || continue
    /usr/bin/python3 "$here/tflite_to_onnx.py" "$tflite" "$work/$1.onnx" || continue
    [ "$(stat -c %s "$work/$1.onnx")" -eq "$2" ] || continue
    mv "$work/$1.onnx" "$onnx"
    return 0
  done
  return 1
}
faces() { network face_detection_short_range 415380; }
hands() { network palm_detection_lite 3865900 && network hand_landmark_lite 4058467; }

if ! faces; then
  tgz=$(package @mediapipe/face_detection 0.4.1646425229 \
    69e08df9f440a23bfd721dcd5e8acfeabe6d70654b477fe00b51e6b6a074584641457add3faff75bfb06474747af5893eae7a22bde46f4f5636f3168b1ffe1ae)
  tar -xzOf "$tgz" package/face_detection_short_range.tflite >"$work/face_detection_short_range.tflite"
  faces
fi
if ! hands; then
  tgz=$(package @mediapipe/hands 0.4.1675469240 \
    1b1a19bcbd669a12711718eeca3eef9c2fbe248b889c6ce71c18a7e5ced94aafd16dc9c6c9f11c26b90cfdb32ee4ad4ccffd8aa3ebc45faffec1ec261073eb1e)
  tar -xzOf "$tgz" package/hand_landmark_lite.tflite >"$work/hand_landmark_lite.tflite"
  # The palm network is the last part of a file of several.
  tar -xzOf "$tgz" package/hands_solution_packed_assets.data | tail -c +2341292 >"$work/palm_detection_lite.tflite"
  hands
fi
if [ -n "$photographs" ] && [ ! -f "$data/photographs/sample6.jpg" ]; then
  tgz=$(package @vladmandic/face-api 1.7.15 \
    5833262b709f34ba3c8f2956a8ca1081fe2722cb773347f3c7576769cf7ac2ffddbcc4cde03c42fcfab50c6b5db83935964b426a64373080d7167beb7474d70f)
  mkdir -p "$data/photographs" "$work/demo"
  tar -xzf "$tgz" -C "$work/demo" --strip-components=2 package/demo
  mv "$work"/demo/sample?.jpg "$data/photographs/"
fi
cat >"$data/models/LICENSE.txt" <<'TEXT'
face_detection_short_range.onnx, palm_detection_lite.onnx, hand_landmark_lite.onnx: MediaPipe, Google, Apache-2.0
(https://www.apache.org/licenses/LICENSE-2.0), taken from the npm packages @mediapipe/face_detection 0.4.1646425229 and
@mediapipe/hands 0.4.1675469240 and converted from TensorFlow Lite to ONNX.
TEXT
echo "networks for faces and hands: $data/models (MediaPipe, Apache-2.0)" >&2
