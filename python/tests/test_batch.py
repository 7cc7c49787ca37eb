"""Many strips in one go: the contract of the program's batch, from Python."""

import csv
import json
import os
import signal
import subprocess
import sys
import textwrap
import threading

import agricolmap
import numpy as np
import pytest
from agricolmap import Status

VARYING = ("times", "peak_memory_bytes", "threads", "command_line", "seconds")


@pytest.fixture(scope="module")
def manifest(pairs):
    """Two strips that are accepted, and one of another field."""

    def strip(name, kind):
        files = pairs / kind
        map_ = "field" if kind == "same_field" else "other"
        return {
            "id": name,
            "map": map_,
            "file": files / "ugv/point_cloud.ply",
            "prior": files / "prior.txt",
        }

    return {
        "maps": [
            {"id": "field", "file": pairs / "same_field/uav/point_cloud.ply"},
            {"id": "other", "file": pairs / "other_field/uav/point_cloud.ply"},
        ],
        "strips": [strip("a", "same_field"), strip("b", "other_field"), strip("c", "same_field")],
        "pictures": False,
    }


def said(folder):
    """What does not differ from run to run."""
    json_ = json.loads((folder / "registration.json").read_text())
    return {key: value for key, value in json_.items() if key not in VARYING}


@pytest.fixture(scope="module")
def done(manifest, tmp_path_factory):
    """Folder, entries, and what was told on the way."""
    folder = tmp_path_factory.mktemp("batch") / "out"
    told = []
    entries = agricolmap.batch(
        manifest, folder, progress=lambda *words: told.append((*words, threading.get_ident()))
    )
    return folder, entries, told


def test_each_strip_has_its_folder(manifest, done, program, tmp_path):
    folder, entries, told = done
    assert [entry.id for entry in entries] == ["a", "b", "c"]
    assert [entry.status for entry in entries] == [Status.ACCEPTED, Status.REJECTED, Status.ACCEPTED]
    first = entries[0]
    assert first.accepted and not first.failed and not first.kept and first.map == "field"
    assert 0 < first.expected_rms_m < 0.05 and first.plane_probability > 0.8 and first.seconds > 0
    assert first.heights_measured and first.height_deviation_m < 0.045
    assert first.outline_m.shape[1] == 2 and len(first.outline_m) > 3
    assert sorted((entry.id, number, of) for entry, number, of, _ in told) == sorted(
        (entry.id, number + 1, 3) for number, (entry, *_) in enumerate(told)
    )
    assert {thread for *_, thread in told} == {threading.get_ident()}
    (tmp_path / "m.yaml").write_text(json.dumps(manifest, default=os.fspath))
    finished = subprocess.run(
        [os.environ["AGRICOLMAP_PROGRAM"], "batch", tmp_path / "m.yaml", "-o", tmp_path / "out"],
        capture_output=True,
    )
    assert finished.returncode == 10
    for entry in entries:
        assert said(folder / entry.id) == said(tmp_path / "out" / entry.id)
        assert os.path.samefile(entry.folder, folder / entry.id)
    for name in ("transform.txt", "aligned.ply"):
        mine, its = ((place / "a" / name).read_bytes() for place in (folder, tmp_path / "out"))
        assert mine == its
    with open(folder / "summary.csv", newline="") as file:
        assert [row["id"] for row in csv.DictReader(file)] == ["a", "b", "c"]
    assert (folder / "summary.html").exists()


def test_what_is_done_is_kept(manifest, done):
    folder, entries, _ = done
    with pytest.raises(agricolmap.OutputError, match="3 of the strips.*resume=True.*overwrite=True"):
        agricolmap.batch(manifest, folder)
    kept = agricolmap.batch(manifest, folder, resume=True)
    assert all(entry.kept for entry in kept)
    assert [entry.expected_rms_m for entry in kept] == [entry.expected_rms_m for entry in entries]
    changed = {**manifest, "options": {"grid": {"cell": 0.03}}}
    again = agricolmap.batch(changed, folder, resume=True, items=["a"])
    assert [(entry.id, entry.kept) for entry in again] == [("a", False)]
    (one,) = agricolmap.batch(manifest, folder, overwrite=True, items=[1])
    assert one.id == "a" and not one.kept


def test_parts_are_the_whole_together(manifest, tmp_path):
    parts = [agricolmap.batch(manifest, tmp_path, shard=(i, 2), jobs=1) for i in (1, 2)]
    assert [[entry.id for entry in part] for part in parts] == [["a", "c"], ["b"]]
    assert not (tmp_path / "summary.csv").exists()
    assert all(entry.kept for entry in agricolmap.batch(manifest, tmp_path, resume=True))
    assert (tmp_path / "summary.csv").exists()


