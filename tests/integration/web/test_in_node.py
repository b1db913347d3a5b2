"""motionrt-web gives what motionrt gives: tokens, attributes, chance, embeddings, hits, walks, motions and files."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

import motionrt
from motionrt.locomotion.crowd import Crowd, history_of
from motionrt.locomotion.goal_frame import Goal, uncanonicalise
from motionrt.locomotion.starting_poses import stride
from motionrt.models import Sessions
from motionrt.models.text import load_tokenizer
from motionrt.models.walknet import WalkModel
from motionrt.retrieval import EMBEDDING_ONLY
from motionrt.retrieval.captions import read_captions
from motionrt.services.search import DEFAULT_CAPTIONS
from motionrt.text import gestures_of_text, parse_query, slots_of_text, targets_of_text
from motionrt.web import write_folder

from .conftest import PACKAGE, Ask

TEXT = "somebody strolls to the left and hails a taxi"
GESTURES = (
    "claps twice and points with the left hand", "bows, then takes a bow", "draws a bow", "stands on her left foot",
    "kneels on one knee", "kneels and prays", "marches without clapping", "plays the violin", "raises the left arm",
    "raises one hand", "raises both arms while walking", "at that point of the dance", "looks left and right and nods",
    "élève: shakes his head – a naïve bow",
)  # fmt: skip
LETTERS = "éİßΣςﬁǅ①ʼ中한😀–’\u00a0\u0301\u200b\u2028\ufffd\t"


def texts(count: int, seed: int) -> list[str]:
    """Captions, strung together, with foreign letters, and strings of any characters."""
    random, captions = np.random.default_rng(seed), read_captions(DEFAULT_CAPTIONS)
    found = []
    for number in range(count):
        text = " ".join(captions[k] for k in random.integers(len(captions), size=1 + 10 * (number % 7 == 0)))
        if number % 3 == 1:
            place = int(random.integers(len(text)))
            text = text[:place] + LETTERS[random.integers(len(LETTERS))] + text[place:]
        if number % 3 == 2:
            codes = random.integers(32, 0x2FA20, size=random.integers(1, 24))
            text = "a" + "".join(chr(code) for code in codes if not 0xD800 <= code < 0xE000)
        found.append(text)
    return found


def as_motion(found: dict[str, Any]) -> motionrt.Motion:
    rotations, root = np.array(found["rotations"], np.float32), np.array(found["root"], np.float32)
    return motionrt.Motion(rotations.reshape(-1, 24, 3, 3), root.reshape(-1, 3), 30.0)


def plain(motion: motionrt.Motion) -> dict[str, list[float]]:
    return {"rotations": motion.rotations.ravel().tolist(), "root": motion.root.ravel().tolist()}


def test_ten_thousand_texts_become_the_same_tokens(ask: Ask) -> None:
    said, tokenizer = texts(10_000, seed=3), load_tokenizer(Sessions())
    assert ask("tokens", texts=said) == [tokenizer.encode(text).ids for text in said]


def test_every_character_becomes_the_same_tokens(ask: Ask) -> None:
    said = [f"a{chr(code)}b" for code in range(0x30000) if not 0xD800 <= code < 0xE000]
    tokenizer = load_tokenizer(Sessions())
    assert ask("tokens", texts=said) == [tokenizer.encode(text).ids for text in said]


def test_texts_say_the_same_about_motions(ask: Ask) -> None:
    said = [*read_captions(DEFAULT_CAPTIONS), *texts(300, seed=4), "Zoë kniet: jumps 3 times, then walks BACK"]
    for text, found in zip(said, ask("said", texts=said, seconds=5), strict=True):
        numbers, known = targets_of_text(parse_query(text), 5)
        assert found["slots"] == slots_of_text(parse_query(text)).tolist(), text
        assert found["known"] == known.tolist()
        np.testing.assert_allclose(found["numbers"], numbers, atol=1e-6)


def test_texts_mean_the_same_gestures(ask: Ask) -> None:
    said = [*GESTURES, *read_captions(DEFAULT_CAPTIONS), *texts(300, seed=5)]
    for text, found in zip(said, ask("gestures", texts=said), strict=True):
        wanted = json.loads(json.dumps(asdict(gestures_of_text(parse_query(text)))))
        assert {**found, "hands": sorted(found["hands"])} == wanted, text


def test_a_seed_draws_the_same_numbers(ask: Ask) -> None:
    for seed, sample in ((0, 0), (7, 2), (2**40 + 5, 1)):
        wanted = np.random.default_rng([seed, sample]).standard_normal(100_000, dtype=np.float32)
        found = ask("normals", seed=seed, sample=sample, count=100_000)
        np.testing.assert_allclose(found, wanted, atol=1e-6)


def test_texts_are_embedded_and_searched_as_in_python(ask: Ask, runtime: motionrt.Runtime) -> None:
    said = [TEXT, "né 3rd – kick!", *texts(10, seed=3)]
    cosines = (np.array(ask("embed", texts=said)) * runtime.embed_text(said)).sum(axis=1)
    assert cosines.mean() > 0.999  # 8-bit activations round otherwise here and there
    assert cosines.min() > 0.997
    hits = runtime.retrieve(TEXT, k=3, weights=EMBEDDING_ONLY, anyway=True)
    near = ask("search", text=TEXT, k=3)
    assert near[0]["id"] == hits[0].id
    np.testing.assert_allclose([hit["score"] for hit in near], [hit.score for hit in hits], atol=0.04)


def test_a_step_of_a_walk_is_that_of_python(ask: Ask) -> None:
    goal = [2.0, 6.0, 0.4]
    crowd = Crowd(WalkModel(Sessions(threads=1)), history_of(stride())[None].astype(np.float64).round(6))
    wanted = [crowd.step(np.array([goal]), 1.2)[0] for _ in range(8)]
    found = ask("walk", goals=[{"from": 0, "goal": goal}], frames=8, speed=1.2)
    np.testing.assert_allclose(found, wanted, atol=1e-3)  # further on, quantised files of two machines drift apart


def test_600_frames_of_exact_files_are_those_of_python(ask: Ask, tmp_path: Path) -> None:
    import onnxruntime

    site = write_folder(tmp_path / "exact", {}, only=["walknet"], exact=True)
    session = onnxruntime.InferenceSession(site / "models" / "walknet.int8.onnx", providers=["CPUExecutionProvider"])
    none = {info.name: np.zeros((1, 8), np.float32) for info in session.get_inputs() if info.name == "wish"}
    crowd = Crowd(
        lambda frames, speed: session.run(["next"], {"frames": frames, "speed": np.float32(speed), **none})[0],
        history_of(stride())[None].astype(np.float64).round(6),
    )
    goals = [{"from": 0, "goal": [2.0, 6.0, 0.4]}, {"from": 200, "goal": [-3.0, 2.0, -2.0]}]
    goals += [{"from": 400, "goal": [1.0, -4.0, 1.5]}]
    wanted = [crowd.step(np.array([goals[f // 200]["goal"]]), 1.2)[0] for f in range(600)]
    found = ask("walk", site=site, goals=goals, frames=600, speed=1.2)
    np.testing.assert_allclose(found, wanted, atol=1e-3)


def test_a_crowd_steps_as_in_python(ask: Ask) -> None:
    places = [Goal(1.5 * k, 0.0, 0.5 * k) for k in range(32)]
    goals = [Goal(1.5 * k, 5.0, 0.1) for k in range(32)]
    history = np.stack([history_of(uncanonicalise(stride(), place)) for place in places])
    crowd = Crowd(WalkModel(Sessions(threads=1)), history)
    for _ in range(2):
        wanted = crowd.step(np.array([goal.row() for goal in goals]))
    found = ask("crowd", places=[vars(place) for place in places], goals=[vars(goal) for goal in goals], frames=2)
    np.testing.assert_allclose(found, wanted, atol=5e-3)


def test_a_character_gets_where_it_is_sent_and_stands(ask: Ask) -> None:
    found = ask("stroll", x=-2.0, z=1.5, frames=240)
    walk = np.array(found["frames"])
    assert found["state"] == "stands"
    assert np.hypot(walk[-1, 216] + 2.0, walk[-1, 218] - 1.5) < 0.5
    assert np.abs(np.diff(walk[:, 216:], axis=0)).max() < 0.12  # no jumps
    assert np.abs(np.diff(walk[-20:], axis=0)).max() < 1e-6


def test_composed_motions_are_those_of_python(ask: Ask, runtime: motionrt.Runtime) -> None:
    gallery = runtime.gallery()
    walk, wave = (gallery.motion(gallery.clips[k].id).resample(30.0) for k in (0, 3))
    for parts in (["right arm"], ["left arm", "torso"], ["left leg"]):
        wanted = runtime.compose([walk, wave], [None, parts])
        layers = [{"motion": plain(walk), "parts": None}, {"motion": plain(wave), "parts": parts}]
        np.testing.assert_allclose(as_motion(ask("compose", layers=layers)).positions(), wanted.positions(), atol=1e-4)


def test_its_files_are_read_back_with_the_same_joints(ask: Ask, runtime: motionrt.Runtime, tmp_path: Path) -> None:
    clip = runtime.gallery().clips[2].id
    motion = runtime.gallery().motion(clip).resample(30.0)
    np.testing.assert_allclose(as_motion(ask("clip", id=clip)).positions(), motion.positions(), atol=1e-4)
    bvh, glb = tmp_path / "a.bvh", tmp_path / "a.glb"
    ask("files", motion=plain(motion), bvh=str(bvh), glb=str(glb))
    for path in (bvh, glb):
        np.testing.assert_allclose(motionrt.load_motion(path).positions(), motion.positions(), atol=2e-3)


def test_wrong_input_is_a_typed_error_that_says_what_to_do(ask: Ask) -> None:
    found = ask("errors")
    assert {name: error["kind"] for name, error in found.items()} == {
        **dict.fromkeys(("empty", "seconds", "goal", "part"), "input"),
        "missing": "load",
    }
    assert "0.5 to 10" in found["seconds"]["message"]
    assert "left arm" in found["part"]["message"]


def test_the_data_of_the_package_are_those_of_motionrt(tmp_path: Path) -> None:
    import importlib.util

    spec = importlib.util.spec_from_file_location("make_data", PACKAGE / "make_data.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    module.write(tmp_path)
    for path in tmp_path.iterdir():
        assert path.read_bytes() == (PACKAGE / "src" / "data" / path.name).read_bytes(), (
            "python integrations/web/make_data.py"
        )
