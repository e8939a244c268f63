"""The specimen's bodies and interactions in Yade.

Yade keeps one interaction per pair of bodies; a bonded pair that touches needs two: a bond, and glass. Each bead is
therefore a clump of two concentric spheres: one of glass, which the collider sees, and one that only carries bonds.

Law of a bond: Law2_ScGeom6D_CohFrictPhys_CohesionMoment about mid-gap, with
  normal      kn (δn − δ0), also in overlap;
  shear       incremental, kt; no limit of Coulomb's;
  bending     k_bend and k_twist times the relative rotation, where there are any.
Law of the glass: Law2_ScGeom_FrictPhys_CundallStrack, k_glass and kt_glass with Coulomb's limit. Below a bond it has
kn less, so that the two together are k_glass, and as much more friction, so that its limit stays that of k_glass.
With glass = "hertz": Law2_ScGeom_MindlinPhys_Mindlin without adhesion, of the stiffness that makes the force at an
overlap of D/200 the same, and of the Poisson ratio that makes tangential over normal stiffness the same; nothing is
taken off below bonds.
Breaking: "griffith": tested from outside (compress.py), on the ellipse. "limits": by Yade at a force in tension and a
force in shear, the ends of that ellipse's axes; compression does not break.
"""

import math

from yade import (O, Bo1_Sphere_Aabb, CohFrictMat, ForceResetter, FrictMat, Ig2_Box_Sphere_ScGeom,
                  Ig2_Sphere_Sphere_ScGeom6D, InsertionSortCollider, InteractionLoop,
                  Ip2_CohFrictMat_CohFrictMat_CohFrictPhys, Ip2_FrictMat_FrictMat_FrictPhys,
                  Ip2_FrictMat_FrictMat_MindlinPhys, Law2_ScGeom6D_CohFrictPhys_CohesionMoment,
                  Law2_ScGeom_FrictPhys_CundallStrack, Law2_ScGeom_MindlinPhys_Mindlin, NewtonIntegrator, Quaternion,
                  Vector3, utils)

NO_LIMIT = 1e30
HERTZ_OVERLAP = 1 / 200  # over D, where Hertz's force is that of the linear contact
STEP = 0.3  # over √(m_min / k_max)
PLATEN_REACH = 3  # diameters within which a bead may come to touch a platen
GLASS, BOND = 1, 2  # members of a clump, and their masks


class Bonded:
    """Bodies of a specimen; `engine` says glass, breaking and local damping."""

    def __init__(self, specimen, engine):
        self.specimen, self.engine = specimen, engine
        self.hertz = engine["glass"] == "hertz"
        self.mean_radius = float(specimen.diameter.mean()) / 2
        self._set_engines()
        self._add_beads()
        self.bonds = [self._bond(k) for k in range(len(specimen.i))]
        self.under = [self._glass_under(k) for k in range(len(specimen.i))]

    def _set_engines(self):
        contact = ([Ip2_FrictMat_FrictMat_MindlinPhys()], [Law2_ScGeom_MindlinPhys_Mindlin(neverErase=True)])
        if not self.hertz:
            contact = [Ip2_FrictMat_FrictMat_FrictPhys()], [Law2_ScGeom_FrictPhys_CundallStrack(neverErase=True)]
        # Arms that end in mid-gap, or a pair that turns as a rigid body would be sheared.
        spheres = Ig2_Sphere_Sphere_ScGeom6D(avoidGranularRatcheting=False)
        O.engines = [
            ForceResetter(),
            InsertionSortCollider([Bo1_Sphere_Aabb()], verletDist=0.1 * self.mean_radius),
            InteractionLoop([spheres, Ig2_Box_Sphere_ScGeom()],
                            contact[0] + [Ip2_CohFrictMat_CohFrictMat_CohFrictPhys()],
                            contact[1] + [Law2_ScGeom6D_CohFrictPhys_CohesionMoment()]),
            NewtonIntegrator(damping=self.engine["local_damping"], gravity=(0, 0, 0)),
        ]

    def glass_material(self, radius, friction):
        """Glass whose contacts have k_glass whatever the beads: the harmonic mean of Young's modulus × radius."""
        law = self.specimen.law
        angle = math.atan(friction)
        if self.hertz:
            overlap = HERTZ_OVERLAP * 2 * self.mean_radius
            effective = 0.75 * law["k_glass_n_per_m"] / math.sqrt(overlap * self.mean_radius / 2)
            ratio = law["kt_glass_n_per_m"] / law["k_glass_n_per_m"]  # 2 (1 − ν) / (2 − ν) after Mindlin
            poisson = 2 * (1 - ratio) / (2 - ratio)
            return FrictMat(young=2 * (1 - poisson**2) * effective, poisson=poisson, frictionAngle=angle)
        return FrictMat(young=law["k_glass_n_per_m"] / radius, frictionAngle=angle,
                        poisson=law["kt_glass_n_per_m"] / law["k_glass_n_per_m"])

    def _add_beads(self):
        law = self.specimen.law
        carrier = O.materials.append(CohFrictMat(isCohesive=True, momentRotationLaw=True))
        self.beads, self.glass, self.carrier, masses = [], [], [], []
        for centre, diameter in zip(self.specimen.centre.tolist(), self.specimen.diameter.tolist()):
            radius = diameter / 2
            glass = O.materials.append(self.glass_material(radius, law["friction"]))
            bead, (outer, inner) = O.bodies.appendClumped(
                [utils.sphere(centre, radius, material=glass, mask=GLASS),
                 utils.sphere(centre, radius, material=carrier, mask=BOND)])
            O.bodies[inner].bounded = False
            masses.append(law["density_kg_m3"] * math.pi / 6 * diameter**3)
            state = O.bodies[bead].state
            state.mass, state.inertia = masses[-1], 0.4 * masses[-1] * radius**2 * Vector3(1, 1, 1)
            O.bodies[bead].aspherical = False
            self.beads.append(bead), self.glass.append(outer), self.carrier.append(inner)
        stiffest = max(law["k_glass_n_per_m"], float(self.specimen.kn.max(initial=0)))
        O.dt = STEP * math.sqrt(min(masses) / stiffest)

    def _bond(self, k):
        s = self.specimen
        bond = utils.createInteraction(self.carrier[s.i[k]], self.carrier[s.j[k]])
        phys = bond.phys
        phys.kn, phys.ks, phys.kr, phys.ktw = s.kn[k], s.kt[k], s.k_bend[k], s.k_twist[k]
        phys.momentRotationLaw = bool(s.k_bend[k] > 0)
        phys.maxRollPl = phys.maxTwistPl = -1  # elastic
        phys.unp = -s.rest[k]
        phys.cohesionBroken, phys.initCohesion, phys.fragile = False, False, True
        phys.cohesionDisablesFriction = True
        phys.normalAdhesion = phys.shearAdhesion = NO_LIMIT
        if self.engine["breaking"] == "limits":
            phys.normalAdhesion = s.kn[k] * math.sqrt(s.break_limit[k])
            phys.shearAdhesion = s.kt[k] * math.sqrt(12 * s.break_limit[k])
        return bond

    def _glass_under(self, k):
        """The glass of a bonded pair."""
        contact = utils.createInteraction(self.glass[self.specimen.i[k]], self.glass[self.specimen.j[k]])
        self.set_glass(contact, self.specimen.kn[k])
        return contact

    def set_glass(self, contact, bond):
        """Stiffness of the glass of a pair whose bond has this one; 0: none."""
        if self.hertz:
            return
        law = self.specimen.law
        rest = max(law["k_glass_n_per_m"] - bond, 0.1 * law["k_glass_n_per_m"])
        contact.phys.kn, contact.phys.ks = rest, law["kt_glass_n_per_m"]
        contact.phys.tangensOfFrictionAngle = law["friction"] * law["k_glass_n_per_m"] / rest

    def bond_of(self, k):
        """The interaction of bond k, or nothing where it has broken."""
        bond = self.bonds[k]
        return bond if bond.isReal and not bond.phys.cohesionBroken else None

    def end_bond(self, k):
        """Breaks bond k; the glass below it is then that of any pair."""
        if self.bonds[k].isReal:
            O.interactions.erase(self.bonds[k].id1, self.bonds[k].id2)
        self.set_glass(self.under[k], 0.0)


