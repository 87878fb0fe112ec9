#!/bin/sh
# Compiles by ccache.
#   cmake/cached.sh CCACHE COMPILER ARGUMENTS...
# What ccache compares is what the preprocessor reads, and of a header that has been precompiled before, that is the old
# result, whatever has changed since: it has to go first.
set -eu
previous=
for argument; do
    [ "$previous" != -o ] || case $argument in *.gch | *.pch) rm -f "$argument" ;; esac
    previous=$argument
done
# Without this it would not store what uses precompiled headers.
CCACHE_SLOPPINESS=pch_defines,time_macros exec "$@"
