"""The picture: both generators beside von Kármán's formulas."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from measures import BANDS, CORRELATIONS, SEPARATIONS, von_karman_spectra

SHOWN = {"spunlaid": {"marker": "o", "color": "#1b6ca8"}, "hipersim": {"marker": "s", "color": "#c8553d", "mfc": "none"}}
GREY = {"color": "0.45", "lw": 1, "zorder": 0}


def draw(path, formulas, found):
    figure, axes = plt.subplots(1, 4, figsize=(17, 4.2), constrained_layout=True)
    draw_spectra(axes[0], formulas, found)
    draw_coherences(axes[1], formulas, found)
    draw_correlations(axes[2], formulas, found, CORRELATIONS[:9])
    draw_correlations(axes[3], formulas, found, CORRELATIONS[9:])
    axes[0].legend(frameon=False)
    figure.savefig(path, dpi=110)


def draw_spectra(ax, formulas, found):
    centres = np.array([np.sqrt(low * high) for low, high in BANDS])
    k1 = np.geomspace(BANDS[0][0], BANDS[-1][1], 200)
    for component, factor in ((0, 1.0), (1, 0.3), (2, 0.1)):
        scale = (formulas[0] / von_karman_spectra(centres).T)[2, 0]
        ax.loglog(k1, factor * scale * k1 * von_karman_spectra(k1)[component], **GREY)
        ax.text(k1[0] * 0.75, factor * scale * k1[0] * von_karman_spectra(k1[:1])[component][0], "uvw"[component])
        for name, shift in (("spunlaid", 0.97), ("hipersim", 1.03)):
            mean, error = (values[:, component] * centres * factor for values in found[name][0])
            label = name if component == 0 else None
            ax.errorbar(centres * shift, mean, error, ls="none", ms=5, capsize=2, label=label, **SHOWN[name])
    ax.set(xlabel="$k_1 L$", title="$k_1 S(k_1)$ of u; of v × 0.3; of w × 0.1")


def draw_coherences(ax, formulas, found):
    centres = np.array([np.sqrt(low * high) for low, high in BANDS])
    r = SEPARATIONS.index(0.5)
    for way, offset, word in ((0, 0.0, "u along y"), (2, 0.5, "v along y, + 0.5"), (4, 1.0, "w along y, + 1")):
        curve = formulas[1][:, r, way] + offset
        ax.semilogx(centres, curve, **GREY)
        ax.text(centres[0], curve[0] + 0.06, word)
        for name, shift in (("spunlaid", 0.97), ("hipersim", 1.03)):
            mean, error = (values[:, r, way] for values in found[of_cut(name)][1])
            ax.errorbar(centres * shift, mean + offset, error, ls="none", ms=5, capsize=2, **SHOWN[name])
    ax.set(xlabel="$k_1 L$", title="coherence at r = L/2", ylim=(-0.25, 2))


def of_cut(name):
    return {"hipersim": "hipersim, cut"}.get(name, name)


def draw_correlations(ax, formulas, found, kinds):
    at = CORRELATIONS.index(kinds[0])
    separations = np.array(SEPARATIONS)
    for i, _ in enumerate(kinds):
        beside = 0.06 * (i - len(kinds) / 2) / len(kinds)
        ax.plot(separations + beside, formulas[2][:, at + i], **GREY)
        for name, shift in (("spunlaid", -0.012), ("hipersim", 0.012)):
            mean, error = (values[:, at + i] for values in found[of_cut(name)][2])
            ax.errorbar(separations + shift + beside, mean, error, ls="none", ms=4, **SHOWN[name])
    ax.set(xlabel="r / L", title="correlation: f and g" if at == 0 else "of two components, askew: (f − g)/2")
