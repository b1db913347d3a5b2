"""The page of a study: one file that a browser opens without a network, with all motions in it."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from motionrt.errors import InvalidInputError
from motionrt.motion import Motion
from motionrt.study.pairs import Pair
from motionrt.study.votes import KIND
from motionrt.untrusted.files import as_path

QUESTION = "Which of the two moves more naturally?"
PER_METRE = 1000  # positions are whole millimetres
_PLACE = "/*STUDY*/null"


def write_study(
    pairs: Sequence[Pair],
    out: str | Path,
    *,
    names: tuple[str, str] = ("A", "B"),
    question: str = QUESTION,
) -> Path:
    """Write the page. Who votes sees neither names nor sides: order and sides are drawn anew for everybody.

    Args:
        pairs: what is compared.
        out: the file (.html).
        names: what the two sides are called in the file of votes.
        question: what is asked.

    Returns:
        ``out`` as a path.

    Raises:
        InvalidInputError: no pairs, or another suffix.
    """
    path = as_path(out)
    if path.suffix.lower() not in {".html", ".htm"}:
        raise InvalidInputError(f"a study is a page: give a name that ends in .html, not {path.name}")
    if not pairs:
        raise InvalidInputError("a study needs at least one pair")
    shown = [{"name": pair.name, "a": _clip(pair.a), "b": _clip(pair.b)} for pair in pairs]
    study: dict[str, Any] = {"kind": KIND, "a": names[0], "b": names[1], "question": question, "pairs": shown}
    study["study"] = hashlib.sha256(json.dumps(study, sort_keys=True).encode()).hexdigest()[:12]
    page = files("motionrt.study").joinpath("page.html").read_text(encoding="utf-8")
    # "<" cannot end the script that the data stands in
    data = json.dumps(study, separators=(",", ":"), ensure_ascii=True).replace("<", "\\u003c")
    path.write_text(page.replace(_PLACE, data, 1), encoding="utf-8")
    return path


def _clip(motion: Motion) -> dict[str, Any]:
    """Joints in millimetres from where the pelvis is at first, frame by frame."""
    joints = motion.positions().astype(np.float64)
    joints -= joints[0, 0] * np.array([1.0, 0.0, 1.0])
    whole = np.rint(joints * PER_METRE).astype(int)
    return {
        "fps": float(motion.fps),
        "parents": [int(parent) for parent in motion.skeleton.parents],
        "sides": [1 if name.startswith("left") else -1 * name.startswith("right") for name in motion.skeleton.names],
        "frames": whole.reshape(len(whole), -1).tolist(),
    }
