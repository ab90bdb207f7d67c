#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# Install what is missing, build exemplar and drag a cat with its examples and without. --install-only also installs what pip, the
# pages and some tests need, if that is to be had.
# Usage: ./demo.sh [--install-only]
set -euo pipefail
usage="Usage: ./demo.sh [--install-only]"
case "$*" in
  "" | --install-only) ;;
  -h | --help) echo "$usage"; exit 0 ;;
  *) echo "$usage" >&2; exit 1 ;;
esac
cd "$(dirname "$(readlink -f "$0")")"

packages=(git g++ cmake ninja-build libdeal.ii-dev libsuitesparse-dev libopenblas0-pthread
          libmuparser-dev libcli11-dev libfmt-dev nlohmann-json3-dev libssl-dev zlib1g-dev libseccomp-dev libopenmpi-dev
          openmpi-bin libgtest-dev libxsimd-dev libboost-dev libjs-three python3 python3-dev python3-numpy pybind11-dev gnuplot-nox help2man)
packages_for_tests=(blender clang python3-pip python3-venv python3-wheel python3-matplotlib python3-scipy mypy doxygen mkdocs mkdocs-material
                    python3-pymdownx libjs-katex chromium chromium-driver python3-selenium)

# Install those of some packages that are missing; end the script if that fails.
install_missing() {
  local wanted=("$@")
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    echo "No Debian package manager here. exemplar needs what these Debian packages hold: ${wanted[*]}"
    return
  fi
  local missing=() package
  for package in "${wanted[@]}"; do
    dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q ' ok installed' ||
      missing+=("$package")
  done
  [ ${#missing[@]} -eq 0 ] && return
  local run_as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null; then
      echo "Packages are missing and there is no right to install them. As root, run:" >&2
      echo "  apt-get install --no-install-recommends ${missing[*]}" >&2
      exit 1
    fi
    run_as_root=(sudo)
  fi
  echo "Installing ${missing[*]}"
  # a broken source among others need not keep these packages from us
  "${run_as_root[@]}" apt-get update -qq || true
  if ! "${run_as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null; then
    echo "These packages are missing and could not be installed: ${missing[*]}" >&2
    exit 1
  fi
}

install_missing "${packages[@]}"
if [ "${1:-}" = "--install-only" ]; then
  # in a shell of its own, for what fails here only leaves out tests
  (install_missing "${packages_for_tests[@]}") || echo "Tests that need them are left out."
  exit 0
fi

# what this scene needs, where nothing more is built already
preset=release
if [ ! -e build/release/CMakeCache.txt ] || grep -q "^EXEMPLAR_SCENES_ONLY:BOOL=ON" build/release/CMakeCache.txt; then
  preset=scenes
fi
echo "Building (a few minutes the first time)"
cmake --preset $preset >/dev/null
cmake --build --preset $preset --target exemplar

build/release/exemplar prm/demo.prm --output output/with_examples
build/release/exemplar prm/demo.prm --set Examples/Importance=0 --output output/without_examples
build/release/exemplar export output/with_examples output/without_examples --html output/demo.html
echo
echo "See both move side by side, in any browser: file://$PWD/output/demo.html"
echo "The frames are in $PWD/output/with_examples and without_examples."
echo "Open animation.pvd there in ParaView (Debian: apt-get install paraview), press Apply, then Play:"
echo "  paraview $PWD/output/with_examples/animation.pvd"
echo "Pull the cat with the mouse, from $PWD (the first line builds the rest of exemplar, which takes minutes):"
echo "  cmake --preset release && cmake --build --preset release"
echo "  build/release/exemplar live prm/live/cat.prm"
