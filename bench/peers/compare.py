"""Runs every program and makes the table. Called by `run`, with the virtual environment's Python.

compare.py BINARY FOLDER: the example `peers` of this program, and a folder for what it exports and the table.
"""

import json
import os
import platform
import re
import subprocess
import sys
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

HERE = Path(__file__).parent
PEERS = {
    "numpy": "NumPy",
    "numba": "Numba",
    "moordyn": "MoorDyn",
    "lammps": "LAMMPS",
    "pyelastica": "PyElastica",
    "mujoco": "MuJoCo",
}
# Of this program: what the ratios are to.
KERNEL = ("spunlaid, semi-implicit-euler", 8, 1e-6)
SECOND = ("spunlaid, implicit-tension", 8, 2e-4)


def rows_of(command, limit):
    """The rows that a program prints, and why there are no more of them."""
    try:
        done = subprocess.run(command, capture_output=True, timeout=limit, cwd=HERE, check=False)
    except (OSError, subprocess.TimeoutExpired) as reason:
        return [], str(reason).splitlines()[0]
    out = done.stdout.decode(errors="replace")
    # Some of them print on the same line.
    rows = [json.loads(found) for found in re.findall(r'\{"program".*?\}', out)]
    last = done.stderr.decode(errors="replace").strip().splitlines()[-1:] or ["no word why"]
    return rows, "" if done.returncode == 0 else last[0]


def number(x, digits=3):
    return f"{x:,.0f}" if x >= 1000 else f"{x:.{digits}g}"


def seconds(x):
    for unit, size in [("h", 3600.0), ("s", 1.0), ("ms", 1e-3)]:
        if x >= size:
            return f"{number(x / size)} {unit}"
    return f"{number(x / 1e-6)} µs"


def main(binary, folder):
    own, reason = rows_of([binary, folder], 900)
    if not own:
        raise SystemExit(f"this program did not run: {reason}")
    found, failed = [], []
    for module, name in PEERS.items():
        print(f"{name} ...", file=sys.stderr, flush=True)
        rows, reason = rows_of([sys.executable, str(HERE / f"with_{module}.py"), folder], 900)
        found += rows
        if reason:
            failed.append((name, reason))
    # Once more at the end: what slowed the machine for a while slowed only one of the two.
    own_again, _ = rows_of([binary], 900)
    best = {}
    for row in own + own_again:
        key = (row["program"], row["fibres"], row["step_s"])
        kept = best.setdefault(key, row)
        for what in ["ns", "second_s"]:
            kept[what] = min(kept[what], row[what])
    kernel, second = best[KERNEL]["ns"], best[SECOND]["second_s"]

    lines = [
        "| program | fibres | step | ns per element and step | over spunlaid | path (amplitude) off by | the paper's second, per fibre | over spunlaid |",
        "|---|---|---|---|---|---|---|---|",
    ]
    for row in list(best.values()) + found:
        path = f"{100 * row['path_error']:.2g} %" if "path_error" in row else "–"
        if "amplitude_error" in row:
            path += f" ({100 * row['amplitude_error']:+.2g} %)"
        lines.append(
            f"| {row['program']} | {number(row['fibres'])} | {seconds(row['step_s'])} | {number(row['ns'])} | "
            f"{number(row['ns'] / kernel)} | {path} | {seconds(row['second_s'])} | {number(row['second_s'] / second)} |"
        )
    lines += [f"| {name} | | | did not run: {reason} | | | | |" for name, reason in failed]
    worst = max((row["force_error"] for row in found if "force_error" in row), default=None)
    packages = []
    for module in PEERS:
        try:
            packages.append(f"{PEERS[module]} {version(module)}")
        except PackageNotFoundError:
            packages.append(f"{PEERS[module]} (not installed)")
    notes = [
        f"Ratios: of the kernels to {KERNEL[0]} at 1 µs, of the seconds to {SECOND[0]} at 200 µs.",
        f"{', '.join(packages)}; Python {platform.python_version()}, {os.cpu_count()} cores, one thread each.",
    ]
    if worst is not None:
        notes.append(f"NumPy's and Numba's forces differ from this program's by {worst:.1e} of the largest at most.")
    text = "\n".join([*lines, "", *notes, ""])
    Path(folder, "table.md").write_text(text)
    print(text)


if __name__ == "__main__":
    main(*sys.argv[1:])
