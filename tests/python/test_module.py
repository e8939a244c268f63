"""What `import pendular` brings, and arrays over the library's own memory."""

import subprocess
import sys
import unittest

import numpy as np

import pendular
from support import InScratchFolder


def in_new_process(code):
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()


class Start(unittest.TestCase):
    def test_heavy_libraries_wait_for_their_first_use(self):
        loaded = in_new_process("import sys, pendular; print(*sys.modules); print(open('/proc/self/maps').read())")
        self.assertIn("pendular._core", loaded)
        self.assertNotIn("numpy", loaded)
        for library in ("libITK", "libvtk", "libopencv"):
            self.assertFalse([path for path in loaded if library in path], library)

    def test_everything_that_is_named_is_there_and_told_of(self):
        for name in pendular.__all__:
            self.assertTrue(getattr(pendular, name).__doc__, name)


class Memory(InScratchFolder):
    def test_a_volume_lies_in_the_array_that_it_was_made_from(self):
        grey = np.random.default_rng(1).integers(0, 255, (4, 5, 6), dtype=np.uint8)
        volume = pendular.Volume(grey, 5.0, (1.0, 2.0, 3.0))
        self.assertTrue(np.shares_memory(volume.grey, grey))
        self.assertFalse(volume.grey.flags.writeable)
        np.testing.assert_allclose(volume.origin_um, (1.0, 2.0, 3.0), rtol=1e-15)
        np.testing.assert_array_equal(volume.grey, grey)

    def test_arrays_outlive_what_they_show(self):
        kept = pendular.Volume(np.arange(60, dtype=np.uint16).reshape(3, 4, 5), 5.0).grey
        beads = pendular.generate(self.sample).beads
        self.assertEqual(kept.sum(), sum(range(60)))
        self.assertTrue(np.all(beads["diameter_m"] > 1e-4))

    def test_a_written_volume_reads_back(self):
        grey = np.arange(60, dtype=np.uint16).reshape(3, 4, 5)
        pendular.write_volume(self.folder / "v.mha", pendular.Volume(grey, 5.0))
        read = pendular.read_volume(self.folder / "v.mha")
        np.testing.assert_array_equal(read.grey, grey)
        self.assertAlmostEqual(read.voxel_um, 5.0)

    def test_segmenting_an_array_is_segmenting_its_file(self):
        volume, _ = pendular.phantom(self.sample)
        grey = np.array(volume.grey)
        ours = pendular.segment(pendular.Volume(grey, volume.voxel_um, volume.origin_um))
        pendular.write_volume(self.folder / "scan.mha", volume)
        theirs = pendular.segment(self.folder / "scan.mha")
        self.assert_same(ours.beads, theirs.beads)

    def test_beads_are_read_only_views_of_the_packing(self):
        packing = pendular.generate(self.sample)
        self.assertTrue(np.shares_memory(packing.beads, packing.beads))
        with self.assertRaises(ValueError):
            packing.beads["x_m"][0] = 1.0
        again = pendular.Packing(packing.beads, packing.bridges, packing.specimen)
        self.assert_same(again.beads, packing.beads)
        self.assert_same(again.bridges, packing.bridges)

    def test_lengths_may_be_given_in_micrometres(self):
        fields = ("x_um", "y_um", "z_um", "diameter_um")
        beads = np.zeros(2, dtype=[("bead_id", int), *((name, float) for name in fields)])
        beads["bead_id"], beads["x_um"], beads["diameter_um"] = [1, 2], [0.0, 205.0], 200.0
        np.testing.assert_allclose(pendular.Packing(beads).beads["x_m"], [0.0, 205e-6], rtol=1e-15)

    def test_a_sample_is_a_mapping_that_changes_by_giving_another(self):
        other = self.sample.changed({"bridges.gap_um": 3, "contact.bond_friction_limit": False})
        self.assertEqual((self.sample["bridges.gap_um"], other["bridges.gap_um"]), (2.0, 3.0))
        self.assertEqual(dict(pendular.sample_from_text(other.text())), dict(other))
        self.assertGreater(self.sample.changed(W=0.03)["bridges.diameter_um"], 73.9)

    def test_progress_is_told_on_the_way(self):
        told = []
        pendular.compress(pendular.generate(self.sample), self.sample, self.folder / "run",
                          progress=lambda what, done, note: told.append((what, done, note)))
        self.assertEqual({what for what, _, _ in told}, {"compress"})
        self.assertTrue(all(0.0 <= done <= 1.0 for _, done, _ in told))
        self.assertIn("stress", told[0][2])


if __name__ == "__main__":
    unittest.main()
