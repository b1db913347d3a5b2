"""Small sound files of every kind, made here: what is mutated."""

from __future__ import annotations

import json
import struct
from pathlib import Path

import numpy as np
from fake_embedder import FakeEmbedder
from fbx_files import write_fbx
from motions import walking
from retarget_rigs import rig
from spellings import write_spellings

from motionrt.motion import SMPL24
from motionrt.retrieval import Gallery

BOX = """o box
v -3 0 -3
v -3 0 3
v 3 0 3
v 3 0 -3
f 1 2 3
f 1 3 4
"""
SCRIPT = """scene:
  floor: [[[-5, -5], [5, -5], [5, 5], [-5, 5]]]
  obstacles: [[[1, 1], [2, 1], [2, 2], [1, 2]]]
  cell: 0.2
start: {at: [0, 0], heading: 0}
speed: 1.2
steps:
  - walk: {to: [0, 1.5], heading: 90}
  - act: {name: grab, keypoints: {right_hand: [0.3, 1.2, 2.0]}, hold: 0.5}
  - walk: {path: [[0, 1.5], [0, 0.5]]}
  - stand: 0.3
"""
MAP = (
    "image: map.pgm\nresolution: 0.1\norigin: [-1.0, -2.0, 0.3]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
)
CLOUD = "x,y,z,label\n" + "".join(f"{i / 10},{i % 3 / 2},{i % 7},{'floor' if i % 2 else 'sofa'}\n" for i in range(30))
PLY = (
    "ply\nformat ascii 1.0\nelement vertex 3\n"
    + "".join(f"property float {axis}\n" for axis in "xyz")
    + "property int label\n"
)
MESH_PLY = (
    "ply\nformat ascii 1.0\nelement vertex 3\n"
    + "".join(f"property float {axis}\n" for axis in "xyz")
    + "element face 1\nproperty list uchar int vertex_indices\nend_header\n-3 0 -3\n-3 0 3\n3 0 3\n3 0 1 2\n"
)
ASF = """:version 1.10
:name small
:units
  length 0.45
  angle deg
:root
  order TX TY TZ RX RY RZ
  axis XYZ
  position 0 0 0
  orientation 0 0 0
:bonedata
  begin
    id 1
    name lfemur
    direction 0 -1 0
    length 8
    axis 0 0 20 XYZ
    dof rx ry rz
    limits (-160.0 20.0)
           (-70.0 70.0)
           (-60.0 70.0)
  end
  begin
    id 2
    name ltibia
    direction 0 -1 0
    length 7
    axis 0 90 0 XYZ
    dof rx
    limits (-10.0 170.0)
  end
:hierarchy
  begin
    root lfemur
    lfemur ltibia
  end
"""
AMC = ":FULLY-SPECIFIED\n:DEGREES\n" + "".join(
    f"{n}\nroot {n / 3} 15 2 0 {9 * n} 0\nlfemur -{n} 3 0\nltibia {n}\n" for n in range(1, 7)
)
BESIDE = {"map.yaml": "map.pgm", "pair.amc": "pair.asf", "pair.asf": "pair.amc"}
"""Files that name others, which are left as they are."""


def write_seeds(folder: Path) -> dict[str, tuple[str, Path]]:
    """``{name: (door, file)}`` of sound files below a folder."""
    folder.mkdir(parents=True, exist_ok=True)
    clip = walking(12)
    written = (".bvh", ".glb", ".gltf", ".vrma", ".npz")
    seeds = {f"motion{suffix}": ("motion", clip.save(folder / f"clip{suffix}")) for suffix in written}
    write_fbx(rig(clip, {name: name for name in SMPL24.names}), folder / "clip.fbx", centimetres_per_unit=100, up="y")
    np.save(folder / "clip.npy", clip.positions()[:, :22].astype(np.float32))
    seeds |= {f"motion{suffix}": ("motion", folder / f"clip{suffix}") for suffix in (".fbx", ".npy")}
    seeds |= {f"rig{suffix}": ("rig", folder / f"clip{suffix}") for suffix in (".bvh", ".glb", ".gltf", ".fbx")}
    texts = {
        "scene.obj": ("scene", BOX),
        "pair.asf": ("acclaim", ASF),
        "pair.amc": ("acclaim", AMC),
        "scene.ply": ("scene", MESH_PLY),
        "scene.off": ("scene", "OFF\n4 2 0\n-3 0 -3\n-3 0 3\n3 0 3\n3 0 -3\n3 0 1 2\n3 0 2 3\n"),
        "map.yaml": ("scene", MAP),
        "plain.pgm": ("scene", "P2\n# made\n4 3\n255\n" + "254 0 205 254\n" * 3),
        "script.yaml": ("script", SCRIPT),
        "cloud.csv": ("cloud", CLOUD),
        "cloud.ply": ("cloud", PLY + "comment label 1 sofa\nend_header\n0 0 0 1\n1 0 1 1\n0 1 0 1\n"),
        "route.csv": ("path_csv", "x,z\n0,0\n1,2\n3,2\n"),
        "mapping.json": ("mapping", json.dumps({"left_hip": "L_Thigh", "head": "Head"})),
        "captions.txt": ("captions", "a person walks\n# no\na person sits\n"),
        "sentence.txt": ("text", "grab the cup from the table at 1.2 m with the left hand"),
    }
    for name, (door, content) in texts.items():
        (folder / name).write_text(content, encoding="utf-8")
        seeds[name] = (door, folder / name)
    (folder / "scene.stl").write_bytes(_stl())
    seeds["scene.stl"] = ("scene", folder / "scene.stl")
    (folder / "map.pgm").write_bytes(b"P5\n20 20\n255\n" + bytes([254]) * 400)
    seeds["map.pgm"] = ("scene", folder / "map.pgm")
    np.savez(
        folder / "cloud.npz", points=np.zeros((4, 3), np.float32), labels=np.arange(4) % 2, names=["floor", "sofa"]
    )
    seeds["cloud.npz"] = ("cloud", folder / "cloud.npz")
    made = Gallery.from_motions([walking(12), walking(20, speed=2.0)], ["a", "b"], FakeEmbedder(), texts=["x", "y"])
    seeds["gallery"] = ("gallery", made.save(folder / "gallery").folder or folder)
    return seeds | write_spellings(folder)


def _stl() -> bytes:
    """Two triangles as a binary STL."""
    corners = ((-3, 0, -3, -3, 0, 3, 3, 0, 3), (-3, 0, -3, 3, 0, 3, 3, 0, -3))
    return bytes(80) + struct.pack("<I", 2) + b"".join(struct.pack("<12fH", 0, 1, 0, *each, 0) for each in corners)
