"""Draws charge.svg: curtains of charged filaments beside each other, from the side.

    for q in 0.01 1 3; do spunlaid web cases/web_shared.toml --set web.width="0.2 m" --set web.length="0.2 m" \
        --set line.charge="$q µC/g" --no-advice --out results/charge_$q; done
    python docs/images/charge.py results/charge_0.01 results/charge_1 results/charge_3 docs/images/charge.svg

A web without charge does not say where its filaments hang, so the first one has a charge that does nothing.
"""

import json
import sys

PANEL, HEIGHT = 240, 400
"""Size of a curtain [px]."""
LEFT, TOP = 60, 40
WIDE = 0.15
"""Half the width of a panel along the machine direction [m]."""
LIGHT, DARK = "#a9cbe8", "#3f86c0"


def panel(folder, x0):
    with open(f"{folder}/summary.json", encoding="utf-8") as file:
        heights = json.load(file)["charge"][0]["heights"]
    with open(f"{folder}/web.toml", encoding="utf-8") as file:
        charge = next(line.split('"')[1] for line in file if line.startswith("charge ="))
    number, unit = charge.split()
    number = float(number) * {"C/kg": 1e3, "µC/g": 1.0, "nC/g": 1e-3}[unit]
    belt = heights[-1]["x_m"]
    across = lambda y: x0 + PANEL / 2 * (1 + y / WIDE)
    down = lambda x: TOP + HEIGHT * x / belt

    def band(low, high, colour):
        there = [f"{across(h['md_m'][low]):.1f},{down(h['x_m']):.1f}" for h in heights]
        back = [f"{across(h['md_m'][high]):.1f},{down(h['x_m']):.1f}" for h in reversed(heights)]
        return f'<polygon points="{" ".join(there + back)}" fill="{colour}"/>'

    def text(x, y, words, anchor="middle"):
        return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}">{words}</text>'

    parts = [band(0, 4, LIGHT), band(1, 3, DARK)]
    parts.append(text(x0 + PANEL / 2, TOP - 14, f"{number:g} µC/g"))
    parts.append(f'<rect x="{x0}" y="{TOP}" width="{PANEL}" height="{HEIGHT}" fill="none" stroke="#555"/>')
    for y in (-0.1, 0.0, 0.1):
        parts.append(f'<path d="M{across(y):.1f} {TOP + HEIGHT}v5" stroke="#555"/>')
        parts.append(text(across(y), TOP + HEIGHT + 20, f"{1e3 * y:g}".replace("-", "−")))
    return parts, belt


def main():
    *folders, out = sys.argv[1:]
    parts = []
    for number, folder in enumerate(folders):
        drawn, belt = panel(folder, LEFT + number * (PANEL + 16))
        parts += drawn
    width = LEFT + len(folders) * (PANEL + 16)
    for share in (0, 0.25, 0.5, 0.75, 1):
        y = TOP + HEIGHT * share
        parts.append(f'<path d="M{LEFT - 5} {y}h5" stroke="#555"/>')
        parts.append(f'<text x="{LEFT - 8}" y="{y + 4}" text-anchor="end">{1e3 * belt * share:g}</text>')
    middle = TOP + HEIGHT / 2
    parts.append(f'<text transform="translate(14 {middle}) rotate(-90)" text-anchor="middle">Distance from the inlet (mm)</text>')
    parts.append(f'<text x="{(LEFT + width) / 2}" y="{TOP + HEIGHT + 42}" text-anchor="middle">Position in machine direction (mm)</text>')
    size = f'width="{width}" height="{TOP + HEIGHT + 54}"'
    with open(out, "w", encoding="utf-8") as file:
        file.write(f'<svg xmlns="http://www.w3.org/2000/svg" {size} font-family="sans-serif" font-size="13">\n')
        file.write(f'<rect {size} fill="white"/>\n' + "\n".join(parts) + "\n</svg>\n")


main()
