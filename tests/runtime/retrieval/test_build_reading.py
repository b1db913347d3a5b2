"""Galleries of files that hold several animations, or that say of themselves what is wrong."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from acclaim_files import Acclaim
from fake_embedder import FakeEmbedder, open_fake
from motions import walking
from retarget_rigs import named, person, renamed, rig

from motionrt.errors import GalleryError, InvalidInputError
from motionrt.formats.gltf.container import pack_container, read_container
from motionrt.retrieval import Gallery, build_gallery, update_gallery
from motionrt.retrieval.words import WordIndex


def library_of_animations(folder: Path) -> Path:
    """``pack.glb`` with a walk and a run of two seconds and a half, and ``turn.bvh``."""
    folder.mkdir()
    path = walking(50).save(folder / "pack.glb")
    document, binary = read_container(path)
    document["animations"] = [{**document["animations"][0], "name": name} for name in ("Walk", "Armature|Run/fast")]
    path.write_bytes(pack_container(document, binary))
    walking(40, turn=0.5).save(folder / "turn.bvh")
    return folder


def test_each_animation_of_a_file_is_a_clip_of_its_own(tmp_path: Path) -> None:
    folder = library_of_animations(tmp_path / "lib")
    gallery = Gallery.open(build_gallery(folder, open_fake).gallery.folder or folder)
    assert [clip.id for clip in gallery.clips] == ["pack.glb#Armature|Run/fast", "pack.glb#Walk", "turn.bvh"]
    assert not gallery.skipped
    for clip in gallery.clips[:2]:
        assert gallery.path(clip) == folder / "pack.glb"
        assert gallery.motion(clip.id).frames == 50
    assert WordIndex.of(gallery.clips, gallery.windows, ()).known("run")


def test_an_update_reads_a_file_of_animations_only_when_it_changed(tmp_path: Path) -> None:
    folder = library_of_animations(tmp_path / "lib")
    build_gallery(folder, open_fake)
    model = FakeEmbedder()
    report = update_gallery(folder, lambda: model)
    assert (len(report.unchanged), model.calls) == (3, 0)
    document, binary = read_container(folder / "pack.glb")
    document["animations"][0]["name"] = "Stroll"
    (folder / "pack.glb").write_bytes(pack_container(document, binary))
    report = update_gallery(folder, open_fake)
    assert report.added == ("pack.glb#Stroll",)
    assert report.changed == ("pack.glb#Armature|Run/fast",)
    assert report.removed == ("pack.glb#Walk",)
    assert report.unchanged == ("turn.bvh",)


def test_one_animation_that_cannot_be_read_does_not_cost_the_others_and_is_tried_again(tmp_path: Path) -> None:
    folder = library_of_animations(tmp_path / "lib")
    document, binary = read_container(folder / "pack.glb")
    samplers = [dict(one) for one in document["animations"][1]["samplers"]]
    longest = max(samplers, key=lambda one: document["accessors"][one["output"]]["count"])
    document["accessors"].append({**document["accessors"][longest["output"]], "count": 7})
    longest["output"] = len(document["accessors"]) - 1
    document["animations"][1]["samplers"] = samplers
    (folder / "pack.glb").write_bytes(pack_container(document, binary))
    first = build_gallery(folder, open_fake).gallery
    assert [clip.id for clip in first.clips] == ["pack.glb#Walk", "turn.bvh"]
    assert [skipped.path for skipped in first.skipped] == ["pack.glb#Armature|Run/fast"]
    again = update_gallery(folder, open_fake).gallery
    assert (again.clips, again.skipped) == (first.clips, first.skipped)


def test_a_file_whose_animations_are_all_refused_for_one_reason_is_one_entry(tmp_path: Path) -> None:
    folder = library_of_animations(tmp_path / "lib")
    document, binary = read_container(folder / "pack.glb")
    for node in document["nodes"]:
        if "knee" in node.get("name", ""):
            node["scale"] = [1, 2, 3]
    (folder / "pack.glb").write_bytes(pack_container(document, binary))
    assert [skipped.path for skipped in build_gallery(folder, open_fake).gallery.skipped] == ["pack.glb"]


def test_one_animation_of_every_file_can_be_asked_for(tmp_path: Path) -> None:
    folder = library_of_animations(tmp_path / "lib")
    gallery = build_gallery(folder, open_fake, animation="Walk").gallery
    assert [clip.id for clip in gallery.clips] == ["pack.glb", "turn.bvh"]
    assert gallery.motion("pack.glb").frames == 50


def test_rate_and_axis_of_the_caller_hold_for_builds_updates_and_hits(tmp_path: Path) -> None:
    folder = tmp_path / "lib"
    folder.mkdir()
    walking(60).save(folder / "walk.bvh")
    gallery = build_gallery(folder, open_fake, fps=60.0, up="y").gallery
    assert gallery.clips[0].duration_s == pytest.approx(1.0)
    assert gallery.motion("walk.bvh").fps == 60
    walking(90).save(folder / "more.bvh")
    updated = update_gallery(folder, open_fake).gallery
    assert [clip.duration_s for clip in updated.clips] == pytest.approx([1.5, 1.0])
    assert (updated.reading.fps, updated.reading.up) == (60.0, "y")


def test_one_skeleton_serves_all_recordings_of_a_folder(tmp_path: Path) -> None:
    folder = tmp_path / "lib"
    (folder / "takes").mkdir(parents=True)
    names = renamed(
        named("{}femur", "{}tibia", "{}foot", "{}toes", "{}clavicle", "{}humerus", "{}radius", "{}wrist", "{}hand"),
        ("l", "r"),
        pelvis="root", spine1="lowerback", spine2="upperback", spine3="thorax", neck="neck", head="head",
    )  # fmt: skip
    amc = Acclaim().write(rig(person(24), names), tmp_path / "one")
    asf = amc.with_suffix(".asf")
    shutil.copy(amc, folder / "takes" / "take.amc")
    (folder / "skeletons").mkdir()
    shutil.copy(asf, folder / "skeletons" / "somebody.asf")
    with pytest.raises(GalleryError, match="none of the 1 motion files"):
        build_gallery(folder, open_fake)
    gallery = build_gallery(folder, open_fake, asf=folder / "skeletons" / "somebody.asf").gallery
    assert np.isfinite(Gallery.open(folder).motion("takes/take.amc").root).all()
    assert gallery.reading.asf == "skeletons/somebody.asf"
    with pytest.raises(InvalidInputError, match="asf= must name a file in"):
        build_gallery(folder, open_fake, asf=asf)


@pytest.mark.parametrize("options", [{"fps": 0.0}, {"up": "x"}])
def test_options_that_cannot_be_are_refused_before_anything_is_read(tmp_path: Path, options: dict[str, object]) -> None:
    walking(20).save(tmp_path / "walk.bvh")
    with pytest.raises(InvalidInputError, match=r"fps|up"):
        build_gallery(tmp_path, open_fake, **options)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "reading", [{"asf": "../outside.asf"}, {"asf": 3}, {"fps": "30"}, {"mapping": {}}, {"other": 1}, [], None]
)
def test_a_gallery_with_other_options_of_reading_than_there_are_is_damaged(tmp_path: Path, reading: object) -> None:
    walking(20).save(tmp_path / "walk.bvh")
    head = (build_gallery(tmp_path, open_fake).gallery.folder or tmp_path) / "gallery.json"
    content = json.loads(head.read_text(encoding="utf-8"))
    del content["checksum"]
    head.write_text(json.dumps({**content, "reading": reading}), encoding="utf-8")
    with pytest.raises(GalleryError):
        Gallery.open(tmp_path)
