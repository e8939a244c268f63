"""Files of tables: beads, bridges, packings, and every CSV that pendular writes."""

from __future__ import annotations

import csv
from typing import TYPE_CHECKING, Any

from . import _core
from ._calls import PathLike, origin
from .errors import InputError

if TYPE_CHECKING:
    import numpy as np


def read_beads(path: PathLike) -> np.ndarray:
    """beads.csv as a structured array: bead_id, x_m, y_m, z_m, diameter_m, sigma_centre_m, sigma_diameter_m, quality,
    boundary. Lengths in m."""
    return _core.read_beads(path)


def write_beads(path: PathLike, beads: np.ndarray) -> None:
    """Writes beads.csv; fields as read_beads() gives them, or lengths in fields ..._um."""
    _core.write_beads(path, beads, origin("write_beads", 1, []))


def read_bridges(path: PathLike, beads: np.ndarray) -> np.ndarray:
    """bridges.csv as a structured array: i, j (rows of `beads`), gap_m, sigma_gap_m, probability, diameter_m,
    sigma_diameter_m, state (pendular.BridgeState)."""
    return _core.read_bridges(path, beads)


def write_bridges(path: PathLike, beads: np.ndarray, bridges: np.ndarray) -> None:
    """Writes bridges.csv, beads by their ids."""
    _core.write_bridges(path, beads, bridges, origin("write_bridges", 1, []))


def read_packing(path: PathLike) -> _core.Packing:
    """packing.vtp, or what another program wrote: Yade text (.txt), LAMMPS data (.data, .lmp, .bpm), .liggghts, beads.csv."""
    return _core.read_packing(path) if str(path).endswith(".vtp") else _core.read_exchange(path)


def write_packing(path: PathLike, packing: _core.Packing) -> None:
    """Writes packing.vtp."""
    if not isinstance(packing, _core.Packing):
        raise InputError(f"packing: found {type(packing).__name__}, expected a Packing")
    if not str(path).endswith(".vtp"):
        raise InputError(f"{path}: expected a name ending in .vtp")
    _core.write_packing(path, packing)


def read_polydata(path: PathLike) -> dict[str, Any]:
    """A .vtp as arrays: points_um, lines, point_data, line_data, fields. Frames of a run are such files."""
    return _core.read_polydata(path)


def _column(cells: list[str]) -> np.ndarray:
    import numpy as np

    for kind in (int, float):
        try:
            return np.array([kind(cell) if cell or kind is int else float("nan") for cell in cells])
        except (ValueError, OverflowError):
            continue
    return np.array(cells)


def read_table(path: PathLike) -> np.ndarray:
    """Any CSV table of pendular as a structured array with the file's columns, whose names carry the units. Columns are
    whole numbers, numbers (an empty cell is NaN) or text."""
    import numpy as np

    try:
        with open(path, newline="", encoding="utf-8") as file:
            lines = [(n, line) for n, line in enumerate(file, 1) if line.strip() and not line.startswith("#")]
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: cannot be read: {error}") from error
    if not lines:
        raise InputError(f"{path}: found no header, expected a table of comma-separated columns")
    rows = list(csv.reader(line for _, line in lines))
    names = rows[0]
    if len(set(names)) != len(names):
        raise InputError(f"{path}:{lines[0][0]}: found a column twice, expected each once")
    for (line, _), row in zip(lines[1:], rows[1:]):
        if len(row) != len(names):
            raise InputError(f"{path}:{line}: found {len(row)} cells, expected {len(names)}")
    columns = [_column([row[k] for row in rows[1:]]) for k in range(len(names))]
    table = np.empty(len(rows) - 1, dtype=[(name, column.dtype) for name, column in zip(names, columns)])
    for name, column in zip(names, columns):
        table[name] = column
    return table
