#!/usr/bin/env bash
# The project's verbs. Works on a bare Debian 12 as root or with sudo.
set -euo pipefail
cd "$(dirname "$0")"
preset=${DUBSAR_PRESET:-release}
build=build/$preset
jobs=${JOBS:-$(nproc)}

packages=(
  g++ cmake ninja-build pkg-config git ca-certificates
  libfmt-dev libexpected-dev libglm-dev nlohmann-json3-dev libcli11-dev libhwy-dev
  libmeshoptimizer-dev libhdf5-dev hdf5-plugin-lzf hdf5-filter-plugin libtiff-dev libpng-dev libjpeg-dev zlib1g-dev libdeflate-dev
  libembree-dev libglfw3-dev libxcb1-dev libepoxy-dev libegl-dev libgl-dev libegl1 libgl1-mesa-dri libopenxr-dev libopenxr-loader1
  libvulkan-dev mesa-vulkan-drivers
  libimgui-dev libfribidi-dev fonts-dejavu-core
  libhidapi-dev libusb-1.0-0-dev
  libopencv-core-dev libopencv-dnn-dev libopencv-objdetect-dev libopencv-videoio-dev opencv-data
  python3-numpy
  libgtest-dev libgmock-dev libbenchmark-dev libspnav-dev libumockdev-dev libxcb-xtest0-dev umockdev xvfb openbox
)

# The device lab runs in a kernel of its own; nothing else needs these.
lab_packages=(qemu-system-x86 busybox-static cpio kmod)

