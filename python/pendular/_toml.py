"""Files of sweeps and experiments from mappings."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from . import _core
from .errors import InputError
from .sample import Sample


def _value(value: Any, where: str) -> str:
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, (bool, int, str)):
        return json.dumps(value)
    if isinstance(value, float):
        return repr(value)
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_value(item, where) for item in value) + "]"
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{json.dumps(key)} = {_value(item, where)}" for key, item in value.items()) + "}"
    raise InputError(f"{where}: found {type(value).__name__}, expected a number, text, true or false, or a list of them")


def _table(name: str, content: Mapping[str, Any]) -> str:
    lines = [f"{json.dumps(key)} = {_value(value, f'{name}.{key}')}" for key, value in content.items()]
    return "\n".join([name, *lines]) + "\n"


def _text(content: Mapping[str, Any]) -> str:
    text = ""
    for name, part in content.items():
        if isinstance(part, Mapping):
            text += _table(f"[{name}]", part)
        elif isinstance(part, (list, tuple)) and all(isinstance(one, Mapping) for one in part):
            text += "".join(_table(f"[[{name}]]", one) for one in part)
        else:
            raise InputError(f"{name}: found {type(part).__name__}, expected a mapping, or a list of them")
    return text


def _write_rows(path: Path, array: Any) -> None:
    import csv

    with open(path, "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(array.dtype.names)
        table.writerows(array.tolist())


def _part(value: Any, path: Path) -> Any:
    """A value that is a file of its own is written, and its path taken instead."""
    from . import tables

    names = getattr(getattr(value, "dtype", None), "names", None)
    if isinstance(value, Sample):
        path = path.with_suffix(".toml")
        value.write(path)
    elif isinstance(value, _core.Packing):
        path = path.with_suffix(".vtp")
        _core.write_packing(path, value)
    elif names and "bead_id" in names and "diameter_m" in names:
        path = path.with_suffix(".csv")
        tables.write_beads(path, value)
    elif names:
        path = path.with_suffix(".csv")
        _write_rows(path, value)
    elif isinstance(value, Path):
        return str(value.absolute())
    else:
        return value
    return path.name


def write_with_parts(content: Mapping[str, Any], out: Path, name: str) -> Path:
    """Writes NAME.toml into `out`, and beside it the samples, packings and tables that the mapping holds."""
    out.mkdir(parents=True, exist_ok=True)

    def parts(table: Mapping[str, Any], prefix: str) -> dict[str, Any]:
        return {key: _part(value, out / f"{prefix}_{key}") for key, value in table.items()}

    whole: dict[str, Any] = {}
    for key, part in content.items():
        if isinstance(part, Mapping):
            whole[key] = parts(part, key)
        elif isinstance(part, (list, tuple)):
            whole[key] = [parts(one, f"{key}_{n}") if isinstance(one, Mapping) else one for n, one in enumerate(part, 1)]
        else:
            whole[key] = part
    path = out / f"{name}.toml"
    path.write_text(_text(whole), encoding="utf-8")
    return path
