"""The gap between simulation and experiment."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Sequence

from ._calls import PathLike, Progress, origin, terms
from ._toml import write_with_parts
from .errors import InputError
from .runs import run_terms


@dataclass(frozen=True)
class Diagnosis:
    """A diagnosis: `verdict` in words, `data` as diagnosis.json holds it, `report` the page to open."""

    folder: Path
    verdict: str
    data: dict[str, Any]

    @property
    def report(self) -> Path:
        return self.folder / "report.html"

    @property
    def probabilities(self) -> dict[str, float]:
        """Of each explanation by its id, most probable first."""
        return {one["id"]: one["probability"] for one in self.data["hypotheses"] if not one["excluded"]}

    def _repr_html_(self) -> str:
        from html import escape

        return f"<p>{escape(self.verdict)}</p>"


def diagnose(experiment: PathLike | Mapping[str, Any], out: PathLike, *, levels: int = 3, runs: int | None = None,
             confidence: float | None = None, leave_out: Sequence[str] = (), fresh_runs: bool = True, plan: bool = False,
             store: PathLike | None = None, retry_failed: bool = False, progress: Progress = None,
             threads: int = 0) -> Diagnosis:
    """Where simulation and experiment part, which effect causes it, and how far the gap shrinks once it is added.

    `experiment`: an experiment file, or what one holds as a mapping, in which `sample` may be a Sample and tables may
    be structured arrays; it is then written to `out`. `levels`: magnitudes from which the response to an effect that
    draws is learnt. `runs`: most runs at the explanations that lead. `confidence`: how often the set of explanations
    is to hold the truth. `leave_out`: effects that are not considered. `fresh_runs`: measure how far the gap shrinks,
    and what further scans would tell. `plan`: assess further measurements, with the runs that this lacks. Effects
    added in Python take part; their runs are made in this process."""
    from . import _pictures

    out = Path(out)
    runs = _pictures.default_runs if runs is None else runs
    confidence = _pictures.default_confidence if confidence is None else confidence
    for name, value, lowest, highest in (("levels", levels, 1, 6), ("runs", runs, 0, 100000),
                                         ("confidence", confidence, 0.5, 0.99)):
        if not lowest <= value <= highest:
            raise InputError(f"{name}: found {value}, expected a number from {lowest} to {highest}")
    if isinstance(leave_out, str):
        raise InputError(f"leave_out: found the text {leave_out!r}, expected a list of effects' names")
    file = write_with_parts(experiment, out, "experiment") if isinstance(experiment, Mapping) else Path(experiment)
    how = _pictures.DiagnoseTerms(levels, runs, confidence, list(leave_out), fresh_runs, plan)
    verdict = _pictures.diagnose(file, out, how, run_terms(out, store, retry_failed, threads),
                                 origin("diagnose", 1, [], levels=levels, runs=runs, leave_out=tuple(leave_out)),
                                 terms(progress, threads))
    return Diagnosis(out, verdict, json.loads((out / "diagnosis.json").read_text(encoding="utf-8")))
