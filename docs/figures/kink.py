#!/usr/bin/env python3
"""Draws kink.svg from the table of ../fracture.md: the first kink against the edge length. No arguments."""
import math
import pathlib
import re

HERE = pathlib.Path(__file__).parent
WIDTH, HEIGHT, LEFT, GAP, TOP, BOTTOM = 340, 300, 60, 70, 40, 80
X_RANGE = (math.log10(25), math.log10(2.5))  # mm, finer to the right
PANELS = {"opening": ("pure opening", (-40, 40), 20, 0.0), "shear": ("pure shear", (-90, -10), 20, -70.53)}
RULES = {"hoop": ("#1b6ca8", "maximum hoop, fitted"), "one tet": ("#c8553d", "one tet, ahead only"),
         "letter": ("#8a8a8a", "one tet, to the letter (thesis)")}


def read_rows():
    for line in (HERE.parent / "fracture.md").read_text().splitlines():
        cells = [cell.strip() for cell in line.split("|")[1:-1]]
        if len(cells) == 6 and cells[0] in PANELS and re.fullmatch(r"[\d.]+", cells[2]):
            yield cells[0], cells[1].startswith("cut"), float(cells[2]), [float(cell) for cell in cells[3:]]


def main():
    rows = list(read_rows())
    assert len(rows) == 38, f"the table has changed its shape: {len(rows)} rows"
    total = 2 * WIDTH + LEFT + GAP + 20
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {total} {HEIGHT + TOP + BOTTOM}" '
           'font-family="sans-serif" font-size="12">', '<rect width="100%" height="100%" fill="white"/>']
    for panel, (mode, (title, (low, high), every, truth)) in enumerate(PANELS.items()):
        left = LEFT + panel * (WIDTH + GAP)

        def x(edge):
            return left + WIDTH * (math.log10(edge) - X_RANGE[0]) / (X_RANGE[1] - X_RANGE[0])

        def y(angle):
            return TOP + HEIGHT * (high - angle) / (high - low)

        out.append(f'<rect x="{left}" y="{TOP}" width="{WIDTH}" height="{HEIGHT}" fill="none" stroke="black"/>')
        out.append(f'<text x="{left}" y="{TOP - 10}" font-weight="bold">{title}: first kink, degrees</text>')
        for edge in (20, 10, 5, 3):
            out.append(f'<text x="{x(edge):.0f}" y="{TOP + HEIGHT + 18}" text-anchor="middle">{edge}</text>')
        for angle in range(low, high + 1, every):
            out.append(f'<text x="{left - 6}" y="{y(angle) + 4:.0f}" text-anchor="end">{angle}</text>')
            out.append(f'<path d="M{left} {y(angle):.1f}h{WIDTH}" stroke="#ddd"/>')
        out.append(f'<path d="M{left} {y(truth):.1f}h{WIDTH}" stroke="black" stroke-dasharray="4 3"/>')
        if truth:
            out.append(f'<text x="{left + 4}" y="{y(truth) + 16:.0f}">{truth:.1f}</text>')
        out.append(f'<text x="{left + WIDTH / 2}" y="{TOP + HEIGHT + 36}" text-anchor="middle">mean edge, mm</text>')
        for rule, colour in reversed(list(enumerate(colour for colour, _ in RULES.values()))):
            for row_mode, cut, edge, angles in rows:
                if row_mode != mode:
                    continue
                at = f'cx="{x(edge):.1f}" cy="{y(angles[rule]):.1f}"'
                if cut:
                    out.append(f'<rect x="{x(edge) - 4:.1f}" y="{y(angles[rule]) - 4:.1f}" width="8" height="8" '
                               f'fill="none" stroke="{colour}" stroke-width="1.5"/>')
                else:
                    out.append(f'<circle {at} r="3.5" fill="{colour}" fill-opacity="0.8"/>')
    place = LEFT
    for colour, name in RULES.values():
        out.append(f'<circle cx="{place}" cy="{TOP + HEIGHT + 62}" r="4" fill="{colour}"/>')
        out.append(f'<text x="{place + 9}" y="{TOP + HEIGHT + 66}">{name}</text>')
        place += 32 + 6.6 * len(name)
    out.append(f'<circle cx="{place}" cy="{TOP + HEIGHT + 62}" r="3.5" fill="black"/>')
    out.append(f'<text x="{place + 9}" y="{TOP + HEIGHT + 66}">flanks are faces</text>')
    out.append(f'<rect x="{place + 116}" y="{TOP + HEIGHT + 58}" width="8" height="8" fill="none" stroke="black"/>')
    out.append(f'<text x="{place + 130}" y="{TOP + HEIGHT + 66}">cut</text>')
    out.append("</svg>")
    (HERE / "kink.svg").write_text("\n".join(out) + "\n")


if __name__ == "__main__":
    main()
