"""The table of limits, and what is read within it."""

from __future__ import annotations

import os
import threading
from dataclasses import fields
from pathlib import Path, PurePosixPath, PureWindowsPath

import numpy as np
import pytest
from motions import walking

from motionrt import limits
from motionrt.errors import FormatError, InvalidInputError, MotionRTError
from motionrt.formats import load_motion
from motionrt.models.external import names_other_files
from motionrt.motion import Motion
from motionrt.retrieval.head import stays_below
from motionrt.untrusted import json_text, yaml_text
from motionrt.untrusted.files import beside, check_file, confined
from motionrt.untrusted.npz import read_arrays

ROOT = Path(__file__).parents[3]


def fail(reason: str, line: int | None) -> FormatError:
    return FormatError("file", reason, line)


def test_every_limit_stands_in_the_manual() -> None:
    manual = (ROOT / "docs" / "reliability.md").read_text(encoding="utf-8")
    missing = [field.name for field in fields(limits.Limits) if f"`{field.name}`" not in manual]
    assert missing == []


def test_a_limit_is_raised_for_a_block_and_by_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    assert limits.limits().joints == 2048
    with limits.raised(joints=3):
        assert limits.limits().joints == 3
        seen = []
        other = threading.Thread(target=lambda: seen.append(limits.limits().joints))
        other.start()
        other.join()
        assert seen == [2048]
    monkeypatch.setenv(limits.VARIABLE, "joints=7, fps=60")
    assert (limits.limits().joints, limits.limits().fps) == (7, 60)


@pytest.mark.parametrize("text", ["joints", "joints=x", "joints=-1", "joints=nan", "knees=3"])
def test_a_wrong_limit_is_refused_in_words(monkeypatch: pytest.MonkeyPatch, text: str) -> None:
    monkeypatch.setenv(limits.VARIABLE, text)
    with pytest.raises(InvalidInputError, match=r"limit|MOTIONRT_LIMITS"):
        limits.limits()


def test_a_message_is_never_longer_than_two_thousand_characters() -> None:
    assert len(str(FormatError("x", "y" * 100_000))) <= 2000


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no pipes in the file system here")
def test_pipes_devices_folders_and_loops_of_links_are_no_files(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.bvh")
    (tmp_path / "loop.bvh").symlink_to(tmp_path / "loop.bvh")
    (tmp_path / "folder.bvh").mkdir()
    for name in ("pipe.bvh", "loop.bvh", "folder.bvh"):
        with pytest.raises(FormatError):
            load_motion(tmp_path / name)
    with pytest.raises(FormatError, match="is a device"):
        check_file(Path("/dev/zero"), fail)


@pytest.mark.parametrize("opening", [b"[", b'{"a":'])
def test_deep_json_is_refused_before_it_is_parsed(opening: bytes) -> None:
    with pytest.raises(FormatError, match="nested too deep"):
        json_text.parse(opening * 100_000, fail)
    assert json_text.parse(b'"' + b"[" * 1000 + b'"', fail) == "[" * 1000


@pytest.mark.parametrize(
    "text",
    [
        "\n".join(f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10 if i else ['x'] * 10)}]" for i in range(9)),
        "\n".join(f"a{i}: &a{i} {{{', '.join(f'k{j}: *a{i - 1}' for j in range(10)) if i else ''}}}" for i in range(9)),
        "a: " + "[" * 500 + "]" * 500,
        "a: " + "{a: " * 100 + "}" * 100,
        "\n".join(f"{'  ' * i}- " for i in range(100)),
    ],
)
def test_yaml_that_costs_more_than_its_size_is_refused(text: str) -> None:
    with pytest.raises(FormatError):
        yaml_text.check_yaml(text, fail)


def test_an_npz_that_claims_more_than_it_holds_is_refused(tmp_path: Path) -> None:
    np.savez_compressed(tmp_path / "bomb.npz", a=np.zeros((300, 2**20), np.uint8))
    with pytest.raises(FormatError, match="unpacked_bytes"):
        read_arrays(tmp_path / "bomb.npz", fail)
    np.savez(tmp_path / "long.npz", **{"n" * 300: np.zeros(1)})
    with pytest.raises(FormatError, match="name"):
        read_arrays(tmp_path / "long.npz", fail)


