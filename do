#!/usr/bin/env bash
# The project's verbs. Works on a bare Debian 12 as root or with sudo.
set -euo pipefail
cd "$(dirname "$0")"
preset=${DUBSAR_PRESET:-release}
build=build/$preset
jobs=${JOBS:-$(nproc)}

packages=(
  g++ cmake ninja-build pkg-config git ca-certificates
  libfmt-dev libexpected-dev libglm-dev nlohmann-json3-dev libcli11-dev libhwy-dev libxxhash-dev
  libhdf5-dev hdf5-plugin-lzf hdf5-filter-plugin libtiff-dev libpng-dev libjpeg-dev zlib1g-dev libdeflate-dev libzstd-dev
  libembree-dev libglfw3-dev libepoxy-dev libegl-dev libgl-dev libegl1 libgl1-mesa-dri
  libimgui-dev
  libhidapi-dev libusb-1.0-0-dev
  libopencv-core-dev libopencv-dnn-dev libopencv-objdetect-dev libopencv-videoio-dev opencv-data
  libgtest-dev libgmock-dev libbenchmark-dev libumockdev-dev libxcb-xtest0-dev umockdev xvfb
)

# The device lab runs in a kernel of its own; nothing else needs these.
lab_packages=(qemu-system-x86 busybox-static cpio kmod)

usage() {
  cat <<'TEXT'
./do demo     install what is needed, build, make a scan, process it, write surfaces and pictures
./do test     install what is needed, build, run all tests
./do lab      boot Debian's kernel in qemu and test the drivers on virtual USB, HID and camera devices
./do build    build the program (build/release/app/dubsar)
./do bench    run the benchmarks; ./do bench displays: only those of many views
./do models   fetch the networks for hands and faces from a webcam (needs npm; docs/webcam.md)
./do deps     install the packages of Debian 12 that dubsar needs
./do format   clang-format over all sources
TEXT
}

# deps [PACKAGE...]: installs what dubsar needs, and these.
deps() {
  local missing=() package
  for package in "${packages[@]}" "$@"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return
  local root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "do: run as root or install sudo, to install: ${missing[*]}" >&2; exit 77; }
    root=(sudo)
  fi
  echo "installing ${missing[*]}" >&2
  "${root[@]}" apt-get update -qq
  "${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >&2
}

build_target() {
  cmake --preset "$preset" >/dev/null
  cmake --build "$build" -j "$jobs" "$@"
}

# fetch_package NAME VERSION SHA512 SECONDS: prints the file of an npm package, its content checked.
fetch_package() {
  local file=$1-$2.tgz
  file=$work/${file#@}
  file=${file%/*}-${file##*/}
  [ -f "$given/${file##*/}" ] && file=$given/${file##*/}
  if [ ! -f "$file" ]; then
    command -v npm >/dev/null || { echo "do: npm is missing: apt install npm, or ./do models --from FOLDER with ${file##*/} in it" >&2; return 1; }
    (cd "$work" && timeout "$4" npm pack --silent --fetch-retries=0 --fetch-timeout="${4}000" "$1@$2" >/dev/null 2>"$work/log") ||
      { echo "do: $1@$2 could not be fetched: $(tail -n 1 "$work/log")" >&2; return 1; }
  fi
  echo "$3  $file" | sha512sum --check --status || { echo "do: $file is not the $1@$2 that was expected: its SHA-512 differs" >&2; return 1; }
  echo "$file"
}

# has FILE BYTES
has() { [ -f "$1" ] && [ "$(stat -c %s "$1")" -eq "$2" ]; }

# models [--from FOLDER] [--photographs] [--timeout SECONDS]: the networks (Apache-2.0) into the user's data folder; with
# --photographs also the pictures that tests use (MIT). Nothing of it is ever part of the program or of its repository.
models() {
  local given=/nonexistent photographs= seconds=120 work data package failed=0
  while [ $# -gt 0 ]; do
    case "$1" in
      --from) given=$(realpath "$2"); shift ;;
      --photographs) photographs=1 ;;
      --timeout) seconds=$2; shift ;;
      *) echo "do: models takes --from FOLDER, --photographs and --timeout SECONDS" >&2; return 64 ;;
    esac
    shift
  done
  data=${XDG_DATA_HOME:-${HOME:-/nonexistent}/.local/share}/dubsar
  mkdir -p "$data/models" && work=$(mktemp -d "$data/fetch.XXXXXX") || return 73
  local face=$data/models/face_detection_short_range.tflite palm=$data/models/palm_detection_lite.tflite hand=$data/models/hand_landmark_lite.tflite
  if ! has "$face" 229032; then
    package=$(fetch_package @mediapipe/face_detection 0.4.1646425229 \
      69e08df9f440a23bfd721dcd5e8acfeabe6d70654b477fe00b51e6b6a074584641457add3faff75bfb06474747af5893eae7a22bde46f4f5636f3168b1ffe1ae "$seconds") &&
      tar -xzOf "$package" package/face_detection_short_range.tflite >"$work/face" && mv "$work/face" "$face" || failed=69
  fi
  if ! { has "$palm" 1985440 && has "$hand" 2071408; } && [ $failed -eq 0 ]; then
    # the palm network is the last part of a file of several
    package=$(fetch_package @mediapipe/hands 0.4.1675469240 \
      1b1a19bcbd669a12711718eeca3eef9c2fbe248b889c6ce71c18a7e5ced94aafd16dc9c6c9f11c26b90cfdb32ee4ad4ccffd8aa3ebc45faffec1ec261073eb1e "$seconds") &&
      tar -xzOf "$package" package/hand_landmark_lite.tflite >"$work/hand" &&
      tar -xzOf "$package" package/hands_solution_packed_assets.data | tail -c +2341292 >"$work/palm" &&
      mv "$work/hand" "$hand" && mv "$work/palm" "$palm" || failed=69
  fi
  if [ -n "$photographs" ] && [ ! -f "$data/photographs/sample6.jpg" ] && [ $failed -eq 0 ]; then
    package=$(fetch_package @vladmandic/face-api 1.7.15 \
      5833262b709f34ba3c8f2956a8ca1081fe2722cb773347f3c7576769cf7ac2ffddbcc4cde03c42fcfab50c6b5db83935964b426a64373080d7167beb7474d70f "$seconds") &&
      mkdir -p "$data/photographs" "$work/demo" && tar -xzf "$package" -C "$work/demo" --strip-components=2 package/demo &&
      mv "$work"/demo/sample?.jpg "$data/photographs/" || failed=69
  fi
  rm -rf "$work"
  [ $failed -eq 0 ] || return $failed
  cat >"$data/models/LICENSE.txt" <<'TEXT'
