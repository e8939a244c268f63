"""What is wrong is said of the argument, before anything is written."""

import unittest
import warnings

import numpy as np

import pendular
from support import InScratchFolder


class BadInput(InScratchFolder):
    def check(self, error, words, call, *args, **how):
        with self.assertRaises(error) as raised:
            call(*args, **how)
        text = str(raised.exception)
        for word in words:
            self.assertIn(word, text)
        self.assertNotIn("\n", text)

    def test_volumes(self):
        good = np.arange(60, dtype=np.uint16).reshape(3, 4, 5)
        holed = good.astype(np.float32)
        holed[1, 2, 3] = np.nan
        for grey, words in ((good.astype(np.int32), ("<i4", "expected uint8, uint16 or float32")),
                            (good.astype(">u2"), (">u2", "byte order")),
                            (np.asfortranarray(good), ("contiguous", "ascontiguousarray")),
                            (good[:, ::2], ("contiguous",)),
                            (good[0], ("2 dimensions", "three")),
                            (good[:0], ("empty",)),
                            (good.tolist(), ("list", "NumPy array")),
                            (np.zeros_like(good), ("one grey value",)),
                            (holed, ("voxel (3, 2, 1)", "NaN"))):
            with self.subTest(words=words):
                self.check(pendular.InputError, ("grey", "found", "expected", *words), pendular.Volume, grey, 5.0)
        for size in (0.0, -1.0, float("nan"), 1e9):
            self.check(pendular.InputError, ("voxel_um",), pendular.Volume, good, size)
        self.check(pendular.InputError, ("volume", "ndarray"), pendular.segment, good)
        self.check(pendular.InputError, ("voxel_um",), pendular.segment, pendular.Volume(good, 5.0), voxel_um=4.0)

    def test_beads(self):
        beads = np.array(pendular.generate(self.sample).beads)
        no_number = beads.copy()
        no_number["y_m"][7] = np.nan
        twice = beads.copy()
        twice["bead_id"][3] = twice["bead_id"][2]
        negative = beads.copy()
        negative["sigma_centre_m"][0] = -1e-6
        names = [name for name in beads.dtype.names if name != "z_m"]
        texts = beads.astype([(n, "U8" if n == "x_m" else beads.dtype[n]) for n in beads.dtype.names])
        for wrong, words in ((np.zeros((3, 4)), ("structured",)), (beads[:0], ("empty",)),
                             (beads[names], ("z_m", "missing")), (no_number, ("y_m", "row 7", "nan")),
                             (twice, (str(beads["bead_id"][2]),)), (negative, ("sigma_centre", "row 0")),
                             (beads.reshape(1, -1), ("2 dimensions",)), (texts, ("x_m", "dtype")), (None, ("NoneType",))):
            with self.subTest(words=words):
                self.check(pendular.InputError, ("beads", *words), pendular.pack, wrong, self.sample)
        self.assertEqual(len(pendular.Packing(beads[::2]).beads), len(beads[::2]))  # rows may be picked

    def test_bridges(self):
        packing = pendular.generate(self.sample)
        for field, value, words in (("i", -1, ("found beads",)), ("j", 10**6, ("found beads",)), ("state", 9, ("state",))):
            wrong = packing.bridges.copy()
            wrong[field][2] = value
            self.check(pendular.InputError, ("bridges", *words), pendular.Packing, packing.beads, wrong)
        double = np.concatenate([packing.bridges, packing.bridges[:1]])
        self.check(pendular.InputError, ("bridges", "twice"), pendular.Packing, packing.beads, double)

    def test_samples(self):
        self.check(pendular.InputError, ("bridges.gap_um",), self.sample.changed, {"bridges.gap_u": 3})
        self.check(pendular.InputError, ("bridges.gap_um", "found"), self.sample.changed, {"bridges.gap_um": -3})
        self.check(pendular.InputError, ("bridges.gap_um",), self.sample.changed, {"bridges.gap_um": "wide"})
        self.check(pendular.InputError, ("contact.friction",), self.sample.changed, {"contact.friction": object()})
        self.check(pendular.InputError, ("effects.missing_bridge", "missing_bridges"), self.sample.changed,
                   {"effects.missing_bridge": 0.1})
        self.check(KeyError, ("contact.frictio",), self.sample.__getitem__, "contact.frictio")
        self.check(pendular.InputError, ("sample", "int"), pendular.compress, pendular.generate(self.sample), 3,
                   self.folder / "run")

    def test_files(self):
        for read in (pendular.read_beads, pendular.read_packing, pendular.read_volume, pendular.read_sample,
                     pendular.read_table, pendular.read_run):
            with self.subTest(read=read.__name__):
                self.check(pendular.InputError, ("absent",), read, self.folder / "absent.vtp")
        (self.folder / "cells.csv").write_text("a,b\n1,2\n3\n")
        self.check(pendular.InputError, ("cells.csv:3", "1 cells", "expected 2"), pendular.read_table,
                   self.folder / "cells.csv")
        (self.folder / "beads.csv").write_text("bead_id,x_um,y_um,z_um,diameter_um\n1,0,wide,0,200\n")
        self.check(pendular.InputError, ("beads.csv:2", "y_um"), pendular.read_beads, self.folder / "beads.csv")
        self.check(pendular.UsageError, ("view", "sideways"), pendular.render, self.folder, view="sideways")
        self.check(pendular.InputError, ("strain",), pendular.modulus, pendular.generate(self.sample), self.sample,
                   strain=3.0)

    def test_bridges_by_finite_elements(self):
        self.check(pendular.InputError, ("d_um", "wide"), pendular.bridge, d_um="wide")
        self.check(pendular.InputError, ("gap_um", "empty"), pendular.bridge, gap_um=[])
        self.check(pendular.InputError, ("broadcast",), pendular.bridge, d_um=[60, 70], gap_um=[1, 2, 3])
        self.check(pendular.InputError, ("expected",), pendular.bridge, d_um=-5)

    def test_classes_of_errors(self):
        self.assertTrue(issubclass(pendular.InputError, ValueError))
        self.assertEqual([c.exit_status for c in (pendular.UsageError, pendular.InputError, pendular.ComputationError)],
                         [2, 3, 4])
        self.check(pendular.UsageError, ("progress",), pendular.generate, self.sample, progress=3)
        dense = self.sample.changed({"specimen.volume_fraction": 0.64})
        self.check(pendular.ComputationError, ("0.64",), pendular.generate, dense)

    def test_warnings_are_pythons(self):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            pendular.bridge(nu=0.4995)
        self.assertEqual([one.category for one in caught], [pendular.PendularWarning])


if __name__ == "__main__":
    unittest.main()
