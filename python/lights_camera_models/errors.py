"""Exceptions of the package. Both are also ``ValueError``."""

from __future__ import annotations

from typing import Any, Sequence


class _Refused(ValueError):
    def __init__(self, text: str, problems: Sequence[dict[str, Any]] = ()) -> None:
        super().__init__(text)
        #: One dictionary for each problem; see :class:`SceneError`.
        self.problems: list[dict[str, Any]] = list(problems)

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.problems)


class ModelError(_Refused):
    """An unknown model, a parameter that a model refuses, or a mistake in the WGSL of a custom model.

    The text names the value, the rule, and the nearest known name. ``problems`` has a dictionary for each mistake, with the
    keys of :class:`SceneError`: ``path`` is the name of a parameter, ``line`` and ``column`` are those of a WGSL text.
    """


class SceneError(_Refused):
    """A scene that cannot be read, or a value that it refuses.

    ``problems`` has a dictionary for each problem, in the order of the file: ``path`` (for example
    ``objects[0].material.roughness``), ``line`` and ``column`` (from 1; ``None`` for scenes from dictionaries),
    ``value`` (as written, or ``None``) and ``message``, which says the rule.
    """
