"""The ONNX files run by a program without Python (examples/node) give what motionrt gives."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import motionrt
from motionrt.locomotion.crowd import Crowd
from motionrt.models.sessions import Sessions
from motionrt.models.text import load_tokenizer
from motionrt.models.walknet import WalkModel
from motionrt.retrieval import EMBEDDING_ONLY

EXAMPLE = Path(__file__).parents[2] / "examples" / "node"

pytestmark = pytest.mark.skipif(
    shutil.which("node") is None or not (EXAMPLE / "node_modules" / "onnxruntime-node").is_dir(),
    reason="needs Node.js, and in examples/node: npm install",
)


def node(script: str, *arguments: str) -> dict[str, Any]:
    command = ["node", script, *arguments, "--json"]
    done = subprocess.run(command, cwd=EXAMPLE, capture_output=True, text=True, encoding="utf-8", check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def start() -> dict[str, Any]:
    return json.loads((EXAMPLE / "start.json").read_text(encoding="utf-8"))


@pytest.mark.parametrize(
    "text",
    [
        "a person walks and turns left",
        "A man, né Zoë's 3rd – kicks!",
        "someone walks and waves " * 50,
    ],
)
def test_a_text_is_embedded_and_searched_as_in_python(text: str) -> None:
    found = node("retrieve.mjs", text, "-k", "7")
    runtime = motionrt.Runtime(threads=1, text_tower="full")
    assert found["tokens"] == load_tokenizer(Sessions()).encode(text).ids
    np.testing.assert_allclose(found["embedding"], runtime.embed_text(text), atol=1e-4)
    hits = runtime.retrieve(text, k=7, weights=EMBEDDING_ONLY, anyway=True)
    np.testing.assert_allclose([hit["score"] for hit in found["hits"]], [hit.score for hit in hits], atol=1e-4)
    assert [hit["id"] for hit in found["hits"]] == [hit.id for hit in hits]
    assert [hit["end_s"] for hit in found["hits"]] == pytest.approx([hit.end_s for hit in hits])


@pytest.mark.parametrize(("goal", "frames"), [((9.0, 30.0, 0.7), 600), ((-4.0, -3.0, -2.0), 150)])
def test_a_walk_at_stride_1_is_the_same_frame_by_frame(goal: tuple[float, float, float], frames: int) -> None:
    x, z, heading = goal
    there = [f"--to={x},{z}", f"--heading={heading}", f"--frames={frames}"]
    found = np.array(node("walk.mjs", *there)["frames"])
    crowd = Crowd(WalkModel(Sessions(threads=1)), np.array(start()["stride"])[None])
    expected = np.stack([crowd.step(np.array([goal]), 1.2)[0] for _ in found])
    assert len(found) > 100
    np.testing.assert_allclose(found, expected, atol=1e-4)


def test_its_bvh_file_is_read_back_with_the_same_joint_positions(tmp_path: Path) -> None:
    out = tmp_path / "walk.bvh"
    subprocess.run(["node", "walk.mjs", "--to", "1,3", "-o", str(out)], cwd=EXAMPLE, check=True, capture_output=True)
    frames = np.array(node("walk.mjs", "--to", "1,3")["frames"])
    walk = motionrt.Motion(frames[:, :216].reshape(-1, 24, 3, 3), frames[:, 216:], 30.0)
    np.testing.assert_allclose(motionrt.load_motion(out).positions(), walk.positions(), atol=2e-3)
