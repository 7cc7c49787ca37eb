"""What a report is put together from; its words are in texts.toml."""

import tomllib
from dataclasses import dataclass, field
from pathlib import Path

import pandas as pd
from matplotlib.figure import Figure

TEXTS = tomllib.loads(Path(__file__).with_name("texts.toml").read_text(encoding="utf-8"))


@dataclass(frozen=True)
class Table:
    """`full` goes into NAME.csv; `shown`, texts, if any, into the page and into documents."""
    name: str
    full: pd.DataFrame
    shown: pd.DataFrame | None = None


@dataclass(frozen=True)
class Section:
    name: str
    plots: dict[str, Figure] = field(default_factory=dict)
    tables: list[Table] = field(default_factory=list)
    facts: str = ""  # before its text
