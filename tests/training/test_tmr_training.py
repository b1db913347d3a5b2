"""The trainer on tiny corpora: resuming, learning, mirroring, releasing."""

from __future__ import annotations

import json
import os
import signal
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from motions import walking

torch = pytest.importorskip("torch", reason="training tests need torch (extra 'train')")
pytest.importorskip("safetensors", reason="training tests need safetensors (extra 'train')")
pytest.importorskip("tqdm", reason="training tests need tqdm (extra 'train')")

from motionrt.errors import InvalidInputError  # noqa: E402
from motionrt.motion.features import guo263  # noqa: E402
from motionrt_training.augment import Augmentation, View, draw_view, view_motion, view_slots, view_text  # noqa: E402
from motionrt_training.batches import EpochPlan  # noqa: E402
from motionrt_training.checkpoint import load_any, load_release, load_state, release  # noqa: E402
from motionrt_training.networks.tmr import TMR  # noqa: E402
from motionrt_training.packed import (  # noqa: E402
    PackedClip,
    PackedCorpus,
    Window,
    load_packed,
    mirror_columns,
    statistics,
    without_source,
)
from motionrt_training.recipes.tmr import parser  # noqa: E402
from motionrt_training.text_cache import TextFeatures, cached_features  # noqa: E402
from motionrt_training.tmr_task import TmrSettings, TmrTask  # noqa: E402
from motionrt_training.trainer import Schedule, Trainer  # noqa: E402

TINY = TmrSettings(d=32, layers=1, heads=2, ff=32, batch=8, patch=2, noise=0.0, threshold=None)
QUICK = Schedule(steps=6, warmup=0, bf16=False, device="cpu", validate_every=1000)


class Words:
    """A backbone whose token features are fixed random vectors of the words."""

    fingerprint = "words"

    def __init__(self) -> None:
        self.calls = 0

    def encode(self, text: str) -> tuple[np.ndarray, np.ndarray]:
        self.calls += 1
        seeds = [int.from_bytes(word.encode("utf-8")[-4:], "big") for word in text.split()]
        tokens = np.stack([np.random.default_rng(seed).standard_normal(12) for seed in seeds]).astype(np.float32)
        mean = tokens.mean(0)
        return tokens, mean / np.linalg.norm(mean)


def corpus_of(count: int = 8, frames: int = 30) -> PackedCorpus:
    rng = np.random.default_rng(0)
    features = np.repeat(rng.standard_normal((count, 1, 6)), frames, axis=1).reshape(-1, 6).astype(np.float16)
    clips = [
        PackedClip(f"c{i}", split, i * frames, frames, (f"move {i} left",), (f"move {i} right",))
        for i in range(count)
        for split in ("train", "val")
    ]
    return PackedCorpus(features, tuple(clips), np.negative)


def task_of(settings: TmrSettings = TINY) -> TmrTask:
    corpus = corpus_of()
    encoded = [Words().encode(text) for text in corpus.texts()]
    length = np.array([len(tokens) for tokens, _ in encoded])
    tokens = np.concatenate([tokens for tokens, _ in encoded]).astype(np.float16)
    sentences = np.stack([sentence for _, sentence in encoded]).astype(np.float16)
    return TmrTask(corpus, TextFeatures(tokens, np.cumsum(length) - length, length, sentences), settings, seed=1)


class StopsAt(TmrTask):
    """Asks the process to end while it prepares the batch of a step, as a scheduler's SIGTERM would."""

    at = 3

    def batch(self, step: int) -> dict[str, torch.Tensor]:
        if step == self.at - 1:
            os.kill(os.getpid(), signal.SIGTERM)
        return super().batch(step)


def test_a_stopped_and_resumed_training_ends_with_the_same_weights(tmp_path: Path) -> None:
    straight = task_of()
    Trainer(straight, QUICK, tmp_path / "straight").run()
    first = task_of()
    first.__class__ = StopsAt
    Trainer(first, QUICK, tmp_path / "resumed").run()
    assert load_state(tmp_path / "resumed" / "last.pt")["step"] == StopsAt.at
    second = task_of()
    trainer = Trainer(second, QUICK, tmp_path / "resumed")
    trainer.run()
    assert trainer.step == QUICK.steps
    for one, other in zip(straight.model.parameters(), second.model.parameters(), strict=True):
        assert torch.equal(one, other)
    averages = [load_state(tmp_path / name / "last.pt")["average"] for name in ("straight", "resumed")]
    assert all(torch.equal(one, other) for one, other in zip(*averages, strict=True))


