"""Rows of filaments, one behind the other in the quench air: `expected_rows.csv` of a folder of cases.

    curtain.py FOLDER

The air of every row lives on heights 5 mm apart and on the rows of the profile, linear between them. What a row
leaves to the next one is T_a + m q/(ρ_a v_c c_pa) and u - m f_t/(ρ_a v_c), with ρ_a at the T_a of the row itself. That grows
without bound where the cross flow ends, so there are two readings, both written down:

- cut: nothing is exchanged where v_c is below 0.45 of its largest value;
- relaxed: the air goes towards the temperature and speed of the filament as 1 - exp(-x) in place of x, and nothing
  is exchanged where v_c is zero. For small x this is the same, and the air never overtakes the filament.
"""

import csv
import math
import sys
import warnings
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

from reference import air_density, read
import tomllib

HEAT_OF_AIR = 1006.0  # J/(kg K)


def rows_of(path, relaxed, rtol=1e-8):
    with open(path, "rb") as file:
        case = tomllib.load(file)["spinline"]
    rows, per_metre = case["rows"], case["filaments_per_metre_and_row"]
    line = read(path)
    stations = line.stations
    z = np.unique(np.concatenate([line.heights, np.linspace(0, line.length, 321)]))
    line.set_air(z, *[np.interp(z, line.heights, column) for column in line.air_rows])
    line.stations = stations  # The integration need not stop at every 5 mm.
    diameters, force = [], None

    def shot_at(x):
        return line.shoot(math.exp(x), rtol)

    for _ in range(rows):
        if force is None:
            force = math.log(line.solve(rtol).force)
        else:
            low, high = force - 0.02, force + 0.02
            while line.miss(shot_at(low)) > 0:
                low -= 0.1
            while line.miss(shot_at(high)) < 0:
                high += 0.02
            force = brentq(lambda x: line.miss(shot_at(x)), low, high, xtol=1e-12)
        shot = shot_at(force)
        diameters.append(2 * math.sqrt(line.flow / (math.pi * line.m["solid_density"] * math.exp(shot.end[0]))))
        u, across, ta = line.air_rows
        v, t = (np.array([value(height) for height in z]) for value in (shot.speed, shot.temperature))
        r = [shot.radius(height) for height in z]
        heat = np.array([line.heat_loss(*place) for place in zip(z, t, v, r)])
        pull = np.array([line.friction(*place) for place in zip(z, v, r)])
        least = 0.0 if relaxed else 0.45 * across.max()
        crossed = across > least
        share = per_metre / (air_density(ta) * np.where(crossed, across, np.inf))
        warming, dragging = share * heat / HEAT_OF_AIR, -share * pull
        if relaxed:
            warming = towards(warming, t - ta)
            dragging = towards(dragging, v - u)
        line.air_rows = (u + dragging, across, ta + warming)
    return diameters


def towards(change, gap):
    return -gap * np.expm1(-change / np.where(gap == 0, 1, gap))


def main(folder):
    warnings.simplefilter("ignore")
    with open(folder / "expected_rows.csv", "w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["name", "row", "diameter_cut_m", "diameter_relaxed_m"])
        for path in sorted(folder.glob("*.toml")):
            columns = [rows_of(path, relaxed) for relaxed in (False, True)]
            for i, (cut, relaxed) in enumerate(zip(*columns), 1):
                table.writerow([path.stem, i, f"{cut:.8g}", f"{relaxed:.8g}"])
                print(path.stem, i, cut, relaxed, flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
