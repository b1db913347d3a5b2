"""Tables of generated motion, on tiny random networks and motions made up for the test."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import torch
from motions import standing, walking

from motionrt.errors import FormatError, InvalidInputError
from motionrt.formats.motion_pack import MotionPack
from motionrt.motion import Motion
from motionrt.motion.body_parts import PART_JOINTS
from motionrt.motion.features import sinc135
from motionrt.synthesis.sampling import Sampling
from motionrt_training.corpora.actions import Action, read_actions
from motionrt_training.corpora.recordings import load_recordings
from motionrt_training.evaluate import generation, pair_tables, part_labels, prompts
from motionrt_training.evaluate.latents import Latents, TorchLatents, drawn
from motionrt_training.evaluate.simultaneous import ActionPair, chosen, read_action_pairs
from motionrt_training.evaluate.ways import WAYS, diffused, first_pose, together
from motionrt_training.networks.temos import Temos

WALK = Action("walk", frozenset({"left leg", "right leg", "global"}))
WAVE = Action("wave the right hand", frozenset({"right arm"}))
TURN = Action("turn left", frozenset({"global"}))


class Letters:
    """A backbone that draws every token's features from its letters."""

    fingerprint = "letters"

    def encode(self, text: str) -> tuple[np.ndarray, np.ndarray]:
        rows = [np.random.default_rng(list(word.encode())).normal(size=384) for word in text.split()]
        return np.stack(rows).astype(np.float32), (np.mean(rows, axis=0) / 384**0.5).astype(np.float32)


def tiny_temos() -> Temos:
    torch.manual_seed(5)
    model = Temos(d=32, layers=1, heads=2, ff=32, dropout=0.0)
    model.motion_decoder.project.weight.data.normal_(0.0, 0.2)
    model.frame_mean[4:] = torch.tensor([1.0, 0.0, 0.0, 0.0, 1.0, 0.0]).repeat(22)
    model.frame_mean[3] = 0.9
    model.frame_std.fill_(0.1)
    return model.eval()


@pytest.fixture
def model() -> Latents:
    return TorchLatents(tiny_temos(), Letters())


@pytest.fixture
def corpus(tmp_path: Path) -> tuple[Path, Path]:
    motions = [walking(90, fps=30), walking(120, fps=30, turn=0.8), standing(60, fps=30)]
    with (tmp_path / "recordings.npz").open("wb") as file:
        MotionPack.of(motions).write(file)
    names = {"ids": ["a", "b", "c"], "splits": ["test", "test", "train"]}
    (tmp_path / "recordings.json").write_text(json.dumps(names), encoding="utf-8")
    labels = [[WALK, WAVE], [WALK, TURN, WAVE], [WALK]]
    rows = [
        {
            "id": f"{name}_0",
            "trial": name,
            "start_s": 0.5,
            "end_s": 1.5 + index / 2,
            "split": names["splits"][index],
            "labels": [{"text": action.text, "parts": sorted(action.parts)} for action in labels[index]],
            "captions": [f"{name} walks", f"someone called {name} goes ahead"],
        }
        for index, name in enumerate(names["ids"])
    ]
    captions = tmp_path / "captions.jsonl"
    captions.write_text("\n".join(map(json.dumps, rows)), encoding="utf-8")
    return tmp_path / "recordings.npz", captions


# -- two actions at once


def test_of_three_labels_the_first_two_that_fit_together_are_chosen() -> None:
    assert chosen([WALK, TURN, WAVE]) == (WALK, WAVE)
    assert chosen([WALK, TURN]) == (WALK, TURN)


def test_pairs_are_the_test_clips_with_two_labels_cut_from_their_recordings(corpus) -> None:
    pairs = read_action_pairs(*corpus)
    assert [(pair.id, pair.sentence, pair.fits) for pair in pairs] == [
        ("a_0", "walk and wave the right hand", True),
        ("b_0", "walk and wave the right hand", True),
    ]
    assert [pair.truth.frames for pair in pairs] == [30, 45]
    expected = walking(90, fps=30)[15:45].canonical()
    np.testing.assert_allclose(pairs[0].truth.positions()[:, :22], expected.positions()[:, :22], atol=1e-3)
    assert [pair.truth.frames for pair in read_action_pairs(*corpus, longest=20)] == [20, 20]
    with pytest.raises(InvalidInputError, match="no clip of split 'val'"):
        read_action_pairs(*corpus, split="val")


