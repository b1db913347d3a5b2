"""Every door through which a stranger's bytes come in, by name: what is called with a file or a folder."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

Door = Callable[[Path], object]


def motion(path: Path) -> object:
    """A motion file, onto the skeleton, and out again as two formats."""
    from motionrt.formats import load_motion

    loaded = load_motion(path)
    assert np.isfinite(loaded.positions()).all()
    for suffix in (".bvh", ".glb"):
        loaded[:2].save(path.with_name(f"out{suffix}"))
    return loaded


def acclaim(path: Path) -> object:
    """Either file of a pair of ASF and AMC, by its own joints."""
    from motionrt.formats import load_rig

    clip = load_rig(path.with_suffix(".amc"))
    assert np.isfinite(clip.global_pose()[0]).all()
    return clip


def rig(path: Path) -> object:
    """A motion file as a character of one's own."""
    from motionrt.formats import load_target

    return load_target(path)


def scene(path: Path) -> object:
    """A mesh or a map; of images the resolution is given."""
    from motionrt.locomotion.scene import Scene

    image = path.suffix.lower() in {".pgm", ".png"}
    return Scene.open(path, resolution=0.05) if image else Scene.open(path)


def cloud(path: Path) -> object:
    """A semantic point cloud, and what stands in it."""
    from motionrt.locomotion.words import load_cloud

    found = load_cloud(path)
    for name in found.names[:3]:
        found.instances(name)
    return found


def script(path: Path) -> object:
    """A script, its scene opened."""
    from motionrt.locomotion import Script

    read = Script.read(path)
    if read.scene is not None:
        read.scene.open()
    return read


def path_csv(path: Path) -> object:
    """A path."""
    from motionrt.locomotion import Path as Route

    return Route.from_csv(path)


def manifest(path: Path) -> object:
    """A models manifest."""
    from motionrt.models.reading import load_manifest

    return load_manifest(path)


def mapping(path: Path) -> object:
    """A joint mapping of the command line."""
    from motionrt.cli.options import read_mapping

    return read_mapping(path)


def captions(path: Path) -> object:
    """A list of captions."""
    from motionrt.retrieval import read_captions

    return read_captions(path)


def gallery(path: Path) -> object:
    """A gallery: opened, searched, read."""
    from motionrt.errors import GalleryError, MotionFileNotFoundError
    from motionrt.retrieval import Gallery

    opened = Gallery.open(path)
    opened.search(np.ones(opened.embeddings.shape[1], np.float32), 3)
    opened.check_model(opened.model.fingerprint, "same")
    for clip in opened.clips:
        try:
            opened.motion(clip.id)
        except MotionFileNotFoundError:  # its files are somewhere else
            continue
        except GalleryError as error:
            if opened.motions is not None or "only its embedding" not in str(error):
                raise
    return opened


def text(path: Path) -> object:
    """A sentence, as searches, generation and instructions take it."""
    from motionrt.locomotion.words.instruction import parse_instruction
    from motionrt.models.text import checked_text
    from motionrt.synthesis.parts import body_parts

    words = path.read_bytes().decode("utf-8", "surrogateescape")
    checked_text(words)
    body_parts(words)
    return parse_instruction(words)


def plan(path: Path) -> object:
    """A plan, its timeline read, as the generator and the studio take it."""
    from motionrt.studio.plan_draft import PlanDraft
    from motionrt.synthesis.parts import body_parts
    from motionrt.synthesis.plan import Plan
    from motionrt.synthesis.timeline import read_timeline

    read = Plan.read(path)
    if read.timeline:
        read_timeline(read.timeline, body_parts)
    PlanDraft.of(read)
    return read


def sidecar(path: Path) -> object:
    """Words beside the clips of a folder."""
    from motionrt.retrieval.sidecars import read_sidecars

    return read_sidecars(path.parent, ["clip0.bvh", "clip1.npz", "a/clip2.bvh"], [path.name])


def votes(path: Path) -> object:
    """What a person chose on a page of comparisons, counted and written as a table."""
    from motionrt.study.votes import count_votes, write_votes

    write_votes([path], path.with_name("votes.csv"))
    return count_votes([path])


def project(path: Path) -> object:
    """A project of the studio: unpacked, its sheet and its files read."""
    from motionrt.errors import MotionRTError
    from motionrt.formats import load_motion
    from motionrt.studio.project import sheet_of, unpacked

    files = unpacked(path.read_bytes())
    sheet = sheet_of(files)
    for name, content in files:
        if name.endswith(".npz"):
            inside = path.with_name("inside.npz")
            inside.write_bytes(content)
            try:
                load_motion(inside)
            except MotionRTError:
                continue
    return sheet


def info(path: Path) -> object:
    """What is told of a motion file."""
    from motionrt.formats.info import motion_file_info

    return repr(motion_file_info(path))


def cut(path: Path) -> object:
    """A motion file, and its first frames cut out of it as they are."""
    from motionrt.formats import load_motion
    from motionrt.formats.cutting import cut_file

    loaded = load_motion(path)
    out = path.with_name(f"part{path.suffix}")
    return cut_file(path, out, 0, max(1, loaded.frames // 2), frames=loaded.frames, fps=loaded.fps)


def dressed(path: Path) -> object:
    """A character with its mesh and colours, in two frames of a motion."""
    from motions import walking

    from motionrt.formats.character import load_character

    figure = load_character(path)
    worn = figure.dressed(walking(2))
    assert all(np.isfinite(worn.vertices(frame)).all() for frame in range(2))
    return worn


DOORS: dict[str, Door] = {
    door.__name__: door
    for door in (
        motion, acclaim, rig, scene, cloud, script, path_csv, manifest, mapping, captions, gallery, text,
        plan, sidecar, votes, project, info, cut, dressed,
    )
}  # fmt: skip


def door_of(name: str) -> str:  # noqa: PLR0911  # a rule a line
    """The door for a file of the corpus, by its name."""
    named = name.partition("-")[0]
    if named in {"plan", "sidecar", "votes", "project", "dressed", "mapping", "cut", "gallery"}:
        return named
    if name.startswith("cloud"):
        return "cloud"
    if name.startswith(("mesh-", "pgm", "laugh_map", "deepmap", "int_digits_map", "mapyaml", "map_res", "png9000")):
        return "scene"
    if name.startswith("laugh_manifest"):
        return "manifest"
    if name.startswith(("gen-", "text-")):
        return "text"
    if name.startswith("g_"):
        return "gallery"
    return "script" if name.endswith(".yaml") else "motion"
