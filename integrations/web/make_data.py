"""Write src/data: what the TypeScript needs of motionrt's definitions, so that each is written down once.

Run it as ``python integrations/web/make_data.py``; a test compares.
"""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

from motionrt import SMPL24
from motionrt.locomotion.crowd import history_of
from motionrt.locomotion.starting_poses import standing, stride
from motionrt.models.sessions import Sessions
from motionrt.models.text import load_tokenizer
from motionrt.motion.attributes import POSTURES
from motionrt.motion.body_parts import PART_JOINTS, PARTS
from motionrt.motion.features import ccf219
from motionrt.synthesis.motion_diffusion import held_columns
from motionrt.text import SLOTS, TARGETS, lexicon
from motionrt.text.lexicon.gestures import Gesture, HeadGesture
from motionrt.text.patterns import compiled
from motionrt.text.slots import CLASSES
from motionrt.text.targets import _SCALED

DATA = Path(__file__).parent / "src" / "data"


def start() -> dict[str, Any]:
    """The skeleton ``smpl24``, its body parts, a second of a steady walk (30 frames of 219 numbers), and a stand."""
    standing_pose = standing()
    return {
        "skeleton": {
            "names": list(SMPL24.names),
            "parents": list(SMPL24.parents),
            "offsets": [[round(float(x), 6) for x in offset] for offset in SMPL24.offsets],
        },
        "parts": {part: list(PART_JOINTS[part]) for part in PARTS},
        "owners": held_columns().tolist(),
        "stride": _rows(history_of(stride())),
        "standing": _rows(ccf219.encode(standing_pose if standing_pose is not None else stride()[-1:]))[0],
    }


def words() -> dict[str, Any]:
    """The lexicon with its groups filled in, and the classes and numbers that the motion generator is told."""
    return {
        "lexicon": {name: _filled(getattr(lexicon, name)) for name in sorted(lexicon.__all__) if name != "GROUPS"},
        "postures": list(POSTURES),
        "slots": list(SLOTS),
        "classes": {slot: list(classes) for slot, classes in CLASSES.items()},
        "targets": list(TARGETS),
        "scales": {name: scale for name, (_, scale) in _SCALED.items()},
    }


def characters() -> dict[str, list[list[int]]]:
    """What the tokenizer makes of characters: ``[first, count]`` of those that vanish, part words, or are words.

    Asked of the tokenizer itself, whose tables are of an older Unicode than those of today's JavaScript.
    """
    tokenizer = load_tokenizer(Sessions())
    kinds: dict[str, list[int]] = {"dropped": [], "space": [], "alone": []}
    for code in (code for code in range(0x110000) if not 0xD800 <= code <= 0xDFFF):
        around = tokenizer.normalizer.normalize_str(f"a{chr(code)}b")
        if around in ("ab", "a b"):
            kinds["dropped" if around == "ab" else "space"].append(code)
        elif len(tokenizer.pre_tokenizer.pre_tokenize_str(around)) == 3 and len(around.replace(" ", "")) == 3:
            kinds["alone"].append(code)
    return {kind: _ranges(codes) for kind, codes in kinds.items()}


def _ranges(codes: list[int]) -> list[list[int]]:
    found: list[list[int]] = []
    for code in codes:
        if found and found[-1][0] + found[-1][1] == code:
            found[-1][1] += 1
        else:
            found.append([code, 1])
    return found


def _filled(value: Any) -> Any:
    """Patterns with the words that ``{name}`` stands for; sets as sorted lists."""
    if isinstance(value, str):
        return compiled(value).pattern
    if isinstance(value, Gesture | HeadGesture):
        return _filled(asdict(value))
    if isinstance(value, dict):
        return {key: _filled(each) for key, each in value.items()}
    if isinstance(value, frozenset | set):
        return sorted(value)
    return [_filled(each) for each in value] if isinstance(value, list | tuple) else value


def _rows(frames: Any) -> list[list[float]]:
    return [[round(float(x), 6) for x in frame] for frame in frames]


def write(folder: Path = DATA) -> None:
    """Write all files."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, value in (("start", start()), ("words", words()), ("characters", characters())):
        text = json.dumps(value, separators=(",", ":"), ensure_ascii=True)
        (folder / f"{name}.json").write_text(text + "\n", encoding="ascii")


if __name__ == "__main__":
    write()
    print(DATA)