@pytest.mark.parametrize("kind", sorted(WAYS))
def test_every_way_makes_the_mean_and_samples_as_long_as_the_truth_and_the_same_again(model, corpus, kind) -> None:
    pair = read_action_pairs(*corpus)[1]
    motions, again = (WAYS[kind](model)(pair, 2) for _ in range(2))
    assert [motion.frames for motion in motions] == [45, 45, 45]
    np.testing.assert_array_equal([m.root for m in motions], [m.root for m in again])
    assert np.abs(motions[0].rotations - motions[1].rotations).max() > 1e-3
    np.testing.assert_array_equal(WAYS[kind](model)(pair, 0)[0].root, motions[0].root)


def test_composed_joints_are_those_of_each_action_alone(model, corpus) -> None:
    pair = read_action_pairs(*corpus)[0]
    found = WAYS["compose"](model)(pair, 0)[0]
    walk, wave = (model.decode(model.text(a.text)[0], pair.truth.frames) for a in (pair.first, pair.second))
    arm = list(PART_JOINTS["right arm"])
    others = [joint for joint in range(24) if joint not in arm]
    np.testing.assert_array_equal(found.rotations[:, arm], wave.rotations[:, arm])
    np.testing.assert_array_equal(found.rotations[:, others], walk.rotations[:, others])
    np.testing.assert_array_equal(found.root, walk.root)


def test_labels_that_clash_are_composed_all_the_same() -> None:
    walk, turn = walking(30, fps=30), walking(30, fps=30, turn=1.0)
    found = together(walk, turn, WALK.parts, TURN.parts)
    np.testing.assert_array_equal(found.root, turn.root)


def test_separate_texts_reach_the_network_one_behind_the_other(model) -> None:
    whole, parts = model.text("walk and wave"), model.text("walk", "and wave")
    np.testing.assert_allclose(whole[0], parts[0], atol=1e-6)  # words do not know their neighbours here
    assert np.abs(model.text("walk")[0] - whole[0]).max() > 1e-3


def test_draws_begin_with_the_mean_and_spread_as_the_distribution_says(model) -> None:
    mean, spread = model.text("walk")
    first, *others = drawn(model, ["walk"], 2000, np.random.default_rng(0))
    np.testing.assert_array_equal(first, mean)
    np.testing.assert_allclose(np.std(others, axis=0), spread, rtol=0.1)


class Truthful:
    """Gives the recording back, then motions that are further and further off."""

    def __call__(self, pair: ActionPair, samples: int) -> list[Motion]:
        truth = pair.truth
        return [
            truth,
            *(Motion(truth.rotations, truth.root + np.float32([0, 0.1 * n, 0]), 30) for n in range(1, samples + 1)),
        ]


def place(motion: Motion) -> np.ndarray:
    return np.array([motion.root[:, 1].mean(), 1.0])


def test_the_ruler_measures_mean_average_and_best(corpus) -> None:
    row = pair_tables.Ruler(read_action_pairs(*corpus), {"height": place}, samples=3).row(Truthful())
    assert row.mean.scores["height"] == pytest.approx(1)
    assert max(row.mean.ape.as_dict().values()) < 1e-6
    assert row.average is not None
    assert row.best is not None
    assert row.average.ape.mean_global == pytest.approx(0.2, abs=1e-5)  # 0.1, 0.2, 0.3
    assert row.best.ape.root == pytest.approx(0.1, abs=1e-5)
    assert row.average.ave.root < 1e-6
    assert row.pairs == 2


def test_rows_are_compared_pair_by_pair_with_the_first_one(corpus) -> None:
    assert pair_tables.difference([0.5, 0.7, 0.9], [0.4, 0.5, 0.6]) == "+0.200 ± 0.058"  # 0.1 / sqrt(3)
    ruler = pair_tables.Ruler(read_action_pairs(*corpus), {"height": place})
    rows = {"told": ruler.row(Truthful()), "again": ruler.row(Truthful())}
    assert pair_tables.difference_table(rows).splitlines()[-1] == "| again | +0.000 ± 0.000 |"


