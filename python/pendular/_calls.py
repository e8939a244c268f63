"""What the calls have in common."""

from __future__ import annotations

import os
import shutil
from pathlib import Path
from typing import Any, Callable, Optional, Union

from . import _core
from .errors import InputError
from .sample import Sample, read_sample

PathLike = Union[str, "os.PathLike[str]"]
Progress = Optional[Callable[[str, float, str], None]]


def terms(progress: Progress, threads: int) -> _core.Terms:
    return _core.Terms(progress, threads)


def origin(function: str, seed: int, inputs: list, /, **options: Any) -> _core.Origin:
    """Provenance of an output: the call with the options that are not None, False or empty."""
    said = [f"{name}={value!r}" for name, value in options.items() if value not in (None, False, "", ())]
    return _core.Origin(f"pendular.{function}({', '.join(said)})", seed, inputs)


def is_path(value: Any) -> bool:
    return isinstance(value, (str, os.PathLike))


def sample_of(value: Sample | PathLike) -> Sample:
    if isinstance(value, Sample):
        return value
    if is_path(value):
        return read_sample(value)
    raise InputError(f"sample: found {type(value).__name__}, expected a Sample or the path of a sample file")


def packing_of(value: _core.Packing | PathLike) -> tuple:
    """The packing, and what provenance says of it."""
    if isinstance(value, _core.Packing):
        return value, value.input()
    if is_path(value):
        return _core.read_packing(value), _core.input_of_file(value)
    raise InputError(f"packing: found {type(value).__name__}, expected a Packing or the path of a packing.vtp")


def program() -> Path | None:
    """The program `pendular`, which makes runs in processes of their own: PENDULAR_PROGRAM, else that of the same build
    or installation, else the one in PATH."""
    named = os.environ.get("PENDULAR_PROGRAM")
    if named:
        return Path(named)
    here = Path(__file__).parent  # a link in the build tree, whose folder is meant
    installed = [above / "bin" / "pendular" for above in list(here.parents)[3:4]]
    for near in (here.parent.parent / "pendular", *installed):
        if near.is_file() and os.access(near, os.X_OK):
            return near
    found = shutil.which("pendular")
    return Path(found) if found else None
