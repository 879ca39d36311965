# SPDX-License-Identifier: GPL-3.0-or-later
"""install.py ZIP: installs the extension as Preferences > Get Extensions > Install from Disk does, with its wheel."""

from __future__ import annotations

import sys
from pathlib import Path

import bpy  # first: it brings the other

import addon_utils  # isort: skip

NAME = "bl_ext.user_default.hairloom"

addon_utils.enable("bl_pkg", default_set=False, persistent=True)
bpy.context.preferences.system.use_online_access = False
print(bpy.ops.extensions.package_install_files(filepath=str(Path(sys.argv[1]).resolve()), repo="user_default", enable_on_install=True))
if NAME not in {one.module for one in bpy.context.preferences.addons}:
    addon_utils.enable(NAME, default_set=True, persistent=True)
import hairloom  # noqa: E402, the wheel that came with it

home = Path(bpy.utils.resource_path("USER")).resolve()
if home not in Path(hairloom.__file__).resolve().parents:
    raise SystemExit(f"hairloom comes from {hairloom.__file__}, not from the extension in {home}")
module = sys.modules[f"{NAME}.module"]
if wrong := module.problem():
    raise SystemExit(wrong)
bpy.ops.wm.save_userpref()
print(f"ok   the extension is on, with the module {hairloom.__file__}")
