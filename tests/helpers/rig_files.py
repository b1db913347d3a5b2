"""Rigs as BVH and GLB files, written from scratch with SciPy: no code under test in it."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from glb_files import Glb
from scipy.spatial.transform import Rotation

from motionrt.rigs import RigClip

ROTATION_ORDERS = ("ZXY", "XYZ", "YXZ", "ZYX", "XZY", "YZX")


def write_bvh_rig(
    clip: RigClip,
    path: Path,
    *,
    orders: Sequence[str] = ("ZXY",),
    moved: Sequence[bool] = (),
    zero_offsets: bool = False,
) -> Path:
    """``clip`` as a BVH.

    Args:
        clip: a rig whose rest pose has no rotations.
        path: the file.
        orders: of the rotation channels, joint by joint, repeated as needed.
        moved: which joints have position channels, repeated as needed; the root always has.
        zero_offsets: all OFFSETs are 0, the bone lengths stand in the position channels.
    """
    lines, columns = ["HIERARCHY"], list[np.ndarray]()

    def block(joint: int, indent: str) -> None:
        root = clip.parents[joint] < 0
        places = root or zero_offsets or (bool(moved) and moved[joint % len(moved)])
        order = orders[joint % len(orders)]
        offset = np.zeros(3) if zero_offsets else clip.offsets[joint].astype(float)
        channels = ["Xposition", "Yposition", "Zposition"] if places else []
        channels += [f"{axis}rotation" for axis in order]
        lines.extend([f"{indent}{'ROOT' if root else 'JOINT'} {clip.names[joint]}", f"{indent}{{"])
        lines.append(f"{indent}  OFFSET " + " ".join(f"{value:.6f}" for value in offset))
        lines.append(f"{indent}  CHANNELS {len(channels)} {' '.join(channels)}")
        if places:
            columns.append(clip.translations[:, joint].astype(float))
        columns.append(Rotation.from_matrix(clip.rotations[:, joint].astype(float)).as_euler(order, degrees=True))
        children = [other for other, parent in enumerate(clip.parents) if parent == joint]
        for child in children:
            block(child, indent + "  ")
        if not children:
            end = "0 0 0" if zero_offsets else " ".join(f"{value / 2:.6f}" for value in offset)
            lines.extend([f"{indent}  End Site", f"{indent}  {{", f"{indent}    OFFSET {end}", f"{indent}  }}"])
        lines.append(f"{indent}}}")

    block(clip.parents.index(-1), "")
    rows = [" ".join(f"{value:.6f}" for value in row) for row in np.concatenate(columns, axis=1)]
    lines += ["MOTION", f"Frames: {clip.frames}", f"Frame Time: {1 / clip.fps:.8f}", *rows, ""]
    path.write_text("\n".join(lines), encoding="utf-8")
    return path


def write_glb_rig(clip: RigClip, path: Path, *, name: str = "Take", interpolation: str = "LINEAR") -> Path:
    """``clip`` as a GLB of plain nodes, no skin and no mesh.

    They stand as the clip's rest pose has them; a clip without one, as in the first frame.
    """
    rest = clip.rest_rotations() if clip.rest is not None else clip.rotations[0]
    stands = clip.offsets if clip.rest is not None else clip.translations[0]
    standing = Rotation.from_matrix(rest.astype(float)).as_quat()
    quaternions = Rotation.from_matrix(clip.rotations.reshape(-1, 3, 3).astype(float)).as_quat()
    quaternions = quaternions.reshape(*clip.rotations.shape[:2], 4)
    nodes = []
    for joint in range(len(clip.names)):
        node = {
            "name": clip.names[joint],
            "translation": stands[joint].astype(float).tolist(),
            "rotation": standing[joint].tolist(),
        }
        children = [other for other, parent in enumerate(clip.parents) if parent == joint]
        nodes.append(node | ({"children": children} if children else {}))
    scene = {"scene": 0, "scenes": [{"nodes": [clip.parents.index(-1)]}], "nodes": nodes}
    out = Glb({"asset": {"version": "2.0"}, **scene, "accessors": [], "bufferViews": []}, bytearray())
    times = np.arange(clip.frames) / clip.fps
    channels = [(joint, "rotation", times, quaternions[:, joint]) for joint in range(len(clip.names))]
    moving = [joint for joint in range(len(clip.names)) if np.ptp(clip.translations[:, joint], axis=0).max() > 0]
    channels += [(joint, "translation", times, clip.translations[:, joint]) for joint in moving]
    out.animate(name, channels, interpolation)
    return out.save(path)


def bvh_places(path: Path) -> tuple[list[str], np.ndarray]:
    """Names and positions ``(F, J, 3)`` of the joints of a BVH, played by SciPy one joint after the other."""
    head, _, body = path.read_text(encoding="utf-8").partition("MOTION")
    names, parents, offsets, channels, above, ends = (
        list[str](),
        list[int](),
        list[list[float]](),
        list[list[str]](),
        [-1],
        0,
    )
    for line in head.splitlines():
        words = line.split()
        if words[:1] in (["ROOT"], ["JOINT"]):
            names.append(" ".join(words[1:]))
            parents.append(above[-1])
            channels.append([])
        elif words[:1] == ["End"]:
            ends = 1
        elif words[:1] == ["OFFSET"] and not ends:
            offsets.append([float(word) for word in words[1:]])
        elif words[:1] == ["CHANNELS"]:
            channels[-1] = words[2:]
        elif words[:1] == ["{"] and not ends:
            above.append(len(names) - 1)
        elif words[:1] == ["}"]:
            ends = 0 if ends else above.pop() * 0
    values = np.array([line.split() for line in body.strip().splitlines()[2:]], dtype=float)
    places, turns, column = np.zeros((len(values), len(names), 3)), list[Rotation](), 0
    for joint, parent in enumerate(parents):
        own = values[:, column : column + len(channels[joint])]
        column += len(channels[joint])
        kinds = [word[0] + word[1] for word in channels[joint]]
        moves = [i for i, kind in enumerate(kinds) if kind[1] == "p"]
        spins = [i for i, kind in enumerate(kinds) if kind[1] == "r"]
        way = own[:, moves] if moves else np.tile(offsets[joint], (len(values), 1))
        turn = Rotation.from_euler("".join(kinds[i][0] for i in spins), own[:, spins], degrees=True)
        places[:, joint] = way if parent < 0 else places[:, parent] + turns[parent].apply(way)
        turns.append(turn if parent < 0 else turns[parent] * turn)
    return names, places
