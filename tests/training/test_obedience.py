"""Obedience of generated motion: what is counted, and against what."""

from __future__ import annotations

import pytest
from motions import standing, walking

from motionrt_training.evaluate import obedience


class Maker:
    """Walks where a text says so, else stands; never asked for anything else."""

    def __init__(self) -> None:
        self.asked: list[tuple[str, int, int | None]] = []

    def generate(self, text: str, seconds: float, *, seed: int, steps: int | None = None):  # type: ignore[no-untyped-def]
        self.asked.append((text, seed, steps))
        frames = round(30 * seconds)
        return walking(frames, fps=30, speed=1.2) if "walk" in text else standing(frames, fps=30)


def test_motions_that_do_what_is_said_pass_and_the_others_do_not() -> None:
    drawn = obedience.draw(Maker(), ["walk straight ahead", "stand still"], 3)  # type: ignore[arg-type]
    rows = {row[0]: row for row in obedience.by_attribute(drawn)}
    assert rows["travel"][1] == 2
    assert rows["all"][2:] == ["100", "50", "50"]  # half of all motions, and the pose that is held, do the other


def test_every_number_of_steps_is_asked_for_every_text_and_seed() -> None:
    maker = Maker()
    rows = obedience.by_steps(maker, ["walk straight ahead"], 2, [3, 12])  # type: ignore[arg-type]
    assert [row[0] for row in rows] == [3, 12]
    assert maker.asked == [("walk straight ahead", seed, steps) for steps in (3, 12) for seed in (0, 1)]
    assert rows[0][1] == "100"


def test_the_command_writes_a_table(tmp_path, monkeypatch: pytest.MonkeyPatch) -> None:  # type: ignore[no-untyped-def]
    monkeypatch.setattr(obedience, "Runtime", lambda models: Maker())
    prompts = tmp_path / "prompts.txt"
    prompts.write_text("walk straight ahead\nstand still\n", encoding="utf-8")
    obedience.main(["--prompts", str(prompts), "--seeds", "1", "-o", str(tmp_path / "page.md")])
    assert "| travel | 2 | 100 | 50 | 50 |" in (tmp_path / "page.md").read_text(encoding="utf-8")
