"""What is laid over what: a motion, the parts it moves on purpose or the joints it shall move, and how strongly."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from numbers import Real

from motionrt.errors import InvalidInputError
from motionrt.motion.body_parts import ARMS, GLOBAL, LEGS, PART_JOINTS, PARTS, TORSO, checked_parts
from motionrt.motion.motion import Motion
from motionrt.motion.skeleton import SMPL24
from motionrt.untrusted.arguments import iterable

Derive = Callable[[Motion], Iterable[str]]
"""Finds the body parts that a motion moves on purpose, where the caller gives none."""

MaskJoints = tuple[int, ...]


@dataclass(frozen=True, eq=False)
class Layer:
    """One motion of a composition.

    Attributes:
        motion: of the ``smpl24`` skeleton; a single frame is a pose that is held.
        parts: the body parts that its action needs, as a labeller gives them: the rules of SINC 3.1 decide which
            joints it moves, and a leg or "global" takes both legs, the global orientation and the translation along.
        mask: exactly the joints that it moves, and no more: names of parts and of joints in any mixture.
        weight: how much its joints cover what lies below, from 0 to 1.

    Raises:
        InvalidInputError: no Motion, both ``parts`` and ``mask``, an empty mask, an unknown name, or such a weight.
    """

    motion: Motion
    parts: str | Iterable[str] | None = None
    mask: str | Iterable[str] | None = None
    weight: float = 1.0

    def __post_init__(self) -> None:
        if self.parts is not None and self.mask is not None:
            raise InvalidInputError(
                "give a layer parts (what its action needs) or a mask (the joints it moves), not both"
            )
        if not isinstance(self.motion, Motion):
            raise InvalidInputError(f"a layer needs a Motion, not {self.motion!r}; motionrt.load_motion reads files")
        if not isinstance(self.weight, Real) or not 0 <= self.weight <= 1:
            raise InvalidInputError(f"a layer's weight must be from 0 to 1, not {self.weight!r}")
        if self.parts is not None:
            object.__setattr__(self, "parts", checked_parts(self.parts))
        if self.mask is not None:
            if not iterable(self.mask):
                raise InvalidInputError(f"a mask is a list of names of parts or joints, not {self.mask!r}")
            names = (self.mask,) if isinstance(self.mask, str) else tuple(self.mask)
            mask_joints(names)
            object.__setattr__(self, "mask", names)


def mask_joints(names: Iterable[str]) -> MaskJoints:
    """Sorted joints of ``smpl24`` that a mask of part and joint names covers.

    "right arm" is a part, "right_wrist" a joint, "pelvis" the same as "global". The translation goes with the pelvis.

    Raises:
        InvalidInputError: no name at all, or one that is neither a part nor a joint; the message lists both.
    """
    joints = sorted({joint for name in names for joint in _joints_of(name)})
    if not joints:
        raise InvalidInputError("a mask needs at least one part or joint")
    return tuple(joints)


def _joints_of(name: str) -> tuple[int, ...]:
    plain = str(name).strip().lower().replace("_", " ")
    joint = plain.replace(" ", "_")
    if plain in PARTS:
        return PART_JOINTS[plain]
    if joint in SMPL24.names:
        return (SMPL24.index(joint),)
    raise InvalidInputError(
        f"no body part or joint '{name}'; parts are: {', '.join(PARTS)}; joints are: {', '.join(SMPL24.names)}"
    )


def checked_layers(layers: Sequence[Layer | Motion]) -> list[Layer]:
    """``layers`` as :class:`Layer` objects, at least two of them, of ``smpl24``, all at the first one's frame rate.

    Raises:
        InvalidInputError: fewer than two, something that is no motion, or another skeleton.
    """
    if not isinstance(layers, Sequence) or len(layers) < 2:
        found = len(layers) if isinstance(layers, Sequence) else layers
        raise InvalidInputError(f"a composition needs a list of two motions or more, not {found!r}")
    for number, layer in enumerate(layers):
        _check_motion(layer.motion if isinstance(layer, Layer) else layer, number)
    checked = [layer if isinstance(layer, Layer) else Layer(layer) for layer in layers]
    fps = checked[0].motion.fps
    return [Layer(layer.motion.resample(fps), layer.parts, layer.mask, layer.weight) for layer in checked]


def _check_motion(motion: object, number: int) -> None:
    if not isinstance(motion, Motion):
        raise InvalidInputError(f"layer {number} is a {type(motion).__name__}, not a Motion")
    if motion.skeleton != SMPL24:
        raise InvalidInputError(
            f"layer {number} has a skeleton of its own; bring it to smpl24 with motionrt.rigs.retarget_in.to_smpl24, "
            "as motionrt.formats.load_motion does for files"
        )


def given_parts(layers: Sequence[Layer], derive: Derive | None) -> list[frozenset[str] | None]:
    """The body parts of each layer's action, ``None`` for layers with a mask.

    A first layer without parts has all six: it moves whatever the others leave. Of parts that are derived for another
    layer, legs and "global" are left away, so that the first keeps its legs and its way; who moves nothing else gives
    arms and torso.

    Raises:
        InvalidInputError: a layer with neither parts nor a mask, and nothing to derive them with.
    """
    found: list[frozenset[str] | None] = []
    for number, layer in enumerate(layers):
        if not _silent(layer):
            found.append(None if layer.parts is None else checked_parts(layer.parts))
        elif number == 0:
            found.append(frozenset(PARTS))
        else:
            derived = _derived(layer.motion, number, derive)
            found.append(derived - {*LEGS, GLOBAL} or frozenset({*ARMS, TORSO}))
    return found


def first_fills(layers: Sequence[Layer]) -> bool:
    """Whether the first layer leaves open what it moves: then it moves what the others leave."""
    return _silent(layers[0])


def _silent(layer: Layer) -> bool:
    return layer.parts is None and layer.mask is None


def _derived(motion: Motion, number: int, derive: Derive | None) -> frozenset[str]:
    if derive is None:
        raise InvalidInputError(f"layer {number} has neither parts nor a mask; say what it moves, as in 'right arm'")
    return checked_parts(derive(motion))
