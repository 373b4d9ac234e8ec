"""The same model in Numba, compiled loops: fibre by fibre, and fibres side by side."""

import math
import sys

import numpy as np
from numba import njit

from model import *


def make(fastmath):
    """The functions compiled with or without leave to reorder and approximate."""

    @njit(fastmath=fastmath, error_model="numpy")
    def forces(l, mass, ka, kt, ct, cn, r, v, air, f):
        """Forces on the nodes of one fibre, element by element."""
        n = len(r) - 1
        for i in range(n + 1):
            share = 0.5 if i == 0 or i == n else 1.0
            f[i, 0] = share * mass * GRAVITY
            f[i, 1] = 0.0
            f[i, 2] = 0.0
        px = py = pz = plength = 0.0
        for j in range(n):
            ex = r[j + 1, 0] - r[j, 0]
            ey = r[j + 1, 1] - r[j, 1]
            ez = r[j + 1, 2] - r[j, 2]
            length = math.sqrt(ex * ex + ey * ey + ez * ez)
            tx, ty, tz = ex / length, ey / length, ez / length
            ux = air[j, 0] - 0.5 * (v[j, 0] + v[j + 1, 0])
            uy = air[j, 1] - 0.5 * (v[j, 1] + v[j + 1, 1])
            uz = air[j, 2] - 0.5 * (v[j, 2] + v[j + 1, 2])
            along = ux * tx + uy * ty + uz * tz
            nx, ny, nz = ux - along * tx, uy - along * ty, uz - along * tz
            a = 0.5 * ct * abs(along) ** 0.39 * along
            b = 0.5 * cn * (nx * nx + ny * ny + nz * nz) ** 0.28
            dx, dy, dz = a * tx + b * nx, a * ty + b * ny, a * tz + b * nz
            pull = ka * (length - l)
            f[j, 0] += dx + pull * tx
            f[j, 1] += dy + pull * ty
            f[j, 2] += dz + pull * tz
            f[j + 1, 0] += dx - pull * tx
            f[j + 1, 1] += dy - pull * ty
            f[j + 1, 2] += dz - pull * tz
            if j > 0:
                qx = py * tz - pz * ty
                qy = pz * tx - px * tz
                qz = px * ty - py * tx
                sine = math.sqrt(qx * qx + qy * qy + qz * qz)
                if sine > 0.0:
                    moment = kt * math.atan2(sine, px * tx + py * ty + pz * tz) / sine
                    m = moment / plength
                    ax, ay, az = m * (qy * pz - qz * py), m * (qz * px - qx * pz), m * (qx * py - qy * px)
                    m = moment / length
                    bx, by, bz = m * (qy * tz - qz * ty), m * (qz * tx - qx * tz), m * (qx * ty - qy * tx)
                    f[j - 1, 0] -= ax
                    f[j - 1, 1] -= ay
                    f[j - 1, 2] -= az
                    f[j, 0] += ax + bx
                    f[j, 1] += ay + by
                    f[j, 2] += az + bz
                    f[j + 1, 0] -= bx
                    f[j + 1, 1] -= by
                    f[j + 1, 2] -= bz
            px, py, pz, plength = tx, ty, tz, length

    @njit(fastmath=fastmath, error_model="numpy")
    def fly(l, mass, ka, kt, ct, cn, wind, h, steps, every, path):
        """Semi-implicit Euler from rest; wind [instant][eddy][component]."""
        n = wind.shape[1]
        r, v, f = np.zeros((n + 1, 3)), np.zeros((n + 1, 3)), np.zeros((n + 1, 3))
        air = np.zeros((n, 3))
        for i in range(n + 1):
            r[i, 0] = i * l
        for k in range(steps):
            if k % every == 0:
                path[k // every, 0] = r[n, 1]
                path[k // every, 1] = r[n, 2]
            x = k * h / WIND_SPACING
            m = int(x)
            s = x - m
            for j in range(n):
                for d in range(3):
                    air[j, d] = (1 - s) * wind[m, j, d] + s * wind[m + 1, j, d]
            forces(l, mass, ka, kt, ct, cn, r, v, air, f)
            for i in range(1, n + 1):
                weight = h / mass * (2.0 if i == n else 1.0)
                for d in range(3):
                    v[i, d] += weight * f[i, d]
                    r[i, d] += h * v[i, d]

    @njit(fastmath=fastmath, error_model="numpy")
    def fly_side_by_side(l, mass, ka, kt, ct, cn, wind, h, steps, every, path):
        """The same for many fibres, the last axis of every array; wind [instant][eddy][component][fibre].

        No branches inside the loop over fibres, so that the compiler may use vector instructions.
        """
        n, fibres = wind.shape[1], wind.shape[3]
        r, v, f = np.zeros((n + 1, 3, fibres)), np.zeros((n + 1, 3, fibres)), np.zeros((n + 1, 3, fibres))
        before = np.zeros((4, fibres))
        for i in range(n + 1):
            r[i, 0] = i * l
        for k in range(steps):
            if k % every == 0:
                path[k // every] = r[n, 1:]
            x = k * h / WIND_SPACING
            m = int(x)
            s = x - m
            for i in range(n + 1):
                share = 0.5 if i == 0 or i == n else 1.0
                f[i, 0] = share * mass * GRAVITY
                f[i, 1:] = 0.0
            for j in range(n):
                bend = 1.0 if j > 0 else 0.0
                above = j - 1 if j > 0 else 0
                for q in range(fibres):
                    ex = r[j + 1, 0, q] - r[j, 0, q]
                    ey = r[j + 1, 1, q] - r[j, 1, q]
                    ez = r[j + 1, 2, q] - r[j, 2, q]
                    length = math.sqrt(ex * ex + ey * ey + ez * ez)
                    inverse = 1.0 / length
                    tx, ty, tz = ex * inverse, ey * inverse, ez * inverse
                    ux = (1 - s) * wind[m, j, 0, q] + s * wind[m + 1, j, 0, q] - 0.5 * (v[j, 0, q] + v[j + 1, 0, q])
                    uy = (1 - s) * wind[m, j, 1, q] + s * wind[m + 1, j, 1, q] - 0.5 * (v[j, 1, q] + v[j + 1, 1, q])
                    uz = (1 - s) * wind[m, j, 2, q] + s * wind[m + 1, j, 2, q] - 0.5 * (v[j, 2, q] + v[j + 1, 2, q])
                    along = ux * tx + uy * ty + uz * tz
                    nx, ny, nz = ux - along * tx, uy - along * ty, uz - along * tz
                    a = 0.5 * ct * abs(along) ** 0.39 * along
                    b = 0.5 * cn * (nx * nx + ny * ny + nz * nz) ** 0.28
                    dx, dy, dz = a * tx + b * nx, a * ty + b * ny, a * tz + b * nz
                    pull = ka * (length - l)
                    px, py, pz = before[0, q], before[1, q], before[2, q]
                    qx = py * tz - pz * ty
                    qy = pz * tx - px * tz
                    qz = px * ty - py * tx
                    sine = math.sqrt(qx * qx + qy * qy + qz * qz) + 1e-300
                    moment = bend * kt * math.atan2(sine, px * tx + py * ty + pz * tz) / sine
                    m0 = moment * before[3, q]
                    ax, ay, az = m0 * (qy * pz - qz * py), m0 * (qz * px - qx * pz), m0 * (qx * py - qy * px)
                    m1 = moment * inverse
                    bx, by, bz = m1 * (qy * tz - qz * ty), m1 * (qz * tx - qx * tz), m1 * (qx * ty - qy * tx)
                    f[above, 0, q] -= ax
                    f[above, 1, q] -= ay
                    f[above, 2, q] -= az
                    f[j, 0, q] += dx + pull * tx + ax + bx
                    f[j, 1, q] += dy + pull * ty + ay + by
                    f[j, 2, q] += dz + pull * tz + az + bz
                    f[j + 1, 0, q] += dx - pull * tx - bx
                    f[j + 1, 1, q] += dy - pull * ty - by
                    f[j + 1, 2, q] += dz - pull * tz - bz
                    before[0, q], before[1, q], before[2, q], before[3, q] = tx, ty, tz, inverse
            for i in range(1, n + 1):
                weight = h / mass * (2.0 if i == n else 1.0)
                for d in range(3):
                    for q in range(fibres):
                        v[i, d, q] += weight * f[i, d, q]
                        r[i, d, q] += h * v[i, d, q]

    return forces, fly, fly_side_by_side


def main(folder):
    c = list(fibre().values())
    wind = read_wind(folder)
    exact = read_path(folder)
    each = [np.ascontiguousarray(wind[..., q]) for q in range(8)]
    wide = np.ascontiguousarray(np.tile(wind, (1, 1, 1, 8)))
    for fastmath in [False, True]:
        forces, fly, fly_side_by_side = make(fastmath)
        name = "Numba, fastmath" if fastmath else "Numba"

        def numpy_forces(constants, r, v, air):
            f = np.zeros_like(r)
            forces(*constants.values(), np.ascontiguousarray(r), np.ascontiguousarray(v), air, f)
            return f

        off = check_forces(numpy_forces, folder, name)
        for h, steps in [(1e-6, 20_000), (2e-5, 50_000)]:
            every = round(1e-3 / h)
            path = np.zeros((8, steps // every, 2))
            for q in range(8):
                fly(*c, each[q], h, steps, every, path[q])
            error = path_error(path, exact[:, : path.shape[1]])
            more = {"force_error": off}
            if h > 1e-6:
                more["path_error"] = error
            took = fastest(lambda: fly(*c, each[0], h, 20_000, every, path[0]), 1.0)
            row(name, 1, h, took / 20_000 / ELEMENTS * 1e9, **more)

            beside = np.zeros((steps // every, 2, 64))
            fly_side_by_side(*c, wide, h, steps, every, beside)
            beside = np.moveaxis(beside, 2, 0)[:8].transpose(0, 1, 2)
            error = path_error(beside, exact[:, : beside.shape[1]])
            if h > 1e-6:
                more["path_error"] = error
            room = np.zeros((steps // every, 2, 64))
            took = fastest(lambda: fly_side_by_side(*c, wide, h, 1_000, every, room), 1.0)
            row(name + ", fibres side by side", 64, h, took / 1_000 / ELEMENTS / 64 * 1e9, **more)


if __name__ == "__main__":
    main(sys.argv[1])
