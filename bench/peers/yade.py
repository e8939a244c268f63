# Compresses the bonded packing in the current folder with Yade: yade -j1 -n -x yade.py
#
# Reads   law.json   stiffness, friction, damping, time step, speed (SI), and what to run
#         beads.txt  x y z r, m (pendular convert, format yade)
#         bonds.txt  i j, places in beads.txt from 0
# Writes  curve.csv  strain, force_top_n, force_bottom_n, every steps_per_row steps
#         speed.json particle_steps_per_second, after warm_up_steps
#
# The law is Yade's JCFpm with its own limits off: a bond is a spring kn along the line of centres, at rest in
# the starting distance, and an incremental spring kt across it; torques about mid-gap, as in pendular
# (avoidGranularRatcheting off, or the arms would be radii). Platens only touch: k_glass, kt_glass, Coulomb.
#
# What JCFpm lacks is added in Python where law.json asks for it (compare: true), at twenty times the cost:
# - dashpots along the line of centres, of bonds and of beads that touch a platen;
# - the glass of a bonded pair that touches. Yade keeps one interaction per pair; it is given stiffness k_glass and
#   the rest length that keeps the force continuous. Then F = k_glass overlap + kn gap0, pendular's normal law, but
#   without friction in the glass.
# Otherwise Yade's local damping of accelerations stands in for dashpots, and bonded glass does not touch.

import json
import math
import time

from yade import (O, Bo1_Sphere_Aabb, Bo1_Wall_Aabb, ForceResetter, Ig2_Sphere_Sphere_ScGeom,
                  Ig2_Wall_Sphere_ScGeom, InsertionSortCollider, InteractionLoop,
                  Ip2_JCFpmMat_JCFpmMat_JCFpmPhys, JCFpmMat, Law2_ScGeom_JCFpmPhys_JointedCohesiveFrictionalPM,
                  NewtonIntegrator, PyRunner, Vector3, utils)


def rows(name, kind):
    with open(name) as lines:
        return [[kind(word) for word in line.split()] for line in lines if not line.startswith("#")]


def add_beads(beads, law):
    """Beads whose contact with a platen of infinite modulus has stiffness k_glass: JCFpm's 2 E R, harmonic mean."""
    ids = []
    for x, y, z, r in beads:
        glass = O.materials.append(JCFpmMat(
            type=0, density=law["density_kg_m3"], young=law["k_glass_n_per_m"] / (2 * r),
            poisson=law["kt_glass_n_per_m"] / law["k_glass_n_per_m"],
            frictionAngle=math.atan(law["platen_friction"]), tensileStrength=1e30, cohesion=1e30))
        ids.append(O.bodies.append(utils.sphere((x, y, z), r, material=glass)))
    return ids


def add_platens(beads, law):
    stiff = O.materials.append(JCFpmMat(
        type=1, young=1e30, poisson=law["kt_glass_n_per_m"] / law["k_glass_n_per_m"],
        frictionAngle=math.atan(law["platen_friction"]), tensileStrength=0, cohesion=0))
    low, high = min(z - r for _, _, z, r in beads), max(z + r for _, _, z, r in beads)
    bottom = O.bodies.append(utils.wall((0, 0, low), axis=2, sense=1, material=stiff))
    top = O.bodies.append(utils.wall((0, 0, high), axis=2, sense=-1, material=stiff))
    O.bodies[bottom].state.vel = (0, 0, law["speed_m_per_s"])
    return bottom, top, high - low


def add_bonds(pairs, ids, law):
    made = []
    for i, j in pairs:
        bond = utils.createInteraction(ids[i], ids[j])
        bond.phys.kn, bond.phys.ks = law["kn_n_per_m"], law["kt_n_per_m"]
        made.append([bond, ids[i], ids[j], -bond.geom.penetrationDepth, False])
    return made


