"""Run folders, and families of runs."""

from __future__ import annotations

import json
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _core
from ._calls import PathLike, Progress, origin, program, terms
from ._toml import write_with_parts
from .errors import InputError, PendularWarning
from .tables import read_polydata, read_table

if TYPE_CHECKING:
    import numpy as np


class Picture:
    """A picture file, which a notebook shows."""

    def __init__(self, path: PathLike):
        self.path = Path(path)

    def __fspath__(self) -> str:
        return str(self.path)

    def _repr_png_(self) -> bytes:
        return self.path.read_bytes()

    def __repr__(self) -> str:
        return f"<pendular.Picture {self.path}>"


class Run:
    """One compression test: its folder, `curve` (a structured array with the columns of curve.csv, SI) and `result`
    (what result.json holds)."""

    def __init__(self, folder: Path, curve: np.ndarray, result: dict[str, Any]):
        self.folder, self.curve, self.result = folder, curve, result

    @cached_property
    def events(self) -> np.ndarray:
        """Broken bonds (events.csv)."""
        return read_table(self.folder / "events.csv")

    @cached_property
    def avalanches(self) -> np.ndarray:
        """Clusters of breaks (avalanches.csv)."""
        return read_table(self.folder / "avalanches.csv")

    @property
    def frames(self) -> list[Path]:
        """Files of the frames, in order; read_polydata() reads one."""
        return sorted((self.folder / "frames").glob("frame_*.vtp"))

    def frame(self, number: int) -> dict[str, Any]:
        """One of them as arrays."""
        return read_polydata(self.frames[number])

    @property
    def modulus_pa(self) -> float:
        """Of the linear part; NaN where there is none."""
        found = self.result["linear_modulus_pa"]
        return float("nan") if found is None else found["value"]

    @property
    def peak_stress_pa(self) -> float:
        """NaN where the curve has none."""
        found = self.result["peak"]
        return float("nan") if found is None else found["stress_pa"]

    def __repr__(self) -> str:
        return f"<pendular.Run {self.folder}: E = {self.modulus_pa / 1e6:.2f} MPa, peak {self.peak_stress_pa / 1e6:.3f} MPa>"


def read_run(folder: PathLike) -> Run:
    """Reads a run folder."""
    folder = Path(folder)
    file = folder / "result.json"
    try:
        result = json.loads(file.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(f"{file}: found no readable JSON ({error}), expected the result of a run") from error
    if not isinstance(result, dict) or "linear_modulus_pa" not in result:
        raise InputError(f"{file}: linear_modulus_pa is missing, expected the result of a run")
    return Run(folder, read_table(folder / "curve.csv"), result)


@dataclass(frozen=True)
class Sweep:
    """What a family of runs came to: `results` has a row per run, `summary` one per point; `folders` are those of the
    runs, None where one failed, and `failed` says why."""

    folder: Path
    results: np.ndarray
    summary: np.ndarray
    folders: list[Path | None]
    failed: list[str]


def run_terms(out: Path, store: PathLike | None, retry_failed: bool, threads: int) -> _core.RunTerms:
    found = program()
    return _core.RunTerms(out / "store" if store is None else store, "" if found is None else found, retry_failed, threads)


def sweep(sweep: PathLike | Mapping[str, Any], out: PathLike, *, seed: int | None = None, store: PathLike | None = None,
          retry_failed: bool = False, progress: Progress = None, threads: int = 0) -> Sweep:
    """Compressions over any keys of a sample, several at once, kept in a store; the same call goes on where it stopped.

    `sweep`: a sweep file, or what one holds as a mapping, {"sweep": {"sample": sample, …}, "grid": {key: values}}, where
    sample and packing may be values; it is then written to `out`. Runs are processes of the program `pendular`; those
    with an effect written in Python are made in this process, one after the other."""
    out = Path(out)
    file = write_with_parts(sweep, out, "sweep") if isinstance(sweep, Mapping) else Path(sweep)
    done = _core.sweep(file, out, seed, run_terms(out, store, retry_failed, threads),
                       origin("sweep", 1, [], seed=seed), terms(progress, threads))
    if done.failed:
        warnings.warn(f"{len(done.failed)} of {done.runs} runs failed (retry_failed=True makes them again): "
                      + "; ".join(done.failed[:3]), PendularWarning, stacklevel=2)
    folders = [path if path != Path() else None for path in done.folders]
    return Sweep(out, read_table(out / "results.csv"), read_table(out / "summary.csv"), folders, done.failed)
