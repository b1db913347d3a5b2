"""Small sound files of the kinds that other programs write: bodies of SMPL, features, binary FBX, a dressed figure."""

from __future__ import annotations

import io
import json
import zipfile
from pathlib import Path

import numpy as np
from binary_fbx import write_binary_fbx
from characters import character
from glb_files import glb
from motions import walking

from motionrt.motion.features import guo263
from motionrt.motion.rotations import matrix_to_axis_angle

PLAN = """timeline:
  - {text: a person walks forward, from: 0, to: 3}
  - {text: waves the right hand, from: 1.5, to: 3, parts: [right arm]}
path: [{time: 0, place: [0, 0]}, {time: 3, place: [0, 2], heading: 90}]
targets: [{time: 2, joint: right_wrist, place: [0.3, 1.2, 1.0]}]
"""
SCALED = "timeline:\n  - {text: walk, seconds: 2}\n  - {text: sit down, seconds: 3}\n"
ROWS = "".join(json.dumps({"file": f"clip{n}.bvh", "captions": ["a person walks", "he goes"]}) + "\n" for n in range(4))
TABLE = "file,caption\nclip0.bvh,a person walks\nclip1.npz,somebody sits\n"
RIG_MAP = 'left_hip: "L_Thigh"\nright_hip: R_Thigh\nhead: Head\n'
STUDY = {
    "kind": "motionrt study", "a": "one", "b": "two", "study": "s",
    "votes": [{"pair": "p", "left": "a", "chosen": "b", "seconds": 1.5}],
}  # fmt: skip


def write_spellings(folder: Path) -> dict[str, tuple[str, Path]]:
    """``{name: (door, file)}`` of sound files below a folder; ``clip.fbx`` lies there already."""
    seeds = {
        name: (door, folder / name) for name, door in (_arrays(folder) | _figures(folder) | _texts(folder)).items()
    }
    write_binary_fbx(folder / "clip.fbx", folder / "binary.fbx")
    (folder / "project.zip").write_bytes(_project(folder))
    return seeds | {
        "motion.binary.fbx": ("motion", folder / "binary.fbx"),
        "rig.binary.fbx": ("rig", folder / "binary.fbx"),
        "project.zip": ("project", folder / "project.zip"),
        "info.bvh": ("info", folder / "clip.bvh"),
        "info.fbx": ("info", folder / "binary.fbx"),
        "info.npz": ("info", folder / "clip.npz"),
        "cut.bvh": ("cut", folder / "clip.bvh"),
        "cut.npz": ("cut", folder / "clip.npz"),
    }


def _arrays(folder: Path) -> dict[str, str]:
    clip = walking(12)
    vectors = matrix_to_axis_angle(clip.rotations.astype(np.float64)).astype(np.float32)
    places, rate = clip.root.astype(np.float32), {"mocap_framerate": np.array(20.0)}
    np.savez(folder / "smpl72.npz", poses=vectors.reshape(12, 72), trans=places, **rate)
    np.savez(folder / "smplx.npz", global_orient=vectors[:, 0], body_pose=vectors[:, 1:22].reshape(12, 63),
             transl=places, **rate)  # fmt: skip
    np.savez(folder / "batch.npz", pose_world=vectors.reshape(1, 12, 72), trans_world=places[None], fps=np.array(20))
    np.savez(folder / "matrices.npz", poses=clip.rotations[:, :24], trans=places, fps=np.array(30))
    np.savez_compressed(folder / "joints.npz", posed_joints=clip.positions()[:, :22])
    features = guo263.encode(clip).astype(np.float32)
    np.save(folder / "features.npy", features)
    np.save(folder / "sample.npy", clip.positions()[:, :22].astype(np.float64).transpose(1, 2, 0))
    np.save(folder / "flat.npy", clip.positions()[:, :22].reshape(12, 66))
    archives = [f"{name}.npz" for name in ("smpl72", "smplx", "batch", "matrices", "joints")]
    return dict.fromkeys([*archives, "features.npy", "sample.npy", "flat.npy"], "motion")


def _figures(folder: Path) -> dict[str, str]:
    """A skinned figure with a texture, and keys of several kinds."""
    from PIL import Image

    made = glb(character(), frames="random")
    picture = io.BytesIO()
    Image.new("RGB", (4, 4), (200, 100, 50)).save(picture, "PNG")
    content = picture.getvalue()
    made.binary += b"\0" * (-len(made.binary) % 4)
    made.document["bufferViews"].append(
        {"buffer": 0, "byteOffset": len(made.binary), "byteLength": len(content)}
    )  # fmt: skip
    made.binary += content
    made.document["images"] = [{"bufferView": len(made.document["bufferViews"]) - 1, "mimeType": "image/png"}]
    made.document["textures"] = [{"source": 0}]
    made.document["materials"] = [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.5, 1],
                                                            "baseColorTexture": {"index": 0}}}]  # fmt: skip
    primitive = made.document["meshes"][0]["primitives"][0]
    count = made.document["accessors"][primitive["attributes"]["POSITION"]]["count"]
    primitive["attributes"]["TEXCOORD_0"] = made.array(np.full((count, 2), 0.3, np.float32), "VEC2")
    made.save(folder / "dressed.glb")
    turned = np.tile(np.array([0, 0, 0, 1], np.float32), (9, 1))
    made.animate("cubic", [(0, "rotation", np.arange(3) / 10, turned)], "CUBICSPLINE")
    made.document["animations"][0]["extras"] = {"take": 1}
    made.save(folder / "moved.glb")
    made.document["animations"].clear()
    made.animate("steps", [(1, "rotation", np.arange(9) / 10, turned)], "STEP")
    made.save(folder / "stepped.glb")
    return {"dressed.glb": "dressed", "moved.glb": "motion", "stepped.glb": "motion"}


def _texts(folder: Path) -> dict[str, str]:
    texts = {
        "plan.yaml": ("plan", PLAN),
        "short.yaml": ("plan", SCALED),
        "captions.jsonl": ("sidecar", ROWS),
        "captions.csv": ("sidecar", TABLE),
        "rig.yaml": ("mapping", RIG_MAP),
        "votes.json": ("votes", json.dumps(STUDY)),
    }
    for name, (_, content) in texts.items():
        (folder / name).write_text(content, encoding="utf-8")
    return {name: door for name, (door, _) in texts.items()}


def _project(folder: Path) -> bytes:
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("clip0.npz", (folder / "clip.npz").read_bytes())
        archive.writestr("script.yaml", "steps:\n  - stand: 0.3\n")
        archive.writestr("plan.yaml", PLAN)
        rows = [{"file": "clip0.npz", "name": "walk", "note": "", "made": True}]
        archive.writestr("project.json", json.dumps({"version": 1, "layout": {}, "clips": rows}))
    return out.getvalue()
