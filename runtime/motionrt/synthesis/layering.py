"""What people give to be composed (motions, files, texts) made into layers."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path

from motionrt.errors import InvalidInputError
from motionrt.formats.load import MOTION_SUFFIXES, WRITABLE_SUFFIXES, load_motion
from motionrt.models.text import checked_text
from motionrt.motion import Motion
from motionrt.synthesis.composing.alignment import frames_of
from motionrt.synthesis.composing.layers import Derive, Layer, given_parts
from motionrt.synthesis.sampling import LONGEST_S, SECONDS, SHORTEST_S
from motionrt.untrusted.words import shown

LayerLike = Layer | Motion | str | Path
Names = str | Iterable[str] | None  # of parts, or of parts and joints
Make = Callable[[str, float], Motion]  # of a text and a number of seconds
Label = Callable[[str], frozenset[str]]

_SUFFIXES = {*MOTION_SUFFIXES, *WRITABLE_SUFFIXES, ".asf", ".fbx", ".glb", ".gltf", ".c3d"}  # of files, read or not


@dataclass(frozen=True)
class Makers:
    """What turns texts and plain motions into layers.

    Attributes:
        make: gives the motion of a text, at most 8 s of it.
        label: gives the body parts that a text needs.
        derive: finds the parts that a motion moves.
    """

    make: Make
    label: Label
    derive: Derive


def is_text(given: object) -> bool:
    """Whether ``given`` is a text to be generated: a ``str`` that is not named like a file of motion.

    Nor is it the name, with a suffix or a slash, of a file or folder that exists: a folder may be called "walk".
    """
    if not isinstance(given, str):
        return False
    suffix = Path(given).suffix.lower()
    named = bool(suffix) or Path(given).name != given
    return suffix not in _SUFFIXES and not (named and _exists(given))


def layers_of(
    given: Sequence[LayerLike],
    makers: Makers,
    *,
    parts: Sequence[Names] | None = None,
    masks: Sequence[Names] | None = None,
    seconds: float | None = None,
) -> list[Layer]:
    """One layer for each of ``given``, all of which say what they move.

    Args:
        given: motions, motion files, texts, or layers, which stay as they are.
        makers: what makes motions of texts, and finds parts.
        parts: for each the parts that its action needs, None for those of the text or the motion.
        masks: for each exactly the joints that it moves, instead of parts.
        seconds: how long the composition shall be; None: as the shortest motion, or 4 s where all are texts.

    Raises:
        InvalidInputError: fewer than two, another number of parts or masks, both for one layer, or something else.
        MotionFileNotFoundError, FormatError, RigError: a file that cannot be read.
    """
    _check(given)
    opened = [_opened(one) for one in given]
    wanted = zip(_each(parts, len(opened), "parts"), _each(masks, len(opened), "masks"), strict=True)
    length = _text_seconds(opened, seconds)
    layers = [_layer(one, of, mask, makers, length) for one, (of, mask) in zip(opened, wanted, strict=True)]
    found = given_parts(layers, makers.derive)
    return [Layer(layer.motion, of, layer.mask, layer.weight) for layer, of in zip(layers, found, strict=True)]


def joined(
    given: Sequence[LayerLike], parts: Sequence[Names] | None = None, masks: Sequence[Names] | None = None
) -> str:
    """Texts as one sentence: "walk in a circle and wave the right hand".

    Raises:
        InvalidInputError: fewer than two, one that is no text, or parts or masks, which one sentence has no use for.
    """
    _check(given)
    if parts is not None or masks is not None:
        raise InvalidInputError(
            "joint=True gives the model one sentence: there is nothing that parts or masks could split"
        )
    texts = [checked_text(one.strip(" .,;")) for one in given if isinstance(one, str) and is_text(one)]
    if len(texts) != len(given):
        raise InvalidInputError("joint=True is for texts alone; files and motions are composed without it")
    return f"{', '.join(texts[:-1])} and {texts[-1]}"


def _check(given: Sequence[LayerLike]) -> None:
    if isinstance(given, str | bytes) or not isinstance(given, Sequence) or len(given) < 2:
        raise InvalidInputError(
            f"a composition needs a list of two or more motions, files or texts, not {_told(given)}"
        )


def _told(given: object) -> str:
    """What is too little for a composition."""
    if isinstance(given, Sequence) and not isinstance(given, str | bytes):
        return f"of {shown(given[0])} alone" if given else "an empty one"
    return shown(given)


def _opened(given: LayerLike) -> Layer | Motion | str:
    if isinstance(given, Layer | Motion):
        return given
    if isinstance(given, str) and is_text(given):
        return checked_text(given)
    if not isinstance(given, str | PathLike):
        raise InvalidInputError(f"a layer is a Motion, a motion file, a text or a Layer, not {shown(given)}")
    return load_motion(given)


def _each(names: Sequence[Names] | None, count: int, what: str) -> Sequence[Names]:
    if names is None:
        return [None] * count
    if isinstance(names, str) or not isinstance(names, Sequence) or len(names) != count:
        raise InvalidInputError(
            f"give {what} as a list with one entry for each of the {count} layers, None to leave open"
        )
    return names


def _text_seconds(opened: Sequence[Layer | Motion | str], seconds: float | None) -> float:
    """How much of each text to generate; longer compositions loop it."""
    motions = [one.motion if isinstance(one, Layer) else one for one in opened if not isinstance(one, str)]
    lengths = [motion.duration for motion in motions if motion.frames > 1]  # a single frame is a pose
    if seconds is not None:
        frames_of(seconds, 1.0)  # before anything is generated
    wanted = min(lengths, default=SECONDS) if seconds is None else seconds
    return min(max(wanted, SHORTEST_S), *LONGEST_S.values())


def _layer(given: Layer | Motion | str, parts: Names, mask: Names, makers: Makers, seconds: float) -> Layer:
    if isinstance(given, Layer):
        if parts is not None or mask is not None:
            raise InvalidInputError("a Layer says itself what it moves; leave its parts and its mask None")
        return given
    if isinstance(given, Motion):
        return Layer(given, parts, mask)
    needed = makers.label(given) if parts is None and mask is None else parts
    return Layer(makers.make(given, seconds), needed, mask)


def _exists(text: str) -> bool:
    try:
        return Path(text).exists()
    except (OSError, ValueError):  # too long, or with letters that no file name has
        return False
