"""MuJoCo: rigid links with ball joints, its own fluid forces on ellipsoids.

Cannot: stretch of the elements, the paper's drag laws, turbulence (one steady wind for all).
"""

import sys

from model import *


def text(step, integrator):
    """The chain in milligrams instead of kilograms: the axial inertia of a link is below MuJoCo's least."""
    c = fibre()
    milli = 1e6
    stiffness, damping = c["kt"] * milli, 1e-12 * milli
    link = (
        '<body pos="{x} 0 0"><joint type="ball" stiffness="{k}" damping="{b}"/>'
        '<geom type="ellipsoid" size="{half} {r} {r}" pos="{half} 0 0" density="{density}" fluidshape="ellipsoid"/>'
    )
    bodies = "".join(
        link.format(
            x=0 if i == 0 else c["l"], k=0 if i == 0 else stiffness, b=damping, half=c["l"] / 2, r=DIAMETER / 2,
            # An ellipsoid has two thirds of a cylinder's volume.
            density=DENSITY * milli * 1.5,
        )
        for i in range(ELEMENTS)
    )  # fmt: skip
    return (
        f'<mujoco><option timestep="{step}" integrator="{integrator}" gravity="{GRAVITY} 0 0" wind="{AIR_VELOCITY} 0 0" '
        f'density="{AIR_DENSITY * milli}" viscosity="{AIR_DENSITY * VISCOSITY * milli}">'
        '<flag contact="disable"/></option><size memory="10M"/>'
        f"<worldbody>{bodies}{'</body>' * ELEMENTS}</worldbody></mujoco>"
    )


def main(_):
    import mujoco

    for integrator in ["implicitfast", "implicit"]:
        for step in [1e-6, 1e-4, 2e-4, 5e-4, 1e-3]:
            model = mujoco.MjModel.from_xml_string(text(step, integrator))
            data = mujoco.MjData(model)
            data.qvel[1] = 0.1

            def work():
                for _ in range(500):
                    mujoco.mj_step(model, data)

            took = fastest(work, 1.0)
            warned = sum(w.number for w in data.warning)
            if warned or not all(map(math.isfinite, data.qpos)):
                print(f"MuJoCo, {integrator}, does not hold at {step} s", file=sys.stderr)
                continue
            row(f"MuJoCo, {integrator}", 1, step, took / 500 / ELEMENTS * 1e9)


if __name__ == "__main__":
    main(sys.argv[1])
