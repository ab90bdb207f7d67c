#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Build and pass the tests.
# Usage: ./test.sh [--quick|--full]
#   without   in Release, what a change can break
#   --quick   of these the inner loop only
#   --full    all tests, as the gate does: in Release everything, and kernels and small scenes in Debug, where deal.II
#             checks every access
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")"
label=change
case "$*" in
  "") ;;
  --quick) label=quick ;;
  --full) label=full ;;
  *) echo "Usage: ./test.sh [--quick|--full]" >&2; exit 1 ;;
esac

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
if [ "$label" = full ]; then
  build debug debug_programs -DEXEMPLAR_OPTIMISED_BUILD="$PWD/build/release"
  ctest --test-dir build/debug -L debug -j "$jobs" --output-on-failure
fi
ctest --test-dir build/release -L "$label" -j "$jobs" --output-on-failure
