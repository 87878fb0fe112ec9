#!/bin/sh
# Compiles by ccache.
#   cmake/cached.sh CCACHE COMPILER ARGUMENTS...
# What ccache compares is what the preprocessor reads, and of a header that has been precompiled before, that is the old
# result, whatever has changed since: it has to go first. And a change of a comment counts, since the compiler knows the
# headers in the result by their text: there it is the files that have to be compared (`depend` mode).
set -eu
previous=
for argument; do
    if [ "$previous" = -o ]; then
        case $argument in *.gch | *.pch)
            rm -f "$argument"
            export CCACHE_DEPEND=1
            ;;
        esac
    fi
    previous=$argument
done
# Without this it would not store what uses precompiled headers.
CCACHE_SLOPPINESS=pch_defines,time_macros exec "$@"
