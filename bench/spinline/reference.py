"""The spinline, solved a second time: SciPy in place of the program's own integrator, and other variables.

The distance below the die is the square of the independent variable: the friction of a boundary layer that begins
at the die goes with 1/√z there, and is finite over √z. The tension is a state of its own in a Newtonian thread. In
a viscoelastic one it follows from the conformation, and v' from the balance of momentum, which is linear in v'.

    reference.py CASE.toml [...]        # prints what comes out of each case
"""

import csv
import math
import sys
import tomllib
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from scipy.optimize import brentq, minimize_scalar

GAS, GRAVITY, STEFAN_BOLTZMANN, ZERO = 8.314462618, 9.81, 5.670374419e-8, 273.15
FASTEST = 2000.0  # A thread that reaches this speed [m/s] has run away.

# ---------------------------------------------------------------- units and constants

UNITS = {
    "m": 1, "cm": 1e-2, "mm": 1e-3, "um": 1e-6, "µm": 1e-6, "m/s": 1, "m/min": 1 / 60, "g/min": 1e-3 / 60,
    "kg/h": 1 / 3600, "g/s": 1e-3, "kg/s": 1, "N": 1, "mN": 1e-3, "uN": 1e-6, "µN": 1e-6, "Pa": 1, "kPa": 1e3,
    "MPa": 1e6, "GPa": 1e9, "Pa s": 1, "kJ/mol": 1e3, "J/mol": 1, "kg/m³": 1, "N/m": 1, "mN/m": 1e-3,
    "J/(kg K)": 1, "J/(kg K^2)": 1, "m^3/kg": 1, "m^3/(kg K)": 1, "1/Pa": 1, "1/s": 1, "K": 1, "J/kg": 1,
    "kJ/kg": 1e3,
}  # fmt: skip


def si(value):
    """A value of a case file in SI units; text without a unit stays text."""
    if not isinstance(value, str):
        return value
    number, _, unit = value.partition(" ")
    if unit == "°C":
        return float(number) + ZERO
    return float(number) * UNITS[unit] if unit in UNITS else value


def celsius(*degrees):
    return [degree + ZERO for degree in degrees]


NAMES = [
    "specific_volume", "specific_volume_slope", "heat_capacity", "heat_capacity_slope", "viscosity",
    "viscosity_temperature", "activation_energy", "freezing_temperature", "solid_density", "modulus",
    "stress_optical_coefficient", "full_birefringence", "unoriented_modulus", "oriented_modulus",
]  # fmt: skip
POLYMERS = {
    "pp": [1.145e-3, 0.903e-6, 2100, 3.35, None, *celsius(230), 44e3, *celsius(110), 905, 20e3, 0.9e-9, 0.06, 1.3e9, 8e9],
    "pet": [0.741e-3, 0.38e-6, 1256, 2.51, 200, *celsius(290), 57e3, *celsius(80), 1340, 100e3, 4.25e-9, 0.24, 2.3e9, 15e9],
    "pa6": [0.929e-3, 0.40e-6, 1930, 2.5, 150, *celsius(260), 55e3, *celsius(80), 1130, 100e3, 1.3e-9, 0.08, 1.0e9, 6e9],
    "pla": [0.80e-3, 0.50e-6, 1590, 2.0, 150, *celsius(230), 95e3, *celsius(65), 1250, 100e3, 2.5e-9, 0.03, 2.5e9, 6e9],
}  # fmt: skip
CRYSTAL_NAMES = [
    "avrami_exponent", "crystallisation_rate", "crystallisation_peak", "crystallisation_width", "melting_temperature",
    "crystallinity", "heat_of_fusion", "orientation_enhancement",
]  # fmt: skip
CRYSTALS = {
    "pp": [3, 0.55, *celsius(65), 60, *celsius(165), 0.6, 165e3, 2000],
    "pet": [1, 0.016, *celsius(190), 64, *celsius(260), 0.4, 121e3, 1000],
    "pa6": [2, 0.14, *celsius(145.6), 46, *celsius(220), 0.5, 209e3, 2000],
}
COMMON = {
    "surface_tension": 0.0, "mobility": 0.2, "extensibility": 0.2, "enhancement_limit": 1e4, "hardening_factor": 4.0,
    "hardening_exponent": 2.0, "freezing_share": 0.1,
}  # fmt: skip


