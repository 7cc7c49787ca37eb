"""What a registration found: a verdict with its reasons and, where there is any, a transformation."""

from __future__ import annotations

import enum
import json
import os
from dataclasses import dataclass
from typing import Any, Dict, List, Optional, Tuple

import numpy as np
import numpy.typing as npt

from . import _arrays, _core, _files
from ._arrays import Floats, PathLike
from ._cloud import Cloud, CloudLike, Crs, cloud_of, pair_of
from ._errors import OutputError, UsageError
from ._maps import CellMap, map_of


class Status(enum.Enum):
    """The verdict."""

    ACCEPTED = "accepted"
    REJECTED = "rejected"
    #: The clouds fit, but in several places that the data cannot tell apart.
    AMBIGUOUS = "ambiguous"

    def __str__(self) -> str:
        return self.value


@dataclass(frozen=True, eq=False)
class Parts:
    """What the transformation adds to the initial guess, at the middle of the moving cloud.

    Attributes:
        shift_m: (3,), in the fixed file's axes [m].
        centre_m: (3,), that middle, fixed file coordinates [m].
        heading_deg: counter-clockwise [degrees].
        tilt_x_deg, tilt_y_deg: between the ground planes [degrees].
        scale_x, scale_y, scale_z: along the moving file's axes.
        shear: of the plane.
    """

    shift_m: Floats
    centre_m: Floats
    heading_deg: float
    tilt_x_deg: float
    tilt_y_deg: float
    scale_x: float
    scale_y: float
    scale_z: float
    shear: float


@dataclass(frozen=True, eq=False)
class Uncertainty:
    """How accurate the transformation is, if it is right.

    Attributes:
        expected_rms_m: horizontally, over the moving cloud [m].
        local_rms_m: part of that which no affine undoes: drift, wind [m].
        covariance: 6×6, of (shift x, y, z [m], heading [rad], scale x, y [relative]) about
            `centre_m`.
        centre_m: (3,), fixed file coordinates [m].
        height_deviation_m: of the height [m].
    """

    expected_rms_m: float
    local_rms_m: float
    covariance: Floats
    centre_m: Floats
    height_deviation_m: float


@dataclass(frozen=True, eq=False)
class Node:
    """A place of the path that is bent.

    Attributes:
        along_m: path length [m].
        place_m: (3,), fixed file coordinates [m].
        displacement_m: (3,), fixed file's axes [m].
        deviation_m: (3,), of the place, per axis [m].
    """

    along_m: float
    place_m: Floats
    displacement_m: Floats
    deviation_m: Floats


@dataclass(frozen=True, eq=False)
class Slip:
    """All that lies behind is displaced against all before.

    Attributes:
        along_m: path length [m].
        place_m: (3,), fixed file coordinates [m].
        offset_m: (3,), fixed file's axes [m].
        deviation_m: of the offset, per axis [m].
    """

    along_m: float
    place_m: Floats
    offset_m: Floats
    deviation_m: float


@dataclass(frozen=True, eq=False)
class Deformation:
    """How the moving cloud is bent beside the transformation, as parts of it confirm that took no
    part in finding it.

    Attributes:
        nodes: in order along the path.
        slips: in order along the path.
        gain: by which left-out parts confirm it, in standard errors.
        rms_m: of the displacements in the plane [m].
    """

    nodes: Tuple[Node, ...]
    slips: Tuple[Slip, ...]
    gain: float
    rms_m: float
    _handle: _core.Registration

    def displacement(self, points: npt.ArrayLike) -> Floats:
        """N×3, along the fixed file's axes [m], of N×3 points of the moving file [m].

        A point lies where the transformation lays it, plus this. See `Registration.place`.
        """
        return self._handle.displacements(_arrays.points(points, "points"))


@dataclass(frozen=True)
class Evidence:
    """What speaks for the answer, measured on the clouds themselves.

    Attributes:
        significance: the peak over the deviation of the score.
        uniqueness: the peak over the highest other one.
        blocks: parts of the moving cloud that were placed alone.
        agreeing_blocks: those of them that agree with the whole.
        overlap: share of the moving map that the fixed map sees.
        correlation: of the two maps.
    """

    significance: float
    uniqueness: float
    blocks: int
    agreeing_blocks: int
    overlap: float
    correlation: float


