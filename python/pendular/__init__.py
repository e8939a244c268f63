"""From a tomogram of bonded beads to its stiffness, its failure, and the reason why.

    found = pendular.segment("scan.mha", voxel_um=5)
    packing = pendular.pack(found.beads, "sample.toml")
    run = pendular.compress(packing, "sample.toml", "run")
    pendular.render(run)

Tables are NumPy structured arrays whose field names carry the units. Errors are pendular.InputError and its like, with
the file or argument and the field in the text; Ctrl-C is KeyboardInterrupt. docs/python.md has more.
"""

from __future__ import annotations

from enum import IntEnum
from typing import TYPE_CHECKING, Any

from ._core import Packing, Specimen, Track, version as __version__
from .chain import (bridge, compress, generate, modulus, pack, pack_report, phantom, read_volume, render, segment, track,
                    write_volume)
from .diagnosis import Diagnosis, diagnose
from .effects import Bonds, Effect, add_effect, effects, remove_effect
from .errors import ComputationError, Error, InputError, PendularWarning, UsageError
from .runs import Picture, Run, Sweep, read_run, sweep
from .sample import Sample, read_sample, sample_from_text
from .tables import (read_beads, read_bridges, read_packing, read_polydata, read_table, write_beads, write_bridges,
                     write_packing)

if TYPE_CHECKING:
    from ._pictures import Segmentation, Volume


class BridgeState(IntEnum):
    """What is known of the polymer between two beads: the field `state` of bridges."""

    CANDIDATE = 0
    BRIDGE = 1
    NONE = 2
    UNDETERMINED = 3


def __getattr__(name: str) -> Any:
    """Classes that need ITK and VTK, which take longer to load than all else."""
    if name in ("Volume", "Segmentation"):
        from . import _pictures

        return getattr(_pictures, name)
    raise AttributeError(f"module 'pendular' has no attribute {name!r}")


__all__ = ["BridgeState", "Bonds", "ComputationError", "Diagnosis", "Effect", "Error", "InputError", "Packing",
           "PendularWarning", "Picture", "Run", "Sample", "Segmentation", "Specimen", "Sweep", "Track", "UsageError", "Volume",
           "add_effect", "bridge", "compress", "diagnose", "effects", "generate", "modulus", "pack", "pack_report",
           "phantom", "read_beads", "read_bridges", "read_packing", "read_polydata", "read_run", "read_sample",
           "read_table", "read_volume", "remove_effect", "render", "sample_from_text", "segment", "sweep", "track",
           "write_beads", "write_bridges", "write_packing", "write_volume"]
