"""The C++ file of examples/engines, compiled against onnxruntime's headers, walks as motionrt does."""

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
PLUGIN = Path(__file__).parent / "node_modules" / "com.github.asus4.onnxruntime"


@pytest.fixture(scope="module")
def walk(tmp_path_factory: pytest.TempPathFactory) -> Path:
    headers = next(iter(sorted(PLUGIN.rglob("onnxruntime_cxx_api.h"))), None)
    if headers is None or shutil.which("g++") is None:
        pytest.skip("needs g++, and in tests/integration: npm install")
    folder = tmp_path_factory.mktemp("engine")
    (folder / "libonnxruntime.so.1").symlink_to(PLUGIN / "Plugins" / "Linux" / "x64" / "libonnxruntime.so")
    (folder / "libonnxruntime.so").symlink_to(folder / "libonnxruntime.so.1")
    program = folder / "walk"
    source = ROOT / "examples" / "engines" / "walk.cpp"
    command = ["g++", "-std=c++17", "-O1", "-Wall", "-Wextra", "-Werror", "-isystem", headers.parent, source]
    command += ["-o", program, "-L", folder, "-lonnxruntime", f"-Wl,-rpath,{folder}"]
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return program


def run(program: Path, *arguments: object) -> subprocess.CompletedProcess[str]:
    return subprocess.run([str(program), *map(str, arguments)], capture_output=True, text=True, check=False)


def test_the_walk_in_cpp_is_that_of_python(walk: Path, tmp_path: Path) -> None:
    history, goal, out = history_of(stride()).astype(np.float32), (2.0, 6.0, 0.4), tmp_path / "walk.f32"
    np.save(tmp_path / "history.npy", history)
    done = run(walk, ROOT / "models" / "walknet.int8.onnx", tmp_path / "history.npy", *goal, 150, out)
    assert (done.returncode, done.stderr) == (0, "")
    found = np.fromfile(out, np.float32).reshape(150, 219)
    crowd = Crowd(WalkModel(Sessions(threads=1)), history[None].astype(np.float64))
    wanted = np.stack([crowd.step(np.array([goal]), 1.2)[0] for _ in found])
    np.testing.assert_allclose(
        found[:8], wanted[:8], atol=1e-3
    )  # two builds of onnxruntime round differently further on
    np.testing.assert_allclose(found[-1, 216:], wanted[-1, 216:], atol=0.1)


def test_wrong_usage_is_told_in_one_line(walk: Path, tmp_path: Path) -> None:
    assert run(walk).returncode == 2
    nothing = run(walk, "none.onnx", tmp_path / "none.npy", 0, 1, 0, 1, tmp_path / "out")
    assert nothing.returncode == 1
    assert nothing.stderr.startswith("error: ")