@dataclass(frozen=True)
class Heights:
    """Whether heights are as good as the place; acceptance does not hang on it.

    Attributes:
        measured: they are.
        limit: ``"flat"``, ``"no_ground"``, ``"canopy"`` or ``"uneven"``; empty when measured.
        words: the same in plain words.
        deviation_m: of the height, bias included; infinite without heights [m].
        bias_m: part of it that all of the cloud has in common [m].
        vertical_scale: metres up in the fixed cloud for one in the moving one; None where the relief of the
            ground does not tell it. ``parts.scale_z`` follows it where it is clearly not 1.
        vertical_scale_deviation: of that; 0 without.
    """

    measured: bool
    limit: str
    words: str
    deviation_m: float
    bias_m: float
    vertical_scale: Optional[float]
    vertical_scale_deviation: float


@dataclass(frozen=True, eq=False)
class Alternative:
    """Another place where the moving cloud fits.

    Attributes:
        transform: 4×4, moving file → fixed file coordinates [m].
        significance: as that of `Evidence`.
    """

    transform: Floats
    significance: float


@dataclass(frozen=True, eq=False)
class Registration:
    """What `register` returns.

    Attributes:
        status: the verdict.
        reasons: why, in plain words; never empty.
        remedies: what may help where it is not accepted.
        plane_probability: that the result is within 5 cm RMS in the plane.
        place_probability: calibrated, that it is the right place, however exact.
        transform: 4×4 float64, moving file → fixed file coordinates [m]. A rejected registration
            may have one, too: the best that was found. None: no place at all.
        parts: the same beside the guess; None without a transformation.
        deformation: on top of the transformation; None: none.
        uncertainty: None where too few blocks can be compared.
        heights: whether they are as good as the place; None without a transformation.
        evidence: what speaks for it.
        alternatives: of an ambiguous one, most significant first.
        times: seconds per stage, in the order in which they were entered.
        warnings: about the clouds and the way to the result.
        crs: what the coordinates of the result mean.
    """

    status: Status
    reasons: Tuple[str, ...]
    remedies: Tuple[str, ...]
    plane_probability: float
    place_probability: float
    transform: Optional[Floats]
    parts: Optional[Parts]
    deformation: Optional[Deformation]
    uncertainty: Optional[Uncertainty]
    heights: Optional[Heights]
    evidence: Evidence
    alternatives: Tuple[Alternative, ...]
    times: Dict[str, float]
    warnings: Tuple[str, ...]
    crs: Crs
    _handle: _core.Registration
    _clouds: Tuple[Any, Any]

    @property
    def accepted(self) -> bool:
        """Whether the status is accepted."""
        return self.status is Status.ACCEPTED

    @property
    def covariance(self) -> Optional[Floats]:
        """6×6, that of `uncertainty`; None where there is none."""
        return None if self.uncertainty is None else self.uncertainty.covariance

    def place(self, points: npt.ArrayLike) -> Floats:
        """Where points of the moving file lie, by transformation and deformation.

        Args:
            points: N×3, coordinates of the moving file [m].

        Returns:
            N×3 float64, fixed file coordinates [m].

        Raises:
            UsageError: for a registration without a transformation.
        """
        at = _arrays.points(points, "points")
        if self.transform is None:
            raise UsageError("a registration without a transformation lays no points anywhere")
        moved = _arrays.moved(self.transform, at)
        return moved if self.deformation is None else moved + self.deformation.displacement(at)

    def aligned(self, cloud: CloudLike) -> Cloud:
        """The moving cloud, or one in its file's coordinates, where the registration lays it.

        A file is read as it was for the registration; all but its coordinates and colours is lost.

        Raises:
            UsageError: for a registration without a transformation.
        """
        moving = cloud_of(cloud, "cloud", self.crs)
        return Cloud._of(_core.aligned_cloud(moving._handle, self._handle))

    def maps(self) -> Tuple[CellMap, CellMap]:
        """What was compared: the map of the fixed cloud and that of the moving one.

        Both in the fixed file's coordinates; the moving one where the transformation lays it, and
        without one where the guess does. Bends are not taken out of it.
        """
        fixed, moving = _core.compared_maps(self._handle)
        return map_of(fixed, self.crs), map_of(moving, self.crs)

    def report(self) -> Dict[str, Any]:
        """All of it as the command line's registration.json has it, options in force included."""
        report: Dict[str, Any] = json.loads(self._handle.report_text([]))
        return report

    def write_report(
        self, folder: PathLike, *, pictures: bool = True, overwrite: bool = False
    ) -> List[str]:
        """Writes registration.json, pictures of what was compared and found, and report.html.

        Clouds that were given as files are read again for the page.

        Args:
            folder: made where it is not there.
            pictures: PNG files beside the report, maps and points in the page; else this has words
                and numbers only.
            overwrite: replace a report, its pictures and page that are there.

        Returns:
            Names of the files in the folder. A build without pictures writes no page.

        Raises:
            OutputError: when they cannot be written.
            InputError: when a cloud's file cannot be read any more.
            UsageError: for pictures in a build without them, and when a file holds another cloud now.
        """
        place = _arrays.path_of(folder, "folder")
        for name in ("registration.json", "report.html"):
            if os.path.exists(os.path.join(place, name)) and not overwrite:
                raise OutputError(f"{os.path.join(place, name)}: exists already", "overwrite")
        try:
            os.makedirs(place, exist_ok=True)
        except OSError as error:
            raise OutputError(f"{place}: cannot be made: {error.strerror}") from None
        names = self._write_pictures(place, pictures)
        self._handle.write_report(place, [name for name in names if name.endswith(".png")])
        names.insert(0, "registration.json")
        # Of another registration, which had pictures of things that this one has not.
        _files.remove(place, {"report.html", *_files.PICTURES} - set(names))
        return names

    def _write_pictures(self, folder: str, drawn: bool) -> List[str]:
        """And the page, which has them, too."""
        try:
            from . import _pictures
        except ImportError:
            if not drawn:
                return []
            raise UsageError(
                "pictures: this build has none (AGRICOLMAP_WITH_PICTURES); say pictures=False"
            ) from None
        if not drawn:
            _pictures.write_page(folder, self._handle, [], None, None)
            return ["report.html"]
        fixed, moving = pair_of(*self._clouds)
        names = _pictures.write_pictures(folder, self._handle)
        try:
            _pictures.write_page(folder, self._handle, names, fixed._handle, moving._handle)
        except BaseException:
            _files.remove(folder, names)
            raise
        return [*names, "report.html"]

    def __str__(self) -> str:
        return "\n  ".join([str(self.status), *self.reasons])

    def __repr__(self) -> str:
        return f"<agricolmap.Registration {self.status}: {self.reasons[0]}>"

    def __reduce__(self) -> str:
        raise TypeError(
            "a Registration keeps its maps and cannot be pickled; pickle what is asked of it, such "
            "as report() and transform"
        )


