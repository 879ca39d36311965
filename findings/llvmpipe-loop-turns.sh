#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# usage: findings/llvmpipe-loop-turns.sh
# Mesa's software Vulkan device (mesa-vulkan-drivers 22.3.6, llvmpipe) gives a shader invocation 65,535 turns for all its loops
# together, not for each: once they are used up every loop ends at its next turn, and the shader goes on as if its condition had
# ended it. No error, no validation message, and vkGetPhysicalDeviceProperties names no such limit. A turn of an outer loop counts
# beside those of the inner. What runs right in a test of each loop alone is wrong when two follow one another.
# Counts the turns of one loop, then of two nested ones, by wgpu 0.29.0 (PyPI). Fails if a count is another one.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
apt-get download -qq mesa-vulkan-drivers=22.3.6-1+deb12u2
dpkg -x mesa-vulkan-drivers_*.deb root
sed "s#\"library_path\": \".*\"#\"library_path\": \"$folder/root/usr/lib/x86_64-linux-gnu/libvulkan_lvp.so\"#" \
    root/usr/share/vulkan/icd.d/lvp_icd.x86_64.json > lvp.json
export VK_ICD_FILENAMES=$folder/lvp.json
python3 -m venv venv
venv/bin/pip install --quiet wgpu==0.29.0 numpy==2.2.6
cat > turns.py <<'CODE'
import sys

import numpy
import wgpu

SHADER = """
@group(0) @binding(0) var<storage, read> asked: array<u32>;
@group(0) @binding(1) var<storage, read_write> found: array<u32>;
@compute @workgroup_size(1) fn main() {
    var first = 0u;
    var second = 0u;
    for (var i = 0u; i < asked[0]; i++) { first += 1u; }
    for (var i = 0u; i < asked[1]; i++) {
        for (var k = 0u; k < asked[2]; k++) { second += 1u; }
    }
    found[0] = first;
    found[1] = second;
}"""
adapter = next(a for a in wgpu.gpu.enumerate_adapters_sync()
               if a.info["adapter_type"] == "CPU" and a.info["backend_type"] == "Vulkan")
print(adapter.info["description"])
device = adapter.request_device_sync()
pipeline = device.create_compute_pipeline(
    layout="auto", compute={"module": device.create_shader_module(code=SHADER), "entry_point": "main"})


def turns(*asked):
    source = device.create_buffer_with_data(data=numpy.array(asked, numpy.uint32), usage=wgpu.BufferUsage.STORAGE)
    target = device.create_buffer(size=8, usage=wgpu.BufferUsage.STORAGE | wgpu.BufferUsage.COPY_SRC)
    group = device.create_bind_group(layout=pipeline.get_bind_group_layout(0), entries=[
        {"binding": 0, "resource": {"buffer": source}}, {"binding": 1, "resource": {"buffer": target}}])
    encoder = device.create_command_encoder()
    work = encoder.begin_compute_pass()
    work.set_pipeline(pipeline)
    work.set_bind_group(0, group)
    work.dispatch_workgroups(1)
    work.end()
    device.queue.submit([encoder.finish()])
    return tuple(int(n) for n in numpy.frombuffer(device.queue.read_buffer(target), numpy.uint32))


failed = False
for asked, expected in (((70000, 0, 0), (65535, 0)), ((30000, 1, 30000), (30000, 30000)), ((60000, 1, 60000), (60000, 5534)),
                        ((60000, 100, 100), (60000, 5426)), ((0, 100000, 1), (0, 21845))):
    found = turns(*asked)
    print(f"first loop {asked[0]:6} turns, then {asked[1]:6} of {asked[2]:5}: found {found[0]:6} and {found[1]:6}")
    if found != expected:
        print(f"error: expected {expected}", file=sys.stderr)
        failed = True
sys.exit(failed)
CODE
venv/bin/python turns.py 2> messages.txt || { grep '^error: expected\|Error' messages.txt >&2; exit 1; }