def meet_platens(ids, bottom, top):
    """Interactions of platens with all beads that may come to touch them, so that none begins a step late."""
    made = []
    for platen, sign in (bottom, 1), (top, -1):
        for bead in ids:
            state, radius = O.bodies[bead].state, O.bodies[bead].shape.radius
            if sign * (state.pos[2] - O.bodies[platen].state.pos[2]) < 1.2 * radius:
                made.append((utils.createInteraction(platen, bead), bead, platen, sign))
    return made


def press_glass(bond, gap):
    """Gives a bond that has begun or ceased to touch its stiffness and rest length."""
    interaction, _, _, gap0, touched = bond
    if (gap <= 0) == touched:
        return
    bond[4] = not touched
    interaction.phys.kn = law["kn_n_per_m"] if touched else law["k_glass_n_per_m"]
    interaction.phys.initD = -gap0 * (1 if touched else law["kn_n_per_m"] / law["k_glass_n_per_m"])


def damp_pair(i, j, normal):
    """Dashpot along the normal, which points from j to i."""
    force = -law["dashpot_n_s_per_m"] * (O.bodies[i].state.vel - O.bodies[j].state.vel).dot(normal) * normal
    O.forces.addF(i, force)
    O.forces.addF(j, -force)


def add_what_yade_lacks():
    for bond in bonds:
        _, i, j, _, _ = bond
        apart = O.bodies[i].state.pos - O.bodies[j].state.pos
        distance = apart.norm()
        press_glass(bond, distance - O.bodies[i].shape.radius - O.bodies[j].shape.radius)
        damp_pair(i, j, apart / distance)
    for contact, bead, platen, sign in near_platens:
        if O.iter == 1:
            contact.phys.initD = 0  # Yade takes the separation of the first step
        if sign * (O.bodies[bead].state.pos[2] - O.bodies[platen].state.pos[2]) <= O.bodies[bead].shape.radius:
            damp_pair(bead, platen, Vector3(0, 0, sign))


def compress(law, bottom, top, height):
    beads = len(O.bodies) - 2
    with open("curve.csv", "w") as curve:
        curve.write("strain,force_top_n,force_bottom_n\n")
        start = time.perf_counter()
        while O.iter < law["steps"]:
            O.run(law["steps_per_row"], True)
            if O.iter == law["warm_up_steps"]:
                start = time.perf_counter()
            strain = law["speed_m_per_s"] * O.iter * O.dt / height
            curve.write("%.9g,%.9g,%.9g\n" % (strain, O.forces.f(top)[2], -O.forces.f(bottom)[2]))
        seconds = time.perf_counter() - start
    with open("speed.json", "w") as speed:
        json.dump({"particle_steps_per_second": beads * (O.iter - law["warm_up_steps"]) / seconds}, speed)


with open("law.json") as file:
    law = json.load(file)
beads, pairs = rows("beads.txt", float), rows("bonds.txt", int)
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()], verletDist=0.05 * max(b[3] for b in beads)),
    InteractionLoop([Ig2_Sphere_Sphere_ScGeom(avoidGranularRatcheting=False), Ig2_Wall_Sphere_ScGeom(noRatch=False)],
                    [Ip2_JCFpmMat_JCFpmMat_JCFpmPhys(cohesiveTresholdIteration=1)],
                    [Law2_ScGeom_JCFpmPhys_JointedCohesiveFrictionalPM(neverErase=law["compare"])]),
    NewtonIntegrator(damping=law["local_damping"], gravity=(0, 0, 0)),
]
O.dt = law["time_step_s"]
ids = add_beads(beads, law)
bottom, top, height = add_platens(beads, law)
bonds = add_bonds(pairs, ids, law)
if law["compare"]:
    near_platens = meet_platens(ids, bottom, top)
    O.engines = O.engines[:1] + [PyRunner(command="add_what_yade_lacks()", iterPeriod=1)] + O.engines[1:]
compress(law, bottom, top, height)
