"""Make ``robot.glb``, a character to try things on until yours is at hand: boxes on a skeleton with Mixamo's names.

    python examples/make_robot.py -o examples/robot.glb

It is 1.2 m tall, with short legs, large feet and a square head, which shows what retargeting does with other builds.
"""

from __future__ import annotations

import argparse
import json
import struct
from pathlib import Path
from typing import Any

import numpy as np

PREFIX = "mixamorig:"
WHITE, GREY, DARK, ORANGE, TEAL = range(5)
COLOURS = ((0.87, 0.88, 0.9), (0.5, 0.53, 0.58), (0.05, 0.06, 0.08), (0.95, 0.33, 0.05), (0.05, 0.62, 0.66))  # linear
EDGE = 0.16  # how much of a box its bevel takes

# joint, parent, place in metres (of the left side), Y up, facing +Z
JOINTS = [
    ("Hips", "", (0, 0.50, 0)), ("Spine", "Hips", (0, 0.57, 0)), ("Spine1", "Spine", (0, 0.64, 0)),
    ("Spine2", "Spine1", (0, 0.71, 0)), ("Neck", "Spine2", (0, 0.83, 0)), ("Head", "Neck", (0, 0.88, 0)),
]  # fmt: skip
SIDE = [
    ("Shoulder", "Spine2", (0.05, 0.79, 0)), ("Arm", "Shoulder", (0.15, 0.79, 0)), ("ForeArm", "Arm", (0.34, 0.79, 0)),
    ("Hand", "ForeArm", (0.52, 0.79, 0)), ("UpLeg", "Hips", (0.085, 0.46, 0)), ("Leg", "UpLeg", (0.085, 0.27, 0)),
    ("Foot", "Leg", (0.085, 0.09, -0.01)), ("ToeBase", "Foot", (0.085, 0.03, 0.10)),
]  # fmt: skip

# joint that moves it, middle, half sizes, colour
BOXES = [
    ("Hips", (0, 0.50, 0), (0.12, 0.055, 0.085), GREY), ("Spine1", (0, 0.60, 0), (0.075, 0.055, 0.06), DARK),
    ("Spine2", (0, 0.735, 0), (0.145, 0.09, 0.105), WHITE), ("Spine2", (0, 0.75, 0.105), (0.05, 0.035, 0.012), TEAL),
    ("Neck", (0, 0.845, 0), (0.04, 0.03, 0.04), DARK), ("Head", (0, 0.985, 0.01), (0.1, 0.1, 0.1), WHITE),
    ("Head", (0, 0.99, 0.109), (0.08, 0.062, 0.012), DARK),
    ("Head", (0.036, 0.994, 0.122), (0.016, 0.026, 0.005), TEAL),
    ("Head", (-0.036, 0.994, 0.122), (0.016, 0.026, 0.005), TEAL), ("Head", (0, 1.115, 0), (0.01, 0.035, 0.01), GREY),
    ("Head", (0, 1.16, 0), (0.025, 0.025, 0.025), ORANGE),
]  # fmt: skip
SIDE_BOXES = [
    ("Head", (0.108, 0.985, 0), (0.014, 0.042, 0.042), ORANGE), ("Arm", (0.155, 0.79, 0), (0.05, 0.06, 0.06), ORANGE),
    ("Arm", (0.25, 0.79, 0), (0.07, 0.035, 0.035), GREY), ("ForeArm", (0.43, 0.79, 0), (0.095, 0.052, 0.052), WHITE),
    ("Hand", (0.575, 0.79, 0.0), (0.055, 0.026, 0.045), DARK),
    ("Hand", (0.555, 0.79, 0.058), (0.028, 0.02, 0.018), DARK),
    ("UpLeg", (0.085, 0.37, 0), (0.05, 0.085, 0.055), GREY), ("Leg", (0.085, 0.185, 0), (0.06, 0.1, 0.065), WHITE),
    ("Leg", (0.085, 0.27, 0.012), (0.045, 0.035, 0.06), ORANGE),
    ("Foot", (0.085, 0.05, 0.02), (0.062, 0.05, 0.09), ORANGE),
    ("ToeBase", (0.085, 0.035, 0.14), (0.062, 0.035, 0.05), ORANGE),
]  # fmt: skip


def label(joint: str, side: str) -> str:
    """The name of a joint on a side; the middle of the body has none."""
    return joint if joint in {"Hips", "Spine2", "Head"} else side + joint


def limbs() -> list[Any]:
    """Joints of both sides."""
    return [
        (label(joint, side), label(parent, side), (sign * x, y, z))
        for side, sign in (("Left", 1), ("Right", -1))
        for joint, parent, (x, y, z) in SIDE
    ]


def shells() -> list[Any]:
    """Boxes of both sides."""
    return [
        (label(joint, side), (sign * x, y, z), half, colour)
        for side, sign in (("Left", 1), ("Right", -1))
        for joint, (x, y, z), half, colour in SIDE_BOXES
    ]


