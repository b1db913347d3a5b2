"""``motionrt compose`` and ``motionrt parts``."""

from __future__ import annotations

import json
import threading
from collections.abc import Callable
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from motions import random_motion, walking
from tiny_models import TINY_GENERATORS

from motionrt import PARTS, Motion, load_motion
from motionrt.cli import main
from motionrt.motion.body_parts import PART_JOINTS

RunJson = Callable[..., Any]
WALK, WAVE = "walk in a circle", "wave the right hand"
MODELS = ("--models", TINY_GENERATORS)


@pytest.fixture(autouse=True)
def fake_models() -> None:
    """The tiny models are used as they are."""


@pytest.fixture
def body(tmp_path: Path) -> Path:
    return walking(60, 30.0).save(tmp_path / "body.npz")


@pytest.fixture
def other(tmp_path: Path) -> Path:
    return random_motion(45, 30.0).save(tmp_path / "other.npz")


def assert_from(motion: Motion, source: Path, names: list[str], joints: np.ndarray) -> None:
    expected = load_motion(source)[: motion.frames].rotations
    np.testing.assert_allclose(motion.rotations[:, joints], expected[:, joints], atol=1e-5, err_msg=str(names))


def test_two_files_become_one(run_json: RunJson, body: Path, other: Path, tmp_path: Path) -> None:
    out = tmp_path / "out.npz"
    found = run_json("compose", body, other, "--parts-b", "right arm, Left_Arm", "--seam", 0, "-o", out)
    assert found.keys() == {"path", "frames", "fps", "seconds", "foot_skate_cm", "seed", "joint", "layers"}
    assert (found["path"], found["frames"], found["fps"], found["seconds"]) == (str(out), 45, 30, 1.5)
    assert (found["seed"], found["joint"]) == (None, False)
    assert found["layers"] == [
        {"given": str(body), "kind": "file", "parts": list(PARTS), "mask": None},
        {"given": str(other), "kind": "file", "parts": ["left arm", "right arm"], "mask": None},
    ]
    arms = np.isin(np.arange(24), [*PART_JOINTS["right arm"], *PART_JOINTS["left arm"]])
    motion = load_motion(out)
    assert_from(motion, other, ["arms"], arms)
    assert_from(motion, body, ["the rest"], ~arms)


def test_masks_name_joints(run_json: RunJson, body: Path, other: Path, tmp_path: Path) -> None:
    out = tmp_path / "out.npz"
    found = run_json("compose", body, other, "--mask-b", "head,left_knee", "--seam", 0, "-o", out)
    assert found["layers"][1]["mask"] == ["head", "left_knee"]
    covered = np.isin(np.arange(24), [15, 4])
    assert_from(load_motion(out), other, ["mask"], covered)
    assert_from(load_motion(out), body, ["the rest"], ~covered)


def test_texts_are_generated_and_labelled(run_json: RunJson, tmp_path: Path) -> None:
    out = tmp_path / "both.bvh"
    found = run_json("compose", WALK, WAVE, "--seed", 4, "--seconds", 2, "-o", out, *MODELS)
    assert found["seed"] == 4
    assert [layer["kind"] for layer in found["layers"]] == ["text", "text"]
    assert found["layers"][1]["parts"] == ["right arm"]
    assert {"left leg", "right leg", "global"} <= set(found["layers"][0]["parts"])
    assert load_motion(out).frames == 60


