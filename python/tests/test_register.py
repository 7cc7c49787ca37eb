"""The registration: what goes in."""

import agricolmap
import numpy as np
import pytest


def errors_of(result, pairs, robot):
    """Distances between where points are laid and where they belong [m]."""
    truth = agricolmap.read_matrix(pairs / "same_field/truth.txt")
    at = robot.xyz[::1000]
    return np.linalg.norm(result.place(at) - (at @ truth[:3, :3].T + truth[:3, 3]), axis=1)


def test_arrays_give_what_files_give(pairs, drone, robot, guess, result):
    assert result.accepted and errors_of(result, pairs, robot).max() < 0.05
    by_arrays = agricolmap.register(
        (drone.xyz, drone.colours), agricolmap.Cloud(robot.xyz, robot.colours), guess
    )
    by_paths = agricolmap.register(
        pairs / "same_field/uav/point_cloud.ply",
        str(pairs / "same_field/ugv/point_cloud.ply"),
        pairs / "same_field/prior.txt",
        threads=1,
    )
    assert np.array_equal(by_paths.transform, result.transform)
    assert np.abs(by_arrays.transform - result.transform).max() < 1e-3
    assert by_arrays.status is by_paths.status is agricolmap.Status.ACCEPTED


def test_offsets_beside_files_are_the_guess(pairs, tmp_path):
    folder = pairs / "georeferenced"
    clouds = [folder / "uav/point_cloud.ply", folder / "ugv/point_cloud.ply"]
    assert agricolmap.register(*clouds).accepted
    moved = [tmp_path / "drone.ply", tmp_path / "robot.ply"]
    shift = np.eye(4)
    shift[:3, 3] = [100, 0, 0]
    agricolmap.read(clouds[0]).write(moved[0])
    agricolmap.read(clouds[1]).write(moved[1], shift)
    (tmp_path / "robot.offset.xyz").write_text("-100 0 0\n")
    result = agricolmap.register(*moved)
    assert result.accepted
    assert any("only" in warning and "offset.xyz" in warning for warning in result.warnings)


def test_options_come_as_they_like(drone, robot, guess, tmp_path):
    (tmp_path / "options.yaml").write_text("verdict:\n  min_probability: 0.9999999\n")
    for options in (
        {"preset": "default", "verdict": {"min_probability": 0.9999999}, "seed": 3},
        tmp_path / "options.yaml",
    ):
        report = agricolmap.register(drone, robot, guess, options).report()
        assert report["options"]["verdict"]["min_probability"] == 0.9999999
        assert report["seed"] == (3 if "preset" in str(options) else 1)


def test_another_field_is_rejected(pairs):
    folder = pairs / "other_field"
    result = agricolmap.register(
        folder / "uav/point_cloud.ply", folder / "ugv/point_cloud.ply", folder / "prior.txt"
    )
    assert result.status is agricolmap.Status.REJECTED and not result.accepted
    assert str(result).startswith("rejected\n  ") and result.reasons


def test_a_transformation_from_elsewhere_is_checked(pairs, drone, robot):
    narrow = {"prior": {"translation": 0.2, "heading_deg": 1, "scale": 0.02}}
    mine = agricolmap.read_matrix(pairs / "same_field/truth.txt")
    mine[0, 3] += 0.05
    result = agricolmap.register(drone, robot, mine, narrow)
    assert result.accepted and abs(result.parts.shift_m[0] + 0.05) < 0.02
    mine[0, 3] += 1
    assert not agricolmap.register(drone, robot, mine, narrow).accepted


def test_the_path_of_the_robot_is_taken(drone, robot, guess, tmp_path):
    at = robot.xyz
    path = at[[at[:, 0].argmin(), at[:, 0].argmax()]]
    result = agricolmap.register(drone, robot, guess, path=path[:, :2])
    assert result.accepted and not result.warnings
    with pytest.raises(agricolmap.UsageError, match=r"path: has shape \(2,\)"):
        agricolmap.register(drone, robot, guess, path=[1, 2])


@pytest.mark.parametrize(
    ("guess", "said"),
    [
        (np.eye(3), r"guess: has shape \(3, 3\)"),
        (np.zeros((4, 4)), "guess: its last row"),
        (np.diag([1.0, 1.0, 0.0, 1.0]), "guess: is not invertible"),
        (np.full((4, 4), np.nan), "guess: has numbers that are not finite"),
        (np.eye(4).astype(complex), "guess: has dtype complex128"),
    ],
)
def test_wrong_guesses_are_named(flat, guess, said):
    with pytest.raises(agricolmap.UsageError, match=said):
        agricolmap.register(flat, flat, guess)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ({"threads": -1}, "threads: is -1"),
        ({"threads": 1.5}, "threads: is 1.5"),
        ({"progress": 3}, "progress: cannot be called"),
        ({"stop": 3}, "stop: has no is_set"),
        ({"options": 3}, "options: is a int"),
        ({"options": {"cpd.outlier_share": 0.3}}, "cpd.outlier_share = 0.3 would do nothing"),
        ({"moving": np.zeros((3, 9))}, r"moving: has shape \(3, 9\)"),
        ({"moving": (np.zeros((9, 3)), np.zeros((9, 3)))}, r"moving\[1\]: has dtype float64"),
        ({"fixed": "none.ply"}, "none.ply"),
    ],
)
def test_wrong_arguments_are_named(flat, arguments, said):
    pair = {"fixed": flat, "moving": flat}
    with pytest.raises(agricolmap.Error, match=said):
        agricolmap.register(**{**pair, **arguments})


def test_remedies_are_in_words_of_python(drone, robot, guess):
    with pytest.raises(agricolmap.InputError, match="no colours.*geometry_only") as caught:
        agricolmap.register(drone.xyz, robot.xyz, guess)
    assert caught.value.remedy == "heights_alone"
    assert "--" not in str(caught.value)