def test_a_strip_that_fails_stops_no_other(manifest, tmp_path):
    bad = tmp_path / "bad.ply"
    bad.write_text("ply\nformat ascii 1.0\nelement vertex 3\n")
    strips = [{"id": "bad", "map": "field", "file": bad}, manifest["strips"][0]]
    first, second = agricolmap.batch({**manifest, "strips": strips}, tmp_path / "out")
    assert first.failed and first.status is None and "bad.ply" in first.message
    assert first.expected_rms_m is None and not os.path.exists(first.folder)
    assert second.accepted
    # What was made before stays, and is said to.
    strips[1] = {**strips[1], "file": bad, "date": np.int64(20260601)}
    (kept,) = agricolmap.batch(
        {**manifest, "strips": strips}, tmp_path / "out", items=[second.id], overwrite=True
    )
    assert kept.failed and kept.message.endswith("the results of an earlier run stay")
    assert os.path.exists(os.path.join(kept.folder, "registration.json"))


def test_what_makes_no_sense_is_named(manifest, tmp_path):
    for words, kind, text in [
        ({"shard": (3, 2)}, agricolmap.UsageError, r"shard: is \(3, 2\)"),
        ({"items": ["d"]}, agricolmap.UsageError, "item d: is neither"),
        ({"items": ["a"], "shard": (1, 2)}, agricolmap.UsageError, "do not go together"),
        ({"jobs": -1}, agricolmap.UsageError, "jobs: is -1"),
        ({"items": []}, agricolmap.UsageError, "items: is empty"),
        ({"items": "a"}, agricolmap.UsageError, "items: give a list"),
        ({"shard": 5}, agricolmap.UsageError, "shard: is 5"),
        ({"memory": "4 GB"}, agricolmap.UsageError, "memory: .*give a number: bytes"),
        ({"memory": -1}, agricolmap.UsageError, "memory"),
        ({"progress": 3}, agricolmap.UsageError, "progress: cannot be called"),
    ]:
        with pytest.raises(kind, match=text):
            agricolmap.batch(manifest, tmp_path / "out", **words)
    with pytest.raises(agricolmap.UsageError, match=r"manifest:\d+: .*fle"):
        agricolmap.batch({**manifest, "strips": [{"fle": "a.ply"}]}, tmp_path / "out")
    with pytest.raises(agricolmap.UsageError, match="manifest: keys must be"):
        agricolmap.batch({**manifest, ("a", 1): 2}, tmp_path / "out")
    with pytest.raises(agricolmap.UsageError, match="\N{EAR OF MAIZE}.ply: there is no such file"):
        agricolmap.batch({**manifest, "strips": [{"map": "field", "file": "\N{EAR OF MAIZE}.ply"}]}, tmp_path / "out")
    with pytest.raises(agricolmap.UsageError, match="manifest: is a list"):
        agricolmap.batch([], tmp_path / "out")
    with pytest.raises(agricolmap.InputError, match="no such file"):
        agricolmap.batch(tmp_path / "none.yaml", tmp_path / "out")
    assert not (tmp_path / "out").exists()


def test_what_progress_raises_stops_and_is_raised(manifest, tmp_path):
    def enough(entry, done, todo):
        raise KeyError(entry.id)

    with pytest.raises(KeyError):
        agricolmap.batch(manifest, tmp_path, jobs=1, progress=enough)
    there = [name for name in "abc" if (tmp_path / name).exists()]
    assert len(there) < 3 and all((tmp_path / name / "batch_item.json").exists() for name in there)
    stop = threading.Event()
    stop.set()
    with pytest.raises(agricolmap.Interrupted):
        agricolmap.batch(manifest, tmp_path, resume=True, stop=stop)


def test_ctrl_c_keeps_what_is_done(manifest, tmp_path):
    strips = [{**manifest["strips"][0], "id": f"strip_{i}"} for i in range(20)]
    file = tmp_path / "m.yaml"
    file.write_text(json.dumps({**manifest, "strips": strips}, default=os.fspath))
    script = textwrap.dedent(
        """
        import signal, sys
        signal.signal(signal.SIGINT, signal.default_int_handler)
        import agricolmap
        try:
            agricolmap.batch(*sys.argv[1:], jobs=1, progress=lambda *_: print("one", flush=True))
        except KeyboardInterrupt:
            print("stopped")
        """
    )
    process = subprocess.Popen(
        [sys.executable, "-c", script, str(file), str(tmp_path / "out")],
        stdout=subprocess.PIPE,
        text=True,
        env=os.environ,
    )
    assert process.stdout.readline().strip() == "one"
    process.send_signal(signal.SIGINT)
    rest, _ = process.communicate(timeout=60)
    assert rest.split()[-1] == "stopped" and process.returncode == 0
    there = list((tmp_path / "out").iterdir())
    assert 1 <= len(there) < 20
    assert all((folder / "batch_item.json").exists() for folder in there)
