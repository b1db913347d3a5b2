"""Maps and meshes of other projects: they open, and long walks through them stay free."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from motionrt.locomotion.scene import Scene

SCENES = Path(__file__).parents[5] / "shared" / "data" / "scenes"


@pytest.mark.parametrize(
    ("name", "options", "least_m2"),
    [
        ("nav2_maps/depot.yaml", {}, 350),
        ("nav2_maps/tb3_sandbox.yaml", {}, 10),
        ("willow/willow-full.pgm", {"resolution": 0.1}, 800),
        ("recast/dungeon.obj", {}, 400),
        ("recast/nav_test.obj", {}, 400),
        ("recast/undulating.obj", {}, 400),
        ("three_pathfinding/level.obj", {}, 50),
        ("three_pathfinding/level.glb", {}, 50),
        ("three_pathfinding/level.nav.obj", {}, 40),
        ("habitat/simple_room.glb", {"up": "z"}, 90),
        ("habitat/stage_floor1.glb", {}, 350),
    ],
)
def test_walks_through_real_scenes_are_free(name: str, options: dict[str, object], least_m2: float) -> None:
    if not (SCENES / name).exists():
        pytest.skip(f"the shared data are not here: {SCENES / name}")
    if not name.endswith((".yaml", ".pgm")):
        pytest.importorskip("trimesh", reason="trimesh (extra 'scene') is not installed")
    scene = Scene.open(SCENES / name, **options)  # type: ignore[arg-type]
    areas = scene.grid.areas
    assert np.bincount(areas[areas > 0]).max() * scene.grid.cell**2 >= least_m2
    path = scene.random_path(60, seed=1)
    places = path.at(np.arange(0, path.length, 0.02))
    assert path.length == pytest.approx(60, abs=0.01)
    assert scene.free(places).all()
    assert (scene.clearance(places) >= scene.agent.radius - 1e-3).all()
    assert np.isfinite(scene.height(places)).all()