def registration_of(
    handle: _core.Registration, crs: Crs, more_warnings: List[str], clouds: Tuple[Any, Any]
) -> Registration:
    """`clouds`: those that were registered, or their files: see `kept`."""
    values = handle.values()
    bend = values["deformation"]
    if bend is not None:
        bend = Deformation(
            nodes=tuple(Node(*node) for node in bend["nodes"]),
            slips=tuple(Slip(*slip) for slip in bend["slips"]),
            gain=bend["gain"],
            rms_m=bend["rms_m"],
            _handle=handle,
        )

    def made(kind: Any, name: str) -> Any:
        return None if values[name] is None else kind(**values[name])

    return Registration(
        status=Status(values["status"]),
        reasons=tuple(values["reasons"]),
        remedies=tuple(values["remedies"]),
        plane_probability=values["plane_probability"],
        place_probability=values["place_probability"],
        transform=values["transform"],
        parts=made(Parts, "parts"),
        deformation=bend,
        uncertainty=made(Uncertainty, "uncertainty"),
        heights=made(Heights, "heights"),
        evidence=Evidence(**values["evidence"]),
        alternatives=tuple(Alternative(*other) for other in values["alternatives"]),
        times=values["times"],
        warnings=(*more_warnings, *values["warnings"]),
        crs=crs,
        _handle=handle,
        _clouds=clouds,
    )
