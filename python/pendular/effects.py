"""Effects written in Python, which `compress`, `sweep` and `diagnose` find as the built-in ones."""

from __future__ import annotations

import hashlib
import types
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Callable

from . import _core
from .errors import InputError

if TYPE_CHECKING:
    import numpy as np


class Bonds:
    """Standing bonds, one entry of every array for each; SI.

    An effect may change kn_n_per_m and kt_n_per_m (normal and tangential stiffness), k_bend_n_m_per_rad and
    k_twist_n_m_per_rad, break_limit_m2 (a bond breaks where stretch² + shear²/12 exceeds it) and, at a step, memory.

    `before` a test there are also i and j (rows of the packing's beads), x_m, y_m, z_m (mid-gap), gap_m, height_m, and
    two random numbers for each bond that follow from the run's seed and the effect's id: uniform (0 to 1) and normal.
    At a `step` there are stretch_m, shear_m, height_m, elapsed_s (since the last step) and memory, an array of the
    effect's own numbers for each bond, 0 at first."""

    __slots__ = ("i", "j", "x_m", "y_m", "z_m", "gap_m", "height_m", "uniform", "normal", "stretch_m", "shear_m",
                 "elapsed_s", "memory", "kn_n_per_m", "kt_n_per_m", "k_bend_n_m_per_rad", "k_twist_n_m_per_rad",
                 "break_limit_m2")

    def __len__(self) -> int:
        return len(self.kn_n_per_m)


Hook = Callable[[Bonds, float], Any]


@dataclass(frozen=True)
class Effect:
    """Something that a real specimen may have and the model has not, of magnitude θ; at 0 there is no effect.

    `before(bonds, theta)` changes the bonds before a test, `step(bonds, theta)` as it goes on: each 1e-4 of strain, or
    each increment of a quasi-static test. What they return is not used. `memory`: how many numbers each bond remembers
    for `step`. `lowest`, `highest`: accepted θ. `bank`: θ of a diagnosis, about 0. `draws`: the effect differs from
    specimen to specimen of one θ. `sentence`: what a specimen then has; `meaning`: of θ.

    Runs are known by a digest of the functions' code and of the constants, variables and functions of their module that
    they use; what that does not see, such as a file that is read, belongs into `version`."""

    id: str
    name: str
    sentence: str
    meaning: str
    unit: str = "fraction"
    lowest: float = 0.0
    highest: float = 1.0
    bank: tuple[float, float] = (0.0, 1.0)
    before: Hook | None = None
    step: Hook | None = None
    memory: int = 0
    draws: bool = False
    version: str = ""


def _digest(value: Any, seen: set[int]) -> str:
    """What a value comes to, as text that is the same in every process."""
    if id(value) in seen:
        return "…"
    if isinstance(value, types.FunctionType):
        seen = seen | {id(value)}
        used = {name: value.__globals__[name] for name in _names(value.__code__) if name in value.__globals__}
        parts = [_digest(value.__code__, seen), _digest(value.__defaults__, seen), _digest(value.__kwdefaults__, seen)]
        parts += [_digest(cell.cell_contents, seen) for cell in value.__closure__ or ()]
        parts += [f"{name}={_digest(used[name], seen)}" for name in sorted(used)]
        return f"function({', '.join(parts)})"
    if isinstance(value, types.CodeType):
        constants = ", ".join(_digest(constant, seen) for constant in value.co_consts)
        return f"code({value.co_code.hex()}, {value.co_names}, {constants})"
    if isinstance(value, types.MethodType):
        return f"method({_digest(value.__func__, seen)}, {_digest(value.__self__, seen | {id(value)})})"
    if isinstance(value, types.ModuleType):
        return f"module {value.__name__} {getattr(value, '__version__', '')}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_digest(item, seen | {id(value)}) for item in value) + "]"
    if isinstance(value, (set, frozenset)):
        return "{" + ", ".join(sorted(_digest(item, seen) for item in value)) + "}"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key!r}: {_digest(item, seen | {id(value)})}" for key, item in value.items()) + "}"
    if hasattr(value, "tobytes") and hasattr(value, "dtype"):
        return f"array({value.dtype}, {value.shape}, {hashlib.sha256(value.tobytes()).hexdigest()})"
    if value is None or isinstance(value, (bool, int, float, complex, str, bytes)) or value is ...:
        return repr(value)
    named = f"{getattr(value, '__module__', '')}.{getattr(value, '__qualname__', getattr(value, '__name__', ''))}"
    if isinstance(value, type):
        methods = {key: item for key, item in vars(value).items() if isinstance(item, types.FunctionType)}
        return f"class {named} {_digest(methods, seen | {id(value)})}"
    attributes = getattr(value, "__dict__", None)
    if not attributes:
        return f"{type(value).__qualname__} {named}"
    return f"{_digest(type(value), seen)} {_digest(attributes, seen | {id(value)})}"


def _names(code: types.CodeType) -> set[str]:
    inner = [constant for constant in code.co_consts if isinstance(constant, types.CodeType)]
    return set(code.co_names).union(*(_names(one) for one in inner))


def add_effect(effect: Effect) -> Effect:
    """From here on a sample may have it: sample.changed({"effects.ID": theta}), or [effects] of its file. One of the same
    id that was added before is replaced."""
    if not isinstance(effect, Effect):
        raise InputError(f"effect: found {type(effect).__name__}, expected an Effect")
    if effect.before is None and effect.step is None:
        raise InputError(f"effect {effect.id}: found neither before nor step, expected a function")
    for name in ("before", "step"):
        hook = getattr(effect, name)
        if hook is not None and not callable(hook):
            raise InputError(f"effect {effect.id}: {name}: found {type(hook).__name__}, expected a function")
    code = _digest([effect.before, effect.step, effect.memory, effect.version], set())
    _core.add_effect(effect, Bonds, hashlib.sha256(code.encode()).hexdigest())
    return effect


def remove_effect(id: str) -> None:
    """Takes an effect that was added back."""
    _core.remove_effect(id)


def effects() -> list[dict[str, Any]]:
    """Every effect: id, unit, name, meaning, lowest, highest, bank, in_python."""
    return _core.effects()