class Platens:
    """Two plates that only touch. Each bead near one meets a plate of its own, set back by the relief there; all
    plates of a platen move as one. The top one may be tilted."""

    def __init__(self, bonded):
        self.bonded, self.specimen = bonded, bonded.specimen
        along_x, along_y = self.specimen.slope()
        self.normals = [Vector3(0, 0, 1), Vector3(along_x, along_y, -1).normalized()]
        faces = [self._faces(side) for side in (0, 1)]
        # Where they just touch the outermost beads.
        self.offset = [min(faces[0]), max(faces[1])]
        self.height0 = self.offset[1] - self.offset[0]
        self.plates = [self._plates(side, faces[side]) for side in (0, 1)]

    def _places(self):
        return [O.bodies[bead].state.pos for bead in self.bonded.beads]

    def _axis(self, height):
        test = self.specimen.test
        return Vector3(test["axis_x_m"], test["axis_y_m"], height)

    def _faces(self, side):
        """Height on the axis of a platen that just touches each bead."""
        relief, normal = self.specimen.relief(side), self.normals[side]
        radii, axis = self.specimen.diameter / 2, self._axis(0)
        return [axis[2] + (normal.dot(place - axis) - radius + back) / normal[2]
                for place, radius, back in zip(self._places(), radii.tolist(), relief.tolist())]

    def _plates(self, side, faces):
        law, normal, places = self.specimen.law, self.normals[side], self._places()
        relief = self.specimen.relief(side)
        reach = PLATEN_REACH * 2 * self.bonded.mean_radius
        width = 2 * max(max(abs(p[0]), abs(p[1])) for p in places) + reach
        half = 0.5 * reach
        turn = Quaternion()
        turn.setFromTwoVectors(Vector3(0, 0, 1), normal)
        point, plates = self._axis(self.offset[side]), []
        for k, face in enumerate(faces):
            if abs(face - self.offset[side]) > reach:
                continue
            surface = O.materials.append(
                self.bonded.glass_material(self.specimen.diameter[k] / 2, law["platen_friction"]))
            centre = point - (half + float(relief[k])) * normal
            plate = O.bodies.append(
                utils.box(centre, (width, width, half), orientation=turn, fixed=True, material=surface))
            O.bodies[plate].bounded = False
            utils.createInteraction(plate, self.bonded.glass[k])
            plates.append(plate)
        return plates

    def drive(self, speed):
        """The bottom one's, upwards."""
        for plate in self.plates[0]:
            O.bodies[plate].state.vel = (0, 0, speed)

    def force(self, side):
        """On a platen, compression positive."""
        sign = (-1, 1)[side]
        return sign * sum(O.forces.f(plate)[2] for plate in self.plates[side])

    def strain(self):
        moved = O.bodies[self.plates[0][0]].state.displ()[2] if self.plates[0] else 0.0
        return moved / self.height0
