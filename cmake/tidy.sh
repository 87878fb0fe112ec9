#!/bin/sh
# What clang 14 has to say: the warnings of its front end on every translation unit of a compilation database, and the
# checks of clang-tidy on the entry points and the host.
#   cmake/tidy.sh BUILD_DIRECTORY
# The build has to be configured for clang, with warnings as errors and without precompiled headers; nothing in it needs
# to have been built.
set -eu
cd "$(dirname "$0")/.."
database=$1/compile_commands.json

echo "-- warnings of clang"
# Each command of the database, unescaped, with the front end only.
sed -n 's/^ *"command": "\(.*\)",$/\1/p' "$database" | grep '\.cpp$' |
    sed -e 's/\\\(.\)/\1/g' -e 's/ -o [^ ]* -c / -fsyntax-only -c /' |
    tr '\n' '\0' | xargs -0 -P "$(nproc)" -I '{}' sh -c '{}'

echo "-- clang-tidy"
# The analyzer is for what lives in other people's programs; it would take minutes on the host.
git ls-files 'umat/*.cpp' 'fortran_shims/*.cpp' |
    xargs -P "$(nproc)" -n 2 clang-tidy-14 -p "$1" --quiet --warnings-as-errors='*' 2>/dev/null
git ls-files 'host/*.cpp' |
    xargs -P "$(nproc)" -n 2 clang-tidy-14 -p "$1" --quiet --warnings-as-errors='*' --checks='-clang-analyzer-*' 2>/dev/null
