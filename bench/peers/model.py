"""The paper's Table 1 fibre in SI units, and what the comparisons share."""

import json
import math
import time
from pathlib import Path

LENGTH, DIAMETER, DENSITY, MODULUS = 1.0, 50e-6, 950.0, 2e9
ELEMENTS = 20
AIR_VELOCITY, AIR_DENSITY, VISCOSITY = 10.0, 1.204, 1.51e-5
BETA = 0.9
GRAVITY = 9.81
WIND_SPACING = 5e-5


def fibre(diameter=DIAMETER, length=LENGTH, elements=ELEMENTS, modulus=MODULUS):
    """Constants of a fibre: rest length, element mass, axial and bending stiffness, drag factors.

    Drag of an element: F = c_t |V_t|^0.39 V_t t + c_n |V_n|^0.56 V_n, the paper's two power laws.
    """
    l = length / elements
    area = math.pi * diameter**2 / 4
    pressure = 0.5 * AIR_DENSITY * diameter * l
    re = diameter / VISCOSITY
    return {
        "l": l,
        "mass": DENSITY * area * l,
        "ka": modulus * area / l,
        "kt": modulus * math.pi * diameter**4 / 64 / l,
        "ct": math.pi * pressure * BETA * re**-0.61,
        "cn": pressure * 6.96 * re**-0.44 * (diameter / 78e-6) ** 0.404,
    }


def fastest(work, seconds=1.0, least=3):
    """Processor time of the process for some work: the least of repetitions over some seconds."""
    best, spent, runs = math.inf, 0.0, 0
    while spent < seconds or runs < least:
        started = time.process_time()
        work()
        took = time.process_time() - started
        best, spent, runs = min(best, took), spent + took, runs + 1
    return best


def row(program, fibres, step, ns, **more):
    """Prints a result: nanoseconds per element and step of a fibre, at steps of so many seconds."""
    second = ns * 1e-9 * ELEMENTS / step
    print(json.dumps({"program": program, "fibres": fibres, "step_s": step, "ns": ns, "second_s": second, **more}), flush=True)


def read_forces(folder):
    """The states that this program wrote with its forces: fibre constants, r, v, f."""
    import numpy as np

    lines = (Path(folder) / "forces.csv").read_text().splitlines()[1:]
    table = np.array([[float(x) for x in line.split(",")] for line in lines])
    for state in np.unique(table[:, 0]):
        rows = table[table[:, 0] == state]
        diameter, length, elements, modulus = rows[0, 1:5]
        yield fibre(diameter, length, int(elements), modulus), rows[:, 6:9], rows[:, 9:12], rows[:, 12:15]


def read_wind(folder):
    """Wind as [instant][eddy][component][fibre], WIND_SPACING apart, eight fibres."""
    import numpy as np

    return np.fromfile(Path(folder) / "wind.f64").reshape(-1, ELEMENTS, 3, 8)


def read_path(folder):
    """Converged y and z of the end nodes: [fibre][millisecond][y, z]."""
    import numpy as np

    table = np.loadtxt(Path(folder) / "path.csv", delimiter=",", skiprows=1)
    return table[:, 2:].reshape(8, -1, 2)


def path_error(path, exact):
    """Root mean square distance of paths [fibre][millisecond][y, z] over the spread of the exact ones."""
    import numpy as np

    exact = exact[: len(path)]
    spread = exact - exact.mean(axis=1, keepdims=True)
    return float(np.sqrt(((path - exact) ** 2).sum() / (spread**2).sum()))


def check_forces(forces, folder, program):
    """Compares a force function f(constants, r, v, air) with what this program exports."""
    import numpy as np

    worst = 0.0
    for constants, r, v, f in read_forces(folder):
        air = np.zeros((len(r) - 1, 3))
        air[:, 0] = 7.0
        off = np.abs(forces(constants, r, v, air) - f).max() / np.abs(f).max()
        worst = max(worst, float(off))
    if worst > 4e-7:
        raise SystemExit(f"{program}: forces differ by {worst:.1e} of the largest")
    return worst
