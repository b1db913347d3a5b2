"""Small rigs as the usual tools and databases have them: their joint names, rest poses, units, axes and helper joints.

All play the motion of :func:`retarget_rigs.person`, so that it is known what a reader should find.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
from retarget_rigs import Z_UP, Array, person, rig
from rig_files import write_bvh_rig, write_glb_rig
from scipy.spatial.transform import Rotation

from motionrt.rigs import RigClip

_PARTS = ("hip", "knee", "ankle", "foot", "collar", "shoulder", "elbow", "wrist", "hand")
_MIDDLE = ("pelvis", "spine1", "spine2", "spine3", "neck", "head")
PERSON = person(40)


@dataclass(frozen=True)
class Kind:
    """One kind of rig.

    Attributes:
        middle: names from pelvis to head; ``-`` for none.
        sided: names from hip to hand, ``{}`` where the side stands; ``-`` for none.
        sides: what stands there for left and right.
        rest: see :func:`retarget_rigs.rig`.
        scale: units per metre.
        z_up: whether the file's vertical is Z.
        twisted: whether the joints have axes of their own at rest, as in most GLB and FBX files.
        between: joints inside a bone, ``upper role/lower role`` -> name, ``{}`` for the side.
        held: leaves, name -> role that they hang on (``top`` is the joint above all).
        beside: toes beside the toe joint, ``{}`` for the side -> metres outwards.
        above: joints above the pelvis, highest first.
        sizes: lengths of bones in those of ``smpl24``, by the role at their end.
        suffix: of the file.
    """

    middle: str
    sided: str
    sides: str = "Left Right"
    rest: str = "t"
    scale: float = 1.0
    z_up: bool = False
    twisted: bool = False
    between: Mapping[str, str] = field(default_factory=dict)
    held: Mapping[str, str] = field(default_factory=dict)
    beside: Mapping[str, float] = field(default_factory=dict)
    above: tuple[str, ...] = ()
    sizes: Mapping[str, float] = field(default_factory=dict)
    suffix: str = ".bvh"

    def names(self) -> dict[str, str]:
        """``smpl24`` role -> joint name."""
        out = dict(zip(_MIDDLE, self.middle.split(), strict=True))
        for part, form in zip(_PARTS, self.sided.split(), strict=True):
            for side, word in zip(("left", "right"), self.sides.split(), strict=True):
                out[f"{side}_{part}"] = form.format(word)
        return {role: name for role, name in out.items() if name != "-"}

    def clip(self) -> RigClip:
        """The rig and its motion."""
        names = self.names()
        clip = rig(PERSON, names, scale=self.scale, rest=self.rest, world=Z_UP if self.z_up else None)
        clip = _sized(clip, names, self.sizes)
        for ends, form in self.between.items():
            upper, lower = ends.split("/")
            for one, two, name in _both(self, upper, lower, form):
                clip = _inserted(clip, names[one], names[two], name)
        for name in reversed(self.above):
            clip = _under(clip, name)
        for form, role in self.held.items():
            for _, two, name in _both(self, role, role, form):
                parent = clip.names[clip.parents.index(-1)] if role == "top" else names[two]
                clip = _held(clip, parent, name, self.scale)
        for form, outwards in self.beside.items():
            for (_, two, name), sign in zip(_both(self, "foot", "foot", form), (1, -1), strict=True):
                toe = clip.names.index(names[two])
                way = clip.offsets[toe] + [sign * outwards * self.scale, 0, 0]
                clip = _grown(clip, name, clip.parents[toe], way)
        return _with_axes(clip) if self.twisted else clip

    def write(self, folder: Path) -> Path:
        """The file."""
        path = folder / f"rig{self.suffix}"
        return write_bvh_rig(self.clip(), path) if self.suffix == ".bvh" else write_glb_rig(self.clip(), path)


def _both(kind: Kind, upper: str, lower: str, form: str) -> list[tuple[str, str, str]]:
    if "{}" not in form:
        return [(upper, lower, form)]
    words = dict(zip(("left", "right"), kind.sides.split(), strict=True))
    ends = [(upper if upper in {"top", *_MIDDLE} else f"{side}_{upper}", side, word) for side, word in words.items()]
    return [
        (one, lower if lower in {"top", *_MIDDLE} else f"{side}_{lower}", form.format(word)) for one, side, word in ends
    ]


def _sized(clip: RigClip, names: Mapping[str, str], sizes: Mapping[str, float]) -> RigClip:
    offsets, translations = clip.offsets.copy(), clip.translations.copy()
    for role, name in names.items():
        share = sizes.get(role.removeprefix("left_").removeprefix("right_"), 1.0)
        joint = clip.names.index(name)
        offsets[joint] *= share
        translations[:, joint] *= share if role != "pelvis" else 1.0
    return replace(clip, offsets=offsets, translations=translations)


def _grown(clip: RigClip, name: str, parent: int, offset: Array) -> RigClip:
    frames = clip.frames
    return replace(
        clip,
        names=(*clip.names, name),
        parents=(*clip.parents, parent),
        offsets=np.concatenate([clip.offsets, offset[None]]).astype(np.float32),
        rotations=np.concatenate([clip.rotations, np.tile(np.eye(3), (frames, 1, 1, 1))], axis=1).astype(np.float32),
        translations=np.concatenate([clip.translations, np.tile(offset, (frames, 1, 1))], axis=1).astype(np.float32),
    )


def _inserted(clip: RigClip, upper: str, lower: str, name: str) -> RigClip:
    """A joint in the middle of a bone."""
    above, below = clip.names.index(upper), clip.names.index(lower)
    half = clip.offsets[below] / 2
    out = _grown(clip, name, above, half)
    parents = list(out.parents)
    parents[below] = len(out.names) - 1
    offsets, translations = out.offsets.copy(), out.translations.copy()
    offsets[below], translations[:, below] = half, half
    return _sorted(replace(out, parents=tuple(parents), offsets=offsets, translations=translations))


def _under(clip: RigClip, name: str) -> RigClip:
    """A joint at the origin above all others."""
    out = _grown(clip, name, -1, np.zeros(3))
    parents = [len(out.names) - 1 if parent < 0 else parent for parent in clip.parents]
    return _sorted(replace(out, parents=(*parents, -1)))


def _held(clip: RigClip, parent: str, name: str, scale: float) -> RigClip:
    seed = sum(map(ord, name))
    return _grown(clip, name, clip.names.index(parent), 0.1 * scale * np.random.default_rng(seed).normal(size=3))


def _sorted(clip: RigClip) -> RigClip:
    """Parents before children."""
    order = [clip.parents.index(-1)]
    for joint in order:
        order += [other for other, parent in enumerate(clip.parents) if parent == joint]
    place = {old: new for new, old in enumerate(order)}
    return replace(
        clip,
        names=tuple(clip.names[old] for old in order),
        parents=tuple(place.get(clip.parents[old], -1) for old in order),
        offsets=clip.offsets[order],
        rotations=clip.rotations[:, order],
        translations=clip.translations[:, order],
    )


def _with_axes(clip: RigClip) -> RigClip:
    """The same rig, every joint with other axes at rest."""
    clip = _sorted(clip)
    axes = Rotation.random(len(clip.names), random_state=5).as_matrix()
    above = np.stack([axes[parent] if parent >= 0 else np.eye(3) for parent in clip.parents])
    back = np.swapaxes(above, -1, -2)
    return replace(
        clip,
        offsets=np.einsum("jab,jb->ja", back, clip.offsets).astype(np.float32),
        rotations=(back @ clip.rotations @ axes).astype(np.float32),
        translations=np.einsum("jab,fjb->fja", back, clip.translations).astype(np.float32),
        rest=(back @ axes).astype(np.float32),
    )


KINDS = {
    "Mixamo": Kind(
        "mixamorig:Hips mixamorig:Spine mixamorig:Spine1 mixamorig:Spine2 mixamorig:Neck mixamorig:Head",
        "mixamorig:{}UpLeg mixamorig:{}Leg mixamorig:{}Foot mixamorig:{}ToeBase mixamorig:{}Shoulder mixamorig:{}Arm"
        " mixamorig:{}ForeArm mixamorig:{}Hand mixamorig:{}HandMiddle1", twisted=True, suffix=".glb",
        held={"mixamorig:HeadTop_End": "head", "mixamorig:{}HandThumb1": "wrist"},
    ),
    "Unreal 4 Mannequin": Kind(
        "pelvis spine_01 spine_02 spine_03 neck_01 head",
        "thigh_{} calf_{} foot_{} ball_{} clavicle_{} upperarm_{} lowerarm_{} hand_{} middle_01_{}", "l r",
        rest="a", twisted=True, suffix=".glb", above=("root",),
        held={"upperarm_twist_01_{}": "shoulder", "lowerarm_twist_01_{}": "elbow", "thigh_twist_01_{}": "hip",
              "ik_foot_{}": "top", "ik_hand_{}": "top"},
    ),
    "Unreal 5 Mannequin": Kind(
        "pelvis spine_01 spine_03 spine_05 neck_01 head",
        "thigh_{} calf_{} foot_{} ball_{} clavicle_{} upperarm_{} lowerarm_{} hand_{} middle_metacarpal_{}", "l r",
        rest="a", twisted=True, suffix=".glb", above=("root",),
        between={"spine1/spine2": "spine_02", "spine2/spine3": "spine_04", "neck/head": "neck_02"},
        held={"upperarm_twist_01_{}": "shoulder", "upperarm_twist_02_{}": "shoulder", "calf_twist_01_{}": "knee",
              "ik_foot_{}": "top", "interaction": "top"},
    ),
    "Unity, VRM": Kind(
        "J_Bip_C_Hips J_Bip_C_Spine J_Bip_C_Chest J_Bip_C_UpperChest J_Bip_C_Neck J_Bip_C_Head",
        "J_Bip_{}_UpperLeg J_Bip_{}_LowerLeg J_Bip_{}_Foot J_Bip_{}_ToeBase J_Bip_{}_Shoulder J_Bip_{}_UpperArm"
        " J_Bip_{}_LowerArm J_Bip_{}_Hand J_Bip_{}_Middle1", "L R", suffix=".glb", above=("Root",),
        held={"J_Sec_Hair1_01": "head", "J_Adj_{}_FaceEye": "head"},
    ),
    "Rokoko": Kind(
        "Hips Spine1 Spine2 Spine3 Neck Head",
        "{}Thigh {}Shin {}Foot {}Toe {}Shoulder {}Arm {}ForeArm {}Hand -", scale=100, between={"spine3/neck": "Spine4"},
    ),
    "Xsens": Kind(
        "Pelvis L5 L3 T8 Neck Head",
        "{}UpperLeg {}LowerLeg {}Foot {}Toe {}Shoulder {}UpperArm {}ForeArm {}Hand -", scale=100,
        between={"spine2/spine3": "T12"},
    ),
    "Perception Neuron": Kind(
        "Hips Spine Spine1 Spine2 Neck Head",
        "{}UpLeg {}Leg {}Foot - {}Shoulder {}Arm {}ForeArm {}Hand {}InHandMiddle", scale=100,
        between={"neck/head": "Neck1"}, held={"{}HandThumb1": "wrist", "{}InHandIndex": "wrist"},
    ),
    "Daz": Kind(
        "hip abdomenLower abdomenUpper chestUpper neckLower head",
        "{}ThighBend {}Shin {}Foot {}Toe {}Collar {}ShldrBend {}ForearmBend {}Hand {}Mid1", "l r",
        rest="a", scale=100, suffix=".glb",
        between={"hip/knee": "{}ThighTwist", "ankle/foot": "{}Metatarsals", "shoulder/elbow": "{}ShldrTwist",
                 "elbow/wrist": "{}ForearmTwist", "spine2/spine3": "chestLower", "neck/head": "neckUpper"},
    ),
    "MakeHuman": Kind(
        "root spine05 spine03 spine01 neck01 head",
        "upperleg01.{} lowerleg01.{} foot.{} toe3-1.{} clavicle.{} upperarm01.{} lowerarm01.{} wrist.{} finger3-1.{}",
        "L R", rest="a", scale=10,
        between={"hip/knee": "upperleg02.{}", "knee/ankle": "lowerleg02.{}", "collar/shoulder": "shoulder01.{}",
                 "shoulder/elbow": "upperarm02.{}", "elbow/wrist": "lowerarm02.{}", "neck/head": "neck02"},
        beside={"toe1-1.{}": -0.04, "toe2-1.{}": -0.02, "toe4-1.{}": 0.02, "toe5-1.{}": 0.04},
    ),
    "Rigify": Kind(
        "DEF-spine DEF-spine.001 DEF-spine.002 DEF-spine.003 DEF-spine.004 DEF-spine.006",
        "DEF-thigh.{} DEF-shin.{} DEF-foot.{} DEF-toe.{} DEF-shoulder.{} DEF-upper_arm.{} DEF-forearm.{} DEF-hand.{}"
        " DEF-f_middle.01.{}", "L R", twisted=True, suffix=".glb", above=("root",),
        between={"hip/knee": "DEF-thigh.{}.001", "knee/ankle": "DEF-shin.{}.001", "elbow/wrist": "DEF-forearm.{}.001",
                 "shoulder/elbow": "DEF-upper_arm.{}.001", "neck/head": "DEF-spine.005"},
        held={"DEF-pelvis.{}": "pelvis", "DEF-breast.{}": "spine3"},
    ),
    "Auto-Rig Pro": Kind(
        "root.x spine_01.x spine_02.x spine_03.x neck.x head.x",
        "thigh_stretch.{} leg_stretch.{} foot.{} toes_01.{} shoulder.{} arm_stretch.{} forearm_stretch.{} hand.{}"
        " middle1.{}", "l r", rest="a", twisted=True, suffix=".glb",
        held={"thigh_twist.{}": "hip", "leg_twist.{}": "knee", "arm_twist.{}": "shoulder", "forearm_twist.{}": "elbow"},
    ),
    "MMD": Kind(
        "腰 上半身 上半身2 上半身3 首 頭", "{}足 {}ひざ {}足首 {}つま先 {}肩 {}腕 {}ひじ {}手首 {}中指１", "左 右",
        rest="a", scale=12.5, suffix=".glb", above=("全ての親", "センター", "グルーブ"),
        between={"shoulder/elbow": "{}腕捩", "elbow/wrist": "{}手捩"}, held={"{}足ＩＫ": "top"},
    ),
    "CMU": Kind(
        "Hips LowerBack Spine Spine1 Neck Head",
        "{}UpLeg {}Leg {}Foot {}ToeBase {}Shoulder {}Arm {}ForeArm {}Hand {}FingerBase", rest="spread",
        scale=1 / (0.0254 / 0.45), between={"pelvis/hip": "{}HipJoint"}, held={"{}Thumb": "wrist"},
    ),
    "LaFAN1": Kind(
        "Hips Spine Spine1 Spine2 Neck Head", "{}UpLeg {}Leg {}Foot {}Toe {}Shoulder {}Arm {}ForeArm {}Hand -",
        rest="bones_up", scale=100,
    ),
    "100STYLE": Kind(
        "Hips Chest Chest2 Chest4 Neck Head", "{}Hip {}Knee {}Ankle {}Toe {}Collar {}Shoulder {}Elbow {}Wrist -",
        scale=100, z_up=True, between={"spine2/spine3": "Chest3"},
    ),
    "Bandai Namco": Kind(
        "Hips Spine Chest UpperChest Neck Head",
        "UpperLeg_{} LowerLeg_{} Foot_{} Toes_{} Shoulder_{} UpperArm_{} LowerArm_{} Hand_{} -", "L R", scale=100,
        above=("joint_Root",),
    ),
    "KayKit": Kind(
        "hips spine - chest - head",
        "upperleg.{} lowerleg.{} foot.{} toes.{} - upperarm.{} lowerarm.{} wrist.{} hand.{}", "l r",
        twisted=True, suffix=".glb", above=("root",),
        held={"handslot.{}": "hand", "kneeIK.{}": "top", "IK-foot.{}": "top", "control-toe-roll.{}": "top",
              "elbowIK.{}": "top", "handIK.{}": "top"},
        sizes={"pelvis": 0.4, "knee": 0.55, "ankle": 0.7, "hip": 1.9, "shoulder": 1.2, "elbow": 0.85, "wrist": 1.0},
    ),
}  # fmt: skip
