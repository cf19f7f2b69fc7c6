#!/usr/bin/env python3
"""Draws stabilisation.svg from the tables of ../stabilisation.md: the errors against beta mu / kappa. No arguments."""
import math
import pathlib
import re

HERE = pathlib.Path(__file__).parent
BODIES = {"bar4": "#1b6ca8", "cook8": "#c8553d", "foot6": "#3a7d44", "tube12": "#7b4b94"}
BETAS = [1, 10, 100, 1000]
WIDTH, HEIGHT, LEFT, GAP, TOP, BOTTOM = 360, 300, 60, 80, 40, 50
X_RANGE, Y_RANGES = (-4.5, 2.3), ((-1.3, 0.8), (-2.0, 0.6))


def read_rows():
    for line in (HERE.parent / "stabilisation.md").read_text().splitlines():
        cells = [cell.strip(" *") for cell in line.split("|")[1:-1]]
        if len(cells) == 19 and cells[0] in BODIES and re.fullmatch(r"0\.\d+", cells[1]):
            numbers = [float(cell) for cell in cells[2:17]]
            yield cells[0], float(cells[1]), numbers[0], numbers[1:7], numbers[9:15]


def alpha(beta, poisson):
    """beta mu / kappa."""
    return beta * 3 * (1 - 2 * poisson) / (2 * (1 + poisson))


def main():
    rows = list(read_rows())
    assert len(rows) == 4 * len(BODIES), "the tables have changed their shape"
    total = 2 * WIDTH + LEFT + GAP + 20
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {total} {HEIGHT + TOP + BOTTOM}" '
           'font-family="sans-serif" font-size="12">', '<rect width="100%" height="100%" fill="white"/>']
    for panel, (title, (low, high)) in enumerate(zip(("error of lambda", "error of u"), Y_RANGES)):
        left = LEFT + panel * (WIDTH + GAP)

        def x(a):
            return left + WIDTH * (math.log10(a) - X_RANGE[0]) / (X_RANGE[1] - X_RANGE[0])

        def y(e):
            return TOP + HEIGHT * (high - math.log10(e)) / (high - low)

        out.append(f'<rect x="{left}" y="{TOP}" width="{WIDTH}" height="{HEIGHT}" fill="none" stroke="black"/>')
        out.append(f'<text x="{left}" y="{TOP - 10}" font-weight="bold">{title}, relative</text>')
        for power in range(math.ceil(X_RANGE[0]), math.floor(X_RANGE[1]) + 1):
            out.append(f'<text x="{x(10 ** power):.0f}" y="{TOP + HEIGHT + 18}" text-anchor="middle">{10 ** power:g}</text>')
        for value in (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5):
            if low <= math.log10(value) <= high:
                out.append(f'<text x="{left - 6}" y="{y(value) + 4:.0f}" text-anchor="end">{value:g}</text>')
                out.append(f'<path d="M{left} {y(value):.1f}h{WIDTH}" stroke="#ddd"/>')
        out.append(f'<text x="{left + WIDTH / 2}" y="{TOP + HEIGHT + 38}" text-anchor="middle">beta mu / kappa</text>')
        out.append(f'<path d="M{x(3 / 16):.1f} {TOP}v{HEIGHT}" stroke="black" stroke-dasharray="4 3"/>')
        out.append(f'<text x="{x(3 / 16) + 4:.0f}" y="{TOP + HEIGHT - 8}">auto</text>')
        for row, (body, colour) in enumerate(BODIES.items()):
            points = sorted((alpha(beta, poisson), error) for name, poisson, auto, *errors in rows if name == body
                            for beta, error in zip(BETAS + [auto], errors[panel][1:]))
            inside = [(x(a), y(e)) for a, e in points if low <= math.log10(e) <= high]
            out.append(f'<polyline points="{" ".join(f"{a:.1f},{b:.1f}" for a, b in inside)}" fill="none" stroke="{colour}"/>')
            out += [f'<circle cx="{a:.1f}" cy="{b:.1f}" r="2.5" fill="{colour}"/>' for a, b in inside]
            out.append(f'<text x="{left + 12}" y="{TOP + HEIGHT - 60 + 15 * row}" fill="{colour}">{body}</text>')
    out.append("</svg>")
    (HERE / "stabilisation.svg").write_text("\n".join(out) + "\n")


if __name__ == "__main__":
    main()
