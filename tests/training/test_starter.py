"""The maker of the starter gallery: windows, the network, roll-outs, and the gallery made of prompts."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import torch
from motions import walking
from tiny_models import TINY

from motionrt import Gallery, Runtime
from motionrt.motion.features import guo263
from motionrt_training.networks.continuation import POSE, Continuation
from motionrt_training.packed import PackedClip, PackedCorpus
from motionrt_training.recipes import starter
from motionrt_training.trainer import Schedule, Trainer


def corpus_of(frames: int = 60) -> PackedCorpus:
    features = np.concatenate([guo263.encode(walking(frames)), guo263.encode(walking(frames, turn=0.05))])
    clips = tuple(
        PackedClip(split, split, start, frames, ("walk left",), ("walk right",))
        for split, start in (("train", 0), ("val", frames))
    )
    return PackedCorpus(features.astype(np.float16), clips)


TINY_SETTINGS = starter.StarterSettings(width=32, blocks=1, batch=16, unroll=2, unroll_after=5)


def test_windows_cover_clips_and_their_mirror_images_with_the_right_texts() -> None:
    found = starter.windows(corpus_of(), "train", torch.zeros(POSE), torch.ones(POSE), 20)
    assert len(found.first) == 2 * (60 - 20 + 1)
    frames, texts = found.draw(np.random.default_rng(0), 40, 20)
    assert frames.shape == (40, 20, POSE)
    assert set(texts) == {"walk left", "walk right"}
    straight = corpus_of().features[:60, :POSE].astype(np.float32)
    for window, text in zip(frames.numpy(), texts, strict=True):
        source = straight if text == "walk left" else guo263.mirror(corpus_of().features[:60])[:, :POSE]
        assert any(np.array_equal(window, source[i : i + 20]) for i in range(41))


def test_a_roll_out_has_the_asked_length_and_continues_what_it_made() -> None:
    torch.manual_seed(0)
    network = Continuation(history=8, ahead=4, width=16, blocks=1).eval()
    start, latent = torch.randn(2, 8, POSE), torch.randn(2, 256)
    made = network.roll_out(start, latent, 10)
    assert made.shape == (2, 10, POSE)
    torch.testing.assert_close(made[:, :4], network(start, latent))
    torch.testing.assert_close(made[:, 4:8], network(torch.cat((start[:, 4:], made[:, :4]), 1), latent))


def test_training_lowers_the_held_out_loss_and_its_checkpoint_makes_a_gallery(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    task = starter.StarterTask(corpus_of(), Runtime(TINY).model, TINY_SETTINGS, seed=0)
    with torch.no_grad():
        before = task.validate(task.model.eval())["held_out"]
    schedule = Schedule(steps=30, lr=3e-3, warmup=1, ema=0.5, validate_every=15, bf16=False, device="cpu")
    after = Trainer(task, schedule, tmp_path / "run", {"network": task.model.config}).run()["held_out"]
    assert after < 0.8 * before
    prompts = tmp_path / "prompts.txt"
    prompts.write_text("# seconds | prompt\n2 | a person walks\n\n1.5 | a person waves\n", encoding="utf-8")
    monkeypatch.setattr(starter, "PROMPTS", prompts)
    monkeypatch.setattr(starter, "Runtime", lambda text_tower: Runtime(TINY, text_tower=text_tower))
    monkeypatch.setattr(starter, "FARTHEST", np.inf)
    monkeypatch.setattr(starter, "RECOGNISED", -1.0)
    monkeypatch.setattr(starter, "_between_floor_and_ceiling", lambda motion: True)
    gallery = starter.make(tmp_path / "run/best.pt", tmp_path / "gallery", candidates=2)
    assert {clip.id: clip.text for clip in gallery.clips} == {
        "a-person-walks": "a person walks",
        "a-person-waves": "a person waves",
    }
    assert gallery.motion("a-person-waves").frames == 30


def test_roll_outs_that_leave_the_range_of_human_poses_are_dropped() -> None:
    network = Continuation(width=16, blocks=1).eval()
    torch.nn.init.constant_(network.out.bias, 100.0)
    assert starter.roll_outs(network, Runtime(TINY).model, "a person walks", 20, candidates=3, seed=0) == []


def test_the_best_motion_is_the_nearest_to_the_text_and_none_when_nothing_fits(monkeypatch: pytest.MonkeyPatch) -> None:
    model, motions = Runtime(TINY).model, [walking(40), walking(40, turn=2.0), walking(40, speed=4.0)]
    fits = model.embed_motion([guo263.encode(motion.grounded()) for motion in motions]) @ model.embed_text(["walk"])[0]
    monkeypatch.setattr(starter, "RECOGNISED", float(fits.max()) - 1e-3)
    assert starter.best_of(motions, model, "walk") is motions[int(np.argmax(fits))]
    monkeypatch.setattr(starter, "RECOGNISED", float(fits.max()) + 1e-3)
    assert starter.best_of(motions, model, "walk") is None
    assert starter.best_of([], model, "walk") is None


def test_the_starter_gallery_can_be_embedded_again_in_place(tmp_path: Path) -> None:
    pytest.importorskip("onnx", reason="onnx is not installed: pip install 'motionrt[export]'")
    from motionrt_export.starter import embed_starter

    model = Runtime(TINY).model
    Gallery.from_motions([walking(40), walking(40, turn=1)], ["a", "b"], model, texts=["x", "y"]).save(tmp_path)
    before = Gallery.open(tmp_path)
    after = embed_starter(Runtime(TINY), tmp_path)
    assert [(clip.id, clip.text) for clip in after.clips] == [("a", "x"), ("b", "y")]
    np.testing.assert_allclose(after.motion("b").positions(), before.motion("b").positions(), atol=5e-4)


def test_every_shipped_prompt_is_readable_and_different() -> None:
    shipped = list(starter.read_prompts(starter.PROMPTS))
    assert len({text for _, text in shipped}) == len(shipped) >= 60
    assert all(2 <= seconds <= 10 for seconds, _ in shipped)
