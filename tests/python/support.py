"""What the tests of the module share: a small specimen, a folder that goes with the test, and the program."""

import os
import subprocess
import tempfile
import unittest
from pathlib import Path

import numpy as np

import pendular

SAMPLE = """
[beads]
diameter_um = 200.9
diameter_sd_um = 1.9
density_kg_m3 = 2540
diameters = "drawn"
[bridges]
youngs_modulus_pa = 1.5e6
poisson_ratio = 0.49
diameter_um = 73.9
diameter_sd_um = 12.7
gap_um = 2
interfacial_energy_j_m2 = 7
normal_stiffness_n_per_m = 5760
tangential_stiffness_n_per_m = 325
[contact]
friction = 0.5
bond_friction_limit = false
[specimen]
diameter_um = 1500
height_um = 1500
volume_fraction = 0.55
[phantom]
voxel_um = 10
wall_thickness_um = 60
margin_um = 80
[compression]
max_strain = 0.02
frames = 2
"""

RELAXED = SAMPLE.replace("max_strain = 0.02\nframes = 2",
                         'control = "relaxation"\nrelax_increment = 2e-3\nmax_strain = 0.02\nframes = 0')


class InScratchFolder(unittest.TestCase):
    """`self.folder` is the test's own, and has sample.toml."""

    sample_text = SAMPLE

    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="pendular.")
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)
        (self.folder / "sample.toml").write_text(self.sample_text)
        self.sample = pendular.read_sample(self.folder / "sample.toml")

    def program(self, *words):
        """Runs the program in the folder."""
        done = subprocess.run([os.environ["PENDULAR_PROGRAM"], *map(str, words)], cwd=self.folder,
                              capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)

    def assert_same(self, ours, theirs):
        """Arrays that are equal bit by bit, field by field."""
        self.assertEqual(ours.dtype.names, theirs.dtype.names)
        self.assertEqual(len(ours), len(theirs))
        for name in ours.dtype.names:
            np.testing.assert_array_equal(ours[name], theirs[name], err_msg=name)
