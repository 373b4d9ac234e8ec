"""The same model in plain NumPy: arrays along the fibre, or over many fibres at once."""

import sys

import numpy as np

from model import *


def forces(c, r, v, air):
    """Forces on the nodes, arrays of shape (..., N+1, 3); air (..., N, 3)."""
    edge = r[..., 1:, :] - r[..., :-1, :]
    length = np.sqrt((edge * edge).sum(-1, keepdims=True))
    t = edge / length
    relative = air - 0.5 * (v[..., 1:, :] + v[..., :-1, :])
    along = (relative * t).sum(-1, keepdims=True)
    across = relative - along * t
    speed = (across * across).sum(-1, keepdims=True)
    drag = 0.5 * (c["ct"] * np.abs(along) ** 0.39 * along * t + c["cn"] * speed**0.28 * across)
    pull = c["ka"] * (length - c["l"]) * t
    f = np.zeros_like(r)
    f[..., :-1, :] += drag + pull
    f[..., 1:, :] += drag - pull
    normal = np.cross(t[..., :-1, :], t[..., 1:, :])
    sine = np.sqrt((normal * normal).sum(-1, keepdims=True))
    cosine = (t[..., :-1, :] * t[..., 1:, :]).sum(-1, keepdims=True)
    moment = c["kt"] * np.arctan2(sine, cosine) / np.where(sine > 0, sine, 1.0)
    a = moment / length[..., :-1, :] * np.cross(normal, t[..., :-1, :])
    b = moment / length[..., 1:, :] * np.cross(normal, t[..., 1:, :])
    f[..., :-2, :] -= a
    f[..., 1:-1, :] += a + b
    f[..., 2:, :] -= b
    f[..., 1:-1, 0] += c["mass"] * GRAVITY
    f[..., 0, 0] += 0.5 * c["mass"] * GRAVITY
    f[..., -1, 0] += 0.5 * c["mass"] * GRAVITY
    return f


def fly(c, wind, h, steps, every=None):
    """Semi-implicit Euler from rest; wind [instant][...][eddy][component]. Positions of the end node."""
    shape = (*wind.shape[1:-2], ELEMENTS + 1, 3)
    r, v = np.zeros(shape), np.zeros(shape)
    r[..., 0] = np.arange(ELEMENTS + 1) * c["l"]
    weight = np.full((ELEMENTS + 1, 1), h / c["mass"])
    weight[0], weight[-1] = 0.0, 2 * h / c["mass"]
    path = []
    for k in range(steps):
        if every and k % every == 0:
            path.append(r[..., -1, 1:].copy())
        x = k * h / WIND_SPACING
        i = int(x)
        s = x - i
        air = (1 - s) * wind[i] + s * wind[i + 1]
        v += forces(c, r, v, air) * weight
        r += h * v
    return path


def main(folder):
    c = fibre()
    off = check_forces(forces, folder, "NumPy")
    wind = read_wind(folder)
    exact = read_path(folder)
    one = np.ascontiguousarray(wind[..., 0])
    # A second at 20 µs, for its path; timed by a share of it.
    path = np.array(fly(c, one, 2e-5, 50_000, every=50))[None]
    error = path_error(path, exact[:1, : path.shape[1]])
    for h, more in [(1e-6, {}), (2e-5, {"path_error": error})]:
        took = fastest(lambda: fly(c, one, h, 1_000), 1.0)
        row("NumPy", 1, h, took / 1_000 / ELEMENTS * 1e9, force_error=off, **more)
    eight = np.ascontiguousarray(np.moveaxis(wind, -1, 1))
    many = np.ascontiguousarray(np.tile(eight[:200], (1, 13, 1, 1))[:, :100])
    for h, more in [(1e-6, {}), (2e-5, {"path_error": error})]:
        took = fastest(lambda: fly(c, many, h, 200), 1.0)
        row("NumPy", 100, h, took / 200 / ELEMENTS / 100 * 1e9, force_error=off, **more)


if __name__ == "__main__":
    main(sys.argv[1])
