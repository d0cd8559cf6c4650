#!/usr/bin/env bash
# The Khronos glTF validator over GLB files: fetched once with npm, its SHA-512 compared. Exit status 65 when a file has
# errors. It does not know EXT_meshopt_compression: of compressed files it checks everything but the compressed bytes.
# usage: validate_glb.sh FILE.glb ...
set -euo pipefail
[ $# -gt 0 ] || { echo "glb: name the GLB files to check" >&2; exit 64; }
for tool in npm node; do
  command -v $tool >/dev/null || { echo "glb: $tool is missing (apt install npm)" >&2; exit 69; }
done
name=gltf-validator version=2.0.0-dev.3.10
sum=a1d278934b519065e20c69fbf320c183e7c16c022f0675f187747002d6b47a64b11adc9a80513c078c442c1d6861edd2e510fc0a2dee640b1969ab1c1f62c011
folder=${XDG_CACHE_HOME:-${HOME:-/nonexistent}/.cache}/dubsar/$name-$version
if [ ! -f "$folder/package/index.js" ]; then
  mkdir -p "$folder" && work=$(mktemp -d "$folder/fetch.XXXXXX") || exit 73
  trap 'rm -rf "$work"' EXIT
  (cd "$work" && npm pack --loglevel=error "$name@$version" >/dev/null 2>log) ||
    { echo "glb: $name@$version could not be fetched: $(grep -m 1 'ERR!' "$work/log" || echo 'no answer')" >&2; exit 69; }
  echo "$sum  $work/$name-$version.tgz" | sha512sum --check --status ||
    { echo "glb: what npm gave is not the $name@$version that was expected: its SHA-512 differs" >&2; exit 65; }
  tar -xzf "$work/$name-$version.tgz" -C "$folder"
fi
node -e '
const validator = require(process.argv[1]), fs = require("fs");
(async () => {
  let errors = 0;
  for (const file of process.argv.slice(2)) {
    const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), {maxIssues: 20});
    const {numErrors, numWarnings, messages} = report.issues;
    console.log(`${file}: ${numErrors} errors, ${numWarnings} warnings; ${report.info?.totalVertexCount ?? 0} vertices, ` +
                `${report.info?.totalTriangleCount ?? 0} triangles`);
    for (const m of messages) console.log(`  ${m.code} ${m.pointer ?? ""}: ${m.message}`);
    errors += numErrors;
  }
  process.exit(errors ? 65 : 0);
})().catch(error => { console.error("glb: " + error); process.exit(65); });
' "$folder/package" "$@"