usage() {
  cat <<'TEXT'
./do demo     install what is needed, build, make a scan, process it, write surfaces and pictures
./do test     install what is needed, build, run all tests but the long ones
./do long     those that take a minute each: whole scans of other seeds and sizes; long turn: the eighth that CI takes at this revision
./do lab      boot Debian's kernel in qemu and test the drivers on virtual USB, HID and camera devices
./do build    build the program (build/release/app/dubsar)
./do peers    talk to VRPN, spacenavd, libspnav and opentrack, as far as they are installed, and print a table
./do bench    run the benchmarks; ./do bench displays: only those of many views;
              ./do bench exa: bits and speed of the surface format, beside Draco and meshoptimizer
              ./do bench paper [--size XxYxZ] [--no-ao]: Table 2 of the paper line by line, per core too
              ./do bench stages [--size N] [--no-meshlab]: every stage on one core beside VTK, ITK, Embree and MeshLab
              ./do bench linear: four sizes, how cost grows; exit code 1 where an exponent is off 1.0 by more than .1
              ./do bench killed: kill -9 at 20 random moments, then --resume; exit code 1 where bytes differ
              ./do bench scanner [--size XxYxZ] [--memory 6G]: a scan larger than memory, 3072x3072x1944 by default
              ./do bench wedges [--quick | --size XxYxZ] [--seed N]: what is read of a hidden tablet, beside what is wanted
              ./do bench ablation [--size XxYxZ] [--seed N] [--seeds COUNT]: what each rule of the contact is worth, with the spread
              ./do bench invariance [--seeds N]: the same object cropped, mirrored, with axes exchanged: how far answers lie apart
              ./do bench script [--size XxYxZ] [--seed N] [--seeds COUNT] [--depth VOXELS] [--scanner WORDS] [--unruled] [--unwritten] [--causes]: wedges that are
                  found and drawn, beside what was pressed (--help says all options); --causes counts what was missed, by place and by cause
              ./do bench seals [--size XxYxZ] [--seed N] [--seeds COUNT] [--lost SHARE]: the average of three impressions, beside the best of them
              ./do bench crossings FILE.exa...: pairs of triangles that cross or touch, partition by partition
              ./do bench wedges --scanner [--size XxYxZ] [--seed N] [--seeds COUNT]: the same of scans with an X-ray scanner's artefacts
              ./do bench light: from the start of a kiosk to its first picture, 1.6 million vertices on 48 views
              ./do bench view: first pictures, pictures a second and memory, beside f3d and MeshLab
./do workflow examples/snakemake: a dry run, and three scans for real; workflow core: with the program of a core build
./do models   fetch the networks for hands and faces from a webcam (docs/webcam.md)
./do glb FILE...  the Khronos validator over GLB files (fetches it with npm)
./do asan     the tests under AddressSanitizer and UndefinedBehaviorSanitizer, windows and pictures too; asan core devices
              input display app program core/exa app/kiosk: of these only (program: what runs dubsar itself); asan turn: the part that
              CI takes at this revision; and what ctest takes, as asan devices -R Vrpn
./do tsan     devices and inputs under ThreadSanitizer (clang)
./do core     build and test the core alone, no graphics, no devices: build/core/app/dubsar has process, info, exa, phantom
./do lint     is every source formatted, and clang-tidy over what changed since the last commit (or since REVISION)
./do deps     install the packages of Debian 12 that dubsar needs
./do visitors [SEED [OF_EACH_KIND [why]]]   naive visitors before the kiosk, simulated: how many turn, zoom, open
./do soak [HOURS [MINUTES [SURFACE]]]   a day of the kiosk: 8 simulated hours, 30 minutes of drawing, a fault a minute
./do strips   make the strips of pictures in docs/ again (minutes)
./do pictures make the other pictures of docs/ again, from docs/scripts (minutes)
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

glb() {
  command -v npm >/dev/null || deps npm
  local here=$PWD
  (cd "${OLDPWD:-.}" && "$here/docs/scripts/validate_glb.sh" "$@")  # names of files are those of the caller
}

models() {
  command -v npm >/dev/null || deps npm
  input/tracking/vision/fetch_models.sh "$@"
}

# Without it the device lab is skipped and says why.
lab_kernel() {
  tests/lab/fetch_kernel.sh build/lab/kernel
}

run_tests() {
  deps
  (models --photographs --timeout 60) || echo "do: going on without; tests that need networks or photographs are skipped" >&2
  (deps "${lab_packages[@]}") || true
  lab_kernel || true
  build_target
  ctest --test-dir "$build" --output-on-failure -j $((jobs + 1)) -LE '^long$' "$@"  # some wait, for clocks or for other programs
}

# Every case of the label long, or every eighth of them, others at each revision.
long() {
  local every=()
  if [ "${1:-}" = turn ]; then
    every=(-I "$(($(revision_number) % 8 + 1)),,8")
    shift
  fi
  deps
  build_target
  ctest --test-dir "$build" --output-on-failure -j "$jobs" -L '^long$' "${every[@]}" "$@"
}

lab() {
  deps "${lab_packages[@]}"
  lab_kernel || { echo "do lab: there is no kernel to boot" >&2; exit 69; }
  build_target --target test_lab
  tests/lab/run_in_kernel.sh "$PWD/$build/tests/lab/test_lab" "$@"
}

# What the sanitized suite is made of: folders of tests/, of tests/core/ and of tests/app/, and what runs the program. CI takes one line a
# revision: each builds what its own cases need, and those of a large folder take turns, every fourth case at a time.
sanitized_parts=(
  "core/base core/image_io core/hdf5 core/mesh"
  "core/volume core/filter"
  "core/phantom core/relief core/refine"
  "core/extract core/rays core/parts core/compare"
  "core/contact"
  "core/script core/edition core/seals"
  "core/exa core/mesh_io"
  "core/pipeline"
  "devices"
  "input"
  "display -I 1,,2"
  "display -I 2,,2"
  "app/commands app/session app/cli app/slices app/additions"
  "app/kiosk"
  "app/panels app/words app/monitor app/calibration app/publish"
  "app/viewer -I 1,,2"
  "app/viewer -I 2,,2"
  "program -I 1,,4"
  "program -I 2,,4"
  "program -I 3,,4"
  "program -I 4,,4"
)

# One more at each revision; made of the revision's name where the checkout does not know how many came before.
revision_number() {
  if [ "$(git rev-parse --is-shallow-repository 2>/dev/null)" = false ]; then
    git rev-list --count HEAD
  else
    echo $((16#$(git rev-parse --short=7 HEAD 2>/dev/null || echo 0)))
  fi
}

part_of_revision() {
  echo "${sanitized_parts[$(revision_number) % ${#sanitized_parts[@]}]}"
}

# The cases of `test`, less those that need a kernel of their own, a preloaded library or most of an hour. asan ROOM...: of these parts only,
# asan turn: of the one whose turn it is; words for ctest may follow, as `-R Leap`.
asan() {
  local rooms=() room folder labels
  if [ "${1:-}" = turn ]; then
    room=$(part_of_revision)
    set -- $room "${@:2}"
    echo "do asan: the turn of $room" >&2
  fi
  deps
  preset=asan build=build/asan
  while [[ "${1:-}" =~ ^((core|app)(/[a-z0-9_]+)?|devices|input|display|program)$ ]]; do
    rooms+=("$1")
    shift
  done
  [ ${#rooms[@]} -gt 0 ] || rooms=(core devices input display app program)
  local targets=("${rooms[@]/#/dubsar_checked_}")
  targets=("${targets[@]/%/_tests}")
  targets=("${targets[@]//\//_}")
  cmake --preset "$preset" >/dev/null
  cmake --build "$build" -j "$jobs" --target "${targets[@]}"
  # No detect_stack_use_after_return: g++ 12 does not align its stand-in frames for the 64-byte registers of AVX-512.
  export ASAN_OPTIONS="strict_string_checks=1:${ASAN_OPTIONS:-}" UBSAN_OPTIONS="print_stacktrace=1:${UBSAN_OPTIONS:-}"
  export LSAN_OPTIONS="suppressions=$PWD/tests/leaks_of_others.txt:print_suppressions=0:${LSAN_OPTIONS:-}"
  for room in "${rooms[@]}"; do
    labels=(-L '^(unit|gl|replay)$')
    folder=$room
    case "$room" in
      program) labels=(-L '^app$') folder=app ;;
      app/*) labels+=(-L "^$room$") folder=app ;;
    esac
    ctest --test-dir "$build/tests/$folder" --output-on-failure -j $((jobs + 1)) "${labels[@]}" "$@"
  done
}

core() {
  deps
  preset=core build=build/core
  build_target
  ctest --test-dir "$build" --output-on-failure -j "$jobs" -L '^unit$' "$@"
}

lint() {
  deps clang-format clang-tidy
  git ls-files '*.cpp' '*.h' | xargs clang-format --dry-run --Werror
  local since=${1:-HEAD~1} changed
  git rev-parse -q --verify "$since" >/dev/null || return 0  # a checkout without history
  build=build/lint  # file by file; clang cannot read the precompiled headers of g++
  cmake --preset ci -B "$build" -DDUBSAR_UNITY=OFF -DDUBSAR_TEST_PCH=OFF >/dev/null
  changed=$(git diff --name-only --diff-filter=AM "$since" -- '*.cpp' | head -n "${LINT_FILES:-12}")
  [ -z "$changed" ] ||
    xargs -n 1 -P "$jobs" clang-tidy -p "$build" --quiet --extra-arg=-Wno-unknown-warning-option --warnings-as-errors='*' <<<"$changed"
}

peers() {
  deps
  (deps spacenavd) || true  # VRPN and opentrack are not in Debian 12
  build_target --target dubsar
  tests/peers/run.sh "$build/app/dubsar"
}

tsan() {
  deps clang libclang-rt-14-dev libomp-dev
  preset=tsan build=build/tsan
  build_target --target test_devices test_leap test_leapc test_input test_input_plugins test_input_sources
  local test
  for test in devices/test_devices devices/leap/test_leap devices/leap/test_leapc input/test_input input/plugins/test_input_plugins input/sources/test_input_sources; do
    TSAN_OPTIONS="halt_on_error=1 ${TSAN_OPTIONS:-}" "$build/tests/$test" --gtest_brief=1
  done
}

bench() {
  deps
  if [ "${1:-}" = exa ]; then
    (deps libdraco-dev libzstd-dev) || echo "do: going on without Draco and meshoptimizer beside it" >&2
    build_target --target dubsar exa_bench test_exa
    local folder=$build/bench-exa app=$build/app/dubsar missed=0
    mkdir -p "$folder"
    # The demo's phantom with so much noise that the surfaces of the paper's chain have 28 and 23 dB; the demo itself.
    [ -e "$folder/scan28.h5" ] || "$app" phantom "$folder/scan28.h5" --preset demo --snr 14.3 -q >/dev/null
    [ -e "$folder/scan23.h5" ] || "$app" phantom "$folder/scan23.h5" --preset demo --snr 16.8 -q >/dev/null
    [ -e "$folder/scan.h5" ] || "$app" phantom "$folder/scan.h5" --preset demo -q >/dev/null
    local bare=(--detail half --sharpen 0 --segment none --no-ao -q)
    "$app" process "$folder/scan28.h5" -o "$folder/phantom28.exa" --iterations 1 "${bare[@]}" >/dev/null
    "$app" process "$folder/scan23.h5" -o "$folder/phantom23.exa" --iterations 0 "${bare[@]}" >/dev/null
    "$app" process "$folder/scan.h5" -o "$folder/demo.exa" -q >/dev/null
    "$app" process "$folder/scan.h5" -o "$folder/demo_open.exa" --detail half --no-fill-holes -q >/dev/null
    "$app" exa stat "$folder/demo.exa"
    # Speeds are processor time: threads that wait must sleep, not spin.
    OMP_WAIT_POLICY=passive "$build/tests/bench/exa_bench" --paper "$folder/demo_open.exa" --large "$folder/phantom28.exa" "$folder/phantom23.exa" "$folder/demo.exa" || missed=1
    echo "500 random volumes, 100,000 flipped bits with and without repaired sums, every truncation, extra bytes, wrong versions, lying headers:"
    DUBSAR_SOAK=1 "$build/tests/core/exa/test_exa" --gtest_filter='ExaSoak.*:ExaFile.EveryTruncation*:ExaFile.LaterVersions*:ExaFile.HeadersThatLie*:ExaFile.BricksThatCode*'
    [ "$missed" = 0 ] || echo "do: a goal of the surface format is missed, see above" >&2
    return "$missed"
  fi
  if [ "${1:-}" = light ]; then
    deps xvfb xdotool
    build_target --target dubsar
    local folder=$build/bench-light app=$build/app/dubsar
    mkdir -p "$folder"
    [ -e "$folder/scan.h5" ] || "$app" phantom "$folder/scan.h5" --preset demo -q >/dev/null
    [ -e "$folder/demo.exa" ] || "$app" process "$folder/scan.h5" -o "$folder/demo.exa" -q >/dev/null
    /usr/bin/python3 tests/bench/first_light.py "$app" "$folder/demo.exa" --json "$build/first_light.json" "${@:2}"
    return
  fi
  if [ "${1:-}" = view ]; then
    (deps f3d meshlab xdotool) || echo "do: going on without f3d and MeshLab beside it" >&2
    build_target --target dubsar
    /usr/bin/python3 tests/bench/view_bench.py "$build/app/dubsar" --json "$build/view_bench.json" "${@:2}"
    return
  fi
  if [ "${1:-}" = stages ]; then
    (deps python3-vtk9 libinsighttoolkit5-dev meshlab xvfb xauth) || echo "do: going on without VTK, ITK and MeshLab beside it" >&2
    build_target --target stage_bench
    build_target --target itk_stages || echo "do: ITK is not there" >&2
    /usr/bin/python3 tests/bench/stage_bench.py "$build/tests/bench/stage_bench" --itk "$build/tests/bench/itk_stages" \
      --json "$build/bench_stages.json" --history "$build/bench_history.jsonl" "${@:2}"
    return
  fi
  case "${1:-}" in
    paper | linear | killed | scanner)
      build_target --target dubsar
      [ "$1" != scanner ] || build_target --target scanner_scan
      /usr/bin/python3 tests/bench/paper_bench.py "$build/app/dubsar" "$1" --maker "$build/tests/bench/scanner_scan" \
        --json "$build/bench_$1.json" --history "$build/bench_history.jsonl" "${@:2}"
      return ;;
  esac
  if [ "${1:-}" = invariance ]; then
    build_target --target dubsar
    /usr/bin/python3 tests/bench/invariance_bench.py "$build/app/dubsar" "$build/bench-invariance" "${@:2}"
    return
  fi
  if [ "${1:-}" = wedges ]; then
    build_target --target wedges_bench
    "$build/tests/bench/wedges_bench" "${@:2}"
    return
  fi
  if [ "${1:-}" = ablation ]; then
    build_target --target ablation_bench
    "$build/tests/bench/ablation_bench" "${@:2}"
    return
  fi
  if [ "${1:-}" = script ] || [ "${1:-}" = seals ]; then
    build_target --target "$1_bench"
    "$build/tests/bench/$1_bench" "${@:2}"
    return
  fi
  if [ "${1:-}" = crossings ]; then
    build_target --target crossing_rows
    "$build/tests/bench/crossing_rows" "${@:2}"
    return
  fi
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
  "$dubsar" render "$out/tablet.exa" -o "$out/tablet.png" --partition tablet --style raking --light 315,20
  "$dubsar" render "$out/tablet.exa" -o "$out/envelope.png" --view orbit
  "$dubsar" fatcross "$out/tablet.exa" -o "$out/fatcross.tif"
  if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then
    echo "the tablet in a window: drag to turn, F1 for help, Escape to end" >&2
    "$dubsar" view "$out/tablet.exa" --partition tablet || echo "do: the surfaces and pictures are in $out/, a window could not be shown" >&2
  fi
}

# The workflow of examples/snakemake: a dry run, a run of three scans, and one that finds nothing to do.
workflow() {
  deps snakemake
  local made=6 reports=true
  if [ "${1:-}" = core ]; then
    preset=core build=build/core made=3 reports=false
  fi
  build_target --target dubsar
  local dubsar=$PWD/$build/app/dubsar work=$PWD/$build/workflow seed
  rm -rf "$work" && mkdir -p "$work/scans"
  cp -r examples/snakemake/. "$work"
  for seed in 1 2 3; do
    "$dubsar" phantom "$work/scans/tablet_$seed.h5" --size 160x112x144 --seed "$seed" -q >/dev/null
  done
  local settings=(--directory "$work" --snakefile "$work/Snakefile" --config "dubsar=$dubsar" "threads=$jobs" "reports=$reports" "options=--ao-rays 16")
  snakemake --dry-run --quiet "${settings[@]}"
  snakemake --cores "$jobs" "${settings[@]}"
  ls -l "$work/surfaces"
  [ "$(ls "$work"/surfaces | grep -cE '\.exa$|_report\.html$')" = "$made" ]
  snakemake --cores "$jobs" "${settings[@]}" 2>&1 | tee "$work/again.log"
  grep -q "Nothing to be done" "$work/again.log"
}

# Figures of 500 simulated people who were never told, before the kiosk as it is; another SEED, other people.
visitors() {
  deps
  cmake --preset "$preset" >/dev/null
  cmake --build "$build" -j "$jobs" --target naive_visitors
  "$build/tests/app/naive_visitors" "$@"
}

soak() {
  deps
  cmake --preset "$preset" >/dev/null
  cmake --build "$build" -j "$jobs" --target soak
  "$build/tests/app/soak" "$@"
}

# Those of sessions are made anew by a test, too, and compared.
pictures() {
  deps ghostscript imagemagick python3-h5py
  build_target --target dubsar
  local dubsar=$build/app/dubsar work=$build/strips
  mkdir -p "$work"
  [ -f "$work/scan.h5" ] || "$dubsar" phantom "$work/scan.h5" --preset demo
  [ -f "$work/tablet.exa" ] || "$dubsar" process "$work/scan.h5" -o "$work/tablet.exa"
  "$dubsar" render "$work/tablet.exa" -o docs/tablet.png --partition tablet --style raking --light 315,20 --size 900x900
  "$dubsar" render "$work/tablet.exa" -o docs/msii.png --partition tablet --style msii --size 900x900
  "$dubsar" fatcross "$work/tablet.exa" -o docs/fatcross.png --dpi 240 --no-sides
  docs/scripts/make_handcopy_pictures.sh "$dubsar" docs ${DUBSAR_S264:+"$DUBSAR_S264"}
  docs/scripts/make_pictures.sh "$dubsar" docs
  docs/scripts/make_contact_pictures.sh "$dubsar" docs
}

strips() {
  deps
  cmake --preset "$preset" >/dev/null
  cmake --build "$build" -j "$jobs" --target dubsar make_strips make_gallery_strips
  local dubsar=$build/app/dubsar work=$build/strips
  mkdir -p "$work"
  [ -f "$work/scan.h5" ] || "$dubsar" phantom "$work/scan.h5" --preset demo
  if [ "${1:-gallery}" = gallery ]; then
    [ -f "$work/half.exa" ] || "$dubsar" process "$work/scan.h5" -o "$work/half.exa" --detail half
    "$build/tests/app/make_gallery_strips" "$work/half.exa" docs/scripts/gallery.json docs
  fi
  if [ "${1:-}" != gallery ]; then
    [ -f "$work/tablet.exa" ] || "$dubsar" process "$work/scan.h5" -o "$work/tablet.exa"
    "$dubsar" export "$work/tablet.exa" "$work/tablet.ply" --partition tablet
    "$build/tests/app/make_strips" "$work/tablet.ply" docs/scripts docs "$@"
  fi
}

verb=${1:-}
[ $# -gt 0 ] && shift
case "$verb" in
  demo) demo "$@" ;;
  test) run_tests "$@" ;;
  long) long "$@" ;;
  lab) lab "$@" ;;
  build) deps; build_target --target dubsar "$@" ;;
  bench) bench "$@" ;;
  asan) asan "$@" ;;
  peers) peers ;;
  tsan) tsan ;;
  core) core "$@" ;;
  lint) lint "$@" ;;
  models) models "$@" ;;
  glb) glb "$@" ;;
  deps) deps ;;
  strips) strips "$@" ;;
  visitors) visitors "$@" ;;
  soak) soak "$@" ;;
  workflow) workflow "$@" ;;
  pictures) pictures ;;
  format) git ls-files '*.cpp' '*.h' | xargs clang-format -i ;;
  *) usage; [ -z "$verb" ] || [ "$verb" = help ] || exit 64 ;;
esac
