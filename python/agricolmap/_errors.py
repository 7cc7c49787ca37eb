"""What can go wrong, as types. A registration that fails is not here: it is a status."""

from __future__ import annotations

# What would mend an error, in the words of this package. The library names the remedy alone.
_HINTS = {
    "heights_alone": "options={'geometry_only': True}",
    "initial_guess": "guess=, or offset.xyz beside the cloud",
    "narrower_guess": "options={'prior': {'translation': 5, 'scale_unknown': False}}, "
    "or 'association': 'correlation'",
    "overwrite": "overwrite=True",
    "resume_or_overwrite": "resume=True, overwrite=True",
}


class Error(Exception):
    """Base of all errors that the library raises on purpose.

    The message names the place and the remedy. As it stands: what no caller can mend, such as a
    processor that the library was not built for.

    Attributes:
        remedy: what would mend it, as one word (``"heights_alone"``, ``"initial_guess"``,
            ``"narrower_guess"``, ``"overwrite"`` and others); empty where the message says it.
    """

    remedy: str

    def __init__(self, message: str = "", remedy: str = "") -> None:
        hint = _HINTS.get(remedy)
        super().__init__(f"{message} ({hint})" if hint else message)
        self.remedy = remedy


class UsageError(Error, ValueError):
    """Options or arguments that make no sense: the message names the argument or the option."""


class InputError(Error):
    """A file or cloud that cannot be used: missing, truncated, lying, empty, degenerate."""


class OutputError(Error):
    """A result that cannot be written: no permission, disk full, exists already."""


class Interrupted(Error):
    """The caller asked to stop by the argument ``stop``. Ctrl-C is a KeyboardInterrupt."""
