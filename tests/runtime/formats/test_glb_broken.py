"""GLB files that are damaged, hostile or of a kind that cannot be read: a typed error that says what to do."""

from __future__ import annotations

import struct
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from characters import character
from glb_files import Glb, container, glb, unpack
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from motions import walking

from motionrt import load_motion
from motionrt.errors import FormatError, MotionFileNotFoundError, MotionRTError
from motionrt.formats import load_rig, load_target, write_glb

TIMES = np.arange(5) / 30.0
PERSON = character("mixamo")


def sound() -> Glb:
    out = glb(PERSON, frames="world")
    keys = np.tile([0.0, 0, 0, 1], (5, 1))
    out.animate("still", [(0, "rotation", TIMES, keys), (1, "rotation", TIMES, keys)])
    return out


def test_the_file_that_the_tests_break_is_sound(tmp_path: Path) -> None:
    assert load_motion(sound().save(tmp_path / "clip.glb")).frames == 5


def test_bytes_that_are_no_glb(tmp_path: Path) -> None:
    path = tmp_path / "clip.glb"
    cases = {
        b"": "not a GLB file",
        b"HIERARCHY\nROOT hips": "not a GLB file",
        b'{"asset": {"version": "2.0"}}': "no nodes",
        struct.pack("<III", 0x46546C67, 1, 12): "GLB version 1",
        struct.pack("<III", 0x46546C67, 2, 12): "ends inside the header",
        struct.pack("<IIIII", 0x46546C67, 2, 20, 0, 0x004E4942): "first chunk is not JSON",
        struct.pack("<IIIII", 0x46546C67, 2, 20, 4096, 0x4E4F534A): "does not fit",
        container({}, b""): "no asset",
        container({"asset": {"version": "1.0"}}, b""): "not glTF 2",
        container({"asset": {"version": "2.0"}}, b""): "no nodes",
    }
    for content, message in cases.items():
        path.write_bytes(content)
        with pytest.raises(FormatError, match=message):
            load_rig(path)