@pytest.mark.parametrize("scale", [0.0, 0.9, 1.1, -1.0])
def test_matrices_that_are_no_rotations_are_refused(scale: float) -> None:
    motion = walking(3)
    rotations = motion.rotations.copy()
    rotations[1, 4] *= scale
    with pytest.raises(InvalidInputError, match=r"no rotation, first in frame 1 at 'left_knee'"):
        Motion(rotations, motion.root, 30)


def test_a_mirror_image_and_a_shear_are_no_rotations() -> None:
    motion = walking(2)
    for wrong in (np.diag([-1.0, 1, 1]), np.array([[1, 0.2, 0], [0, 1, 0], [0, 0, 1]])):
        rotations = motion.rotations.copy()
        rotations[0, 0] = wrong
        with pytest.raises(InvalidInputError, match="no rotation"):
            Motion(rotations, motion.root, 30)


@pytest.mark.parametrize("fps", [0, -1, 1e-300, 1e9, float("inf"), True, "30", None, 10**400])
def test_absurd_rates_are_refused(fps: object) -> None:
    motion = walking(2)
    with pytest.raises(InvalidInputError, match="fps"):
        Motion(motion.rotations, motion.root, fps)  # type: ignore[arg-type]
    with pytest.raises(InvalidInputError, match="fps"):
        motion.resample(fps)  # type: ignore[arg-type]


@pytest.mark.parametrize("path", [None, 3, b"x.bvh", "x\0.bvh", ["x.bvh"]])
def test_what_is_no_path_is_told(path: object) -> None:
    with pytest.raises(MotionRTError):
        load_motion(path)  # type: ignore[arg-type]


def test_confined_files_name_only_what_lies_beside_them_by_plain_names(tmp_path: Path) -> None:
    (tmp_path / "in").mkdir()
    (tmp_path / "in" / "a.csv").touch()
    (tmp_path / "b.csv").touch()
    assert beside(tmp_path, "b.csv", fail) == tmp_path / "b.csv"
    with confined(tmp_path / "in"):
        assert beside(tmp_path / "in", "a.csv", fail) == tmp_path / "in" / "a.csv"
        told = set()
        for name in ("../b.csv", "../c.csv", "/etc/passwd", "..", ".", "in/a.csv", "C:a.csv"):
            with pytest.raises(FormatError) as refused:
                beside(tmp_path / "in", name, fail)
            told.add(str(refused.value).replace(name, "NAME"))
        assert len(told) == 1


@pytest.mark.parametrize("name", ["../a", "a/../../b", "/a", "C:/a", "C:a", "//host/share/a", r"\\host\share\a", ""])
def test_an_id_of_a_gallery_stays_below_its_folder_on_windows(name: str) -> None:
    assert not stays_below(name, PureWindowsPath)


@pytest.mark.parametrize("name", ["a", "a/b.bvh", "caf\udce9.bvh", "con/a.bvh", "a" * 300])
def test_names_below_the_folder_are_let_through(name: str) -> None:
    assert stays_below(name, PurePosixPath)
    assert stays_below(name, PureWindowsPath)


def test_models_with_weights_elsewhere_are_known_by_their_bytes() -> None:
    onnx = pytest.importorskip("onnx", reason="makes the model; the runtime needs no onnx")
    numpy_helper, helper = onnx.numpy_helper, onnx.helper
    weight = numpy_helper.from_array(np.ones(2, np.float32), "location")
    graph = helper.make_graph([helper.make_node("Identity", ["location"], ["y"])], "g", [], [], [weight])
    model = helper.make_model(graph)
    assert not names_other_files(model.SerializeToString())
    entry = model.graph.initializer[0].external_data.add()
    entry.key, entry.value = "location", "../../etc/passwd"
    model.graph.initializer[0].data_location = onnx.TensorProto.EXTERNAL
    assert names_other_files(model.SerializeToString())
    inner = helper.make_node("If", ["c"], ["z"], then_branch=model.graph, else_branch=graph)
    nested = helper.make_model(helper.make_graph([inner], "h", [], []))
    assert names_other_files(nested.SerializeToString())
