"""Writes small ASCII FBX files of version 7.4: bones, one take, linear keys."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from motionrt.rigs import RigClip

_SECOND = 46_186_158_000
_LINEAR = 4


def write_fbx(clip: RigClip, path: Path, *, centimetres_per_unit: float, up: str, take: str = "Take 001") -> Path:
    """``clip`` (its own unit and axes) as an FBX that says which unit and vertical axis those are."""
    joints = range(len(clip.names))
    objects, links = [], []
    for j in joints:
        objects.append(_bone(j, clip))
        links.append(f'C: "OO",{1000 + j},{1000 + clip.parents[j] if clip.parents[j] >= 0 else 0}')
        links.append(f'C: "OO",{3000 + j},{1000 + j}')
        for kind, values in (("Rotation", _degrees(clip, j)), ("Translation", clip.translations[:, j].astype(float))):
            at = 100_000 + 100 * j + (50 if kind == "Rotation" else 0)
            objects.append(f'AnimationCurveNode: {at}, "AnimCurveNode::{kind[0]}", "" {{ Properties70: {{ }} }}')
            links += [f'C: "OO",{at},2', f'C: "OP",{at},{1000 + j},"Lcl {kind}"']
            for axis in range(3):
                objects.append(_curve(at + 1 + axis, values[:, axis], clip.fps))
                links.append(f'C: "OP",{at + 1 + axis},{at},"d|{"XYZ"[axis]}"')
    stop = round((clip.frames - 1) / clip.fps * _SECOND)
    path.write_text(
        f"""; FBX 7.4.0 project file
FBXHeaderExtension: {{
    FBXHeaderVersion: 1003
    FBXVersion: 7400
}}
GlobalSettings: {{
    Version: 1000
    Properties70: {{
        P: "UpAxis", "int", "Integer", "",{1 if up == "y" else 2}
        P: "UpAxisSign", "int", "Integer", "",1
        P: "FrontAxis", "int", "Integer", "",{2 if up == "y" else 1}
        P: "FrontAxisSign", "int", "Integer", "",{1 if up == "y" else -1}
        P: "CoordAxis", "int", "Integer", "",0
        P: "CoordAxisSign", "int", "Integer", "",1
        P: "UnitScaleFactor", "double", "Number", "",{centimetres_per_unit}
        P: "TimeMode", "enum", "", "",14
        P: "CustomFrameRate", "double", "Number", "",{clip.fps}
    }}
}}
Objects: {{
AnimationStack: 1, "AnimStack::{take}", "" {{
    Properties70: {{
        P: "LocalStop", "KTime", "Time", "",{stop}
    }}
}}
AnimationLayer: 2, "AnimLayer::Base", "" {{ }}
{chr(10).join(objects)}
}}
Connections: {{
C: "OO",2,1
{chr(10).join(links)}
}}
"""
    )
    return path


def _bone(j: int, clip: RigClip) -> str:
    offset = ",".join(f"{value:.9g}" for value in clip.offsets[j])
    return (
        f'NodeAttribute: {3000 + j}, "NodeAttribute::{clip.names[j]}", "LimbNode" {{ TypeFlags: "Skeleton" }}\n'
        f'Model: {1000 + j}, "Model::{clip.names[j]}", "LimbNode" {{ Version: 232\n'
        f'Properties70: {{ P: "Lcl Translation", "Lcl Translation", "", "A",{offset} }} }}'
    )


def _degrees(clip: RigClip, j: int) -> np.ndarray:
    """The usual order of FBX: about the fixed axes X, Y, Z."""
    angles = Rotation.from_matrix(clip.rotations[:, j].astype(float)).as_euler("xyz")
    return np.asarray(np.degrees(np.unwrap(angles, axis=0)))


def _curve(at: int, values: np.ndarray, fps: float) -> str:
    times = ",".join(str(round(k / fps * _SECOND)) for k in range(len(values)))
    numbers = ",".join(f"{value:.9g}" for value in values)
    count = len(values)
    return (
        f'AnimationCurve: {at}, "AnimCurve::", "" {{ Default: 0\nKeyVer: 4008\n'
        f"KeyTime: *{count} {{ a: {times} }}\nKeyValueFloat: *{count} {{ a: {numbers} }}\n"
        f"KeyAttrFlags: *1 {{ a: {_LINEAR} }}\nKeyAttrDataFloat: *4 {{ a: 0,0,0,0 }}\n"
        f"KeyAttrRefCount: *1 {{ a: {count} }} }}"
    )