def test_the_held_first_pose_is_off_by_the_way_walked(corpus) -> None:
    row = pair_tables.Ruler(read_action_pairs(*corpus)[:1], {}).row(first_pose)
    assert row.mean.ape.trajectory == pytest.approx(1.2 * 14.5 / 30, rel=0.05)  # 1.2 m/s, 30 frames
    assert row.average is None


def test_the_command_writes_table_and_figures(corpus, tmp_path, monkeypatch) -> None:
    checkpoint = tmp_path / "tiny.pt"
    net = tiny_temos()
    torch.save({"model": net.state_dict(), "notes": {"network": net.config}, "step": 1}, checkpoint)
    monkeypatch.setattr(generation, "open_backbone", lambda kind, path: Letters())
    monkeypatch.setattr(generation, "_retrieval", lambda models: place)
    files = ["--recordings", str(corpus[0]), "--captions", str(corpus[1]), "--encoder", str(checkpoint)]
    out, figures = tmp_path / "table.md", tmp_path / "table.json"
    rows = ["--row", f"one=text:{checkpoint}", "--row", f"two=compose:{checkpoint}", "--row", f"three={checkpoint}"]
    generation.main(["pairs", *files, *rows, "--samples", "2", "-o", str(out), "--json", str(figures)])
    page, found = out.read_text(encoding="utf-8"), json.loads(figures.read_text(encoding="utf-8"))
    assert page.startswith("2 test clips with two simultaneous labels; in 2 of them")
    assert [line.split(" |")[0] for line in page.splitlines() if line.startswith("| t")] == ["| two", "| three"] * 4
    assert "Best of 2 samples" in page
    assert found["rows"]["one"]["mean"] == found["rows"]["three"]["mean"] != found["rows"]["two"]["mean"]
    assert 0 < found["rows"]["one"]["mean"]["scores"]["TEMOS"] < 1


class Diffuser:
    """A generator whose latents are the temperature and the number of the sample, and whose motions walk so fast."""

    def latents(self, text: str, sampling: Sampling) -> np.ndarray:
        assert (text, sampling.sampler) == ("walk and wave the right hand", "diffusion")
        return np.array([[sampling.temperature, sample] for sample in range(sampling.n)])

    def decode(self, latents: np.ndarray, frames: int) -> list[Motion]:
        return [walking(frames, fps=30, speed=1 + temperature + sample) for temperature, sample in latents]


def test_diffusion_gives_one_motion_without_noise_and_then_samples(corpus) -> None:
    pair = read_action_pairs(*corpus)[1]
    speeds = [m.root[-1, 2] / m.duration for m in diffused(Diffuser())(pair, 2)]
    assert speeds == pytest.approx([1, 2, 3])
    assert [motion.frames for motion in diffused(Diffuser())(pair, 0)] == [45]


# -- prompts


class Speeds:
    """A runtime whose texts say how fast to walk, and whose embeddings are the speed and the length."""

    def __init__(self, wrong: bool = False) -> None:
        self.wrong = wrong

    def generate(self, text: str, *, seconds: float, seed: int, n: int, sampler: str, foot_lock: bool) -> list[Motion]:
        speed = float(text.rsplit(maxsplit=1)[-1]) * (-1 if self.wrong else 1)
        return [walking(round(30 * seconds), fps=30, speed=speed + 0.01 * sample) for sample in range(n)]

    def embed_text(self, text: Sequence[str]) -> np.ndarray:
        return _unit([float(one.split()[-1]) for one in text])

    def embed_motion(self, motion: Sequence[Motion]) -> np.ndarray:
        return _unit([float(one.root[-1, 2] / one.duration) for one in motion])


def _unit(speeds: list[float]) -> np.ndarray:
    return np.stack([np.cos(speeds), np.sin(speeds)], axis=1)


ASKED = [prompts.Prompt(2.0, f"walk at {speed}") for speed in (0.2, 0.6, 1.0, 1.4)]


