#!/usr/bin/env bash
# Sets the machine up, builds, and draws the error-against-run-time report of the built-in scenes.
set -euo pipefail
cd "$(dirname "$0")"
.ci/setup build
[ -f build/build.ninja ] || meson setup build >build-setup.log || { cat build-setup.log; exit 1; }
rm -f build-setup.log
ninja -C build
build/samples/afterglow report cornell atrium --size 256x256 --budget quick -o build/report
echo "The report: $PWD/build/report/report.html"
