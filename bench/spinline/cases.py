"""Solves every case of a folder and leaves what comes out in `expected.csv` beside them.

    cases.py FOLDER

The last column is the accuracy: the largest relative difference between three solutions, of DOP853 at a tolerance of
1e-11 and 1e-12 and of LSODA at 1e-11. The place of the largest strain rate is less certain (a maximum is flat) and
is left out of it.
"""

import csv
import sys
import warnings
from pathlib import Path

from reference import ZERO, Failure, read

PLACES = [0.02, 0.05, 0.1]  # Where speed and temperature are reported, in parts of the length.


def solution(line, rtol, method):
    shot = line.solve(rtol, method)
    row = shot.results()
    for i, part in enumerate(PLACES, 1):
        z = part * line.length
        row |= {f"z{i}_m": z, f"v{i}_m_s": shot.speed(z), f"t{i}_c": shot.temperature(z) - ZERO}
    return row


def accuracy(rows):
    keys = [key for key in rows[0] if key != "largest_strain_rate_at_m" and rows[0][key]]
    return max(abs(row[key] / rows[0][key] - 1) for key in keys for row in rows[1:])


def main(folder):
    warnings.simplefilter("ignore")  # Of trial steps that go too far.
    expected, failures = [], []
    for path in sorted(folder.glob("*.toml")):
        try:
            line = read(path)
            rows = [solution(line, *how) for how in [(1e-12, "DOP853"), (1e-11, "DOP853"), (1e-11, "LSODA")]]
        except Failure as failure:
            failures.append([path.stem, *str(failure).split(": ", 1)])
            print(path.stem, failure, flush=True)
            continue
        difference = accuracy(rows)
        expected.append({"name": path.stem} | {key: f"{value:.10g}" for key, value in rows[0].items()})
        expected[-1]["accuracy"] = f"{difference:.0e}"
        print(path.stem, f"{difference:.1e}", flush=True)
    with open(folder / "expected.csv", "w", newline="") as file:
        table = csv.DictWriter(file, expected[0], lineterminator="\n")
        table.writeheader()
        table.writerows(expected)
    with open(folder / "expected_failures.csv", "w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerows([["name", "failure", "detail"], *failures])


if __name__ == "__main__":
    main(Path(sys.argv[1]))