def material(line):
    """Every constant of the polymer, in SI units."""
    polymer = line["polymer"]
    m = COMMON | dict(zip(NAMES, POLYMERS[polymer]))
    if polymer == "pet":
        m["stress_optical_temperature"] = 400.0
    if line.get("crystallisation"):
        m |= dict(zip(CRYSTAL_NAMES, CRYSTALS[polymer]))
        if polymer == "pp":
            m["freezing_temperature"] = 40 + ZERO
    m |= {key: si(value) for key, value in line.get("material", {}).items()}
    if m["viscosity"] is None:
        # Poiseuille's law in the die of the melt flow rate.
        pressure = 2.16 * 9.80665 / (math.pi * 9.55e-3**2 / 4)
        density = 1 / (m["specific_volume"] + m["specific_volume_slope"] * (m["viscosity_temperature"] - ZERO))
        flow = line["melt_flow_rate"] * 1e-3 / 600
        m["viscosity"] = math.pi * 1.0475e-3**4 * pressure * density / (8 * 8e-3 * flow)
    return m


def birefringence(m, stress, t):
    """The stress-optical law; where a temperature is known with the coefficient it is that of a network of chains."""
    return m["stress_optical_coefficient"] * m.get("stress_optical_temperature", t) / t * stress


# ---------------------------------------------------------------- the air


def air_density(t):
    return 101325 / (287.05 * t)


def air_viscosity(t):
    """Kinematic."""
    return 1.716e-5 * (t / ZERO) ** 1.5 * (ZERO + 110.4) / (t + 110.4) / air_density(t)


def air_conductivity(t):
    return 2.64638e-3 * t**1.5 / (t + 245.4 * 10 ** (-12 / t))


class Layer:
    """Thickness α(X) of a laminar boundary layer, from its series."""

    def __init__(self, share):
        m = np.arange(1, 161)
        self.m = m
        logs = [math.log(share(k)) + k * math.log(2) - math.lgamma(k + 3) - math.log(k + 1) for k in range(1, 161)]
        self.coefficients = np.exp(logs)
        assumed_values = np.linspace(math.log(1e-16), math.log(40), 4000)
        self.guess = CubicSpline([math.log(self.distance(math.exp(g))[0]) for g in assumed_values], assumed_values)

    def distance(self, a):
        terms = self.coefficients * a ** (self.m + 1)
        return terms.sum(), (terms * (self.m + 1)).sum() / a

    def thickness(self, x):
        log_x = math.log(min(max(x, 1e-30), 1e30))
        a = math.exp(self.guess(log_x))
        for _ in range(2):
            reached, slope = self.distance(a)
            a *= math.exp((log_x - math.log(reached)) * reached / (slope * a))
        return a


LAYERS = {"sakiadis": Layer(lambda m: m), "glauert-lighthill": Layer(lambda m: 0.5 * m * m)}
MATSUI = {"matsui": 0.9, "majumdar-shambaugh": 0.78}


# ---------------------------------------------------------------- the thread


class Failure(Exception):
    """The message for a user; the first word names the failure."""