def test_motions_that_do_what_was_asked_rank_first_and_wrong_ones_do_not() -> None:
    texts = [prompt.text for prompt in ASKED]
    right, wrong = (
        prompts.judged(maker, texts, prompts.generated(maker, ASKED, 3, "vae", foot_lock=False))
        for maker in (Speeds(), Speeds(wrong=True))
    )
    assert (right.motions, right.recall_1, right.median_rank) == (12, 100.0, 1.0)
    assert right.by_text == (100.0,) * 4
    assert wrong.recall_1 < 50
    assert right.multimodality is not None
    assert right.diversity is not None
    assert right.multimodality < right.diversity


def test_the_command_judges_generations_and_baselines(corpus, tmp_path, monkeypatch) -> None:
    class Fake(Speeds):
        def __init__(self, models: object) -> None:
            super().__init__()
            embed = SimpleNamespace(embed=lambda texts: np.ones((len(texts), 2)))
            self.model = SimpleNamespace(sentences=embed)

        def embed_text(self, text: Sequence[str]) -> np.ndarray:
            return super().embed_text([one if one[-1].isdigit() else "1.2" for one in text])

    monkeypatch.setattr(generation, "Runtime", Fake)
    asked = tmp_path / "prompts.txt"
    asked.write_text("1 | walk at 0.2\n2 | walk at 1.1\n", encoding="utf-8")
    files = ["--recordings", str(corpus[0]), "--captions", str(corpus[1]), "--prompts", str(asked)]
    generation.main(["prompts", *files, "--samples", "2", "--json", str(tmp_path / "figures.json")])
    rows = json.loads((tmp_path / "figures.json").read_text(encoding="utf-8"))["rows"]
    assert {name: row["motions"] for name, row in rows.items()} == {
        "diffusion, feet locked": 4,
        "diffusion, feet free": 4,
        "vae, feet locked": 4,
        "vae, feet free": 4,
        "chance": 0,
        "training clip of the nearest caption": 2,
        "test clip of the nearest caption": 2,
        "its first pose, held": 2,
        "recorded test clips, own captions": 2,
        "recorded test clips, feet locked": 2,
    }
    assert rows["vae, feet free"]["recall_1"] == 100.0


def test_the_baseline_takes_the_clip_with_the_nearest_caption(corpus) -> None:
    clips = read_actions(load_recordings(corpus[0]), corpus[1])

    def sentences(texts: list[str]) -> np.ndarray:
        return np.array([["b walks" in text, "b walks" not in text] for text in texts], float)

    found = prompts.looked_up([prompts.Prompt(1.0, "b walks")], clips, sentences)
    assert [[motion.frames for motion in group] for group in found] == [[45]]


def test_prompts_are_read_with_their_seconds_and_a_bad_line_is_named(tmp_path) -> None:
    file = tmp_path / "prompts.txt"
    file.write_text("# comment\n\n4 | walk\n2.5|jump up\n", encoding="utf-8")
    assert prompts.read_prompts(file) == [prompts.Prompt(4.0, "walk"), prompts.Prompt(2.5, "jump up")]
    for bad in ("walk", "four | walk", "4 |"):
        file.write_text(f"4 | walk\n{bad}\n", encoding="utf-8")
        with pytest.raises(FormatError, match="seconds"):
            prompts.read_prompts(file)
    file.write_text("# nothing\n", encoding="utf-8")
    with pytest.raises(InvalidInputError, match="no prompt"):
        prompts.read_prompts(file)


def test_the_shipped_prompts_are_forty_and_within_what_generation_takes() -> None:
    asked = prompts.read_prompts()
    assert len({prompt.text for prompt in asked}) == 40
    assert all(0.5 <= prompt.seconds <= 10 for prompt in asked)


def test_the_page_of_prompts_leaves_out_what_was_not_measured() -> None:
    rows = {
        "chance": prompts.by_chance(),
        "made": prompts.PromptRow(12, 50.0, 75.0, 1.5, skate_cm=0.41, jerk=9.0, fid=1.1),
    }
    page = prompts.prompt_page(rows, ASKED, 3)
    assert "| chance |  | 3.1 | 9.4 | 16.5 |  |  |  |  |  |  |  |  |" in page
    assert "| made | 12 | 50.0 | 75.0 | 1.5 | 0.41 |  |  | 9.0 |  |  |  | 1.10 |" in page
    assert json.dumps(prompts.as_json(rows, ASKED))


