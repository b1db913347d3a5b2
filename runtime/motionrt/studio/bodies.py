"""What moves on the stage: the figure in the colour of its clip, or a character of the user's own in its colours."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from motionrt.formats import Character, Dressed
from motionrt.motion.rotations import matrix_to_quaternion
from motionrt.motion.skeleton import FloatArray, Skeleton
from motionrt.studio.clips import Clip, Colour, between, continuous
from motionrt.studio.figure import figure_of

COLOURS = 5  # of a character: viser gives a skinned mesh one colour, so that it is cut into as many
CROWN = 0.2  # metres of the figure above its highest joint
FLESH, SOLE = 0.21, 0.06  # metres that it reaches beside and above its joints (fingers, toes, head), and below
VERTICES = 120_000  # of a character, at most


class Body(Protocol):
    """Somebody on the stage."""

    def pose(self, joints: FloatArray, turns: FloatArray, time: float) -> float:
        """Take the pose of a time: joints ``(22, 3)`` and turns ``(22, 4)`` wxyz of the clip then.

        Returns:
            metres above the ground that nothing of the head reaches.
        """

    def play(self, clip: Clip) -> None:
        """Play another clip from now on."""

    def suits(self, skeleton: Skeleton, character: Character | None) -> bool:
        """Whether it can play a clip of a skeleton as that character."""

    def box(self, clip: Clip) -> FloatArray:
        """``(2, 3)`` lowest and highest corner of all that its skin touches while it plays the clip, metres."""


class FigureBody:
    """motionrt's own figure.

    Args:
        scene: of viser.
        name: of the node.
        clip: whose skeleton and colour it has.
    """

    def __init__(self, scene: Any, name: str, clip: Clip) -> None:
        self._skeleton, figure = clip.motion.skeleton, figure_of(clip.motion.skeleton)
        self._node = _skinned(
            scene, name, figure.vertices, figure.faces, figure.weights, figure.bones, _upright(len(figure.bones)),
            clip.colour,
        )  # fmt: skip

    def pose(self, joints: FloatArray, turns: FloatArray, time: float) -> float:  # noqa: ARG002
        """As the clip."""
        for bone, place, turn in zip(self._node.bones, joints.tolist(), turns.tolist(), strict=True):
            bone.position, bone.wxyz = place, turn
        return float(joints[:, 1].max()) + CROWN

    def play(self, clip: Clip) -> None:
        """In another colour."""
        self._node.color = clip.colour

    def suits(self, skeleton: Skeleton, character: Character | None) -> bool:
        """Whether the figure is wanted, in these proportions."""
        return character is None and skeleton == self._skeleton

    def box(self, clip: Clip) -> FloatArray:
        """Of the joints, and the flesh around them."""
        return figure_box(clip)


@dataclass(frozen=True, eq=False)
class _Piece:
    """The triangles of one colour: their node, and the joints ``(B,)`` that move them."""

    node: Any
    joints: npt.NDArray[np.int64]


class CharacterBody:
    """A character of the user's own.

    Args:
        scene: of viser.
        name: of the nodes.
        clip: what it plays.
        character: who.

    Raises:
        RigError: the rig is no humanoid; says what to do.
    """

    def __init__(self, scene: Any, name: str, clip: Clip, character: Character) -> None:
        self._character = character
        self.play(clip)
        worn = self._worn
        self._crown = max(0.0, float(worn.rest_vertices[:, 1].max() - worn.rest_places[:, 1].max()))
        self._around = _corners(worn.rest_vertices) - _corners(worn.rest_places)
        self._pieces = self._cut(scene, name, worn)

    def pose(self, joints: FloatArray, turns: FloatArray, time: float) -> float:  # noqa: ARG002
        """As its rig is turned then."""
        places, quaternions = between(self._worn.places, self._quaternions, self._worn.fps, time)
        for piece in self._pieces:
            here, turned = places[piece.joints].tolist(), quaternions[piece.joints].tolist()
            for bone, place, turn in zip(piece.node.bones, here, turned, strict=True):
                bone.position, bone.wxyz = place, turn
        return float(places[:, 1].max()) + self._crown

    def play(self, clip: Clip) -> None:
        """Retarget another clip."""
        self._worn: Dressed = self._character.dressed(clip.motion)
        self._quaternions = continuous(matrix_to_quaternion(self._worn.turns))

    def suits(self, skeleton: Skeleton, character: Character | None) -> bool:  # noqa: ARG002
        """Whether this character is wanted: it plays clips of any skeleton."""
        return character is self._character

    def box(self, clip: Clip) -> FloatArray:  # noqa: ARG002
        """Of its own joints, and as much around them as in the pose that the mesh was bound in."""
        worn = self._worn
        return _corners(worn.places.reshape(-1, 3)) + self._around

    @staticmethod
    def _cut(scene: Any, name: str, worn: Dressed) -> list[_Piece]:
        skin, pieces = worn.skin.with_fewer_colours(COLOURS), []
        for number, colour in enumerate(np.unique(skin.colours, axis=0)):
            part = skin.part((skin.colours == colour).all(axis=1))
            weights = part.dense_weights(len(worn.places[0]))
            joints = np.flatnonzero(weights.any(axis=0))
            vertices = part.at(worn.rest_places, worn.rest_turns)
            rest = matrix_to_quaternion(worn.rest_turns[joints])
            red, green, blue = colour.tolist()
            node = _skinned(
                scene, f"{name}/{number}", vertices, part.faces.astype(np.uint32), weights[:, joints],
                worn.rest_places[joints], rest, (red, green, blue), side="double",
            )  # fmt: skip
            pieces.append(_Piece(node, joints))
        return pieces


def figure_box(clip: Clip) -> FloatArray:
    """``(2, 3)`` corners of what the figure touches in a clip: its joints, and the flesh around them."""
    around = np.array([[-FLESH, -SOLE, -FLESH], [FLESH, FLESH, FLESH]], np.float32)
    return np.asarray(clip.box + around, np.float32)


def _corners(points: FloatArray) -> FloatArray:
    return np.stack([points.min(axis=0), points.max(axis=0)])


def _upright(bones: int) -> FloatArray:
    return np.tile(np.array([1.0, 0, 0, 0], np.float32), (bones, 1))


def _skinned(
    scene: Any, name: str, vertices: Any, faces: Any, weights: Any, places: Any, turns: Any, colour: Colour,
    side: str = "front",
) -> Any:  # fmt: skip
    return scene.add_mesh_skinned(
        name,
        vertices,
        faces,
        bone_wxyzs=turns,
        bone_positions=places,
        skin_weights=weights,
        color=colour,
        side=side,
        cast_shadow=True,
        receive_shadow=False,
    )