class Spinline:
    # What the exact checks switch off.
    gravity, inertia, drag, cooling = GRAVITY, 1.0, True, True
    found = None  # The intervals of the force, once they are known.

    def __init__(self, case, folder=Path(".")):
        line = {key: si(value) for key, value in case["spinline"].items()}
        self.m = m = material(line)
        self.flow = line["throughput"]
        self.length = line["length"]
        self.t0 = line["die_temperature"]
        self.r0 = line["hole_diameter"] * line.get("die_swell", 1.0) / 2
        self.v0 = self.flow / (self.density(self.t0) * math.pi * self.r0**2)
        self.take_up = line.get("take_up_speed")
        self.end_tension = line.get("end_tension", 0.0)
        self.law = line.get("law", "newtonian")
        self.crystallises = line.get("crystallisation", False)
        self.emissivity = line.get("emissivity", 0.0)
        self.dissipation = 1.0 if line.get("dissipation") else 0.0
        self.nusselt_factor = line.get("nusselt_factor", 1.0)
        self.break_stress = line.get("break_stress", math.inf)
        drag = case.get("drag", {})
        self.layer = LAYERS.get(drag.get("along"))
        if self.layer is None:
            along = drag.get("along", "matsui")
            self.beta = drag.get("friction_coefficient", MATSUI[along]) if along == "matsui" else MATSUI[along]
        if "profile" in line:
            with open(folder / line["profile"]) as file:
                rows = [[float(cell) for cell in row] for row in list(csv.reader(file))[1:]]
            z, *air = np.array(rows).T
            along, across = (line.get(key, 1.0) for key in ("velocity_factor", "cross_velocity_factor"))
            warmer = line.get("temperature_offset", 0.0)
            self.set_air(z * 1e-3, along * air[0], across * air[1], air[2] + ZERO + warmer)
        else:
            constant = [line["velocity"], line["cross_velocity"], line["temperature"]]
            self.set_air(*np.array([[0.0, self.length], *([value] * 2 for value in constant)]))

    def set_air(self, z, *values):
        """The air in rows at the heights z; linear between them, constant beyond."""
        self.heights, self.air_rows = z, values
        inside = z[(z > 0) & (z < self.length)]
        self.stations = [0.0, *inside, self.length]

    def air(self, z):
        """Speed along, speed across and temperature; one look-up for the three."""
        h = self.heights
        i = min(max(int(np.searchsorted(h, z)), 1), len(h) - 1)
        share = min(max((z - h[i - 1]) / (h[i] - h[i - 1]), 0.0), 1.0)
        return [row[i - 1] + share * (row[i] - row[i - 1]) for row in self.air_rows]

    def density(self, t):
        return 1 / (self.m["specific_volume"] + self.m["specific_volume_slope"] * (t - ZERO))

    def viscosity(self, t, y):
        m = self.m
        exponent = m["activation_energy"] / GAS * (1 / t - 1 / m["viscosity_temperature"])
        if self.crystallises:
            exponent += m["hardening_factor"] * self.transformed(y) ** m["hardening_exponent"]
        return m["viscosity"] * math.exp(exponent)

    def transformed(self, y):
        return -math.expm1(-(max(y, 0.0) ** self.m["avrami_exponent"])) if self.crystallises else 0.0

    def friction(self, z, v, r):
        """Force of the air along the thread per length."""
        if not self.drag:
            return 0.0
        u, _, ta = self.air(z)
        nu, slip = air_viscosity(ta), u - v
        if slip == 0.0:
            return 0.0
        if self.layer:
            # π d ρ V²/2 · 4/(Re α)
            return 2 * math.pi * air_density(ta) * nu * slip / self.layer.thickness(nu * z / (abs(slip) * r * r))
        return math.pi * r * air_density(ta) * self.beta * (abs(slip) * 2 * r / nu) ** -0.61 * abs(slip) * slip

    def heat_loss(self, z, t, v, r):
        """Heat that leaves the thread per length and time."""
        if not self.cooling:
            return 0.0
        u, across, ta = self.air(z)
        film = 0.5 * (t + ta)
        nusselt = 0.42 * (2 * r / air_viscosity(film)) ** (1 / 3) * ((u - v) ** 2 + 64 * across**2) ** (1 / 6)
        convection = math.pi * air_conductivity(film) * nusselt * self.nusselt_factor * (t - ta)
        return convection + 2 * math.pi * r * self.emissivity * STEFAN_BOLTZMANN * (t**4 - ta**4)

    def growth(self, t, order):
        """K of the crystallisation [1/s]; the order is the f of the melt or of the freezing point."""
        m = self.m
        if not self.crystallises or t >= m["melting_temperature"]:
            return 0.0
        bell = math.exp(-4 * math.log(2) * ((t - m["crystallisation_peak"]) / m["crystallisation_width"]) ** 2)
        start = -math.expm1(-(((m["melting_temperature"] - t) / 20) ** 2))
        limit = 1 / m["enhancement_limit"]
        enhanced = (1 + limit) / (math.exp(-m["orientation_enhancement"] * order**2) + limit)
        return m["crystallisation_rate"] * bell * start * enhanced

    def order(self, stress):
        return min(1.0, self.m["stress_optical_coefficient"] * stress / self.m["full_birefringence"])

    def warming(self, z, t, v, r, y, y_rate, work):
        """T' from the balance of heat; work is A N₁ v'."""
        m = self.m
        heat = self.dissipation * work - self.heat_loss(z, t, v, r)
        if self.crystallises and y > 0.0:
            n = m["avrami_exponent"]
            heat += self.flow * m["heat_of_fusion"] * m["crystallinity"] * n * y ** (n - 1) * math.exp(-(y**n)) * y_rate
        return heat / (self.flow * (m["heat_capacity"] + m["heat_capacity_slope"] * (t - ZERO)))

    # The states are ln v, T, y and then F (Newtonian or solid) or c_zz, c_rr (viscoelastic).

    def section(self, state):
        """v, A, r, N₁ and F of a state of the melt."""
        v = math.exp(state[0])
        area = self.flow / (self.density(state[1]) * v)
        r = math.sqrt(area / math.pi)
        skin = math.pi * self.m["surface_tension"] * r
        if self.law == "newtonian":
            return v, area, r, (state[3] - skin) / area, state[3]
        stress = self.m["modulus"] * (state[3] - state[4])
        return v, area, r, stress, area * stress + skin

    def melt_rates(self, z, state):
        """d(state)/dz and v' of the melt, and the slope of the balance of momentum (positive below the elastic wave)."""
        v, area, r, stress, force = self.section(state)
        _, t, y = state[:3]
        eta = self.viscosity(t, y)
        y_rate = self.growth(t, self.order(stress)) / v
        weight_and_friction = self.flow * self.gravity / v + self.friction(z, v, r)

        def others(stretch):
            """Rates of T, y and F or c for a given v'."""
            warming = self.warming(z, t, v, r, y, y_rate, area * stress * stretch)
            if self.law == "newtonian":
                return [warming, y_rate, self.inertia * self.flow * stretch - weight_and_friction]
            czz, crr = state[3:]
            rz, rr = self.relaxation(czz - 1, crr - 1)
            rate = self.m["modulus"] / eta
            return [warming, y_rate, (2 * stretch * czz - rate * rz) / v, (-stretch * crr - rate * rr) / v]

        if self.law == "newtonian":
            stretch = stress / (3 * eta)
            return [stretch / v, *others(stretch)], stretch, 1.0

        def excess(stretch):
            """F' by the chain rule less F' by the balance of momentum: linear in v'."""
            warming, _, czz_rate, crr_rate = others(stretch)
            expansion = self.density(t) * self.m["specific_volume_slope"] * warming  # -ρ'/ρ
            widening = expansion - stretch / v  # A'/A
            change = area * (stress * widening + self.m["modulus"] * (czz_rate - crr_rate))
            change += 0.5 * math.pi * self.m["surface_tension"] * r * widening
            return change - self.inertia * self.flow * stretch + weight_and_friction

        at_rest, at_one = excess(0.0), excess(1.0)
        slope = at_one - at_rest
        stretch = -at_rest / slope
        return [stretch / v, *others(stretch)], stretch, slope

    def relaxation(self, zeta, chi):
        if self.law == "giesekus":
            a = self.m["mobility"]
            return zeta + a * zeta**2, chi + a * chi**2
        if self.law == "ucm":
            return zeta, chi
        trace = self.m["extensibility"] * (zeta + 2 * chi)
        factor = 1 + trace if self.law == "ptt" else math.exp(min(trace, 300.0))
        return factor * zeta, factor * chi

    def solid_rates(self, z, state, order):
        v = math.exp(state[0])
        t, y = state[1:3]
        r = math.sqrt(self.flow / (self.density(t) * v * math.pi))
        y_rate = self.growth(t, order) / v
        warming = self.warming(z, t, v, r, y, y_rate, 0.0)
        return [0.0, warming, y_rate, -self.flow * self.gravity / v - self.friction(z, v, r)]

    def start(self, force):
        """State at the die; none if the force is below what the surface pulls."""
        state = [math.log(self.v0), self.t0, 0.0]
        if self.law == "newtonian":
            return [*state, force]
        area = math.pi * self.r0**2
        s = (force - math.pi * self.m["surface_tension"] * self.r0) / (area * self.m["modulus"])
        if s <= 0:
            return None
        # c - c^(-1/2) = s
        czz = brentq(lambda c: c - c**-0.5 - s, 1.0, 2.0 + s, xtol=1e-15, rtol=1e-15)
        return [*state, czz, czz**-0.5]

    def shoot(self, force, rtol, method="DOP853"):
        """One integration from the die with a given force there."""
        shot = Shot(self)
        state = self.start(force)
        if state is None or self.section(state)[3] <= 0:
            shot.fate = "slack"
            return shot

        def slack(x, s):
            return self.section(s)[3]

        def away(x, s):
            return s[0] - math.log(FASTEST)

        def cold(x, s):
            return s[1] - self.m["freezing_temperature"]

        def crystalline(x, s):
            return self.transformed(s[2]) - self.m["freezing_share"]

        def wave(x, s):
            return self.melt_rates(max(x, 1e-12) ** 2, s)[2]

        events = [slack, away, cold, crystalline] if self.crystallises else [slack, away, cold]
        fates = ["slack", "away", "cold", "crystalline"]
        if self.law != "newtonian":
            events.append(wave)
            fates = [*fates[: len(events) - 1], "wave"]
            if self.melt_rates(1e-24, state)[2] <= 0:
                shot.fate = "wave"
                return shot
        for event in events:
            event.terminal = True

        def rates(x, s):
            x = max(x, 1e-12)
            # Stages of a step that is too long go anywhere.
            tame = [(-30.0, 30.0), (50.0, 3000.0), (0.0, 100.0), (-1e9, 1e9), (-1e9, 1e9)]
            s = [min(max(value, low), high) for value, (low, high) in zip(s, tame)]
            rate = self.melt_rates(x * x, s)[0] if shot.solid is None else self.solid_rates(x * x, s, shot.order)
            return [2 * x * value for value in rate]

        ends = [math.sqrt(z) for z in self.stations]
        x, i = 0.0, 0
        while i + 1 < len(ends):
            scale = [1.0, 100.0, 1.0, force, 1.0][: len(state)]
            if self.law != "newtonian" and shot.solid is None:
                scale[3] = scale[4] = 1.0
            piece = solve_ivp(rates, (x, ends[i + 1]), state, method, rtol=rtol,
                              atol=[1e-3 * rtol * value for value in scale],
                              events=events if shot.solid is None else None, dense_output=True)  # fmt: skip
            if piece.status < 0:
                shot.fate = "away"
                return shot
            x, state = piece.t[-1], list(piece.y[:, -1])
            shot.pieces.append((x, shot.solid is None, piece.sol))
            if piece.status == 0:
                i += 1
                continue
            fate = next(name for name, hits in zip(fates, piece.t_events) if len(hits))
            if fate in ("slack", "away", "wave"):
                shot.fate, shot.where = fate, x * x
                return shot
            _, _, r, stress, tension = self.section(state)
            shot.solid, shot.by, shot.order = x * x, fate, self.order(stress)
            shot.frozen = state[1], 2 * r, stress
            state = [*state[:3], tension]
        shot.fate = "complete"
        shot.end = state
        shot.end_force = state[3] if shot.solid is not None else self.section(state)[4]
        return shot

    def miss(self, shot):
        """What the end of a shot is off by: positive if the force at the die is too large."""
        if shot.fate != "complete":
            return -math.inf if shot.fate == "slack" else math.inf
        if self.take_up is None:
            return (shot.end_force - self.end_tension) / 1e-3
        return shot.end[0] - math.log(self.take_up)

    def brackets(self, count=1, rtol=1e-6):
        """Intervals of ln F₀ with a change of sign, from below."""
        # With crystallisation a second and a third state can lie close to the first one.
        found, x, step = [], math.log(1e-8), 0.05 if self.crystallises else 0.4
        before = self.shoot(math.exp(x), rtol)
        self.first = before
        while len(found) < count and x < math.log(1.0 if self.crystallises else 100.0):
            after = self.shoot(math.exp(x + step), rtol)
            if self.miss(before) * self.miss(after) < 0:
                found.append((x, x + step))
            x, before = x + step, after
        self.last = before
        return found

    def solve(self, rtol=1e-11, method="DOP853"):
        """The shot that meets the end, after every failure has been looked for."""
        if self.take_up is not None and self.take_up <= self.v0:
            raise Failure(f"take-up: {self.take_up:.4g} m/s is below {self.v0:.4g} m/s")
        if self.found is None:
            self.found = self.brackets(9 if self.crystallises else 1)
        brackets = self.found
        if not brackets:
            if self.last.fate == "complete":
                raise Failure("wave: no force draws this thread to its end")
            if self.first.fate == "wave":
                raise Failure("wave: faster than its own elastic wave")
            raise Failure("pull: the air holds the thread back")
        low, high = brackets[0]
        shots = [self.shoot(math.exp(x), 1e-6) for x in (low, high)]
        for _ in range(200):
            if all(shot.fate == "complete" for shot in shots):
                break
            middle = 0.5 * (low + high)
            if high - low < 1e-10:
                fates = [shot.fate for shot in shots]
                if fates == ["slack", "complete"] and shots[1].solid is None:
                    # The tension of a melt can fall to zero at the end, and no further.
                    raise Failure(f"solid: still at {shots[1].end[1] - ZERO:.1f} °C at the end")
                raise Failure("wave: between two shots" if "wave" in fates else f"jump: from {fates[0]} to {fates[1]}")
            shot = self.shoot(math.exp(middle), 1e-6)
            if self.miss(shot) < 0:
                low, shots[0] = middle, shot
            else:
                high, shots[1] = middle, shot
        x = brentq(lambda x: self.miss(self.shoot(math.exp(x), rtol, method)), low, high, xtol=1e-14, rtol=1e-14)
        shot = self.shoot(math.exp(x), rtol, method)
        shot.force, shot.solutions = math.exp(x), len(brackets)
        if shot.solid is None:
            raise Failure(f"solid: still at {shot.end[1] - ZERO:.1f} °C at the end")
        if max(shot.stress(z) for z in np.linspace(0, shot.solid, 500)) > self.break_stress:
            raise Failure(f"break: {shot.frozen[2]:.4g} Pa at {shot.solid:.4g} m")
        return shot


