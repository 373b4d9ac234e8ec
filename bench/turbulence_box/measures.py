"""What is compared: one-point spectra, coherences and correlations of a box, and von Kármán's formulas for them.

Lengths are in integral length scales, and the rms is one.
"""

import numpy as np
from boxes import POINTS, STEP, WAVE_NUMBER
from scipy.special import gamma, kv

SEPARATIONS = (0.25, 0.5, 1.0, 2.0)
COMPONENTS = "uvw"
PAIRS = ("uu", "vv", "ww", "uv", "uw", "vw")
# Edges of the bands of k₁ L_T, and the largest wave numbers of spunlaid along and across (`air.toml`).
BANDS = ((0.25, 0.5), (0.5, 1.0), (1.0, 2.0), (2.0, 4.0), (4.0, 8.0), (8.0, 14.0))
CUTOFF = 15.0

# Across: none, along y, along z, along both.
ACROSS = [(0.0, 0.0)]
for r in SEPARATIONS:
    ACROSS += [(r, 0.0), (0.0, r), (r / np.sqrt(2), 0.0), (0.0, r / np.sqrt(2)), (r / np.sqrt(2), r / np.sqrt(2))]

K1 = 2 * np.pi * np.fft.rfftfreq(POINTS[0], STEP)
# Ends of the box along the flow are faded: one of the two fields does not repeat itself there.
WINDOW = np.hanning(POINTS[0] + 1)[:-1]
# Each wave number has a twin of the other sign, except zero.
COUNTED = np.where(K1 == 0, 0.5, 1.0) * (K1 < CUTOFF)
K2, K3 = (2 * np.pi * np.fft.fftfreq(points, STEP) for points in POINTS[1:])


def cross_spectra(box, cutoff=None):
    """`out[pair, across, k₁]`: two-sided cross-spectra of two components at two places over the wave number along the flow, their sum
    over all wave numbers being the covariance. With a cut-off without the waves that are shorter across."""
    kept = np.ones(POINTS[1:], dtype=bool) if cutoff is None else np.hypot(K2[:, None], K3[None, :]) <= cutoff
    k2, k3 = (k[kept] for k in np.meshgrid(K2, K3, indexing="ij"))
    phases = np.exp(1j * np.array([k2 * y + k3 * z for y, z in ACROSS])).astype(np.complex64)
    waves = []
    for component in box:
        along = np.fft.rfft(component * WINDOW[:, None, None].astype(np.float32), axis=0).astype(np.complex64)
        waves.append(np.fft.fft2(along)[:, kept].astype(np.complex64) / (POINTS[1] * POINTS[2]))
    products = [np.conj(waves[COMPONENTS.index(i)]) * waves[COMPONENTS.index(j)] for i, j in PAIRS]
    return np.array([phases @ product.T for product in products]) / (POINTS[0] * np.sum(WINDOW**2))


def spectra(cross):
    """One-point spectra of u, v, w in the bands, in parts of the variance up to the cut-off."""
    of_all = cross[:3, 0].real
    return np.array([of_all[:, band].mean(axis=1) for band in bands()]) / (of_all @ COUNTED)


def bands():
    return [(low <= K1) & (high > K1) for low, high in BANDS]


def coherences(cross):
    """Coherence in the bands: bands × separations × (u along y, u along z, v along y, w along z, w along y, v along z)."""
    ways = [("uu", 0), ("uu", 1), ("vv", 0), ("ww", 1), ("ww", 0), ("vv", 1)]
    return np.array(
        [
            [
                [
                    cross[PAIRS.index(pair), 1 + 5 * r + way, band].real.sum() / cross[PAIRS.index(pair), 0, band].real.sum()
                    for pair, way in ways
                ]
                for r in range(len(SEPARATIONS))
            ]
            for band in bands()
        ]
    )


