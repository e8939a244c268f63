"""Sample files: what is believed of a specimen and its test."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Iterator, Union

from . import _core


class Sample(Mapping):
    """A sample as a mapping from dotted keys, which carry their units, to values: `sample["bridges.gap_um"]`.

    It does not change; `changed()` gives another. All keys are in docs/sample.md; effects are `effects.NAME`.
    """

    def __init__(self, core: _core.Sample):
        self._core = core

    def __getitem__(self, key: str) -> Any:
        return self._core.value(key)

    def __iter__(self) -> Iterator[str]:
        return iter(self._core.keys())

    def __len__(self) -> int:
        return len(self._core.keys())

    def changed(self, settings: Mapping[str, Any] | None = None, /, **more: Any) -> Sample:
        """Another sample with some keys set, as {"bridges.gap_um": 3.0}; `W` sets the polymer content, which changes
        the bridges' diameter. InputError for an unknown key, naming the nearest, or a value out of range."""
        return Sample(self._core.changed({**(settings or {}), **more}))

    def text(self) -> str:
        """The text of a sample file that says the same."""
        return self._core.text()

    def write(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Writes that file."""
        Path(path).write_text(self.text(), encoding="utf-8")

    def __repr__(self) -> str:
        return f"<pendular.Sample {self._core.name}>"


def read_sample(path: Union[str, "os.PathLike[str]"]) -> Sample:
    """Reads and checks a sample file (.toml)."""
    return Sample(_core.Sample.read(path))


def sample_from_text(text: str) -> Sample:
    """A sample from the text of such a file."""
    return Sample(_core.Sample.from_text(text))
