# SPDX-License-Identifier: GPL-3.0-or-later
"""Puts the peers' results into one file, one picture, and the table of docs/accuracy.md."""
import argparse
import csv
import glob
import math
import os

import scene

OURS = "Hairloom"
COLOURS = {OURS: "#0072B2", "Blender": "#D55E00", "PyElastica": "#009E73", "Newton": "#CC79A7"}
BEGIN, END = "<!-- peers: ./dev peers writes this -->", "<!-- end of the peers -->"
LEFT, TOP, RIGHT, BOTTOM, WIDTH, HEIGHT = 84, 38, 660, 472, 860, 560


def number(row, column):
    return float(row[column])


def cheapest(rows, error_mm):
    """The row that is at least as exact for the least time, or None."""
    enough = [row for row in rows if number(row, "error_rms_mm") <= error_mm]
    return min(enough, key=lambda row: number(row, "ms_per_frame"), default=None)


def factors(rows, ours):
    """How many times less ours costs at each row's error; None where ours is nowhere so exact."""
    found = [(row, cheapest(ours, number(row, "error_rms_mm"))) for row in rows]
    return [(row, own and number(row, "ms_per_frame") / number(own, "ms_per_frame")) for row, own in found]


def short(value):
    """Two digits, as people write them."""
    if value >= 10:
        return f"{float(f'{value:.2g}'):,.0f}"
    if value == 0 or value >= 1e-3:
        return f"{value:.2g}"
    digits, power_of_ten = f"{value:.1e}".split("e-")
    return digits + "·10⁻" + "".join("⁰¹²³⁴⁵⁶⁷⁸⁹"[int(c)] for c in str(int(power_of_ten)))


def read(folder):
    rows = []
    for path in sorted(glob.glob(os.path.join(folder, "*.csv"))):
        with open(path, newline="") as file:
            rows += csv.DictReader(file)
    rows.sort(key=lambda row: (list(COLOURS).index(row["peer"]), number(row, "ms_per_frame")))
    return rows


def text(x, y, words, size=12, anchor="middle", colour="#222222", more=""):
    return f'<text x="{x:.2f}" y="{y:.2f}" font-size="{size}" text-anchor="{anchor}" fill="{colour}"{more}>{words}</text>'


def line(x1, y1, x2, y2, colour, more=""):
    return f'<path d="M{x1:.2f} {y1:.2f}L{x2:.2f} {y2:.2f}" fill="none" stroke="{colour}"{more}/>'


def decades(values):
    return math.floor(math.log10(min(values))), math.ceil(math.log10(max(values)))


def power(k):
    return str(10**k) if 0 <= k < 3 else f'10<tspan dy="-4.8" font-size="9.6">{str(k).replace("-", "−")}</tspan>'


def label_of(row):
    return row["setting"].replace("substeps", "").replace("substep", "").replace("steps", "").replace(" ", "")


def labels(points):
    """Beside each point (x, y, words, colour) where there is room; a point without room goes without."""
    taken = [(x - 4, y - 4, x + 4, y + 4) for x, y, _, _ in points]
    parts = []
    for x, y, words, colour in points:
        wide = 6.5 * len(words)
        for left, base in ((x + 8, y - 4), (x - 8 - wide, y + 12), (x - wide / 2, y - 9), (x - wide / 2, y + 18), (x + 8, y + 12)):
            box = (left, base - 9, left + wide, base + 1)
            if all(box[2] < a or c < box[0] or box[3] < b or d < box[1] for a, b, c, d in taken):
                taken.append(box)
                parts.append(text(left, base, words, 11, "start", colour,
                                  ' stroke="#ffffff" stroke-width="3" stroke-linejoin="round" paint-order="stroke"'))
                break
    return parts


