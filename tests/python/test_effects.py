"""Effects written in Python act, are found as the built-in ones, and fail in words."""

import unittest

import numpy as np

import pendular
from support import RELAXED, InScratchFolder


def softer(bonds, theta):
    bonds.kn_n_per_m *= 1.0 - theta
    bonds.kt_n_per_m *= 1.0 - theta


def effect(**hooks):
    told = {"id": "soft_bridges", "name": "softer bridges", "sentence": "All bridges are softer than stated.",
            "meaning": "share of stiffness that is lost", "highest": 0.9, "bank": (0.0, 0.5), **hooks}
    return pendular.Effect(**told)


class Effects(InScratchFolder):
    sample_text = RELAXED

    def setUp(self):
        super().setUp()
        self.packing = pendular.generate(self.sample)

    def add(self, **hooks):
        added = pendular.add_effect(effect(**hooks))
        self.addCleanup(lambda: added.id in {one["id"] for one in pendular.effects()} and pendular.remove_effect(added.id))
        return added

    def run_with(self, theta, name="run", **how):
        sample = self.sample.changed({"effects.soft_bridges": theta}) if theta else self.sample
        return pendular.compress(self.packing, sample, self.folder / name, **how)

    def test_bonds_before_a_test(self):
        seen = {}

        def before(bonds, theta):
            seen.update({name: np.array(getattr(bonds, name)) for name in ("i", "j", "gap_m", "uniform", "z_m")})
            softer(bonds, theta)

        self.add(before=before)
        stiff, soft = self.run_with(0.0, "stiff"), self.run_with(0.5, "soft")
        self.assertLess(soft.modulus_pa, 0.8 * stiff.modulus_pa)
        self.assertEqual(len(seen["i"]), stiff.result["bonds"])
        self.assertTrue(np.all((seen["uniform"] >= 0.0) & (seen["uniform"] < 1.0)))
        first = seen["uniform"]
        self.run_with(0.2, "other_theta")
        np.testing.assert_array_equal(seen["uniform"], first)

    def test_it_is_what_the_built_in_one_does(self):
        """bond_damage, written again."""

        def step(bonds, theta):
            life = np.minimum(np.sqrt(bonds.stretch_m**2 + bonds.shear_m**2 / 12.0) / np.sqrt(bonds.break_limit_m2), 1.0)
            lost = np.maximum(0.9 * np.maximum(0.0, (life - (1.0 - theta)) / theta), bonds.memory[:, 0])
            factor = (1.0 - lost) / (1.0 - bonds.memory[:, 0])
            for name in ("kn_n_per_m", "kt_n_per_m", "k_bend_n_m_per_rad", "k_twist_n_m_per_rad"):
                setattr(bonds, name, getattr(bonds, name) * factor)
            bonds.memory[:, 0] = lost

        self.add(step=step, memory=1)
        ours = self.run_with(0.8, "ours")
        theirs = pendular.compress(self.packing, self.sample.changed({"effects.bond_damage": 0.8}), self.folder / "theirs")
        np.testing.assert_allclose(ours.curve["stress_pa"], theirs.curve["stress_pa"], rtol=1e-6)
        self.assertFalse(np.array_equal(ours.curve["stress_pa"], self.run_with(0.0, "plain").curve["stress_pa"]))

    def test_it_goes_on_from_a_checkpoint(self):
        class Stop(Exception):
            pass

        def stop(*_):
            raise Stop

        def step(bonds, theta):
            bonds.kn_n_per_m *= 1.0 - 0.01 * theta
            bonds.memory += 1.0

        self.add(step=step, memory=2)
        with self.assertRaises(Stop):
            self.run_with(0.5, "run", progress=stop)
        self.assertTrue((self.folder / "run" / "checkpoint").exists())
        resumed, whole = self.run_with(0.5, "run", resume=True), self.run_with(0.5, "whole")
        self.assert_same(resumed.curve, whole.curve)

    def test_what_it_throws_names_it_and_keeps_the_cause(self):
        def broken(bonds, theta):
            raise ZeroDivisionError("of nothing")

        for hook in ("before", "step"):
            self.add(**{hook: broken})
            with self.assertRaisesRegex(pendular.ComputationError, f"soft_bridges: {hook}: ZeroDivisionError: of nothing") as raised:
                self.run_with(0.5)
            self.assertIsInstance(raised.exception.__cause__, ZeroDivisionError)

    def test_what_is_no_number_names_it(self):
        def no_number(bonds, theta):
            bonds.kn_n_per_m[3] = np.nan

        def negative(bonds, theta):
            bonds.kt_n_per_m[4] = -1.0

        def too_few(bonds, theta):
            bonds.break_limit_m2 = bonds.break_limit_m2[1:]

        def words(bonds, theta):
            bonds.kn_n_per_m = "stiff"

        def misspelt(bonds, theta):
            bonds.kn = 1.0

        for wrong, told in ((no_number, "kn_n_per_m of bond 3: found nan"), (negative, "kt_n_per_m of bond 4: found -1"),
                            (too_few, "break_limit_m2: found"), (words, "kn_n_per_m: found"), (misspelt, "AttributeError")):
            for hook in ("before", "step"):
                with self.subTest(told=told, hook=hook):
                    self.add(**{hook: wrong})
                    with self.assertRaisesRegex(pendular.ComputationError, f"soft_bridges: {hook}: .*{told}"):
                        self.run_with(0.5)

    def test_definitions_that_make_no_effect(self):
        for wrong, told in (({}, "neither"), ({"before": 3}, "before"), ({"before": softer, "bank": (0.1, 0.5)}, "range"),
                            ({"before": softer, "unit": ""}, "unit"), ({"before": softer, "id": "bond_damage"}, "bond_damage")):
            with self.subTest(told=told), self.assertRaisesRegex(pendular.InputError, told):
                pendular.add_effect(effect(**wrong))
        with self.assertRaisesRegex(pendular.InputError, "soft_bridges"):
            self.sample.changed({"effects.soft_bridges": 0.5})

    def test_runs_of_a_sweep_are_known_by_what_the_effect_does(self):
        def sweep(name):
            return pendular.sweep({"sweep": {"sample": self.sample},
                                   "grid": {"effects.soft_bridges": [0.0, 0.5], "compression.max_strain": [0.02]}},
                                  self.folder / name, store=self.folder / "store")

        self.add(before=softer)
        first, again = sweep("first"), sweep("again")
        self.assertEqual(first.folders, again.folders)
        moduli = first.results["linear_modulus_pa"]
        self.assertLess(moduli[1], moduli[0])
        factor = 0.1

        def softer_still(bonds, theta):
            bonds.kn_n_per_m *= factor

        self.add(before=softer_still)
        other = sweep("other")
        self.assertEqual(other.folders[0], first.folders[0])  # made without the effect
        self.assertNotEqual(other.folders[1], first.folders[1])

    def test_a_run_that_fails_is_in_the_table(self):
        def broken(bonds, theta):
            raise ValueError("not today")

        self.add(before=broken)
        with self.assertWarnsRegex(pendular.PendularWarning, "1 of 2 runs failed"):
            done = pendular.sweep({"sweep": {"sample": self.sample},
                                   "grid": {"effects.soft_bridges": [0.0, 0.5], "compression.max_strain": [0.004]}},
                                  self.folder / "sweep")
        self.assertEqual(done.results["status"].tolist(), ["done", "failed"])
        self.assertIn("not today", done.results["message"][1])
        self.assertIsNone(done.folders[1])


if __name__ == "__main__":
    unittest.main()
