"""A cloud alone is enough to walk round its things; limbs inside them are measured."""

from __future__ import annotations

import numpy as np
import pytest
from fake_character_models import FakeCharacterModels
from rooms import room

from motionrt.locomotion import Goal, SemanticCloud, WalkTo
from motionrt.locomotion.performing import Performer
from motionrt.locomotion.words.ways import ways_through

BLOCK = ((-1.0, 0.0, -0.3), (1.0, 0.9, 0.3))


@pytest.fixture(scope="module")
def cloud() -> SemanticCloud:
    return room({"table": [BLOCK]})


def inside(places: np.ndarray) -> np.ndarray:
    return (np.abs(places[:, 0]) < 1.0) & (np.abs(places[:, 1]) < 0.3)


def test_the_way_leads_round_what_stands_there(cloud: SemanticCloud) -> None:
    ways = ways_through(cloud)
    assert ways is not None
    path = ways.plan((0.0, -2.0), (0.0, 2.0))
    assert not inside(path.at(np.linspace(0, path.length, 200))).any()
    assert not path.notes
    assert path.points[[0, -1]] == pytest.approx(np.array([[0, -2], [0, 2]]), abs=1e-3)


def test_where_there_is_no_way_it_is_straight_and_says_so(cloud: SemanticCloud) -> None:
    ways = ways_through(cloud)
    assert ways is not None
    path = ways.plan((0.0, -2.0), (20.0, 2.0))
    assert path.length == pytest.approx(np.hypot(20, 4), rel=1e-5)
    assert "straight through" in path.notes[0]


def test_without_ground_there_are_no_ways() -> None:
    assert ways_through(SemanticCloud(np.zeros((4, 3)), ["chair"] * 4)) is None


def test_a_noisy_scan_with_holes_is_walked_through_as_well() -> None:
    rng = np.random.default_rng(0)
    clean = room({"table": [BLOCK]})
    keep = rng.random(len(clean)) > 0.3
    labels = np.array(clean.names)[clean.index][keep]
    noisy = SemanticCloud(clean.points[keep] + rng.normal(0, 0.015, (int(keep.sum()), 3)), labels)
    ways = ways_through(noisy)
    assert ways is not None
    path = ways.plan((0.0, -2.0), (0.0, 2.0))
    assert not path.notes
    assert not inside(path.at(np.linspace(0, path.length, 200))).any()


def test_a_performance_in_a_cloud_keeps_out_of_its_things_and_measures_it(cloud: SemanticCloud) -> None:
    def share(given: SemanticCloud | None) -> float:
        done = Performer(FakeCharacterModels(), Goal(0, -2), cloud=given).perform([WalkTo(0, 2)], foot_lock=False)
        return float(inside(done.motion.root[:, [0, 2]]).mean())

    assert share(None) > 0.1
    assert share(cloud) == 0.0
    done = Performer(FakeCharacterModels(), Goal(0, -2), cloud=cloud).perform([WalkTo(0, 2)], foot_lock=False)
    assert done.measures.penetration_share is not None
    assert done.measures.penetration_share < 0.3
    assert "penetration_max_cm" in done.measures.as_dict()
