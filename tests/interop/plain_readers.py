# SPDX-License-Identifier: GPL-3.0-or-later
"""Yuksel .hair, TressFX 4, PLY and OBJ read as their pages say, by nothing of Hairloom's: a list of strands of (x, y, z)."""
import struct


def read_hair(path):
    data = open(path, "rb").read()
    magic, strands, points, bits, segments = struct.unpack_from("<4sIIII", data, 0)
    if magic != b"HAIR" or not bits & 2:
        raise ValueError("no .hair file with points")
    at = 128
    counts = [segments] * strands
    if bits & 1:
        counts = struct.unpack_from(f"<{strands}H", data, at)
        at += 2 * strands
    if sum(counts) + strands != points:
        raise ValueError(f"strands of {sum(counts) + strands} points; the head says {points}")
    values = struct.unpack_from(f"<{3 * points}f", data, at)
    return split([values[3 * i:3 * i + 3] for i in range(points)], [count + 1 for count in counts])


def read_tfx(path):
    data = open(path, "rb").read()
    version, strands, vertices, positions, uvs = struct.unpack_from("<fIIII", data, 0)
    if version != 4.0:
        raise ValueError(f"version {version}")
    if uvs != positions + 16 * strands * vertices or uvs + 8 * strands > len(data):
        raise ValueError("sections leave a gap or go beyond the end")
    values = struct.unpack_from(f"<{4 * strands * vertices}f", data, positions)
    points = [values[4 * i:4 * i + 3] for i in range(strands * vertices)]
    return split(points, [vertices] * strands)


def read_ply(path):
    data = open(path, "rb").read()
    head, body = data.split(b"end_header\n", 1)
    counts = {words[1]: int(words[2]) for words in map(str.split, head.decode().splitlines()) if words[0] == "element"}
    floats = head.count(b"property float")
    points = [struct.unpack_from("<3f", body, 4 * floats * i) for i in range(counts["vertex"])]
    strands, at = [], 4 * floats * counts["vertex"]
    for _ in range(counts["strand"]):
        count, = struct.unpack_from("<I", body, at)
        strands.append([points[i] for i in struct.unpack_from(f"<{count}I", body, at + 4)])
        at += 4 + 4 * count
    if at != len(body):
        raise ValueError(f"{len(body) - at} bytes follow the last strand")
    return strands


def read_obj_lines(path):
    points, strands = [], []
    for line in open(path):
        words = line.split()
        if words and words[0] == "v":
            points.append(tuple(map(float, words[1:4])))
        elif words and words[0] == "l":
            strands.append([points[int(index) - 1] for index in words[1:]])
    return strands


def read_obj_c4d(path):
    """Ribbons by their faces: each joins two cross-sections, whose first vertex is the strand's."""
    points, strands, last = [], [], None
    for line in open(path):
        words = line.split()
        if words and words[0] == "v":
            points.append(tuple(map(float, words[1:4])))
        elif words and words[0] == "f":
            left, right, right_next, left_next = map(int, words[1:])
            if (right, right_next) != (left + 1, left_next + 1):
                raise ValueError(f"a face joins {left}, {right}, {right_next} and {left_next}")
            if left != last:
                strands.append([points[left - 1]])
            strands[-1].append(points[left_next - 1])
            last = left_next
    if 2 * sum(map(len, strands)) != len(points):
        raise ValueError(f"ribbons of {sum(map(len, strands))} cross-sections; there are {len(points)} vertices")
    return strands


def split(points, counts):
    strands, at = [], 0
    for count in counts:
        strands.append(points[at:at + count])
        at += count
    if at != len(points):
        raise ValueError(f"curves of {at} points; there are {len(points)}")
    return strands