def test_other_settings_in_the_same_folder_are_refused(tmp_path: Path) -> None:
    Trainer(task_of(), QUICK, tmp_path, {"threshold": 0.8}).run()
    with pytest.raises(ValueError, match="other settings"):
        Trainer(task_of(), QUICK, tmp_path, {"threshold": 0.9}).run()


@pytest.mark.parametrize("bf16", [False, True])
def test_eight_pairs_are_learned_by_heart(tmp_path: Path, bf16: bool) -> None:
    settings = TmrSettings(**{**vars(TINY), "contrast": "mean", "dropout": 0.0, "mirror": False})
    schedule = Schedule(steps=160, lr=3e-3, warmup=10, ema=0.9, bf16=bf16, device="cpu", validate_every=160)
    measures = Trainer(task_of(settings), schedule, tmp_path).run()
    assert measures["t2m_R1"] == 100.0
    assert measures["m2t_R1"] == 100.0
    rows = [json.loads(line) for line in (tmp_path / "log.jsonl").read_text(encoding="utf-8").splitlines()]
    assert {"loss", "contrastive", "reconstruction", "kl", "ms_per_step"} <= set(rows[0])
    assert rows[-2]["loss"] < rows[0]["loss"]


@pytest.mark.parametrize(
    ("settings", "present"),
    [
        (TmrSettings(contrastive=False), {"reconstruction"}),
        (TmrSettings(reconstruction=False), {"contrastive"}),
        (TmrSettings(margin=True, reconstruct="both"), {"contrastive", "reconstruction"}),
        (TmrSettings(margin=True, reconstruction=False, encoder="gru", contrast="mean"), {"contrastive"}),
    ],
)
def test_the_ablation_switches_remove_their_terms(settings: TmrSettings, present: set[str]) -> None:
    task = task_of(TmrSettings(**{**vars(settings), "d": 32, "layers": 1, "heads": 2, "ff": 32}))
    losses = task.losses(task.model, task.batch(0))
    assert {"contrastive", "reconstruction"} & set(losses) == present
    assert torch.isfinite(losses["loss"])


def test_alternate_reconstruction_is_that_of_both_on_average() -> None:
    both, alternate = (TmrSettings(reconstruct=name, dropout=0.0, speed=0.0) for name in ("both", "alternate"))
    task = task_of(TmrSettings(**{**vars(TINY), "dropout": 0.0}))
    batch = task.batch(0)
    motion, mask = task.model.normalise(batch["motion"])[:8], batch["mask"][:8]  # without the mirror images
    latents = torch.randn(2, 8, 32)

    def term(settings: TmrSettings) -> float:
        task.settings = settings
        return float(task._reconstruction(latents[0], latents[1], motion, mask).detach())

    mean = np.mean([term(alternate) for _ in range(400)])
    assert mean == pytest.approx(term(both), rel=0.03)