def test_a_file_cut_anywhere_is_an_error(tmp_path: Path) -> None:
    content, path = sound().to_bytes(), tmp_path / "clip.glb"
    for length in (*range(0, 60, 7), len(content) // 2, len(content) - 1):
        path.write_bytes(content[:length])
        with pytest.raises(FormatError):
            load_rig(path)


def test_json_that_lies_about_its_size_or_is_too_big_is_not_read(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = sound().save(tmp_path / "clip.glb")
    monkeypatch.setenv("MOTIONRT_LIMITS", "json_bytes=1000")
    with pytest.raises(FormatError, match="bytes of JSON: the limit json_bytes is 1,000"):
        load_rig(path)


def test_json_that_is_damaged_or_deep_is_an_error(tmp_path: Path) -> None:
    path = tmp_path / "clip.glb"
    cases = {
        b'{"asset":   ': "is not JSON",
        b"[" * 200_000: "nested too deep|not JSON",
        b"\xff\xfe{}": "not UTF-8",
        b'{"asset": {"version": "2.0"}, "x": NaN} ': "NaN is no number",
    }
    for text, message in cases.items():
        chunk = struct.pack("<II", len(text), 0x4E4F534A) + text
        path.write_bytes(struct.pack("<III", 0x46546C67, 2, 12 + len(chunk)) + chunk)
        with pytest.raises(FormatError, match=message):
            load_rig(path)


def _circle(document: dict[str, Any]) -> None:
    nodes = document["nodes"]
    nodes[4].setdefault("children", []).append(1)
    nodes[0]["children"] = [child for child in nodes[0]["children"] if child != 1]


def _two_parents(document: dict[str, Any]) -> None:
    document["nodes"][5].setdefault("children", []).append(1)


def _deep(document: dict[str, Any]) -> None:
    first = len(document["nodes"])
    document["nodes"] += [{"name": "x", "children": [first + i + 1]} for i in range(3000)] + [{"name": "x"}]


def _roots(document: dict[str, Any]) -> None:
    hips = document["nodes"][0]
    document["scenes"][0]["nodes"] += hips["children"]
    hips["children"] = []


def _sparse(document: dict[str, Any]) -> None:
    accessor = document["accessors"][document["animations"][0]["samplers"][0]["output"]]
    accessor["sparse"] = {
        "count": 10**9,
        "indices": {"bufferView": 0, "componentType": 5123},
        "values": {"bufferView": 0},
    }


def _meshopt(document: dict[str, Any]) -> None:
    accessor = document["accessors"][document["animations"][0]["samplers"][0]["output"]]
    view = document["bufferViews"][accessor["bufferView"]]
    view["extensions"] = {"EXT_meshopt_compression": {"buffer": 0, "mode": "ATTRIBUTES"}}


def _no_view(document: dict[str, Any]) -> None:
    del document["accessors"][document["animations"][0]["samplers"][0]["output"]]["bufferView"]


def _set(*keys: object, value: object) -> Callable[[dict[str, Any]], None]:
    def change(document: dict[str, Any]) -> None:
        place: Any = document
        for key in keys[:-1]:
            place = place[key]
        place[keys[-1]] = value

    return change


def _output(key: str, value: object) -> Callable[[dict[str, Any]], None]:
    def change(document: dict[str, Any]) -> None:
        document["accessors"][document["animations"][0]["samplers"][0]["output"]][key] = value

    return change


DAMAGE: dict[str, tuple[Callable[[dict[str, Any]], None], str]] = {
    "circle": (_circle, "its own ancestor: the nodes form a circle"),
    "two parents": (_two_parents, "hangs on two nodes"),
    "too deep": (_deep, "nested more than 512 deep"),
    "two roots": (_roots, r"has \d roots \('mixamorig:Hips', .*put them under one node"),
    "child": (_set("nodes", 1, "children", value=[9999]), "a child 9999, which does not exist"),
    "sparse": (_sparse, "sparse accessor of sizes that do not fit"),
    "meshopt": (_meshopt, "compressed with meshopt; export without compression"),
    "no data": (_no_view, "has no data"),
    "far away": (_output("byteOffset", 2**40), "lies outside of the file's binary data"),
    "too many": (_output("count", 2**40), "lies outside of the file's binary data"),
    "negative": (_output("byteOffset", -400), "sizes that are no sizes"),
    "kind": (_output("componentType", 5125000), "accessor of an unknown kind"),
    "text": (_output("count", "5"), "accessor of an unknown kind"),
    "shape": (_output("type", "VEC3"), "the file is damaged"),
    "values": (_output("count", 4), "4 values for 5 keys"),
    "skins": (lambda document: document.update(skins=document["skins"] * 300), "holds 300 skins; at most 256"),
    "no accessor": (_set("animations", 0, "samplers", 0, "output", value=999), r"accessors\[999\], which does not"),
    "spline": (_set("animations", 0, "samplers", 0, "interpolation", value="BEZIER"), "unknown interpolation 'BEZIER'"),
    "mirrored": (_set("nodes", 1, "scale", value=[-1, 1, 1]), "'mixamorig:Spine' is mirrored .negative scale.; apply"),
    "negative scale": (_set("nodes", 0, "scale", value=[-1, -1, -1]), "is mirrored"),
    "flat": (_set("nodes", 1, "scale", value=[1, 0, 1]), "has no size .scale 0.; apply"),
    "uneven": (_set("nodes", 1, "scale", value=[1, 2, 1]), r"scaled unevenly \(1, 2, 1\) above other joints; apply"),
    "quaternion": (_set("nodes", 1, "rotation", value=[0, 0, 0, 0]), "a quaternion without length"),
    "huge": (_set("nodes", 1, "translation", value=[1e30, 0, 0]), "not 3 finite numbers of sane size"),
    "words": (_set("nodes", 1, "translation", value=["a", 0, 0]), "not 3 finite numbers"),
    "matrix": (_set("nodes", 1, "matrix", value=[1.0, 0, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]), "shears"),
    "joints": (_set("skins", 0, "joints", value=[0, 1, 5000]), "names joints that do not exist"),
    "node kinds": (_set("nodes", value={"a": 1}), "nodes is not as glTF has it"),
    "nothing moves": (_set("animations", value=[]), r"a skeleton but no animation.*retarget_to"),
    "no skeleton": (lambda document: [document.pop(key) for key in ("skins", "animations")] and None, "no skeleton"),
}  # fmt: skip


@pytest.mark.parametrize("name", DAMAGE)
def test_damage_is_named(tmp_path: Path, name: str) -> None:
    out = sound()
    DAMAGE[name][0](out.document)
    with pytest.raises(FormatError, match=DAMAGE[name][1]):
        load_rig(out.save(tmp_path / "clip.glb"))


def test_data_in_other_files_is_not_looked_for(tmp_path: Path) -> None:
    document, binary = unpack(sound().to_bytes())
    document["buffers"][0]["uri"] = "../../etc/passwd"
    (tmp_path / "clip.glb").write_bytes(container(document, binary))
    with pytest.raises(FormatError, match=r"lies in another file \('../../etc/passwd'\); save everything in one \.glb"):
        load_rig(tmp_path / "clip.glb")


def test_times_that_run_back_or_for_years_are_errors(tmp_path: Path) -> None:
    out = glb(PERSON, frames="world")
    keys = np.tile([0.0, 0, 0, 1], (3, 1))
    out.animate("back", [(1, "rotation", [0.0, 2.0, 1.0], keys)])
    with pytest.raises(FormatError, match="times that go back"):
        load_rig(out.save(tmp_path / "clip.glb"))
    out = glb(PERSON, frames="world")
    out.animate("years", [(1, "rotation", [0.0, 1.0, 1e8], keys)])
    with pytest.raises(FormatError, match="frames at 30 fps; cut it"):
        load_rig(out.save(tmp_path / "clip.glb"))


def test_compressed_meshes_and_missing_pictures_do_not_matter(tmp_path: Path) -> None:
    out = sound()
    out.document["extensionsUsed"] = out.document["extensionsRequired"] = ["KHR_draco_mesh_compression"]
    primitive = out.document["meshes"][0]["primitives"][0]
    primitive["extensions"] = {"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}}}
    out.document["images"] = [{"uri": "skin.png"}]
    path = out.save(tmp_path / "clip.glb")
    assert load_motion(path).frames == 5
    walking(4, 30).retarget_to(path).save(tmp_path / "out.glb")
    assert unpack((tmp_path / "out.glb").read_bytes())[0]["images"] == [{"uri": "skin.png"}]


def test_missing_files_and_folders_are_told_apart(tmp_path: Path) -> None:
    for read in (load_rig, load_target):
        with pytest.raises(MotionFileNotFoundError):
            read(tmp_path / "none.glb")
    (tmp_path / "folder.glb").mkdir()
    with pytest.raises(FormatError, match="is a folder"):
        load_target(tmp_path / "folder.glb")


@settings(max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.data())
def test_whatever_the_bytes_only_our_errors_come_out(tmp_path: Path, data: st.DataObject) -> None:
    content = bytearray(write_glb(walking(3), tmp_path / "walk.glb").read_bytes())
    for _ in range(data.draw(st.integers(1, 6))):
        place = data.draw(st.integers(0, min(len(content), 9000) - 1))
        content[place] = data.draw(st.sampled_from([*b'0129-.",:[]{}eE \0\xff', 0x7F]))
    path = tmp_path / "clip.glb"
    path.write_bytes(bytes(content))
    for read in (load_motion, load_target):
        with suppress(MotionRTError):
            read(path)
