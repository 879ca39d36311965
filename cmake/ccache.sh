#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: ccache.sh CCACHE COMPILER ARGUMENT...
# Compiles by ccache. A header that is precompiled anew loses its old form first: ccache would preprocess with that, find nothing
# changed and bring the old form back. Comments count: GCC knows a header with "#pragma once" again by all its bytes, and would
# read it twice where the precompiled form is of other comments.
for argument in "$@"; do
    case $argument in
        *.gch)
            rm -f -- "$argument"
            export CCACHE_COMMENTS=1
            ;;
    esac
done
exec "$@"
