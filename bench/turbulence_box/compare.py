"""Makes boxes with both generators and compares them: compare.py FOLDER [SEEDS].

Leaves `table.md`, `numbers.csv` and `picture.png` in the folder. What was made of a box stays there as `spunlaid-1.npz` and so on, and
is not made again.
"""

import csv
import sys
import time
from pathlib import Path

import numpy as np
from boxes import Hipersim, Spunlaid
from measures import (
    BANDS,
    CORRELATIONS,
    CUTOFF,
    K1,
    SEPARATIONS,
    coherences,
    correlations,
    cross_spectra,
    spectra,
    von_karman,
    von_karman_cross_spectra,
    von_karman_spectra,
    weighted,
)
from picture import draw

WAYS = ("u, along y", "u, along z", "v, along y", "w, along z", "w, along y", "v, along z")


def measured(generator, seeds, folder):
    """The cross-spectra of each seed, as the box is and without the waves that spunlaid leaves out; the rms."""
    made = None
    for seed in range(1, seeds + 1):
        file = folder / f"{generator.name}-{seed}.npz"
        if not file.exists():
            begin = time.time()
            made = made or generator()
            box = made.box(seed)
            np.savez(file, whole=cross_spectra(box), cut=cross_spectra(box, CUTOFF), rms=box.std(axis=(1, 2, 3)))
            print(f"{generator.name}, seed {seed}: {time.time() - begin:.0f} s", file=sys.stderr, flush=True)
        with np.load(file) as found:
            yield dict(found)


def expected():
    """Von Kármán's numbers, in the order of `numbers`."""
    cross = von_karman_cross_spectra()
    return [spectra(cross), coherences(cross), correlations(cross, windowed=False)]


def numbers(cross):
    return [spectra(cross), coherences(cross), correlations(cross)]


def mean_and_error(boxes):
    """Of each kind of number over the seeds."""
    return [(np.mean(kind, axis=0), np.std(kind, axis=0, ddof=1) / np.sqrt(len(kind))) for kind in zip(*boxes)]


def names():
    band = [f"{low:g} to {high:g}" for low, high in BANDS]
    yield [("spectrum", component, b, "") for b in band for component in "uvw"]
    yield [("coherence", way, b, r) for b in band for r in SEPARATIONS for way in WAYS]
    yield [("correlation", kind, "", r) for r in SEPARATIONS for kind, *_ in CORRELATIONS]


def deviation(ours, theirs, relative):
    """Largest difference, in per cent or as it is, and where; largest in standard errors; rms of it in standard errors."""
    (a, a_error), (b, b_error) = ours, theirs
    off = (a / b - 1) if relative else a - b
    in_errors = (a - b) / np.hypot(a_error, b_error)
    where = np.argmax(np.abs(off))
    return off.flat[where], where, np.abs(in_errors).max(), np.sqrt(np.mean(in_errors**2))


def main(folder, seeds):
    folder.mkdir(parents=True, exist_ok=True)
    ours, theirs = (list(measured(generator, seeds, folder)) for generator in (Spunlaid, Hipersim))
    formulas = expected()
    found = {
        "spunlaid": mean_and_error(numbers(box["whole"]) for box in ours),
        "hipersim": mean_and_error(numbers(box["whole"]) for box in theirs),
        "hipersim, cut": mean_and_error(numbers(weighted(box["cut"], von_karman_spectra(K1))) for box in theirs),
    }
    write_numbers(folder / "numbers.csv", formulas, found)
    table = write_table(formulas, found, seeds)
    table += rms_table(ours, theirs)
    (folder / "table.md").write_text(table)
    print(table)
    draw(folder / "picture.png", formulas, found)


def write_numbers(path, formulas, found):
    with path.open("w", newline="") as file:
        out = csv.writer(file)
        columns = [f"{name}{what}" for name in found for what in ("", " error")]
        out.writerow(["quantity", "of", "k1_times_length_scale", "separation_in_length_scales", "von_karman", *columns])
        for kind, rows in enumerate(names()):
            for i, row in enumerate(rows):
                values = [values[kind][which].flat[i] for values in found.values() for which in (0, 1)]
                out.writerow([*row, *(f"{value:.5g}" for value in (formulas[kind].flat[i], *values))])


def write_table(formulas, found, seeds):
    lines = [f"{seeds} boxes of each. Differences of spunlaid; correlations and coherences as they are, spectra in per cent.", ""]
    lines += [
        "| | numbers | against | largest difference | where | largest, standard errors | rms, standard errors |",
        "|---|---|---|---|---|---|---|",
    ]
    for kind, rows in enumerate(names()):
        ours = found["spunlaid"][kind]
        for name in ("hipersim, cut", "hipersim", "von Kármán"):
            if kind == 0 and name == "hipersim, cut":
                continue
            other = found[name][kind] if name in found else (formulas[kind], np.zeros_like(formulas[kind]))
            off, where, largest, rms = deviation(ours, other, kind == 0)
            off = f"{100 * off:+.1f} %" if kind == 0 else f"{off:+.4f}"
            place = ", ".join(str(part) for part in rows[where][1:] if part != "")
            lines.append(f"| {rows[0][0]} | {len(rows)} | {name} | {off} | {place} | {largest:.1f} | {rms:.2f} |")
    lines += [
        "",
        "Correlations",
        "",
        "| | r / L | f, g | sum of the waves | spunlaid | hipersim, cut as spunlaid | hipersim |",
        "|---|---|---|---|---|---|---|",
    ]
    for i, (_, kind, _, r) in enumerate(list(names())[2]):
        values = [f"{values[2][0].flat[i]:.3f} ± {values[2][1].flat[i]:.3f}" for name, values in in_order(found)]
        formula = CORRELATIONS[i % len(CORRELATIONS)][-1](*von_karman(r))
        lines.append(f"| {kind} | {r:g} | {formula:.3f} | {formulas[2].flat[i]:.3f} | " + " | ".join(values) + " |")
    lines += ["", "Spectra over k₁ L, two-sided, in parts of the variance up to the cut-off", ""]
    lines += ["| | k₁ L | von Kármán | spunlaid, over it | hipersim, over it |", "|---|---|---|---|---|"]
    for i, (_, component, band, _) in enumerate(next(names())):
        formula = formulas[0].flat[i]
        values = [
            f"{found[name][0][0].flat[i] / formula:.3f} ± {found[name][0][1].flat[i] / formula:.3f}"
            for name in ("spunlaid", "hipersim")
        ]
        lines.append(f"| {component} | {band} | {formula:.3g} | " + " | ".join(values) + " |")
    return "\n".join(lines) + "\n"


def in_order(found):
    return [(name, found[name]) for name in ("spunlaid", "hipersim, cut", "hipersim")]


def rms_table(ours, theirs):
    lines = ["", "| rms | u | v | w |", "|---|---|---|---|"]
    for name, boxes in (("spunlaid", ours), ("hipersim", theirs)):
        rms = np.array([box["rms"] for box in boxes])
        cells = [f"{m:.4f} ± {e:.4f}" for m, e in zip(rms.mean(axis=0), rms.std(axis=0, ddof=1) / np.sqrt(len(rms)))]
        lines.append(f"| {name} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main(Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 8)