def box(middle: Any, half: Any) -> tuple[Any, Any]:
    """A box with bevelled edges: flat triangles, three corners each ``(T, 3, 3)``, and their normals."""
    middle, half = np.array(middle, float), np.array(half, float)
    inset = half - EDGE * half.min()
    polygons = []
    signs = [np.array((x, y, z)) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]

    def corner(sign: Any, axis: int) -> Any:  # of the face towards an axis
        return sign * np.where(np.arange(3) == axis, half, inset)

    for axis in range(3):
        a, b = (axis + 1) % 3, (axis + 2) % 3
        for towards in (-1, 1):
            loop = []
            for u, v in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                sign = np.zeros(3)
                sign[axis], sign[a], sign[b] = towards, u, v
                loop.append(corner(sign, axis))
            polygons.append(loop)
        for u in (-1, 1):
            for v in (-1, 1):  # the edge between the faces of a and b
                loop = []
                for along, face in ((-1, a), (1, a), (1, b), (-1, b)):
                    sign = np.zeros(3)
                    sign[axis], sign[a], sign[b] = along, u, v
                    loop.append(corner(sign, face))
                polygons.append(loop)
    polygons += [[corner(sign, axis) for axis in range(3)] for sign in signs]
    triangles = []
    for loop in polygons:
        for k in range(1, len(loop) - 1):
            p, q, r = loop[0], loop[k], loop[k + 1]
            outwards = np.dot(np.cross(q - p, r - p), p + q + r) > 0
            triangles.append((p, q, r) if outwards else (p, r, q))
    corners = np.array(triangles)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return corners + middle, np.repeat(normals[:, None], 3, axis=1)


def robot() -> bytes:
    """The file."""
    joints = JOINTS + limbs()
    names = [name for name, _, _ in joints]
    places = np.array([place for _, _, place in joints], float)
    document: dict[str, Any] = {
        "asset": {"version": "2.0", "generator": "motionrt examples/make_robot.py"},
        "scene": 0, "scenes": [{"nodes": [0, len(names)]}], "nodes": [], "accessors": [], "bufferViews": [],
        "meshes": [{"name": "Robot", "primitives": []}],
        "materials": [
            {"name": name, "pbrMetallicRoughness": {"baseColorFactor": [*colour, 1], "metallicFactor": 0}}
            for name, colour in zip(("White", "Grey", "Dark", "Orange", "Teal"), COLOURS, strict=True)
        ],
    }  # fmt: skip
    for name, parent, place in joints:
        origin = places[names.index(parent)] if parent else np.zeros(3)
        node: dict[str, Any] = {"name": PREFIX + name, "translation": np.round(place - origin, 6).tolist()}
        children = [names.index(other) for other, above, _ in joints if above == name]
        document["nodes"].append({**node, **({"children": children} if children else {})})
    document["nodes"].append({"name": "Robot", "mesh": 0, "skin": 0})
    binary = bytearray()

    def array(values: Any, kind: str, component: int) -> int:
        binary.extend(b"\0" * (-len(binary) % 4))
        document["bufferViews"].append({"buffer": 0, "byteOffset": len(binary), "byteLength": values.nbytes})
        binary.extend(values.tobytes())
        entry = {
            "bufferView": len(document["bufferViews"]) - 1,
            "componentType": component,
            "count": len(values),
            "type": kind,
        }
        if kind == "VEC3":
            entry |= {"min": values.min(axis=0).tolist(), "max": values.max(axis=0).tolist()}
        document["accessors"].append(entry)
        return len(document["accessors"]) - 1

    boxes = BOXES + shells()
    for colour in range(len(COLOURS)):
        parts = [(names.index(joint), *box(middle, half)) for joint, middle, half, tint in boxes if tint == colour]
        corners = np.concatenate([part[1].reshape(-1, 3) for part in parts]).astype("<f4")
        normals = np.concatenate([part[2].reshape(-1, 3) for part in parts]).astype("<f4")
        who = np.zeros((len(corners), 4), "u1")
        who[:, 0] = np.concatenate([np.full(3 * len(part[1]), part[0]) for part in parts])
        much = np.tile(np.array([255, 0, 0, 0], "u1"), (len(corners), 1))
        attributes = {"POSITION": array(corners, "VEC3", 5126), "NORMAL": array(normals, "VEC3", 5126),
                      "JOINTS_0": array(who, "VEC4", 5121), "WEIGHTS_0": array(much, "VEC4", 5121)}  # fmt: skip
        document["accessors"][attributes["WEIGHTS_0"]]["normalized"] = True
        document["meshes"][0]["primitives"].append({"attributes": attributes, "material": colour})
    binds = np.tile(np.eye(4, dtype="<f4"), (len(names), 1, 1))
    binds[:, 3, :3] = -places  # stored column by column
    document["skins"] = [
        {"joints": list(range(len(names))), "skeleton": 0, "inverseBindMatrices": array(binds, "MAT4", 5126)}
    ]
    binary.extend(b"\0" * (-len(binary) % 4))
    document["buffers"] = [{"byteLength": len(binary)}]
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<II", len(text), 0x4E4F534A) + text + struct.pack("<II", len(binary), 0x004E4942) + binary
    return struct.pack("<III", 0x46546C67, 2, 12 + len(chunks)) + chunks


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--out", type=Path, default=Path("robot.glb"))
    args = parser.parse_args()
    args.out.write_bytes(robot())
    print(f"{args.out}: {args.out.stat().st_size / 1000:.0f} kB")


if __name__ == "__main__":
    main()
