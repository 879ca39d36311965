#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Runs a test on a display of its own.
exec xvfb-run -a -s "-screen 0 1600x1000x24" "$@"
