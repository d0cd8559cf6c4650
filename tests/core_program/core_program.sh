#!/bin/bash
# core_program.sh PROGRAM: what a core build is for. Exit code 1, with a line, where something is not so.
set -euo pipefail
program=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() { echo "core program: $*" >&2; exit 1; }

libraries=$(ldd "$program")
for library in libGL libEGL libepoxy libglfw libX11 libusb libhidapi libopencv libopenxr; do
  ! grep -q "$library" <<<"$libraries" || fail "needs $library"
done

help=$("$program" --help)
for verb in phantom process info exa wedges handcopy; do
  grep -Eq "^ +$verb " <<<"$help" || fail "has no verb $verb"
done
rc=0
"$program" view 2>/dev/null || rc=$?
[ "$rc" = 64 ] || fail "view: exit code $rc found, 64 expected"

mkdir "$work/scans"
for seed in 1 2; do
  "$program" phantom "$work/scans/tablet_$seed.h5" --size 96x64x80 --seed "$seed" -q >/dev/null
done
"$program" process "$work/scans" -o "$work/surfaces" --no-ao -q --progress none >/dev/null
"$program" exa verify "$work/surfaces/tablet_1.exa" >/dev/null
cp "$work/surfaces/tablet_2.exa" "$work/before.exa"
rm "$work/surfaces/tablet_2.exa"
"$program" process "$work/scans" -o "$work/surfaces" --no-ao -q --progress none --resume >/dev/null
cmp "$work/before.exa" "$work/surfaces/tablet_2.exa" || fail "--resume made other bytes"

text=$("$program" process "$work/scans/tablet_1.h5" -o "$work/one.exa" --no-ao -q --progress none)
! grep -q "dubsar view" <<<"$text" || fail "advises a verb that it has not"
"$program" info "$work/one.exa" | grep -q . || fail "info says nothing"
"$program" wedges "$work/one.exa" -o "$work/one.csv" -q --progress none >/dev/null
grep -q "^id,side,column,line,order,kind,head_x," "$work/one.csv" || fail "wedges has another first row"
for kind in svg pdf dxf; do
  "$program" handcopy "$work/one.exa" -o "$work/one.$kind" -q --progress none >/dev/null
  [ -s "$work/one.$kind" ] || fail "handcopy wrote no $kind"
  "$program" handcopy "$work/one.exa" -o "$work/one.$kind" -q --progress none >/dev/null || fail "handcopy keeps its own $kind"
done
rc=0
"$program" wedges "$work/one.exa" -o "$work/one.txt" -q 2>/dev/null || rc=$?
[ "$rc" = 64 ] || fail "wedges: exit code $rc found, 64 expected"
