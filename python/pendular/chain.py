"""From a tomogram to its stiffness and failure: the steps of the command line as functions."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _core
from ._calls import PathLike, Progress, is_path, origin, packing_of, sample_of, terms
from .errors import InputError
from .runs import Picture, Run
from .sample import Sample

if TYPE_CHECKING:
    import numpy as np

    from ._pictures import Segmentation, Volume


def read_volume(path: PathLike, *, voxel_um: float | None = None, size: tuple[int, int, int] | None = None,
                type: str = "", progress: Progress = None, threads: int = 0) -> Volume:
    """Reads a tomogram: MetaImage, NRRD, TIFF, a folder of slices, DICOM, GE phoenix, or raw data with `size` (x, y, z)
    and `type`. Uncompressed MetaImage, raw and phoenix data stay in their file. `volume.grey` is a read-only array
    [z, y, x] of the volume's own memory."""
    from . import _pictures

    return _pictures.read_volume(path, voxel_um, size, type, terms(progress, threads))


def write_volume(path: PathLike, volume: Volume) -> None:
    """Writes a MetaImage (.mha) or a TIFF (.tif)."""
    volume.write(path, origin("write_volume", 1, []))


def phantom(sample: Sample | PathLike, *, packing: _core.Packing | PathLike | None = None, seed: int = 1,
            progress: Progress = None, threads: int = 0) -> tuple[Volume, _core.Packing]:
    """A synthetic tomogram of a packing, or of a generated one, as [phantom] of the sample says; and its truth."""
    from . import _pictures

    sample = sample_of(sample)
    inputs = [sample._core.input()]
    if packing is not None:
        packing, of_packing = packing_of(packing)
        inputs.append(of_packing)
    return _pictures.phantom(sample._core, packing, origin("phantom", seed, inputs), terms(progress, threads))


def segment(volume: Volume | PathLike, *, voxel_um: float | None = None, bridges: bool = False, cutoff: float = 0.064,
            beads: str = "auto", min_diameter_um: float | None = None, false_discoveries: float = 0.05,
            calibrate_bridges: bool = False, progress: Progress = None, threads: int = 0) -> Segmentation:
    """Beads of a tomogram with standard errors and, with `bridges`, the polymer between them.

    `volume`: a Volume, or a path. An array of your own becomes one without a copy: Volume(array, voxel_um=5). `cutoff`:
    largest gap of a candidate bridge over the mean diameter. `beads`: "bright" or "dark" against what surrounds them.
    Results are `.beads` and `.bridges`, as read_beads() and read_bridges() give them, `.specimen`, `.porosity`, …"""
    from . import _pictures

    if is_path(volume):
        volume = read_volume(volume, voxel_um=voxel_um, threads=threads)
    elif voxel_um is not None:
        raise InputError("voxel_um: found a value beside a Volume, which has its own; expected it with a path only")
    if not isinstance(volume, _pictures.Volume):
        raise InputError(f"volume: found {type(volume).__name__}, expected a Volume or a path")
    return _pictures.segment(volume, cutoff, beads, min_diameter_um, bridges, false_discoveries, calibrate_bridges,
                             terms(progress, threads))


def pack(beads: np.ndarray | PathLike, sample: Sample | PathLike, *, bridges: np.ndarray | PathLike | None = None,
         progress: Progress = None, threads: int = 0) -> _core.Packing:
    """Beads to a packing in the sample's specimen, with candidate bridges or those of state `bridge` in `bridges`. Where
    errors are stated, beads are moved and resized by these until none overlap and as many touch as likely do."""
    return pack_report(beads, sample, bridges=bridges, progress=progress, threads=threads)[0]


def pack_report(beads: np.ndarray | PathLike, sample: Sample | PathLike, *,
                bridges: np.ndarray | PathLike | None = None, progress: Progress = None,
                threads: int = 0) -> tuple[_core.Packing, dict[str, Any]]:
    """pack(), and its statistics as the command line writes them beside the packing (packing.json)."""
    sample = sample_of(sample)
    inputs = [sample._core.input()]
    if is_path(beads):
        inputs.append(_core.input_of_file(beads))
        beads = _core.read_beads(beads)
    if is_path(bridges):
        inputs.append(_core.input_of_file(bridges))
        bridges = _core.read_bridges(bridges, beads)
    packed = _core.pack(beads, bridges, sample._core, origin("pack", 1, inputs), terms(progress, threads))
    return packed.packing, packed.report


def generate(sample: Sample | PathLike, *, seed: int = 1, progress: Progress = None, threads: int = 0) -> _core.Packing:
    """A random packing of the sample's specimen, with its candidate bridges."""
    sample = sample_of(sample)
    made = origin("generate", seed, [sample._core.input()])
    return _core.generate(sample._core, made, terms(progress, threads)).packing


