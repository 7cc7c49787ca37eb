"""The stages one by one."""

import threading

import agricolmap
import numpy as np
import pytest
from agricolmap import Pair, Place


@pytest.fixture(scope="module")
def pair(drone, robot, guess):
    return Pair(drone, robot, guess)


def distance(robot, one, other):
    at = robot.xyz[::1000]
    return np.sqrt((((at @ (one - other)[:3, :3].T + (one - other)[:3, 3])) ** 2).sum(1)).max()


def test_stages_make_what_register_makes(pair, robot, result):
    """The first search convinces, so that there is no other."""
    places = pair.locate()
    assert len(places) > 1 and places[0].score >= places[1].score
    assert distance(robot, places[0].transform, result.transform) < 0.4
    judged = pair.judge(places)
    assert distance(robot, judged.transform, result.transform) < 1e-4
    assert judged.accepted and judged.evidence.blocks == result.evidence.blocks
    assert judged.evidence.significance == pytest.approx(result.evidence.significance, rel=1e-3)
    assert judged.uncertainty.expected_rms_m == pytest.approx(
        result.uncertainty.expected_rms_m, rel=0.01
    )
    assert judged.plane_probability > 0.95


def test_places_are_refined_and_told_apart(pair, robot, result):
    near = result.transform.copy()
    near[:2, 3] += 0.05
    refined = pair.refine([near, Place(result.transform)])
    assert len(refined) == 1 and refined[0].score > 10
    assert distance(robot, refined[0].transform, result.transform) < 0.02


def test_places_of_ones_own_are_judged(pair, result):
    judged = pair.judge([result.transform])
    assert judged.accepted and np.abs(judged.transform - result.transform).max() < 0.02
    elsewhere = result.transform.copy()
    elsewhere[0, 3] += 1.3
    assert not pair.judge([elsewhere]).accepted
    nothing = pair.judge([])
    assert nothing.status is agricolmap.Status.REJECTED and nothing.transform is None


def test_maps_of_a_pair_are_what_is_compared(pair, result):
    for one, other in zip(pair.maps(), result.maps()):
        assert np.array_equal(one.height_m, other.height_m, equal_nan=True)
    fixed, moving = pair.maps()
    assert np.allclose(
        fixed.file_from_cell[:3, :3], moving.file_from_cell[:3, :3]
    )  # by the guess both lie alike


def test_what_makes_no_sense_is_named(pair, drone, robot, guess):
    with pytest.raises(agricolmap.UsageError, match="scale"):
        Pair(drone, robot, guess, {"prior": {"scale_unknown": True}})
    with pytest.raises(agricolmap.UsageError, match=r"places\[1\]: has shape \(3, 3\)"):
        pair.refine([np.eye(4), np.eye(3)])
    with pytest.raises(agricolmap.UsageError, match="places: is a single one"):
        pair.judge(np.eye(4))
    stop = threading.Event()
    stop.set()
    with pytest.raises(agricolmap.Interrupted):
        Pair(drone, robot, guess, stop=stop)
