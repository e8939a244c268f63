"""Uniaxial compression of one specimen in Yade: yade -j1 -n -x compress.py FOLDER

Reads FOLDER/run.json and writes FOLDER/result.json (both: blind/engine_run.h).
"""

import json
import os
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.abspath(sys.argv[0])))

import numpy as np
import yade.config
from yade import O, utils

from ageing import Ageing, griffith
from bonded import Bonded, Platens
from specimen import Specimen

STEPS_PER_LOOK = 5  # between two looks at the platens
STRAIN_PER_CHANGE = 1e-4  # between two looks at the bonds
UNLOADED = 0.01  # of the force at which the platen turned
REST = 1e-3  # unbalanced force
STEPS_PER_SETTLING, MOST_SETTLING = 200, 200  # between two looks at it, and looks
OVERLAP = 2e-8  # m; beads that are to touch may overlap by the table's rounding


class Test:
    def __init__(self, run):
        self.specimen = Specimen(run)
        if len(self.specimen.gap) and self.specimen.gap.min() < -OVERLAP:
            raise SystemExit("run.json: beads overlap by %g m, expected beads that touch" % -self.specimen.gap.min())
        self.bonded = Bonded(self.specimen, run["engine"])
        self.ageing = Ageing(self.specimen)
        self.standing = np.ones(len(self.specimen.i), dtype=bool)
        self.broken, self.rows, self.frames = [], [], []
        self.speed = self.specimen.test["speed_m_per_s"]
        if self.specimen.theta("residual_stress") != 0:
            self.settle()
        self.platens = Platens(self.bonded)
        self.start = self.places()
        self.outer = self.outer_beads()
        self.unload_at, self.frame_at = list(self.specimen.test["unload_at"]), list(self.specimen.test["frame_at"])
        self.unloading = False
        self.platens.drive(self.speed)

    def places(self):
        return np.array([O.bodies[bead].state.pos for bead in self.bonded.beads])

    def settle(self):
        """To rest, without platens, under the stress that bonds have before the test."""
        for _ in range(MOST_SETTLING):
            for _ in range(STEPS_PER_SETTLING):
                O.step()
            self.look_at_bonds(0.0, 0.0)
            if utils.unbalancedForce() < REST:
                break
        for bead in self.bonded.beads:
            state = O.bodies[bead].state
            state.vel = state.angVel = (0, 0, 0)

    # Bonds

    def look_at_bonds(self, strain, elapsed):
        """Breaks bonds that are beyond their limit and lets the others age."""
        which = np.flatnonzero(self.standing)
        by_yade = [k for k in which if self.bonded.bond_of(k) is None]
        self.end(by_yade, strain)
        which = np.flatnonzero(self.standing)
        if not len(which):
            return
        s, bonds = self.specimen, [self.bonded.bonds[k] for k in which]
        stretch = np.array([-b.geom.penetrationDepth + b.phys.unp for b in bonds])
        shear = np.array([b.phys.shearForce.norm() / b.phys.ks for b in bonds])
        beyond = stretch**2 + shear**2 / 12 >= s.break_limit[which]
        if self.bonded.engine["breaking"] == "griffith":
            self.end(which[beyond], strain)
        else:
            beyond[:] = False
        if self.ageing.softens:
            self.soften(which[~beyond], stretch[~beyond], shear[~beyond])
        if self.ageing.creeps and elapsed > 0:
            self.creep(which[~beyond], stretch[~beyond], elapsed)

    def end(self, which, strain):
        for k in which:
            self.bonded.end_bond(k)
            self.standing[k] = False
            self.broken.append([strain, int(self.specimen.i[k]), int(self.specimen.j[k])])

    def soften(self, which, stretch, shear):
        before = self.ageing.left[which]
        for k, old, new in zip(which, before, self.ageing.stiffness_left(which, stretch, shear)):
            phys = self.bonded.bonds[k].phys
            phys.kn, phys.ks = new * self.specimen.kn[k], new * self.specimen.kt[k]
            phys.kr, phys.ktw = new * self.specimen.k_bend[k], new * self.specimen.k_twist[k]
            phys.shearForce = phys.shearForce * (new / old)
            self.bonded.set_glass(self.bonded.under[k], phys.kn)

    def creep(self, which, stretch, elapsed):
        bonds = [self.bonded.bonds[k] for k in which]
        slip = np.array([-b.phys.shearForce / b.phys.ks for b in bonds])
        normal = np.array([b.geom.normal for b in bonds])
        longer, slid = self.ageing.creep(which, stretch, slip, normal, elapsed)
        for bond, d, u in zip(bonds, longer.tolist(), slid.tolist()):
            bond.phys.unp -= d
            bond.phys.shearForce += bond.phys.ks * type(bond.phys.shearForce)(*u)

    # What is observed

    def outer_beads(self):
        """Beads of the middle third of the height within a diameter of its outermost one."""
        z, xy = self.start[:, 2], self.start[:, :2] - self.start[:, :2].mean(axis=0)
        low, high = z.min(), z.max()
        middle = (z >= low + (high - low) / 3) & (z <= low + 2 * (high - low) / 3)
        r = np.hypot(xy[:, 0], xy[:, 1])
        return np.flatnonzero(middle & (r >= r[middle].max(initial=0) - 2 * self.bonded.mean_radius))

    def lateral_strain(self):
        """Radial expansion of these beads by least squares, of those that still have a bond."""
        bonded = np.zeros(len(self.start), dtype=bool)
        bonded[self.specimen.i[self.standing]] = bonded[self.specimen.j[self.standing]] = True
        outer = self.outer[bonded[self.outer]]
        if len(outer) < 3:
            return 0.0
        now = np.array([O.bodies[self.bonded.beads[k]].state.pos for k in outer])[:, :2]
        r = self.start[outer, :2] - self.start[outer, :2].mean(axis=0)
        u = now - now.mean(axis=0) - r
        return float((u * r).sum() / (r * r).sum())

    def frame(self, strain):
        s, touching = self.specimen, []
        of_glass = {body: k for k, body in enumerate(self.bonded.glass)}
        for contact in O.interactions:
            if contact.id1 in of_glass and contact.id2 in of_glass and contact.geom.penetrationDepth > 0:
                touching.append(sorted((of_glass[contact.id1], of_glass[contact.id2])))
        bonds = np.stack([s.i[self.standing], s.j[self.standing]], axis=1)
        return {"strain": strain, "displacement_m": (self.places() - self.start).tolist(), "bonds": bonds.tolist(),
                "touching": sorted(touching)}

    # The course of the test

    def turn(self, read, force):
        """Back at a strain that is asked for, until hardly any load is left."""
        if self.unloading and force <= UNLOADED * self.turned_at:
            self.unloading = False
            self.platens.drive(self.speed)
        elif not self.unloading and self.unload_at and read >= self.unload_at[0]:
            self.unload_at.pop(0)
            self.unloading, self.turned_at = True, force
            self.platens.drive(-self.speed)

    def run(self):
        s, height = self.specimen, self.platens.height0
        s.height0 = height
        per_step = self.speed * O.dt / height
        looks_per_row = max(1, round(1 / (s.test["rows_per_strain"] * per_step * STEPS_PER_LOOK)))
        looks_per_change = max(1, round(STRAIN_PER_CHANGE / (per_step * STEPS_PER_LOOK)))
        sums, looks, read = np.zeros(4), 0, 0.0
        while read < s.test["max_strain"]:
            for _ in range(STEPS_PER_LOOK):
                O.step()
            looks += 1
            strain, top, bottom = self.platens.strain(), self.platens.force(1), self.platens.force(0)
            read, stress = s.read(strain, top)
            sums += read, stress, s.read(strain, bottom)[1], 1
            self.turn(read, top)
            if looks % looks_per_change == 0:
                self.look_at_bonds(strain, looks_per_change * STEPS_PER_LOOK * O.dt)
            if sums[3] == looks_per_row:
                self.rows.append((sums[:3] / sums[3]).tolist() + [len(self.broken), self.lateral_strain()])
                sums[:] = 0
            if self.frame_at and read >= self.frame_at[0] and not self.unloading:
                self.frames.append(self.frame(self.frame_at.pop(0)))


def write(folder, result):
    """Whole or not at all."""
    path = os.path.join(folder, "result.json")
    with open(path + ".part", "w") as file:
        json.dump(result, file)
    os.replace(path + ".part", path)


def main(folder):
    with open(os.path.join(folder, "run.json")) as file:
        run = json.load(file)
    start = time.perf_counter()
    test = Test(run)
    test.run()
    s = test.specimen
    write(folder, {
        "engine": "Yade " + yade.config.version, "beads": len(s.centre), "steps": O.iter,
        "seconds": time.perf_counter() - start,
        "bridges": {"pairs": np.stack([s.i, s.j], axis=1).tolist(), "gap_m": s.body_gap.tolist(),
                    "neck_m": s.neck.tolist()},
        "columns": ["strain", "stress_pa", "stress_bottom_pa", "broken_bonds", "lateral_strain"],
        "rows": test.rows, "frames": test.frames, "events": test.broken})


main(sys.argv[-1])
