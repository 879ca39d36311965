#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: ccache.sh CCACHE COMPILER ARGUMENT...
# Compiles by ccache. A header that is precompiled anew loses its old form first: ccache would preprocess with that, find nothing
# changed and bring the old form back.
for argument in "$@"; do
    case $argument in
        *.gch) rm -f -- "$argument" ;;
    esac
done
exec "$@"