def test_a_mirrored_motion_comes_with_its_mirrored_text() -> None:
    task = task_of(TmrSettings(**{**vars(TINY), "speed": 0.0}))
    seen = set()
    for step in range(8):
        batch = task.batch(step)
        for row, (clip, view) in enumerate(task.plan.at(step)):
            text, source = view_text(task.clips[clip], view), task.corpus.features[task.clips[clip].start]
            assert ("right" in text) == view.mirror
            expected = -source if view.mirror else source
            np.testing.assert_allclose(batch["motion"][row, 0], expected.astype(np.float32))
            twin = batch["motion"][row + len(batch["motion"]) // 2, 0]
            np.testing.assert_allclose(twin, -expected.astype(np.float32))
            seen.add(view.mirror)
    assert seen == {True, False}


def test_a_faster_view_has_larger_rates_and_the_same_poses() -> None:
    frames = np.arange(40, dtype=np.float16)[:, None] * np.ones((1, 263), dtype=np.float16)
    clip = PackedClip("c", "train", 0, 40, ("a",), ("a",))
    seen = view_motion(PackedCorpus(frames, (clip,)), clip, View(False, 2.0, 1.5, 20, 0))
    np.testing.assert_allclose(seen[:, 100], 2.0 + 1.5 * np.arange(20))  # a rotation column: interpolated
    np.testing.assert_allclose(seen[:, 200], 1.5 * (2.0 + 1.5 * np.arange(20)))  # a velocity: scaled too


def test_views_stay_inside_the_clip_and_keep_enough_of_it() -> None:
    rng, rules = np.random.default_rng(0), Augmentation(crop=0.6, most=200, speed=0.1)
    for length in (1, 5, 20, 33, 199, 400):
        clip = PackedClip("c", "train", 0, length, ("a", "b"), ("a", "b"))
        for _ in range(50):
            view = draw_view(clip, rules, rng)
            assert 1 <= view.frames <= 200
            assert view.first + (view.frames - 1) * view.speed <= length - 1 + 1e-6
            available = (length - 1) / view.speed + 1
            assert view.frames >= min(200, 0.6 * available - 1)


def test_statistics_leave_the_test_split_out() -> None:
    features = np.concatenate([np.ones((10, 3)), np.full((10, 3), 50.0)]).astype(np.float16)
    clips = [PackedClip(split, split, start, 10, ("a",), ("a",)) for split, start in (("train", 0), ("test", 10))]
    mean, std = statistics(PackedCorpus(features, tuple(clips), np.negative))
    np.testing.assert_allclose(mean, 0.0)  # ones and their mirror images, which are minus ones here
    assert (std > 0).all()


def test_a_source_is_left_out_of_training_and_validation_and_can_still_be_searched() -> None:
    rows = [("train", "a"), ("train", "b"), ("val", "a"), ("test", "a"), ("test", "b"), ("train", "")]
    clips = [PackedClip(f"{i}", split, 0, 1, ("x",), ("x",), source=s) for i, (split, s) in enumerate(rows)]
    corpus = without_source(PackedCorpus(np.zeros((1, 3), np.float16), tuple(clips), np.negative), "a")
    assert [clip.id for clip in corpus.split("train")] == ["1"]  # what names no source may hold some of it
    assert corpus.split("val") == []
    assert [clip.id for clip in corpus.split("test")] == ["3", "4"]
    with pytest.raises(InvalidInputError, match=r"no clip is of the source 'c'; the corpus has a, b"):
        without_source(corpus, "c")


def test_a_release_holds_the_averaged_weights_in_half_precision(tmp_path: Path) -> None:
    task = task_of()
    Trainer(task, Schedule(**{**vars(QUICK), "validate_every": 3}), tmp_path, {"network": task.model.config}).run()
    release(tmp_path / "best.pt", tmp_path / "tmr.safetensors", "tmr")
    model, metadata = load_release(tmp_path / "tmr.safetensors", TMR)
    best = load_any(tmp_path / "best.pt", TMR)
    for one, other in zip(model.parameters(), best.parameters(), strict=True):
        assert torch.equal(one, other.half().float())
    assert json.loads(metadata["config"]) == task.model.config
    assert metadata["recipe"] == "tmr"
    assert int(metadata["steps"]) in (3, 6)


def test_texts_are_encoded_once_and_kept(tmp_path: Path) -> None:
    words, texts = Words(), ["walk left", "jump", "turn around slowly"]
    first = cached_features(texts, words, tmp_path)
    again = cached_features(texts, words, tmp_path)
    assert words.calls == 3
    np.testing.assert_array_equal(first.of(2), words.encode(texts[2])[0].astype(np.float16))
    np.testing.assert_array_equal(first.tokens, again.tokens)
    cached_features(["another"], words, tmp_path)
    assert words.calls == 5


def test_a_packed_file_is_read_back(tmp_path: Path) -> None:
    meta = [{"id": "a", "split": "train", "texts": ["x left"], "texts_mirror": ["x right"]}]
    arrays = {"features": np.zeros((4, 263), np.float16)}
    np.savez(tmp_path / "p.npz", **arrays, start=[0], length=[4], meta=json.dumps(meta))
    corpus = load_packed(tmp_path / "p.npz")
    assert corpus.texts() == ["x left", "x right"]
    assert corpus.motion(corpus.clips[0], mirror=True).shape == (4, 263)
    np.savez(tmp_path / "broken.npz", start=[0])
    with pytest.raises(ValueError, match="features"):
        load_packed(tmp_path / "broken.npz")


def test_every_setting_is_an_option() -> None:
    needed = ["--corpus", "cmu.npz", "--out", "run"]
    options = ["--threshold", "none", "--no-contrastive", "--minutes", "5", "--bf16", "false"]
    args = parser().parse_args([*needed, *options])
    assert (args.threshold, args.contrastive, args.minutes, args.bf16) == (None, False, 5.0, False)
    assert parser().parse_args(needed).threshold == 0.8


def test_a_sided_caption_is_told_from_the_mirror_image_of_its_clip() -> None:
    batch = task_of().batch(0)
    positive, negative = batch["positive"].numpy(), batch["negative"].numpy()
    assert positive.shape == (16, 16)  # 8 clips and their mirror images, as many captions: "left" and "right"
    assert (positive.sum(0) == 1).all()
    assert (positive.sum(1) == 1).all()
    for text, motion in zip(*np.nonzero(positive), strict=True):
        assert negative[text, (motion + 8) % 16] == TINY.hard
    assert not (positive & (negative > 0)).any()


def test_a_caption_without_a_side_goes_with_both_images_of_its_clip() -> None:
    task = task_of()
    clips = tuple(replace(clip, texts=("wave",), texts_mirror=("wave",)) for clip in task.corpus.clips)
    task.clips, task.index["wave"] = [clip for clip in clips if clip.split == "train"], 0
    batch = task.batch(0)
    assert batch["positive"].shape == (1, 16)
    assert bool(batch["positive"].all())
    assert not bool(batch["negative"].any())


def test_a_clip_whose_caption_names_a_turn_is_told_from_itself_without_the_turn() -> None:
    features = np.ones((30, 263), dtype=np.float16)
    clip = PackedClip("a", "train", 0, 30, ("turn left",), ("turn right",))
    task = task_of()
    task.corpus = PackedCorpus(features, (clip,))
    task.clips, task.plan = [clip], EpochPlan([clip], 1, Augmentation(speed=0.0), 1)
    task.index = {"turn left": 0, "turn right": 1}
    batch = task.batch(0)
    np.testing.assert_array_equal(batch["motion"][2:, :, 0], 0.0)  # the turn of the clip and of its mirror image
    assert bool((batch["motion"][:2, :, 0] != 0).all())
    np.testing.assert_array_equal(batch["negative"][:, 2:], TINY.hard * np.eye(2))


def test_windows_bring_their_texts_and_slots_into_the_views() -> None:
    own = Window(4, 10, (1,), (2,), ("hop",), ("hop",))
    clip = PackedClip("a", "train", 0, 30, ("walk",), ("walk",), (Window(0, 30, (3,), (4,)), own))
    rng = np.random.default_rng(0)
    views = [draw_view(clip, Augmentation(speed=0.0, spoken=0.5), rng) for _ in range(60)]
    said = {(view_text(clip, v), v.first, v.frames, view_slots(clip, v)) for v in views}
    assert said == {("walk", 0, 30, (3,)), ("walk", 0, 30, (4,)), ("hop", 4, 10, (1,)), ("hop", 4, 10, (2,))}


@pytest.mark.parametrize("turn", [0.4, -0.7])
def test_columns_that_change_places_are_the_mirror_image_but_for_rotations(turn: float) -> None:
    features = guo263.encode(walking(80, turn=turn))
    exact, quick = guo263.mirror(features), mirror_columns(features)
    metres = {
        "yaw": (0, 2e-3),
        "planar": (guo263.PLANAR, 1e-3),
        "height": (3, 1e-3),
        "joints": (guo263.POSITIONS, 0.02),
    }
    for name, (columns, most) in metres.items():
        np.testing.assert_allclose(quick[:, columns], exact[:, columns], atol=most, err_msg=name)
    np.testing.assert_array_equal(mirror_columns(quick), features)