def bridge(*, d_um: Any = 73.9, gap_um: Any = 2.0, D_um: Any = 200.9, E_pa: Any = 1.5e6, nu: Any = 0.49,
           D2_um: Any = None, progress: Progress = None, threads: int = 0) -> np.ndarray:
    """Stiffness of polymer bridges by finite elements. Values or arrays, broadcast against each other; without them,
    sample A of Hemmerle et al. 2021. A structured array of their shape: kn_n_per_m, kt_n_per_m, k_bend_n_m_per_rad,
    k_twist_n_m_per_rad, error_estimate (relative), …"""
    import numpy as np

    given = {"d_um": d_um, "D_um": D_um, "D2_um": D_um if D2_um is None else D2_um, "gap_um": gap_um, "E_pa": E_pa,
             "nu": nu}
    arrays = []
    for name, value in given.items():
        try:
            arrays.append(np.asarray(value, dtype=float))
        except (TypeError, ValueError) as error:
            raise InputError(f"{name}: found {value!r}, expected numbers") from error
        if arrays[-1].size == 0:
            raise InputError(f"{name}: found an empty array, expected numbers")
    try:
        arrays = np.broadcast_arrays(*arrays)
    except ValueError as error:
        raise InputError(f"bridge: found arrays of shapes {[a.shape for a in arrays]}, expected ones that broadcast") from error
    table = _core.bridge(*(np.ascontiguousarray(a).reshape(-1) for a in arrays), terms(progress, threads))
    return table.reshape(arrays[0].shape)


def modulus(packing: _core.Packing | PathLike, sample: Sample | PathLike, *, strain: float = 0.03, seed: int = 1,
            progress: Progress = None, threads: int = 0) -> dict[str, Any]:
    """Young's modulus and Poisson ratio of a packing as a network of springs, without a run: what modulus.json holds."""
    if not 1e-6 <= strain <= 0.2:
        raise InputError(f"strain: found {strain}, expected a number from 1e-06 to 0.2")
    packing, of_packing = packing_of(packing)
    sample = sample_of(sample)
    made = origin("modulus", seed, [of_packing, sample._core.input()], strain=strain)
    return _core.modulus(packing, sample._core, strain, made, terms(progress, threads))


def compress(packing: _core.Packing | PathLike, sample: Sample | PathLike, out: PathLike, *, seed: int = 1,
             resume: bool = False, checkpoint_every_s: float = 30.0, progress: Progress = None, threads: int = 0) -> Run:
    """Uniaxial compression by the discrete element model, into the run folder `out`.

    Ctrl-C, or an exception of `progress`, keeps a checkpoint and raises KeyboardInterrupt, or that exception; the same
    call with `resume=True` goes on and ends with the same bytes as one that was never stopped. `progress` is called
    with what is done, its share from 0 to 1, and a note, some ten times a second."""
    packing, of_packing = packing_of(packing)
    sample = sample_of(sample)
    made = origin("compress", seed, [of_packing, sample._core.input()])
    curve, result = _core.compress(packing, sample._core, out, resume, checkpoint_every_s, made,
                                   terms(progress, threads))
    return Run(Path(out), curve, result)


def track(before: np.ndarray | PathLike, after: np.ndarray | PathLike, *, strain: float | None = None,
          reach: float = 2.5, progress: Progress = None, threads: int = 0) -> _core.Track:
    """Beads of one specimen followed from a scan to the next, turned and shifted as it may be: `.beads` (displacement,
    local strain, loose), `.lost`, `.new`, `.registration`, `.shear_band`; `.write(path)` writes track.csv. `strain`:
    between the scans, where it is known. `reach`: in mean diameters."""
    for name, value, lowest, highest in (("strain", strain, -0.5, 0.9), ("reach", reach, 0.1, 20.0)):
        if value is not None and not lowest <= value <= highest:
            raise InputError(f"{name}: found {value}, expected a number from {lowest} to {highest}")
    scans, inputs = [], []
    for scan in (before, after):
        if is_path(scan):
            inputs.append(_core.input_of_file(scan))
            scan = _core.read_beads(scan)
        scans.append(scan)
    made = origin("track", 1, inputs, strain=strain, reach=reach)
    return _core.track(*scans, strain, reach, made, terms(progress, threads))


def render(run: Run | PathLike, out: PathLike | None = None, *, view: str = "", film: bool = False,
           progress: Progress = None, threads: int = 0) -> list[Picture]:
    """Pictures, plot and report.html of a run folder, drawn without a display; the pictures. `view`: draw
    only this one. Without `out` they go into the run folder's `pictures`."""
    from . import _pictures

    folder = run.folder if isinstance(run, Run) else Path(run)
    made = origin("render", 1, [], view=view, film=film)
    drawn = _pictures.render(folder, folder / "pictures" if out is None else out, view, film, made,
                             terms(progress, threads))
    return [Picture(path) for path in drawn]
