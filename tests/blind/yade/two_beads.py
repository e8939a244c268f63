"""Two bonded beads in Yade against closed forms: yade -j1 -n -x two_beads.py SCRIPTS

SCRIPTS is blind/yade. Writes one line for each quantity, what was found and what was expected, and ends with status 1
where one is off.
"""

import math
import sys

sys.path.insert(0, sys.argv[-1])

import numpy as np
from yade import O, Quaternion, Vector3

from bonded import Bonded
from specimen import Specimen

D, GAP, REST = 200e-6, 3e-6, 4e-6
KN, KT, K_BEND, K_TWIST, GLASS = 5000.0, 300.0, 2e-6, 1e-6, 10.0
ENERGY, MODULUS = 7.0, 1.5e6
WAY, STEPS = 1e-8, 1000


def run_of(gap, breaking, effects):
    flat = [[1.0, 1.0], [1.0, 1.0]]
    return {
        "engine": {"glass": "linear", "breaking": breaking, "local_damping": 0.0}, "seed": 1, "effects": effects,
        "law": {"kn_n_per_m": KN, "kt_n_per_m": KT, "k_bend_n_m_per_rad": K_BEND, "k_twist_n_m_per_rad": K_TWIST,
                "k_glass_n_per_m": GLASS * KN, "kt_glass_n_per_m": GLASS * KT, "friction": 0.5, "platen_friction": 0.5,
                "density_kg_m3": 2540, "diameter_m": D, "gap_m": 2e-6, "interfacial_energy_j_m2": ENERGY,
                "youngs_modulus_pa": MODULUS},
        "test": {"speed_m_per_s": 0.05},
        "stiffness": dict({"gap_m": [2e-6, 4e-5], "neck_m": [2e-5, 1.6e-4]},
                          **{name: flat for name in ("normal", "tangential", "bending", "twisting")}),
        "beads": {"centre_m": [[0, 0, 0], [0, 0, D + gap]], "diameter_m": [D, D]},
        "bridges": {"pairs": [[0, 1]], "neck_m": [7e-5]}}


def pair(gap=GAP, breaking="griffith", effects=None):
    O.reset()
    bonded = Bonded(Specimen(run_of(gap, breaking, effects or {})), run_of(gap, breaking, {})["engine"])
    for bead in bonded.beads:
        O.bodies[bead].state.blockedDOFs = "xyzXYZ"
    O.dt = 1e-8
    return bonded


def moved(bonded, velocity=(0, 0, 0), spin=(0, 0, 0), way=WAY, both=False):
    """The second bead at constant velocity or spin (by `way`, m or rad); force and torque on it at the end."""
    rate = way / (STEPS * O.dt)
    for bead, sign in zip(bonded.beads, (-1 if both else 0, 1)):
        O.bodies[bead].state.vel = sign * rate * Vector3(*velocity)
        O.bodies[bead].state.angVel = sign * rate * Vector3(*spin)
    for _ in range(STEPS + 1):  # forces are those of the step's beginning
        O.step()
    return O.forces.f(bonded.carrier[1]), O.forces.t(bonded.carrier[1]), O.forces.f(bonded.glass[1])


def strength(breaking, velocity):
    """How far the second bead moves until the bond breaks."""
    bonded = pair(breaking=breaking)
    O.bodies[bonded.beads[1]].state.vel = 0.05 * Vector3(*velocity)
    limit, start = bonded.specimen.break_limit[0], O.bodies[bonded.beads[1]].state.pos
    for _ in range(100_000):
        O.step()
        bond = bonded.bond_of(0)
        if bond is None:
            break
        stretch = -bond.geom.penetrationDepth + bond.phys.unp
        shear = bond.phys.shearForce.norm() / bond.phys.ks
        if breaking == "griffith" and stretch**2 + shear**2 / 12 >= limit:
            break
    return (O.bodies[bonded.beads[1]].state.pos - start).norm()


failed = False


def check(what, found, expected, tolerance):
    global failed
    off = abs(found / expected - 1)
    failed |= not off <= tolerance
    print("%-46s %.6g expected %.6g off by %.1e" % (what, found, expected, off))


arm = (D + GAP) / 2
force, _, _ = moved(pair(), velocity=(0, 0, 1))
check("normal stiffness, N/m", -force[2] / WAY, KN, 1e-6)
force, torque, _ = moved(pair(), velocity=(1, 0, 0))
check("shear stiffness, N/m", -force[0] / WAY, KT, 1e-4)
check("torque of shear about mid-gap, N", -torque[1] / WAY, -KT * arm, 1e-3)
bent = pair(effects={"bridge_bending": 1.0})
_, torque, _ = moved(bent, spin=(1, 0, 0), way=1e-4, both=True)
check("bending, N m/rad", -torque[0] / 2e-4, K_BEND, 1e-3)
_, torque, _ = moved(pair(effects={"bridge_bending": 1.0}), spin=(0, 0, 1), way=1e-4, both=True)
check("twisting, N m/rad", -torque[2] / 2e-4, K_TWIST, 1e-3)
force, _, glass = moved(pair(gap=0.0), velocity=(0, 0, -1))
check("glass and bond in overlap, N/m", (force[2] + glass[2]) / WAY, GLASS * KN, 1e-6)

height = GAP + D - 2 * math.sqrt(D**2 / 4 - 3.5e-5**2)
limit = math.sqrt(2 * ENERGY * height / MODULUS)
for breaking in "griffith", "limits":
    check("tensile strength (%s), m" % breaking, strength(breaking, (0, 0, 1)), limit, 1e-3)
# Bead centres move on a line: the gap opens by what is of second order.
check("shear strength (limits), m", strength("limits", (1, 0, 0)), math.sqrt(12) * limit, 3e-2)
sys.exit(failed)
