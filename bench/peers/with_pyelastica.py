"""PyElastica: a Cosserat rod, with the paper's drag laws and wind written in Numba as a force of one's own.

Cannot: steps near the axial limit; shear and the rods' own spin make it stable only for far shorter ones.
"""

import sys

import numpy as np
from numba import njit

from model import *


@njit(cache=False)
def drag(tangents, velocity, forces, ct, cn, u):
    """Adds half of each element's drag to its two nodes; arrays (3, n)."""
    for j in range(tangents.shape[1]):
        ux = u - 0.5 * (velocity[0, j] + velocity[0, j + 1])
        uy = -0.5 * (velocity[1, j] + velocity[1, j + 1])
        uz = -0.5 * (velocity[2, j] + velocity[2, j + 1])
        tx, ty, tz = tangents[0, j], tangents[1, j], tangents[2, j]
        along = ux * tx + uy * ty + uz * tz
        nx, ny, nz = ux - along * tx, uy - along * ty, uz - along * tz
        a = 0.5 * ct * abs(along) ** 0.39 * along
        b = 0.5 * cn * (nx * nx + ny * ny + nz * nz) ** 0.28
        for i in (j, j + 1):
            forces[0, i] += a * tx + b * nx
            forces[1, i] += a * ty + b * ny
            forces[2, i] += a * tz + b * nz


def main(_):
    import elastica as ea

    c = fibre()

    class Air(ea.NoForces):
        def apply_forces(self, system, time=0.0):
            drag(system.tangents, system.velocity_collection, system.external_forces, c["ct"], c["cn"], AIR_VELOCITY)

    class Simulator(ea.BaseSystemCollection, ea.Constraints, ea.Forcing):
        pass

    for step in [2.5e-8, 3e-8]:
        simulator = Simulator()
        rod = ea.CosseratRod.straight_rod(
            ELEMENTS, np.zeros(3), np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0]), LENGTH, DIAMETER / 2, DENSITY,
            youngs_modulus=MODULUS, shear_modulus=MODULUS / 2.8,
        )  # fmt: skip
        simulator.append(rod)
        simulator.constrain(rod).using(ea.OneEndFixedBC, constrained_position_idx=(0,), constrained_director_idx=(0,))
        simulator.add_forcing_to(rod).using(ea.GravityForces, acc_gravity=np.array([GRAVITY, 0.0, 0.0]))
        simulator.add_forcing_to(rod).using(Air)
        simulator.finalize()
        rod.velocity_collection[1, 1:] = 0.01 * np.arange(ELEMENTS)
        stepper = ea.PositionVerlet()
        now = [0.0]

        def work():
            for _ in range(500):
                now[0] = stepper.step(simulator, np.float64(now[0]), np.float64(step))

        work()
        took = fastest(work, 3.0)
        # Unstable, it flies about at hundreds of metres per second, but stays finite.
        if not (np.abs(rod.velocity_collection) < 20).all():
            print(f"PyElastica does not hold at {step} s", file=sys.stderr)
            continue
        row("PyElastica", 1, step, took / 500 / ELEMENTS * 1e9)


if __name__ == "__main__":
    main(sys.argv[1])
