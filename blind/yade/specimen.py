"""A specimen as one run describes it (run.json, blind/engine_run.h), and what its effects make of it.

Coded from the guide of the effects (docs/effects.md), apart from the project's own code, with random numbers of its
own. SI units.
"""

import math
import zlib

import numpy as np

UM = 1e-6


def rim_height(gap, diameter_i, diameter_j, neck):
    """Height of a bridge at its rim: the gap and the sagittas of both caps at the neck's radius."""
    half = np.minimum(neck, 0.99 * np.minimum(diameter_i, diameter_j)) / 2
    sagittas = [d / 2 - np.sqrt((d / 2) ** 2 - half**2) for d in (diameter_i, diameter_j)]
    return gap + sagittas[0] + sagittas[1]


class Stiffness:
    """Stiffness of a bridge over that of the mean one, between the values of a table over gap and neck."""

    def __init__(self, table):
        self.gap = np.log(table["gap_m"])
        self.neck = np.array(table["neck_m"])
        self.values = {name: np.log(table[name]) for name in ("normal", "tangential", "bending", "twisting")}

    def __call__(self, name, gap, neck):
        x, kx = self._place(self.gap, np.log(gap))
        y, ky = self._place(self.neck, neck)
        v = self.values[name]
        low = v[kx, ky] * (1 - x) + v[kx + 1, ky] * x
        high = v[kx, ky + 1] * (1 - x) + v[kx + 1, ky + 1] * x
        return np.exp(low * (1 - y) + high * y)

    @staticmethod
    def _place(grid, at):
        """Share of the way through the cell that a value lies in, and that cell; the grid's ends hold beyond it."""
        at = np.clip(at, grid[0], grid[-1])
        cell = np.clip(np.searchsorted(grid, at) - 1, 0, len(grid) - 2)
        return (at - grid[cell]) / (grid[cell + 1] - grid[cell]), cell


class Specimen:
    """Beads, bonds and numbers of the law as they hold in truth."""

    def __init__(self, run):
        self.run = run
        self.effects = run["effects"]
        self.centre = np.array(run["beads"]["centre_m"])
        self.diameter = np.array(run["beads"]["diameter_m"])
        self.law = dict(run["law"])
        self.test = dict(run["test"])
        self._change_law()
        self._make_bonds()

    def theta(self, effect):
        return self.effects.get(effect, 0.0)

    def random(self, effect):
        return np.random.default_rng([self.run["seed"], zlib.crc32(effect.encode())])

    def _change_law(self):
        law = self.law
        for key, effect in ("friction", "bead_friction"), ("platen_friction", "platen_friction"):
            law[key] = max(0.0, law[key] + self.theta(effect))
        if "loading_rate" in self.effects:
            self.test["speed_m_per_s"] *= self.theta("loading_rate")

    def _make_bonds(self):
        run, law = self.run, self.law
        pairs = np.array(run["bridges"]["pairs"], dtype=int).reshape(-1, 2)
        neck = np.array(run["bridges"]["neck_m"])
        present = self.random("missing_bridges").random(len(pairs)) >= self.theta("missing_bridges")
        self.i, self.j = pairs[present].T
        di, dj = self.diameter[self.i], self.diameter[self.j]
        apart = np.linalg.norm(self.centre[self.i] - self.centre[self.j], axis=1)
        self.gap = apart - (di + dj) / 2
        self.rest = self.gap.copy()
        self.body_gap = np.full(len(self.i), law["gap_m"])
        self.neck = neck[present].copy()
        longer = self._spread_bodies()

        ratio = Stiffness(run["stiffness"])
        own = {name: ratio(name, self.body_gap, self.neck) for name in ratio.values}
        self.kn = law["kn_n_per_m"] * own["normal"]
        self.kt = law["kt_n_per_m"] * own["tangential"]
        self.k_bend = self.theta("bridge_bending") * law["k_bend_n_m_per_rad"] * own["bending"]
        self.k_twist = self.theta("bridge_bending") * law["k_twist_n_m_per_rad"] * own["twisting"]

        self.height = rim_height(self.gap + longer, di, dj, self.neck)
        self.break_limit = 2 * law["interfacial_energy_j_m2"] * self.height / law["youngs_modulus_pa"]
        self._change_strength()
        self.rest -= self.theta("residual_stress") * self.height

    def _spread_bodies(self):
        """Gaps and necks of their own; returns by how much bridges are longer."""
        count, law = len(self.i), self.law
        longer = np.zeros(count)
        if "bridge_gap_spread" in self.effects:
            excess = self.random("bridge_gap_spread").exponential(UM * self.theta("bridge_gap_spread"), count)
            longest = max(0.2 * law["diameter_m"], law["gap_m"])
            self.body_gap = np.minimum(self.body_gap + excess, longest)
            longer = self.body_gap - law["gap_m"]
        if "bridge_diameter_spread" in self.effects:
            off = self.random("bridge_diameter_spread").normal(0, UM * self.theta("bridge_diameter_spread"), count)
            farthest = 0.75 * self.neck
            self.neck = np.minimum(self.neck + np.clip(off, -farthest, farthest), 0.8 * law["diameter_m"])
        return longer

    def _change_strength(self):
        if "interface_strength" not in self.effects:
            return
        theta = self.theta("interface_strength")
        spread = abs(theta) / 2
        off = self.random("interface_strength").normal(-spread**2 / 2, spread, len(self.i))
        self.break_limit *= (1 + theta) * np.exp(off)

    def relief(self, platen):
        """By how much a platen's face lies back where each bead is; `platen` is 0 for the bottom, 1 for the top."""
        drawn = self.random("platen_roughness").normal(size=(2, len(self.centre)))
        return UM * self.theta("platen_roughness") * np.abs(drawn[platen])

    def slope(self):
        """Of the top platen along x and y, in a direction that is drawn."""
        slope = math.tan(math.radians(self.theta("platen_tilt")))
        way = self.random("platen_tilt").uniform(0, 2 * math.pi)
        return slope * math.cos(way), slope * math.sin(way)

    def read(self, strain, force):
        """Strain and stress as the instruments read them."""
        section = self.test["section_m2"]
        scale = 1 + self.theta("voxel_scale")
        given_way = UM * self.theta("machine_compliance") * force / self.height0
        return (strain + given_way) / scale, force / section / scale**2
