#!/usr/bin/env bash
# Boots Debian's kernel in qemu with this machine's files as a read-only root and runs one program inside as root: there
# virtual HID, USB and camera devices are real to it. Nothing on this machine is changed.
# usage: run_in_kernel.sh PROGRAM [ARGUMENT...]
# exit: that of PROGRAM; 77 with the reason when the lab cannot run here; 70 when the kernel did not get to its end
# environment: LAB_KERNEL (folder made by fetch_kernel.sh; build/lab/kernel), LAB_SECONDS (limit, 240),
#              LAB_ACCEL (kvm or tcg; found out), LAB_CPUS (1: emulated threads wait for each other least on one)
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
kernel=${LAB_KERNEL:-$(dirname "$(dirname "$here")")/build/lab/kernel}
seconds=${LAB_SECONDS:-240}

skip() {
  echo "device lab: skipped: $1" >&2
  exit 77
}

[ $# -gt 0 ] || { echo "usage: run_in_kernel.sh PROGRAM [ARGUMENT...]" >&2; exit 64; }
for tool in qemu-system-x86_64 busybox cpio setpriv; do
  command -v "$tool" >/dev/null || skip "$tool is missing: ./do lab installs it"
done
[ -r "$kernel/complete" ] || skip "there is no kernel in $kernel: ./do lab fetches it"

work=$(mktemp -d "${TMPDIR:-/tmp}/dubsar-lab.XXXXXX")
qemu=
clean_up() {
  [ -z "$qemu" ] || kill "$qemu" 2>/dev/null || true
  rm -rf "$work"
}
trap clean_up EXIT
trap 'exit 130' INT
trap 'exit 143' TERM HUP

mkdir -p "$work"/ram/{bin,proc,sys,dev}
cp "$(command -v busybox)" "$work/ram/bin/busybox"
install -m 755 "$here/init" "$work/ram/init"
cp -r "$kernel/modules" "$kernel/order" "$work/ram/"
printf 'cd %q && exec env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 %s\n' "$PWD" "$(printf '%q ' "$@")" \
  >"$work/ram/command"
(cd "$work/ram" && find . | cpio -o -H newc --quiet >"$work/ram.cpio")

# boot ACCELERATOR CPU SECONDS_TO_START: runs it all, or gives up when the kernel has not even started in that time. qemu
# ends with us, however we end; the limit covers a kernel that hangs.
boot() {
  : >"$work/status"
  rm -f "$work/talk"
  mkfifo "$work/talk"  # qemu makes its stdout non-blocking, which must not be ours
  cat "$work/talk" &
  local reader=$!
  setpriv --pdeathsig TERM timeout --kill-after=5 "$seconds" setpriv --pdeathsig KILL \
    qemu-system-x86_64 -accel "$1" -cpu "$2" -smp "${LAB_CPUS:-1}" -m 1536 -nodefaults -display none -no-reboot \
    -kernel "$kernel/vmlinuz" -initrd "$work/ram.cpio" -append "console=ttyS0 panic=-1 quiet dubsar.lab" \
    -serial "file:$work/kernel.log" -chardev stdio,id=talk,signal=off -serial chardev:talk -serial "file:$work/status" \
    -virtfs local,path=/,mount_tag=host,security_model=none,readonly=on,multidevs=remap \
    </dev/null >"$work/talk" 2>"$work/qemu.log" &
  qemu=$!
  local until=$((SECONDS + $3))
  until grep -q up "$work/status" || ! kill -0 "$qemu" 2>/dev/null || [ "$SECONDS" -ge "$until" ]; do sleep 0.3; done
  grep -q up "$work/status" || kill "$qemu" 2>/dev/null || true
  wait "$qemu" 2>/dev/null || true
  wait "$reader" || true
  qemu=
}

exit_status() { sed -n 's/^exit //p' "$work/status" | tr -d '\r'; }

# Nested virtualisation is often there and broken, at once or later: then everything is emulated.
accel=${LAB_ACCEL:-}
status=
if [ "$accel" != tcg ] && [ -w /dev/kvm ]; then
  boot kvm host 20 2>/dev/null  # bash announces aborts
  status=$(exit_status)
fi
if [ -z "$status" ] && [ "$accel" != kvm ]; then
  boot tcg max "$seconds" 2>/dev/null
  status=$(exit_status)
fi

if [ -z "$status" ]; then
  {
    echo "device lab: the kernel did not get to its end within $seconds s"
    tail -n 5 "$work/qemu.log"
    tail -n 30 "$work/kernel.log"
  } >&2 || true
  exit 70
fi
exit "$status"
