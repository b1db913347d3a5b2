"""The C# files of examples/engines compile, and walk as motionrt does with the same network.

Neither Unity nor a compiler for the sources of onnxruntime's C# package is here: what the files use of both is declared
in tests/integration/csharp, and the network's answers are those that it gave to Python.
"""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from motionrt.locomotion.crowd import Crowd, history_of
from motionrt.locomotion.starting_poses import stride
from motionrt.models.sessions import Sessions
from motionrt.models.walknet import WalkModel

ROOT = Path(__file__).parents[2]
UNITY, STUBS = ROOT / "examples" / "engines" / "unity", Path(__file__).parent / "csharp"

pytestmark = pytest.mark.skipif(shutil.which("mcs") is None, reason="no C# compiler (Debian: apt install mono-mcs)")


def compile_(out: Path, kind: str, *sources: Path) -> Path:
    words = ["mcs", "-langversion:7.2", "-warnaserror", "-warn:4", "-nowarn:0649", f"-target:{kind}", f"-out:{out}"]
    done = subprocess.run([*words, *map(str, sources)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    return out


def test_the_file_for_unity_compiles(tmp_path: Path) -> None:
    compile_(tmp_path / "unity.dll", "library", UNITY / "Walker.cs", UNITY / "UnityWalkNet.cs", STUBS / "Unity.cs")


def test_the_file_for_onnxruntime_compiles(tmp_path: Path) -> None:
    sources = UNITY / "Walker.cs", UNITY / "OnnxRuntimeWalkNet.cs", STUBS / "OnnxRuntime.cs"
    compile_(tmp_path / "onnxruntime.dll", "library", *sources)


@pytest.mark.skipif(shutil.which("mono") is None, reason="no mono (Debian: apt install mono-runtime)")
def test_600_frames_in_csharp_are_those_of_python(tmp_path: Path) -> None:
    program = compile_(tmp_path / "replay.exe", "exe", UNITY / "Walker.cs", STUBS / "Replay.cs")
    model, asked, said = WalkModel(Sessions(threads=1)), [], []

    def network(frames: np.ndarray, speed: np.ndarray) -> np.ndarray:
        asked.append(frames[0].copy())
        said.append(model(frames, speed)[0])
        return said[-1][None]

    goal, history = (2.0, 6.0, 0.4), history_of(stride()).astype(np.float32)
    crowd = Crowd(network, history[None].astype(np.float64))
    wanted = np.stack([crowd.step(np.array([goal]), 1.2)[0] for _ in range(600)])
    files = [tmp_path / name for name in ("history.f32", "said.f32", "seen.f32", "frames.f64")]
    history.tofile(files[0])
    np.stack(said).astype(np.float32).tofile(files[1])
    given = [files[0], files[1], *goal, files[2], files[3]]
    done = subprocess.run(["mono", program, *map(str, given)], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    np.testing.assert_allclose(np.fromfile(files[3]).reshape(600, 219), wanted, atol=1e-5)
    np.testing.assert_allclose(np.fromfile(files[2], np.float32).reshape(600, 30, 219), np.stack(asked), atol=1e-5)