def picture(rows, path):
    finite = [row for row in rows if math.isfinite(number(row, "error_rms_mm"))]
    x0, x1 = decades([number(row, "ms_per_frame") for row in finite])
    y0, y1 = decades([number(row, column) for row in finite for column in ("error_rms_mm", "doubt_mm")])

    def x_of(ms):
        return LEFT + (math.log10(ms) - x0) / (x1 - x0) * (RIGHT - LEFT)

    def y_of(mm):
        return BOTTOM - (math.log10(mm) - y0) / (y1 - y0) * (BOTTOM - TOP)

    title = "Others on the same axes: time per frame against error"
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{HEIGHT}" viewBox="0 0 {WIDTH} {HEIGHT}" role="img" '
             f'aria-label="{title}" font-family="Helvetica, Arial, \'Liberation Sans\', \'DejaVu Sans\', sans-serif">',
             f'<rect width="{WIDTH}" height="{HEIGHT}" fill="#ffffff"/>', text(12, 26, title, 15, "start", more=' font-weight="bold"')]
    for k in range(x0, x1 + 1):
        parts += [line(x_of(10**k), TOP, x_of(10**k), BOTTOM, "#e2e2e2"), text(x_of(10**k), BOTTOM + 19, power(k))]
    for k in range(y0, y1 + 1):
        parts += [line(LEFT, y_of(10**k), RIGHT, y_of(10**k), "#e2e2e2"), text(LEFT - 9, y_of(10**k) + 4, power(k), anchor="end")]
    parts.append(f'<rect x="{LEFT}" y="{TOP}" width="{RIGHT - LEFT}" height="{BOTTOM - TOP}" fill="none" stroke="#666666"/>')
    points = []
    for s, (peer, colour) in enumerate(COLOURS.items()):
        own = [row for row in finite if row["peer"] == peer]
        if not own:
            continue
        spots = [(x_of(number(row, "ms_per_frame")), y_of(number(row, "error_rms_mm")), row) for row in own]
        doubt = y_of(number(own[0], "doubt_mm"))
        parts.append(line(max(spots[0][0] - 20, LEFT), doubt, min(spots[-1][0] + 20, RIGHT), doubt, colour,
                          ' stroke-width="1.2" stroke-dasharray="6 4"'))
        way = "L".join(f"{x:.2f} {y:.2f}" for x, y, _ in spots)
        parts.append(f'<path d="M{way}" fill="none" stroke="{colour}" stroke-width="1.6"/>')
        for x, y, row in spots:
            tip = f'{peer}, {row["setting"]}: {row["ms_per_frame"]} ms, {row["error_rms_mm"]} mm rms, {row["error_max_mm"]} mm at most'
            parts.append(f'<circle cx="{x:.2f}" cy="{y:.2f}" r="4" fill="{colour}" stroke="#ffffff" stroke-width="0.8">'
                         f"<title>{tip}</title></circle>")
            points.append((x, y, label_of(row), colour))
        parts += [line(RIGHT + 22, TOP + 9 + 22 * s, RIGHT + 46, TOP + 9 + 22 * s, colour, ' stroke-width="2"'),
                  text(RIGHT + 54, TOP + 13 + 22 * s, f'{peer} {own[0]["version"]}', anchor="start")]
    parts += labels(points)
    below = TOP + 9 + 22 * len(COLOURS)
    parts += [line(RIGHT + 22, below, RIGHT + 46, below, "#666666", ' stroke-width="1.2" stroke-dasharray="6 4"'),
              text(RIGHT + 54, below + 4, "uncertainty of its reference", anchor="start"),
              text((LEFT + RIGHT) / 2, BOTTOM + 39, "processor time per frame of 300 strands (ms)", 13),
              text(24, (TOP + BOTTOM) / 2, "error against its own converged run, rms (mm)", 13,
                   more=f' transform="rotate(-90 24 {(TOP + BOTTOM) / 2})"'),
              text(12, 534, "Labels: substeps or steps a frame of 1/60 s, × iterations where there are any. Left is fast, down is accurate.",
                   anchor="start", colour="#555555"),
              text(12, 549, f'{rows[0]["machine"]}, {rows[0]["date"]}.', anchor="start", colour="#555555"), "</svg>"]
    with open(path, "w") as file:
        file.write("\n".join(parts) + "\n")


def sentence(peer, rows, ours):
    known = [(row, factor) for row, factor in factors(rows, ours) if math.isfinite(number(row, "error_rms_mm"))]
    reached = [(row, factor) for row, factor in known if factor]
    beyond = [row for row, factor in known if not factor]
    words = [f"- **{peer}**:"]
    if reached:
        few, many = (short(pick(factor for _, factor in reached)) for pick in (min, max))
        words.append(f"at the same error or less, ours costs {few if few == many else f'{few} to {many}'} times less.")
        close = [row["setting"] for row, factor in reached if factor < 10]
        if close:
            words.append(f"It is less than ten times at {', '.join(close)}.")
    if beyond:
        best = min(ours, key=lambda row: number(row, "error_rms_mm"))
        words.append(f"{'At' if reached else 'at'} {' and '.join(row['setting'] for row in beyond)} it is more accurate "
                     f"({short(number(beyond[0], 'error_rms_mm'))} mm) than ours at any setting here "
                     f"({short(number(best, 'error_rms_mm'))} mm), for "
                     f"{short(number(beyond[0], 'ms_per_frame') / number(best, 'ms_per_frame'))} times the time.")
    return " ".join(words)


def table(rows):
    lines = ["| simulator | setting, a frame of 1/60 s | ms per frame | error against its own reference, mm: rms, largest | "
             "stretch, %: mean, largest | cantilever error, mm |", "|---|---|---|---|---|---|"]
    for row in rows:
        cells = [f"{row['peer']} {row['version']}", row["setting"]]
        for columns in (["ms_per_frame"], ["error_rms_mm", "error_max_mm"], ["stretch_mean_percent", "stretch_max_percent"],
                        ["cantilever_mm"]):
            cells.append(", ".join(short(number(row, column)) for column in columns))
        lines.append(f"| {' | '.join(cells)} |")
    of = {peer: [row for row in rows if row["peer"] == peer] for peer in COLOURS}
    truths = [f"{peer} {own[0]['converged']}, {short(number(own[0], 'doubt_mm'))} mm" for peer, own in of.items() if own]
    load = max(number(row, "load") for row in rows)
    busy = f", a busy machine (load {load:.0f})" if load > 1.5 else ""
    lines += ["", f"{scene.STRANDS} strands, {rows[0]['machine']}{busy}, {rows[0]['date']}. Reference of each, and its distance from the "
              f"next best run: {', '.join(truths)}.", ""]
    for peer, own in of.items():
        if not own:
            lines.append(f"- **{peer}** was not run: it could not be had for a Python of this machine.")
        elif peer != OURS:
            lines.append(sentence(peer, own, of[OURS]))
    return "\n".join(lines)


def main():
    options = argparse.ArgumentParser(description=__doc__)
    options.add_argument("folder", help="with a CSV of each simulator")
    options.add_argument("--results", required=True, help="CSV to write")
    options.add_argument("--picture", required=True, help="SVG to write")
    options.add_argument("--page", required=True, help="Markdown whose part between marks is written anew")
    asked = options.parse_args()
    rows = read(asked.folder)
    with open(asked.results, "w", newline="") as file:
        writer = csv.DictWriter(file, scene.COLUMNS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    picture(rows, asked.picture)
    with open(asked.page) as file:
        page = file.read()
    begin, end = page.index(BEGIN) + len(BEGIN), page.index(END)
    with open(asked.page, "w") as file:
        file.write(page[:begin] + "\n" + table(rows) + "\n" + page[end:])


if __name__ == "__main__":
    main()
