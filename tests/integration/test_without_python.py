"""The ONNX files run by programs without Python (examples/node, on motionrt-web) give what motionrt gives."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import motionrt
from motionrt.locomotion.crowd import Crowd, history_of
from motionrt.locomotion.starting_poses import stride
from motionrt.models.sessions import Sessions
from motionrt.models.text import load_tokenizer
from motionrt.models.walknet import WalkModel
from motionrt.retrieval import EMBEDDING_ONLY
from motionrt.web import write_folder

EXAMPLE = Path(__file__).parents[2] / "examples" / "node"

pytestmark = pytest.mark.skipif(
    not (EXAMPLE / "node_modules" / "onnxruntime-node").is_dir()
    or not (EXAMPLE / "node_modules" / "motionrt-web" / "dist" / "lib").is_dir(),
    reason="needs Node.js; in integrations/web: npm install && npm run build; in examples/node: npm install",
)


@pytest.fixture(scope="module")
def runtime() -> motionrt.Runtime:
    return motionrt.Runtime(threads=1, text_tower="full")


@pytest.fixture(scope="module")
def site(runtime: motionrt.Runtime, tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_folder(tmp_path_factory.mktemp("site"), {"starter": runtime.gallery()}, native=True)


def run(script: str, *arguments: str) -> subprocess.CompletedProcess[str]:
    command = ["node", script, *arguments]
    return subprocess.run(command, cwd=EXAMPLE, capture_output=True, text=True, encoding="utf-8", check=False)


def node(script: str, site: Path, *arguments: str) -> dict[str, Any]:
    done = run(script, *arguments, "--site", str(site), "--json")
    assert (done.returncode, done.stderr) == (0, "")
    return json.loads(done.stdout)


@pytest.mark.parametrize(
    "text",
    [
        "a person walks and turns left",
        "A man, né Zoë's 3rd – kicks!",
        "someone walks and waves " * 50,
    ],
)
def test_a_text_is_embedded_and_searched_as_in_python(text: str, site: Path, runtime: motionrt.Runtime) -> None:
    found = node("retrieve.mjs", site, text, "-k", "7")
    assert found["tokens"] == load_tokenizer(Sessions()).encode(text).ids
    np.testing.assert_allclose(found["embedding"], runtime.embed_text(text), atol=1e-4)
    hits = runtime.retrieve(text, k=7, weights=EMBEDDING_ONLY, anyway=True)
    np.testing.assert_allclose([hit["score"] for hit in found["hits"]], [hit.score for hit in hits], atol=1e-4)
    assert [hit["id"] for hit in found["hits"]] == [hit.id for hit in hits]
    assert [hit["end_s"] for hit in found["hits"]] == pytest.approx([hit.end_s for hit in hits])


@pytest.mark.parametrize(("goal", "frames"), [((9.0, 30.0, 0.7), 600), ((-4.0, -3.0, -2.0), 150)])
def test_a_walk_at_stride_1_is_the_same_frame_by_frame(
    goal: tuple[float, float, float], frames: int, site: Path
) -> None:
    x, z, heading = goal
    there = [f"--to={x},{z}", f"--heading={heading}", f"--frames={frames}"]
    found = np.array(node("walk.mjs", site, *there)["frames"])
    crowd = Crowd(WalkModel(Sessions(threads=1)), history_of(stride())[None].astype(np.float64).round(6))
    expected = np.stack([crowd.step(np.array([goal]), 1.2)[0] for _ in found])
    assert len(found) > 100
    np.testing.assert_allclose(found, expected, atol=1e-4)


@pytest.mark.parametrize("text", ["somebody waves the left hand", "walks backward, slowly", "sits down"])
def test_a_seed_gives_the_motion_of_python(text: str, site: Path, runtime: motionrt.Runtime) -> None:
    found = node("generate.mjs", site, text, "--seconds", "3", "--seed", "11")
    wanted = runtime.generate(text, seconds=3, seed=11)
    np.testing.assert_allclose(found["rotations"], wanted.rotations.ravel(), atol=1e-3)
    np.testing.assert_allclose(found["root"], wanted.root.ravel(), atol=1e-3)


@pytest.mark.parametrize("suffix", [".bvh", ".glb"])
def test_its_file_is_read_back_with_the_same_joint_positions(suffix: str, site: Path, tmp_path: Path) -> None:
    out = tmp_path / f"walk{suffix}"
    assert run("walk.mjs", "--to", "1,3", "-o", str(out), "--site", str(site)).stderr == ""
    frames = np.array(node("walk.mjs", site, "--to", "1,3")["frames"])
    walk = motionrt.Motion(frames[:, :216].reshape(-1, 24, 3, 3), frames[:, 216:], 30.0)
    np.testing.assert_allclose(motionrt.load_motion(out).positions(), walk.positions(), atol=2e-3)


def test_wrong_usage_and_missing_files_end_in_one_line() -> None:
    wrong, missing = run("walk.mjs", "--to", "here"), run("walk.mjs", "--site", "/nowhere")
    assert (wrong.returncode, wrong.stderr) == (2, "error: --to takes a number, not 'here'\n")
    assert missing.returncode == 1
    assert missing.stderr.startswith("error: cannot read /nowhere/models.json")
    assert run("walk.mjs", "--speeed", "1").returncode == 2
    assert run("generate.mjs", "--help").stdout.startswith("usage: node generate.mjs")
