#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Build and pass all tests: kernels and small scenes in Debug, where deal.II checks
# every access, and everything in Release.
# Usage: ./test.sh [--quick]      --quick: the Release tests of the inner loop only
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")"
if [ $# -gt 1 ] || { [ $# -eq 1 ] && [ "$1" != "--quick" ]; }; then
  echo "Usage: ./test.sh [--quick]" >&2
  exit 1
fi

./demo.sh --install-only

# one more than the cores, as tests of several processes wait for each other
jobs=$(($(nproc) + 1))

# Usage: build PRESET TARGET [SETTING]...
build() {
  local preset=$1 target=$2
  shift 2
  echo "Building $preset"
  cmake --preset "$preset" "$@" >/dev/null
  cmake --build --preset "$preset" --target "$target"
}

build release all
if [ "${1:-}" = "--quick" ]; then
  exec ctest --test-dir build/release -L quick -j "$jobs" --output-on-failure
fi
build debug debug_programs -DEXEMPLAR_OPTIMISED_BUILD="$PWD/build/release"
ctest --test-dir build/debug -L debug -j "$jobs" --output-on-failure
ctest --test-dir build/release -j "$jobs" --output-on-failure
