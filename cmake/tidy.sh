#!/bin/sh
# What clang 14 has to say: the warnings of its front end on every translation unit of a compilation database, and the
# checks of clang-tidy on the entry points and the host.
#   cmake/tidy.sh BUILD_DIRECTORY
# The build has to be configured for clang, with warnings as errors; nothing in it needs to have been built.
set -eu
cd "$(dirname "$0")/.."
root=$(pwd)
cd "$1"

# run PATTERN [COMMAND OF SED]...: the commands of the database, unescaped, whose file matches.
run() {
    pattern=$1
    shift
    sed -n 's/^ *"command": "\(.*\)",$/\1/p' compile_commands.json | grep -E -e "$pattern" |
        sed -e 's/\\\(.\)/\1/g' "$@" | tr '\n' '\0' | xargs -0 -P "$(nproc)" -I '{}' sh -c '{}'
}
# tidy PATTERN [OPTION]...: clang-tidy, which repeats the warnings of the front end, on the files of the database that
# match. It looks at all that is included, so that more of it than a source asks for costs time.
mkdir -p plain
sed 's/ -Xclang -include\(-pch\)\? -Xclang [^ ]*//g' compile_commands.json >plain/compile_commands.json
tidy() {
    pattern=$1
    shift
    sed -n 's/^ *"file": "\(.*\)"[^"]*$/\1/p' compile_commands.json | grep -E -e "$pattern" | sort -u |
        xargs -P "$(nproc)" -n 2 clang-tidy-14 -p plain --quiet --warnings-as-errors='*' "$@" 2>/dev/null
}

echo "-- precompiled headers"
sed -n 's/.* -o \([^ ]*\)\/cmake_pch\.hxx\.pch .*/\1/p' compile_commands.json | xargs mkdir -p
run '\.hxx\.cxx$'

echo "-- warnings of clang"
host="^($root|$PWD)/host/.*(\.cpp|_cxx\.cxx)\$" # files, or several of them in one
run '(\.cpp|_cxx\.cxx)$' -e "\\# $root/\\(host\\|umat\\|fortran_shims\\)/[^ ]*\$#d" -e "\\# $PWD/host/[^ ]*\$#d" \
    -e 's/ -o [^ ]* -c / -fsyntax-only -c /'

echo "-- clang-tidy and warnings of the entry points and the host"
# The analyzer is for what lives in other people's programs; it would take minutes on the host.
tidy "^$root/(umat|fortran_shims)/.*\\.cpp\$"
tidy "$host" --checks='-clang-analyzer-*'
