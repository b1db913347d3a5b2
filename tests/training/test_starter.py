"""The maker of the starter gallery: which motions are taken, and what becomes of prompts that none does."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from motions import walking

from motionrt_training.recipes import starter
from motionrt_training.recipes.starter import Drawn


def test_the_likest_of_those_that_agree_is_taken() -> None:
    walk = walking(60)
    drawn = [Drawn(walk, 0.9, 0.2), Drawn(walk, 0.8, 0.5), Drawn(walk, 0.3, 0.9)]
    assert starter.chosen(drawn, said=True) is drawn[1]
    assert starter.chosen(drawn, said=False) is drawn[2]
    assert starter.chosen(drawn[2:], said=True) is None


def test_motions_that_float_are_not_taken() -> None:
    walk = walking(60).grounded()
    floating = replace(walk, root=walk.root + np.array([0, 0.3, 0], np.float32))
    assert starter.stands(walk)
    assert not starter.stands(floating)
    assert starter.chosen([Drawn(floating, 1.0, 1.0)], said=True) is None


def test_prompts_have_seconds_and_remarks_are_left_out(tmp_path: Path) -> None:
    path = tmp_path / "prompts.txt"
    path.write_text("# mine\n4 | a walk\n\n2.5 | a jump | high\n", encoding="utf-8")
    assert list(starter.read_prompts(path)) == [(4.0, "a walk"), (2.5, "a jump | high")]
