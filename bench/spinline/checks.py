"""Threads whose solution is known, through the reference solver: found, exact.

An isothermal thread: 100 Pa s, 1000 kg/m³, hole of 1 mm, 10 mm/s in the hole, 0.1 m long; no force but those named.
"""

import math

from scipy.optimize import brentq

from reference import LAYERS, ZERO, Spinline

AREA = math.pi * 1e-6 / 4
NEWTONIAN = 300 * AREA * 0.01 / 0.1  # 3 η A₀ v₀/L [N]


def thread(constants=(), **keys):
    melt = {
        "specific_volume": 1e-3, "specific_volume_slope": 0.0, "viscosity": 100.0, "activation_energy": 0.0,
        "viscosity_temperature": "200 °C", "freezing_temperature": "-200 °C", "heat_capacity_slope": 0.0,
    }  # fmt: skip
    line = {
        "polymer": "pp", "die_temperature": "200 °C", "hole_diameter": "1 mm", "throughput": 1000 * AREA * 0.01,
        "length": 0.1, "velocity": 0.0, "cross_velocity": 0.0, "temperature": "20 °C", "material": melt | dict(constants),
    }  # fmt: skip
    line = Spinline({"spinline": line | keys})
    line.gravity, line.inertia, line.drag, line.cooling = 0.0, 0.0, False, False
    return line


def cooled(constants, **keys):
    """The same with a heat loss that is proportional to T - T_a: Nu k = 0.015 W/(m K)."""
    line = thread(constants, **keys)
    line.cooling = True
    line.heat_loss = lambda z, t, v, r: math.pi * 0.015 * (t - 20 - ZERO)
    return line


def drawn(line, low, high):
    """The shot to the speed of the godet, from two forces around it."""
    force = brentq(lambda f: line.miss(line.shoot(f, 1e-12)), low, high, xtol=1e-18, rtol=1e-14)
    shot = line.shoot(force, 1e-12)
    shot.force = force
    return shot


def say(name, found, exact):
    print(f"{name:32} {found:.10g}  {exact:.10g}  {found / exact - 1:+.0e}")


def main():
    shot = drawn(thread(take_up_speed=0.2), 6e-5, 8e-5)
    say("Matovich-Pearson, force", shot.force, 7.058527877e-5)
    say("Matovich-Pearson, v(L/2)", shot.speed(0.05), 0.04472135955)

    line = thread(take_up_speed=4.0)
    line.inertia = 1.0
    shot = drawn(line, 1.2e-4, 1.5e-4)
    say("inertia, force", shot.force, 1.363755121e-4)
    say("inertia, v(L/2)", shot.speed(0.05), 0.1821374093)
    say("inertia, F(L)", shot.end_force, 1.677128988e-4)

    line = thread()
    line.gravity = 9.81
    say("gravity, v(0.1 m)", line.shoot(2.5e-4, 1e-12).speed(0.1), 15.56223893)
    say("gravity, v(0.03 m)", line.shoot(1.5e-4, 1e-12).speed(0.03), 0.02564248069)
    say("surface tension", thread({"surface_tension": 0.03}).shoot(1.5e-4, 1e-12).speed(0.1), 2.841783015)

    for law, ratios in {
        "ucm": [6.987355583, 4.929438216, 2.486968770],
        "giesekus": [7.825261522, 8.158354469, 7.329416467],
        "ptt": [7.221362014, 6.169631802, 4.499914877],
    }.items():
        for deborah, ratio in zip([0.02, 0.1, 0.5], ratios):
            line = thread({"modulus": 10 / deborah, "mobility": 0.3, "extensibility": 0.2}, law=law)
            end = line.shoot(2 * NEWTONIAN, 1e-12).end
            say(f"{law}, De = {deborah}", math.exp(end[0]) / 0.01, ratio)

    slopes = []
    for deborah in [1e-4, 2e-4]:
        line = thread({"modulus": 10 / deborah, "mobility": 0.3}, law="giesekus")
        end = line.shoot(2 * NEWTONIAN, 1e-11, "Radau").end
        slopes.append((end[0] - math.log(0.01) - 2) / deborah)
    say("giesekus, slope at De = 0", 2 * slopes[0] - slopes[1], 3.833433659)

    shot = cooled({"heat_capacity": 2000.0}).shoot(1e-5, 1e-12)
    say("cooling, T(L) [°C]", shot.end[1] - ZERO, 153.3472797)
    constants = {"heat_capacity": 1000.0, "activation_energy": 44e3}
    say("cooling and drawing, force", drawn(cooled(constants, take_up_speed=0.2), 1e-4, 3e-4).force, 1.886176177e-4)
    shot = drawn(cooled(constants | {"freezing_temperature": "150 °C"}, take_up_speed=0.2), 1e-4, 4e-4)
    say("freezing, force", shot.force, 2.371019557e-4)
    say("freezing, distance", shot.solid, 0.05423706674)

    line = thread(crystallisation=True)
    say("crystallisation, K", line.growth(100 + ZERO, 0.0), 0.2140997613)
    say("crystallisation, K at f = 0.05", line.growth(100 + ZERO, 0.05), 31.31366349)
    say("crystallisation, share", line.transformed(2.7466365 * line.growth(100 + ZERO, 0.0)), 0.1840104369)
    for x, thickness in [(1, 1.4087808), (100, 3.7692069), (1e4, 6.2671949)]:
        say(f"layer of a drawn filament, {x:g}", LAYERS["sakiadis"].thickness(x), thickness)


if __name__ == "__main__":
    main()
