"""Options of a registration: one table, that of the library, for all who set them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Iterator, List, Mapping, Optional, Tuple, Union

from . import _arrays, _core
from ._arrays import PathLike
from ._errors import UsageError

Value = Union[bool, int, float, str]


@dataclass(frozen=True)
class OptionInfo:
    """One option.

    Attributes:
        name: such as ``"grid.cell"``.
        type: bool, int, float or str.
        default: of the default preset.
        unit: such as ``"m"``; empty: none.
        limits: what is allowed, in words.
        low, high: the same of numbers; both 0 for others.
        choices: the same of words; empty for others.
        help: what it means.
        basic: for users; the others are for those who change how a stage works.
    """

    name: str
    type: type
    default: Value
    unit: str
    limits: str
    low: float
    high: float
    choices: Tuple[str, ...]
    help: str
    basic: bool

    def __str__(self) -> str:
        unit = f" {self.unit}" if self.unit else ""
        return f"{self.name} = {self.default}{unit} ({self.limits}): {self.help}"


@dataclass(frozen=True)
class Prior:
    """How wrong the initial guess may be: limits, not deviations.

    Attributes:
        translation_m: horizontally, at the moving cloud's middle [m].
        heading_deg: [degrees].
        scale: of each horizontal axis, relative (0.3: 0.7 to 1.3).
        anywhere: no guess: any place and heading; the first two do not count.
        scale_unknown: the moving cloud is in units of its own: a factor of 0.1 to 10.
    """

    translation_m: float = 5.0
    heading_deg: float = 11.5
    scale: float = 0.3
    anywhere: bool = False
    scale_unknown: bool = False


_TYPES = {"bool": bool, "int": int, "float": float, "str": str}


def _value(kind: str, text: str) -> Value:
    if kind == "bool":
        return text == "true"
    if kind == "str":
        return text
    return int(text) if kind == "int" else float(text)


def _text(name: str, value: Any) -> str:
    if hasattr(value, "item") and getattr(value, "ndim", 0) == 0:
        value = value.item()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float):
        # As the library writes whole numbers, so that 2.0 will do for an option that has them.
        return str(int(value)) if value.is_integer() and abs(value) < 1e15 else repr(value)
    if isinstance(value, (int, str)):
        return str(value)
    raise UsageError(f"option {name} cannot be a {type(value).__name__}; give a number, bool or str")


def _flat(values: Mapping[str, Any], prefix: str = "") -> Iterator[Tuple[str, Any]]:
    for name, value in values.items():
        if not isinstance(name, str):
            raise UsageError(f"option {prefix}{name!r}: names are str")
        if isinstance(value, Mapping):
            yield from _flat(value, f"{prefix}{name}.")
        else:
            yield prefix + name, value


class Options:
    """All options of a registration by name, with the library's own limits and defaults.

    ``options["grid.cell"]`` reads and sets one. Names are those of the command line and of its YAML
    files; groups may be nested: ``Options(grid={"cell": 0.03})``.

    Args:
        preset: what measures best (``"default"``), or the paper's chain (``"paper"``,
            ``"paper-literal"``).
        values: options by name, nested or with dots.

    Raises:
        UsageError: for names that there are none of (with the one that was probably meant) and
            values outside their limits; then nothing is changed.
    """

    __slots__ = ("_handle",)
    _handle: _core.Options

    def __init__(self, preset: str = "default", **values: Any) -> None:
        self._handle = _core.Options(preset)
        self.update(values)

    @classmethod
    def load(cls, path: PathLike, preset: str = "default") -> "Options":
        """The options that the YAML file names, the others as in the preset.

        Raises:
            InputError: when it cannot be read.
            UsageError: names file and line of keys and values that make no sense.
        """
        options = cls(preset)
        options._handle.load(_arrays.path_of(path, "path"))
        return options

    @staticmethod
    def presets() -> List[str]:
        """Names of the presets."""
        return _core.Options.presets()

    @staticmethod
    def names() -> List[str]:
        """Names of all options, in the order of the stages."""
        return [info.name for info in _TABLE]

    @staticmethod
    def describe(name: str = "") -> List[OptionInfo]:
        """Type, unit, limits, default and meaning of the options whose names begin like this.

        ``describe("grid")`` has all of the group, ``describe("grid.cell")`` one, ``describe()`` all.

        Raises:
            UsageError: when there are none.
        """
        found = [
            info for info in _TABLE if not name or f"{info.name}.".startswith(f"{name.rstrip('.')}.")
        ]
        if not found:
            _core.Options("default").get(name)  # raises, with the name that was meant
        return found

    @property
    def preset(self) -> str:
        """That it was made from."""
        return self._handle.preset

    @property
    def prior(self) -> Prior:
        """How wrong the initial guess may be; can be set."""
        return Prior(*self._handle.prior())

    @prior.setter
    def prior(self, prior: Prior) -> None:
        self._handle.set_prior(
            prior.translation_m, prior.heading_deg, prior.scale, prior.anywhere, prior.scale_unknown
        )

    def update(self, values: Mapping[str, Any]) -> None:
        """Sets all of these, nested or with dots, or none."""
        changed = _core.Options(self._handle)
        for name, text in flat_texts(values):
            changed.set(name, text)
        self._handle = changed

    def save(self, path: PathLike) -> None:
        """Writes all options with their meaning as YAML, as `load` and the command line read them.

        Raises:
            OutputError: when it cannot be written.
        """
        self._handle.save(_arrays.path_of(path, "path"))

    def changed(self) -> dict[str, Value]:
        """What differs from the preset."""
        usual = Options(self.preset)
        return {name: self[name] for name in self if self[name] != usual[name]}

    def __getitem__(self, name: str) -> Value:
        text = self._handle.get(name)
        return _value(_KINDS[name], text)

    def __setitem__(self, name: str, value: Any) -> None:
        self.update({name: value})

    def __iter__(self) -> Iterator[str]:
        return iter(self.names())

    def __len__(self) -> int:
        return len(_TABLE)

    def __contains__(self, name: object) -> bool:
        return name in _KINDS

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Options):
            return NotImplemented
        return all(self[name] == other[name] for name in self)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        changed = "".join(f", {name}={value!r}" for name, value in self.changed().items())
        return f"<agricolmap.Options {self.preset!r}{changed}>"


def infos_of(table: List[_core.OptionInfo]) -> List[OptionInfo]:
    return [
        OptionInfo(
            name=info.name,
            type=_TYPES[info.kind],
            default=_value(info.kind, info.default),
            unit=info.unit,
            limits=info.limits,
            low=info.low,
            high=info.high,
            choices=tuple(info.choices),
            help=info.help,
            basic=info.basic,
        )
        for info in table
    ]


def flat_texts(values: Mapping[str, Any]) -> List[Tuple[str, str]]:
    """Names with dots and what the library reads."""
    return [(name, _text(name, value)) for name, value in _flat(values)]


_TABLE = infos_of(_core.Options("default").list())
_KINDS = {info.name: info.type.__name__ for info in _TABLE}


def options_of(value: Optional[Union[Options, Mapping[str, Any], PathLike]]) -> Options:
    """What callers may give for options."""
    if value is None:
        return Options()
    if isinstance(value, Options):
        return value
    if isinstance(value, Mapping):
        options = Options(value.get("preset", "default"))
        options.update({name: one for name, one in value.items() if name != "preset"})
        return options
    if _arrays.is_path(value):
        return Options.load(value)
    raise UsageError(
        f"options: is a {type(value).__name__}; give Options, a dict or the path of a YAML file"
    )