face_detection_short_range.tflite, palm_detection_lite.tflite, hand_landmark_lite.tflite: MediaPipe, Google, Apache-2.0
(https://www.apache.org/licenses/LICENSE-2.0), taken from the npm packages @mediapipe/face_detection 0.4.1646425229 and
@mediapipe/hands 0.4.1675469240.
TEXT
  echo "networks for faces and hands: $data/models (MediaPipe, Apache-2.0)" >&2
}

# Without it the device lab is skipped and says why.
lab_kernel() {
  tests/lab/fetch_kernel.sh build/lab/kernel
}

run_tests() {
  deps
  models --photographs --timeout 20 || echo "do: going on without; tests that need networks or photographs are skipped" >&2
  (deps "${lab_packages[@]}") || true
  lab_kernel || true
  build_target
  ctest --test-dir "$build" --output-on-failure -j "$jobs" "$@"
}

lab() {
  deps "${lab_packages[@]}"
  lab_kernel || { echo "do lab: there is no kernel to boot" >&2; exit 69; }
  build_target --target test_lab
  tests/lab/run_in_kernel.sh "$PWD/$build/tests/lab/test_lab" "$@"
}

bench() {
  deps
  build_target --target dubsar_bench
  local filter=()
  if [ "${1:-}" = displays ]; then
    filter=(--benchmark_filter='^Display')
    shift
  fi
  "$build/tests/bench/dubsar_bench" "${filter[@]}" "$@"
}

demo() {
  deps
  build_target --target dubsar
  local dubsar=$build/app/dubsar out=out
  mkdir -p "$out"
  local scan=${1:-$out/scan.h5}
  if [ $# -eq 0 ]; then
    "$dubsar" phantom "$scan" --preset demo
  fi
  "$dubsar" process "$scan" -o "$out/tablet.exa" --json "$out/report.json"
  "$dubsar" export "$out/tablet.exa" "$out/tablet.ply"
  "$dubsar" export "$out/tablet.exa" "$out/tablet.stl" --partition tablet
  "$dubsar" render "$out/tablet.exa" -o "$out/tablet.png" --partition tablet
  "$dubsar" render "$out/tablet.exa" -o "$out/envelope.png" --view orbit
  if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ] && "$dubsar" view --help >/dev/null 2>&1; then
    "$dubsar" view "$out/tablet.exa"
  fi
}

verb=${1:-}
[ $# -gt 0 ] && shift
case "$verb" in
  demo) demo "$@" ;;
  test) run_tests "$@" ;;
  lab) lab "$@" ;;
  build) deps; build_target --target dubsar "$@" ;;
  bench) bench "$@" ;;
  models) models "$@" ;;
  deps) deps ;;
  format) git ls-files '*.cpp' '*.h' | xargs clang-format -i ;;
  *) usage; [ -z "$verb" ] || [ "$verb" = help ] || exit 64 ;;
esac
