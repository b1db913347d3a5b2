"""Contact events and loop points of clips."""

from __future__ import annotations

import json
import struct
from pathlib import Path

import numpy as np
import pytest

from motionrt.motion import Motion
from motionrt.motion.events import events


def standing(frames: int = 60) -> Motion:
    return Motion(np.tile(np.eye(3, dtype=np.float32), (frames, 24, 1, 1)), np.tile([0, 0.9, 0], (frames, 1)), 30.0)


def test_both_feet_of_somebody_who_stands_are_in_contact_all_the_time() -> None:
    found = events(standing())
    assert [(row["foot"], row["from"], row["to"]) for row in found["contacts"]] == [
        ("left", 0.0, pytest.approx(59 / 30, abs=1e-3)),
        ("right", 0.0, pytest.approx(59 / 30, abs=1e-3)),
    ]


def test_a_clip_that_ends_as_it_begins_can_be_looped_wherever_it_goes() -> None:
    gone = standing().root + np.linspace(0, 2, 60)[:, None] * [0, 0, 1]
    assert events(standing())["loop"] == {"from": 0.0, "to": pytest.approx(59 / 30, abs=1e-3)}
    assert events(Motion(standing().rotations, gone, 30.0))["loop"] is not None


def test_a_clip_that_ends_otherwise_cannot() -> None:
    sunk = standing().root - np.linspace(0, 0.4, 60)[:, None] * [0, 1, 0]
    assert events(Motion(standing().rotations, sunk, 30.0))["loop"] is None


def test_glb_files_carry_the_events_in_the_extras_of_their_animation(tmp_path: Path) -> None:
    content = standing().save(tmp_path / "clip.glb").read_bytes()
    length = struct.unpack("<I", content[12:16])[0]
    document = json.loads(content[20 : 20 + length])
    assert document["animations"][0]["extras"]["motionrt"] == json.loads(json.dumps(events(standing())))