def test_foot_skate_and_jerk_are_those_of_motions_on_their_floor() -> None:
    high = standing(30, fps=30)
    high = Motion(high.rotations, high.root + np.float32([0, 5, 0]), 30)
    found = prompts.moved([high])
    assert found == {"skate_cm": 0, "jerk": 0, "energy": 0, "contact_speed": 0, "contact_share": 1}
    walks = prompts.moved([walking(60, fps=30)])
    assert walks["skate_cm"] > 1
    assert walks["contact_speed"] > 0.1
    still = prompts.moved(prompts.frozen([[walking(60, fps=30)]])[0])
    assert still["energy"] == still["skate_cm"] == 0


# -- body parts


def test_phrases_are_read_with_their_answers(tmp_path) -> None:
    header = "phrase\tleft arm\tright arm\tleft leg\tright leg\ttorso\tglobal\n"
    file = tmp_path / "labels.tsv"
    file.write_text(f"# made up\n{header}wave\tno\tyes\tno\tno\tsometimes\tno\n", encoding="utf-8")
    found = part_labels.read_phrases(file)
    assert found == part_labels.Phrases(("wave",), (("no", "yes", "no", "no", "sometimes", "no"),))
    for bad in ("phrase\tarm\n", f"{header}wave\tno\n", "# nothing\n"):
        file.write_text(bad, encoding="utf-8")
        with pytest.raises(FormatError, match="columns"):
            part_labels.read_phrases(file)


def test_labels_of_a_clip_count_together_and_motions_are_watched(corpus) -> None:
    clips = [clip for clip in read_actions(load_recordings(corpus[0]), corpus[1]) if clip.split == "test"]
    known = {action.text: action.parts for action in (WALK, WAVE, TURN)}
    found = part_labels.on_clips({"told": known.__getitem__}, {"blind": lambda motion: ()}, clips)
    assert found["told"].mean == 1.0
    assert found["told"].phrases == 2
    assert found["blind"].accuracy["right arm"] == 0.0
    assert found["blind"].accuracy["torso"] == 1.0
    by_label = part_labels.on_labels({"told": known.__getitem__}, clips)
    assert (by_label["told"].phrases, by_label["told"].mean) == (3, 1.0)
    page = part_labels.part_page({"clips": found})
    assert "| told | 2 | 1.000 |" in page


def test_the_command_asks_the_rules_and_watches_the_motions(corpus, tmp_path, capsys) -> None:
    phrases = tmp_path / "labels.tsv"
    header = "phrase\tleft arm\tright arm\tleft leg\tright leg\ttorso\tglobal"
    phrases.write_text(
        f"{header}\nwave the right hand\tno\tyes\tno\tno\tsometimes\tno\nbow\tno\tno\tno\tno\tyes\tno\n",
        encoding="utf-8",
    )
    files = ["--recordings", str(corpus[0]), "--captions", str(corpus[1]), "--phrases", str(phrases)]
    generation.main(["parts", *files, "--json", str(tmp_path / "figures.json")])
    tables = json.loads((tmp_path / "figures.json").read_text(encoding="utf-8"))
    assert [sorted(rows) for rows in tables.values()] == [
        ["most common answer", "rules"],
        ["most common answer", "rules"],
        ["most common answer", "rules", "velocity", "velocity, as published"],
    ]
    assert tables["phrases answered by hand"]["rules"]["accuracy"]["right arm"] == 1.0
    assert "| rules | 2 | 1.000 | 1.000 |" in capsys.readouterr().out


def test_the_floor_answers_with_what_is_most_common() -> None:
    answers = [("no", "yes", "sometimes", "no", "yes", "no"), ("no", "yes", "yes", "no", "no", "no")]
    assert part_labels.most_common(answers) == ["right arm", "left leg"]


def test_a_decoded_motion_starts_at_the_origin(model) -> None:
    motion = model.decode(model.text("walk")[0], 20)
    assert (motion.frames, motion.fps) == (20, sinc135.FPS)
    np.testing.assert_allclose(motion.root[0, [0, 2]], 0, atol=1e-6)
    assert model.motion(motion).shape == (32,)
