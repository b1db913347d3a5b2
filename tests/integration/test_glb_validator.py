"""GLB files before the judge of the format: the validator of the Khronos Group, from npm (``gltf-validator``)."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from characters import Z_UP, bvh_text, character
from gaits import gait
from glb_files import glb
from motions import random_motion, standing, walking

from motionrt.formats import write_glb

HERE = Path(__file__).parent
SCRIPT = """
const validator = require('gltf-validator'), fs = require('fs');
(async () => {
  const reports = {};
  for (const file of process.argv.slice(1))
    reports[file] = (await validator.validateBytes(new Uint8Array(fs.readFileSync(file)))).issues;
  console.log(JSON.stringify(reports));
})();
"""


def validated(*paths: Path) -> dict[str, Any]:
    """The validator's issues, by file."""
    node = shutil.which("node")
    if node is None:
        pytest.skip("node is not installed")
    if not (HERE / "node_modules" / "gltf-validator").exists():
        pytest.skip(f"npm's gltf-validator is not installed: run 'npm install' in {HERE}")
    command = [node, "-e", SCRIPT, *map(str, paths)]
    done = subprocess.run(command, cwd=HERE, capture_output=True, text=True, check=True, encoding="utf-8")
    reports: dict[str, Any] = json.loads(done.stdout)
    return reports


def flawless(*paths: Path) -> None:
    for path, issues in validated(*paths).items():
        assert not issues["messages"], f"{path}: {issues['messages'][:3]}"


def test_motions_of_all_lengths_and_rates_are_valid(tmp_path: Path) -> None:
    motions = [standing(1), gait(4.0)[0], *(random_motion(n, 30, seed=n) for n in (1, 2, 3, 30, 300))]
    motions += [walking(40, fps) for fps in (15, 20, 23.976, 24, 25, 29.97, 30, 50, 60, 120)]
    motions += [random_motion(20, 30, seed=seed) for seed in range(33)]
    flawless(*(write_glb(motion, tmp_path / f"{i}.glb") for i, motion in enumerate(motions)))


@pytest.mark.parametrize("armature", [None, (Z_UP, 0.01), (np.eye(3), 100.0)])
def test_characters_with_a_new_animation_are_as_valid_as_before(tmp_path: Path, armature: Any) -> None:
    paths = []
    for scheme in ("mixamo", "unreal", "cmu"):
        rig = glb(character(scheme, root="root" if scheme == "unreal" else None), frames="random", armature=armature)
        moved = walking(30, 30).retarget_to(rig.save(tmp_path / f"{scheme}.glb"), root_motion=scheme == "unreal")
        paths.append((tmp_path / f"{scheme}.glb", moved.save(tmp_path / f"{scheme}_walks.glb")))
    reports = validated(*(path for pair in paths for path in pair))
    for before, after in paths:
        counts = [
            {key: reports[str(path)][key] for key in ("numErrors", "numWarnings", "numInfos", "numHints")}
            for path in (before, after)
        ]
        assert counts[0] == counts[1]
        assert counts[1]["numErrors"] == 0


def test_a_character_from_bvh_is_valid(tmp_path: Path) -> None:
    (tmp_path / "rig.bvh").write_text(bvh_text(character("cmu", pose="a")), encoding="utf-8")
    flawless(walking(30, 30).retarget_to(tmp_path / "rig.bvh").save(tmp_path / "out.glb"))
