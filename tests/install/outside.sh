#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A host and a plugin outside of the tree, built against the installed package and run with it.
#
#     outside.sh BUILD    installs from there to a folder elsewhere
set -eu
source=$PWD
root=$(mktemp -d)
trap 'rm -rf "$root"' EXIT
meson install -C "$1" --no-rebuild --destdir "$root" >"$root/install.log"
pc=$(find "$root" -name afterglow.pc)
libs=$(dirname "$(dirname "$pc")")
prefix=$(dirname "$(find "$root" -path '*/bin/afterglow')")/..
prefix=$(cd "$prefix" && pwd)
export PKG_CONFIG_PATH
PKG_CONFIG_PATH=$(dirname "$pc")
unset AFTERGLOW_PLUGIN_PATH LD_LIBRARY_PATH

echo "== a host"
cp tests/install/host.c "$root"
cd "$root" # from here on the source tree is not needed
# shellcheck disable=SC2046
cc -std=c11 -Wall -Werror host.c -o host $(pkg-config --cflags --libs afterglow) -Wl,-rpath,"$libs"
./host

echo "== what a shader includes is there"
shaders=$(pkg-config --variable=shaderdir afterglow)
missing=0
while IFS=: read -r file name; do
    [ -e "$(dirname "$file")/$name" ] || [ -e "$shaders/$name" ] || { echo "$file: no $name"; missing=1; }
done < <(grep -roP '^#include "\K[^"]+' "$shaders")
[ "$missing" = 0 ]

echo "== a plugin"
cp -r "$source/samples/out_of_tree" plugin
meson setup plugin/build plugin -Dwerror=true
ninja -C plugin/build
if grep -rlF "$source/" plugin/build --include='*.ninja' --include='*.d' --include='*.json' --include='*.txt'; then
    echo "these name the source tree"
    exit 1
fi
clang-tidy --config-file="$source/.clang-tidy" -p plugin/build --quiet plugin/screen.c

echo "== its picture"
afterglow=$prefix/bin/afterglow
frame() { # OUT options...: the indirect light
    local out=$1
    shift
    "$afterglow" render cornell --size 64x64 --layer indirect -o "$out" "$@" 2>&1 | tee -a warnings
}
frame none.pfm
frame screen.pfm --plugin-dir plugin/build --gi screen
frame far.pfm --plugin-dir plugin/build --gi screen --set reach=2 --set rays=64
frame open.pfm --plugin-dir plugin/build --gi screen --layer screen.open
# Half of one bounce is on the screen, and none of it twice.
"$afterglow" reference cornell --bounces 1 --spp 16 --size 64x64 --layer indirect -o truth.pfm
"$afterglow" compare far.pfm truth.pfm --json | tee far.json
python3 - <<'PYTHON'
import json, struct
def mean(name):
    data = open(name, 'rb').read().split(b'\n', 3)[3]
    values = struct.unpack('<%df' % (len(data) // 4), data)
    return sum(values) / len(values)
assert mean('none.pfm') == 0
assert mean('screen.pfm') > 0
assert 0 < mean('open.pfm') < 1
ratio = json.load(open('far.json'))['energy_ratio']
assert 0.3 < ratio < 1, ratio
assert not open('warnings').read()
PYTHON

echo "== installed beside the others"
meson install -C plugin/build >/dev/null
"$afterglow" plugins | grep -q '^screen$'

echo "== the document"
python3 "$source/tests/install/document.py" "$source/docs/writing-a-plugin.md" document.sh
mkdir document
(cd document && prefix=$prefix bash ../document.sh)
for file in mean.png radiance.png stats.json trace.json stability/stability.json; do
    test -s "document/mean/$file"
done
"$afterglow" compare document/mean/mine.exr document/mean/truth.exr --json | python3 -c '
import json, sys
ratio = json.load(sys.stdin)["energy_ratio"]
assert 0.2 < ratio < 5, ratio'

echo "== the plugin with Afterglow as a subproject"
mkdir -p whole/subprojects
cp "$source"/samples/out_of_tree/* whole
ln -s "$source" whole/subprojects/afterglow
unset PKG_CONFIG_PATH
meson setup whole/build whole --force-fallback-for=afterglow -Dafterglow:tests=false -Dafterglow:samples=false
ninja -C whole/build gi_screen.so.p/screen.c.o