class Shot:
    """A thread from the die to where its integration ended."""

    def __init__(self, line):
        self.line, self.pieces = line, []
        self.solid = self.by = self.order = self.where = None

    def state(self, z):
        x = math.sqrt(z)
        for end, melt, solution in self.pieces:
            if x <= end:
                break
        return solution(min(x, end)), melt

    def speed(self, z):
        return math.exp(self.state(z)[0][0])

    def temperature(self, z):
        return self.state(z)[0][1]

    def radius(self, z):
        return math.sqrt(self.line.flow / (self.line.density(self.temperature(z)) * self.speed(z) * math.pi))

    def stress(self, z):
        return self.line.section(self.state(z)[0])[3]

    def strain_rate(self, z):
        """v' in the melt."""
        return self.line.melt_rates(max(z, 1e-24), self.state(z)[0])[1]

    def largest_strain_rate(self):
        """The largest v' and where it is, by golden section around the largest of many places."""
        z = np.linspace(0, self.solid, 2001)
        i = int(np.argmax([self.strain_rate(place) for place in z]))
        ends = (z[max(i - 1, 0)], z[min(i + 1, 2000)])
        best = minimize_scalar(lambda place: -self.strain_rate(place), bounds=ends, method="bounded",
                               options={"xatol": 1e-12})  # fmt: skip
        places = [*ends, best.x]
        return max((self.strain_rate(place), place) for place in places)

    def results(self):
        line, m = self.line, self.line.m
        v = math.exp(self.end[0])
        rate, place = self.largest_strain_rate()
        return {
            "final_speed_m_s": v,
            "final_diameter_m": 2 * math.sqrt(line.flow / (math.pi * m["solid_density"] * v)),
            "linear_density_kg_m": line.flow / v,
            "freezing_distance_m": self.solid,
            "freezing_temperature_c": self.frozen[0] - ZERO,
            "freezing_diameter_m": self.frozen[1],
            "freezing_stress_pa": self.frozen[2],
            "force_at_die_n": self.force,
            "largest_strain_rate_per_s": rate,
            "largest_strain_rate_at_m": place,
            "end_temperature_c": self.end[1] - ZERO,
            "steady_states": self.solutions,
            "birefringence": birefringence(m, self.frozen[2], self.frozen[0]),
        }


def read(path):
    with open(path, "rb") as file:
        return Spinline(tomllib.load(file), Path(path).parent)


def main(paths):
    for path in paths:
        print(path)
        for name, value in read(path).solve().results().items():
            print(f"  {name:28} {value:.9g}")


if __name__ == "__main__":
    main(sys.argv[1:])
