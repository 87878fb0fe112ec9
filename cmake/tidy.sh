#!/bin/sh
# clang-tidy over the sources that a compilation database knows: the entry points and the host.
#   cmake/tidy.sh BUILD_DIRECTORY
set -eu
cd "$(dirname "$0")/.."
git ls-files 'umat/*.cpp' 'host/*.cpp' 'host/replay/*.cpp' 'fortran_shims/*.cpp' |
    xargs -P "$(nproc)" -n 2 clang-tidy-14 -p "$1" --quiet --warnings-as-errors='*' 2>/dev/null