# What correlations are of: name, pair, place across among five, along the flow in separations, von Kármán's formula of f and g.
DIAGONAL = 1 / np.sqrt(2)
CORRELATIONS = (
    ("u, along x", "uu", None, 1.0, lambda f, g: f),
    ("v, along y", "vv", 0, 0.0, lambda f, g: f),
    ("w, along z", "ww", 1, 0.0, lambda f, g: f),
    ("u, along y", "uu", 0, 0.0, lambda f, g: g),
    ("u, along z", "uu", 1, 0.0, lambda f, g: g),
    ("v, along x", "vv", None, 1.0, lambda f, g: g),
    ("w, along x", "ww", None, 1.0, lambda f, g: g),
    ("v, along z", "vv", 1, 0.0, lambda f, g: g),
    ("w, along y", "ww", 0, 0.0, lambda f, g: g),
    ("u with v, askew in x and y", "uv", 2, DIAGONAL, lambda f, g: (f - g) / 2),
    ("u with w, askew in x and z", "uw", 3, DIAGONAL, lambda f, g: (f - g) / 2),
    ("v with w, askew in y and z", "vw", 4, 0.0, lambda f, g: (f - g) / 2),
)


def weighted(cross, power):
    """With these one-point spectra of u, v, w in place of its own."""
    scale = np.sqrt(power / cross[:3, 0].real)
    return cross * np.array([scale[COMPONENTS.index(i)] * scale[COMPONENTS.index(j)] for i, j in PAIRS])[:, None]


def correlations(cross, windowed=True):
    """Correlations at one instant: separations × kinds."""
    variance = dict(zip(COMPONENTS, cross[:3, 0].real @ COUNTED))
    out = np.empty((len(SEPARATIONS), len(CORRELATIONS)))
    for at, r in enumerate(SEPARATIONS):
        for kind, (_, pair, across, along, _) in enumerate(CORRELATIONS):
            of_all = cross[PAIRS.index(pair), 0 if across is None else 1 + 5 * at + across]
            wave = np.exp(1j * K1 * along * r)
            covariance = (of_all * wave).real @ COUNTED / (window_overlap(along * r) if windowed else 1.0)
            out[at, kind] = covariance / np.sqrt(variance[pair[0]] * variance[pair[1]])
    return out


def window_overlap(distance):
    """What the window leaves of a correlation at a distance along the flow."""
    k = 2 * np.pi * np.fft.fftfreq(POINTS[0], STEP)
    power = np.abs(np.fft.fft(WINDOW)) ** 2
    return (power * np.cos(k * distance)).sum() / power.sum()


def von_karman(r):
    """f and g."""
    q = WAVE_NUMBER * r
    scale = 2 ** (2 / 3) / gamma(1 / 3) * q ** (1 / 3)
    return scale * kv(1 / 3, q), scale * (kv(1 / 3, q) - q / 2 * kv(2 / 3, q))


def von_karman_spectra(k1):
    """One-point spectra of u, v, w over the wave number along the flow, two-sided, of variance one."""
    a = (k1 / WAVE_NUMBER) ** 2
    u = (1 + a) ** (-5 / 6) / np.pi
    v = (1 + 8 / 3 * a) * (1 + a) ** (-11 / 6) / (2 * np.pi)
    return np.array([u, v, v])


def von_karman_cross_spectra():
    """As `cross_spectra`: the sum over the waves of a box up to both cut-offs, of each k₁ scaled to the one-point spectrum."""
    k2, k3 = (k[np.hypot(K2[:, None], K3[None, :]) <= CUTOFF] for k in np.meshgrid(K2, K3, indexing="ij"))
    phases = np.exp(1j * np.array([k2 * y + k3 * z for y, z in ACROSS]))
    k = np.array([np.broadcast_to(K1[:, None], (len(K1), len(k2))), *np.broadcast_arrays(k2, k3, np.empty((len(K1), 1)))[:2]])
    square = (k**2).sum(axis=0)
    out = np.empty((len(PAIRS), len(ACROSS), len(K1)), dtype=complex)
    for pair, (i, j) in enumerate((COMPONENTS.index(i), COMPONENTS.index(j)) for i, j in PAIRS):
        power = ((i == j) * square - k[i] * k[j]) * (square + WAVE_NUMBER**2) ** (-17 / 6)
        out[pair] = phases @ power.T
    return weighted(out, von_karman_spectra(K1))
