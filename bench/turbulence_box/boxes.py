"""Boxes of isotropic turbulence of rms one from two generators, on the same grid.

Arrays are component × x × y × z, with x along the mean flow. Lengths are in integral length scales L_T.
"""

from pathlib import Path

import numpy as np
from hipersim.turbgen.spectral_tensor import MannSpectralTensor
from scipy.special import beta, gamma

CASE = Path(__file__).parent / "air.toml"

# The grid: eight points in a length scale, a box of 64 × 16 × 16.
STEP = 1 / 8
POINTS = (512, 128, 128)
# Its multiples are spread evenly between whole numbers.
GOLDEN = (np.sqrt(5) - 1) / 2

# Mann's energy spectrum is α ε^(2/3) L^(5/3) (kL)⁴ / (1 + (kL)²)^(17/6). Von Kármán's has the same form with 1/k_e in place of L,
# and an integral length scale L_T = √π Γ(5/6) / (Γ(1/3) k_e).
WAVE_NUMBER = np.sqrt(np.pi) * gamma(5 / 6) / gamma(1 / 3)
MANN_LENGTH = 1 / WAVE_NUMBER
# The variance is two thirds of the energy: 0.688 α ε^(2/3) L^(2/3). Here it is one.
MANN_STRENGTH = 1 / (beta(5 / 2, 1 / 3) / 3 * MANN_LENGTH ** (2 / 3))


class Hipersim:
    """Mann's model without shear. The box repeats itself across after its width, as that of spunlaid does."""

    name = "hipersim"

    def __init__(self):
        self.tensor = MannSpectralTensor(
            alphaepsilon=MANN_STRENGTH,
            L=MANN_LENGTH,
            Gamma=0,
            Nxyz=POINTS,
            dxyz=(STEP,) * 3,
            double_xyz=(False,) * 3,
            # What is shorter across than the grid can have is given to the waves that are there, as spunlaid does.
            HighFreqComp=1,
        )

    def box(self, seed):
        return self.tensor.generate(seed=seed).uvw


class Spunlaid:
    """The field of eddies, looked at from a place that does not move. What comes later lies behind along the flow."""

    name = "spunlaid"

    def __init__(self):
        # Needed only here: the other box can be made without it.
        import spunlaid

        self.make = lambda seed: spunlaid.Air(spunlaid.Case.read(CASE), replicate=seed)

    def box(self, seed):
        air = self.make(seed)
        speed, length = air.case["air.velocity"], air.case["air.length_scale"]
        rms = air.case["air.turbulence_intensity"] * speed
        width = tuple(points * STEP * length for points in POINTS[1:])
        assert np.allclose(air.extent, width), f"the field repeats itself after {air.extent} m, the box after {width} m"
        y, z = (STEP * length * np.arange(points) for points in POINTS[1:])
        # The sums over harmonics that make the field last a window each, and begin three quarters of one apart. A box sees some three
        # of them, and boxes that all began with a window would see the harmonics as lines. So each begins elsewhere.
        window = 64 / air.case["air.cutoff_frequency"]
        start = (GOLDEN * seed) % 1 * 0.75 * window
        box = np.empty((3, *POINTS), dtype=np.float32)
        for i in range(POINTS[0]):
            velocity = air.at(start + i * STEP * length / speed, 0.0, y[:, None], z[None, :])
            box[:, -1 - i] = np.moveaxis((velocity - [speed, 0, 0]) / rms, -1, 0)
        return box
