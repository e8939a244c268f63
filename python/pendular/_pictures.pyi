from os import PathLike
from pathlib import Path
from typing import Any, Optional, Union

import numpy as np

from ._core import Origin, Packing, RunTerms, Sample, Specimen, Terms

_Path = Union[str, PathLike[str]]

default_runs: int
default_confidence: float

class Volume:
    grey: np.ndarray
    voxel_um: float
    origin_um: tuple[float, float, float]
    def __init__(self, grey: np.ndarray, voxel_um: float,
                 origin_um: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> None: ...
    def write(self, path: _Path, origin: Origin) -> None: ...

class Segmentation:
    beads: np.ndarray
    bridges: np.ndarray
    grains: np.ndarray
    specimen: Optional[Specimen]
    measured_bridges: Optional[dict[str, Any]]
    threshold: float
    bright_beads: bool
    porosity: float
    blur_m: float
    noise_over_edge: float
    rejected: int
    def labels(self, volume: Volume) -> Volume: ...
    def write_qa(self, folder: _Path, volume: Volume) -> None: ...

class DiagnoseTerms:
    def __init__(self, levels: int, runs: int, confidence: float, leave_out: list[str], fresh_runs: bool,
                 plan: bool) -> None: ...

def read_volume(path: _Path, voxel_um: Optional[float], size: Optional[tuple[int, int, int]], type: str,
                terms: Terms) -> Volume: ...
def phantom(sample: Sample, packing: Optional[Packing], origin: Origin, terms: Terms) -> tuple[Volume, Packing]: ...
def segment(volume: Volume, cutoff: float, tone: str, min_diameter_um: Optional[float], bridges: bool,
            false_discoveries: float, calibrate_bridges: bool, terms: Terms) -> Segmentation: ...
def render(run: _Path, out: _Path, view: str, film: bool, origin: Origin, terms: Terms) -> list[Path]: ...
def diagnose(file: _Path, out: _Path, how: DiagnoseTerms, runs: RunTerms, origin: Origin, terms: Terms) -> str: ...
