"""MoorDyn: lumped masses in a current.

Cannot: drag coefficients that depend on the velocity, gravity along the flow other than by hanging the line
in a vertical current, turbulence tied to eddies along the line.
"""

import sys
import tempfile
from pathlib import Path

from model import *

INPUT = """--------------------- MoorDyn Input File -------------------------------------
The fibre of Table 1, hanging along z, in air that flows down at 10 m/s
----------------------- LINE TYPES -------------------------------------------
Name  Diam  MassDen  EA  BA/-zeta  EI  Cd  Ca  CdAx  CaAx
(name) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-)
fibre {diameter} {line_density} {ea} 0.0 {ei} {cd} 0.0 {cdax} 0.0
---------------------- POINTS ------------------------------------------------
ID  Attachment  X  Y  Z  M  V  CdA  CA
(#) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)
1 Fixed 0 0 -1 0 0 0 0
2 Free 0.01 0 -2 0 0 0 0
---------------------- LINES -------------------------------------------------
ID  LineType  AttachA  AttachB  UnstrLen  NumSegs  Outputs
(#) (name) (#) (#) (m) (-) (-)
1 fibre 1 2 1.0 20 -
---------------------- OPTIONS -----------------------------------------------
0 writeLog
{step} dtM
{scheme} tScheme
9.81 g
1.204 WtrDnsty
10 WtrDpth
3.0e6 kBot
3.0e5 cBot
1 Currents
0.0 TmaxIC
0.001 dtIC
1.0 threshIC
---------------------- NEED THIS LINE ----------------------------------------
"""
CURRENT = """--------------------- MoorDyn steady currents File ---------------------------
Depth (z), velocity
(m) (m/s) (m/s) (m/s)
-10.0 0.0 0.0 -10.0
0.0 0.0 0.0 -10.0
"""


def prepare(folder, scheme, step):
    area = math.pi * DIAMETER**2 / 4
    re = DIAMETER / VISCOSITY
    text = INPUT.format(
        diameter=DIAMETER,
        line_density=DENSITY * area,
        ea=MODULUS * area,
        ei=MODULUS * math.pi * DIAMETER**4 / 64,
        # The paper's laws at the mean flow along the fibre and the turbulence's rms across it.
        cd=6.96 * re**-0.44 * (DIAMETER / 78e-6) ** 0.404,
        cdax=BETA * (AIR_VELOCITY * re) ** -0.61,
        scheme=scheme,
        step=step,
    )
    (folder / "fibre.txt").write_text(text)
    (folder / "current_profile.txt").write_text(CURRENT)
    return str(folder / "fibre.txt")


def main(_):
    import moordyn

    def fly(scheme, step, duration):
        with tempfile.TemporaryDirectory() as name:
            system = moordyn.Create(prepare(Path(name), scheme, step))
            if moordyn.Init(system, [], []) != 0:
                raise RuntimeError("MoorDyn did not start")
            try:
                started = time.process_time()
                moordyn.Step(system, [], [], 0.0, duration)
                took = time.process_time() - started
                end = moordyn.GetPointPos(moordyn.GetPoint(system, 2))
            finally:
                moordyn.Close(system)
            if not all(math.isfinite(x) and abs(x) < 10 for x in end):
                raise RuntimeError("the fibre flew off")
            return took

    for scheme in ["Euler", "RK2"]:
        for step in [1e-6, 1e-5, 2e-5, 3e-5, 5e-5]:
            steps = 20_000
            try:
                took = min(fly(scheme, step, steps * step) for _ in range(4))
            except RuntimeError as reason:
                print(f"MoorDyn, {scheme}, does not hold at {step} s: {reason}", file=sys.stderr)
                break
            row(f"MoorDyn, {scheme}", 1, step, took / steps / ELEMENTS * 1e9)


if __name__ == "__main__":
    main(sys.argv[1])
