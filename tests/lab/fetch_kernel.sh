#!/usr/bin/env bash
# Puts Debian's own kernel and the few modules that the device lab needs into FOLDER (10 MB); installs nothing.
# usage: fetch_kernel.sh FOLDER        exit 0: it is there; 77: it cannot be had, with the reason
set -euo pipefail
export PATH="$PATH:/usr/sbin:/sbin"
folder=${1:?usage: fetch_kernel.sh FOLDER}
modules=(virtio_pci 9pnet_virtio 9p overlay uhid usbhid hid_generic vhci_hcd uvcvideo vivid)

skip() {
  echo "device lab: $1" >&2
  exit 77
}

[ "$(cat "$folder/complete" 2>/dev/null)" = "${modules[*]}" ] && exit 0
[ "$(uname -m)" = x86_64 ] || skip "this machine is $(uname -m), the lab's kernel is for x86_64"
for tool in apt-get apt-cache dpkg-deb depmod modprobe; do
  command -v "$tool" >/dev/null || skip "$tool is missing, expected Debian with the package kmod"
done

newest_kernel() { apt-cache depends linux-image-amd64 2>/dev/null | awk '/Depends: linux-image-[0-9]/ {print $2; exit}'; }
package=$(newest_kernel)
if [ -z "$package" ] && [ "$(id -u)" -eq 0 ]; then
  apt-get update -qq >/dev/null 2>&1 || true
  package=$(newest_kernel)
fi
[ -n "$package" ] || skip "apt knows no package linux-image-amd64: run apt-get update"

mkdir -p "$(dirname "$folder")"
work=$(mktemp -d "$folder.XXXXXX")
trap 'rm -rf "$work"' EXIT
echo "device lab: fetching $package (70 MB)" >&2
# the package lists may be older than the archive
(cd "$work" && apt-get download "$package" >log 2>&1) ||
  { [ "$(id -u)" -eq 0 ] && apt-get update -qq >/dev/null 2>&1 && (cd "$work" && apt-get download "$package" >log 2>&1); } ||
  skip "$package cannot be fetched: $(grep -m1 '^E:' "$work/log" || echo 'apt-get download failed')"

mkdir "$work/all" "$work/kernel" "$work/kernel/modules"
dpkg-deb --fsys-tarfile "$work/$package"_*.deb | tar -x -C "$work/all" ./boot ./lib/modules
version=$(ls "$work/all/lib/modules")
depmod -b "$work/all" "$version"
for module in "${modules[@]}"; do
  modprobe -d "$work/all" -S "$version" --show-depends "$module" || echo "missing $module"
done >"$work/wanted" 2>/dev/null
! grep '^missing' "$work/wanted" >&2 || skip "kernel $version lacks a module that the lab needs"
awk '$1 == "insmod" && !seen[$2]++ {print $2}' "$work/wanted" | while read -r file; do
  cp "$file" "$work/kernel/modules/"
  basename "$file"
done >"$work/kernel/order"
cp "$work/all/boot/vmlinuz-$version" "$work/kernel/vmlinuz"
echo "$version" >"$work/kernel/version"
echo "${modules[*]}" >"$work/kernel/complete"
rm -rf "$folder"
mv "$work/kernel" "$folder"
