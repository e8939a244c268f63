"""How bonds change as a test goes on: their breaking, and the effects that change their stiffness or rest length.

Called every so many steps with all standing bonds, as arrays. SI units.
"""

import numpy as np

LEAST_STIFFNESS = 0.05  # that is left of a softened bond
LOST_AT_BREAK = 0.9  # of a damaged one
RELAXATION_STRAIN = 0.01  # of the platen, where no relaxation time is stated


def griffith(stretch, shear):
    return np.sqrt(stretch**2 + shear**2 / 12)


class Ageing:
    """Factor on the stiffness and creep of each bond of a specimen, by its number."""

    def __init__(self, specimen):
        count = len(specimen.i)
        self.specimen = specimen
        self.left = np.ones(count)  # of the stiffness
        self.damage = np.zeros(count)
        self.crept, self.crept_shear = np.zeros(count), np.zeros((count, 3))
        stated = specimen.test["relaxation_time_s"]
        speed = specimen.run["test"]["speed_m_per_s"]  # as stated, whatever the run's
        self.time = stated if stated else RELAXATION_STRAIN * specimen.test["height_m"] / speed
        self.softens = bool({"polymer_nonlinearity", "bond_damage"} & set(specimen.effects))
        self.creeps = "polymer_viscoelasticity" in specimen.effects

    def stiffness_left(self, which, stretch, shear):
        """Share of the stiffness that these bonds now have."""
        specimen, strained = self.specimen, griffith(stretch, shear)
        left = np.ones(len(which))
        if "polymer_nonlinearity" in specimen.effects:
            lost = specimen.theta("polymer_nonlinearity") / 2 * strained / specimen.height[which]
            left *= np.maximum(1 - lost, LEAST_STIFFNESS)
        if "bond_damage" in specimen.effects:
            theta = specimen.theta("bond_damage")
            life = np.minimum(strained / np.sqrt(specimen.break_limit[which]), 1)
            lost = LOST_AT_BREAK * np.maximum(0, (life - (1 - theta)) / theta)
            self.damage[which] = np.maximum(self.damage[which], lost)
            left *= 1 - self.damage[which]
        self.left[which] = left
        return left

    def creep(self, which, stretch, slip, normal, elapsed):
        """What moves of rest length and of slip: a standard linear solid whose share θ follows the strain."""
        theta = self.specimen.theta("polymer_viscoelasticity")
        share = -np.expm1(-elapsed / self.time)
        moved = share * (stretch - (1 - theta) * self.crept[which])
        self.crept[which] += moved
        before = self.crept_shear[which]
        before -= np.sum(before * normal, axis=1)[:, None] * normal
        slid = share * (slip - (1 - theta) * before)
        self.crept_shear[which] = before + slid
        return theta * moved, theta * slid
