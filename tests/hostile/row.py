"""What a row of the tables is, and the input that all start from."""
import fnmatch
from dataclasses import dataclass
from pathlib import Path
from typing import Callable, Optional

SAMPLES = Path(__file__).resolve().parents[2] / "samples"

# Effects that are left out for a small library, which makes a small bank.
LEFT_OUT = ("bridge_gap_spread,bridge_diameter_spread,bridge_bending,polymer_nonlinearity,polymer_viscoelasticity,bond_damage,"
            "interface_strength,residual_stress,platen_friction,platen_tilt,platen_roughness,funicular_bridges,position_error,"
            "diameter_bias,voxel_scale,loading_rate")

SAMPLE = """[beads]
diameter_um = 200.9
diameter_sd_um = 1.9
density_kg_m3 = 2540
diameters = "drawn"
[bridges]
youngs_modulus_pa = 1.5e6
poisson_ratio = 0.49
diameter_um = 73.9
diameter_sd_um = 12.7
gap_um = 2.0
interfacial_energy_j_m2 = 7.0
normal_stiffness_n_per_m = 5760
tangential_stiffness_n_per_m = 325
[contact]
friction = 0.5
bond_friction_limit = false
[specimen]
diameter_um = 1000
height_um = 1000
volume_fraction = 0.53
[compression]
max_strain = 0.01
frames = 2
[phantom]
voxel_um = 10
wall_thickness_um = 60
margin_um = 80
"""


@dataclass
class Row:
    name: str
    command: str  # in bash; $P is the program
    status: object  # the one, or a tuple of those that are right
    says: str = ""  # a part of the line on standard error
    prepare: Callable = lambda folder: None
    changes: tuple = ()  # patterns of names that may be new or changed
    then: Optional[Callable] = None  # whether the result is right
    warns: bool = False  # warnings may stand before the line

    def statuses(self):
        return self.status if isinstance(self.status, tuple) else (self.status,)

    def may_change(self, name):
        return any(fnmatch.fnmatch(name, pattern) for pattern in self.changes)


def file(name, content):
    """Writes one file, of text or bytes."""

    def write(folder):
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())

    return write


def both(*parts):
    def write(folder):
        for part in parts:
            part(folder)

    return write