def test_a_file_and_a_text_and_another_text(body: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "out.bvh"
    texts = [WAVE, "shake the head", "--parts-c", "torso"]
    assert main(["compose", str(body), *texts, "--seed", "0", "-o", str(out), *map(str, MODELS)]) == 0
    shown, err = capsys.readouterr()
    rows = [line.split(maxsplit=1) for line in shown.splitlines()]
    assert [row[0] for row in rows] == ["layer", "A", "B", "C"]
    starts = ["moves", "the whole body ", "right arm ", "torso "]
    assert all(row[1].startswith(start) for row, start in zip(rows, starts, strict=True))
    assert err == ""
    assert load_motion(out).frames == 60


def test_joint_texts_are_one_motion_of_the_model(run_json: RunJson, tmp_path: Path) -> None:
    joint, single = tmp_path / "joint.npz", tmp_path / "single.npz"
    found = run_json("compose", WALK, WAVE, "--joint", "--seed", 2, "-o", joint, *MODELS)
    run_json("generate", f"{WALK} and {WAVE}", "--seed", 2, "--candidates", 1, "-o", single, *MODELS)
    assert found["joint"] is True
    assert [layer["parts"] for layer in found["layers"]] == [None, None]
    np.testing.assert_array_equal(load_motion(joint).rotations, load_motion(single).rotations)


def test_a_seed_is_told_where_chance_has_a_part(
    body: Path, other: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = ["-o", str(tmp_path / "out.bvh")]
    assert main(["compose", str(body), str(other), "--parts-b", "torso", *out]) == 0
    assert capsys.readouterr().err == ""
    assert main(["compose", str(body), WAVE, *out, *map(str, MODELS)]) == 0
    assert capsys.readouterr().err.startswith("seed ")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["BODY"], "two or more motions, files or texts"),
        (["BODY", "OTHER", "--parts-b", "tail"], "unknown body part 'tail'"),
        (["BODY", "OTHER", "--parts-c", "torso"], "--parts-c is for a motion that is not there: only 2 are given"),
        (["BODY", "OTHER", "--parts-b", "torso", "--mask-b", "head"], "not both"),
        (["BODY", "OTHER", "--parts-b", "torso", "--seam", "9"], "seam must be 0, 1, 2 or 3"),
        (["BODY", "OTHER", "--parts-b", "torso", "--align", "best"], "align must be one of start, stretch, phase"),
        (["BODY", "OTHER", "--parts-b", "torso", "--seconds", "10000"], "seconds must be"),
        (["BODY", "missing.bvh"], "missing.bvh"),
        (["BODY", "OTHER", "--joint"], "--joint is for texts alone"),
        (["BODY", ""], "the text is empty"),
    ],
)
def test_an_error_is_one_line_and_tells_by_its_exit_code(
    arguments: list[str], message: str, body: Path, other: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    files = {"BODY": str(body), "OTHER": str(other)}
    given = [files.get(argument, argument) for argument in arguments]
    code = 2 if "that is not there" in message else 1
    assert main(["compose", *given, "-o", str(tmp_path / "out.bvh"), *map(str, MODELS)]) == code
    out, err = capsys.readouterr()
    assert out == ""
    assert message in err
    assert err.count("\n") == 1
    assert not (tmp_path / "out.bvh").exists()


def test_the_parts_of_a_text_come_with_reasons(run_json: RunJson, capsys: pytest.CaptureFixture[str]) -> None:
    found = run_json("parts", "kick with the right leg")
    assert found.keys() == {"text", "labeller", "parts", "because"}
    assert found["parts"] == ["right leg"]
    assert (found["text"], found["labeller"]) == ("kick with the right leg", "rules")
    assert found["because"][0].keys() == {"words", "rule", "parts", "adds"}
    assert main(["parts", "kick with the right leg"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "right leg"
    assert lines[2].split() == ["words", "parts", "rule"]
    assert "kick" in lines[3]


class Server(BaseHTTPRequestHandler):
    """Answers every prompt as a chat completion."""

    def do_POST(self) -> None:
        asked = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        said = "neck" if asked["model"] == "toy" and self.headers["Authorization"] == "Bearer abc" else "?"
        body = json.dumps({"choices": [{"message": {"content": said}}]}).encode()
        self.send_response(200)
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *_: object) -> None:
        """Says nothing."""


def test_a_language_model_may_be_asked(run_json: RunJson, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("TOY_KEY", "abc")
    with ThreadingHTTPServer(("127.0.0.1", 0), Server) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        url = f"http://127.0.0.1:{server.server_port}/v1"
        found = run_json("parts", "nod", "--endpoint", url, "--llm", "toy", "--key-variable", "TOY_KEY")
        server.shutdown()
    assert found == {"text": "nod", "labeller": "llm", "parts": ["torso"], "because": []}


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--llm", "toy"], "both --endpoint URL and --llm NAME"),
        (["--endpoint", "localhost", "--llm", "toy"], "must be an http(s) address"),
        (["--endpoint", "http://x/v1", "--llm", "toy", "--key-variable", "NO_SUCH_KEY"], "NO_SUCH_KEY is not set"),
    ],
)
def test_a_language_model_that_is_not_all_there_is_refused(
    options: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["parts", "nod", *options]) == (2 if "both" in message else 1)
    assert message in capsys.readouterr().err


def test_parts_of_nothing_are_refused(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["parts", "  "]) == 1
    assert "text is empty" in capsys.readouterr().err


@pytest.mark.parametrize(
    "url",
    ["http://[::1", "http://host:port/v1", "http://h:99999", "http://h/ü", "http://a b/", "http://a..b/", "http://:80"],
)
def test_an_address_that_is_none_is_one_line_and_exit_code_one(url: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["parts", "nod", "--endpoint", url, "--llm", "toy", "--json"]) == 1
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("motionrt: error: ")
    assert err.count("\n") == 1


@pytest.mark.parametrize("option", [("--sampler", "gan"), ("--temperature", "nan"), ("--seed", "-1")])
def test_wrong_options_are_refused_for_files_too(
    option: tuple[str, str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = str(walking(20).save(tmp_path / "walk.bvh"))
    out = tmp_path / "out.bvh"
    assert main(["compose", file, file, "-o", str(out), *option, *map(str, MODELS)]) == 1
    assert option[0].strip("-") in capsys.readouterr().err
    assert not out.exists()


def test_a_file_of_labels_becomes_a_file_of_parts(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    labels, out = tmp_path / "labels.txt", tmp_path / "parts.jsonl"
    labels.write_text(
        "kick with the right leg\n# no label\n\nshake the head\nkick with the right leg\n", encoding="utf-8"
    )
    assert main(["parts", "--file", str(labels), "-o", str(out)]) == 0
    rows = [json.loads(line) for line in out.read_text(encoding="utf-8").splitlines()]
    assert rows == [
        {"text": "kick with the right leg", "labeller": "rules", "parts": ["right leg"]},
        {"text": "shake the head", "labeller": "rules", "parts": ["torso"]},
    ]
    assert "2 texts" in capsys.readouterr().err


@pytest.mark.parametrize("arguments", [[], ["nod", "--file", "x"], ["--file", "x"], ["nod", "-o", "x"]])
def test_parts_want_one_text_or_a_file_with_its_output(
    arguments: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["parts", *arguments]) == 1
    assert "give one TEXT, or --file LABELS with -o PARTS.jsonl" in capsys.readouterr().err
